//! Types of values.

use crate::rapid::names::{Basic, DeclarationId, Kind, Names, ValueType};

/// The type of a value, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    /// It is not known.
    Unknown,
    /// A number that can be `num` or `dnum`: a literal or the value of a signal.
    Number,
    /// A list in brackets; its place decides its type.
    Aggregate,
    /// A record or basic type, with the number of dimensions.
    Of(DeclarationId, u8),
}

/// The types with rules of their own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Basics {
    pub(super) num: Option<DeclarationId>,
    pub(super) dnum: Option<DeclarationId>,
    pub(super) bool: Option<DeclarationId>,
    pub(super) string: Option<DeclarationId>,
    pub(super) pos: Option<DeclarationId>,
    pub(super) orient: Option<DeclarationId>,
    pub(super) switch: Option<DeclarationId>,
}

impl Basics {
    pub(super) fn new() -> Basics {
        let find = Names::predefined;
        Basics {
            num: find("num"),
            dnum: find("dnum"),
            bool: find("bool"),
            string: find("string"),
            pos: find("pos"),
            orient: find("orient"),
            switch: find("switch"),
        }
    }
}

/// The scalar of a type that may be unknown.
pub(super) fn scalar(id: Option<DeclarationId>) -> Type {
    id.map_or(Type::Unknown, |id| Type::Of(id, 0))
}

/// The type of declared data.
pub(super) fn stated(names: &Names, value: ValueType) -> Type {
    let base = value.declaration.and_then(|id| names.base(id));
    let Some(base) = base else { return Type::Unknown };
    match names.declaration(base).kind {
        Kind::Basic(Basic::Opaque | Basic::Any) => Type::Unknown,
        _ => Type::Of(base, value.dimensions),
    }
}

/// The type of the value of a signal where a value is needed.
pub(super) fn as_value(names: &Names, ty: Type) -> Type {
    match ty {
        Type::Of(id, 0) if is_basic(names, id, &[Basic::SemiValue, Basic::Number]) => Type::Number,
        other => other,
    }
}

pub(super) fn is_basic(names: &Names, id: DeclarationId, kinds: &[Basic]) -> bool {
    matches!(names.declaration(id).kind, Kind::Basic(kind) if kinds.contains(&kind))
}

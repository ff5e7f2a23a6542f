//! The parameters of a called routine, and which arguments a call gives them.

use super::context::{Context, Place};
use crate::rapid::names::{Access, DeclarationId, Kind, Mode};
use crate::rapid::syntax::NodeKind;

/// A parameter.
#[derive(Clone, Copy)]
pub(super) struct Parameter {
    pub(super) id: DeclarationId,
    pub(super) access: Access,
    /// The number of its group of alternatives, if it is optional.
    pub(super) group: Option<u16>,
}

/// The parameters of a routine, in order.
pub(super) fn parameters(context: &Context<'_>, routine: DeclarationId) -> Vec<Parameter> {
    let inside = context.names.inside(routine);
    let parameter = |id| match context.names.declaration(id).kind {
        Kind::Parameter(Mode { access, group }) => Some(Parameter { id, access, group }),
        _ => None,
    };
    inside.filter_map(parameter).collect()
}

/// An argument of a call.
pub(super) struct Argument<'a> {
    /// All of it.
    pub(super) whole: Place<'a>,
    /// Its name, if it is given.
    pub(super) name: Option<Place<'a>>,
    /// Its value, if it has one.
    pub(super) value: Option<Place<'a>>,
}

impl Argument<'_> {
    /// `\name`
    pub(super) fn is_optional(&self) -> bool {
        matches!(self.whole.kind(), NodeKind::OptionalArgument | NodeKind::ConditionalArgument)
    }

    /// `\name?parameter`
    pub(super) fn is_conditional(&self) -> bool {
        self.whole.kind() == NodeKind::ConditionalArgument
    }
}

/// The callee and the arguments of a call statement or a function call; `None` for a call by a
/// string.
pub(super) fn call(place: Place<'_>) -> Option<(Place<'_>, Vec<Argument<'_>>)> {
    let mut children = place.children();
    let callee = children.next().filter(|name| name.kind() == NodeKind::Name)?;
    let arguments = children.map(|whole| {
        if whole.kind().is_named_argument() {
            let mut parts = whole.children();
            let name = parts.next();
            let value = parts.next().filter(|_| whole.kind() != NodeKind::ConditionalArgument);
            Argument { whole, name, value }
        } else {
            Argument { whole, name: None, value: Some(whole) }
        }
    });
    Some((callee, arguments.collect()))
}

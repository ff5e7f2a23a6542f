//! Declarations.

use super::keys::Key;
use crate::rapid::text::Span;

/// A declaration of a [`Names`](super::Names), in the order of the files and their text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DeclarationId(pub(super) u32);

/// What a declaration declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `MODULE`, or the file around declarations without one.
    Module,
    /// `RECORD`
    Record,
    /// A component of a record.
    Component,
    /// `ALIAS`
    Alias,
    /// A predefined type that is neither record nor alias.
    Basic(Basic),
    /// Data of a module or of a routine.
    Data(Storage),
    /// `PROC`, `FUNC`, `TRAP`
    Routine(RoutineKind),
    /// A parameter.
    Parameter(Mode),
    /// The counter of a FOR.
    Counter,
    /// The target of a GOTO.
    Label,
}

/// A predefined type without components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basic {
    /// `num`, `dnum`, `bool`, `string`: can be assigned and compared.
    Atomic,
    /// A signal: it has a `num` as value, and nothing can be assigned to it.
    SemiValue,
    /// `clock`, `iodev`: can neither be assigned nor compared.
    NonValue,
    /// No more is known than the name.
    Opaque,
    /// `num` and `dnum`, of parameters of built-in routines.
    Number,
    /// All types, of parameters of built-in routines.
    Any,
}

/// How data are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// `CONST`
    Const,
    /// `PERS`
    Pers,
    /// `VAR`
    Var,
}

/// The kind of a routine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoutineKind {
    /// `FUNC`
    Func,
    /// `PROC`
    Proc,
    /// `TRAP`
    Trap,
}

/// How a parameter is passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// What the argument has to be.
    pub access: Access,
    /// The number of its group of alternatives among the optional parameters; `None` if it is
    /// required.
    pub group: Option<u16>,
}

/// The access mode of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A value.
    In,
    /// A variable or persistent.
    InOut,
    /// A variable.
    Var,
    /// A persistent.
    Pers,
}

/// Where the name of a declaration is visible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// In all modules of the task; `PERS` also in other tasks.
    Global,
    /// In all modules of this task only.
    Task,
    /// In the module, routine or record around it.
    Local,
}

/// The type of a value: that of a scalar or of the elements of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ValueType {
    /// The declaration of the type; `None` if it is not known.
    pub declaration: Option<DeclarationId>,
    /// The number of dimensions, 0 for a scalar.
    pub dimensions: u8,
}

impl ValueType {
    /// A type that is not known.
    pub const UNKNOWN: ValueType = ValueType { declaration: None, dimensions: 0 };
}

/// A declaration.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// What it declares.
    pub kind: Kind,
    /// Its name; empty where the text has none.
    pub name: Span,
    /// All of it: of a counter its FOR.
    pub whole: Span,
    /// The module, routine or record around it.
    pub parent: Option<DeclarationId>,
    /// Where its name is visible.
    pub reach: Reach,
    /// The type of its value, of a FUNC that of its result, of an alias what it stands for.
    pub value: ValueType,
    pub(super) key: Key,
    /// One past the last declaration inside it.
    pub(super) end: u32,
}

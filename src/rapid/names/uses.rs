//! Uses of names.

use super::declaration::{DeclarationId, ValueType};

/// An identifier of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// The place where it stands.
    pub role: Role,
    /// What it names.
    pub meaning: Meaning,
}

/// The place of an identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Its declaration.
    Declaration,
    /// A value, or the variable of an assignment.
    Value,
    /// A type.
    Type,
    /// A called procedure.
    Procedure,
    /// A called function.
    Function,
    /// The trap of a CONNECT.
    Trap,
    /// A component, after a dot.
    Component,
    /// The name of an argument.
    Argument,
    /// A label.
    Label,
}

/// What an identifier names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// This declaration, of a file or predefined.
    Declared(DeclarationId),
    /// A predefined constant of this type.
    Predefined(ValueType),
    /// A name of `RobotWare` or an option about which no more is known.
    Known,
    /// A procedure, by a string.
    Late,
    /// A component of a value of unknown type, or an argument of an unknown routine.
    Open,
    /// Nothing here has this name.
    Unknown,
}

//! Parameter lists as text: `"\\Conc Signal:signaldo SearchPoint= ToPoint"`.
//!
//! An option starts with a backslash; a written argument ends with `=`; a type that is needed
//! follows a colon.

use super::types::{SignalKind, data_type};

/// The place of an argument in a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArgumentPlace<'a> {
    /// Its number among the positional arguments, from 0.
    Position(usize),
    /// Its name.
    Name(&'a str),
}

/// A parameter of an instruction or a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Parameter {
    /// As RAPID writes it.
    pub(super) name: &'static str,
    /// Whether it is an option: `\Name`.
    pub(super) optional: bool,
    /// Whether the argument is written to.
    pub(super) written: bool,
    type_name: &'static str,
}

impl Parameter {
    /// The kind of the signal, if it is one.
    pub(super) fn signal(&self) -> Option<SignalKind> {
        data_type(self.type_name)?.signal
    }
}

/// The parameters of a list, in order.
pub(super) fn parameters(list: &'static str) -> impl Iterator<Item = Parameter> {
    list.split_whitespace().map(|text| {
        let optional = text.starts_with('\\');
        let written = text.ends_with('=');
        let (name, type_name) = text.split_once(':').unwrap_or((text, ""));
        let name = name.trim_start_matches('\\').trim_end_matches('=');
        Parameter { name, optional, written, type_name }
    })
}

/// Whether a list marks the argument at this place as written to.
pub(super) fn is_written(list: &'static str, place: ArgumentPlace<'_>) -> bool {
    match place {
        ArgumentPlace::Position(n) => positional(list).nth(n).is_some_and(|p| p.written),
        ArgumentPlace::Name(name) => {
            parameters(list).any(|p| p.written && p.name.eq_ignore_ascii_case(name))
        }
    }
}

/// The parameters that are not optional.
pub(super) fn positional(list: &'static str) -> impl Iterator<Item = Parameter> {
    parameters(list).filter(|parameter| !parameter.optional)
}

//! Built-in functions whose value depends only on their arguments.
//!
//! Names and values: function reference of `RobotWare` 6. Angles are in degrees, lengths in mm.

mod arguments;
mod bits;
mod geometry;
mod number;
mod text;

pub(super) use arguments::EvaluatedArguments;
use arguments::Function;
pub(super) use geometry::product;

/// The function of a name in lower case.
pub(super) fn lookup(name: &str) -> Option<Function> {
    number::lookup(name)
        .or_else(|| geometry::lookup(name))
        .or_else(|| text::lookup(name))
        .or_else(|| bits::lookup(name))
}

#[cfg(test)]
mod tests {
    use super::lookup;
    use crate::rapid::builtins::{FUNCTIONS, Source};

    #[test]
    fn calculated_functions_are_implemented() {
        for entry in FUNCTIONS {
            let is_calculated = lookup(&entry.name.to_lowercase()).is_some();
            assert_eq!(is_calculated, entry.source == Source::Arguments, "{}", entry.name);
        }
    }
}

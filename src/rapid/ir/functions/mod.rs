//! RAPID's own functions, as far as their value depends on their arguments alone.
//!
//! Names and values: function reference of `RobotWare` 6. Angles are in degrees, lengths in mm.

mod bits;
mod geometry;
mod number;
mod text;

pub(super) use geometry::product;
use nalgebra::Vector3;

use super::convert;
use super::value::Datum;

/// The arguments of a call, all of them known.
pub(super) struct Given<'v> {
    /// In order, without the optional ones.
    pub(super) args: Vec<&'v Datum>,
    /// Lower-case name and value of the optional ones; switches have none.
    pub(super) options: Vec<(&'v str, Option<&'v Datum>)>,
}

/// A value with its type.
pub(super) type Typed = (Datum, &'static str);
/// Gives the value; `None` if the arguments do not fit.
pub(super) type Function = fn(&Given<'_>) -> Option<Typed>;

/// The function of a name in lower case.
pub(super) fn lookup(name: &str) -> Option<Function> {
    number::lookup(name)
        .or_else(|| geometry::lookup(name))
        .or_else(|| text::lookup(name))
        .or_else(|| bits::lookup(name))
}

impl Given<'_> {
    fn num(&self, index: usize) -> Option<f64> {
        self.args.get(index)?.num()
    }

    fn text(&self, index: usize) -> Option<&str> {
        match self.args.get(index)? {
            Datum::Text(text) => Some(text),
            _ => None,
        }
    }

    fn vector(&self, index: usize) -> Option<Vector3<f64>> {
        convert::nums::<3>(self.args.get(index)?, "the vector").ok().map(Vector3::from)
    }

    fn has(&self, option: &str) -> bool {
        self.options.iter().any(|(name, _)| *name == option)
    }

    /// The number of an option, `otherwise` without it.
    fn option(&self, option: &str, otherwise: f64) -> Option<f64> {
        match self.options.iter().find(|(name, _)| *name == option) {
            Some((_, value)) => (*value)?.num(),
            None => Some(otherwise),
        }
    }
}

fn num(value: f64) -> Option<Typed> {
    value.is_finite().then_some((Datum::Num(value), "num"))
}

fn boolean(value: bool) -> Typed {
    (Datum::Bool(value), "bool")
}

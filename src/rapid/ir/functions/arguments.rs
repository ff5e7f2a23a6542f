//! Arguments and values of functions.

use nalgebra::Vector3;

use crate::rapid::ir::convert;
use crate::rapid::ir::value::Datum;

/// The arguments of a call, all with known values.
pub(in crate::rapid::ir) struct EvaluatedArguments<'v> {
    /// In order, without the optional ones.
    pub(in crate::rapid::ir) args: Vec<&'v Datum>,
    /// Lower-case name and value of the optional ones; switches have none.
    pub(in crate::rapid::ir) options: Vec<(&'v str, Option<&'v Datum>)>,
}

/// A value with its type.
pub(in crate::rapid::ir) type TypedDatum = (Datum, &'static str);
/// Returns the value; `None` if the arguments do not fit.
pub(in crate::rapid::ir) type Function = fn(&EvaluatedArguments<'_>) -> Option<TypedDatum>;

impl EvaluatedArguments<'_> {
    pub(super) fn num(&self, index: usize) -> Option<f64> {
        self.args.get(index)?.num()
    }

    pub(super) fn text(&self, index: usize) -> Option<&str> {
        match self.args.get(index)? {
            Datum::Text(text) => Some(text),
            _ => None,
        }
    }

    pub(super) fn vector(&self, index: usize) -> Option<Vector3<f64>> {
        convert::nums::<3>(self.args.get(index)?, "the vector").ok().map(Vector3::from)
    }

    pub(super) fn has(&self, option: &str) -> bool {
        self.options.iter().any(|(name, _)| *name == option)
    }

    /// The number of an option; `otherwise` if the call does not state it.
    pub(super) fn option(&self, option: &str, otherwise: f64) -> Option<f64> {
        match self.options.iter().find(|(name, _)| *name == option) {
            Some((_, value)) => (*value)?.num(),
            None => Some(otherwise),
        }
    }
}

pub(super) fn num(value: f64) -> Option<TypedDatum> {
    value.is_finite().then_some((Datum::Num(value), "num"))
}

pub(super) fn boolean(value: bool) -> TypedDatum {
    (Datum::Bool(value), "bool")
}

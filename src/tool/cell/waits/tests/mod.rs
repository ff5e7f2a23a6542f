//! Tests on cells with formulas of their own.

mod line;
mod rates;
mod recorder;

pub(in crate::tool::cell::waits) use recorder::Chance;
mod rules;

//! Tests on cells with formulas of their own.

mod files;
mod line;
mod rates;
mod recorder;
mod rules;

pub(in crate::tool::cell::waits) use recorder::Chance;

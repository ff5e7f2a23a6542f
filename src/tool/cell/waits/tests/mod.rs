//! Tests on cells with formulas of their own.

mod line;
mod rates;
mod recorder;
mod rules;

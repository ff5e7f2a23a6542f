//! Tests on cells with formulas of their own.

mod files;
mod line;
mod populations;
mod rates;
mod recorder;
mod rules;

//! Results as text, JSON and HTML.

pub mod calibrate;
pub mod campaign;
pub mod check;
pub mod comparison;
pub mod diagnose;
pub mod html;
pub mod identify;
pub mod instrument;
pub mod json;
pub mod lint;
mod mark;
pub mod place;
pub mod placement;
mod plausible;
pub mod prove;
mod prove_words;
pub mod simulated;
pub mod slack;
pub mod standstill;
pub mod suggestions;
pub mod svg;
pub mod table;
pub mod text;
pub mod trajectory;
pub mod waits;
mod whole_cycle;

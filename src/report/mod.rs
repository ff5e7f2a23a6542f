//! Results as text and JSON.

pub mod json;
pub mod place;
pub mod table;
pub mod text;
pub mod trajectory;

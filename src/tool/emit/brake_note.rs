//! The note on dwells at which closing the brakes saves energy.

use serde::Serialize;
use tera::{Context, Tera};

/// A dwell in the note.
#[derive(Clone, Debug, Serialize)]
pub struct BrakeDwell {
    /// File and line.
    pub place: String,
    /// s.
    pub duration: String,
    /// W.
    pub holding: String,
    /// s.
    pub break_even: String,
    /// J.
    pub potential: String,
}

/// The note with an optional configuration fragment.
///
/// # Errors
/// The template failed.
pub fn brake_note(
    robot: &str,
    dwells: &[BrakeDwell],
    break_even: &str,
) -> Result<String, tera::Error> {
    let mut context = Context::new();
    context.insert("robot", robot);
    context.insert("dwells", dwells);
    context.insert("break_even", break_even);
    Tera::one_off(include_str!("../../../templates/brakes.txt.tera"), &context, false)
}

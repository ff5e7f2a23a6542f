//! URDF files: the chain from the root to the flange as Robot TOML text.
//!
//! Fixed joints are merged: their transformations into the next joints, their masses into the
//! moving bodies that carry them.

mod bodies;
mod chain;
mod document;
mod elements;
mod write;

use super::error::RobotError;
use chain::Chain;
use document::Document;

/// The Robot TOML of a URDF; `file` is its name in messages and as source. An inertia that no body
/// has is replaced by the nearest one, and noted as assumed.
///
/// # Errors
/// An element that a [`Model`](super::Model) cannot represent, with its line.
pub fn import_urdf(file: &str, text: &str) -> Result<String, RobotError> {
    let document = Document::read(file, text)?;
    let chain = Chain::find(&document)?;
    let bodies = bodies::merged(&document, &chain)?;
    write::toml(&document, &chain, &bodies)
}

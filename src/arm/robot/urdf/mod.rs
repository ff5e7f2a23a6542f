//! URDF files: the chain from the root to the flange, as the text of a Robot TOML.
//!
//! Fixed joints are merged: their transformations into the joints behind them, the
//! masses behind them into the moving body that they are fixed to.

mod bodies;
mod chain;
mod document;
mod elements;
mod write;

use super::error::RobotError;
use chain::Chain;
use document::Document;

/// The Robot TOML of a URDF; `file` names it in messages and as the source.
///
/// # Errors
/// What a [`Model`](super::Model) cannot be made of, with its line.
pub fn import_urdf(file: &str, text: &str) -> Result<String, RobotError> {
    let document = Document::read(file, text)?;
    let chain = Chain::find(&document)?;
    let links = bodies::merged(&document, &chain)?;
    write::toml(&document, &chain, &links)
}

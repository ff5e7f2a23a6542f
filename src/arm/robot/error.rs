//! Errors of reading a robot.

use thiserror::Error;

/// Wrong input of a [`Model`](super::Model).
#[derive(Debug, Error)]
pub enum RobotError {
    /// The catalogue has no such robot.
    #[error(
        "unknown robot \"{name}\"{}; joulepath robots list shows the known ones; \
         or give a robot TOML or URDF file",
        .suggestion.as_ref().map_or(String::new(), |s| format!(", did you mean \"{s}\"?"))
    )]
    Unknown {
        /// As asked for.
        name: String,
        /// The nearest name of the catalogue, if one is near.
        suggestion: Option<String>,
    },
    /// A robot of which no lengths are published.
    #[error(
        "the geometry of the robot \"{name}\" is not published, so that the catalogue lacks it; give \
         a robot TOML or URDF file that has it"
    )]
    Unpublished {
        /// As asked for.
        name: String,
    },
    /// The name fits several robots.
    #[error("\"{name}\" fits several robots: {}; name one of them in full", .candidates.join(", "))]
    Ambiguous {
        /// As asked for.
        name: String,
        /// The robots it fits.
        candidates: Vec<String>,
    },
    /// A file could not be read.
    #[error("cannot read the robot file {path}: {reason}; check the path")]
    Io {
        /// Path as given.
        path: String,
        /// The system's reason.
        reason: String,
    },
    /// The robot that a file extends cannot be read.
    #[error("{place}: extends = \"{name}\": {reason}")]
    Base {
        /// `file:line`.
        place: String,
        /// As the file names it.
        name: String,
        /// Why, with the way out.
        reason: String,
    },
    /// The file's kind is not supported.
    #[error("{path} is no robot file; give a Robot TOML that ends in .toml or a URDF in .urdf")]
    Format {
        /// Path as given.
        path: String,
    },
    /// A URDF that no model can be made of.
    #[error("{place}: {message}")]
    Urdf {
        /// `file:line` of the element.
        place: String,
        /// What is wrong with it and the way out.
        message: String,
    },
    /// A controller's configuration without a usable robot.
    #[error("{place}: {message}")]
    Configuration {
        /// `file`, or `file:line`.
        place: String,
        /// What is wrong with it and the way out.
        message: String,
    },
    /// Not TOML.
    #[error("{place}: not valid TOML: {message}")]
    Syntax {
        /// `file:line`.
        place: String,
        /// The parser's message.
        message: String,
    },
    /// A key that no robot has.
    #[error("{place}: unknown key \"{key}\" in {table}; known keys: {}", .known.join(", "))]
    UnknownKey {
        /// `file:line`.
        place: String,
        /// The key.
        key: String,
        /// Its table.
        table: String,
        /// The keys of the table.
        known: Vec<String>,
    },
    /// A required key is missing.
    #[error(
        "{place}: {table} lacks \"{key}\"; {}",
        .instead.as_ref().map_or("add it".into(), |i| format!(
            "write \"{i}\" as \"{key}\", in SI units and radians"
        ))
    )]
    Missing {
        /// `file:line` of the table.
        place: String,
        /// The table.
        table: String,
        /// The missing key.
        key: String,
        /// A similar key of the table, if there is one.
        instead: Option<String>,
    },
    /// A value of another type than the key's.
    #[error("{place}: {key} is {found}; give {expected}")]
    Type {
        /// `file:line`.
        place: String,
        /// The key with its table.
        key: String,
        /// The value found.
        found: String,
        /// What is expected.
        expected: String,
    },
    /// A list of the wrong length.
    #[error("{place}: {key} has {found} entries; give {expected}")]
    Length {
        /// `file:line`.
        place: String,
        /// The key with its table.
        key: String,
        /// Entries found.
        found: usize,
        /// Entries expected, with the reason.
        expected: String,
    },
    /// A value that no robot can have.
    #[error("{place}: {key} = {value}, but it must be {must}")]
    Value {
        /// `file:line`.
        place: String,
        /// The key with its table.
        key: String,
        /// The value found.
        value: String,
        /// What it must be.
        must: String,
    },
    /// An effect whose law the model does not have.
    #[error(
        "{place}: no law for the effect \"{id}\"{}; remove [effects.{id}], laws are known of {}",
        .suggestion.as_ref().map_or(String::new(), |s| format!(", did you mean \"{s}\"?")),
        .known.join(", ")
    )]
    Effect {
        /// `file:line` of the table.
        place: String,
        /// Its id.
        id: String,
        /// The nearest known one, if one is near.
        suggestion: Option<String>,
        /// All known ones.
        known: Vec<String>,
    },
    /// `extends` leads too deep, probably in a circle.
    #[error("{place}: \"extends\" is nested more than {limit} deep; remove the circle")]
    Extends {
        /// `file:line`.
        place: String,
        /// The limit.
        limit: usize,
    },
}

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
        /// The requested name.
        name: String,
        /// A similar name of the catalogue.
        suggestion: Option<String>,
    },
    /// A robot without published lengths.
    #[error(
        "the catalogue does not contain the robot \"{name}\", because its geometry is not published; \
         give a robot TOML or URDF file"
    )]
    Unpublished {
        /// The requested name.
        name: String,
    },
    /// The name matches several robots.
    #[error("\"{name}\" fits several robots: {}; name one of them in full", .candidates.join(", "))]
    Ambiguous {
        /// The requested name.
        name: String,
        /// The matching robots.
        candidates: Vec<String>,
    },
    /// A file could not be read.
    #[error("cannot read the robot file {path}: {reason}; check the path")]
    Io {
        /// Path as given.
        path: String,
        /// Reason of the operating system.
        reason: String,
    },
    /// The robot that a file extends cannot be read.
    #[error("{place}: extends = \"{name}\": {reason}")]
    Base {
        /// `file:line`.
        place: String,
        /// Name in the file.
        name: String,
        /// Reason and remedy.
        reason: String,
    },
    /// The file type is not supported.
    #[error("{path} is no robot file; give a Robot TOML that ends in .toml or a URDF in .urdf")]
    Format {
        /// Path as given.
        path: String,
    },
    /// A URDF that cannot be converted to a model.
    #[error("{place}: {message}")]
    Urdf {
        /// `file:line` of the element.
        place: String,
        /// Error and remedy.
        message: String,
    },
    /// A controller configuration without a usable robot.
    #[error("{place}: {message}")]
    Configuration {
        /// `file`, or `file:line`.
        place: String,
        /// Error and remedy.
        message: String,
    },
    /// The file is not valid TOML.
    #[error("{place}: not valid TOML: {message}")]
    Syntax {
        /// `file:line`.
        place: String,
        /// Message of the parser.
        message: String,
    },
    /// An unknown key.
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
        /// A similar key of the table.
        instead: Option<String>,
    },
    /// A value of a wrong type.
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
    /// An implausible value.
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
    /// An effect without a law in the model.
    #[error(
        "{place}: the effect \"{id}\" is not known{}; correct it or remove [effects.{id}]; known effects: {}",
        .suggestion.as_ref().map_or(String::new(), |s| format!(", did you mean \"{s}\"?")),
        .known.join(", ")
    )]
    Effect {
        /// `file:line` of the table.
        place: String,
        /// Its id.
        id: String,
        /// A similar known id.
        suggestion: Option<String>,
        /// All known ids.
        known: Vec<String>,
    },
    /// `extends` is nested too deep, probably circular.
    #[error("{place}: \"extends\" is nested more than {limit} deep; remove the circle")]
    Extends {
        /// `file:line`.
        place: String,
        /// The limit.
        limit: usize,
    },
}

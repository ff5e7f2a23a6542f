//! `joulepath.toml`: what a cell needs to be told once.

mod lint;

pub use lint::Lint;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// Name of the file that is looked for.
pub const FILE_NAME: &str = "joulepath.toml";

/// The configuration. Unknown keys are errors.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Robot: a name of the catalogue or a file, relative to the configuration.
    pub robot: Option<String>,
    /// The routine that starts the program.
    pub entry: Option<String>,
    /// Time for the cycle, s.
    pub takt_s: Option<f64>,
    /// Least time between two points of a stream, s.
    pub spacing_s: Option<f64>,
    /// Seconds after which an input comes.
    #[serde(default)]
    pub inputs: BTreeMap<String, f64>,
    /// Levels of inputs that the program asks for.
    #[serde(default)]
    pub assume: BTreeMap<String, f64>,
    /// What arm and tool keep out of where a movement may leave its path.
    #[serde(default)]
    pub keep_out: Vec<KeepOut>,
    /// The linter.
    #[serde(default)]
    pub lint: Lint,
}

/// A part of the cell, in the robot's base frame, m.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "lowercase")]
pub enum KeepOut {
    /// A box along the axes of the base frame between two corners.
    Box([[f64; 3]; 2]),
    /// What lies beyond a plane: n · x < d, as n and d.
    Plane([f64; 4]),
}

/// A configuration that can't be used.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// It can't be read.
    #[error(
        "cannot read the configuration '{path}': {reason}; check the path, or leave --config out"
    )]
    Unreadable {
        /// Its path.
        path: String,
        /// Why.
        reason: String,
    },
    /// It is wrong.
    #[error(
        "{path}: {reason}; known keys are robot, entry, takt_s, spacing_s, [inputs], [assume], \
         [[keep_out]] with box or plane, and [lint]"
    )]
    Wrong {
        /// Its path.
        path: String,
        /// From the parser, with line and column.
        reason: String,
    },
}

/// Parses a configuration; `path` names it in messages.
///
/// # Errors
/// Wrong TOML, unknown keys, wrong types.
pub fn parse(path: &str, text: &str) -> Result<Config, ConfigError> {
    toml::from_str(text).map_err(|error| ConfigError::Wrong {
        path: path.to_owned(),
        reason: error.to_string().trim().to_owned(),
    })
}

/// The folders in which a configuration may lie for a program, nearest first.
pub fn candidates(program: &Path) -> Vec<PathBuf> {
    program.ancestors().map(|folder| folder.join(FILE_NAME)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_keys_are_named() {
        let error = parse("joulepath.toml", "robto = \"x\"").expect_err("unknown key");
        assert!(error.to_string().contains("robto"), "{error}");
        let config = parse("joulepath.toml", "robot = \"a\"\n[inputs]\ndiA = 2.5").expect("valid");
        assert_eq!(config.inputs["diA"], 2.5);
        let text = "[[keep_out]]\nbox = [[0, 0, 0], [1, 1, 1]]\n\
                    [[keep_out]]\nplane = [1, 0, 0, -0.8]\n";
        let config = parse("joulepath.toml", text).expect("valid");
        assert_eq!(config.keep_out[1], KeepOut::Plane([1.0, 0.0, 0.0, -0.8]));
    }
}

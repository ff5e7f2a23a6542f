//! `joulepath.toml`: the permanent settings of a cell.

mod lint;

pub use lint::Lint;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// Name of the configuration file.
pub const FILE_NAME: &str = "joulepath.toml";

/// The configuration. Unknown keys are errors.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Robot: a name of the catalogue or a file, relative to the configuration.
    pub robot: Option<String>,
    /// The routine that starts the program.
    pub entry: Option<String>,
    /// Cycle time, s.
    pub takt_s: Option<f64>,
    /// Hours in which the cell works in a year.
    pub hours_per_year: Option<f64>,
    /// Minimum time between two points of a stream, s.
    pub spacing_s: Option<f64>,
    /// Times of inputs, s.
    #[serde(default)]
    pub inputs: BTreeMap<String, f64>,
    /// Levels of inputs that the program asks for.
    #[serde(default)]
    pub assume: BTreeMap<String, f64>,
    /// Zones that arm and tool must avoid if a movement leaves its path.
    #[serde(default)]
    pub keep_out: Vec<KeepOut>,
    /// The linter.
    #[serde(default)]
    pub lint: Lint,
}

/// An obstacle in the robot's base frame, m.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "lowercase")]
pub enum KeepOut {
    /// A box with edges parallel to the axes, given by two corners.
    Box([[f64; 3]; 2]),
    /// The half-space n · x < d, given by n and d.
    Plane([f64; 4]),
}

/// An unusable configuration.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// It cannot be read.
    #[error(
        "cannot read the configuration '{path}': {reason}; check the path, or leave --config out"
    )]
    Unreadable {
        /// Its path.
        path: String,
        /// Why.
        reason: String,
    },
    /// Its content is wrong.
    #[error(
        "{path}: {reason}; known keys are robot, entry, takt_s, hours_per_year, spacing_s, [inputs], [assume], \
         [[keep_out]] with box or plane, and [lint]"
    )]
    Wrong {
        /// Its path.
        path: String,
        /// Message of the parser, with line and column.
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

/// The possible configuration files of a program, nearest first.
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

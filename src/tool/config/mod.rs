//! `joulepath.toml`: the permanent settings of a cell.

mod format;
mod idle;
mod lint;

pub use format::Format;
pub use idle::Idle;
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
    /// Idle states of the controller for the rest of the takt, by name.
    #[serde(default)]
    pub idle: BTreeMap<String, Idle>,
    /// Zones that arm and tool must avoid if a movement leaves its path.
    #[serde(default)]
    pub keep_out: Vec<KeepOut>,
    /// The linter.
    #[serde(default)]
    pub lint: Lint,
    /// The formatter.
    #[serde(default)]
    pub format: Format,
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
         [idle.NAME] with power_w, wake_s and wake_j, [[keep_out]] with box or plane, [lint], and [format]"
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
/// Wrong TOML, unknown keys, wrong types, idle states with impossible numbers.
pub fn parse(path: &str, text: &str) -> Result<Config, ConfigError> {
    let wrong = |reason: String| ConfigError::Wrong { path: path.to_owned(), reason };
    let config: Config =
        toml::from_str(text).map_err(|error| wrong(error.to_string().trim().to_owned()))?;
    let of_idle = config.idle.iter().find_map(|(name, idle)| idle.fault(name));
    match of_idle.or_else(|| config.format.fault()) {
        Some(fault) => Err(wrong(fault)),
        None => Ok(config),
    }
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

    #[test]
    fn styles_of_the_formatter_are_read_and_checked() {
        use crate::rapid::format::{Indent, KeywordCase, Style};
        let style = |text: &str| parse("joulepath.toml", text).expect("valid").format.style();
        assert_eq!(style(""), Style::default());
        let text = "[format]\nindent-width = 4\nkeyword-case = \"keep\"\nmax-blank-lines = 2";
        let expected =
            Style { indent: Indent::Spaces(4), keywords: KeywordCase::Keep, blank_lines: 2 };
        assert_eq!(style(text), expected);
        assert_eq!(style("[format]\nindent_style = \"tabs\"").indent, Indent::Tab);
        for wrong in
            ["indent-width = 0", "indent-width = 17", "max-blank-lines = 101", "indent = 2"]
        {
            let error = parse("joulepath.toml", &format!("[format]\n{wrong}")).expect_err(wrong);
            let key = wrong.split(' ').next().expect("a key");
            assert!(error.to_string().contains(key), "{error}");
        }
    }

    #[test]
    fn impossible_idle_states_are_refused() {
        let state = |numbers: &str| parse("joulepath.toml", &format!("[idle.sleep]\n{numbers}"));
        let config = state("power_w = 60\nwake_s = 4.5").expect("valid");
        assert_eq!(config.idle["sleep"], Idle { power_w: 60.0, wake_s: 4.5, wake_j: 0.0 });
        for (numbers, named) in [
            ("power_w = -1\nwake_s = 4", "[idle.sleep]: power_w = -1: give a number of W"),
            ("power_w = 60\nwake_s = inf", "[idle.sleep]: wake_s = inf: give a number of s"),
            ("power_w = 60\nwake_s = 4\nwake_j = nan", "wake_j = NaN: give a number of J"),
            ("power_w = 60", "missing field `wake_s`"),
            ("power_w = 60\nwake_s = 4\nwake = 3", "unknown field `wake`"),
        ] {
            let error = state(numbers).expect_err(numbers).to_string();
            assert!(error.contains(named), "{numbers}: {error}");
            assert!(error.contains("[idle.NAME] with power_w, wake_s and wake_j"), "{error}");
        }
    }
}

//! The section `[lint]` of the configuration.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::tool::lint::Settings;

/// Settings of the linter in a cell; keys accept `_` instead of `-`. Selectors are codes (`EW101`),
/// prefixes of codes (`EW1`), names or families.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Lint {
    /// Enabled rules; all by default.
    pub select: Option<Vec<String>>,
    /// Disabled rules.
    #[serde(default)]
    pub ignore: Vec<String>,
    /// Disabled rules by file pattern.
    #[serde(default, alias = "per_file_ignores")]
    pub per_file_ignores: BTreeMap<String, Vec<String>>,
    /// Minimum reported saving, J.
    #[serde(alias = "threshold_j")]
    pub threshold_j: Option<f64>,
    /// The same by rule or family, J.
    #[serde(default, alias = "thresholds_j")]
    pub thresholds_j: BTreeMap<String, f64>,
    /// Maximum waste, such as `500J` or `3%`.
    #[serde(alias = "max_waste")]
    pub max_waste: Option<String>,
    /// File with known findings that are not reported, relative to the configuration.
    pub baseline: Option<String>,
}

impl Lint {
    /// The settings of the linter.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let default = Settings::default();
        Settings {
            select: self.select.clone().unwrap_or(default.select),
            ignore: self.ignore.clone(),
            per_file_ignores: self.per_file_ignores.clone(),
            threshold_j: self.threshold_j.unwrap_or(default.threshold_j),
            thresholds_j: self.thresholds_j.clone(),
        }
    }
}

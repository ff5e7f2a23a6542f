//! `[lint]` of the configuration.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::tool::lint::Settings;

/// What a cell asks of the linter; `_` in a key is as good as `-`. Selectors are codes (`EW101`), starts of codes (`EW1`), names
/// or families.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Lint {
    /// Rules that run; all where nothing is said.
    pub select: Option<Vec<String>>,
    /// Rules that don't.
    #[serde(default)]
    pub ignore: Vec<String>,
    /// Rules that are not told in files that fit a pattern.
    #[serde(default, alias = "per_file_ignores")]
    pub per_file_ignores: BTreeMap<String, Vec<String>>,
    /// Least saving that is told, J.
    #[serde(alias = "threshold_j")]
    pub threshold_j: Option<f64>,
    /// The same by rule or family, J.
    #[serde(default, alias = "thresholds_j")]
    pub thresholds_j: BTreeMap<String, f64>,
    /// What may be wasted, such as `500J` or `3%`.
    #[serde(alias = "max_waste")]
    pub max_waste: Option<String>,
    /// File of findings that are known and not told, beside the configuration.
    pub baseline: Option<String>,
}

impl Lint {
    /// What the linter needs of it.
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

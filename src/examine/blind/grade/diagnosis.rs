//! The graded part of a diagnosis.

use serde::Deserialize;
use serde_json::{Map, Value};
use thiserror::Error;

/// A diagnosis that can't be graded.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "{case}: the diagnosis can't be read ({reason}): write it again with diagnose --format json"
)]
pub struct DiagnosisError {
    /// The case.
    pub case: String,
    /// Cause.
    pub reason: String,
}

/// The graded part of the JSON output of `diagnose`.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Diagnosis {
    pub(super) verdict: Verdict,
    pub(super) effects: Vec<NamedEffect>,
    #[serde(default)]
    pub(super) candidates: Vec<NamedEffect>,
    #[serde(default, rename = "where")]
    places: Vec<Place>,
    #[serde(default)]
    gap: Vec<Gap>,
}

/// The verdict.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "snake_case")]
pub(super) enum Verdict {
    NoGap,
    ParametersOnly,
    Effect,
    Partial,
    Unknown,
    NotSeparable,
    NotExcited,
}

impl Verdict {
    pub(super) fn name(self) -> &'static str {
        match self {
            Verdict::NoGap => "no_gap",
            Verdict::ParametersOnly => "parameters_only",
            Verdict::Effect => "effect",
            Verdict::Partial => "partial",
            Verdict::Unknown => "unknown",
            Verdict::NotSeparable => "not_separable",
            Verdict::NotExcited => "not_excited",
        }
    }

    /// Whether the verdict is an abstention.
    pub(super) fn abstains(self) -> bool {
        matches!(
            self,
            Verdict::Partial | Verdict::Unknown | Verdict::NotSeparable | Verdict::NotExcited
        )
    }
}

/// A diagnosed effect.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct NamedEffect {
    pub(super) id: String,
    #[serde(default)]
    pub(super) joints: Vec<usize>,
    #[serde(default)]
    class: Vec<String>,
    #[serde(default)]
    pub(super) probability: Option<f64>,
    #[serde(default)]
    pub(super) evidence_probability: Option<f64>,
    #[serde(default)]
    parameters: Map<String, Value>,
}

#[derive(Clone, Debug, Deserialize)]
struct Place {
    #[serde(default)]
    joint: Option<usize>,
    #[serde(default)]
    line: Option<usize>,
    #[serde(default)]
    share_percent: Option<f64>,
}

#[derive(Clone, Debug, Deserialize)]
struct Gap {
    #[serde(default)]
    channel: String,
    #[serde(default)]
    shrink_percent: Option<Interval>,
}

/// A value with its 95 % interval.
#[derive(Clone, Copy, Debug, Deserialize)]
struct Interval {
    value: Option<f64>,
}

impl Diagnosis {
    /// Reads the diagnosis of a case.
    ///
    /// # Errors
    /// A graded field is missing or has another type.
    pub(super) fn read(case: &str, value: &Value) -> Result<Diagnosis, DiagnosisError> {
        Diagnosis::deserialize(value)
            .map_err(|error| DiagnosisError { case: case.into(), reason: error.to_string() })
    }

    /// The diagnosed effects, without link parameters.
    pub(super) fn named(&self) -> impl Iterator<Item = &NamedEffect> {
        self.effects.iter().filter(|said| said.id != "link_parameters")
    }

    /// The joint with the largest share.
    pub(super) fn place(&self) -> Option<usize> {
        let mut joints: Vec<usize> = self.places.iter().filter_map(|place| place.joint).collect();
        joints.sort_unstable();
        joints.dedup();
        let share = |joint: usize| -> f64 {
            let of_joint = self.places.iter().filter(|place| place.joint == Some(joint));
            of_joint.filter_map(|place| place.share_percent).sum()
        };
        // The lower number of equal joints.
        joints.into_iter().rev().max_by(|a, b| share(*a).total_cmp(&share(*b)))
    }

    /// The stated lines.
    pub(super) fn lines(&self) -> impl Iterator<Item = usize> {
        self.places.iter().filter_map(|place| place.line)
    }

    /// The claimed reduction of the torque gap \[1\].
    pub(super) fn shrink(&self) -> Option<f64> {
        let torque = self.gap.iter().find(|gap| gap.channel == "torque")?;
        Some(torque.shrink_percent?.value? / 100.0)
    }
}

impl NamedEffect {
    /// All ids of its equivalence class.
    pub(super) fn ids(&self) -> Vec<&str> {
        let mut ids = vec![self.id.as_str()];
        ids.extend(self.class.iter().map(String::as_str).filter(|id| *id != self.id));
        ids
    }

    /// Value and standard deviation of a parameter, of a joint (from 1) if there are several.
    pub(super) fn parameter(&self, name: &str, joint: Option<usize>) -> Option<[f64; 2]> {
        let of_joint = joint.and_then(|joint| self.parameters.get(&format!("{name}_j{joint}")));
        let found = of_joint.or_else(|| self.parameters.get(name))?;
        Some([found.get("value")?.as_f64()?, found.get("sd")?.as_f64()?])
    }
}

//! What a decision rests on: one entry for each gate that a hypothesis had to pass.

use serde::Serialize;

/// A gate, in the order in which they are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Gate {
    /// Evidence of the effect beside the others \[nats\], at least.
    Evidence,
    /// Evidence of a joint of the effect \[nats\], at least.
    JointEvidence,
    /// Share of the effect in a joint's torque \[1\], at least.
    Size,
    /// Deviations by which the law differs from 0, whatever its shape \[1\], at least.
    Significance,
    /// Share of the effect beside the largest one at the joint with which it may be confused
    /// \[1\], at least.
    Form,
    /// Standard deviations by which a parameter is beyond what is possible \[1\], at most.
    Bounds,
    /// Standard deviations of what any robot has of the parameter \[1\], at least.
    Everyday,
    /// Noise of the joint over that of the baseline \[1\], at most.
    Noise,
    /// What the effect leaves of the gap in the held-out data \[1\], at most.
    HeldOut,
    /// Torque that nothing explains, of the joint's torque \[1\], at most.
    Unexplained,
    /// Effects that the logs cannot tell from this one, itself included, at most.
    Class,
    /// Evidence that the effect came after the baseline, and was not there already \[nats\], at least.
    Since,
    /// Deviations of the effect from what it is in the baseline, or from 0, by how much it differs from log
    /// to log \[1\], at least.
    Logs,
}

/// The answer of a gate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// What is asked about: an effect, with its joint (from 1) where the gate is about one.
    pub hypothesis: String,
    /// The gate.
    pub gate: Gate,
    /// The value.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Whether it passed.
    pub passed: bool,
}

impl Gate {
    /// Whether values have to be at most the limit; otherwise at least.
    #[must_use]
    pub fn is_upper(self) -> bool {
        match self {
            Gate::Evidence
            | Gate::JointEvidence
            | Gate::Size
            | Gate::Significance
            | Gate::Form
            | Gate::Everyday
            | Gate::Since
            | Gate::Logs => false,
            Gate::Bounds | Gate::Noise | Gate::HeldOut | Gate::Unexplained | Gate::Class => true,
        }
    }

    /// What its value is.
    #[must_use]
    pub fn what(self) -> &'static str {
        match self {
            Gate::Evidence => "evidence, nats",
            Gate::JointEvidence => "evidence of the joint, nats",
            Gate::Size => "share of the joint's torque",
            Gate::Significance => "deviations of the law from 0",
            Gate::Form => "size beside a law that it may be a form of",
            Gate::Everyday => "deviations of what any robot has",
            Gate::Bounds => "deviations beyond what is possible",
            Gate::Noise => "noise over that of the baseline",
            Gate::HeldOut => "what is left of the gap in the held-out data",
            Gate::Unexplained => "share of the torque that nothing explains",
            Gate::Class => "effects that the logs cannot tell apart",
            Gate::Since => "evidence that it came after the baseline, nats",
            Gate::Logs => "deviations by which it differs from log to log",
        }
    }

    /// The answer for a value.
    #[must_use]
    pub fn of(self, hypothesis: String, value: f64, limit: f64) -> Entry {
        let passed = if self.is_upper() { value <= limit } else { value >= limit };
        Entry { hypothesis, gate: self, value, limit, passed }
    }
}

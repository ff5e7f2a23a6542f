//! The score of one case.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use super::super::label::{Kind, Label, Truth};
use super::diagnosis::{Diagnosis, NamedEffect, Verdict};

/// Least detectability of a graded effect \[nats\].
pub(super) const DETECTABLE_NATS: f64 = 10.0;
/// Largest number of ids in a class that counts as an answer.
const LARGEST_CLASS: usize = 5;
/// Least share of the gap of one joint for grading the place.
const CLEAR_SHARE: f64 = 0.5;
/// Largest accepted error of a parameter in standard deviations.
const PARAMETER_SD: f64 = 3.0;
/// Parameters of which a turn more is the same.
const ANGLES: [&str; 3] = ["phase", "direction", "azimuth"];

/// What is said of an effect, and whether it is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// Whether it is asserted; else it is only considered.
    pub is_asserted: bool,
    /// Its probability by the evidence alone.
    pub evidence: f64,
    /// Whether it is there.
    pub is_there: bool,
}

/// Outcome of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Outcome {
    RightName,
    RightClass,
    /// Some of several effects, without wrong ones.
    SomeRight,
    WrongName,
    /// No effect was named.
    Verdict(Verdict),
}

impl Outcome {
    pub(super) fn name(self) -> &'static str {
        match self {
            Outcome::RightName => "right_name",
            Outcome::RightClass => "right_class",
            Outcome::SomeRight => "some_right",
            Outcome::WrongName => "wrong_name",
            Outcome::Verdict(verdict) => verdict.name(),
        }
    }

    /// Whether an effect was named.
    pub(super) fn names(self) -> bool {
        !matches!(self, Outcome::Verdict(_))
    }
}

/// Score of a case; `None` for properties that are not graded.
#[derive(Clone, Debug)]
pub(super) struct Score {
    pub(super) kind: Kind,
    pub(super) detectable: bool,
    pub(super) outcome: Outcome,
    pub(super) joints: Option<bool>,
    pub(super) place: Option<bool>,
    pub(super) line: Option<bool>,
    pub(super) parameters: Vec<bool>,
    /// Probability of each named effect, and whether it is present.
    pub(super) probabilities: Vec<(f64, bool)>,
    /// Claimed reduction over that of an oracle with the model error only.
    pub(super) of_oracle: Option<f64>,
    pub(super) said: String,
}

impl Score {
    /// Whether exactly the true effects were named, possibly as a class.
    pub(super) fn is_right(&self) -> bool {
        matches!(self.outcome, Outcome::RightName | Outcome::RightClass)
    }

    pub(super) fn is_wrong(&self) -> bool {
        self.outcome == Outcome::WrongName
    }

    /// Whether the diagnosis abstains from naming an effect.
    pub(super) fn abstains(&self) -> bool {
        matches!(self.outcome, Outcome::Verdict(verdict) if verdict.abstains())
    }
}

/// The effects that are to be found.
fn truths(label: &Label) -> Vec<&Truth> {
    match label.kind {
        Kind::One | Kind::Two | Kind::Power | Kind::Motion => label.effects.iter().collect(),
        Kind::Healthy | Kind::ParametersOnly | Kind::Outside => Vec::new(),
    }
}

/// What a diagnosis says of each effect that it asserts or considers.
pub(super) fn stated(label: &Label, diagnosis: &Diagnosis) -> Vec<Stated> {
    let truths = truths(label);
    let list = |all: &[NamedEffect], is_asserted: bool| -> Vec<Stated> {
        let known = all.iter().filter(|said| said.id != "link_parameters");
        let one = |said: &NamedEffect| {
            let is_there = truths.iter().any(|truth| accepts(truth, said));
            Some(Stated { is_asserted, evidence: said.evidence_probability?, is_there })
        };
        known.filter_map(one).collect()
    };
    let mut both = list(&diagnosis.effects, true);
    both.extend(list(&diagnosis.candidates, false));
    both
}

/// Scores a case.
pub(super) fn score(label: &Label, diagnosis: &Diagnosis) -> Score {
    let truths = truths(label);
    let named: Vec<&NamedEffect> = diagnosis.named().collect();
    let found = |truth: &Truth| named.iter().copied().find(|said| accepts(truth, said));
    let wrong = named.iter().any(|said| !truths.iter().any(|truth| accepts(truth, said)));
    let right: Vec<(&Truth, &NamedEffect)> =
        truths.iter().filter_map(|truth| Some((*truth, found(truth)?))).collect();
    let all_right = !truths.is_empty() && right.len() == truths.len();
    let by_name = right.iter().all(|(truth, said)| {
        said.ids().len() == 1 && (said.id == truth.id || truth.equivalents.contains(&said.id))
    });
    let outcome = if wrong {
        Outcome::WrongName
    } else if named.is_empty() {
        Outcome::Verdict(diagnosis.verdict)
    } else if !all_right {
        Outcome::SomeRight
    } else if by_name {
        Outcome::RightName
    } else {
        Outcome::RightClass
    };
    let detectable = !label.effects.is_empty()
        && label.effects.iter().all(|truth| truth.nats >= DETECTABLE_NATS);
    let mut at_joints = right.iter().filter(|(truth, _)| !truth.joints.is_empty()).peekable();
    let joints = (right.len() == truths.len() && at_joints.peek().is_some())
        .then(|| at_joints.all(|(truth, said)| same_joints(truth, said)));
    let clear = label.place.filter(|_| label.share.is_some_and(|share| share >= CLEAR_SHARE));
    let place = clear
        .filter(|_| !truths.is_empty() && !named.is_empty())
        .map(|joint| diagnosis.place() == Some(joint));
    let line = (!label.lines.is_empty())
        .then(|| diagnosis.lines().any(|line| label.lines.contains(&line)));
    let parameters = right
        .iter()
        .filter(|(truth, said)| truth.nats >= DETECTABLE_NATS && said.id == truth.id)
        .flat_map(|(truth, said)| within(truth, said))
        .collect();
    let probabilities = named
        .iter()
        .filter_map(|said| {
            let there = truths.iter().any(|truth| accepts(truth, said));
            Some((said.probability?, there))
        })
        .collect();
    Score {
        kind: label.kind,
        detectable,
        outcome,
        joints,
        place,
        line,
        parameters,
        probabilities,
        of_oracle: of_oracle(label, diagnosis),
        said: said(&named, diagnosis),
    }
}

/// Whether a diagnosed effect matches the truth by its name or its class.
fn accepts(truth: &Truth, said: &NamedEffect) -> bool {
    let ids = said.ids();
    ids.len() <= LARGEST_CLASS
        && ids.iter().any(|id| *id == truth.id || truth.equivalents.iter().any(|other| other == id))
}

/// A wrist coupling may be diagnosed at one of its joints; otherwise the joints have to be equal.
fn same_joints(truth: &Truth, said: &NamedEffect) -> bool {
    let set = |joints: &[usize]| joints.iter().copied().collect::<BTreeSet<usize>>();
    let (there, told) = (set(&truth.joints), set(&said.joints));
    if truth.id == "wrist_coupling" {
        return !told.is_empty() && told.is_subset(&there);
    }
    there == told
}

/// Whether each graded parameter is within its tolerance: one without a deviation has to be exact.
fn within(truth: &Truth, said: &NamedEffect) -> Vec<bool> {
    let graded = truth.parameters.iter().filter(|parameter| parameter.graded);
    graded
        .filter_map(|parameter| match said.parameter(&parameter.name, parameter.joint) {
            Some([value, sd]) => {
                let mut missed = value - parameter.value;
                if ANGLES.contains(&parameter.name.as_str()) {
                    missed = (missed + PI).rem_euclid(TAU) - PI;
                }
                Some(missed.abs() <= PARAMETER_SD * sd)
            }
            // A zero parameter may be missing.
            None if parameter.value == 0.0 => None,
            None => Some(false),
        })
        .collect()
}

/// Claimed reduction of the torque gap, over that of an oracle with the model error only.
fn of_oracle(label: &Label, diagnosis: &Diagnosis) -> Option<f64> {
    let (mut model, mut left) = (0.0, 0.0);
    for joint in label.heldout.iter().filter(|joint| joint.torque > 0.0) {
        model += (joint.model / joint.torque).powi(2);
        left += (joint.left / joint.torque).powi(2);
    }
    let oracle = 1.0 - (left / model).sqrt();
    (oracle.is_finite() && oracle > 0.0)
        .then_some(oracle)
        .and_then(|oracle| Some(diagnosis.shrink()? / oracle))
}

fn said(named: &[&NamedEffect], diagnosis: &Diagnosis) -> String {
    if named.is_empty() {
        return diagnosis.verdict.name().into();
    }
    named.iter().map(|said| said.ids().join("|")).collect::<Vec<_>>().join(" + ")
}

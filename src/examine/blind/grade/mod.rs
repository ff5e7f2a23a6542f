//! Grades of diagnoses against the opened labels.

mod diagnosis;
mod score;
mod wilson;

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::label::{Kind, Label};
use diagnosis::Diagnosis;
use score::{Score, score};

pub use diagnosis::DiagnosisError;
pub use score::Stated;

/// Value of `left_out`: for each case with one torque effect, the library lacks that effect and all
/// similar ones.
pub const FAMILY: &str = "family";
/// Edges of the probability bins.
const BINS: [f64; 8] = [0.0, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 1.0];

/// The result of an examination.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grades {
    /// Number of graded cases.
    pub cases: usize,
    /// Number of cases with undetectable effects.
    pub undetectable: usize,
    /// Effect that the library lacked, if any.
    pub left_out: Option<String>,
    /// Confusion table: for each true fault, the number of each outcome; detectable faults only.
    pub confusion: BTreeMap<String, BTreeMap<&'static str, usize>>,
    /// Graded rates.
    pub rates: Vec<Rate>,
    /// Stated probabilities and observed frequencies.
    pub reliability: Vec<Bin>,
    /// Median ratio of the claimed reduction to an oracle's, for single detectable effects.
    pub shrink_of_oracle: Option<f64>,
    /// Cases with wrong diagnoses.
    pub wrong: Vec<Wrong>,
}

/// Observed rate of a property.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// The property.
    pub name: &'static str,
    /// Number of cases with the property.
    pub hits: usize,
    /// Number of relevant cases.
    pub of: usize,
    /// `hits` over `of`; `None` without cases.
    pub rate: Option<f64>,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Required bound.
    pub asked: Asked,
}

/// Required bound of a rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Asked {
    /// Upper bound.
    AtMost(f64),
    /// Lower bound.
    AtLeast(f64),
}

/// Effects with stated probabilities in an interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// Lower end of the interval.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Mean stated probability.
    pub stated: f64,
    /// Number of effects that are present.
    pub hits: usize,
    /// Number of all effects in the bin.
    pub of: usize,
    /// Lower end of the 95 % interval of `hits` over `of`.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Bin {
    /// A bin with `of` effects, of which `hits` are present.
    #[must_use]
    pub fn new([from, to]: [f64; 2], stated: f64, hits: usize, of: usize) -> Bin {
        let [low, high] = wilson::interval(hits, of);
        Bin { from, to, stated, hits, of, low, high }
    }
}

/// A case with a wrong diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wrong {
    /// The case.
    pub case: String,
    /// True fault.
    pub truth: String,
    /// Diagnosis.
    pub said: String,
}

/// Grades diagnoses, each in the JSON of `diagnose` and in the order of `labels`. With `left_out`,
/// an effect that the library lacked, only its cases are graded: the expected answer is unknown, or
/// a class of effects indistinguishable from it. [`FAMILY`] selects all cases with one torque
/// effect.
///
/// # Errors
/// A diagnosis has an unexpected shape.
pub fn grade(
    labels: &[Label],
    diagnoses: &[Value],
    left_out: Option<&str>,
) -> Result<Grades, DiagnosisError> {
    let mut confusion: BTreeMap<String, BTreeMap<&'static str, usize>> = BTreeMap::new();
    let mut scores = Vec::new();
    let mut wrong = Vec::new();
    for (label, diagnosis) in labels.iter().zip(diagnoses) {
        if left_out.is_some_and(|id| !is_of(label, id)) {
            continue;
        }
        let score = score(label, &Diagnosis::read(&label.case, diagnosis)?);
        let truth = truth(label);
        if score.detectable || label.effects.is_empty() {
            let row = confusion.entry(truth.clone()).or_default();
            *row.entry(score.outcome.name()).or_default() += 1;
        }
        if score.is_wrong() {
            wrong.push(Wrong { case: label.case.clone(), truth, said: score.said.clone() });
        }
        scores.push(score);
    }
    let rates = match left_out {
        Some(_) => left_out_rates(&scores),
        None => rates(&scores),
    };
    Ok(Grades {
        cases: scores.len(),
        undetectable: scores.len() - confusion.values().flat_map(BTreeMap::values).sum::<usize>(),
        left_out: left_out.map(str::to_owned),
        confusion,
        rates,
        reliability: reliability(&scores),
        shrink_of_oracle: median(single(&scores).filter_map(|score| score.of_oracle).collect()),
        wrong,
    })
}

/// What a diagnosis says of each effect that it asserts or considers, and whether it is there.
///
/// # Errors
/// The diagnosis has an unexpected shape.
pub fn stated(label: &Label, diagnosis: &Value) -> Result<Vec<Stated>, DiagnosisError> {
    Ok(score::stated(label, &Diagnosis::read(&label.case, diagnosis)?))
}

/// Whether a case has this effect alone; [`FAMILY`] accepts any torque effect.
#[must_use]
pub fn is_of(label: &Label, id: &str) -> bool {
    match label.kind {
        Kind::One if id == FAMILY => true,
        Kind::One | Kind::Power | Kind::Motion => label.effects.iter().any(|truth| truth.id == id),
        Kind::Healthy | Kind::ParametersOnly | Kind::Two | Kind::Outside => false,
    }
}

/// Row name in the confusion table.
fn truth(label: &Label) -> String {
    match label.kind {
        Kind::One | Kind::Power | Kind::Motion => {
            label.effects.first().map_or_else(String::new, |truth| truth.id.clone())
        }
        kind => format!("({})", kind.name()),
    }
}

/// Cases with one detectable effect.
fn single(scores: &[Score]) -> impl Iterator<Item = &Score> {
    scores.iter().filter(|score| {
        score.detectable && matches!(score.kind, Kind::One | Kind::Power | Kind::Motion)
    })
}

fn rates(scores: &[Score]) -> Vec<Rate> {
    use Asked::{AtLeast, AtMost};
    let of_kind = |kind: Kind| scores.iter().filter(move |score| score.kind == kind);
    let named = |kind: Kind| of_kind(kind).map(|score| score.outcome.names());
    let one = || single(scores);
    let two = || of_kind(Kind::Two).filter(|score| score.detectable);
    let outside = of_kind(Kind::Outside).filter(|score| score.detectable);
    let parameters = scores.iter().flat_map(|score| score.parameters.iter().copied());
    vec![
        rate("healthy_named", AtMost(0.02), named(Kind::Healthy)),
        rate("parameters_only_named", AtMost(0.02), named(Kind::ParametersOnly)),
        rate("one_right_or_class", AtLeast(0.92), one().map(Score::is_right)),
        rate("one_wrong_name", AtMost(0.02), one().map(Score::is_wrong)),
        rate("one_joints", AtLeast(0.90), one().filter_map(|score| score.joints)),
        rate("one_place", AtLeast(0.90), one().filter_map(|score| score.place)),
        rate("line", AtLeast(0.90), one().filter_map(|score| score.line)),
        rate("parameters_within_3_sd", AtLeast(0.93), parameters),
        rate("two_both", AtLeast(0.70), two().map(Score::is_right)),
        rate("two_wrong_name", AtMost(0.03), two().map(Score::is_wrong)),
        rate("outside_abstains", AtLeast(0.95), outside.map(Score::abstains)),
    ]
}

fn left_out_rates(scores: &[Score]) -> Vec<Rate> {
    use Asked::{AtLeast, AtMost};
    let unknown_or_class = single(scores).map(|score| score.abstains() || score.is_right());
    vec![
        rate("left_out_unknown_or_class", AtLeast(0.92), unknown_or_class),
        rate("left_out_wrong_name", AtMost(0.08), single(scores).map(Score::is_wrong)),
    ]
}

fn rate(name: &'static str, asked: Asked, answers: impl Iterator<Item = bool>) -> Rate {
    let answers: Vec<bool> = answers.collect();
    let (hits, of) = (answers.iter().filter(|hit| **hit).count(), answers.len());
    let [low, high] = wilson::interval(hits, of);
    let rate = (of > 0).then(|| hits as f64 / of as f64);
    Rate { name, hits, of, rate, low, high, asked }
}

impl Rate {
    /// Whether the bound holds; `None` without cases.
    #[must_use]
    pub fn met(&self) -> Option<bool> {
        self.rate.map(|rate| match self.asked {
            Asked::AtMost(most) => rate <= most,
            Asked::AtLeast(least) => rate >= least,
        })
    }
}

fn reliability(scores: &[Score]) -> Vec<Bin> {
    let all: Vec<(f64, bool)> =
        scores.iter().flat_map(|score| score.probabilities.iter().copied()).collect();
    let last = BINS.len() - 2;
    (0..=last)
        .map(|i| {
            let (from, to) = (BINS[i], BINS[i + 1]);
            let within: Vec<&(f64, bool)> = all
                .iter()
                .filter(|(p, _)| *p >= from && (*p < to || i == last && *p <= to))
                .collect();
            let of = within.len();
            let hits = within.iter().filter(|(_, hit)| *hit).count();
            let stated = within.iter().map(|(p, _)| p).sum::<f64>() / of.max(1) as f64;
            Bin::new([from, to], stated, hits, of)
        })
        .collect()
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { f64::midpoint(values[middle - 1], upper) })
}

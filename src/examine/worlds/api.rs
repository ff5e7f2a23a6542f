//! A case of a world, and the evidence that is expected of its faults.

use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};

use super::model::{MAX, Row};
use super::random::Rng;
pub(super) use crate::examine::blind::{HeldOut, Kind, Truth};

/// Kinds and their shares.
const KINDS: [(Kind, f64); 7] = [
    (Kind::Healthy, 0.2),
    (Kind::ParametersOnly, 0.06),
    (Kind::One, 0.34),
    (Kind::Two, 0.1),
    (Kind::Outside, 0.12),
    (Kind::Power, 0.08),
    (Kind::Motion, 0.1),
];

/// The kind of a case; a case of motion may turn out healthy.
pub(super) fn kind(seed: u64, number: usize) -> Kind {
    KINDS[Rng::stream(seed, number, "kind").weighted(&KINDS.map(|kind| kind.1))].0
}

/// What a world makes of a seed and a number: the same arguments give the same bytes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case {
    /// Names in the folder of the case, and contents.
    pub(super) files: Vec<(String, String)>,
    /// Options of the diagnosis: [`options`].
    pub(super) options: Value,
    pub(super) kind: Kind,
    /// The faults.
    pub(super) effects: Vec<Truth>,
    /// The joint, from 1, with the largest share of the gap due to the faults, and that share.
    pub(super) place: Option<(usize, f64)>,
    /// RAPID lines at which a motion fault appears; may be empty.
    pub(super) lines: Vec<usize>,
    /// The gap of the nominal model on the held-out log, by joint.
    pub(super) heldout: Vec<HeldOut>,
}

impl Case {
    /// A case in which nothing is wrong; the robot's file is the first.
    pub(super) fn new(files: Vec<(String, String)>, options: Value, kind: Kind) -> Self {
        let (effects, lines, heldout) = (Vec::new(), Vec::new(), Vec::new());
        Self { files, options, kind, effects, place: None, lines, heldout }
    }
}

/// Expected log-likelihood ratio \[nats\] of a fault, `½ Δᵀ(Σ + BBᵀ)⁻¹Δ`.
///
/// By joint: `delta` is what the fault changes in the mean of the repetitions, all logs behind one
/// another; `sd` the standard deviation of one row of that mean (noise and everyday error);
/// `columns` what one standard deviation of each nuisance changes (parameters of the model; they
/// are shared by the joints). Some hundred rows per joint are enough, and `sd` is that of these.
pub(super) fn nats(delta: &[Vec<f64>], sd: &[f64], columns: &[Vec<Vec<f64>>]) -> f64 {
    let count = columns.len();
    let mut gram = DMatrix::<f64>::identity(count, count);
    let mut projected = DVector::<f64>::zeros(count);
    let mut squares = 0.0;
    for (joint, rows) in delta.iter().enumerate() {
        let weight = 1.0 / (sd[joint] * sd[joint]).max(1e-18);
        squares += weight * rows.iter().map(|x| x * x).sum::<f64>();
        let block = DMatrix::from_fn(rows.len(), count, |row, k| columns[k][joint][row]);
        let rows = DVector::from_column_slice(rows);
        gram += weight * block.tr_mul(&block);
        projected += weight * block.tr_mul(&rows);
    }
    let told = gram.cholesky().map_or(0.0, |factor| projected.dot(&factor.solve(&projected)));
    0.5 * (squares - told).max(0.0)
}

/// Options of the diagnosis: the robot's file, the trust in it, and the period \[s\] if it is told. Logs
/// have the names `log-1.csv` …, `heldout.csv`, `baseline-1.csv` …
pub(super) fn options(robot: &str, trust: &str, period: Option<f64>) -> Value {
    match period {
        Some(period) => json!({ "robot": robot, "trust": trust, "period": period }),
        None => json!({ "robot": robot, "trust": trust }),
    }
}

/// Options of a case with a program in the folder `program`.
pub(super) fn program_options(robot: &str, trust: &str) -> Value {
    json!({ "robot": robot, "trust": trust, "program": "program" })
}

/// Name of the program's module in the folder of a case.
pub(super) const MODULE: &str = "program/MainModule.mod";

/// The joint, from 1, with the largest of some squared torques, and its share of their sum.
pub(super) fn largest(squares: &[f64]) -> Option<(usize, f64)> {
    let whole: f64 = squares.iter().sum();
    let best = squares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (whole > 0.0).then(|| (best.0 + 1, best.1 / whole))
}

/// Rms values of `n` joints: torque, residual of the model, contribution of the faults, everyday
/// error.
pub(super) fn held_out(n: usize, [torque, model, effects, left]: [&Row; 4]) -> Vec<HeldOut> {
    let one = |i: usize| HeldOut {
        joint: i + 1,
        torque: torque[i],
        model: model[i],
        effects: effects[i],
        left: left[i],
    };
    (0..n).map(one).collect()
}

/// Root mean squares of rows.
pub(super) fn rms(rows: impl Iterator<Item = Row>) -> Row {
    let (mut squares, mut count) = ([0.0; MAX], 0.0_f64);
    for row in rows {
        for (square, value) in squares.iter_mut().zip(row) {
            *square += value * value;
        }
        count += 1.0;
    }
    squares.map(|square| (square / count.max(1.0)).sqrt())
}

/// Difference of two rows.
pub(super) fn minus(a: &Row, b: &Row) -> Row {
    std::array::from_fn(|i| a[i] - b[i])
}

/// A row with one value.
pub(super) fn single(joint: usize, value: f64) -> Row {
    let mut row = [0.0; MAX];
    row[joint] = value;
    row
}

/// Rows by joint, of `n` joints.
pub(super) fn by_joint(n: usize, rows: &[Row]) -> Vec<Vec<f64>> {
    (0..n).map(|i| rows.iter().map(|row| row[i]).collect()).collect()
}

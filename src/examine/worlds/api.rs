//! What every world returns: a case with its files and the truth.

use serde::{Deserialize, Serialize};

/// Kind of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The robot differs from its model within the usual spread.
    Healthy,
    /// Bodies differ: a change of parameters only.
    ParametersOnly,
    /// One torque effect.
    One,
    /// Two torque effects.
    Two,
    /// A fault without a corresponding effect in the library.
    Outside,
    /// One power effect.
    Power,
    /// One motion effect.
    Motion,
}

/// A fault.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Effect id; `outside` for a fault without an effect.
    pub id: String,
    /// Functional form of its law.
    pub form: String,
    /// Joints, from 1; empty for a fault of the whole arm.
    pub joints: Vec<usize>,
    /// Its parameters.
    pub parameters: Vec<TrueParameter>,
    /// Interval within each period in which it acts \[s\].
    pub window: Option<[f64; 2]>,
    /// Effects with exactly the same torques in this case.
    pub equivalents: Vec<String>,
    /// Expected log-likelihood ratio \[nats\] of the fault: [`nats`].
    pub nats: f64,
}

/// A parameter of a fault.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueParameter {
    /// Name as in a diagnosis.
    pub name: String,
    /// Joint, from 1.
    pub joint: Option<usize>,
    /// Value in SI units.
    pub value: f64,
    /// Whether it has the same meaning in every form of the law.
    pub graded: bool,
}

/// Rms torques of the held-out log without noise \[Nm\].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldOut {
    /// Joint, from 1.
    pub joint: usize,
    /// Torque.
    pub torque: f64,
    /// Residual of the nominal model.
    pub model: f64,
    /// Contribution of the faults.
    pub effects: f64,
    /// The everyday error: what a robot without faults, whose parameters are known exactly, differs
    /// from its model.
    pub left: f64,
}

/// A case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Names in the folder of the case, and contents.
    pub files: Vec<(String, String)>,
    /// Options of the diagnosis: `robot` (file), `trust`, perhaps `period`, `program`, and the
    /// file names `log`, `heldout`, `baseline` (lists).
    pub options: serde_json::Value,
    /// Kind.
    pub kind: Kind,
    /// The faults.
    pub effects: Vec<Truth>,
    /// The joint, from 1, with the largest share of the gap due to the faults, and that share.
    pub place: Option<(usize, f64)>,
    /// RAPID lines at which a motion fault appears; may be empty.
    pub lines: Vec<usize>,
    /// The gap of the nominal model on the held-out log, by joint.
    pub heldout: Vec<HeldOut>,
}

/// Expected log-likelihood ratio \[nats\] of a fault, `½ Δᵀ(Σ + BBᵀ)⁻¹Δ`.
///
/// By joint: `delta` is what the fault changes in the mean of the repetitions, all logs behind one
/// another; `sd` the standard deviation of one row of that mean (noise and everyday error);
/// `columns` what one standard deviation of each nuisance changes (parameters of the model; they
/// are shared by the joints). At most some hundred rows per joint are needed: thin them out, and
/// give `sd` of the thinned rows.
pub fn nats(delta: &[Vec<f64>], sd: &[f64], columns: &[Vec<Vec<f64>>]) -> f64 {
    let count = columns.len();
    let mut gram = nalgebra::DMatrix::<f64>::identity(count, count);
    let mut projected = nalgebra::DVector::<f64>::zeros(count);
    let mut squares = 0.0;
    for (joint, rows) in delta.iter().enumerate() {
        let weight = 1.0 / (sd[joint] * sd[joint]).max(1e-18);
        squares += weight * rows.iter().map(|x| x * x).sum::<f64>();
        let block = nalgebra::DMatrix::from_fn(rows.len(), count, |row, k| columns[k][joint][row]);
        let rows = nalgebra::DVector::from_column_slice(rows);
        gram += weight * block.tr_mul(&block);
        projected += weight * block.tr_mul(&rows);
    }
    let told = gram.cholesky().map_or(0.0, |factor| projected.dot(&factor.solve(&projected)));
    0.5 * (squares - told).max(0.0)
}

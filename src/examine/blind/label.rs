//! Label of a case: its sealed true faults.

use serde::{Deserialize, Serialize};

/// Kind of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The robot differs from its model within the usual spread.
    Healthy,
    /// Bodies or friction differ: a change of parameters only.
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

impl Kind {
    /// The name in JSON and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Kind::Healthy => "healthy",
            Kind::ParametersOnly => "parameters_only",
            Kind::One => "one",
            Kind::Two => "two",
            Kind::Outside => "outside",
            Kind::Power => "power",
            Kind::Motion => "motion",
        }
    }
}

/// Label of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Label {
    /// Name of the case.
    pub case: String,
    /// Kind of the case.
    pub kind: Kind,
    /// Confidence in the nominal model, as an option value.
    pub trust: String,
    /// The faults; for [`Kind::Outside`] the fault without an effect id.
    pub effects: Vec<Truth>,
    /// The joint, from 1, with the largest share of the gap due to the faults; `None` without such
    /// a joint.
    pub place: Option<usize>,
    /// That share.
    pub share: Option<f64>,
    /// RAPID lines at which the fault appears; may be empty.
    pub lines: Vec<usize>,
    /// The gap of the nominal model on the held-out log, by joint.
    pub heldout: Vec<HeldOut>,
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
    /// Expected log-likelihood ratio \[nats\] with and without the fault; nominal parameters and
    /// smooth model errors are free within their spread.
    pub nats: f64,
}

impl Truth {
    /// A fault of these joints, from 0; its detectability is not yet known.
    pub(in crate::examine) fn new(id: &str, form: &str, joints: &[usize]) -> Truth {
        Truth {
            id: id.into(),
            form: form.into(),
            joints: joints.iter().map(|joint| joint + 1).collect(),
            parameters: Vec::new(),
            window: None,
            equivalents: Vec::new(),
            nats: 0.0,
        }
    }

    /// Adds a parameter of a joint, from 0, or of the arm.
    pub(in crate::examine) fn tell(
        &mut self,
        name: &str,
        joint: Option<usize>,
        value: f64,
        graded: bool,
    ) {
        let joint = joint.map(|joint| joint + 1);
        self.parameters.push(TrueParameter { name: name.into(), joint, value, graded });
    }
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
    /// The model error, which no diagnosis can identify.
    pub left: f64,
}

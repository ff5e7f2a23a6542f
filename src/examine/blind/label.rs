//! The truth of a case, as it is sealed.

use serde::{Deserialize, Serialize};

/// What kind of case it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The robot differs from its model by the usual spread.
    Healthy,
    /// Bodies or friction differ, which is a matter of parameters.
    ParametersOnly,
    /// One effect.
    One,
    /// Two effects.
    Two,
    /// Something that no library has.
    Outside,
    /// One effect of the power.
    Power,
    /// One effect of the motion.
    Motion,
}

impl Kind {
    /// As JSON and tables name it.
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

/// The truth of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Label {
    /// Name of the case.
    pub case: String,
    /// Kind of the case.
    pub kind: Kind,
    /// How much the nominal model is believed, as options name it.
    pub trust: String,
    /// What is wrong; for [`Kind::Outside`] the thing that has no id.
    pub effects: Vec<Truth>,
    /// The joint, from 1, with the largest share of the gap that the effects make; `None` where
    /// there is none or the channel has no joints.
    pub place: Option<usize>,
    /// That share.
    pub share: Option<f64>,
    /// RAPID lines that say where the effect is; empty where it is at none.
    pub lines: Vec<usize>,
    /// The held-out log: the gap that the nominal model leaves, joint by joint.
    pub heldout: Vec<HeldOut>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Effect id; `outside` for what no library has.
    pub id: String,
    /// The form of its law.
    pub form: String,
    /// Joints from 1; empty where it is of the whole arm.
    pub joints: Vec<usize>,
    /// Its parameters.
    pub parameters: Vec<TrueParameter>,
    /// When it acts within each period \[s\].
    pub window: Option<[f64; 2]>,
    /// Effects whose torques are exactly the same here.
    pub equivalents: Vec<String>,
    /// Expected log-likelihood ratio \[nats\] of the logs against those without it, the nominal
    /// parameters and smooth model errors being free within their spread.
    pub nats: f64,
}

/// A parameter of the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueParameter {
    /// As a diagnosis names it.
    pub name: String,
    /// The joint, from 1.
    pub joint: Option<usize>,
    /// Its value, SI.
    pub value: f64,
    /// Whether it means the same in every form of the law.
    pub graded: bool,
}

/// Rms torques of the held-out log without noise \[Nm\].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldOut {
    /// The joint, from 1.
    pub joint: usize,
    /// Of the torque itself.
    pub torque: f64,
    /// What the nominal model misses.
    pub model: f64,
    /// What the effects add.
    pub effects: f64,
    /// What no diagnosis can know: the model error.
    pub left: f64,
}

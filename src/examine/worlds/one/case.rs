//! A case: its kind, and the dispatch to the makers.

use crate::api::{Case, Kind};
use crate::arm::{Arm, CAD, COMMISSIONED, Spread};
use crate::design::design;
use crate::rng::Rng;
use crate::{motion_case, torque_case};
use serde_json::{Value, json};

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
/// Share of models of torque cases that are URDFs.
const URDF_SHARE: f64 = 0.45;
/// Share of robots with a baseline.
const BASELINE_SHARE: f64 = 0.6;
/// Share of cases whose model was identified on the robot.
const COMMISSIONED_SHARE: f64 = 0.5;
/// Share of cases with a baseline in which the rotors are missing from a URDF and stay in the torques.
const ROTORS_LEFT: f64 = 0.3;
/// Share of cases in which the period is told.
const PERIOD_TOLD: f64 = 0.5;

/// What is drawn first.
pub struct Plan {
    /// Seed of all cases.
    pub seed: u64,
    /// Number of this one.
    pub number: usize,
    /// Kind.
    pub kind: Kind,
    /// The nominal robot.
    pub nominal: Arm,
    /// Whether its file is a URDF.
    pub urdf: bool,
    /// Whether rotors missing in the URDF stay in the logged torques.
    pub rotors_left: bool,
    /// Spread of the parameters.
    pub spread: Spread,
    /// Whether there are logs from before the fault.
    pub baseline: bool,
    /// Whether the period is told.
    pub period_told: bool,
}

impl Plan {
    /// A stream of random numbers for a purpose.
    pub fn rng(&self, purpose: &str) -> Rng {
        Rng::new(self.seed, self.number, purpose)
    }

    /// Name and content of the robot's file.
    pub fn robot_file(&self) -> (String, String) {
        let name = format!("arm-{:04}", self.number);
        if self.urdf {
            ("nominal.urdf".to_owned(), crate::nominal::urdf(&self.nominal, &name))
        } else {
            ("nominal.toml".to_owned(), crate::nominal::toml(&self.nominal, &name))
        }
    }

    /// Options of the diagnosis.
    pub fn options(&self, names: [&[String]; 3], period: f64) -> Value {
        let mut options = json!({
            "robot": if self.urdf { "nominal.urdf" } else { "nominal.toml" },
            "trust": self.spread.trust,
            "log": names[0],
            "heldout": names[1],
            "baseline": names[2],
        });
        if self.period_told && period > 0.0 {
            options["period"] = json!(crate::arm::neat(period));
        }
        options
    }
}

/// Draws what comes first.
fn plan(seed: u64, number: usize) -> Plan {
    let mut rng = Rng::new(seed, number, "plan");
    let shares: Vec<f64> = KINDS.iter().map(|kind| kind.1).collect();
    let kind = KINDS[rng.weighted(&shares)].0;
    let motion = kind == Kind::Motion;
    let electric = kind == Kind::Power;
    let mut nominal = design(&mut Rng::new(seed, number, "design"), motion);
    if electric && nominal.regeneration == 0.0 {
        nominal.regeneration = 0.7;
    }
    let urdf = rng.chance(URDF_SHARE) && !motion && !electric;
    let baseline = rng.chance(BASELINE_SHARE) || motion || electric;
    Plan {
        seed,
        number,
        kind,
        nominal,
        urdf,
        rotors_left: urdf && baseline && rng.chance(ROTORS_LEFT),
        spread: if rng.chance(COMMISSIONED_SHARE) { COMMISSIONED } else { CAD },
        baseline,
        period_told: rng.chance(PERIOD_TOLD),
    }
}

/// The case of a seed and a number.
pub fn case(seed: u64, number: usize) -> Case {
    let plan = plan(seed, number);
    if plan.kind == Kind::Motion { motion_case::make(&plan) } else { torque_case::make(&plan) }
}

//! What is drawn first in a case.

use super::arm::Arm;
use super::design::design;
use crate::examine::worlds::api::Kind;
use crate::examine::worlds::model::{CAD, COMMISSIONED, Spread};
use crate::examine::worlds::random::Rng;

/// Share of models of torque cases that are URDFs.
const URDF_SHARE: f64 = 0.45;
/// Share of robots with a baseline.
const BASELINE_SHARE: f64 = 0.6;
/// Share of cases whose model was identified on the robot.
const COMMISSIONED_SHARE: f64 = 0.5;
/// Share of cases with a baseline in which the rotors, missing from a URDF, stay in the torques.
const ROTORS_LEFT: f64 = 0.3;
/// Share of cases in which the period is told.
const PERIOD_TOLD: f64 = 0.5;

/// What the model's file and the logs say of the rotors' torques.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rotors {
    /// A TOML with rotors.
    InModel,
    /// A URDF; the drive takes them off the logged torques.
    Removed,
    /// A URDF; they are in the torques.
    Left,
}

/// What is drawn first.
pub(super) struct Plan {
    pub(super) seed: u64,
    pub(super) number: usize,
    pub(super) kind: Kind,
    pub(super) nominal: Arm,
    pub(super) rotors: Rotors,
    pub(super) spread: Spread,
    /// Whether there are logs from before the fault.
    pub(super) baseline: bool,
    pub(super) period_told: bool,
}

impl Plan {
    pub(super) fn new(seed: u64, number: usize, kind: Kind) -> Self {
        let mut rng = Rng::stream(seed, number, "plan");
        let motion = kind == Kind::Motion;
        let electric = kind == Kind::Power;
        let mut nominal = design(&mut Rng::stream(seed, number, "design"), motion);
        if electric && nominal.regeneration == 0.0 {
            nominal.regeneration = 0.7;
        }
        let urdf = rng.chance(URDF_SHARE) && !motion && !electric;
        let baseline = rng.chance(BASELINE_SHARE) || motion || electric;
        let rotors = match (urdf, baseline && rng.chance(ROTORS_LEFT)) {
            (false, _) => Rotors::InModel,
            (true, false) => Rotors::Removed,
            (true, true) => Rotors::Left,
        };
        let spread = if rng.chance(COMMISSIONED_SHARE) { COMMISSIONED } else { CAD };
        let period_told = rng.chance(PERIOD_TOLD);
        Self { seed, number, kind, nominal, rotors, spread, baseline, period_told }
    }

    /// A stream of random numbers for a purpose.
    pub(super) fn rng(&self, purpose: &str) -> Rng {
        Rng::stream(self.seed, self.number, purpose)
    }

    /// Name and content of the robot's file.
    pub(super) fn robot_file(&self) -> (String, String) {
        let sheet = self.nominal.sheet(format!("arm-{:04}", self.number));
        sheet.file(self.rotors != Rotors::InModel)
    }
}

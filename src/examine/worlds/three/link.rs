//! Faults between the links: springs, balancers, cables. They load the gear.

use super::law::{Memory, Parameter};

/// A law of one joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkLaw {
    /// Stiffness about the centre \[Nm/rad\], grows with the fault.
    pub(super) stiffness: f64,
    /// Angle without torque \[rad\].
    pub(super) centre: f64,
    pub(super) form: LinkForm,
}

/// Forms of springs; x is the angle from the centre.
#[derive(Clone, Copy, Debug)]
pub(super) enum LinkForm {
    /// Helical spring between two pivots at the distances 1 and `arm` from the axis, free length
    /// `free` of the shortest: A. Klimchik et al., gravity compensators, 2013.
    Lever { arm: f64, free: f64 },
    /// Gas cylinder, polytropic: `k sin x /(1−fill (1−cos x))^1.3`.
    Gas { fill: f64 },
    /// `k (share x + (1−share) D z)`, z a Bouc-Wen state of the distance D: friction between strands
    /// (R. Bouc, 1967; Y.-K. Wen, 1976).
    BoucWen { share: f64, distance: f64 },
    /// `k width (softplus-like)`: a hose that gets taut on both sides, soft in the middle.
    Taut { width: f64 },
}

impl LinkLaw {
    /// Torque \[Nm\] that the motor needs more at an angle; `change` is the angle since the last step.
    pub(super) fn torque(&self, angle: f64, change: f64, memory: &mut Memory) -> f64 {
        let x = angle - self.centre;
        match self.form {
            LinkForm::Lever { arm, free } => {
                let length = (1.0 + arm * arm - 2.0 * arm * x.cos()).sqrt();
                let shortest = (arm - 1.0).abs();
                let force = 1.0 - free * shortest / length;
                // Scaled so that the slope at the centre is the stiffness.
                self.stiffness * force / (1.0 - free) * x.sin()
            }
            LinkForm::Gas { fill } => {
                self.stiffness * x.sin() / (1.0 - fill * (1.0 - x.cos())).max(0.2).powf(1.3)
            }
            LinkForm::BoucWen { share, distance } => {
                // ż = (1 − |z|·(½ + ½ sgn(z ẋ)))·ẋ/D.
                let z = memory[0];
                let shape = 1.0 - z.abs() * if z * change > 0.0 { 1.0 } else { 0.0 };
                memory[0] = (z + shape * change / distance).clamp(-1.0, 1.0);
                self.stiffness * (share * x + (1.0 - share) * distance * memory[0])
            }
            LinkForm::Taut { width } => {
                let r = x / width;
                self.stiffness * x * (0.3 + 0.7 * r * r / (1.0 + r * r))
            }
        }
    }

    /// Its parameters by the library's names.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        let mostly = matches!(self.form, LinkForm::Lever { .. } | LinkForm::Gas { .. });
        vec![("stiffness", self.stiffness, false), ("centre", self.centre, mostly)]
    }
}

//! The robot whose energy is the mean over plausible robots.
//!
//! All parts except the copper loss are linear in the parameters, so the robot of mean parameters
//! has their mean. The copper loss c τ² is quadratic; its mean along a motion,
//!
//! ```text
//! ∫ E[c τ²] dt = Σ E[c ΔπΔπᵀ] : ∫ φ φᵀ dt,
//! ```
//!
//! follows from the second moments and determines the loss constant c of the mean robot.

use super::change::Changes;
use super::moments::Moments;
use super::plausible::Robots;
use crate::arm::dynamics::{RIGID, link_of, link_parameters};
use crate::arm::effects::drawn;
use crate::arm::robot::Model;
use crate::arm::robot::prior::Plausible;

impl Robots {
    /// The mean robot along a motion; `None` if its effects are invalid.
    pub fn mean(&self, model: &Model, along: &Moments) -> Option<Model> {
        let robots = &self.draws.robots;
        let mut mean = mean(robots)?;
        let of_mean = Changes::from_one(model, &mean);
        for j in 0..model.dof {
            let square = along.squares(j, &of_mean)[0];
            let copper = robots.iter().zip(along.squares(j, self.drawn()));
            let copper: f64 = copper.map(|(robot, square)| robot.loss[j] * square).sum();
            if square > 0.0 {
                mean.loss[j] = copper / robots.len() as f64 / square;
            }
        }
        drawn(model, &mean).ok()
    }
}

/// Means of all numbers; a link has the mean of its inertial parameters.
fn mean(robots: &[Plausible]) -> Option<Plausible> {
    let share = 1.0 / robots.len() as f64;
    let one = |value: &dyn Fn(&Plausible) -> f64| robots.iter().map(value).sum::<f64>() * share;
    let first = robots.first()?;
    let list = |of: fn(&Plausible) -> &Vec<f64>| -> Vec<f64> {
        (0..of(first).len()).map(|j| one(&|robot| of(robot)[j])).collect()
    };
    let link = |i: usize| {
        let parameters: [f64; RIGID] =
            std::array::from_fn(|p| one(&|robot| link_parameters(&robot.links[i])[p]));
        link_of(&parameters)
    };
    Some(Plausible {
        links: (0..first.links.len()).map(link).collect(),
        coulomb: list(|robot| &robot.coulomb),
        viscous: list(|robot| &robot.viscous),
        rotors: list(|robot| &robot.rotors),
        loss: list(|robot| &robot.loss),
        base_w: one(&|robot| robot.base_w),
        coils_w: one(&|robot| robot.coils_w),
        release_j: one(&|robot| robot.release_j),
        spring: one(&|robot| robot.spring),
    })
}

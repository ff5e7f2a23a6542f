//! Spread of real robots around their nominal model.

use nalgebra::{Matrix3, Vector3};

use super::mechanics::Body;
use super::plant::Plant;
use super::random::Random;

/// Largest distance of a parameter from its nominal value \[standard deviations\].
const FARTHEST: f64 = 2.5;

/// Trust in a nominal model: standard deviations of the real robot's parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trust {
    /// Name of the option value.
    pub(super) name: &'static str,
    /// Masses \[1\].
    pub(super) mass: f64,
    /// Coordinates of a centre of mass \[m\].
    pub(super) com: f64,
    /// Moments of inertia and rotors \[1\].
    pub(super) inertia: f64,
    /// Coulomb and viscous friction, and losses \[1\].
    pub(super) friction: f64,
}

impl Trust {
    /// Identified when the robot was new.
    pub(super) const COMMISSIONED: Trust =
        Trust { name: "commissioned", mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05 };
    /// From drawings.
    pub(super) const CAD: Trust =
        Trust { name: "cad", mass: 0.10, com: 0.015, inertia: 0.20, friction: 0.25 };

    /// A random true robot for the model `nominal`.
    pub(super) fn real(self, nominal: &Plant, random: &mut Random) -> Plant {
        let mut plant = nominal.clone();
        for body in &mut plant.bodies {
            self.vary(body, random);
        }
        for joint in 0..plant.dof {
            for (value, sd) in [
                (&mut plant.rotor[joint], self.inertia),
                (&mut plant.coulomb[joint], self.friction),
                (&mut plant.viscous[joint], self.friction),
            ] {
                *value *= 1.0 + sd * random.normal_within(FARTHEST);
            }
        }
        plant
    }

    fn vary(self, body: &mut Body, random: &mut Random) {
        let heavier = 1.0 + self.mass * random.normal_within(FARTHEST);
        body.mass *= heavier;
        body.com += Vector3::from_fn(|_, _| self.com * random.normal_within(FARTHEST));
        // Stretched along its axes, a body stays physical: its second moments are a covariance.
        let half_trace = 0.5 * body.inertia.trace();
        let moments = Matrix3::from_diagonal_element(half_trace) - body.inertia;
        let stretch = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| {
            1.0 + 0.5 * self.inertia * random.normal_within(FARTHEST)
        }));
        let moments = stretch * moments * stretch;
        body.inertia = Matrix3::from_diagonal_element(moments.trace()) - moments;
    }
}

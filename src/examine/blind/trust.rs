//! Spread of real robots around their nominal model.

use nalgebra::{Matrix3, Vector3};

use super::mechanics::Body;
use super::plant::Plant;
use super::random::Random;

/// Largest distance of a parameter from its nominal value \[standard deviations\].
const FARTHEST: f64 = 2.5;

/// Source of a nominal model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trust {
    /// Identified when the robot was new.
    Commissioned,
    /// From drawings.
    Cad,
}

impl Trust {
    /// Name of the option value.
    pub(super) fn name(self) -> &'static str {
        match self {
            Trust::Commissioned => "commissioned",
            Trust::Cad => "cad",
        }
    }

    /// Standard deviation of masses \[1\].
    pub(super) fn mass(self) -> f64 {
        match self {
            Trust::Commissioned => 0.01,
            Trust::Cad => 0.10,
        }
    }

    /// Standard deviation of the coordinates of a centre of mass \[m\].
    pub(super) fn com(self) -> f64 {
        match self {
            Trust::Commissioned => 0.003,
            Trust::Cad => 0.015,
        }
    }

    /// Standard deviation of moments of inertia and rotors \[1\].
    pub(super) fn inertia(self) -> f64 {
        match self {
            Trust::Commissioned => 0.03,
            Trust::Cad => 0.20,
        }
    }

    /// Standard deviation of Coulomb and viscous friction and of losses \[1\].
    pub(super) fn friction(self) -> f64 {
        match self {
            Trust::Commissioned => 0.05,
            Trust::Cad => 0.25,
        }
    }

    /// A random true robot for the model `nominal`.
    pub(super) fn real(self, nominal: &Plant, random: &mut Random) -> Plant {
        let mut plant = nominal.clone();
        for body in &mut plant.bodies {
            self.vary(body, random);
        }
        for joint in 0..plant.dof {
            for (value, sd) in [
                (&mut plant.rotor[joint], self.inertia()),
                (&mut plant.coulomb[joint], self.friction()),
                (&mut plant.viscous[joint], self.friction()),
            ] {
                *value *= 1.0 + sd * random.normal_within(FARTHEST);
            }
        }
        plant
    }

    fn vary(self, body: &mut Body, random: &mut Random) {
        let heavier = 1.0 + self.mass() * random.normal_within(FARTHEST);
        body.mass *= heavier;
        body.com += Vector3::from_fn(|_, _| self.com() * random.normal_within(FARTHEST));
        // Stretched along its axes, a body stays physical: its second moments are a covariance.
        let half_trace = 0.5 * body.inertia.trace();
        let moments = Matrix3::from_diagonal_element(half_trace) - body.inertia;
        let stretch = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| {
            1.0 + 0.5 * self.inertia() * random.normal_within(FARTHEST)
        }));
        let moments = stretch * moments * stretch;
        body.inertia = Matrix3::from_diagonal_element(moments.trace()) - moments;
    }
}

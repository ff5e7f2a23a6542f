//! Torques of a world's nominal robots without faults, for a comparison with the library's.

use super::model::{Row, Sheet};
use super::random::Rng;

/// States of a robot: angles \[rad\], rates \[rad/s\], accelerations \[rad/s²\].
pub(super) type State = [Row; 3];
/// Number of states.
const STATES: usize = 20;

/// A nominal robot and its torques.
pub struct Plain {
    /// Its file as TOML, and as URDF, which has no rotors.
    pub files: [String; 2],
    /// Angles \[rad\], rates \[rad/s\] and accelerations \[rad/s²\]; no joint rests.
    pub states: Vec<State>,
    /// Torques of both files' models \[Nm\].
    pub torques: Vec<[Row; 2]>,
}

impl Plain {
    /// Random states; `torque` gives the torques with or without the rotors' inertia.
    pub(super) fn new(
        sheet: &Sheet,
        rng: &mut Rng,
        torque: impl Fn(&State, Rotors) -> Row,
    ) -> Plain {
        let mut states = vec![State::default(); STATES];
        for [q, v, a] in &mut states {
            for i in 0..sheet.joints.len() {
                q[i] = rng.between(sheet.lower[i], sheet.upper[i]);
                v[i] = sheet.velocity[i] * rng.between(0.1, 1.0) * rng.sign();
                a[i] = 5.0 * rng.normal();
            }
        }
        let both = |state| [torque(state, Rotors::With), torque(state, Rotors::Without)];
        let torques = states.iter().map(both).collect();
        Plain { files: [sheet.file(false).1, sheet.file(true).1], states, torques }
    }
}

/// Whether torques have the rotors' inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rotors {
    With,
    Without,
}

//! Logs of a robot with an effect.

use joulepath::arm::effects::{Effect, Motion};
use joulepath::arm::robot::Model;
use joulepath::learn::identify::{Hints, Samples, prepare};
use joulepath::learn::log::{Channel, Log};

use crate::excited::{normal, series};

/// The robot with parameter errors as after an identification.
pub(crate) fn perturbed(model: &Model, seed: u64) -> Model {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut other = model.clone();
    for link in &mut other.links {
        link.mass *= 1.0 + 0.01 * normal(&mut random);
        for axis in 0..3 {
            link.com[axis] += 0.003 * normal(&mut random);
        }
        link.inertia *= 1.0 + 0.03 * normal(&mut random);
    }
    for joint in 0..model.dof {
        other.friction.coulomb[joint] *= 1.0 + 0.05 * normal(&mut random);
        other.friction.viscous[joint] *= 1.0 + 0.05 * normal(&mut random);
    }
    other
}

/// A robot and the properties of its logs.
pub(crate) struct Robot<'a> {
    pub(crate) model: &'a Model,
    /// Effects with their joints, from 0, and their coordinates.
    pub(crate) effects: &'a [(&'static Effect, usize, &'a [f64])],
    /// Noise of the torque, relative to its largest value.
    pub(crate) noise: f64,
}

impl Robot<'_> {
    /// Seven repetitions of 10 s at 100 Hz.
    pub(crate) fn samples(&self, seed: u64) -> Samples {
        let series = series(seed);
        let count = 1000;
        let states = series.sampled(count);
        let n = self.model.dof;
        let columns = |order: usize| -> Vec<Vec<f64>> {
            (0..n).map(|j| states.iter().map(|s| s[order][j]).collect()).collect()
        };
        let t = (0..count).map(|i| 0.01 * i as f64).collect();
        let motion = Motion::new(self.model, t, [columns(0), columns(1), columns(2)], &[], true);
        let mut torque = motion.torque.clone();
        for (effect, joint, coordinates) in self.effects {
            for (to, added) in effect.added(&motion, *joint, coordinates) {
                torque[to].iter_mut().zip(added).for_each(|(x, a)| *x += a);
            }
        }
        let mut random = fastrand::Rng::with_seed(seed + 100);
        let repetitions = 7;
        let mut values = vec![Vec::new(); 1 + 2 * n];
        for row in 0..repetitions * count {
            values[0].push(0.01 * row as f64);
            for joint in 0..n {
                values[1 + joint].push(motion.q[joint][row % count]);
                let largest = torque[joint].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let noise = self.noise * largest * normal(&mut random);
                values[1 + n + joint].push(torque[joint][row % count] + noise);
            }
        }
        let mut channels = vec![Channel::Time];
        channels.extend((0..n).map(Channel::Position));
        channels.extend((0..n).map(Channel::Torque));
        let tau = values[1 + n..].to_vec();
        let rows = (2..values[0].len() as u64 + 2).collect();
        let log = Log { channels, values, rows, rejected: Vec::new(), degrees: Vec::new() };
        prepare(&log, &tau, Hints { period: Some(10.0), cutoff: None }).unwrap()
    }
}

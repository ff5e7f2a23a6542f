//! The nodes of a path with their coefficients, as the example `peer_paths` writes them.

use nalgebra::DMatrix;
use serde_json::Value;

pub const DOF: usize = 6;
pub type Joints = [f64; DOF];

/// τ = `inertial` s̈ + `centrifugal` ṡ² + `gravity` + `dry`, one column per node.
pub struct Nodes {
    pub s: Vec<f64>,
    pub q1: DMatrix<f64>,
    pub q2: DMatrix<f64>,
    pub q3: DMatrix<f64>,
    pub inertial: DMatrix<f64>,
    pub centrifugal: DMatrix<f64>,
    pub gravity: DMatrix<f64>,
    pub dry: DMatrix<f64>,
    pub velocity: Joints,
    pub acceleration: Joints,
    pub torque: Joints,
    pub jerk: Joints,
    /// W/(Nm)² of each joint.
    pub loss: Joints,
}

/// The numbers of a list; infinite where there is none.
pub fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter().map(|x| x.as_f64().unwrap_or(f64::INFINITY)).collect()
}

impl Nodes {
    pub fn new(value: &Value) -> Nodes {
        let matrix = |name: &str| {
            let rows = value[name].as_array().map(Vec::as_slice).unwrap_or_default();
            DMatrix::from_iterator(DOF, rows.len(), rows.iter().flat_map(numbers))
        };
        let joints = |name: &str| -> Joints {
            let list = numbers(&value[name]);
            std::array::from_fn(|j| list[j])
        };
        Nodes {
            s: numbers(&value["s"]),
            q1: matrix("q1"),
            q2: matrix("q2"),
            q3: matrix("q3"),
            inertial: matrix("inertial"),
            centrifugal: matrix("centrifugal"),
            gravity: matrix("gravity"),
            dry: matrix("dry"),
            velocity: joints("velocity"),
            acceleration: joints("acceleration"),
            torque: joints("torque"),
            jerk: joints("jerk"),
            loss: joints("loss"),
        }
    }

    /// Duration of the profile b = ṡ² at the nodes, s.
    pub fn duration(&self, b: &[f64]) -> f64 {
        (0..self.s.len() - 1).map(|k| self.time(b, k)).sum()
    }

    fn time(&self, b: &[f64], k: usize) -> f64 {
        2.0 * (self.s[k + 1] - self.s[k]) / (b[k].sqrt() + b[k + 1].sqrt())
    }

    /// Σ loss · τ² over the motion, J, with τ at the position `at` (0…1) of each interval: at 0
    /// as COPP, at ½ as joulepath.
    pub fn thermal(&self, b: &[f64], at: f64) -> f64 {
        let mix =
            |m: &DMatrix<f64>, j: usize, k: usize| (1.0 - at) * m[(j, k)] + at * m[(j, k + 1)];
        let of = |k: usize| {
            let u = (b[k + 1] - b[k]) / (2.0 * (self.s[k + 1] - self.s[k]));
            let here = (1.0 - at) * b[k] + at * b[k + 1];
            let power = |j: usize| {
                let rest = mix(&self.gravity, j, k) + mix(&self.dry, j, k);
                let moving = mix(&self.inertial, j, k) * u + mix(&self.centrifugal, j, k) * here;
                self.loss[j] * (rest + moving).powi(2)
            };
            self.time(b, k) * (0..DOF).map(power).sum::<f64>()
        };
        (0..self.s.len() - 1).map(of).sum()
    }

    /// The largest used share of a limit at both ends of all intervals.
    pub fn worst(&self, b: &[f64]) -> f64 {
        let mut worst: f64 = 0.0;
        for k in 0..self.s.len() - 1 {
            let u = (b[k + 1] - b[k]) / (2.0 * (self.s[k + 1] - self.s[k]));
            for (node, b) in [(k, b[k]), (k + 1, b[k + 1])] {
                for j in 0..DOF {
                    let at = |m: &DMatrix<f64>| m[(j, node)];
                    let torque = at(&self.inertial) * u
                        + at(&self.centrifugal) * b
                        + at(&self.gravity)
                        + at(&self.dry);
                    worst = worst
                        .max(at(&self.q1).abs() * b.sqrt() / self.velocity[j])
                        .max((at(&self.q1) * u + at(&self.q2) * b).abs() / self.acceleration[j])
                        .max(torque.abs() / self.torque[j]);
                }
            }
        }
        worst
    }
}

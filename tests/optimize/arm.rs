//! A synthetic arm with consistent dynamics, and random paths. Point masses mᵢ at the links of six
//! revolute joints, and rotors at the joints: τ = Σ mᵢ Jᵢᵀ (p̈ᵢ − γ) + I q̈, which needs only
//! positions and their derivatives along the path.

use joulepath::retime::motion::stream::{DOF, Joints};
use joulepath::retime::motion::timing::grid::{PathGrid, PathPoint};
use joulepath::retime::motion::timing::limits::PathLimits;
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::optimize::energy_program::{EnergyOutcome, energy_bound, minimize_energy};
use joulepath::retime::optimize::path_energy::EnergyModel;
use joulepath::retime::optimize::plant::Plant;

type Vec3 = [f64; 3];

/// Offset of the next joint in the frame of each joint, m.
const LINKS: [Vec3; DOF] = [
    [0.15, 0.0, 0.45],
    [0.0, 0.0, 0.7],
    [0.3, 0.0, 0.1],
    [0.3, 0.0, 0.0],
    [0.06, 0.0, 0.0],
    [0.0, 0.08, 0.02],
];
/// Axis of each joint: 0 = x, 1 = y, 2 = z.
const AXES: [usize; DOF] = [2, 1, 1, 0, 1, 0];
/// Masses at the ends of the links, kg.
const MASSES: [f64; DOF] = [40.0, 25.0, 18.0, 6.0, 4.0, 8.0];
/// Rotor inertia at the joint side, kg m².
const ROTORS: Joints = [12.0, 14.0, 8.0, 1.2, 1.0, 0.4];
const COULOMB: Joints = [60.0, 60.0, 40.0, 12.0, 10.0, 6.0];
const VISCOUS: Joints = [40.0, 45.0, 25.0, 6.0, 5.0, 2.5];
pub(crate) const VELOCITY: Joints = [3.1, 2.6, 3.1, 5.6, 6.8, 7.8];
const ACCELERATION: Joints = [12.0, 12.0, 14.0, 35.0, 40.0, 50.0];
const TORQUE: Joints = [1100.0, 1300.0, 750.0, 130.0, 110.0, 70.0];
const GRAVITY: f64 = 9.81;

/// Copper losses, W/(Nm)².
pub(crate) const LOSS: Joints = [4e-4, 4e-4, 8e-4, 1e-2, 1.2e-2, 3e-2];

pub(crate) fn limits() -> PathLimits {
    PathLimits::new(ACCELERATION, TORQUE).unwrap()
}

/// The ends of the links, m, at the joint angles `q`, rad.
fn positions(q: &Joints) -> [Vec3; DOF] {
    let mut frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut at = [0.0; 3];
    std::array::from_fn(|j| {
        let (sin, cos) = q[j].sin_cos();
        let (a, b) = ((AXES[j] + 1) % 3, (AXES[j] + 2) % 3);
        for row in &mut frame {
            let (x, y) = (row[a], row[b]);
            (row[a], row[b]) = (cos * x + sin * y, cos * y - sin * x);
        }
        for i in 0..3 {
            at[i] += (0..3).map(|k| frame[i][k] * LINKS[j][k]).sum::<f64>();
        }
        at
    })
}

/// d(position of link i)/dq, by central differences.
fn jacobians(q: &Joints) -> [[Vec3; DOF]; DOF] {
    const H: f64 = 1e-6;
    let mut out = [[[0.0; 3]; DOF]; DOF];
    for j in 0..DOF {
        let (mut lo, mut hi) = (*q, *q);
        lo[j] -= H;
        hi[j] += H;
        let (lo, hi) = (positions(&lo), positions(&hi));
        for i in 0..DOF {
            out[i][j] = std::array::from_fn(|k| (hi[i][k] - lo[i][k]) / (2.0 * H));
        }
    }
    out
}

/// A smooth joint path q(s), s ∈ [0, length], as sums of incommensurate cosines.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    pub(crate) length: f64,
    centre: Joints,
    waves: Vec<(Joints, f64, f64)>,
}

/// A linear congruential generator.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// Uniform in [lo, hi).
    pub(crate) fn uniform(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        lo + (hi - lo) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

impl Path {
    pub(crate) fn random(seed: u64) -> Path {
        let mut random = Random::new(seed);
        let length = random.uniform(0.5, 2.5);
        let centre = std::array::from_fn(|_| random.uniform(-0.8, 0.8));
        let waves = (1..=3)
            .map(|k| {
                let size = 0.9 / f64::from(k * k);
                let amplitude = std::array::from_fn(|_| random.uniform(-size, size));
                (amplitude, f64::from(k) * 2.4 / length, random.uniform(0.0, 6.0))
            })
            .collect();
        Path { length, centre, waves }
    }

    /// (q, q', q'').
    pub(crate) fn at(&self, s: f64) -> (Joints, Joints, Joints) {
        let (mut q, mut q1, mut q2) = (self.centre, [0.0; DOF], [0.0; DOF]);
        for (amplitude, rate, phase) in &self.waves {
            let (sin, cos) = (rate * s + phase).sin_cos();
            for j in 0..DOF {
                q[j] += amplitude[j] * cos;
                q1[j] -= amplitude[j] * rate * sin;
                q2[j] -= amplitude[j] * rate * rate * cos;
            }
        }
        (q, q1, q2)
    }
}

/// The arm as a model for streams.
pub(crate) struct SyntheticArm;

impl Plant for SyntheticArm {
    fn torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        let rigid = rigid_torque(q, qd, qdd, GRAVITY);
        std::array::from_fn(|j| rigid[j] + VISCOUS[j] * qd[j])
    }

    fn dry_friction(&self) -> Joints {
        COULOMB
    }

    fn torque_limit(&self) -> Joints {
        TORQUE
    }
}

fn rigid_torque(q: &Joints, qd: &Joints, qdd: &Joints, gravity: f64) -> Joints {
    const H: f64 = 1e-4;
    let ahead = |t: f64| std::array::from_fn(|j| q[j] + t * qd[j] + 0.5 * t * t * qdd[j]);
    let (before, here, after) = (positions(&ahead(-H)), positions(q), positions(&ahead(H)));
    let jacobians = jacobians(q);
    std::array::from_fn(|j| {
        let mut sum = ROTORS[j] * qdd[j];
        for i in 0..DOF {
            for k in 0..3 {
                let mut a = (before[i][k] - 2.0 * here[i][k] + after[i][k]) / (H * H);
                if k == 2 {
                    a += gravity;
                }
                sum += MASSES[i] * jacobians[i][j][k] * a;
            }
        }
        sum
    })
}

/// The point of the path at s with its dynamics; `friction` scales the viscous part.
pub(crate) fn point(path: &Path, s: f64, friction: f64) -> PathPoint {
    let (q, q1, q2) = path.at(s);
    let rest = [0.0; DOF];
    let v_max = (0..DOF).map(|j| VELOCITY[j] / q1[j].abs()).fold(1e3, f64::min);
    PathPoint {
        m: rigid_torque(&q, &rest, &q1, 0.0),
        c: rigid_torque(&q, &q1, &q2, 0.0),
        g: rigid_torque(&q, &rest, &rest, GRAVITY),
        coulomb: std::array::from_fn(|j| COULOMB[j] * q1[j].signum()),
        viscous: std::array::from_fn(|j| friction * VISCOUS[j] * q1[j]),
        ..PathPoint::kinematic(q, q1, q2, v_max)
    }
}

/// n + 1 nodes on [0, length], denser towards the ends: s = L (3x² − 2x³). From rest the speed
/// grows as √s, so that equal intervals are inefficient at the ends: for random paths with N = 100
/// these nodes halve the excess time over a fine grid.
pub(crate) fn rest_to_rest_nodes(length: f64, n: usize) -> Vec<f64> {
    let share = |k: usize| k as f64 / n as f64;
    (0..=n).map(|k| length * share(k).powi(2) * (3.0 - 2.0 * share(k))).collect()
}

/// The path on n intervals, denser towards the ends, with nodes at reversals of a joint; values
/// from inside each interval.
pub(crate) fn grid(path: &Path, n: usize, friction: f64) -> PathGrid {
    with_reversals(path, rest_to_rest_nodes(path.length, n), friction)
}

/// The path on the given nodes and at reversals of a joint.
pub(crate) fn with_reversals(path: &Path, mut s: Vec<f64>, friction: f64) -> PathGrid {
    let n = s.len() - 1;
    for k in 0..n {
        for j in 0..DOF {
            let (mut lo, mut hi) = (s[k], s[k + 1]);
            let sign = path.at(lo).1[j].signum();
            if sign != path.at(hi).1[j].signum() {
                while hi - lo > 1e-12 {
                    let middle = 0.5 * (lo + hi);
                    *(if path.at(middle).1[j].signum() == sign { &mut lo } else { &mut hi }) =
                        middle;
                }
                s.push(hi);
            }
        }
    }
    s.sort_by(f64::total_cmp);
    s.dedup_by(|b, a| *b - *a < 1e-4 * path.length / n as f64);
    let ends = s
        .windows(2)
        .map(|w| {
            let middle = path.at(0.5 * (w[0] + w[1])).1;
            [w[0], w[1]].map(|s| {
                let mut end = point(path, s, friction);
                end.coulomb = std::array::from_fn(|j| COULOMB[j] * middle[j].signum());
                end
            })
        })
        .collect();
    PathGrid::new(s, ends).unwrap()
}

/// The profile of least energy within `duration` (s), with its lower bound.
pub(crate) fn least_energy(
    grid: &PathGrid,
    limits: &PathLimits,
    model: &EnergyModel,
    fastest: &Profile,
    duration: f64,
) -> EnergyOutcome {
    let bound = energy_bound(grid, limits, model, fastest, duration);
    minimize_energy(grid, limits, model, fastest, duration, bound.as_ref())
}

/// b of a profile at nodes `s`, by linear interpolation on its own nodes.
pub(crate) fn resample(nodes: &[f64], b: &[f64], s: &[f64]) -> Vec<f64> {
    let mut k = 0;
    s.iter()
        .map(|s| {
            while k + 2 < nodes.len() && *s > nodes[k + 1] {
                k += 1;
            }
            let x = ((s - nodes[k]) / (nodes[k + 1] - nodes[k])).clamp(0.0, 1.0);
            b[k] + x * (b[k + 1] - b[k])
        })
        .collect()
}

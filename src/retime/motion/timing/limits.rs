//! Limits along a path as rows |α u + β b + γ √b + κ| ≤ 1 in u = s̈ and b = ṡ².
//!
//! Rows hold at **both** ends of each interval: with collocation at one end the torque exceeds its
//! limit between the nodes.

use super::grid::{PathGrid, PathPoint};
use super::row::Row;
use crate::retime::motion::stream::{DOF, Joints};

/// Largest |q̈| and |τ| of each joint; infinite without a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLimits {
    acceleration: Joints,
    torque: Joints,
}

/// A limit that is not positive.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the {quantity} limit of joint {joint} is {value}; give a positive number")]
pub struct LimitError {
    /// `acceleration` or `torque`.
    pub quantity: &'static str,
    /// Joint from 1.
    pub joint: usize,
    /// The refused value.
    pub value: f64,
}

impl PathLimits {
    /// Limits on |q̈| (rad/s²) and |τ| (Nm) of each joint; infinity means none.
    ///
    /// # Errors
    /// A limit that is not positive.
    pub fn new(acceleration: Joints, torque: Joints) -> Result<PathLimits, LimitError> {
        for (quantity, values) in [("acceleration", &acceleration), ("torque", &torque)] {
            if let Some(j) = values.iter().position(|x| x.is_nan() || *x <= 0.0) {
                return Err(LimitError { quantity, joint: j + 1, value: values[j] });
            }
        }
        Ok(PathLimits { acceleration, torque })
    }

    /// Largest |q̈| of each joint, rad/s².
    pub fn acceleration(&self) -> &Joints {
        &self.acceleration
    }

    /// Largest |τ| of each joint, Nm.
    pub fn torque(&self) -> &Joints {
        &self.torque
    }
}

/// Bound on |u| from the acceleration row of a joint for b ≤ `b_max`.
fn acceleration_bound(row: &Row, b_max: f64) -> f64 {
    (1.0 + row.constant.abs() + row.b.abs() * b_max) / row.u.abs()
}

fn acceleration_row(point: &PathPoint, limits: &PathLimits, j: usize) -> Row {
    let w = 1.0 / (limits.acceleration[j] * point.capability[j]);
    Row { u: w * point.q1[j], b: w * point.q2[j], constant: point.bias[j], ..Row::default() }
}

fn torque_row(point: &PathPoint, limits: &PathLimits, j: usize) -> Row {
    let w = 1.0 / limits.torque[j];
    Row {
        u: w * point.m[j],
        b: w * point.c[j],
        root: w * point.viscous[j],
        constant: w * (point.g[j] + point.coulomb[j]),
    }
}

/// The rows of one point without infinite limits and zero rows.
pub(crate) fn rows(point: &PathPoint, limits: &PathLimits) -> impl Iterator<Item = Row> {
    let joints = (0..DOF)
        .flat_map(move |j| [acceleration_row(point, limits, j), torque_row(point, limits, j)]);
    joints.chain(point.tcp_rows).filter(|row| *row != Row::default())
}

/// Calls `take` with the rows of one point that a profile within the acceleration rows can violate,
/// for b ≤ `b_max`.
pub(crate) fn binding_rows(
    point: &PathPoint,
    limits: &PathLimits,
    b_max: f64,
    mut take: impl FnMut(&Row),
) {
    let accelerations: [Row; DOF] = std::array::from_fn(|j| acceleration_row(point, limits, j));
    let bounds = accelerations.iter().map(|row| acceleration_bound(row, b_max));
    // With a reserve for the tolerance of the solver.
    let u_max = bounds.fold(f64::INFINITY, f64::min) * 1.001;
    let root = b_max.sqrt();
    let mut see = |row: &Row| {
        if row.largest(u_max, b_max, root) > 1.0 {
            take(row);
        }
    };
    accelerations.iter().for_each(&mut see);
    (0..DOF).for_each(|j| see(&torque_row(point, limits, j)));
    point.tcp_rows.iter().for_each(see);
}

/// The limited quantity of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RowKind {
    Acceleration,
    Torque,
    Tcp,
}

/// The kind of the most used row of the profile b on interval k.
pub(crate) fn tightest_row(
    grid: &PathGrid,
    limits: &PathLimits,
    b: &[f64],
    interval: usize,
) -> RowKind {
    let u = (b[interval + 1] - b[interval]) / (2.0 * grid.delta(interval));
    let mut tightest = (0.0, RowKind::Acceleration);
    for (point, b) in grid.ends()[interval].iter().zip(&b[interval..interval + 2]) {
        let mut see = |row: Row, kind: RowKind| {
            let value = row.value(u, *b).abs();
            if value > tightest.0 {
                tightest = (value, kind);
            }
        };
        for j in 0..DOF {
            see(acceleration_row(point, limits, j), RowKind::Acceleration);
            see(torque_row(point, limits, j), RowKind::Torque);
        }
        for row in point.tcp_rows {
            see(row, RowKind::Tcp);
        }
    }
    tightest.1
}

/// The largest used share of a limit of the profile b (one per node) at the ends of the intervals:
/// joint accelerations, torques, TCP accelerations and b. Infinite if the number of nodes differs.
pub fn worst_ratio(grid: &PathGrid, limits: &PathLimits, b: &[f64]) -> f64 {
    if b.len() != grid.s().len() {
        return f64::INFINITY;
    }
    let speed = (0..=grid.intervals()).map(|node| b[node] / grid.b_max(node));
    let mut worst = speed.fold(0.0, f64::max);
    for (k, pair) in grid.ends().iter().enumerate() {
        let u = (b[k + 1] - b[k]) / (2.0 * grid.delta(k));
        for (point, b) in pair.iter().zip(&b[k..k + 2]) {
            worst = worst.max(ratio(point, limits, u, *b));
        }
    }
    worst
}

/// The largest used share of the acceleration and torque limits of a point at u and b.
fn ratio(point: &PathPoint, limits: &PathLimits, u: f64, b: f64) -> f64 {
    let v = b.sqrt();
    let joints = (0..DOF).map(|j| {
        let acceleration = (point.q1[j] * u + point.q2[j] * b)
            / (limits.acceleration[j] * point.capability[j])
            + point.bias[j];
        let load = point.m[j] * u + point.c[j] * b + point.g[j];
        let friction = point.coulomb[j] + point.viscous[j] * v;
        acceleration.abs().max((load + friction).abs() / limits.torque[j])
    });
    let tcp = point.tcp_rows.iter().map(|row| row.value(u, b).abs());
    joints.chain(tcp).fold(0.0, f64::max)
}

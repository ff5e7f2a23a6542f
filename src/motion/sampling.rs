//! From a joint path to the grid that the timing solvers see.

use super::timing::grid::{GridError, PathGrid, PathPoint};
use crate::dynamics::{Data, Load, rnea};
use crate::path::joint_path::{DOF, Extent, JointPath, Joints, Piece, PieceKind};
use crate::robot::Model;

/// Speed limits of one leg.
#[derive(Clone, Copy, Debug)]
pub struct SpeedCap {
    /// TCP speed, m/s.
    pub tcp: f64,
    /// Reorientation speed, rad/s.
    pub orientation: f64,
}

impl SpeedCap {
    /// No limit but the robot's own.
    pub const NONE: SpeedCap = SpeedCap { tcp: f64::INFINITY, orientation: f64::INFINITY };
}

/// Robot and load of a run.
#[derive(Clone, Copy)]
pub struct Loaded<'a> {
    /// The robot.
    pub model: &'a Model,
    /// What the flange carries.
    pub load: &'a Load,
}

/// Fewest intervals of a leg.
const LEG_INTERVALS: usize = 4;
/// Intervals of a zone.
const ZONE_INTERVALS: usize = 8;
/// Nodes nearer to each other than this share of the path are one.
const NODE_DISTANCE: f64 = 1e-4;

/// Nodes in s: about `count` intervals in all, closer towards the ends of the legs, where speeds
/// change; and the edges and kinks of the zones.
pub fn nodes(path: &JointPath, count: usize) -> Vec<f64> {
    let length = path.length();
    let mut nodes = vec![0.0];
    let mut begin = 0.0;
    for leg in path.legs() {
        let end = path.leg_end(leg);
        let n = ((end - begin) / length * count as f64).round().max(LEG_INTERVALS as f64);
        nodes.extend((1..=n as usize).map(|i| {
            let share = 0.5 * (1.0 - (std::f64::consts::PI * i as f64 / n).cos());
            begin + (end - begin) * share
        }));
        begin = end;
    }
    // Evenly in each zone, whatever pieces it happens to be made of.
    let mut zone: Option<(f64, f64)> = None;
    let is_zone = |kind: PieceKind| matches!(kind, PieceKind::CartesianZone | PieceKind::JointZone);
    for piece in path.pieces() {
        let end = piece.s + piece.length;
        zone = match (zone, is_zone(piece.kind)) {
            (Some((begin, _)), true) => Some((begin, end)),
            (None, true) => Some((piece.s, end)),
            (found, false) => {
                nodes.extend(found.into_iter().flat_map(zone_nodes));
                None
            }
        };
    }
    nodes.sort_by(f64::total_cmp);
    let mut kept: Vec<f64> = Vec::with_capacity(nodes.len());
    for node in nodes {
        if kept.last().is_none_or(|last| node - last > NODE_DISTANCE * length) {
            kept.push(node);
        }
    }
    if let Some(last) = kept.last_mut() {
        *last = length;
    }
    kept
}

/// The edges of a zone and nodes between them.
fn zone_nodes((begin, end): (f64, f64)) -> impl Iterator<Item = f64> {
    (0..=ZONE_INTERVALS).map(move |i| begin + (end - begin) * i as f64 / ZONE_INTERVALS as f64)
}

/// The grid at these nodes, with the speed caps of the legs.
///
/// # Errors
/// Values that are not finite.
pub fn grid(
    loaded: Loaded<'_>,
    path: &JointPath,
    nodes: &[f64],
    caps: &[SpeedCap],
) -> Result<PathGrid, GridError> {
    let mut data = Data::new();
    let mut ends = Vec::with_capacity(nodes.len());
    for pair in nodes.windows(2) {
        let piece = path.piece_at(0.5 * (pair[0] + pair[1]));
        let extent = path.extent(piece.leg);
        let cap = &caps[piece.leg];
        ends.push([pair[0], pair[1]].map(|s| point(loaded, &mut data, piece, s, cap, extent)));
    }
    PathGrid::new(nodes.to_vec(), ends)
}

fn point(
    Loaded { model, load }: Loaded<'_>,
    data: &mut Data,
    piece: &Piece,
    s: f64,
    cap: &SpeedCap,
    extent: Extent,
) -> PathPoint {
    let at = piece.eval(s);
    let mut v_max = f64::INFINITY;
    if let Some(limits) = &model.limits.velocity {
        for j in 0..DOF {
            if at.q1[j] != 0.0 {
                v_max = v_max.min(limits[j] / at.q1[j].abs());
            }
        }
    }
    let twist = extent.tool.jacobian(model, &at.q) * nalgebra::Vector6::from(at.q1);
    let tcp_rate = twist.fixed_rows::<3>(0).norm();
    let turn_rate = twist.fixed_rows::<3>(3).norm();
    let mut limit = |rate: f64, speed: f64| {
        if rate > 0.0 {
            v_max = v_max.min(speed / rate);
        }
    };
    limit(tcp_rate, model.limits.tcp_speed.unwrap_or(f64::INFINITY));
    if matches!(piece.kind, PieceKind::Joint | PieceKind::JointZone) {
        // The joints keep their ratio: the programmed speed holds on the average.
        limit(extent.length / extent.extent, cap.tcp);
        limit(extent.angle / extent.extent, cap.orientation);
    } else {
        limit(tcp_rate, cap.tcp);
        limit(turn_rate, cap.orientation);
    }
    let mut point = PathPoint::kinematic(at.q, at.q1, at.q2, v_max);
    if model.has_dynamics() {
        let zero = [0.0; DOF];
        let tau = |data: &mut Data, qd: &Joints, qdd: &Joints| -> Joints {
            let tau = rnea(model, data, load, &at.q, qd, qdd);
            std::array::from_fn(|j| tau[j])
        };
        point.g = tau(data, &zero, &zero);
        let m = tau(data, &zero, &at.q1);
        let c = tau(data, &at.q1, &at.q2);
        point.m = std::array::from_fn(|j| m[j] - point.g[j]);
        point.c = std::array::from_fn(|j| c[j] - point.g[j]);
        for j in 0..DOF {
            point.coulomb[j] = model.friction.coulomb[j] * sign(at.q1[j]);
            point.viscous[j] = model.friction.viscous[j] * at.q1[j];
        }
    }
    point
}

fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

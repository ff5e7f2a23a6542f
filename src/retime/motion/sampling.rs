//! The timing grid of a joint path.

use rayon::prelude::*;

use super::controller::interpolation_s;
use super::timing::grid::{GridError, PathGrid, PathPoint, SpeedBound, TCP_ROWS};
use super::timing::row::Row;
use crate::arm::dynamics::{Load, rnea_each};
use crate::arm::kinematics::Tcp;
use crate::arm::robot::Model;
use crate::retime::path::joint_path::{
    DOF, Extent, JointPath, Joints, PathPoint as PiecePoint, Piece, PieceKind,
};

/// Programmed limits of one leg.
#[derive(Clone, Copy, Debug)]
pub struct SpeedCap {
    /// TCP speed, m/s; the mean for a joint movement.
    pub tcp: f64,
    /// Instantaneous TCP speed, m/s: between corner zones, and in them.
    pub peak: [f64; 2],
    /// Joint speeds, rad/s.
    pub joints: Joints,
    /// Reorientation speed, rad/s.
    pub orientation: f64,
    /// Share of the robot accelerations.
    pub acceleration: f64,
    /// Acceleration and deceleration of the TCP along its path, m/s².
    pub path_acceleration: [f64; 2],
    /// Acceleration of the TCP, m/s².
    pub world_acceleration: f64,
}

impl SpeedCap {
    /// No programmed limit.
    pub const NONE: SpeedCap = SpeedCap {
        tcp: f64::INFINITY,
        peak: [f64::INFINITY; 2],
        joints: [f64::INFINITY; DOF],
        orientation: f64::INFINITY,
        acceleration: 1.0,
        path_acceleration: [f64::INFINITY; 2],
        world_acceleration: f64::INFINITY,
    };
}

/// Robot and load of a run.
#[derive(Clone, Copy)]
pub struct Loaded<'a> {
    /// The robot.
    pub model: &'a Model,
    /// Tool and payload.
    pub load: &'a Load,
}

/// Fewest intervals of a leg.
const LEG_INTERVALS: usize = 4;
/// Intervals of a zone.
const ZONE_INTERVALS: usize = 8;
/// Halvings of the first and last interval: a slow motion reaches its speed early.
const END_HALVINGS: i32 = 8;
/// Nodes closer to each other are merged; m of the path or share of a short one.
const NODE_DISTANCE: (f64, f64) = (1e-5, 1e-4);

/// Nodes in s: about `count` intervals in total, denser at the ends of legs, where speeds change;
/// nodes of the zones; and nodes at narrow peaks of joint speeds.
pub fn nodes(model: &Model, path: &JointPath, caps: &[SpeedCap], count: usize) -> Vec<f64> {
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
    let ends = [nodes[1], length - nodes[nodes.len() - 2]];
    for k in 1..=END_HALVINGS {
        let [first, last] = ends.map(|interval| interval * 0.5_f64.powi(k));
        nodes.extend([first, length - last]);
    }
    // Uniform in each zone, independent of its pieces.
    for (begin, end) in zones(path) {
        let node = |i: usize| begin + (end - begin) * i as f64 / ZONE_INTERVALS as f64;
        nodes.extend((0..=ZONE_INTERVALS).map(node));
    }
    nodes.sort_by(f64::total_cmp);
    let apart = NODE_DISTANCE.0.min(NODE_DISTANCE.1 * length);
    let mut kept: Vec<f64> = Vec::with_capacity(nodes.len());
    for node in nodes {
        if kept.last().is_none_or(|last| node - last > apart) {
            kept.push(node);
        }
    }
    if let Some(last) = kept.last_mut() {
        *last = length;
    }
    let Some(joints) = &model.limits.velocity else { return kept };
    let bounds = SpeedBounds { joints, path, caps };
    let mut nodes = Vec::with_capacity(kept.len());
    let mut begin = (kept[0], bounds.square(kept[0]));
    for node in &kept[1..] {
        let end = (*node, bounds.square(*node));
        nodes.push(begin.0);
        bounds.peaks([begin, end], PEAK_HALVINGS, &mut nodes);
        begin = end;
    }
    nodes.push(begin.0);
    nodes
}

/// Accepted ratio of a joint speed between two nodes to its limit.
const PEAK: f64 = 1.002;
/// Largest number of halvings of an interval for this.
const PEAK_HALVINGS: usize = 8;

/// The largest ṡ² under the joint speed limits and the programmed speed.
struct SpeedBounds<'a> {
    joints: &'a [f64],
    path: &'a JointPath,
    caps: &'a [SpeedCap],
}

impl SpeedBounds<'_> {
    fn square(&self, s: f64) -> f64 {
        let piece = self.path.piece_at(s);
        let extent = self.path.extent(piece.leg);
        let programmed = self.caps[piece.leg].tcp * extent.extent / extent.length;
        let q1 = piece.rates(s);
        let joints = (0..DOF).map(|j| self.joints[j] / q1[j].abs()).fold(f64::INFINITY, f64::min);
        programmed.min(joints).powi(2)
    }

    /// Adds nodes where ṡ², linear between two nodes, would exceed the bound: joint speeds have
    /// narrow peaks near a singularity.
    fn peaks(&self, [begin, end]: [(f64, f64); 2], halvings: usize, nodes: &mut Vec<f64>) {
        let s = 0.5 * (begin.0 + end.0);
        let middle = (s, self.square(s));
        if halvings > 0 && 0.5 * (begin.1 + end.1) > PEAK * PEAK * middle.1 {
            self.peaks([begin, middle], halvings - 1, nodes);
            nodes.push(s);
            self.peaks([middle, end], halvings - 1, nodes);
        }
    }
}

/// Start and end of each zone in s.
fn zones(path: &JointPath) -> Vec<(f64, f64)> {
    let mut zones: Vec<(f64, f64)> = Vec::new();
    let mut corner = None;
    for piece in path.pieces().iter().filter(|piece| piece.kind.is_zone()) {
        let end = piece.s + piece.length;
        // Zones may touch; each lies around the end of one leg.
        let before = piece.leg.checked_sub(1).map_or(0.0, |leg| path.leg_end(leg));
        let starts = piece.s - before < path.leg_end(piece.leg) - end;
        let around = if starts { piece.leg.saturating_sub(1) } else { piece.leg };
        match zones.last_mut() {
            Some(zone) if corner == Some(around) => zone.1 = end,
            _ => zones.push((piece.s, end)),
        }
        corner = Some(around);
    }
    zones
}

/// The grid at these nodes with the speed caps of the legs.
///
/// # Errors
/// Values that are not finite.
pub fn grid(
    loaded: Loaded<'_>,
    path: &JointPath,
    nodes: &[f64],
    caps: &[SpeedCap],
) -> Result<PathGrid, GridError> {
    let zones = zones(path);
    let last = nodes.len().saturating_sub(1);
    if last <= TOGETHER {
        return PathGrid::new(nodes.to_vec(), ends(loaded, path, &zones, nodes, caps));
    }
    let stretches: Vec<Vec<[PathPoint; 2]>> = (0..last)
        .into_par_iter()
        .step_by(TOGETHER)
        .map(|from| ends(loaded, path, &zones, &nodes[from..=(from + TOGETHER).min(last)], caps))
        .collect();
    PathGrid::new(nodes.to_vec(), stretches.concat())
}

/// Intervals per parallel task.
const TOGETHER: usize = 128;

/// Values at both ends of each interval between the nodes.
fn ends(
    loaded: Loaded<'_>,
    path: &JointPath,
    zones: &[(f64, f64)],
    nodes: &[f64],
    caps: &[SpeedCap],
) -> Vec<[PathPoint; 2]> {
    let mut zones = zones.iter().peekable();
    let mut ends: Vec<[PathPoint; 2]> = Vec::with_capacity(nodes.len());
    let mut before = None;
    for pair in nodes.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        while zones.peek().is_some_and(|(_, end)| *end < middle) {
            zones.next();
        }
        let zone = zones.peek().filter(|(begin, _)| *begin <= middle);
        let piece = path.piece_at(middle);
        let limits = Bounds {
            cap: &caps[piece.leg],
            extent: path.extent(piece.leg),
            zone: zone.map(|(begin, end)| end - begin),
        };
        // Within a leg and a zone the path is smooth: both sides of a node have the same values.
        let stretch = (piece.leg, piece.kind, limits.zone);
        let begin = match ends.last() {
            Some([_, end]) if before == Some(stretch) => *end,
            _ => point(loaded, piece, pair[0], &limits),
        };
        before = Some(stretch);
        ends.push([begin, point(loaded, piece, pair[1], &limits)]);
    }
    ends
}

/// Speed bounds of an interval other than the joint limits.
struct Bounds<'a> {
    cap: &'a SpeedCap,
    extent: Extent,
    /// Length of the zone that contains it.
    zone: Option<f64>,
}

fn point(
    Loaded { model, load }: Loaded<'_>,
    piece: &Piece,
    s: f64,
    Bounds { cap, extent, zone }: &Bounds<'_>,
) -> PathPoint {
    let at = piece.eval(s);
    let mut slowest = (f64::INFINITY, SpeedBound::None);
    let mut limit = |rate: f64, speed: f64, bound: SpeedBound| {
        if rate > 0.0 && speed / rate < slowest.0 {
            slowest = (speed / rate, bound);
        }
    };
    if let Some(limits) = &model.limits.velocity {
        for j in 0..DOF {
            limit(at.q1[j].abs(), limits[j], SpeedBound::Joint);
        }
    }
    for j in 0..DOF {
        limit(at.q1[j].abs(), cap.joints[j], SpeedBound::Joint);
    }
    let rotations = model.kinematics.rotations(&at.q);
    let twist = extent.tool.twist_of(model, &at.q, &rotations, &at.q1);
    let tcp_rate = twist.fixed_rows::<3>(0).norm();
    let turn_rate = twist.fixed_rows::<3>(3).norm();
    limit(tcp_rate, model.limits.tcp_speed.unwrap_or(f64::INFINITY), SpeedBound::Robot);
    // Joints keep their ratio, so the programmed speed holds on average.
    let (programmed, turn) = match piece.kind {
        PieceKind::Joint | PieceKind::JointZone => {
            (extent.length / extent.extent, extent.angle / extent.extent)
        }
        PieceKind::Cartesian | PieceKind::CartesianZone => (tcp_rate, turn_rate),
    };
    limit(programmed, cap.tcp, SpeedBound::Programmed);
    limit(tcp_rate, cap.peak[usize::from(zone.is_some())], SpeedBound::Programmed);
    limit(turn, cap.orientation, SpeedBound::Reorientation);
    if let Some(zone) = zone {
        // The interpolator takes at least one step per zone, as runs with z1 show.
        limit(1.0, zone / interpolation_s(model), SpeedBound::Zone);
    }
    let (v_max, v_bound) = slowest;
    let mut point = PathPoint::kinematic(at.q, at.q1, at.q2, v_max);
    point.v_bound = v_bound;
    if let (Some(by_pose), Some(limits)) =
        (&model.limits.acceleration_by_pose, &model.limits.acceleration)
    {
        for (j, capability) in by_pose.at(&at.q).into_iter().enumerate() {
            point.capability[j] = capability.acceleration / limits[j];
            point.bias[j] = capability.weight;
        }
    }
    point.capability = point.capability.map(|share| share * cap.acceleration);
    point.tcp_rows = tcp_rows(model, &at, &extent.tool, &twist, cap);
    if model.has_dynamics() {
        let motions: [[&[f64]; 2]; 3] = [[&[], &[]], [&[], &at.q1], [&at.q1, &at.q2]];
        let [g, m, c] = rnea_each(model, load, &rotations, motions);
        point.g = std::array::from_fn(|j| g[j]);
        point.m = std::array::from_fn(|j| m[j] - g[j]);
        point.c = std::array::from_fn(|j| c[j] - g[j]);
        for j in 0..DOF {
            point.coulomb[j] = model.friction.coulomb[j] * sign(at.q1[j]);
            point.viscous[j] = model.friction.viscous[j] * at.q1[j];
        }
    }
    point
}

/// TCP speed over path speed below which the TCP turns back.
const TURNS_BACK: f64 = 1e-5;

/// Inradius of a regular octagon in the unit circle; the same times √2 for its diagonal sides.
const OCTAGON: [f64; 2] = [0.923_879_532_511_286_7, 1.306_562_964_876_376_5];

/// The rows of `PathAccLim` and `WorldAccLim`: with p' and p'' of the TCP the acceleration is
/// p' s̈ + p'' ṡ², split into the components along and across the path.
fn tcp_rows(
    model: &Model,
    at: &PiecePoint,
    tool: &Tcp,
    twist: &nalgebra::Vector6<f64>,
    cap: &SpeedCap,
) -> [Row; TCP_ROWS] {
    let mut rows = [Row::default(); TCP_ROWS];
    let [up, down] = cap.path_acceleration;
    let world = cap.world_acceleration;
    if !(up.is_finite() || down.is_finite() || world.is_finite()) {
        return rows;
    }
    let rate = twist.fixed_rows::<3>(0).into_owned();
    let speed = rate.norm();
    let bend = tool.jacobian(model, &at.q) * nalgebra::Vector6::from(at.q2)
        + tool.jacobian_dot(model, &at.q, &at.q1) * nalgebra::Vector6::from(at.q1);
    let bend = bend.fixed_rows::<3>(0).into_owned();
    // Where the TCP turns back, it moves along its acceleration just before and behind.
    let along = if speed < TURNS_BACK { bend.norm() } else { bend.dot(&rate) / speed };
    let across = if speed < TURNS_BACK { 0.0 } else { (bend - rate * (along / speed)).norm() };
    let row = |t: f64, n: f64, limit: f64, constant: f64| Row {
        u: t * speed / limit,
        b: (t * along + n * across) / limit,
        constant,
        ..Row::default()
    };
    if up.is_finite() || down.is_finite() {
        // An unlimited side has a very large limit.
        let [up, down] = [up, down].map(|x| x.min(NO_ACCELERATION_LIMIT));
        let half = 0.5 * (up + down);
        rows[0] = row(1.0, 0.0, half, 0.5 * (down - up) / half);
    }
    if world.is_finite() {
        let [flat, corner] = OCTAGON.map(|x| x * world);
        rows[1] = row(1.0, 0.0, flat, 0.0);
        rows[2] = row(0.0, 1.0, flat, 0.0);
        rows[3] = row(1.0, 1.0, corner, 0.0);
        rows[4] = row(1.0, -1.0, corner, 0.0);
    }
    rows
}

/// Stands for an unlimited acceleration, m/s².
const NO_ACCELERATION_LIMIT: f64 = 1e3;

/// Joint rate on the path at rounding level, rad per unit of s.
const STILL: f64 = 1e-9;

/// The sign of a joint rate, 0 at rest.
fn sign(rate: f64) -> f64 {
    if rate.abs() < STILL { 0.0 } else { rate.signum() }
}

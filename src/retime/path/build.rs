//! Joint paths from legs.

use nalgebra::{Isometry3, Matrix6, UnitQuaternion, Vector3, Vector6};

use super::axiswise::Wrist;
use super::blend;
use super::curve::{self, Curve, CurvePoint};
use super::joint_path::{DOF, Extent, JointPath, Joints, PathPoint, Piece, PieceKind};
use super::leg::{Leg, LegKind, PathError, first_difference};
use crate::arm::kinematics::{fk, ik_near, limits_ok};
use crate::arm::robot::Model;

/// Parameter length of a rotation of the tool or of a joint without TCP motion, m/rad.
const METRES_PER_RADIAN: f64 = 0.1;
/// Parameter length below which a leg does not move, m.
const NO_MOTION: f64 = 1e-7;
/// Longest piece of a Cartesian curve, m.
pub(super) const MAX_PIECE: f64 = 0.04;
/// Largest distance of the middle of a piece from the exact joint angles, rad.
const PIECE_TOLERANCE: f64 = 2e-7;
/// Shortest piece, m: a line that needs shorter ones is singular.
const MIN_PIECE: f64 = 1e-5;
/// Joint motion per TCP path above which a line is singular, rad/m.
const SINGULAR_RATE: f64 = 300.0;
/// Samples for the TCP length of a joint leg.
const LENGTH_SAMPLES: usize = 24;

/// A leg with its lengths and its curve.
pub(super) struct Measured<'a> {
    leg: &'a Leg,
    index: usize,
    /// TCP length, m.
    length: f64,
    /// Rotation angle of the tool, rad.
    angle: f64,
    /// Length in the parameter s.
    extent: f64,
    /// The Cartesian curve over [0, extent]; `None` for joint legs.
    pub(super) curve: Option<Curve>,
    /// The wrist angles, if they are interpolated axis by axis.
    wrist: Option<Wrist>,
}

/// The joint paths of a run: legs with zones between them. A corner without space for a zone (a
/// rotation on the spot next to a line, a zone of size 0) ends one path and begins the next: the
/// robot stops there.
///
/// # Errors
/// A leg that cannot be followed.
pub fn build(model: &Model, legs: &[Leg]) -> Result<Vec<JointPath>, PathError> {
    let mut paths = Vec::new();
    let mut start = legs.first().map_or([0.0; DOF], |leg| leg.start);
    let mut open: Vec<Measured<'_>> = Vec::new();
    for (index, leg) in legs.iter().enumerate() {
        let measured = measure(model, leg, index, &start)?;
        start = leg.end;
        if measured.extent < NO_MOTION {
            continue;
        }
        let rounded = open.last().is_some_and(|before| zone_size(before, &measured) > 0.0);
        if !rounded && !open.is_empty() {
            paths.push(assemble(model, &open)?);
            open.clear();
        }
        open.push(measured);
    }
    if !open.is_empty() {
        paths.push(assemble(model, &open)?);
    }
    Ok(paths)
}

/// Lengths and curve of a leg that starts at the joint angles `start` (rad).
pub(super) fn measure<'a>(
    model: &Model,
    leg: &'a Leg,
    index: usize,
    start: &Joints,
) -> Result<Measured<'a>, PathError> {
    let from = leg.tool.pose(&fk(model, start));
    let to = leg.target;
    let turn = curve::rotation_between(&from.rotation, &to.rotation);
    let angle = turn.norm();
    let (length, curve) = match &leg.kind {
        LegKind::Joint => {
            let mut length = 0.0;
            let mut last = from.translation.vector;
            for i in 1..=LENGTH_SAMPLES {
                let q = along(start, &leg.end, i as f64 / LENGTH_SAMPLES as f64);
                let here = leg.tool.pose(&fk(model, &q)).translation.vector;
                length += (here - last).norm();
                last = here;
            }
            (length, None)
        }
        LegKind::Line => line(&from, &to, &turn),
        LegKind::Arc(via) => {
            let (a, b) = (from.translation.vector, to.translation.vector);
            let via = via.translation.vector;
            if let Some((center, normal, arc)) = curve::circle(&a, &via, &b) {
                let length = arc * (a - center).norm();
                let extent = length.max(METRES_PER_RADIAN * angle);
                let curve = Curve::Arc {
                    start: from.rotation,
                    center,
                    radius: a - center,
                    normal,
                    rate: arc / extent,
                    turn: turn / extent,
                    length: extent,
                };
                (length, Some(curve))
            } else if (via - a).dot(&(b - via)) > 0.0 {
                // Via point on the chord: logged runs follow the line.
                line(&from, &to, &turn)
            } else {
                return Err(PathError::FlatArc { leg: index });
            }
        }
    };
    let extent = if let Some(curve) = &curve {
        curve.length()
    } else {
        let widest = (0..DOF).map(|j| (leg.end[j] - start[j]).abs()).fold(0.0, f64::max);
        length.max(METRES_PER_RADIAN * widest)
    };
    let wrist = (leg.axiswise && curve.is_some()).then(|| Wrist::new(start, &leg.end, extent));
    Ok(Measured { leg, index, length, angle, extent, curve, wrist })
}

/// TCP length of a line (m) and its curve; `None` if it does not move.
fn line(from: &Isometry3<f64>, to: &Isometry3<f64>, turn: &Vector3<f64>) -> (f64, Option<Curve>) {
    let chord = to.translation.vector - from.translation.vector;
    let length = chord.norm();
    let extent = length.max(METRES_PER_RADIAN * turn.norm());
    let curve = (extent >= NO_MOTION).then(|| Curve::Line {
        start: *from,
        direction: chord / extent,
        turn: turn / extent,
        length: extent,
    });
    (length, curve)
}

fn along(a: &Joints, b: &Joints, share: f64) -> Joints {
    std::array::from_fn(|j| a[j] + (b[j] - a[j]) * share)
}

/// Size in s of the zone between two legs, equal on both sides; 0 without a zone.
///
/// A zone is limited to half of the shorter leg. If the tool rotates much, the smallest of the
/// relative sizes holds (RAPID reference, zonedata).
fn zone_size(before: &Measured<'_>, after: &Measured<'_>) -> f64 {
    let zone = &before.leg.zone;
    let turning = |leg: &Measured<'_>| leg.length < METRES_PER_RADIAN * leg.angle * 0.01;
    if turning(before) != turning(after) {
        return 0.0;
    }
    let share = |leg: &Measured<'_>| {
        let by_length = if leg.length > NO_MOTION { zone.tcp / leg.length } else { 0.5 };
        let by_angle = if leg.angle > NO_MOTION { zone.angle / leg.angle } else { 0.5 };
        0.5_f64.min(by_length).min(by_angle)
    };
    let size = |leg: &Measured<'_>| share(leg) * leg.extent;
    let size = size(before).min(size(after));
    if size < NO_MOTION { 0.0 } else { size }
}

/// One path of legs with zones between all of them.
fn assemble(model: &Model, legs: &[Measured<'_>]) -> Result<JointPath, PathError> {
    let mut builder = Builder { model, pieces: Vec::new(), s: 0.0, q: legs[0].leg.start };
    let mut trimmed = 0.0;
    // Joint angles at the programmed start of the current leg.
    let mut corner = legs[0].leg.start;
    for (i, leg) in legs.iter().enumerate() {
        let next = legs.get(i + 1);
        let zone = next.map_or(0.0, |next| zone_size(leg, next));
        let reached = builder.follow(leg, &corner, trimmed, leg.extent - zone)?;
        if let Some(joint) = first_difference(&reached, &leg.leg.end) {
            return Err(PathError::Configuration { leg: leg.index, joint });
        }
        if let Some(next) = next {
            builder.round(leg, next, zone, &corner, &leg.leg.end)?;
        }
        corner = leg.leg.end;
        trimmed = zone;
    }
    // A leg that does not move has no piece; the others keep their indices.
    let first = legs[0].index;
    let last = legs[legs.len() - 1].index;
    let extents = (first..=last).map(|index| {
        let leg = &legs[legs.partition_point(|leg| leg.index <= index) - 1];
        let flat_arc = matches!(leg.leg.kind, LegKind::Arc(_))
            && matches!(leg.curve, Some(Curve::Line { .. }));
        Extent {
            length: leg.length,
            angle: leg.angle,
            extent: leg.extent,
            tool: leg.leg.tool,
            flat_arc,
        }
    });
    let ends = [legs[0].leg.start, legs[legs.len() - 1].leg.end];
    Ok(JointPath::new(builder.pieces, first, extents.collect(), ends))
}

struct Builder<'a> {
    model: &'a Model,
    pieces: Vec<Piece>,
    s: f64,
    /// Joint angles at the end of the last piece; they select the inverse solution.
    q: Joints,
}

impl Builder<'_> {
    /// The part [from, to] of a leg; returns the joint angles at its programmed end, reached along it.
    fn follow(
        &mut self,
        leg: &Measured<'_>,
        start: &Joints,
        from: f64,
        to: f64,
    ) -> Result<Joints, PathError> {
        match &leg.curve {
            None => {
                let end = leg.leg.end;
                if to - from > NO_MOTION {
                    let (a, b) = (joint_point(leg, start, from), joint_point(leg, start, to));
                    self.push(leg.index, PieceKind::Joint, to - from, &a, &b);
                }
                self.q = joint_point(leg, start, to).q;
                // The joint range is convex except for conditional limits: four samples suffice.
                for share in [0.25, 0.5, 0.75, 1.0] {
                    self.check_limits(leg, &along(start, &end, share), share)?;
                }
                Ok(end)
            }
            Some(curve) => {
                if to - from > NO_MOTION {
                    self.trace(leg, curve, PieceKind::Cartesian, from, to)?;
                }
                // Continue to the programmed end, for the configuration there.
                let mut q = self.q;
                let rest = curve.length() - to;
                let steps = (rest / MAX_PIECE).ceil().max(1.0) as usize;
                for i in 1..=steps {
                    let x = to + rest * i as f64 / steps as f64;
                    q = self.solve(leg, &curve.eval(x), &q, x)?;
                }
                Ok(q)
            }
        }
    }

    /// The zone between two legs, one half on each.
    fn round(
        &mut self,
        before: &Measured<'_>,
        after: &Measured<'_>,
        size: f64,
        start: &Joints,
        corner: &Joints,
    ) -> Result<(), PathError> {
        match (&before.curve, &after.curve) {
            (Some(Curve::Line { .. }), Some(Curve::Line { .. }))
                if before.leg.tool == after.leg.tool
                    && before.wrist.is_none()
                    && after.wrist.is_none() =>
            {
                let curve = cartesian_corner(before, after, size);
                for pair in blend::KINKS.windows(2) {
                    let leg = if pair[1] <= 0.0 { before } else { after };
                    let (from, to) = (size * (1.0 + pair[0]), size * (1.0 + pair[1]));
                    self.trace(leg, &curve, PieceKind::CartesianZone, from, to)?;
                }
                Ok(())
            }
            (None, None) => {
                let rate = |leg: &Measured<'_>, a: &Joints| -> Joints {
                    std::array::from_fn(|j| (leg.leg.end[j] - a[j]) / leg.extent)
                };
                let (d1, d2) = (rate(before, start), rate(after, corner));
                let at = |z: f64| {
                    let [integral, weight, slope] = blend::turn(z);
                    PathPoint {
                        q: std::array::from_fn(|j| {
                            corner[j] + size * (d1[j] * z + (d2[j] - d1[j]) * integral)
                        }),
                        q1: std::array::from_fn(|j| d1[j] + (d2[j] - d1[j]) * weight),
                        q2: std::array::from_fn(|j| (d2[j] - d1[j]) * slope / size),
                    }
                };
                for pair in blend::KINKS.windows(2) {
                    let index = if pair[1] <= 0.0 { before.index } else { after.index };
                    let length = size * (pair[1] - pair[0]);
                    let (a, b) = (at(pair[0]), at(pair[1]));
                    self.push(index, PieceKind::JointZone, length, &a, &b);
                }
                self.q = at(1.0).q;
                self.check_limits(before, &at(0.0).q, 1.0)
            }
            _ => {
                let a = self.leg_point(before, start, before.extent - size, &self.q)?;
                // The inverse solution after the corner is continued from the corner.
                let b = self.leg_point(after, corner, size, corner)?;
                let whole = Piece::hermite((0.0, 2.0 * size), 0, PieceKind::JointZone, &a, &b);
                let middle = whole.eval(size);
                self.check_limits(before, &middle.q, 1.0)?;
                self.push(before.index, PieceKind::JointZone, size, &a, &middle);
                self.push(after.index, PieceKind::JointZone, size, &middle, &b);
                self.q = b.q;
                Ok(())
            }
        }
    }

    /// Pieces along a TCP curve, each within the tolerance.
    fn trace(
        &mut self,
        leg: &Measured<'_>,
        curve: &Curve,
        kind: PieceKind,
        from: f64,
        to: f64,
    ) -> Result<(), PathError> {
        let q = self.q;
        let mut a = self.curve_point(leg, curve, from, &q)?;
        let mut x = from;
        let mut step = MAX_PIECE;
        while to - x > NO_MOTION {
            let h = step.min(to - x);
            let b = self.curve_point(leg, curve, x + h, &a.q)?;
            let middle = self.solve(leg, &curve.eval(x + 0.5 * h), &a.q, x + 0.5 * h)?;
            let piece = Piece::hermite((0.0, h), leg.index, kind, &a, &b);
            let got = piece.eval(0.5 * h).q;
            let error = (0..DOF).map(|j| (got[j] - middle[j]).abs()).fold(0.0, f64::max);
            if error > PIECE_TOLERANCE && h > MIN_PIECE {
                step = 0.5 * h;
                continue;
            }
            if error > PIECE_TOLERANCE {
                return Err(singular(leg, x));
            }
            self.push(leg.index, kind, h, &a, &b);
            a = b;
            x += h;
            step = (2.0 * h).min(MAX_PIECE);
        }
        self.q = a.q;
        Ok(())
    }

    /// Joint angles and derivatives at x of a curve, on the inverse solution next to `near`.
    fn curve_point(
        &self,
        leg: &Measured<'_>,
        curve: &Curve,
        x: f64,
        near: &Joints,
    ) -> Result<PathPoint, PathError> {
        let at = curve.eval(x);
        let q = self.solve(leg, &at, near, x)?;
        let singular = || singular(leg, x);
        if let Some(wrist) = &leg.wrist {
            let point = wrist.derivatives(self.model, &leg.leg.tool, &at, q);
            return point
                .filter(|p| p.q1.iter().all(|x| x.abs() < SINGULAR_RATE))
                .ok_or_else(singular);
        }
        let j: Matrix6<f64> = leg.leg.tool.jacobian(self.model, &q);
        let lu = j.lu();
        let twist = stack(&at.linear, &at.angular);
        let q1 = lu.solve(&twist).ok_or_else(singular)?;
        if q1.amax() >= SINGULAR_RATE || q1.iter().any(|x| x.is_nan()) {
            return Err(singular());
        }
        let q1: Joints = q1.into();
        let rate: Matrix6<f64> = leg.leg.tool.jacobian_dot(self.model, &q, &q1);
        let bias = rate * Vector6::from(q1);
        let q2 =
            lu.solve(&(stack(&at.linear_rate, &at.angular_rate) - bias)).ok_or_else(singular)?;
        Ok(PathPoint { q, q1, q2: q2.into() })
    }

    fn solve(
        &self,
        leg: &Measured<'_>,
        at: &CurvePoint,
        near: &Joints,
        x: f64,
    ) -> Result<Joints, PathError> {
        // Largest joint step between neighbouring points of one inverse solution, rad.
        const JUMP: f64 = 0.6;
        let tool = &leg.leg.tool;
        let q = match &leg.wrist {
            Some(wrist) => {
                let position = at.pose.translation.vector;
                let solution = wrist.solve(self.model, tool, &position, x, near);
                solution.ok_or_else(|| singular(leg, x))?
            }
            None => ik_near(self.model, &tool.flange(&at.pose), near).map_err(|why| {
                let percent = percent(leg, x);
                PathError::Unreachable { leg: leg.index, percent, why: why.to_string() }
            })?,
        };
        if (0..DOF).any(|j| (q[j] - near[j]).abs() > JUMP) {
            return Err(singular(leg, x));
        }
        self.check_limits(leg, &q, x / leg.extent)?;
        Ok(q)
    }

    /// The point at x of a leg, on the inverse solution next to `near`.
    fn leg_point(
        &self,
        leg: &Measured<'_>,
        start: &Joints,
        x: f64,
        near: &Joints,
    ) -> Result<PathPoint, PathError> {
        match &leg.curve {
            None => Ok(joint_point(leg, start, x)),
            Some(curve) => self.curve_point(leg, curve, x, near),
        }
    }

    fn check_limits(&self, leg: &Measured<'_>, q: &Joints, share: f64) -> Result<(), PathError> {
        limits_ok(self.model, q).map_err(|why| PathError::Unreachable {
            leg: leg.index,
            percent: 100.0 * share.clamp(0.0, 1.0),
            why: why.to_string(),
        })
    }

    fn push(&mut self, leg: usize, kind: PieceKind, length: f64, a: &PathPoint, b: &PathPoint) {
        self.pieces.push(Piece::hermite((self.s, length), leg, kind, a, b));
        self.s += length;
    }
}

fn percent(leg: &Measured<'_>, x: f64) -> f64 {
    (100.0 * x / leg.extent).clamp(0.0, 100.0)
}

fn singular(leg: &Measured<'_>, x: f64) -> PathError {
    PathError::Singular { leg: leg.index, percent: percent(leg, x) }
}

fn joint_point(leg: &Measured<'_>, start: &Joints, x: f64) -> PathPoint {
    let end = &leg.leg.end;
    PathPoint {
        q: along(start, end, x / leg.extent),
        q1: std::array::from_fn(|j| (end[j] - start[j]) / leg.extent),
        q2: [0.0; DOF],
    }
}

fn cartesian_corner(before: &Measured<'_>, after: &Measured<'_>, half: f64) -> Curve {
    let corner = before.leg.target;
    let rates = |leg: &Measured<'_>| match &leg.curve {
        Some(Curve::Line { direction, turn, .. }) => (*direction, *turn),
        _ => (Vector3::zeros(), Vector3::zeros()),
    };
    let ((d1, w1), (d2, w2)) = (rates(before), rates(after));
    let into: UnitQuaternion<f64> = corner.rotation.inverse();
    Curve::Corner { corner, directions: [d1, d2], turns: [into * w1, into * w2], half }
}

fn stack(linear: &Vector3<f64>, angular: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

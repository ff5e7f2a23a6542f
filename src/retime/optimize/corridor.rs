//! The programmed path with tolerances and speed ceilings for a realised motion.

use nalgebra::{Isometry3, Quaternion, SMatrix, Vector3, Vector4};

use super::ceilings::{Ceiling, Ceilings};
use super::freedom::Freedom;
use super::smoothed::{Difference, Located, Slopes, Smoothed};
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::Run;
use crate::retime::path::PieceKind;
use crate::retime::path::joint_path::{DOF, Joints};

/// Distance of the samples of the path, m.
const SPACING: f64 = 0.002;
/// Largest distance (m) and rotation (rad) of two samples at one pose.
const SAME: f64 = 1e-9;
/// Weight of a rotation of the tool in distances, m/rad.
const METRES_PER_RADIAN: f64 = 0.1;
/// Allowed distance from a line or arc, m.
pub const LINE_TOLERANCE: f64 = 0.001;
/// Allowed distance from a joint movement, m.
pub const JOINT_TOLERANCE: f64 = 0.005;
/// Allowed distance in a corner zone, as a share of its size.
pub const ZONE_TOLERANCE: f64 = 0.1;
/// Allowed distance of the polygon near stop points, m: grippers and fixtures are close there.
pub(super) const STOP_TOLERANCE: f64 = 0.0005;
/// Distance from a stop point within which this holds, m: 50 mm and a reserve for the sampling.
const NEAR_STOP: f64 = 0.05 + 3.0 * SPACING;
/// Growth of the polygon tolerance beyond that, m/m: a motion cannot follow a step.
const WIDENING: f64 = 0.05;
/// Number of samples behind and ahead of the last place in which the nearest one is searched.
const WINDOW: (usize, usize) = (8, 24);

/// One sample of the programmed path.
#[derive(Clone, Copy, Debug)]
struct Place {
    pose: Isometry3<f64>,
    /// Largest speeds at this sample.
    ceiling: Ceiling,
    /// Largest distance from this sample, m.
    tolerance: f64,
    /// Largest distance of the polygon through the points, m.
    polygon: f64,
    /// The same near a stop point, m.
    stop_tolerance: f64,
}

/// The programmed path of a run.
#[derive(Clone, Debug)]
pub struct Corridor {
    places: Vec<Place>,
    /// Largest loads and speeds of a stream in the corridor.
    pub(super) ceilings: Ceilings,
    /// Joint angles at the end of the run, rad.
    pub(super) end: Joints,
}

/// Position of a pose relative to the corridor.
#[derive(Clone, Copy, Debug)]
pub struct Offset {
    /// Distance of the TCP, m, including the rotation of the tool.
    pub distance: f64,
    /// Allowed distance, m.
    pub tolerance: f64,
    /// Allowed distance of the polygon through the points, m.
    pub polygon: f64,
    /// Largest speeds.
    pub ceiling: Ceiling,
}

/// Lowers the tolerances of the polygon near both ends of a path.
fn tighten_near_stops(places: &mut [Place]) {
    let stops = [0, places.len() - 1].map(|i| places[i].pose.translation.vector);
    for place in places {
        let distances = stops.map(|stop| (place.pose.translation.vector - stop).norm());
        let beyond = (distances[0].min(distances[1]) - NEAR_STOP).max(0.0);
        place.polygon = place.polygon.min(place.stop_tolerance + WIDENING * beyond);
    }
}

impl Corridor {
    /// The corridor of a run along one path; `None` for streams.
    pub fn new(model: &Model, run: &Run, freedom: &Freedom) -> Option<Corridor> {
        let ceilings = Ceilings::new(model, run, freedom);
        let [(_, TimedMotion::Path(path, _))] = run.motions.as_slice() else { return None };
        let mut places = Vec::new();
        for piece in path.pieces() {
            let movement = &run.moves[piece.leg].movement;
            let before = piece.leg.checked_sub(1);
            // A piece of a zone takes the ceiling of the leg before or after its corner.
            let ceiling = ceilings.moves[piece.leg];
            let is_after_corner = path.leg_end(piece.leg) > piece.s + piece.length + 1e-9;
            // The other leg at the corner of a zone, and the leg at whose end the zone is.
            let (corner, rounded) = match piece.kind.is_zone() {
                true if is_after_corner => (before, before),
                true => (Some(piece.leg + 1), Some(piece.leg)),
                false => (None, None),
            };
            let tolerance = match piece.kind {
                PieceKind::Joint => JOINT_TOLERANCE,
                PieceKind::Cartesian => LINE_TOLERANCE,
                PieceKind::CartesianZone | PieceKind::JointZone => {
                    let size = rounded.map_or(0.0, |leg| run.legs[leg].zone.tcp);
                    LINE_TOLERANCE.max(ZONE_TOLERANCE * size)
                }
            };
            // The path is free in a corner if it is free in both movements.
            let other = corner.and_then(|leg| run.moves.get(leg)).map(|record| &record.movement);
            let movements = std::iter::once(movement).chain(other);
            let free = movements
                .map(|movement| freedom.free_deviation(movement))
                .fold(f64::INFINITY, f64::min);
            // In a corner the joint speeds change from one movement to the next.
            let beyond = corner.and_then(|leg| ceilings.moves.get(leg)).unwrap_or(&ceiling);
            let tcp = if corner.is_some() { ceiling.corner } else { ceiling.tcp };
            let ceiling = Ceiling { tcp, joints: ceiling.max(beyond).joints, ..ceiling };
            let tolerance = tolerance.max(free);
            let stop_tolerance = STOP_TOLERANCE.max(free);
            let extent = path.extent(piece.leg);
            let share = extent.length.max(METRES_PER_RADIAN * extent.angle) / extent.extent;
            // For a rotation by more than π the angle between the end orientations is too small.
            let ends = [piece.s, piece.s + piece.length].map(|s| piece.eval(s).q);
            let turned = (0..DOF).map(|j| (ends[1][j] - ends[0][j]).abs()).fold(0.0, f64::max);
            let way = (piece.length * share).max(METRES_PER_RADIAN * turned);
            let n = (way / SPACING).ceil().max(1.0) as usize;
            let poses: Vec<Isometry3<f64>> = (0..=n)
                .map(|i| piece.s + piece.length * i as f64 / n as f64)
                .map(|s| extent.tool.pose(&fk(model, &piece.eval(s).q)))
                .collect();
            // Without the zone the original passes the corner point: the polygon may do so too.
            let cut = corner.and_then(|other| run.legs.get(other.min(piece.leg))).map(|leg| {
                let corner = extent.tool.pose(&fk(model, &leg.end)).translation.vector;
                let distance = |pose: &Isometry3<f64>| (pose.translation.vector - corner).norm();
                poses.iter().map(distance).fold(f64::INFINITY, f64::min) + LINE_TOLERANCE
            });
            let polygon = cut.map_or(tolerance, |cut| tolerance.max(cut));
            let place = |pose| Place { pose, ceiling, tolerance, polygon, stop_tolerance };
            places.extend(poses.into_iter().map(place));
        }
        tighten_near_stops(&mut places);
        Some(Corridor { places, ceilings, end: run.end })
    }

    /// The offset of a pose. The nearest place is searched near `from`, which is set to it.
    pub fn offset(&self, pose: &Isometry3<f64>, from: &mut usize) -> Offset {
        let begin = from.saturating_sub(WINDOW.0);
        let end = (*from + WINDOW.1).min(self.places.len() - 1);
        let distances = (begin..=end).map(|i| (self.distance(pose, i), i));
        let (distance, nearest) = first_least(distances, *from);
        *from = nearest;
        let place = &self.places[nearest];
        // At the boundary of two stretches the larger tolerance holds.
        let lo = &self.places[nearest.saturating_sub(1)];
        let hi = &self.places[(nearest + 1).min(self.places.len() - 1)];
        Offset {
            distance,
            tolerance: place.tolerance.max(lo.tolerance).max(hi.tolerance),
            polygon: place.polygon.max(lo.polygon).max(hi.polygon),
            ceiling: place.ceiling.max(&lo.ceiling).max(&hi.ceiling),
        }
    }

    /// The limits of a stream at each place without steps: polishing needs derivatives. Each lower TCP
    /// ceiling is extended by `reach` (m) to both sides.
    pub(super) fn smoothed(&self, reach: f64) -> Smoothed {
        let last = self.places.len() - 1;
        let n = (reach / SPACING).ceil() as usize;
        let lowest = |i: usize| {
            let around = i.saturating_sub(n)..=(i + n).min(last);
            self.places[around].iter().map(|p| p.ceiling.tcp).fold(f64::INFINITY, f64::min)
        };
        let each = |value: &dyn Fn(&Place) -> f64| self.places.iter().map(value).collect();
        let ways: Vec<f64> = self
            .places
            .windows(2)
            .map(|pair| difference(&pair[0].pose, &pair[1].pose).norm())
            .collect();
        Smoothed::new(
            &ways,
            (0..=last).map(lowest).collect(),
            std::array::from_fn(|j| each(&|place| place.ceiling.joints[j])),
            each(&|place| place.tolerance),
            each(&|place| place.polygon),
        )
    }

    /// The position of a pose along the places. It is searched near `from`, which is set to the
    /// nearest place.
    pub(super) fn locate(&self, pose: &Isometry3<f64>, from: &mut usize) -> Located {
        let place = self.nearest(pose, from);
        let sides = self.neighbours(place).map(|next| self.aside(pose, place, next));
        if sides[1].distance < sides[0].distance { sides[1] } else { sides[0] }
    }

    /// The derivatives of a position by the joint angles, with the Jacobian of the TCP at the pose.
    pub(super) fn slopes(
        &self,
        at: &Located,
        pose: &Isometry3<f64>,
        jacobian: &SMatrix<f64, 6, DOF>,
    ) -> Slopes {
        let side = same_side(&self.places[at.place].pose, pose);
        let inside = at.share > 0.0 && at.share < 1.0;
        let mut slopes = Slopes::default();
        for j in 0..DOF {
            let moved = jacobian.fixed_view::<3, 1>(0, j).into_owned();
            // The derivative of a unit quaternion is half of the angular velocity times it.
            let turning = Quaternion::from_imag(jacobian.fixed_view::<3, 1>(3, j).into_owned());
            let turned = METRES_PER_RADIAN * side * (turning * pose.rotation.quaternion()).coords;
            let moved = stacked(&moved, &turned);
            if inside {
                slopes.share[j] = moved.dot(&at.along) / at.along.norm_squared();
            }
            if at.distance > 0.0 {
                slopes.distance[j] = moved.dot(&at.offset) / at.distance;
            }
        }
        slopes
    }

    /// The place nearest to a pose. It is searched near `from`, which is set to it.
    fn nearest(&self, pose: &Isometry3<f64>, from: &mut usize) -> usize {
        const STRIDE: usize = 8;
        const AHEAD: usize = 32 * STRIDE;
        let square = |place: &Place| {
            let turn = METRES_PER_RADIAN * turn(&pose.rotation.coords, &place.pose.rotation.coords);
            (pose.translation.vector - place.pose.translation.vector).norm_squared() + turn * turn
        };
        let nearest = |range: &mut dyn Iterator<Item = usize>| {
            first_least(range.map(|i| (square(&self.places[i]), i)), 0).1
        };
        let last = self.places.len() - 1;
        let around = |i: usize| i.saturating_sub(STRIDE)..=(i + STRIDE).min(last);
        let fine = around(*from);
        let (begin, end) = (*fine.start(), *fine.end());
        let mut best = nearest(&mut fine.into_iter());
        // At the end of the window a nearer place may follow.
        if (best == begin && begin > 0) || (best == end && end < last) {
            let window = from.saturating_sub(2 * STRIDE)..=(*from + AHEAD).min(last);
            best = nearest(&mut around(nearest(&mut window.step_by(STRIDE))));
        }
        *from = best;
        best
    }

    /// Distance of a pose from the path stretches before and after a place, m.
    fn distance(&self, pose: &Isometry3<f64>, i: usize) -> f64 {
        self.neighbours(i)
            .map(|k| self.aside(pose, i, k).distance)
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    /// The next and the previous place at another pose, or the last and the first: two pieces of the
    /// path have a place each where they meet.
    fn neighbours(&self, i: usize) -> [usize; 2] {
        let here = &self.places[i].pose;
        let other = |k: &usize| difference(here, &self.places[*k].pose).norm() > SAME;
        let last = self.places.len() - 1;
        [(i..=last).find(other).unwrap_or(last), (0..i).rev().find(other).unwrap_or(0)]
    }

    /// The position of a pose beside the stretch from place `i` to place `k`.
    fn aside(&self, pose: &Isometry3<f64>, i: usize, k: usize) -> Located {
        let from = difference(&self.places[i].pose, pose);
        let along = difference(&self.places[i].pose, &self.places[k].pose);
        let square = along.norm_squared();
        let share = if square > 0.0 { (from.dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
        let offset = from - along * share;
        Located { place: i, next: k, share, distance: offset.norm(), offset, along }
    }
}

/// The first pair of the least number; `otherwise` if there is none.
fn first_least(pairs: impl Iterator<Item = (f64, usize)>, otherwise: usize) -> (f64, usize) {
    pairs.fold((f64::INFINITY, otherwise), |a, b| if b.0 < a.0 { b } else { a })
}

/// Displacement from one pose to another, m, over the difference of their orientations, which for
/// small angles has the length of the angle, as a distance.
fn difference(from: &Isometry3<f64>, to: &Isometry3<f64>) -> Difference {
    let moved = to.translation.vector - from.translation.vector;
    let turned = same_side(from, to) * to.rotation.coords - from.rotation.coords;
    stacked(&moved, &(2.0 * METRES_PER_RADIAN * turned))
}

/// −1 if the quaternions of two near orientations have opposite signs, else 1.
fn same_side(from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
    if from.rotation.coords.dot(&to.rotation.coords) < 0.0 { -1.0 } else { 1.0 }
}

fn stacked(moved: &Vector3<f64>, turned: &Vector4<f64>) -> Difference {
    let mut all = Difference::zeros();
    all.fixed_rows_mut::<3>(0).copy_from(moved);
    all.fixed_rows_mut::<4>(3).copy_from(turned);
    all
}

/// Angle between two orientations, rad; for large angles its chord, which has the same order and
/// needs no inverse trigonometric function.
fn turn(a: &Vector4<f64>, b: &Vector4<f64>) -> f64 {
    (8.0 * (1.0 - a.dot(b).abs()).max(0.0)).sqrt()
}

/// Largest distance of the TCP from each joint axis along the run, m: the weights of joint errors.
pub(super) fn levers(model: &Model, run: &Run) -> Joints {
    let mut lever = [MIN_LEVER; DOF];
    for leg in &run.legs {
        for q in [&leg.start, &leg.end] {
            let j = leg.tool.jacobian(model, q);
            for (i, lever) in lever.iter_mut().enumerate() {
                *lever = lever.max(j.fixed_view::<3, 1>(0, i).norm());
            }
        }
    }
    lever
}

/// Smallest lever, m: a joint whose axis passes through the TCP still turns the tool.
const MIN_LEVER: f64 = 0.1;

#[cfg(test)]
pub(super) mod tests {
    use super::super::allowed::Loads;
    use super::*;
    use crate::arm::kinematics::Tcp;

    /// A corridor along a joint movement, with limits that change along it.
    pub(in super::super) fn along(
        model: &Model,
        tool: &Tcp,
        ends: &[Joints; 2],
    ) -> (Corridor, Smoothed) {
        const PLACES: usize = 40;
        let place = |i: usize| {
            let x = i as f64 / PLACES as f64;
            let q: Joints = std::array::from_fn(|j| ends[0][j] + x * (ends[1][j] - ends[0][j]));
            let fast = 1.0 + 0.3 * x;
            Place {
                pose: tool.pose(&fk(model, &q)),
                ceiling: Ceiling { tcp: fast, corner: fast, joints: [2.0 * fast; DOF] },
                tolerance: 0.001 * fast,
                polygon: 0.002 * fast,
                stop_tolerance: STOP_TOLERANCE,
            }
        };
        let loads = Loads { acceleration: [1.0; DOF], jerk: [1.0; DOF], torque: [1.0; DOF] };
        let ceilings = Ceilings { loads, moves: Vec::new() };
        let corridor =
            Corridor { places: (0..=PLACES).map(place).collect(), ceilings, end: ends[1] };
        let smoothed = corridor.smoothed(0.0);
        (corridor, smoothed)
    }
}

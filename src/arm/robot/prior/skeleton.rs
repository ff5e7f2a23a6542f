//! Links of an arm with known axes and size only.
//!
//! The mass of a gear or tube follows from the moment of what it carries, the outer arm and the
//! payload, so it depends on the remaining path length to the flange. Drives are lumps at the
//! bearings with tubes between them. Constants are fitted to the meshes of 71 ABB robots;
//! docs/robots.md states the accuracy.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use super::known::Shape;
use super::rules::Size;
use crate::arm::robot::geometry::Geometry;

/// Position of a bearing between the two points of its axis nearest to the neighbouring axes; and
/// of the last one.
const BEARING: [f64; 2] = [0.3, 0.5];
/// Factor and exponent of the lump of a drive.
const DRIVE: (f64, f64) = (0.18, 0.8);
/// Lump at the flange relative to a drive there; lump of the foot.
const FLANGE: f64 = 0.3;
const FOOT: f64 = 0.02;
/// Moment of the payload relative to its share of the total mass.
const PAYLOAD: f64 = 2.85;
/// A drive is in the shorter of its two links; share of the arm length below which both are short.
const COMPACT: f64 = 0.05;
/// Density of lumps and tubes including hollows \[kg/m³\].
const DENSITY: f64 = 1000.0;
/// Feet are heavier than meshes indicate: from ten KUKA arms with published masses.
const MOVING: f64 = 0.96;
/// Squared sine of the angle between axes below which they are parallel.
const PARALLEL: f64 = 1e-6;
/// Distances below this are zero \[m\].
const SHORT: f64 = 1e-9;

type Point = Vector3<f64>;

/// The line of the arm at joint angles 0, in the base frame.
struct Line {
    /// Foot, bearings, flange \[m\].
    points: Vec<Point>,
    /// Rotations and origins \[m\] of the joint frames.
    frames: Vec<(Matrix3<f64>, Point)>,
}

impl Line {
    fn new(geometry: &Geometry) -> Line {
        let mut frames: Vec<(Matrix3<f64>, Point)> = Vec::new();
        let (mut turn, mut at) = (Rotation3::identity(), Point::zeros());
        for joint in &geometry.joints {
            at += turn * joint.translation;
            turn *= joint.rotation;
            frames.push((*turn.matrix(), at));
        }
        let flange = at + turn * geometry.flange.translation.vector;
        let axes: Vec<(Point, Unit<Point>)> = geometry
            .joints
            .iter()
            .zip(&frames)
            .map(|(joint, (turn, at))| (*at, Unit::new_normalize(turn * joint.axis.into_inner())))
            .collect();
        let count = axes.len();
        let mut points = vec![projected(&axes[0], &Point::zeros())];
        for i in 0..count {
            let before = if i == 0 { Some(points[0]) } else { nearest(&axes[i], &axes[i - 1]) };
            let behind = match axes.get(i + 1) {
                Some(next) => nearest(&axes[i], next),
                None => Some(projected(&axes[i], &flange)),
            };
            let alone = projected(&axes[i], &points[points.len() - 1]);
            let low = before.or(behind).unwrap_or(alone);
            let high = behind.or(before).unwrap_or(alone);
            points.push(low + BEARING[usize::from(i + 1 == count)] * (high - low));
        }
        points.push(flange);
        Line { points, frames }
    }
}

fn projected((at, axis): &(Point, Unit<Point>), point: &Point) -> Point {
    at + axis.into_inner() * (point - at).dot(axis)
}

/// The point of a line nearest to another line; `None` if they are parallel.
fn nearest((at, axis): &(Point, Unit<Point>), other: &(Point, Unit<Point>)) -> Option<Point> {
    let cross = axis.cross(&other.1);
    let square = cross.norm_squared();
    (square > PARALLEL)
        .then(|| at + axis.into_inner() * (other.0 - at).cross(&other.1).dot(&cross) / square)
}

/// A body in the base frame.
struct Body {
    /// kg.
    mass: f64,
    /// Centre of mass \[m\].
    at: Point,
    /// Inertia about the centre of mass \[kg m²\].
    inertia: Matrix3<f64>,
}

fn sphere(mass: f64, at: Point) -> Body {
    let radius = (3.0 * mass / (4.0 * std::f64::consts::PI * DENSITY)).cbrt();
    Body { mass, at, inertia: Matrix3::identity() * (0.4 * mass * radius * radius) }
}

/// A tube along `way` in a link of the mass `link`.
fn tube(mass: f64, at: Point, way: &Point, link: f64) -> Body {
    let length = way.norm();
    let round = (3.0 * link / (4.0 * std::f64::consts::PI * DENSITY)).powf(2.0 / 3.0);
    let square = (mass / (std::f64::consts::PI * DENSITY * length.max(SHORT))).min(round);
    let across = mass * (3.0 * square + length * length) / 12.0;
    let along = 0.5 * mass * square;
    let axis = way / length.max(SHORT);
    Body {
        mass,
        at,
        inertia: Matrix3::identity() * across + axis * axis.transpose() * (along - across),
    }
}

/// Remaining path length from each point (foot first) to the flange over the whole length.
fn remaining_lengths(points: &[Point]) -> Vec<f64> {
    let mut left = vec![0.0; points.len()];
    for i in (0..points.len() - 1).rev() {
        left[i] = left[i + 1] + (points[i + 1] - points[i]).norm();
    }
    let whole = left[0].max(SHORT);
    left.iter().map(|rest| rest / whole).collect()
}

/// Smallest remaining path length from the middle of a link: a flange has a length even if a file
/// places it in the last joint.
const LEAST_REMAINDER: f64 = 0.003;

/// Remaining path length from the middle of each link over the whole length, the basis of the
/// common variation of outer links.
pub(super) fn middles(geometry: &Geometry) -> Vec<f64> {
    let left = remaining_lengths(&Line::new(geometry).points);
    left.windows(2).skip(1).map(|pair| (0.5 * (pair[0] + pair[1])).max(LEAST_REMAINDER)).collect()
}

/// The links of an arm with their shares of the moving mass, and the mass of its foot \[kg\].
pub(super) fn shapes(geometry: &Geometry, size: Size) -> (Vec<Shape>, f64) {
    let line = Line::new(geometry);
    let points = &line.points;
    let count = points.len() - 1;
    let left = remaining_lengths(points);
    let load = PAYLOAD * size.payload / size.mass;
    let far = (2.0 * size.reach.powi(2) / size.mass).min(0.15);
    let segment = |i: usize| left[i] - left[i + 1];
    let drive = |rest: f64| DRIVE.0 * ((rest + far) * (rest + load)).powf(DRIVE.1);
    // Per link: lump at its bearing, tube, lump at the next bearing.
    let mut parts = vec![[0.0; 3]; count];
    parts[0][0] = FOOT;
    for j in 1..count {
        let compact = |i: usize| (segment(i) + COMPACT).powi(-2);
        let own = compact(j) / (compact(j) + compact(j - 1));
        parts[j][0] += drive(left[j]) * own;
        parts[j - 1][2] += drive(left[j]) * (1.0 - own);
    }
    parts[count - 1][2] += FLANGE * DRIVE.0 * (far * load).powf(DRIVE.1);
    for (i, link) in parts.iter_mut().enumerate() {
        link[1] = 0.5 * ((left[i] + load).powi(2) - (left[i + 1] + load).powi(2));
    }
    let sum: f64 = parts.iter().flatten().sum();
    let scale = size.mass / sum;
    let mass = |i: usize| scale * parts[i].iter().sum::<f64>();
    let moving: f64 = (1..count).map(mass).sum();
    let shapes = (1..count)
        .map(|i| {
            let [first, between, last] = parts[i].map(|part| scale * part);
            let way = points[i + 1] - points[i];
            let (thick, thin) = (left[i] + load, left[i + 1] + load);
            let centre = points[i] + way * ((thick + 2.0 * thin) / (3.0 * (thick + thin)));
            let bodies = [
                sphere(first, points[i]),
                tube(between, centre, &way, mass(i)),
                sphere(last, points[i + 1]),
            ];
            let com = bodies.iter().map(|b| b.at * b.mass).sum::<Point>() / mass(i);
            let inertia: Matrix3<f64> = bodies
                .iter()
                .map(|b| {
                    let d = b.at - com;
                    b.inertia
                        + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * b.mass
                })
                .sum();
            let (turn, origin) = &line.frames[i - 1];
            Shape {
                share: mass(i) / moving,
                com: turn.transpose() * (com - origin),
                gyration: turn.transpose() * inertia * turn / mass(i),
            }
        })
        .collect();
    (shapes, size.mass - MOVING * moving)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::robot::find;

    /// Expected values are those of an independent implementation of the rule.
    #[test]
    fn masses_are_those_of_the_rule() {
        for (name, payload, reach, masses) in [
            ("IRB1200-5/0.9", 5.0, 0.9, [11.99, 15.48, 13.68, 6.52, 4.79, 0.97, 0.56]),
            ("IRB6700-200/2.6", 200.0, 2.6, [233.0, 320.8, 318.5, 162.0, 131.5, 24.4, 14.9]),
        ] {
            let mass: f64 = masses.iter().sum();
            let model = find(name).expect("in the catalogue");
            let (shapes, foot) = shapes(&model.kinematics, Size { mass, reach, payload });
            let moving = (mass - foot) / MOVING;
            for (shape, expected) in shapes.iter().zip(&masses[1..]) {
                let found = shape.share * moving;
                assert!(
                    (found - expected).abs() < 0.02 * expected + 0.02,
                    "{name}: {found}, {expected}"
                );
            }
        }
    }
}

//! Room around the arm: capsules against planes and against each other.
//!
//! Nothing is published of the shapes of the arms, so that every link is taken as a capsule
//! between the origins of its joints, with a radius that is a share of the arm's length.

use nalgebra::{Isometry3, Point3, Vector3};

use crate::robot::{MAX_DOF, Model};

/// Radii over the length of the arm: upper links, wrist, tool.
const RADII: [f64; 3] = [0.09, 0.05, 0.03];
/// Points nearer to each other than this share of the arm are one.
const APART: f64 = 1e-6;

/// A half space that every point of arm and tool stays in: n · x ≥ d, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit vector into the half space.
    pub normal: Vector3<f64>,
    /// Distance of the plane from the base frame's origin along it \[m\].
    pub distance: f64,
}

/// The shape of an arm with its tool.
#[derive(Clone, Debug)]
pub struct Body<'a> {
    model: &'a Model,
    /// Tool centre point in tool0 \[m\].
    tool: Vector3<f64>,
    length: f64,
    planes: Vec<Plane>,
}

struct Capsule {
    from: Point3<f64>,
    to: Point3<f64>,
    radius: f64,
}

impl<'a> Body<'a> {
    /// With a tool that reaches to `tool` in tool0 \[m\].
    #[must_use]
    pub fn new(model: &'a Model, tool: Vector3<f64>, planes: &[Plane]) -> Body<'a> {
        let joints = &model.kinematics.joints;
        let links: f64 = joints.iter().skip(2).map(|joint| joint.translation.norm()).sum();
        let length = links + model.kinematics.flange.translation.vector.norm();
        Body { model, tool, length: length.max(0.1), planes: planes.to_vec() }
    }

    /// The least room at the joint angles `q` \[rad\]: to the planes, and to itself \[m\].
    #[must_use]
    pub fn margins(&self, q: &[f64]) -> [f64; 2] {
        let capsules = self.capsules(q);
        let mut to_planes = f64::INFINITY;
        // The base column stands where it stands.
        for capsule in capsules.iter().skip(1) {
            for plane in &self.planes {
                for end in [capsule.from, capsule.to] {
                    let room = plane.normal.dot(&end.coords) - plane.distance - capsule.radius;
                    to_planes = to_planes.min(room);
                }
            }
        }
        let mut to_itself = f64::INFINITY;
        for (i, one) in capsules.iter().enumerate() {
            for other in capsules.iter().skip(i + 2) {
                let room = between(one, other) - one.radius - other.radius;
                to_itself = to_itself.min(room);
            }
        }
        [to_planes, to_itself]
    }

    /// Adds a point that is not the last one.
    fn add(&self, points: &mut Vec<Point3<f64>>, point: Point3<f64>) {
        if points.last().is_none_or(|last| (point - last).norm() > APART * self.length) {
            points.push(point);
        }
    }

    fn capsules(&self, q: &[f64]) -> Vec<Capsule> {
        let geometry = &self.model.kinematics;
        let angles = geometry.to_serial(q);
        let mut frame = Isometry3::identity();
        let mut points = vec![Point3::origin()];
        for (joint, angle) in geometry.joints.iter().take(MAX_DOF).zip(angles) {
            let rotation = nalgebra::Rotation3::from_matrix_unchecked(joint.rotation_at(angle));
            let rotation = nalgebra::UnitQuaternion::from_rotation_matrix(&rotation);
            frame *= Isometry3::from_parts(joint.translation.into(), rotation);
            self.add(&mut points, frame.translation.vector.into());
        }
        let flange = frame * geometry.flange;
        self.add(&mut points, flange.translation.vector.into());
        let links = points.len();
        if self.tool.norm() > 0.0 {
            points.push(flange.transform_point(&self.tool.into()));
        }
        let radius = |link: usize| {
            let kind = if link + 1 >= links { 2 } else { usize::from(link + 2 >= links) };
            RADII[kind] * self.length
        };
        let pairs = points.windows(2).enumerate();
        pairs.map(|(i, p)| Capsule { from: p[0], to: p[1], radius: radius(i) }).collect()
    }
}

/// Distance of the middle lines of two capsules \[m\]. C. Ericson, "Real-time collision
/// detection", 2005, section 5.1.9.
fn between(one: &Capsule, other: &Capsule) -> f64 {
    let (d1, d2, r) = (one.to - one.from, other.to - other.from, one.from - other.from);
    let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r));
    let (b, c) = (d1.dot(&d2), d1.dot(&r));
    let denominator = a * e - b * b;
    let s = if denominator > 0.0 { ((b * f - c * e) / denominator).clamp(0.0, 1.0) } else { 0.0 };
    let t = if e > 0.0 { (b * s + f) / e } else { 0.0 };
    let (s, t) = if t < 0.0 {
        (if a > 0.0 { (-c / a).clamp(0.0, 1.0) } else { 0.0 }, 0.0)
    } else if t > 1.0 {
        (if a > 0.0 { ((b - c) / a).clamp(0.0, 1.0) } else { 0.0 }, 1.0)
    } else {
        (s, t)
    };
    ((one.from + d1 * s) - (other.from + d2 * t)).norm()
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;
    use crate::kinematics::fk;
    use crate::robot::find;

    /// Of a distance \[m\], against points on both lines.
    const GRID: f64 = 0.01;

    #[test]
    fn distances_are_those_of_the_nearest_points() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..200 {
            let mut point = || Point3::new(random.f64(), random.f64(), random.f64());
            let one = Capsule { from: point(), to: point(), radius: 0.0 };
            let other = Capsule { from: point(), to: point(), radius: 0.0 };
            let on = |c: &Capsule, k: i32| c.from + (c.to - c.from) * (f64::from(k) / 200.0);
            let least = (0..=200)
                .flat_map(|i| (0..=200).map(move |k| (i, k)))
                .map(|(i, k)| (on(&one, i) - on(&other, k)).norm())
                .fold(f64::INFINITY, f64::min);
            let found = between(&one, &other);
            assert!(found <= least + 1e-12 && least - found < GRID, "{found} {least}");
        }
    }

    #[test]
    fn the_tip_of_the_tool_counts() {
        let model = find("IRB1600-10/1.45").unwrap();
        let tool = Vector3::new(0.0, 0.0, 0.3);
        let plane = Plane { normal: -Vector3::x(), distance: -1.3 };
        let q = [0.0, 0.6, 0.2, 0.0, -0.8, 0.0];
        let body = Body::new(&model, tool, &[plane]);
        let tip = fk(&model, &q).transform_point(&tool.into());
        let [room, _] = body.margins(&q);
        assert!((room - (1.3 - tip.x - RADII[2] * body.length)).abs() < 1e-9, "{room} {tip}");
    }
}

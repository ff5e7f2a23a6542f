//! The shape of an arm with its tool.
//!
//! Nothing is published of the shapes of the arms, so that every link is taken as a capsule
//! between the origins of its joints, with a radius that is a share of the arm's length.

use nalgebra::{Point3, Vector3};

use crate::arm::robot::{MAX_DOF, Model};

use super::super::fk::Frames;
use super::capsule::Capsule;
use super::obstacle::Obstacle;

/// Radii over the length of the arm: upper links, wrist, tool.
const RADII: [f64; 3] = [0.09, 0.05, 0.03];
/// Points nearer to each other than this share of the arm are one.
const APART: f64 = 1e-6;
/// Parts of an arm that are nearer along it than their radii by this factor count as joined.
const JOINED: f64 = 1.5;
/// Nearer to each other than this, two lines cross \[m\].
const CROSSING: f64 = 1e-9;
/// Shortest arm that radii are a share of \[m\].
const SHORTEST: f64 = 0.1;

/// An arm with its tool among obstacles.
#[derive(Clone, Debug)]
pub struct Body<'a> {
    model: &'a Model,
    /// Tool centre point in tool0 \[m\].
    tool: Vector3<f64>,
    length: f64,
    obstacles: Vec<Obstacle>,
}

/// The least room and how it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance of the surfaces, negative where they overlap, infinite where there is nothing
    /// \[m\].
    pub room: f64,
    /// Its change with each joint \[m/rad\].
    pub gradient: [f64; MAX_DOF],
}

/// A capsule and the last joint that moves it.
#[derive(Clone, Copy)]
struct Part {
    capsule: Capsule,
    /// Number of joints that move it.
    joints: usize,
    /// Way from the base to its beginning along the middle line \[m\].
    begin: f64,
}

impl<'a> Body<'a> {
    /// With a tool that reaches to `tool` in tool0 \[m\].
    #[must_use]
    pub fn new(model: &'a Model, tool: Vector3<f64>, obstacles: &[Obstacle]) -> Body<'a> {
        let joints = &model.kinematics.joints;
        let links: f64 = joints.iter().skip(2).map(|joint| joint.translation.norm()).sum();
        let length = links + model.kinematics.flange.translation.vector.norm();
        Body { model, tool, length: length.max(SHORTEST), obstacles: obstacles.to_vec() }
    }

    /// The capsules of base column, links and tool at the joint angles `q` \[rad\], in the base
    /// frame.
    #[must_use]
    pub fn capsules(&self, q: &[f64]) -> Vec<Capsule> {
        self.parts(&Frames::at(self.model, q)).into_iter().map(|part| part.capsule).collect()
    }

    /// The least room at the joint angles `q` \[rad\]: to the obstacles, and to itself \[m\].
    #[must_use]
    pub fn margins(&self, q: &[f64]) -> [f64; 2] {
        let parts = self.parts(&Frames::at(self.model, q));
        // The base column stands where it stands.
        let to_obstacles = parts
            .iter()
            .skip(1)
            .flat_map(|part| self.obstacles.iter().map(|of| of.room(&part.capsule)))
            .fold(f64::INFINITY, f64::min);
        let to_itself = pairs(&parts).map(|pair| between(&pair).0).fold(f64::INFINITY, f64::min);
        [to_obstacles, to_itself]
    }

    /// The same with gradients. Where two places are equally near, it is that of one of them.
    #[must_use]
    pub fn nearest(&self, q: &[f64]) -> [Nearest; 2] {
        let frames = Frames::at(self.model, q);
        let parts = self.parts(&frames);
        let none = Nearest { room: f64::INFINITY, gradient: [0.0; MAX_DOF] };
        let mut to_obstacles = none;
        for part in parts.iter().skip(1) {
            for obstacle in &self.obstacles {
                let witness = obstacle.witness(&part.capsule);
                let room = witness.distance - part.capsule.radius;
                if room < to_obstacles.room {
                    let gradient = self.pushed(&frames, part.joints, &witness.point, &witness.away);
                    to_obstacles = Nearest { room, gradient };
                }
            }
        }
        let mut to_itself = none;
        for pair in pairs(&parts) {
            let (room, [one, other]) = between(&pair);
            if room < to_itself.room {
                // Lines that cross have no direction between them.
                let away = (one - other).try_normalize(CROSSING).unwrap_or_default();
                let first = self.pushed(&frames, pair[0].joints, &one, &away);
                let second = self.pushed(&frames, pair[1].joints, &other, &away);
                let gradient = std::array::from_fn(|joint| first[joint] - second[joint]);
                to_itself = Nearest { room, gradient };
            }
        }
        [to_obstacles, to_itself]
    }

    /// Rate of a point of a part along `away`, for each joint \[m/rad\].
    fn pushed(
        &self,
        frames: &Frames,
        joints: usize,
        point: &Point3<f64>,
        away: &Vector3<f64>,
    ) -> [f64; MAX_DOF] {
        let mut rates = [0.0; MAX_DOF];
        for (joint, rate) in rates.iter_mut().enumerate().take(joints) {
            *rate = frames.axis[joint].cross(&(point.coords - frames.origin[joint])).dot(away);
        }
        self.model.kinematics.from_serial_torque(rates)
    }

    fn parts(&self, frames: &Frames) -> Vec<Part> {
        let dof = self.model.dof.min(MAX_DOF);
        // Points of the middle line, each with the number of joints that turn what follows it.
        let mut points = vec![(Point3::origin(), 0)];
        let mut add = |point: Point3<f64>, joints: usize| match points.last_mut() {
            Some((last, of)) if (point - *last).norm() <= APART * self.length => *of = joints,
            _ => points.push((point, joints)),
        };
        for joint in 0..dof {
            add(frames.origin[joint].into(), joint + 1);
        }
        let flange = frames.flange(self.model);
        add(flange.translation.vector.into(), dof);
        let links = points.len();
        if self.tool.norm() > 0.0 {
            points.push((flange.transform_point(&self.tool.into()), dof));
        }
        let radius = |link: usize| {
            let kind = if link + 1 >= links { 2 } else { usize::from(link + 2 >= links) };
            RADII[kind] * self.length
        };
        let mut begin = 0.0;
        let part = |(i, pair): (usize, &[(Point3<f64>, usize)])| {
            let capsule = Capsule { from: pair[0].0, to: pair[1].0, radius: radius(i) };
            let part = Part { capsule, joints: pair[0].1, begin };
            begin += capsule.length();
            part
        };
        points.windows(2).enumerate().map(part).collect()
    }
}

/// Parts that are no neighbours. What lies so near along the arm that it would touch in every
/// pose is cut off from the later one.
fn pairs(parts: &[Part]) -> impl Iterator<Item = [Part; 2]> {
    parts.iter().enumerate().flat_map(move |(i, one)| {
        parts.iter().skip(i + 2).filter_map(move |other| {
            let apart = other.begin - one.begin - one.capsule.length();
            let near = JOINED * (one.capsule.radius + other.capsule.radius) - apart;
            let length = other.capsule.length();
            if near >= length {
                return None;
            }
            let mut capsule = other.capsule;
            if near > 0.0 {
                capsule.from = capsule.at(near / length);
            }
            Some([*one, Part { capsule, ..*other }])
        })
    })
}

/// Room between two parts \[m\], and their nearest points.
fn between([one, other]: &[Part; 2]) -> (f64, [Point3<f64>; 2]) {
    let points = one.capsule.nearest_points(&other.capsule);
    let room = (points[0] - points[1]).norm() - one.capsule.radius - other.capsule.radius;
    (room, points)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::obstacle::{KeepOut, Plane};
    use super::*;
    use crate::arm::kinematics::fk;
    use crate::arm::robot::find;

    /// Step of central differences \[rad\], and what they may miss \[m/rad\].
    const STEP: f64 = 1e-5;
    const MISSED: f64 = 1e-5;

    #[test]
    fn the_tip_of_the_tool_counts() {
        let model = find("IRB1600-10/1.45").unwrap();
        let tool = Vector3::new(0.0, 0.0, 0.3);
        let plane = Plane { normal: -Vector3::x(), distance: -1.3 };
        let q = [0.0, 0.6, 0.2, 0.0, -0.8, 0.0];
        let body = Body::new(&model, tool, &[Obstacle::Plane(plane)]);
        let tip = fk(&model, &q).transform_point(&tool.into());
        let [room, _] = body.margins(&q);
        assert!((room - (1.3 - tip.x - RADII[2] * body.length)).abs() < 1e-9, "{room} {tip}");
    }

    #[test]
    fn a_tool_of_any_length_leaves_room() {
        let model = find("IRB1600-10/1.45").unwrap();
        for length in [0.05, 0.1, 0.25, 0.5] {
            let body = Body::new(&model, Vector3::new(0.0, 0.0, length), &[]);
            let [_, straight] = body.margins(&[0.0, 0.0, 0.0, 0.0, 0.3, 0.0]);
            assert!(straight > 0.01, "{length}: {straight}");
        }
        // Folded back, a long tool meets the upper arm or the forearm.
        let body = Body::new(&model, Vector3::new(0.0, 0.0, 0.5), &[]);
        let [_, folded] = body.margins(&[0.0, 0.0, 0.0, 0.0, 3.0, 0.0]);
        assert!(folded < 0.0, "{folded}");
    }

    /// Also with a parallelogram, whose third joint is not turned by the second.
    #[test]
    fn gradients_are_those_of_differences() {
        let mut random = fastrand::Rng::with_seed(8);
        for name in ["IRB1600-10/1.45", "IRB2400-12/1.55", "IRB14000 left"] {
            let model = find(name).unwrap();
            let obstacles = [
                Obstacle::Plane(Plane { normal: Vector3::z(), distance: 0.1 }),
                Obstacle::KeepOut(KeepOut::between(
                    Point3::new(0.4, -0.3, 0.2),
                    Point3::new(0.9, 0.2, 0.8),
                )),
            ];
            let body = Body::new(&model, Vector3::new(0.1, 0.0, 0.3), &obstacles);
            let mut kinks = 0;
            for _ in 0..200 {
                let q: Vec<f64> = (0..model.dof).map(|_| 4.0 * random.f64() - 2.0).collect();
                let nearest = body.nearest(&q);
                assert_eq!(nearest.map(|n| n.room), body.margins(&q));
                for joint in 0..model.dof {
                    let at = |step: f64| {
                        let mut q = q.clone();
                        q[joint] += step;
                        body.margins(&q)
                    };
                    let (low, here, high) = (at(-STEP), body.margins(&q), at(STEP));
                    for kind in 0..2 {
                        let [left, right] =
                            [(here[kind] - low[kind]) / STEP, (high[kind] - here[kind]) / STEP];
                        // Where another place becomes the nearest there is no gradient.
                        if (left - right).abs() > 1e-3 {
                            kinks += 1;
                            continue;
                        }
                        let found = nearest[kind].gradient[joint];
                        assert!(
                            (found - 0.5 * (left + right)).abs() < MISSED.max(1e-3 * found.abs()),
                            "{name} {joint} {kind}: {found} {left} {right}"
                        );
                    }
                }
            }
            assert!(kinks < 40, "{name}: {kinks}");
        }
    }
}

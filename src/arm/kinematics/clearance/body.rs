//! The shape of an arm with its tool.
//!
//! Arm shapes are not published, so each link is a capsule between its joint origins with a radius
//! relative to the arm length.

use nalgebra::{Point3, Vector3};

use crate::arm::robot::Model;

use super::super::fk::Frames;
use super::capsule::Capsule;
use super::obstacle::Obstacle;

/// Radii relative to the arm length: upper links, wrist, tool.
const RADII: [f64; 3] = [0.09, 0.05, 0.03];
/// Distance of points below which they are equal, relative to the arm length.
const APART: f64 = 1e-6;
/// Parts whose distance along the arm is below this multiple of their radii are joined.
const JOINED: f64 = 1.5;
/// Smallest arm length for the radii \[m\].
const SHORTEST: f64 = 0.1;

/// An arm with its tool, and obstacles.
#[derive(Clone, Debug)]
pub struct Body<'a> {
    model: &'a Model,
    /// TCP in tool0 \[m\].
    tool: Vector3<f64>,
    length: f64,
    obstacles: Vec<Obstacle>,
}

/// A capsule of the centre line of the arm.
#[derive(Clone, Copy)]
struct Part {
    capsule: Capsule,
    /// Distance of its start from the base along the centre line \[m\].
    begin: f64,
}

impl<'a> Body<'a> {
    /// The arm with a tool that extends to `tool` in tool0 \[m\].
    #[must_use]
    pub fn new(model: &'a Model, tool: Vector3<f64>, obstacles: &[Obstacle]) -> Body<'a> {
        let joints = &model.kinematics.joints;
        let links: f64 = joints.iter().skip(2).map(|joint| joint.translation.norm()).sum();
        let length = links + model.kinematics.flange.translation.vector.norm();
        Body { model, tool, length: length.max(SHORTEST), obstacles: obstacles.to_vec() }
    }

    /// The capsules of base column, links and tool at `q` \[rad\], in the base frame.
    #[must_use]
    pub fn capsules(&self, q: &[f64]) -> Vec<Capsule> {
        self.parts(&Frames::at(self.model, q)).into_iter().map(|part| part.capsule).collect()
    }

    /// The least clearance at the joint angles `q` \[rad\]: to the obstacles, and to itself \[m\].
    #[must_use]
    pub fn margins(&self, q: &[f64]) -> [f64; 2] {
        let parts = self.parts(&Frames::at(self.model, q));
        // The base column does not move.
        let to_obstacles = parts
            .iter()
            .skip(1)
            .flat_map(|part| self.obstacles.iter().map(|obstacle| obstacle.room(&part.capsule)))
            .fold(f64::INFINITY, f64::min);
        let to_itself = pairs(&parts).map(|pair| between(&pair)).fold(f64::INFINITY, f64::min);
        [to_obstacles, to_itself]
    }

    fn parts(&self, frames: &Frames) -> Vec<Part> {
        // The centre line: base, joint origins, flange, TCP.
        let mut points = vec![Point3::origin()];
        let flange = frames.flange(self.model);
        let origins = frames.origin.iter().take(self.model.dof);
        for point in origins.chain([&flange.translation.vector]).map(|at| Point3::from(*at)) {
            if points.last().is_none_or(|last| (point - last).norm() > APART * self.length) {
                points.push(point);
            }
        }
        let links = points.len();
        if self.tool.norm() > 0.0 {
            points.push(flange.transform_point(&self.tool.into()));
        }
        let radius = |link: usize| {
            let kind = if link + 1 >= links { 2 } else { usize::from(link + 2 >= links) };
            RADII[kind] * self.length
        };
        let mut begin = 0.0;
        let part = |(i, pair): (usize, &[Point3<f64>])| {
            let capsule = Capsule { from: pair[0], to: pair[1], radius: radius(i) };
            let part = Part { capsule, begin };
            begin += capsule.length();
            part
        };
        points.windows(2).enumerate().map(part).collect()
    }
}

/// Pairs of parts that are not neighbours. A portion so close along the arm that it would touch in
/// every pose is removed from the later part.
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

/// Clearance between two parts \[m\].
fn between([one, other]: &[Part; 2]) -> f64 {
    let [a, b] = one.capsule.nearest_points(&other.capsule);
    (a - b).norm() - one.capsule.radius - other.capsule.radius
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::obstacle::Plane;
    use super::*;
    use crate::arm::kinematics::fk;
    use crate::arm::robot::find;

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
        // Folded back, a long tool collides with the upper arm or the forearm.
        let body = Body::new(&model, Vector3::new(0.0, 0.0, 0.5), &[]);
        let [_, folded] = body.margins(&[0.0, 0.0, 0.0, 0.0, 3.0, 0.0]);
        assert!(folded < 0.0, "{folded}");
    }
}

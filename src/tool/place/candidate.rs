//! A program with its frames moved.

use nalgebra::{Isometry3, Point3};

use super::bounds::Bounds;
use super::error::PlaceError;
use super::frame::{Frame, about};
use crate::arm::kinematics::{KeepOut, Obstacle, Plane};
use crate::arm::robot::Model;
use crate::rapid::ir::program::Program;
use crate::rapid::text::Edit;
use crate::tool::retrofit::{Cell, Source};

/// Frames that move together.
struct Group {
    bounds: Bounds,
    frames: Vec<Frame>,
}

/// The ways in which a program may be placed.
pub(super) struct Ways<'a> {
    pub(super) cell: Cell<'a>,
    /// Keep-outs, in the base frame of the robot as it stands.
    obstacles: &'a [Obstacle],
    groups: Vec<Group>,
}

/// A program with its frames moved.
pub struct Placed {
    /// The shifts of the groups in the world, m and rad.
    pub shifts: Vec<[f64; 6]>,
    /// The files.
    pub files: Vec<Source>,
    /// The robot where it stands.
    pub model: Model,
    pub(super) obstacles: Vec<Obstacle>,
}

impl<'a> Ways<'a> {
    pub(super) fn new(
        (cell, obstacles): (Cell<'a>, &'a [Obstacle]),
        program: &Program,
        all: &[Bounds],
    ) -> Result<Ways<'a>, PlaceError> {
        let mut groups: Vec<Group> = Vec::new();
        let mut names: Vec<String> = Vec::new();
        for bounds in all {
            let mut frames = Vec::new();
            for name in &bounds.names {
                let wrong =
                    |reason: &str| PlaceError::Frame { name: name.clone(), reason: reason.into() };
                let key = name.to_lowercase();
                if names.contains(&key) {
                    return Err(wrong("it is named twice; name each frame once"));
                }
                names.push(key);
                let frame = Frame::find(program, cell.files, name)?;
                let stays =
                    (0..6).find(|axis| bounds.axes[*axis].is_some() && !frame.moves_along(*axis));
                if stays.is_some() {
                    return Err(wrong(
                        "a tool can only be mounted at another angle: give rz alone",
                    ));
                }
                frames.push(frame);
            }
            let mounted = frames.iter().filter(|frame| matches!(frame, Frame::Mounted(_))).count();
            if mounted > 0 && mounted < frames.len() {
                let reason = "a tool turns about the flange, other frames about the world's axes; \
                              give them separate --move options";
                return Err(PlaceError::Frame {
                    name: bounds.names.join("+"),
                    reason: reason.into(),
                });
            }
            groups.push(Group { bounds: bounds.clone(), frames });
        }
        Ok(Ways { cell, obstacles, groups })
    }

    /// Number of axes along which frames may move.
    pub(super) fn freedom(&self) -> usize {
        self.groups.iter().map(|group| group.bounds.freedom()).sum()
    }

    /// The program at a point of the unit cube.
    pub(super) fn placed(&self, point: &[f64]) -> Result<Placed, PlaceError> {
        let mut rest = point;
        let shifts = self.groups.iter().map(|group| {
            let (own, others) = rest.split_at(group.bounds.freedom());
            rest = others;
            group.bounds.shift(own)
        });
        let shifts: Vec<[f64; 6]> = shifts.collect();
        self.shifted(shifts)
    }

    /// The program as it is.
    pub(super) fn today(&self) -> Placed {
        Placed {
            shifts: vec![[0.0; 6]; self.groups.len()],
            files: self.cell.files.to_vec(),
            model: self.cell.model.clone(),
            obstacles: self.obstacles.to_vec(),
        }
    }

    fn shifted(&self, shifts: Vec<[f64; 6]>) -> Result<Placed, PlaceError> {
        let mut placed = Placed { shifts, ..self.today() };
        let base = self.cell.model.kinematics.base;
        let mut edits: Vec<Edit> = Vec::new();
        for (group, shift) in self.groups.iter().zip(&placed.shifts) {
            let Some(first) = group.frames.first() else { continue };
            let shift = about(&first.origin(&base), shift);
            edits.extend(group.frames.iter().flat_map(|frame| frame.edits(&shift)));
            if group.frames.iter().any(|frame| matches!(frame, Frame::Base)) {
                placed.model.kinematics.base = shift * base;
                let seen = placed.model.kinematics.base.inverse() * base;
                placed.obstacles = placed.obstacles.iter().map(|part| moved(part, &seen)).collect();
            }
        }
        let files = self.cell.edited(edits);
        placed.files = files.map_err(|error| PlaceError::Cycle(error.to_string()))?;
        Ok(placed)
    }
}

impl Placed {
    /// The program of the changed text with the robot where it stands.
    pub(super) fn cell<'p>(&'p self, of: Cell<'p>) -> Cell<'p> {
        Cell { files: &self.files, model: &self.model, ..of }
    }
}

/// An obstacle in another frame.
fn moved(obstacle: &Obstacle, to: &Isometry3<f64>) -> Obstacle {
    match obstacle {
        Obstacle::KeepOut(part) => Obstacle::KeepOut(KeepOut { pose: to * part.pose, ..*part }),
        Obstacle::Plane(plane) => {
            let normal = to * plane.normal;
            let on_plane = to * Point3::from(plane.normal * plane.distance);
            Obstacle::Plane(Plane { normal, distance: normal.dot(&on_plane.coords) })
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    #[test]
    fn a_plane_keeps_its_distance_from_points_in_a_moved_frame() {
        let to = Isometry3::from_parts(
            Vector3::new(0.3, -0.2, 0.5).into(),
            UnitQuaternion::from_euler_angles(0.1, 0.4, -0.7),
        );
        let normal = Vector3::new(1.0, 2.0, -0.5).normalize();
        let plane = Plane { normal, distance: -0.4 };
        let Obstacle::Plane(there) = moved(&Obstacle::Plane(plane), &to) else {
            panic!("a plane stays a plane")
        };
        let point = Point3::new(0.7, 0.1, 0.9);
        let before = plane.normal.dot(&point.coords) - plane.distance;
        let after = there.normal.dot(&(to * point).coords) - there.distance;
        assert!((before - after).abs() < 1e-12);
    }
}

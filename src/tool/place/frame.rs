//! Frames of a program that can be moved, and the edits that move them.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::error::PlaceError;
use crate::arm::robot::nearest;
use crate::rapid::ir::hir::{Data, Expr, ExprKind};
use crate::rapid::ir::number::number;
use crate::rapid::ir::program::{DataId, Program};
use crate::rapid::text::{Edit, Span};
use crate::tool::retrofit::{Source, file_and_line};

/// The name of the robot's base.
const BASE: &str = "base";

/// A frame that can be moved.
#[derive(Clone, Debug)]
pub(super) enum Frame {
    /// The base of the robot in the world.
    Base,
    /// A frame that stands in the world: the user frame of a work object or a stationary tool.
    Standing(Standing),
    /// How a tool is mounted on the flange.
    Mounted(Box<Mounted>),
}

#[derive(Clone, Debug)]
pub(super) struct Standing {
    /// Its pose in the source.
    span: Span,
    /// The pose in the world, m.
    pose: Isometry3<f64>,
    /// What the targets refer to, in this frame (the object frame of a work object).
    object: Isometry3<f64>,
}

#[derive(Clone, Debug)]
pub(super) struct Mounted {
    frame: (Span, Isometry3<f64>),
    /// Centre of mass, mm.
    com: (Span, Vector3<f64>),
    /// Axes of inertia.
    axes: (Span, UnitQuaternion<f64>),
}

impl Frame {
    /// The frame of this name.
    pub(super) fn find(
        program: &Program,
        files: &[Source],
        name: &str,
    ) -> Result<Frame, PlaceError> {
        if name.eq_ignore_ascii_case(BASE) {
            return Ok(Frame::Base);
        }
        let wrong = |reason: String| PlaceError::Frame { name: name.to_owned(), reason };
        let key = name.to_lowercase();
        let mut found = Vec::new();
        let mut known = BTreeMap::new();
        for (id, data) in frames(program) {
            known.insert(data.name.key.clone(), data.name.text.clone());
            if data.name.key == key {
                found.push((id, data));
            }
        }
        let (id, data) = match found.as_slice() {
            [one] => *one,
            [] if key == "wobj0" => {
                return Err(wrong("wobj0 is the world; move base, or the other frames".into()));
            }
            [] => {
                let near = nearest(&key, known.keys().map(String::as_str));
                let near = near.and_then(|near| known.get(near));
                let meant = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
                let all = if known.is_empty() {
                    "it declares none: move base".to_owned()
                } else {
                    let names: Vec<&str> = known.values().map(String::as_str).collect();
                    format!("it declares {}", names.join(", "))
                };
                return Err(wrong(format!(
                    "no module declares a wobjdata or tooldata of this name at its top level; \
                     {all}{meant}"
                )));
            }
            [(_, first), (_, second), ..] => {
                let [first, second] = [first, second].map(|data| file_and_line(files, data.span));
                return Err(wrong(format!(
                    "{first} and {second} both declare it; give the frames different names"
                )));
            }
        };
        let wrong = |reason: &str| {
            let place = file_and_line(files, data.span);
            PlaceError::Frame { name: name.to_owned(), reason: format!("{place}: {reason}") }
        };
        if program.is_written(id) {
            return Err(wrong(
                "the program writes it, so that the numbers in the source are not where it stands; \
                 move another frame, or base",
            ));
        }
        let read = match data.type_name.key.as_str() {
            "wobjdata" => work_object(data),
            _ => tool(data),
        };
        read.map_err(wrong)
    }

    /// Whether it can be moved along this axis.
    pub(super) fn moves_along(&self, axis: usize) -> bool {
        !matches!(self, Frame::Mounted(_)) || axis == 5
    }

    /// The place about which its group turns, in the world.
    pub(super) fn origin(&self, base: &Isometry3<f64>) -> Vector3<f64> {
        match self {
            Frame::Base => base.translation.vector,
            Frame::Standing(standing) => (standing.pose * standing.object).translation.vector,
            Frame::Mounted(_) => Vector3::zeros(),
        }
    }

    /// The edits that move it by a shift in the world; a mounted tool turns about the flange's z axis.
    pub(super) fn edits(&self, shift: &Isometry3<f64>) -> Vec<Edit> {
        let edit = |span: &Span, text: String| Edit { span: *span, text: text.into_bytes() };
        match self {
            Frame::Base => Vec::new(),
            Frame::Standing(standing) => {
                vec![edit(&standing.span, pose_text(&(shift * standing.pose)))]
            }
            Frame::Mounted(tool) => {
                let turn = shift.rotation;
                vec![
                    edit(&tool.frame.0, pose_text(&(turn * tool.frame.1))),
                    edit(&tool.com.0, vector_text(&(turn * tool.com.1))),
                    edit(&tool.axes.0, rotation_text(&(turn * tool.axes.1))),
                ]
            }
        }
    }
}

/// The shift of a group of frames that turns about a place, in the world.
pub(super) fn about(origin: &Vector3<f64>, shift: &[f64; 6]) -> Isometry3<f64> {
    let [x, y, z, rx, ry, rz] = *shift;
    let turn = UnitQuaternion::from_euler_angles(rx, ry, rz);
    let moved = origin + Vector3::new(x, y, z) - turn * origin;
    Isometry3::from_parts(Translation3::from(moved), turn)
}

/// The scalar frames that modules declare.
fn frames(program: &Program) -> impl Iterator<Item = (DataId, &Data)> {
    program.modules.iter().enumerate().flat_map(|(module, of)| {
        let data = of.data.iter().enumerate();
        let data = data.map(move |(index, data)| (DataId { module, index }, data));
        data.filter(|(_, data)| {
            matches!(data.type_name.key.as_str(), "wobjdata" | "tooldata") && data.dims.is_empty()
        })
    })
}

/// Message for values that are no numbers in the declaration.
const NO_LITERAL: &str = "its declaration has no literal value [ … ] with all numbers, so that there is \
                          nothing to edit; write its numbers into the declaration";

fn work_object(data: &Data) -> Result<Frame, &'static str> {
    let [robhold, ufprog, _, uframe, oframe] = literal(data)? else { return Err(NO_LITERAL) };
    if flag(robhold)? {
        return Err("the robot holds this work object; move the stationary tool");
    }
    if !flag(ufprog)? {
        return Err("a mechanical unit moves this work object; move another frame, or base");
    }
    let (pose, object) = (pose(uframe)?, pose(oframe)?);
    Ok(Frame::Standing(Standing { span: uframe.span, pose, object }))
}

fn tool(data: &Data) -> Result<Frame, &'static str> {
    let [robhold, tframe, tload] = literal(data)? else { return Err(NO_LITERAL) };
    let frame = pose(tframe)?;
    if !flag(robhold)? {
        let object = Isometry3::identity();
        return Ok(Frame::Standing(Standing { span: tframe.span, pose: frame, object }));
    }
    let [_, com, axes, ..] = list(tload)? else { return Err(NO_LITERAL) };
    let mounted = Mounted {
        frame: (tframe.span, frame),
        com: (com.span, Vector3::from(numbers(com)?)),
        axes: (axes.span, rotation(axes)?),
    };
    Ok(Frame::Mounted(Box::new(mounted)))
}

fn literal(data: &Data) -> Result<&[Expr], &'static str> {
    list(data.init.as_ref().ok_or(NO_LITERAL)?)
}

fn list(value: &Expr) -> Result<&[Expr], &'static str> {
    match &value.kind {
        ExprKind::Aggregate(items) => Ok(items),
        _ => Err(NO_LITERAL),
    }
}

fn flag(value: &Expr) -> Result<bool, &'static str> {
    match value.kind {
        ExprKind::Bool(is) => Ok(is),
        _ => Err(NO_LITERAL),
    }
}

fn numbers<const N: usize>(value: &Expr) -> Result<[f64; N], &'static str> {
    value.literal_numbers().and_then(|all| all.try_into().ok()).ok_or(NO_LITERAL)
}

fn rotation(value: &Expr) -> Result<UnitQuaternion<f64>, &'static str> {
    let [w, i, j, k] = numbers(value)?;
    let turn = Quaternion::new(w, i, j, k);
    UnitQuaternion::try_new(turn, f64::EPSILON).ok_or("its quaternion is zero; correct it")
}

/// A `pose`, m.
fn pose(value: &Expr) -> Result<Isometry3<f64>, &'static str> {
    let [trans, rot] = list(value)? else { return Err(NO_LITERAL) };
    let trans = Vector3::from(numbers(trans)?) * 1e-3;
    Ok(Isometry3::from_parts(Translation3::from(trans), rotation(rot)?))
}

fn pose_text(pose: &Isometry3<f64>) -> String {
    let trans = vector_text(&(pose.translation.vector * 1e3));
    format!("[{trans},{}]", rotation_text(&pose.rotation))
}

/// A vector in mm.
fn vector_text(mm: &Vector3<f64>) -> String {
    format!("[{},{},{}]", number(mm.x, 3), number(mm.y, 3), number(mm.z, 3))
}

fn rotation_text(turn: &UnitQuaternion<f64>) -> String {
    // Of the two quaternions of a rotation the one with a positive first component.
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    let parts = [turn.w, turn.i, turn.j, turn.k].map(|part| number(sign * part, 9));
    format!("[{}]", parts.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_turns_about_the_place_of_its_first_frame() {
        let origin = Vector3::new(1.0, 2.0, 0.5);
        let shift = about(&origin, &[0.1, 0.0, 0.0, 0.0, 0.0, std::f64::consts::FRAC_PI_2]);
        let moved = shift * nalgebra::Point3::from(origin);
        assert!((moved.coords - Vector3::new(1.1, 2.0, 0.5)).norm() < 1e-12);
        let beside = shift * nalgebra::Point3::new(2.0, 2.0, 0.5);
        assert!((beside.coords - Vector3::new(1.1, 3.0, 0.5)).norm() < 1e-12);
    }
}

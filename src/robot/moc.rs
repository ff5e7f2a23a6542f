//! A controller's motion configuration, `SYSPAR/MOC.cfg`, as an overlay of the
//! catalogue's robot.
//!
//! It names the robot and holds what was set up on it: joint ranges, base frame, arm
//! loads, the largest speed of the TCP, the levels of the friction compensation. It
//! has no lengths, gears or motors of the standard axes.

use std::fmt::Write;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use super::catalogue;
use super::error::RobotError;
use super::system_parameters::{Entry, break_off, section};
use super::toml_text::{list, pose, quoted};

/// Sections of a controller's own file: of the first ones, and of the last.
const ENDS: [&str; 2] = ["MOTION_SYSTEM", "MOTOR_CALIB"];

/// How every motion configuration begins.
const HEADER: &str = "MOC:CFG_";

/// The Robot TOML of the robot in a `MOC.cfg`; `file` names it in messages and as the
/// source, `unit` the mechanical unit where the controller has several robots.
///
/// # Errors
/// It is no motion configuration, breaks off, or lacks a range; the catalogue does not
/// have its robot; it has several and `unit` names none of them.
pub fn import_moc(file: &str, text: &str, unit: Option<&str>) -> Result<String, RobotError> {
    let configuration = Configuration { file, text };
    configuration.check_whole()?;
    let (index, robot) = configuration.robot(unit)?;
    let kind = configuration.text(&robot, "use_robot_type", "ROBOT")?;
    let model = catalogue::find(kind)?;

    let source = quoted(&format!("{file}, {kind}"));
    let stated = format!("source = {source}\nprovenance = \"identified\"\n");
    let mut out = format!("extends = {}\nname = {}\n", quoted(&model.name), quoted(&model.name));

    if let Some(base) = configuration.base(&robot)? {
        let _ = write!(out, "\n[kinematics.base]\n{stated}{}", pose(&base));
    }
    let arms = section(text, "ARM");
    let joints: Vec<String> = (0..model.dof)
        .map(|i| {
            let stated = robot.get(&format!("use_joint_{i}")).cloned();
            stated.unwrap_or_else(|| format!("rob{}_{}", index + 1, i + 1))
        })
        .collect();
    let _ = write!(out, "\n[limits]\nposition = [\n");
    for joint in &joints {
        let arm = configuration.named(&arms, joint, "ARM")?;
        let [low, high] = [
            configuration.number(arm, "lower_joint_bound", joint)?,
            configuration.number(arm, "upper_joint_bound", joint)?,
        ];
        if low >= high {
            return Err(configuration.error(format!(
                "{joint} turns from {low} to {high} rad; correct -lower_joint_bound and \
                 -upper_joint_bound"
            )));
        }
        let _ = writeln!(out, "  {},", list(&[low, high]));
    }
    let _ = write!(out, "]\nposition_source = {source}\nposition_provenance = \"identified\"\n");
    // What is set up on the controller holds without the conditions of the data sheet.
    out.push_str("position_if = []\n");
    if let Some(arm) = joints.get(2).and_then(|joint| find(&arms, joint))
        && arm.contains_key("upper_joint_coupl_bound")
    {
        let [low, high] = [
            configuration.number(arm, "lower_joint_coupl_bound", &joints[2])?,
            configuration.number(arm, "upper_joint_coupl_bound", &joints[2])?,
        ];
        let _ = write!(
            out,
            "coupled = {}\ncoupled_source = {source}\ncoupled_provenance = \"identified\"\n",
            list(&[low, high])
        );
    }
    let planners = section(text, "MOTION_PLANNER");
    if let Some(planner) = planners.get(index).filter(|p| p.contains_key("linear_max_speed")) {
        let speed = configuration.number(planner, "linear_max_speed", "MOTION_PLANNER")?;
        let _ = write!(
            out,
            "tcp_speed = {speed:?}\ntcp_speed_source = {source}\n\
             tcp_speed_provenance = \"identified\"\n"
        );
    }
    if let Some(levels) = configuration.friction(index, model.dof)? {
        let _ = write!(
            out,
            "\n[controller]\nfriction_level = {}\nfriction_level_source = {source}\n\
             friction_level_provenance = \"identified\"\n",
            list(&levels)
        );
    }
    out.push_str(&configuration.arm_loads(index, &arms, &joints, &stated)?);
    Ok(out)
}

struct Configuration<'a> {
    file: &'a str,
    text: &'a str,
}

impl Configuration<'_> {
    fn error(&self, message: String) -> RobotError {
        RobotError::Configuration { place: self.file.to_owned(), message }
    }

    fn check_whole(&self) -> Result<(), RobotError> {
        let at = |line: usize, message: String| {
            Err(RobotError::Configuration { place: format!("{}:{line}", self.file), message })
        };
        if !self.text.trim_start_matches('\u{feff}').starts_with(HEADER) {
            return at(
                1,
                format!(
                    "not a motion configuration: it does not begin with {HEADER}; give SYSPAR/MOC.cfg of a backup"
                ),
            );
        }
        let broken = break_off(self.text).map(|(line, how)| (line, how.to_owned()));
        // What a controller writes ends in other sections than it begins with.
        let [begins, ends] = ENDS.map(|name| !section(self.text, name).is_empty());
        let lacks = (begins && !ends)
            .then(|| (self.text.lines().count(), format!("there is no section {}", ENDS[1])));
        match broken.or(lacks) {
            Some((line, how)) => {
                at(line, format!("the file breaks off here ({how}); take it from the backup again"))
            }
            None => Ok(()),
        }
    }

    /// The robot and its number among the robots.
    fn robot(&self, unit: Option<&str>) -> Result<(usize, Entry), RobotError> {
        let robots = section(self.text, "ROBOT");
        let name = |robot: &Entry| robot.get("name").cloned().unwrap_or_default();
        let names: Vec<String> = robots.iter().map(name).collect();
        let chosen = match (unit, robots.len()) {
            (_, 0) => {
                let message = "it has no robot (no entry in the section ROBOT); is it cut?";
                return Err(self.error(message.into()));
            }
            (None, 1) => Some(0),
            (None, _) => None,
            (Some(unit), _) => names.iter().position(|name| name.eq_ignore_ascii_case(unit)),
        };
        match chosen {
            Some(index) => Ok((index, robots[index].clone())),
            None => Err(self.error(format!(
                "it has the robots {}; name one of them with --unit",
                names.join(", ")
            ))),
        }
    }

    fn base(&self, robot: &Entry) -> Result<Option<Isometry3<f64>>, RobotError> {
        if !robot
            .keys()
            .any(|key| key.starts_with("base_frame_pos") || key.starts_with("base_frame_orient"))
        {
            return Ok(None);
        }
        let or = |key: &str, absent: f64| {
            if robot.contains_key(key) { self.number(robot, key, "ROBOT") } else { Ok(absent) }
        };
        let [x, y, z] = [
            or("base_frame_pos_x", 0.0)?,
            or("base_frame_pos_y", 0.0)?,
            or("base_frame_pos_z", 0.0)?,
        ];
        let [w, i, j, k] = [
            or("base_frame_orient_u0", 1.0)?,
            or("base_frame_orient_u1", 0.0)?,
            or("base_frame_orient_u2", 0.0)?,
            or("base_frame_orient_u3", 0.0)?,
        ];
        let Some(turn) = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 0.1) else {
            let message = "the base frame's orientation is no quaternion: base_frame_orient_u0…u3";
            return Err(self.error(message.into()));
        };
        Ok(Some(Isometry3::from_parts(Translation3::new(x, y, z), turn)))
    }

    /// The levels of all joints; `None` where the file has none.
    fn friction(&self, index: usize, dof: usize) -> Result<Option<Vec<f64>>, RobotError> {
        let blocks = section(self.text, "CFRIC_BLOCK");
        let mut levels = Vec::with_capacity(dof);
        for joint in 1..=dof {
            let name = format!("r{}_CFric_{joint}", index + 1);
            let Some(block) = find(&blocks, &name) else {
                if levels.is_empty() {
                    return Ok(None);
                }
                return self.named(&blocks, &name, "CFRIC_BLOCK").map(|_| None);
            };
            if !block.contains_key("friction_ff_level") {
                return Ok(None);
            }
            levels.push(self.number(block, "friction_ff_level", &name)?);
        }
        Ok(Some(levels))
    }

    fn arm_loads(
        &self,
        index: usize,
        arms: &[Entry],
        joints: &[String],
        stated: &str,
    ) -> Result<String, RobotError> {
        let loads = section(self.text, "ARM_LOAD");
        let mut out = String::new();
        for (i, joint) in joints.iter().enumerate() {
            let used = find(arms, joint).and_then(|arm| arm.get("use_customer_arm_load")).cloned();
            let name = used.unwrap_or_else(|| format!("r{}_load_{}", index + 1, i + 1));
            let Some(load) = find(&loads, &name) else { continue };
            let or_zero = |key: &str| {
                if load.contains_key(key) { self.number(load, key, &name) } else { Ok(0.0) }
            };
            let mass = or_zero("mass")?;
            if mass <= 0.0 {
                continue;
            }
            let com =
                [or_zero("mass_centre_x")?, or_zero("mass_centre_y")?, or_zero("mass_centre_z")?];
            let moments = [or_zero("inertia_x")?, or_zero("inertia_y")?, or_zero("inertia_z")?];
            let inertia = [moments[0], moments[1], moments[2], 0.0, 0.0, 0.0];
            let _ = write!(
                out,
                "\n# {name}: the axes are taken as those of the joint's frame.\n[[arm_load]]\n\
                 {stated}joint = {}\nmass = {mass:?}\ncom = {}\ninertia = {}\n",
                i + 1,
                list(&com),
                list(&inertia)
            );
        }
        Ok(out)
    }

    fn named<'e>(
        &self,
        entries: &'e [Entry],
        name: &str,
        section: &str,
    ) -> Result<&'e Entry, RobotError> {
        find(entries, name).ok_or_else(|| {
            self.error(format!(
                "the section {section} has no \"{name}\"; is the file cut? take it from the backup \
                 again"
            ))
        })
    }

    fn text<'e>(&self, entry: &'e Entry, key: &str, of: &str) -> Result<&'e str, RobotError> {
        entry.get(key).map(String::as_str).filter(|value| !value.is_empty()).ok_or_else(|| {
            self.error(format!("{of} has no -{key}; take the file from the backup again"))
        })
    }

    fn number(&self, entry: &Entry, key: &str, of: &str) -> Result<f64, RobotError> {
        let text = self.text(entry, key, of)?;
        text.parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| self.error(format!("-{key} of {of} is \"{text}\"; it must be a number")))
    }
}

fn find<'e>(entries: &'e [Entry], name: &str) -> Option<&'e Entry> {
    entries.iter().find(|e| e.get("name").is_some_and(|own| own.eq_ignore_ascii_case(name)))
}

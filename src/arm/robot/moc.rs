//! A motion configuration of a controller, `SYSPAR/MOC.cfg`, as an overlay on a catalogue robot.
//!
//! It contains the robot type and its installation: joint ranges, base frame, arm loads, the
//! largest TCP speed, the levels of the friction compensation. It has no lengths, gears or motors
//! of the standard axes.

use std::fmt::Write;

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::error::RobotError;
use super::fields::{Accepts, LENGTH, TURN, is_turn};
use super::limits::TCP_SPEED;
use super::link::{Link, MASS};
use super::load::find as find_robot;
use super::system_parameters::{Entry, section, truncation};
use super::toml_text::{list, pose, quoted};

/// One of the first and one of the last sections of a file written by a controller.
const ENDS: [&str; 2] = ["MOTION_SYSTEM", "MOTOR_CALIB"];

/// Sections that are read.
const READ: [&str; 5] = ["MOTION_PLANNER", "ROBOT", "ARM", "ARM_LOAD", "CFRIC_BLOCK"];

/// Tolerance of the length of a quaternion: few printed digits.
const UNIT: f64 = 0.01;

/// Coordinates in m and components of a quaternion.
const PLACEMENT: Accepts = Accepts::Between(-1000.0, 1000.0, "a number, in m");
/// Levels of the friction compensation \[Nm\].
const FRICTION_LEVEL: Accepts = Accepts::Between(0.0, 1000.0, "0 or more and at most 1000, in Nm");

/// Start of every motion configuration.
const HEADER: &str = "MOC:CFG_";

/// The Robot TOML of the robot in a `MOC.cfg`; `file` is its name in messages and as source, `unit`
/// the mechanical unit if the controller has several robots.
///
/// # Errors
/// It is no motion configuration, is truncated or lacks a range; the catalogue does not contain its
/// robot; it has several robots and `unit` names none of them.
pub fn import_moc(file: &str, text: &str, unit: Option<&str>) -> Result<String, RobotError> {
    let configuration = Configuration { file, text };
    configuration.check_complete()?;
    let (index, robot) = configuration.robot(unit)?;
    let kind = configuration.text(&robot, "use_robot_type", "ROBOT")?;
    let model = find_robot(kind).map_err(|error| {
        configuration.error_at(robot.line_of("use_robot_type"), error.to_string())
    })?;

    let source = quoted(&format!("{file}, {kind}"));
    let stated = format!("source = {source}\nprovenance = \"identified\"\n");
    let entry = |key: &str, value: &str| {
        format!("{key} = {value}\n{key}_source = {source}\n{key}_provenance = \"identified\"\n")
    };
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
    let mut ranges = String::from("[\n");
    for joint in &joints {
        let arm = configuration.named(&arms, joint, "ARM")?;
        let keys = ["lower_joint_bound", "upper_joint_bound"];
        let _ = writeln!(ranges, "  {},", list(&configuration.range(arm, keys, joint)?));
    }
    let _ = write!(out, "\n[limits]\n{}", entry("position", &(ranges + "]")));
    // Ranges of the controller hold without the conditions of the data sheet.
    out.push_str("position_if = []\n");
    if let Some(arm) = joints.get(2).and_then(|joint| find(&arms, joint))
        && arm.contains_key("upper_joint_coupl_bound")
    {
        let keys = ["lower_joint_coupl_bound", "upper_joint_coupl_bound"];
        out.push_str(&entry("coupled", &list(&configuration.range(arm, keys, &joints[2])?)));
    }
    let planners = section(text, "MOTION_PLANNER");
    if let Some(planner) = planners.get(index).filter(|p| p.contains_key("linear_max_speed")) {
        let speed =
            configuration.number(planner, "linear_max_speed", "MOTION_PLANNER", TCP_SPEED)?;
        out.push_str(&entry("tcp_speed", &format!("{speed:?}")));
    }
    if let Some(levels) = configuration.friction(index, model.dof)? {
        let _ = write!(out, "\n[controller]\n{}", entry("friction_level", &list(&levels)));
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

    fn error_at(&self, line: usize, message: String) -> RobotError {
        RobotError::Configuration { place: format!("{}:{line}", self.file), message }
    }

    fn check_complete(&self) -> Result<(), RobotError> {
        let at = |line: usize, message: String| Err(self.error_at(line, message));
        if !self.text.trim_start_matches('\u{feff}').starts_with(HEADER) {
            return at(
                1,
                format!(
                    "not a motion configuration: it does not begin with {HEADER}; give SYSPAR/MOC.cfg of a backup"
                ),
            );
        }
        let broken = truncation(self.text).map(|(line, how)| (line, how.to_owned()));
        // A file that starts like one of a controller must also end like one.
        let [begins, ends] = ENDS.map(|name| !section(self.text, name).is_empty());
        let lacks = (begins && !ends)
            .then(|| (self.text.lines().count(), format!("there is no section {}", ENDS[1])));
        if let Some((line, how)) = broken.or(lacks) {
            let message =
                format!("the file is cut off here ({how}); copy it from the backup again");
            return at(line, message);
        }
        for name in READ {
            self.check_once(name)?;
        }
        Ok(())
    }

    /// Entries of a section have distinct names, keys of an entry are unique.
    fn check_once(&self, name: &str) -> Result<(), RobotError> {
        let entries = section(self.text, name);
        for (i, entry) in entries.iter().enumerate() {
            if let Some((key, line)) = entry.repeated() {
                let message = format!("a second -{key} in one entry of {name}; remove one");
                return Err(self.error_at(line, message));
            }
            let Some(own) = entry.get("name") else { continue };
            if let Some(first) = find(&entries[..i], own) {
                return Err(self.error_at(
                    entry.line_of("name"),
                    format!(
                        "a second \"{own}\" in {name}, the first is in line {}; rename or remove \
                         one (where the whole file is there twice, take it from the backup again)",
                        first.line_of("name")
                    ),
                ));
            }
        }
        Ok(())
    }

    /// The robot and its index among the robots.
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
        let position = ["x", "y", "z"].map(|axis| format!("base_frame_pos_{axis}"));
        let [x, y, z] = self.numbers(robot, &position, "ROBOT", PLACEMENT)?;
        let turn = [0, 1, 2, 3].map(|i| format!("base_frame_orient_u{i}"));
        let [u0, u1, u2, u3] = self.numbers(robot, &turn, "ROBOT", PLACEMENT)?;
        let u0 = if robot.contains_key(&turn[0]) { u0 } else { 1.0 };
        let turn = Quaternion::new(u0, u1, u2, u3);
        if (turn.norm() - 1.0).abs() > UNIT {
            let key = robot.keys().find(|key| key.starts_with("base_frame_orient"));
            return Err(self.error_at(
                robot.line_of(key.unwrap_or_default()),
                format!(
                    "-base_frame_orient_u0…u3 are a quaternion of length {:.3}; correct them to \
                     length 1",
                    turn.norm()
                ),
            ));
        }
        let turn = UnitQuaternion::new_normalize(turn);
        Ok(Some(Isometry3::from_parts(Translation3::new(x, y, z), turn)))
    }

    /// The levels of all joints; `None` if the file has none.
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
            levels.push(self.number(block, "friction_ff_level", &name, FRICTION_LEVEL)?);
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
        let stated_of = |entry: &Entry| entry.get("use_customer_arm_load").cloned();
        let referred: Vec<String> = arms.iter().filter_map(stated_of).collect();
        let is_referred = |name: &str| referred.iter().any(|own| own.eq_ignore_ascii_case(name));
        let prefix = format!("r{}_load_", index + 1);
        let mut carried: Vec<String> = Vec::new();
        let mut out = String::new();
        for (i, joint) in joints.iter().enumerate() {
            let arm = find(arms, joint);
            let stated_name = arm.and_then(stated_of).filter(|name| !name.is_empty());
            // A load with a reference is at its arm, independent of its number.
            let usual = format!("{prefix}{}", i + 1);
            let own = Some(usual).filter(|name| !is_referred(name));
            let Some(name) = stated_name.clone().or(own) else { continue };
            let Some(load) = find(&loads, &name) else {
                if stated_name.is_none() {
                    continue;
                }
                return Err(self.error_at(
                    arm.map_or(1, |arm| arm.line_of("use_customer_arm_load")),
                    format!(
                        "-use_customer_arm_load of {joint} is \"{name}\", which the section \
                         ARM_LOAD does not have; add it or name another"
                    ),
                ));
            };
            if let Some(body) = self.arm_load(load, &name)? {
                let _ = write!(
                    out,
                    "\n# {name}: the axes are taken as those of the joint's frame.\n[[arm_load]]\n\
                     {stated}joint = {}\n{body}",
                    i + 1,
                );
            }
            carried.push(name);
        }
        for load in &loads {
            let name = load.get("name").map_or("", String::as_str);
            let known = carried.iter().any(|own| own.eq_ignore_ascii_case(name));
            let of_robot = name.to_lowercase().starts_with(&prefix);
            if of_robot && !known && !is_referred(name) && self.arm_load(load, name)?.is_some() {
                return Err(self.error_at(
                    load.line_of("name"),
                    format!(
                        "no arm carries the load {name}; name it in -use_customer_arm_load of its \
                         ARM, or remove it"
                    ),
                ));
            }
        }
        Ok(out)
    }

    /// The keys of the body of a load; `None` if its mass is 0.
    fn arm_load(&self, load: &Entry, name: &str) -> Result<Option<String>, RobotError> {
        let [mass] = self.numbers(load, &["mass".to_owned()], name, MASS)?;
        let keys = ["x", "y", "z"].map(|axis| format!("mass_centre_{axis}"));
        let com = self.numbers(load, &keys, name, LENGTH)?;
        let keys = ["x", "y", "z"].map(|axis| format!("inertia_{axis}"));
        let moments = self.numbers(load, &keys, name, Accepts::NonNegative)?;
        if mass == 0.0 {
            return Ok(None);
        }
        let body = Link {
            mass,
            com: Vector3::from(com),
            inertia: Matrix3::from_diagonal(&Vector3::from(moments)),
        };
        if let Some(why) = body.impossible() {
            let key = keys.iter().find(|key| load.contains_key(key));
            return Err(self.error_at(
                load.line_of(key.map_or("mass", String::as_str)),
                format!(
                    "{name}: {why}; correct -inertia_x, -inertia_y and -inertia_z (kg m2), or leave \
                     all three out"
                ),
            ));
        }
        let inertia = list(&[moments[0], moments[1], moments[2], 0.0, 0.0, 0.0]);
        Ok(Some(format!("mass = {mass:?}\ncom = {}\ninertia = {inertia}\n", list(&com))))
    }

    /// The interval of two keys \[rad\].
    fn range(&self, arm: &Entry, keys: [&str; 2], joint: &str) -> Result<[f64; 2], RobotError> {
        let [low, high] =
            [self.number(arm, keys[0], joint, TURN)?, self.number(arm, keys[1], joint, TURN)?];
        for (key, bound) in keys.into_iter().zip([low, high]) {
            if !is_turn(bound) {
                return Err(self.refused(arm, key, joint, TURN));
            }
        }
        if low < high {
            return Ok([low, high]);
        }
        Err(self.error_at(
            arm.line_of(keys[1]),
            format!(
                "{joint} turns from {low} to {high} rad; correct -{} and -{}",
                keys[0], keys[1]
            ),
        ))
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
            let message = format!("{of} has no -{key}; take the file from the backup again");
            self.error_at(entry.line_of(key), message)
        })
    }

    /// The values of keys, 0 for an absent one.
    fn numbers<const N: usize>(
        &self,
        entry: &Entry,
        keys: &[String; N],
        of: &str,
        accepts: Accepts,
    ) -> Result<[f64; N], RobotError> {
        let mut values = [0.0; N];
        for (value, key) in values.iter_mut().zip(keys).filter(|(_, key)| entry.contains_key(key)) {
            *value = self.number(entry, key, of, accepts)?;
        }
        Ok(values)
    }

    fn number(
        &self,
        entry: &Entry,
        key: &str,
        of: &str,
        accepts: Accepts,
    ) -> Result<f64, RobotError> {
        let number = self.text(entry, key, of)?.parse().ok();
        number
            .filter(|value| accepts.holds(*value))
            .ok_or_else(|| self.refused(entry, key, of, accepts))
    }

    fn refused(&self, entry: &Entry, key: &str, of: &str, accepts: Accepts) -> RobotError {
        let text = entry.get(key).map_or("", String::as_str);
        self.error_at(
            entry.line_of(key),
            format!("-{key} of {of} is \"{text}\"; it must be {}", accepts.words()),
        )
    }
}

fn find<'e>(entries: &'e [Entry], name: &str) -> Option<&'e Entry> {
    entries.iter().find(|e| e.get("name").is_some_and(|own| own.eq_ignore_ascii_case(name)))
}

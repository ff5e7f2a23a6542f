//! A model as complete Robot TOML with the origin of each number.

use std::fmt::Write;

use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use super::drive::Sharing;
use super::effect::Given;
use super::geometry::{Coupling, Joint};
use super::model::Model;
use super::provenance::{Origin, Provenance};
use super::toml_text::{list, number, pose_entries, quoted};

/// The text of a model; reading it returns the same model.
#[must_use]
pub fn to_toml(model: &Model) -> String {
    let mut out = Writer { origins: &model.origins, text: String::new() };
    let _ = writeln!(out.text, "name = {}", quoted(&model.name));
    if let Some(name) = &model.type_name {
        let _ = writeln!(out.text, "type = {}", quoted(name));
    }
    for (key, value) in [("mass", model.mass), ("payload", model.payload)] {
        if let Some(value) = value {
            let _ = writeln!(out.text, "{key} = {}", number(value));
        }
    }
    geometry(model, &mut out);
    limits(model, &mut out);
    for (i, link) in model.links.iter().enumerate() {
        let m = &link.inertia;
        let moments = [m.m11, m.m22, m.m33, m.m12, m.m13, m.m23];
        let entries = [
            ("mass", number(link.mass)),
            ("com", list(link.com.as_slice())),
            ("inertia", list(&moments)),
        ];
        out.table(&format!("link {}", i + 1), &entries);
    }
    friction(model, &mut out);
    motors(model, &mut out);
    if model.wrist.coupling != 0.0 {
        out.table("wrist", &[("coupling", number(model.wrist.coupling))]);
    }
    power(model, &mut out);
    effects(model, &mut out);
    if let Some(calibration) = &model.calibration {
        let _ = writeln!(out.text, "\n[calibration]\nrobots = {}", calibration.robots);
        let _ = writeln!(out.text, "\n[calibration.draws]");
        for (name, draws) in &calibration.draws {
            let _ = writeln!(out.text, "{} = {}", quoted(name), list(draws));
        }
    }
    out.text
}

struct Writer<'a> {
    origins: &'a [Origin],
    text: String,
}

impl Writer<'_> {
    /// A table, or an entry of a list of tables such as `link 2`; a common origin is written once.
    fn table(&mut self, name: &str, entries: &[(&str, String)]) {
        let origins = self.origins;
        let origin = |key: &str| {
            let found = origins.iter().find(|o| o.table == name && o.key == key);
            found.map_or((None, None), |o| (o.provenance, o.source.as_deref()))
        };
        let first = entries.first().map_or((None, None), |(key, _)| origin(key));
        let shared = entries.iter().all(|(key, _)| origin(key) == first);
        let _ = match name.rsplit_once(' ') {
            Some((list, _)) => writeln!(self.text, "\n[[{list}]]"),
            None => writeln!(self.text, "\n[{name}]"),
        };
        if shared {
            self.origin("", first);
        }
        for (key, value) in entries {
            let _ = writeln!(self.text, "{key} = {value}");
            let own = origins.iter().find(|o| o.table == name && o.key == *key);
            if let Some(sd) = own.and_then(|own| own.sd.as_ref()) {
                let sd = if let [one] = sd.as_slice() { number(*one) } else { list(sd) };
                let _ = writeln!(self.text, "{key}_sd = {sd}");
            }
            if !shared {
                self.origin(&format!("{key}_"), origin(key));
            }
        }
    }

    fn origin(&mut self, prefix: &str, (provenance, source): (Option<Provenance>, Option<&str>)) {
        if let Some(source) = source {
            let _ = writeln!(self.text, "{prefix}source = {}", quoted(source));
        }
        if let Some(provenance) = provenance {
            let _ = writeln!(self.text, "{prefix}provenance = \"{provenance}\"");
        }
    }
}

fn geometry(model: &Model, out: &mut Writer<'_>) {
    let geometry = &model.kinematics;
    if geometry.coupling == Coupling::Parallelogram {
        out.table("kinematics", &[("coupling", quoted("parallelogram"))]);
    }
    if geometry.base != Isometry3::identity() {
        out.table("kinematics.base", &pose_entries(&geometry.base));
    }
    // An OPW form recognised in a chain has rounding errors: then the chain is written.
    let as_opw = geometry.opw.as_ref().filter(|opw| {
        let (joints, flange) = opw.chain();
        joints == geometry.joints && flange == geometry.flange
    });
    if let Some(opw) = as_opw {
        let lengths = [opw.a1, opw.a2, opw.b, opw.c1, opw.c2, opw.c3, opw.c4];
        let names = ["a1", "a2", "b", "c1", "c2", "c3", "c4"];
        let mut entries: Vec<(&str, String)> = names.into_iter().zip(lengths.map(number)).collect();
        entries.push(("offsets", list(&opw.offsets)));
        entries.push(("signs", list(&opw.signs)));
        out.table("kinematics.opw", &entries);
        return;
    }
    if geometry.flange != Isometry3::identity() {
        out.table("kinematics.flange", &pose_entries(&geometry.flange));
    }
    for (i, joint) in geometry.joints.iter().enumerate() {
        let mut entries = pose_entries(&frame(joint)).to_vec();
        entries.push(("axis", list(joint.axis.as_slice())));
        out.table(&format!("joint {}", i + 1), &entries);
    }
}

fn frame(joint: &Joint) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::from(joint.translation),
        UnitQuaternion::from_rotation_matrix(&joint.rotation),
    )
}

fn limits(model: &Model, out: &mut Writer<'_>) {
    let limits = &model.limits;
    let ranges: Vec<String> = limits.position.iter().map(|range| list(range)).collect();
    let mut entries = vec![("position", format!("[{}]", ranges.join(", ")))];
    entries.extend(limits.coupled.as_ref().map(|range| ("coupled", list(range))));
    entries.extend(limits.velocity.as_ref().map(|x| ("velocity", list(x))));
    entries.extend(limits.acceleration.as_ref().map(|x| ("acceleration", list(x))));
    entries.extend(limits.jerk.as_ref().map(|x| ("jerk", list(x))));
    entries.extend(limits.torque.as_ref().map(|x| ("torque", list(x))));
    entries.extend(limits.tcp_speed.map(|x| ("tcp_speed", number(x))));
    entries.extend(limits.tcp_acceleration.map(|x| ("tcp_acceleration", number(x))));
    out.table("limits", &entries);
    if let Some(by_pose) = &limits.acceleration_by_pose {
        let entries = [
            ("axis_1", list(&by_pose.axis_1)),
            ("axis_2", list(&by_pose.axis_2)),
            ("axis_3", list(&by_pose.axis_3)),
        ];
        out.table("limits.acceleration_by_pose", &entries);
    }
    for (i, wider) in limits.position_if.iter().enumerate() {
        let entries = [
            ("joint", (wider.joint + 1).to_string()),
            ("position", list(&wider.position)),
            ("if_joint", (wider.if_joint + 1).to_string()),
            ("if_within", list(&wider.if_within)),
        ];
        out.table(&format!("limits.position_if {}", i + 1), &entries);
    }
}

fn friction(model: &Model, out: &mut Writer<'_>) {
    let friction = &model.friction;
    let mut entries =
        vec![("coulomb", list(&friction.coulomb)), ("viscous", list(&friction.viscous))];
    entries.extend(friction.coulomb_asymmetry.as_ref().map(|x| ("coulomb_asymmetry", list(x))));
    out.table("friction", &entries);
    if let Some(law) = &friction.stribeck {
        let entries = [("stiction", list(&law.stiction)), ("velocity", list(&law.velocity))];
        out.table("friction.stribeck", &entries);
    }
    for (table, key, values) in [
        ("friction.viscous_asymmetry", "asymmetry", &friction.viscous_asymmetry),
        ("friction.load_friction", "mu", &friction.load_friction),
    ] {
        if let Some(values) = values {
            out.table(table, &[(key, list(values))]);
        }
    }
}

fn motors(model: &Model, out: &mut Writer<'_>) {
    let Some(motors) = &model.motors else { return };
    let mut entries = vec![("ratio", list(&motors.ratio))];
    entries.extend(motors.torque_constant.as_ref().map(|x| ("torque_constant", list(x))));
    entries.push(("rotor_inertia", list(&motors.rotor_inertia)));
    entries.push(("loss_constant", list(&motors.loss_constant)));
    entries.extend(motors.peak_current.as_ref().map(|x| ("peak_current", list(x))));
    entries.extend(motors.rated_current.as_ref().map(|x| ("rated_current", list(x))));
    out.table("motors", &entries);
}

fn effects(model: &Model, out: &mut Writer<'_>) {
    for effect in &model.effects {
        let entries: Vec<(&str, String)> = effect
            .values
            .iter()
            .map(|(name, given)| {
                let value = match given {
                    Given::Robot(value) => number(*value),
                    Given::Joints(values) => list(values),
                };
                (name.as_str(), value)
            })
            .collect();
        out.table(&format!("effects.{}", effect.id), &entries);
    }
    // Errors of the log are in `sensors`.
    let sensors = &model.sensors;
    let (inertia, viscous) = (&sensors.apparent_inertia, &sensors.apparent_viscous);
    for (id, parameters) in [
        ("apparent_torque", vec![("inertia", inertia), ("viscous", viscous)]),
        ("encoder_offset", vec![("offset", &sensors.position_offset)]),
        ("torque_offset", vec![("offset", &sensors.torque_offset)]),
        ("torque_constant", vec![("error", &sensors.torque_error)]),
    ] {
        let given = |values: &Vec<f64>| values.iter().any(|value| *value != 0.0);
        let entries: Vec<(&str, String)> = parameters
            .into_iter()
            .filter(|(_, values)| given(values))
            .map(|(key, values)| (key, list(values)))
            .collect();
        if !entries.is_empty() {
            out.table(&format!("effects.{id}"), &entries);
        }
    }
}

fn power(model: &Model, out: &mut Writer<'_>) {
    let drive = &model.drive;
    let sharing = match drive.sharing {
        Sharing::None => "none",
        Sharing::Bus => "bus",
    };
    let entries = [
        ("base_w", number(drive.base_w)),
        ("sharing", quoted(sharing)),
        ("regeneration", number(drive.regeneration)),
    ];
    out.table("drive", &entries);
    if let Some(brakes) = &model.brakes {
        let has = |key: &str| model.origin_of("brakes", key).is_some();
        let entries = [
            ("energy_per_release_j", brakes.energy_per_release_j),
            ("release_s", brakes.release_s),
            ("engage_s", brakes.engage_s),
            ("power_released_w", brakes.power_released_w),
        ];
        // An unstated 0 is omitted, so that it is estimated on reading.
        let stated = entries.iter().filter(|(key, value)| *value != 0.0 || has(key));
        let entries: Vec<_> = stated.map(|(key, value)| (*key, number(*value))).collect();
        out.table("brakes", &entries);
    }
    out.table("standstill", &[("holding_w", list(&model.standstill.holding_w))]);
    let controller = &model.controller;
    let mut entries = Vec::new();
    entries.extend(controller.friction_level.as_ref().map(|x| ("friction_level", list(x))));
    entries.extend(controller.ramp_s.map(|x| ("ramp_s", number(x))));
    entries.extend(controller.ramp_core.map(|x| ("ramp_core", number(x))));
    entries.extend(controller.closing.map(|x| ("closing", number(x))));
    entries.extend(controller.settling_s.map(|x| ("settling_s", number(x))));
    entries.extend(controller.interpolation_s.map(|x| ("interpolation_s", number(x))));
    if !entries.is_empty() {
        out.table("controller", &entries);
    }
}

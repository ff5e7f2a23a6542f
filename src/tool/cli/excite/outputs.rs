//! Writes the output of `joulepath excite`: modules, table and result.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::bail;
use serde_json::{Value, json};

use super::args::{TorqueArg, Variant};
use super::motion::Motion;
use crate::arm::dynamics::{Data, Load, torque};
use crate::arm::robot::Model;
use crate::learn::excite::State;
use crate::tool::cli::output;
use crate::tool::emit::{Excitation, LoggedTorques, Points, excitation};

/// Distance of the marks from the middle of joint 1's motion, as share of its range of motion.
const MARK_SHARE: f64 = 0.02;

/// Writes the modules and the table; returns their paths.
pub(super) fn write(
    out: &Path,
    (title, torques): (&str, TorqueArg),
    model: &Model,
    load: &Load,
    motion: &Motion,
) -> anyhow::Result<Vec<String>> {
    let six = |state: &State| -> [f64; 6] { std::array::from_fn(|joint| state[0][joint]) };
    let positions = |states: &[State]| states.iter().map(six).collect::<Vec<_>>();
    let mut lists = Vec::new();
    let (mut start, mut stop) = (motion.points.first().map(six), motion.points.last().map(six));
    let spacing = motion.period / motion.points.len().max(1) as f64;
    let into = motion.blends.as_ref().map(|[into, _]| into.sampled(spacing));
    let back = motion.blends.as_ref().map(|[_, back]| back.sampled(spacing));
    if let Some(into) = &into {
        start = into.first().map(six);
        let points = positions(into.get(1..).unwrap_or_default());
        lists.push(Points { what: "From rest", name: "In", repeated: false, points });
    }
    // The blend ends at the first point, and the period ends with it again.
    let mut period = motion.points.clone();
    if motion.blends.is_some() && !period.is_empty() {
        period.rotate_left(1);
    }
    let repeated = motion.cycles > 1;
    lists.push(Points { what: "One repetition", name: "Q", repeated, points: positions(&period) });
    if let Some(back) = &back {
        stop = back.last().map(six);
        let points = positions(back.get(1..back.len().saturating_sub(1)).unwrap_or_default());
        lists.push(Points { what: "To rest", name: "Out", repeated: false, points });
    }
    let first: Vec<f64> = motion.states.iter().map(|state| state[0][0]).collect();
    let low = first.iter().copied().fold(f64::INFINITY, f64::min);
    let high = first.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (middle, range) = (0.5 * (low + high), high - low);
    let [motion_module, logger] = excitation(&Excitation {
        title: title.to_owned(),
        robot: model.name.clone(),
        cycles: motion.cycles,
        period: motion.period,
        spacing,
        start: start.unwrap_or_default(),
        lists,
        stop: stop.unwrap_or_default(),
        marks: [middle - MARK_SHARE * range, middle + MARK_SHARE * range],
        torques: logged_torques(torques, model)?,
    })?;
    let mut outputs = Vec::new();
    let table = table(model, load, motion);
    for (name, text) in [motion_module, logger, ("excitation.csv".to_owned(), table)] {
        let path = out.join(name);
        output::write(&path, text.as_bytes())?;
        outputs.push(path.display().to_string());
    }
    Ok(outputs)
}

fn logged_torques(from: TorqueArg, model: &Model) -> anyhow::Result<LoggedTorques> {
    if from == TorqueArg::TestSignal {
        return Ok(LoggedTorques::TestSignals);
    }
    let Some(motors) = &model.motors else {
        bail!(
            "--torque motor-torque: {} has no gear ratios; give them in [motors] of a robot file",
            model.name
        );
    };
    Ok(LoggedTorques::Motors { ratio: motors.ratio.clone(), coupling: model.wrist.coupling })
}

pub(super) fn title(variant: Variant) -> &'static str {
    match variant {
        Variant::Full => "Excitation of all parameters",
        Variant::Gravity => "Slow excitation of the weights",
        Variant::Friction => "Friction of each joint over speed",
        Variant::Payload => "Excitation of what the flange carries",
        Variant::Wrist => "Axes 5 and 6 alone and against each other",
        Variant::Warming => "Excitation of all parameters, from cold to warm",
    }
}

/// One repetition in steps of 1 ms.
fn table(model: &Model, load: &Load, motion: &Motion) -> String {
    let n = model.dof;
    let mut csv = String::from("t");
    for name in ["q", "qd", "qdd", "tau"] {
        for joint in 1..=n {
            let _ = write!(csv, ",{name}{joint}");
        }
    }
    csv.push('\n');
    let mut data = Data::new();
    let step = motion.period / motion.states.len().max(1) as f64;
    for (row, [q, qd, qdd]) in motion.states.iter().enumerate() {
        // Rounded to whole microseconds.
        let _ = write!(csv, "{}", (step * row as f64 * 1e6).round() / 1e6);
        for values in [q, qd, qdd] {
            for value in &values[..n] {
                let _ = write!(csv, ",{value}");
            }
        }
        let parts = torque(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
        for joint in 0..n {
            if model.has_dynamics() {
                let _ = write!(csv, ",{}", parts.rigid[joint] + parts.friction[joint]);
            } else {
                csv.push(',');
            }
        }
        csv.push('\n');
    }
    csv
}

pub(super) fn json(motion: &Motion, outputs: &[String]) -> Value {
    let information = motion.information.as_ref();
    let checked = &motion.checked;
    let room = |room: f64| if room.is_finite() { json!(room) } else { Value::Null };
    json!({
        "period_s": motion.period,
        "cycles": motion.cycles,
        "points": motion.points.len(),
        "rank": information.map(|i| i.rank),
        "condition": {
            "scaled": information.map(|i| i.scaled),
            "raw": information.map(|i| i.raw),
        },
        "log_det": information.map(|i| i.log_det),
        "max_ratio": {
            "position": checked.ratios.position,
            "velocity": checked.ratios.velocity,
            "acceleration": checked.ratios.acceleration,
            "torque": checked.ratios.torque,
        },
        "workspace_margin_m": room(checked.to_obstacles),
        "self_margin_m": room(checked.to_itself),
        "blend_s": motion.blends.as_ref().map(|of| of.iter().map(|b| b.duration).collect::<Vec<_>>()),
        "outputs": outputs,
    })
}

pub(super) fn text(motion: &Motion, outputs: &[String]) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{} repetition(s) of {:.2} s, {} points each",
        motion.cycles,
        motion.period,
        motion.points.len()
    );
    if let Some(told) = &motion.information {
        let _ = writeln!(
            text,
            "{} base parameters, condition {:.1} scaled, {:.0} raw, log det {:.1}",
            told.rank, told.scaled, told.raw, told.log_det
        );
    }
    let r = &motion.checked.ratios;
    let torque = match r.torque {
        0.0 => "not known (no dynamics or no limits)".to_owned(),
        torque => format!("{torque:.2}"),
    };
    let _ = writeln!(
        text,
        "largest share of the limits: position {:.2}, speed {:.2}, acceleration {:.2}, torque {torque}",
        r.position, r.velocity, r.acceleration
    );
    let _ = writeln!(
        text,
        "least room: {:.3} m to planes and boxes, {:.3} m of the arm to itself (capsules of assumed radii)",
        motion.checked.to_obstacles, motion.checked.to_itself
    );
    for path in outputs {
        let _ = writeln!(text, "{path}");
    }
    text
}

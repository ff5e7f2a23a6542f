//! `joulepath robots show`: what is known of a robot.

use std::fmt::Write as _;
use std::io::Write as _;

use serde_json::{Value, json};

use crate::cli::common::Format;
use crate::effects;
use crate::robot::{Model, Provenance};

/// Shows one robot.
pub(super) fn run(robot: &str, format: Format) -> anyhow::Result<()> {
    let model = effects::load_estimated(robot)?;
    let mut out = std::io::stdout().lock();
    match format {
        Format::Text => write!(out, "{}", text(&model))?,
        Format::Json => writeln!(out, "{:#}", document(&model))?,
    }
    Ok(())
}

fn text(model: &Model) -> String {
    let mut text = format!("{}, {} joints\n", model.name, model.dof);
    let degrees = |list: &[f64]| {
        list.iter().map(|x| format!("{:.1}", x.to_degrees())).collect::<Vec<_>>().join(" ")
    };
    // Hundredths, but no zeros behind them; -0 is 0.
    let shown = |angle: f64| (angle.to_degrees() * 100.0).round() / 100.0 + 0.0;
    let range = |[low, high]: &[f64; 2]| format!("{}…{}", shown(*low), shown(*high));
    let ranges: Vec<String> = model.limits.position.iter().map(range).collect();
    let _ = writeln!(text, "position deg: {}", ranges.join(" "));
    for wider in &model.limits.position_if {
        let _ = writeln!(
            text,
            "  axis {}: {} while axis {} is within {}",
            wider.joint + 1,
            range(&wider.position),
            wider.if_joint + 1,
            range(&wider.if_within)
        );
    }
    if let Some(coupled) = &model.limits.coupled {
        let _ = writeln!(text, "  axis 3 minus axis 2: {}", range(coupled));
    }
    for (what, list) in [
        ("speed deg/s", &model.limits.velocity),
        ("acceleration deg/s2", &model.limits.acceleration),
    ] {
        let figures = list.as_ref().map_or_else(|| "not known".into(), |list| degrees(list));
        let _ = writeln!(text, "{what}: {figures}");
    }
    let estimated = model.provenance_of("link 1", "mass") == Some(Provenance::Estimated);
    let dynamics = if estimated {
        "estimated"
    } else if model.has_dynamics() {
        "yes"
    } else {
        "no: energies can't be computed"
    };
    let _ = writeln!(text, "dynamics: {dynamics}");
    for (title, lines) in [("estimated", model.estimated()), ("assumed", model.assumed())] {
        if !lines.is_empty() {
            let _ = writeln!(text, "\n{title}:");
        }
        for line in lines {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

fn document(model: &Model) -> Value {
    let origins: Vec<Value> = model
        .origins
        .iter()
        .map(|origin| {
            json!({
                "table": origin.table,
                "key": origin.key,
                "provenance": origin.provenance.map(|p| p.to_string()),
                "source": origin.source,
                "sd": origin.sd,
            })
        })
        .collect();
    let limits = &model.limits;
    json!({
        "name": model.name,
        "joints": model.dof,
        "position_rad": limits.position,
        "velocity_rad_s": limits.velocity,
        "acceleration_rad_s2": limits.acceleration,
        "torque_nm": limits.torque,
        "tcp_speed_m_s": limits.tcp_speed,
        "dynamics": model.has_dynamics(),
        "estimated": model.estimated(),
        "assumed": model.assumed(),
        "origins": origins,
    })
}

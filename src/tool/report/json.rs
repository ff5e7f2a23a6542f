//! The JSON of `simulate` and `optimize`. The field names are a stable interface.

use serde_json::{Value, json};

use super::mark::mark;
use super::place::{Place, Places};
use super::simulated::{Simulated, StepKind};
use super::whole_cycle;
use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::energy::EnergyParts;
use crate::retime::energy::plausible::{Contribution, Interval};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::WaitBasis;
use crate::retime::optimize::check::Check;
use crate::retime::optimize::energy_curve::TimeEnergy;
use crate::tool::retrofit::{
    Figures, LowerLimits, OutputFile, OutputKind, Retrofit, Segment, SegmentKind, SignalKind,
    SignalShift, SpacingSaving,
};

/// The six energy parts, or nulls for a robot without dynamics.
fn energy_parts(parts: &EnergyParts, known: bool) -> Value {
    let value = |x: f64| known.then_some(x);
    json!({
        "mechanical_j": value(parts.mechanical_j),
        "friction_j": value(parts.friction_j),
        "copper_j": value(parts.copper_j),
        "drive_j": value(parts.drive_j),
        "idle_j": value(parts.idle_j),
        "brake_j": value(parts.brake_j),
    })
}

/// The result of `simulate`.
pub fn simulation(of: Simulated<'_>, places: Places<'_>, notes: &[String]) -> Value {
    let Simulated { model, entry, simulation, account, plausible } = of;
    let known = model.has_dynamics();
    let mut moves = Vec::new();
    let mut waits = Vec::new();
    for step in of.steps() {
        let place = places.of(step.span);
        let energy_j = known.then_some(step.energy_j);
        match step.kind {
            StepKind::Move(record) => moves.push(json!({
                "file": place.file,
                "line": place.first,
                "instruction": step.instruction,
                "routine": step.routine,
                "t_start_s": step.t_start,
                "duration_s": step.duration,
                "energy_j": energy_j,
                "limit": record.pace.name(),
                "mark": mark(&record.movement),
            })),
            StepKind::Wait(basis) => waits.push(json!({
                "file": place.file,
                "line": place.first,
                "instruction": step.instruction,
                "t_start_s": step.t_start,
                "duration_s": step.duration,
                "basis": match basis {
                    WaitBasis::Stated => "stated",
                    WaitBasis::Input => "input",
                    WaitBasis::Unknown => "unknown",
                },
                "energy_j": energy_j,
            })),
        }
    }
    json!({
        "robot": model.name,
        "entry": entry,
        "cycle_s": simulation.cycle_s,
        "energy_j": known.then(|| account.total.energy_j()),
        "motion_energy_j": known.then(|| account.total.motion_energy_j()),
        "energy_interval_j": plausible.map(|p| interval(p.energy_j)),
        "motion_energy_interval_j": plausible.map(|p| interval(p.motion_energy_j)),
        "energy_median_j": plausible.map(|p| p.energy_j.median),
        "motion_energy_median_j": plausible.map(|p| p.motion_energy_j.median),
        "torque_median_nm": plausible.map(|p| p.torque_nm.iter().map(|x| x.median).collect::<Vec<f64>>()),
        "torque_interval_nm": plausible.map(|p| p.torque_nm.iter().map(|x| interval(*x)).collect::<Vec<_>>()),
        "energy": energy_parts(&account.total, known),
        "estimated": plausible.map_or_else(Vec::new, |p| estimated(&p.contributions)),
        "moves": moves,
        "waits": waits,
        "notes": notes,
        "unresolved": unresolved(places, simulation),
        "assumed": assumed(model, simulation),
    })
}

/// `[low, high]`: the interval of 90 % of the plausible robots.
pub(super) fn interval(interval: Interval) -> [f64; 2] {
    [interval.low, interval.high]
}

pub(super) fn estimated(parts: &[Contribution]) -> Vec<Value> {
    let value = |part: &Contribution| {
        json!({
            "group": part.group,
            "share_of_variance": part.share,
            "narrowed_by": part.narrowed_by,
        })
    };
    parts.iter().map(value).collect()
}

/// The JSON field `unresolved`.
fn unresolved(places: Places<'_>, simulation: &Simulation) -> Vec<Value> {
    simulation
        .unresolved
        .iter()
        .map(|note| {
            let place = places.of(note.span);
            json!({ "file": place.file, "line": place.first, "reason": note.reason })
        })
        .collect()
}

/// The assumptions that the robot's file and the program leave open.
pub fn assumed(model: &Model, simulation: &Simulation) -> Vec<String> {
    let mut list = model.assumed();
    list.extend(simulation.assumed.iter().cloned());
    list
}

fn figures(figures: &Figures) -> Value {
    json!({
        "cycle_s": figures.cycle_s,
        "energy_j": figures.energy_j,
        "motion_energy_j": figures.motion_energy_j,
    })
}

/// The original figures, and the part of them that is padding.
fn original(retrofit: &Retrofit) -> Value {
    let mut value = figures(&retrofit.original);
    let padding = retrofit.padding.as_ref();
    value["padding_s"] = padding.map_or(0.0, |padding| padding.duration_s).into();
    value["padding_j"] = padding.map_or(0.0, |padding| padding.energy.energy_j()).into();
    value
}

/// The result of `optimize`. `outputs`: the written paths.
pub fn retrofit(
    model: &Model,
    entry: &str,
    places: Places<'_>,
    retrofit: &Retrofit,
    outputs: &[String],
) -> Value {
    let segments: Vec<Value> =
        retrofit.segments.iter().map(|segment| segment_value(places, segment)).collect();
    let worst = &retrofit.verification.worst;
    let checks: Vec<Value> = retrofit
        .verification
        .checks
        .iter()
        .map(|(what, held)| json!({ "check": what, "passed": held }))
        .collect();
    let uncertainty = retrofit.uncertainty.as_ref();
    let side = |mut value: Value, of: Option<[Interval; 2]>| {
        value["energy_interval_j"] = json!(of.map(|of| interval(of[0])));
        value["motion_energy_interval_j"] = json!(of.map(|of| interval(of[1])));
        value["energy_median_j"] = json!(of.map(|of| of[0].median));
        value["motion_energy_median_j"] = json!(of.map(|of| of[1].median));
        value
    };
    let mut value = json!({
        "robot": model.name,
        "entry": entry,
        "original": side(original(retrofit), uncertainty.map(|u| u.original)),
        "optimized": side(figures(&retrofit.optimized), uncertainty.map(|u| u.optimized)),
        "takt": whole_cycle::takt_json(&retrofit.whole_cycle),
        "whole_cycle": whole_cycle::energy_json(&retrofit.whole_cycle),
        "saving_percent": retrofit.saving_percent(),
        "saving_interval_percent": uncertainty.map(|u| interval(u.saving_percent[0])),
        "saving_median_percent": uncertainty.map(|u| u.saving_percent[0].median),
        "motion_saving_percent": retrofit.motion_saving_percent(),
        "motion_saving_interval_percent": uncertainty.map(|u| interval(u.saving_percent[1])),
        "motion_saving_median_percent": uncertainty.map(|u| u.saving_percent[1].median),
        "estimated": uncertainty.map_or_else(Vec::new, |u| estimated(&u.contributions)),
        "potential_j": retrofit.potential_j,
        "segments": segments,
        "verification": {
            "passed": retrofit.verification.passed,
            "max_ratio": ratios(worst),
            "max_path_deviation_m": worst.deviation_m,
            "max_polygon_deviation_m": worst.polygon_m,
            "endpoint_error_rad": worst.endpoint_error_rad,
            "intended_error_rad": retrofit.verification.intended_error_rad,
            "checks": checks,
        },
        "signals": retrofit.signals.iter().map(signal).collect::<Vec<Value>>(),
        "files": retrofit.outputs.iter().map(file).collect::<Vec<Value>>(),
        "outputs": outputs,
        "guards": {
            "instructions": retrofit.guard_instructions,
            "estimated_ms": retrofit.guards_ms(),
        },
        "lower_limits": retrofit.lower_limits.iter().map(lower_limits).collect::<Vec<Value>>(),
        "notes": retrofit.notes,
        "unresolved": unresolved(places, &retrofit.before.0),
        "assumed": assumed(model, &retrofit.before.0),
    });
    if !retrofit.whole_cycle.curve.is_empty() {
        value["cycle_curve"] = whole_cycle::curve_json(&retrofit.whole_cycle);
    }
    if !retrofit.spacings.is_empty() {
        value["spacings"] = retrofit.spacings.iter().map(spacing).collect();
    }
    value
}

fn spacing(of: &SpacingSaving) -> Value {
    json!({
        "spacing_s": of.spacing_s,
        "points": of.points,
        "saved_j": of.saved_j,
        "motion_saving_percent": of.motion_saving_percent,
        "used": of.is_used,
    })
}

fn lower_limits(lower: &LowerLimits) -> Value {
    json!({
        "share": lower.share,
        "original_s": lower.original_s,
        "optimized_s": lower.optimized_s,
    })
}

pub(super) fn signal(signal: &SignalShift) -> Value {
    json!({
        "name": signal.name,
        "kind": match signal.kind {
            SignalKind::Input => "input",
            SignalKind::Output => "output",
        },
        "times": signal.times,
        "order_kept": signal.order_kept,
        "largest_shift_s": signal.largest_shift_s,
    })
}

fn ratios(check: &Check) -> Value {
    json!({
        "velocity": check.velocity,
        "acceleration": check.acceleration,
        "jerk": check.jerk,
        "torque": check.torque,
        "tcp_speed": check.tcp_speed,
    })
}

fn segment_value(places: Places<'_>, segment: &Segment) -> Value {
    let place = places.of(segment.span);
    let piece = |span: &Span| {
        let Place { file, first, last } = places.of(*span);
        json!({ "file": file, "line_first": first, "line_last": last })
    };
    let mut value = json!({
        "file": place.file,
        "line_first": place.first,
        "line_last": place.last,
        "kind": match segment.kind {
            SegmentKind::Timing => "timing",
            SegmentKind::Path => "path",
            SegmentKind::Idle => "idle",
        },
        "rewritten": segment.rewritten,
        "reason": segment.reason.as_ref().map(ToString::to_string),
        "executions": segment.executions,
        "rewritten_executions": segment.rewritten_executions,
        "time_before_s": segment.time_before_s,
        "time_after_s": segment.time_after_s,
        "energy_before_j": segment.energy_before_j,
        "energy_after_j": segment.energy_after_j,
        "lower_bound_j": segment.lower_bound_j,
        "points": segment.points,
        "potential_j": segment.potential_j,
    });
    if segment.pieces.len() > 1 {
        value["pieces"] = segment.pieces.iter().map(piece).collect();
    }
    if !segment.pareto.is_empty() {
        let point = |point: &TimeEnergy| {
            json!({
                "time_s": point.time_s,
                "energy_j": point.energy_j,
                "lower_bound_j": point.lower_bound_j,
            })
        };
        value["pareto"] = segment.pareto.iter().map(point).collect();
    }
    value
}

pub(super) fn file(output: &OutputFile) -> Value {
    json!({
        "path": output.path,
        "kind": match output.kind {
            OutputKind::Unchanged => "unchanged",
            OutputKind::Changed => "changed",
            OutputKind::New => "new",
        },
    })
}

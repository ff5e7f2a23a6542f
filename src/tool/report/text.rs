//! The text of `simulate` and `optimize`.

use std::fmt::Write;

use super::mark::mark;
use super::place::Places;
use super::plausible::{energies, is_rewritten, saving};
use super::simulated::{Simulated, Step, StepKind};
use super::table::{Align, table};
use super::whole_cycle;
use crate::arm::robot::prior::is_mass_known;
use crate::arm::robot::{Model, Provenance};
use crate::rapid::ir::movement::Movement;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::WaitBasis;
use crate::tool::retrofit::{LowerLimits, Retrofit, Segment, SegmentKind};

/// The table of a simulation.
pub fn simulation(of: Simulated<'_>, places: Places<'_>) -> String {
    let Simulated { model, simulation, account, plausible, .. } = of;
    let known = model.has_dynamics();
    let row = |step: Step<'_>| {
        let instruction = match step.kind {
            StepKind::Move(record) => marked(&record.movement),
            StepKind::Wait(WaitBasis::Stated) => step.instruction.to_owned(),
            StepKind::Wait(WaitBasis::Input) => format!("{} (input)", step.instruction),
            StepKind::Wait(WaitBasis::Unknown) => format!("{} (unknown)", step.instruction),
        };
        vec![
            places.of(step.span).to_string(),
            instruction,
            step.routine.to_owned(),
            format!("{:.3}", step.t_start),
            format!("{:.3}", step.duration),
            if known { format!("{:.1}", step.energy_j) } else { "-".to_owned() },
        ]
    };
    let rows: Vec<Vec<String>> = of.steps().into_iter().map(row).collect();
    let mut out = table(
        &[
            ("place", Align::Left),
            ("instruction", Align::Left),
            ("routine", Align::Left),
            ("start s", Align::Right),
            ("time s", Align::Right),
            ("energy J", Align::Right),
        ],
        &rows,
    );
    let _ = write!(out, "\n{}: cycle {:.3} s", model.name, simulation.cycle_s);
    if known {
        let p = &account.total;
        let _ = writeln!(
            out,
            ", energy {:.1} J (rigid body {:.1}, friction {:.1}, copper {:.1}, drive {:.1}, \
             idle {:.1}, brakes {:.1})",
            p.energy_j(),
            p.mechanical_j,
            p.friction_j,
            p.copper_j,
            p.drive_j,
            p.idle_j,
            p.brake_j
        );
        for line in plausible.map(energies).unwrap_or_default() {
            let _ = writeln!(out, "{line}");
        }
    } else {
        let _ = writeln!(out, "; the robot's file has no dynamics, so no energy");
    }
    out
}

/// The instruction with its additional action.
fn marked(movement: &Movement) -> String {
    match mark(movement) {
        Some(mark) => format!("{} ({mark})", movement.instruction),
        None => movement.instruction.to_string(),
    }
}

/// Notes on a simulation, one per line: unresolved movements and assumptions.
pub fn notes(model: &Model, places: Places<'_>, simulation: &Simulation) -> Vec<String> {
    let mut notes = Vec::new();
    for note in &simulation.unresolved {
        notes.push(format!("{}: {}", places.of(note.span), note.reason));
    }
    for text in &simulation.assumed {
        notes.push(format!("assumed: {text}"));
    }
    let estimated = model.count(Provenance::Estimated);
    if let Some(calibration) = &model.calibration {
        notes.push(format!(
            "calibrated: {} was moved to a log of power; intervals are over {} robots that fit it",
            model.name, calibration.robots
        ));
    } else if estimated > 0 {
        let mass = if is_mass_known(model) {
            ""
        } else {
            "; its mass is not known: intervals are wider, state mass in its file (kg, of the whole robot)"
        };
        notes.push(format!(
            "estimated: {estimated} figures of {} follow from its size: every energy has an interval, \
             joulepath calibrate narrows it by a log of power, joulepath identify by currents{mass}",
            model.name
        ));
    }
    let assumed = model.assumed();
    if !assumed.is_empty() {
        notes.push(format!(
            "assumed: {} figures of {} (joulepath robots show lists them): energies are \
             estimates until a log of your robot calibrates them",
            assumed.len(),
            model.name
        ));
    }
    notes
}

/// The table of a retrofit.
pub fn retrofit(model: &Model, places: Places<'_>, retrofit: &Retrofit) -> String {
    let executed = retrofit.segments.iter().filter(|segment| segment.executions > 0);
    let mut rows: Vec<Vec<String>> = executed.map(|segment| segment_row(places, segment)).collect();
    if let Some(padding) = &retrofit.padding {
        rows.push(vec![
            "end of the cycle".to_owned(),
            "padding".to_owned(),
            String::new(),
            format!("{:.3}", padding.duration_s),
            format!("{:.3}", 0.0),
            format!("{:.1}", padding.energy.energy_j()),
            format!("{:.1}", 0.0),
            String::new(),
            "the original waits, so that both sides take the same time".to_owned(),
        ]);
    }
    let (before, after) = (&retrofit.original, &retrofit.optimized);
    rows.push(vec![
        "cycle".to_owned(),
        String::new(),
        String::new(),
        format!("{:.3}", before.cycle_s),
        format!("{:.3}", after.cycle_s),
        format!("{:.1}", before.energy_j),
        format!("{:.1}", after.energy_j),
        format!("{:.1}", before.energy_j - after.energy_j),
        String::new(),
    ]);
    let mut out = headline(model, retrofit);
    let _ = writeln!(out, "{}", whole_cycle::text(&retrofit.whole_cycle));
    for line in saving(retrofit).into_iter().chain(remarks(retrofit)) {
        let _ = writeln!(out, "{line}");
    }
    out.push('\n');
    out.push_str(&table(
        &[
            ("place", Align::Left),
            ("now", Align::Left),
            ("runs", Align::Right),
            ("s before", Align::Right),
            ("s after", Align::Right),
            ("J before", Align::Right),
            ("J after", Align::Right),
            ("saved J", Align::Right),
            ("why not", Align::Left),
        ],
        &rows,
    ));
    out
}

fn segment_row(places: Places<'_>, segment: &Segment) -> Vec<String> {
    let saved = segment.energy_before_j - segment.energy_after_j;
    let what = match (segment.kind, segment.rewritten) {
        (SegmentKind::Idle, _) => "dwell",
        (SegmentKind::Timing, true) if segment.points == 0 => "new speeds",
        (SegmentKind::Path, true) => "free stream",
        (SegmentKind::Timing, true) => "stream",
        (SegmentKind::Timing | SegmentKind::Path, false) => "as it was",
    };
    let runs = if segment.rewritten {
        format!("{}/{}", segment.rewritten_executions, segment.executions)
    } else {
        segment.executions.to_string()
    };
    let mut reason = segment.reason.as_ref().map(ToString::to_string).unwrap_or_default();
    if segment.potential_j > 0.0 {
        let _ = write!(reason, " ({:.1} J)", segment.potential_j);
    }
    vec![
        places.of_pieces(&segment.pieces),
        what.to_owned(),
        runs,
        format!("{:.3}", segment.time_before_s),
        format!("{:.3}", segment.time_after_s),
        format!("{:.1}", segment.energy_before_j),
        format!("{:.1}", segment.energy_after_j),
        if segment.rewritten { format!("{saved:.1}") } else { String::new() },
        reason,
    ]
}

/// The saving of a retrofit and the outcome of its verification.
fn headline(model: &Model, retrofit: &Retrofit) -> String {
    let (before, after) = (&retrofit.original, &retrofit.optimized);
    let worst = &retrofit.verification.worst;
    format!(
        "{}: motion energy {:.1} J -> {:.1} J (saves {:.1} %), energy with waits and base load \
         saves {:.1} %\nverified: {}; at most {:.0} % of joint speed, {:.0} % of acceleration, \
         {:.0} % of torque, {:.0} % of TCP speed; path within {:.2} mm, polygon \
         of the points within {:.2} mm, ends within {:.1e} rad\n",
        model.name,
        before.motion_energy_j,
        after.motion_energy_j,
        retrofit.motion_saving_percent(),
        retrofit.saving_percent(),
        match (retrofit.verification.passed, is_rewritten(retrofit)) {
            (false, _) => "FAILED",
            (true, true) => "passed",
            (true, false) => "nothing was changed",
        },
        100.0 * worst.velocity,
        100.0 * worst.acceleration,
        100.0 * worst.torque,
        100.0 * worst.tcp_speed,
        1e3 * worst.deviation_m,
        1e3 * worst.polygon_m,
        worst.endpoint_error_rad,
    )
}

/// Cost of the guards, lower limits, and possible savings by settings of the controller.
fn remarks(retrofit: &Retrofit) -> Vec<String> {
    let mut lines = Vec::new();
    if retrofit.guard_instructions > 0 {
        lines.push(format!(
            "guards run {} RAPID instructions in a cycle, about {:.1} ms (0.05 ms each, assumed)",
            retrofit.guard_instructions,
            retrofit.guards_ms()
        ));
    }
    if is_rewritten(retrofit) && !retrofit.lower_limits.is_empty() {
        let lower = |lower: &LowerLimits| {
            let percent = 100.0 * (1.0 - lower.share);
            format!(
                "{percent:.0} % lower: {:.2} s, original {:.2} s",
                lower.optimized_s, lower.original_s
            )
        };
        let cycles: Vec<String> = retrofit.lower_limits.iter().map(lower).collect();
        lines.push(format!(
            "cycle if the true limits are lower than assumed: {}",
            cycles.join("; ")
        ));
    }
    if retrofit.potential_j > 0.0 {
        lines.push(format!(
            "brakes in dwells could save {:.1} J more, by a setting of the controller",
            retrofit.potential_j
        ));
    }
    lines
}

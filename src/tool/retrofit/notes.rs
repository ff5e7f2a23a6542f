//! Notes for the user beyond the figures.

use std::fmt::Write;

use super::figures::{Figures, Segment, SegmentKind};
use super::files::file_and_line;
use super::job::Original;
use super::padding::Padding;
use super::settings::{Budget, Objective, Settings};
use super::simulated::Simulated;
use super::whole_cycle::WholeCycle;
use crate::arm::robot::Model;
use crate::retime::energy::account::at_rest;
use crate::retime::optimize::reason::Reason;

/// Smaller energy differences are rounding, J.
const ROUNDING_J: f64 = 1e-3;
/// Unused share of a takt that causes a note.
const UNUSED: f64 = 0.01;

/// All notes on a retrofit except those on estimated torques and the path.
pub(super) fn notes(
    program: &Original<'_>,
    model: &Model,
    settings: &Settings,
    segments: &[Segment],
    (original, optimized, padding): (&Figures, &Figures, Option<&Padding>),
    whole: &WholeCycle,
) -> Vec<String> {
    let mut notes: Vec<String> = unchanged(segments).into_iter().collect();
    notes.extend(padding.map(|padding| padded(original, padding, whole)));
    if settings.objective == Objective::Time {
        return notes;
    }
    if settings.budget == Budget::AsBefore {
        notes.extend(shared(segments));
        return notes;
    }
    if let Budget::Takt(takt) = settings.budget
        && takt - optimized.cycle_s > UNUSED * takt
        && whole.optimized.rest.state.is_none()
    {
        notes.push(format!(
            "the cycle takes {:.3} s of the takt of {takt} s: slower travel would save nothing \
             more, or is not possible, and the rest of the takt is waited for",
            optimized.cycle_s
        ));
    }
    let dearer: Vec<String> = segments
        .iter()
        .filter(|segment| segment.kind != SegmentKind::Idle && segment.rewritten)
        .filter(|segment| {
            let waited = segment.time_after_s - segment.time_before_s;
            let before = segment.energy_before_j + resting_j(model, &program.cycle, waited);
            segment.energy_after_j > before + ROUNDING_J
        })
        .map(|segment| file_and_line(program.files, segment.span))
        .collect();
    if dearer.is_empty() {
        return notes;
    }
    let mut note = format!(
        "in the time asked for, {} of the rewritten runs take more energy than before and than \
         waiting for the rest of their time ({}); the cycle takes {:.1} J instead of {:.1} J",
        dearer.len(),
        dearer.join(", "),
        optimized.energy_j,
        original.energy_j,
    );
    if let Budget::Takt(takt) = settings.budget
        && takt >= original.cycle_s
    {
        let _ = write!(
            note,
            "; with the rest of the takt, {:.1} J instead of {:.1} J",
            whole.optimized.energy_j(),
            whole.original.energy_j(),
        );
    }
    notes.push(note);
    notes
}

/// The note on the objective if torque limits are estimates.
pub(super) fn mean_energy(model: &Model) -> String {
    format!(
        "the torque limits of {} are estimated: streams minimise the mean energy over plausible robots \
         (--pareto shows that mean, too), and ask no more torque of any joint than the original cycle \
         does in 95 % of them",
        model.name
    )
}

/// The warning on streams that leave the programmed path without keep-out zones.
pub(super) fn off_path(settings: &Settings, farthest_m: f64) -> Option<String> {
    settings.freedom.keep_out.is_empty().then(|| {
        format!(
            "warning: streams leave the programmed path by up to {:.1} mm, and no keep-out is \
             configured: nothing tells what stands there; state the cell's boxes and planes as \
             keep_out in joulepath.toml, or leave out --free-path",
            1e3 * farthest_m
        )
    })
}

/// The note on the wait that is added to the original.
fn padded(original: &Figures, padding: &Padding, whole: &WholeCycle) -> String {
    let rests = [&whole.original.rest, &whole.optimized.rest];
    let spent = if rests.iter().any(|rest| rest.state.is_some()) {
        format!("of its rest of the takt, which takes {:.1} J more", padding.energy.energy_j())
    } else {
        format!(
            "in which the robot waits where its cycle ends ({:.1} J of base load, holding and open \
             brakes)",
            padding.energy.energy_j()
        )
    };
    format!(
        "the original is padded: by itself it takes {:.3} s, and it is counted with {:.3} s more \
         {spent}, so that both sides take {:.3} s",
        original.cycle_s - padding.duration_s,
        padding.duration_s,
        original.cycle_s,
    )
}

/// Time ratio below which a faster run causes a note.
const QUICK: f64 = 0.5;

/// The notes on single runs that lose by the distribution of the cycle time.
fn shared(segments: &[Segment]) -> Vec<String> {
    let rewritten = || segments.iter().filter(|s| s.kind != SegmentKind::Idle && s.rewritten);
    let dearer = rewritten().filter(|s| s.energy_after_j > s.energy_before_j + ROUNDING_J).count();
    let quick = rewritten().filter(|s| s.time_after_s < QUICK * s.time_before_s).count();
    let mut notes = Vec::new();
    if dearer > 0 {
        notes.push(format!(
            "{dearer} of the rewritten runs take more energy than before, base load included: the \
             time of the cycle is shared so that all together take less"
        ));
    }
    if quick > 0 {
        notes.push(format!(
            "{quick} of the rewritten runs take less than half of their time: the speed of a joint \
             movement is no limit for its stream; a line keeps its programmed speed"
        ));
    }
    notes
}

/// The note that no file changes.
fn unchanged(segments: &[Segment]) -> Option<String> {
    if segments.iter().any(|segment| segment.rewritten) {
        return None;
    }
    let timed = segments.iter().filter(|s| matches!(s.reason, Some(Reason::Timed))).count();
    let already = if timed > 0 {
        format!(": {timed} of its runs are streams or timed already")
    } else {
        String::new()
    };
    Some(format!("no movement was rewritten, every file stays as it was{already}"))
}

/// Energy of standing at the end of the cycle, J.
fn resting_j(model: &Model, cycle: &Simulated, duration: f64) -> f64 {
    cycle.end().map_or(0.0, |(load, q)| at_rest(model, load, q, duration.max(0.0)).energy_j())
}

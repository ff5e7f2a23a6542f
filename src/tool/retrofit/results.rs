//! Assembles the result of a retrofit.

use super::cycle_curve::cycle_curve;
use super::figures::{Figures, LowerLimits, Retrofit, SegmentKind};
use super::job::Job;
use super::notes;
use super::padding::padding;
use super::rewritten::Rewritten;
use super::segments::segments;
use super::settings::Form;
use super::signals::signals;
use super::simulated::Simulated;
use super::uncertainty::uncertainty;
use super::whole_cycle::{self, whole_cycle};
use crate::retime::optimize::idle::dwells;

/// The result of a job. `leaves_path`: whether streams leave the programmed path.
pub(super) fn results(job: Job<'_>, rewritten: Rewritten, leaves_path: bool) -> Retrofit {
    let mut whole =
        whole_cycle(job.model, &job.settings, &job.original.cycle, &rewritten.simulated);
    if job.settings.pareto > 0 && job.settings.form == Form::Streams && !leaves_path {
        let Rewritten { candidates, simulated, .. } = &rewritten;
        let takt = whole.optimized.time_s;
        whole.curve = cycle_curve(&job, candidates, simulated, takt, job.settings.pareto);
    }
    let Job { original, model, settings, robots, mean } = job;
    let Rewritten { candidates, waits, respeeded, outputs, simulated, .. } = rewritten;
    let dwells = dwells(model, &original.cycle.simulation);
    let mut segments = segments(&original, &simulated, &candidates, &dwells, &waits);
    for segment in &mut segments {
        if mean.is_some() {
            // The bounds refer to the mean robot, the energies to the model.
            segment.lower_bound_j = None;
        }
        if segment.kind == SegmentKind::Timing && respeeded.contains(&segment.span) {
            segment.rewritten = true;
            segment.rewritten_executions = segment.executions;
            segment.reason = None;
        }
    }
    let optimized = figures(&simulated);
    let padding = padding(model, &original.cycle, optimized.cycle_s, &whole);
    let uncertainty = robots
        .map(|robots| uncertainty(model, &robots, (&original.cycle, padding.as_ref()), &simulated));
    let before = figures(&original.cycle).padded(padding.as_ref());
    let mut lower_limits = rewritten.lower_limits;
    let mut notes = notes::notes(
        &original,
        model,
        &settings,
        &segments,
        (&before, &optimized, padding.as_ref()),
        &whole,
    );
    if settings.form != Form::Speeds {
        // The padded original is at least as long as the retrofit.
        if padding.is_some() {
            for LowerLimits { original_s, .. } in &mut lower_limits {
                *original_s = original_s.max(before.cycle_s);
            }
        }
        notes.extend(mean.is_some().then(|| notes::mean_energy(model)));
        if leaves_path {
            notes.extend(notes::off_path(&settings, rewritten.verification.worst.deviation_m));
        }
    }
    notes.extend(whole_cycle::notes(model, &settings, &whole, &original.cycle));
    Retrofit {
        original: before,
        whole_cycle: whole,
        padding,
        optimized,
        potential_j: dwells.iter().map(|dwell| dwell.potential_j).fold(0.0, |a, b| a + b),
        segments,
        notes,
        lower_limits,
        uncertainty,
        spacings: Vec::new(),
        verification: rewritten.verification,
        signals: signals(&original.cycle.simulation, &simulated.simulation),
        guard_instructions: outputs.guards.iter().map(|guard| guard.instructions).sum(),
        outputs: outputs.files,
        before: (original.cycle.simulation, original.cycle.account),
        after: (simulated.simulation, simulated.account),
    }
}

fn figures(cycle: &Simulated) -> Figures {
    Figures {
        cycle_s: cycle.simulation.cycle_s,
        energy_j: cycle.account.total.energy_j(),
        motion_energy_j: cycle.account.total.motion_energy_j(),
    }
}

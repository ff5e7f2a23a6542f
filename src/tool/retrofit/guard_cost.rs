//! The cost of guards: dozens of RAPID instructions at the stop point before a stream.

use super::candidate::{Candidate, State, with_stream};
use super::figures::INSTRUCTION_MS;
use super::job::Job;
use super::outputs::Guarded;
use super::settings::{Budget, Objective};
use crate::retime::energy::power::holding_w;
use crate::retime::optimize::reason::Reason;

/// Maximum share of the cycle for all guards.
const MAX_SHARE: f64 = 0.005;

/// Refuses the candidates of sites whose guards cost more than their streams save; if all guards
/// together take too long, also those that save least per guard time. `guards`: those of
/// the emitted program.
pub(super) fn costly(
    job: &Job<'_>,
    candidates: &[Candidate],
    guards: &[Guarded],
) -> Vec<(usize, State)> {
    let Job { original, model, settings, .. } = job;
    // Site, time of its guards in a cycle (s), saving per guard time (J/s, or s/s).
    let mut worth: Vec<(usize, f64, f64)> = Vec::new();
    let mut costly = Vec::new();
    for index in 0..original.sites.len() {
        let count: f64 = guards.iter().map(|guard| guard.instructions_of(index)).sum();
        if count == 0.0 || !with_stream(candidates).any(|(_, own)| own.site == index) {
            continue;
        }
        let time = 1e-3 * INSTRUCTION_MS * count;
        let gains = candidates.iter().filter(|c| c.site == index).filter_map(|candidate| {
            let retiming = candidate.retiming()?;
            let run = original.run(candidate)?;
            let coils = model.brakes.as_ref().map_or(0.0, |brakes| brakes.power_released_w);
            let holding: f64 = holding_w(model, &run.load, &run.start).iter().sum();
            let standing = model.drive.base_w + coils + holding;
            let saved_s = run.duration() - retiming.duration_s;
            // A slower stream uses time of a wait, which would have cost standing power.
            let saved_j =
                retiming.energy_before_j - retiming.energy.energy_j() - standing * saved_s;
            let executions = original.events(candidate).len() as f64;
            Some((executions * saved_j, executions * saved_s, standing))
        });
        let (saved_j, saved_s, standing) = gains
            .fold((0.0, 0.0, 0.0_f64), |(j, s, w), gain| (j + gain.0, s + gain.1, w.max(gain.2)));
        let (saved, cost) = match settings.objective {
            Objective::Energy => (saved_j, standing * time),
            Objective::Time => (saved_s, time),
        };
        // With a takt or factor, runs may take more energy so that others save it.
        let must_pay = settings.budget == Budget::AsBefore || settings.objective == Objective::Time;
        if must_pay && saved < cost {
            let unit = if settings.objective == Objective::Energy { "J" } else { "s" };
            let why = format!(
                "its guards take {cost:.2} {unit} in a cycle ({:.1} ms), its streams save {saved:.2} {unit}",
                1e3 * time
            );
            costly.push((index, why));
        } else {
            worth.push((index, time, saved / time));
        }
    }
    if costly.is_empty() {
        worth.sort_by(|a, b| b.2.total_cmp(&a.2));
        let mut all = 0.0;
        for (site, time, _) in worth {
            all += time;
            if all > MAX_SHARE * original.cycle.simulation.cycle_s {
                all -= time;
                let why = format!(
                    "its guards take {:.1} ms in a cycle, and all guards may take {:.1} % of it",
                    1e3 * time,
                    100.0 * MAX_SHARE
                );
                costly.push((site, why));
            }
        }
    }
    with_stream(candidates)
        .filter_map(|(index, candidate)| {
            let (_, why) = costly.iter().find(|(site, _)| *site == candidate.site)?;
            Some((index, State::Refused(Reason::NoStream(why.clone()))))
        })
        .collect()
}

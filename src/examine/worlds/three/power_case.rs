//! Cases of the power channel.

use super::drive::{Run, World, logged};
use super::logfile::{Recorder, csv};
use super::motion::{STEP, Style, Track, track};
use super::power::{EFFECTS, PowerFault, Supply, powers};
use super::spatial::Point;
use super::torque_case::Setting;
use super::truth::heldout;
use crate::examine::worlds::api::{Case, Kind, Truth, nats};
use crate::examine::worlds::model::Row;
use crate::examine::worlds::random::Rng;

/// Rows by log in the evidence.
const ROWS: usize = 200;

/// States of all periods of a run.
fn points(run: &Run) -> Vec<Point> {
    let mut out = Vec::new();
    for cycle in 0..run.cycles {
        let track = match &run.entry {
            Some(entry) if cycle == 0 => entry,
            _ => &run.track,
        };
        out.extend_from_slice(&track.points);
    }
    out
}

/// A recording with its torques and states.
struct Taken<'a> {
    run: &'a Run,
    points: Vec<Point>,
    torques: Vec<Row>,
}

impl<'a> Taken<'a> {
    fn new(world: &World, run: &'a Run) -> Self {
        Self { run, points: points(run), torques: logged(world, run, &[]) }
    }

    fn powers(&self, world: &World, supply: &Supply, fault: Option<&PowerFault>) -> Vec<f64> {
        powers(world, supply, &self.run.day, &self.points, &self.torques, fault)
    }
}

/// A motion with a wait at its end, long enough that brakes close.
fn waiting(world: &World, period: f64, rng: &mut Rng) -> Track {
    let steps = (period / STEP).round() as usize;
    let wait = ((0.35 * period).clamp(3.0, 8.0) / STEP).round() as usize;
    let busy = steps.saturating_sub(wait).max(1000);
    let mut moved = track(Style::Moves, &world.nominal, busy as f64 * STEP, rng);
    let rest = moved
        .points
        .first()
        .map_or_else(Point::default, |point| Point { q: point.q, ..Point::default() });
    moved.points.resize(steps, rest);
    moved
}

/// Rms of the difference over the mean of the power.
fn share(with: &[f64], without: &[f64]) -> f64 {
    let count = without.len().max(1) as f64;
    let mean = without.iter().sum::<f64>() / count;
    let square = with.iter().zip(without).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / count;
    square.sqrt() / mean.abs().max(1.0)
}

/// Share of the power that a fault changes in a log.
fn lost_braking(world: &World, supply: &Supply, taken: &Taken, fault: &PowerFault) -> f64 {
    share(&taken.powers(world, supply, Some(fault)), &taken.powers(world, supply, None))
}

/// The fault at its size.
fn sized(
    setting: &Setting,
    supply: &Supply,
    taken: &Taken,
    drawn: &PowerFault,
    rng: &mut Rng,
) -> PowerFault {
    let world = &setting.world;
    let clean = taken.powers(world, supply, None);
    // From barely visible to strong: 1.5 to 30 % of the mean power.
    let target = rng.log_between(0.015, 0.3);
    let seen = share(&taken.powers(world, supply, Some(drawn)), &clean);
    drawn.scaled((target / seen.max(1e-6)).clamp(0.02, 50.0))
}

/// Expected evidence \[nats\].
fn evidence(
    setting: &Setting,
    supply: &Supply,
    logs: &[Taken],
    before: &[Taken],
    fault: &PowerFault,
) -> f64 {
    let world = &setting.world;
    let arm = &world.nominal;
    let mut delta = Vec::new();
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); arm.axes() + 2];
    let mut sd = 1.0;
    for (taken, acts) in
        logs.iter().map(|taken| (taken, true)).chain(before.iter().map(|taken| (taken, false)))
    {
        let clean = taken.powers(world, supply, None);
        let faulty = if acts { taken.powers(world, supply, Some(fault)) } else { clean.clone() };
        let count = taken.run.track.points.len();
        sd = supply.sd(&clean, taken.run.cycles);
        for row in 0..ROWS {
            let phase = row * count / ROWS;
            let mut mean = 0.0;
            for cycle in 0..taken.run.cycles {
                let at = cycle * count + phase;
                if let (Some(a), Some(b)) = (faulty.get(at), clean.get(at)) {
                    mean += (a - b) / taken.run.cycles as f64;
                }
            }
            delta.push(mean);
            let (Some(at), Some(torque)) = (taken.points.get(phase), taken.torques.get(phase))
            else {
                continue;
            };
            let mut back = 0.0;
            for i in 0..arm.axes() {
                // A spread of 10 % of each copper loss.
                columns[i].push(0.1 * arm.loss[i] * torque[i] * torque[i]);
                back += (torque[i] * at.v[i]).min(0.0);
            }
            columns[arm.axes()].push(0.05 * arm.base);
            columns[arm.axes() + 1].push(0.05 * back);
        }
    }
    let columns: Vec<Vec<Vec<f64>>> = columns.into_iter().map(|column| vec![column]).collect();
    nats(&[delta], &[sd], &columns)
}

/// Whether the brakes close in any log: otherwise their power is base power.
fn brakes_close(logs: &[Taken]) -> bool {
    logs.iter().any(|taken| {
        let mut stands = 0.0;
        taken.points.iter().any(|at| {
            stands = if at.v.iter().any(|rate| rate.abs() > 1e-4) { 0.0 } else { stands + STEP };
            stands > 2.5
        })
    })
}

pub(super) fn case(seed: u64, number: usize) -> Case {
    let mut rng = Rng::stream(seed, number, "power");
    let mut setting = Setting::new(seed, number, true, true);
    let mut id = rng.pick(&EFFECTS);
    if id == "no_regeneration" && setting.world.nominal.regeneration == 0.0 {
        id = "copper_loss";
    }
    if rng.chance(0.3) || (id == "brake_power" && rng.chance(0.7)) {
        let (world, period) = (&setting.world, setting.schedule.period);
        let all =
            setting.runs.iter_mut().chain(&mut setting.baselines).chain([&mut setting.heldout]);
        for run in all {
            run.track = waiting(world, period, &mut rng);
            run.entry = None;
        }
    }
    let supply = Supply::new(&setting.world, setting.spread.friction.min(0.1), &mut rng);
    let logs: Vec<Taken> = setting.runs.iter().map(|run| Taken::new(&setting.world, run)).collect();
    let before: Vec<Taken> =
        setting.baselines.iter().map(|run| Taken::new(&setting.world, run)).collect();
    let held = Taken::new(&setting.world, &setting.heldout);
    let mut drawn = PowerFault::draw(id, &setting.world, &mut rng);
    if drawn.id == "no_regeneration"
        && logs.iter().all(|log| lost_braking(&setting.world, &supply, log, &drawn) < 0.01)
    {
        // Slow motions brake little: nobody could see the loss.
        drawn = PowerFault::draw("copper_loss", &setting.world, &mut rng);
    }
    let fault = logs
        .first()
        .map_or_else(|| drawn.clone(), |first| sized(&setting, &supply, first, &drawn, &mut rng));
    let nats = evidence(&setting, &supply, &logs, &before, &fault);
    let mut truth = Truth { nats, ..fault.truth() };
    match (fault.id, brakes_close(&logs)) {
        ("brake_power", false) => truth.equivalents.push("base_load".into()),
        ("base_load", false) => truth.equivalents.push("brake_power".into()),
        _ => {}
    }
    let logger = Recorder::new(setting.schedule.rate, false, &mut rng);
    let mut files = vec![setting.world.nominal.sheet().file(false)];
    let mut add = |name: String, taken: &Taken, fault: Option<&PowerFault>| {
        let mut rng = Rng::stream(seed, number, &name);
        let clean = taken.powers(&setting.world, &supply, fault);
        let shown = supply.shown(&clean, &mut rng);
        let text = csv(&setting.world, taken.run, &taken.torques, &shown, &logger, &mut rng);
        files.push((name, text));
    };
    for (k, taken) in logs.iter().enumerate() {
        add(format!("log-{}.csv", k + 1), taken, Some(&fault));
    }
    add("heldout.csv".to_owned(), &held, Some(&fault));
    for (k, taken) in before.iter().enumerate() {
        add(format!("baseline-{}.csv", k + 1), taken, None);
    }
    let heldout = heldout(&setting.world, &setting.heldout, &[]);
    Case { effects: vec![truth], heldout, ..Case::new(files, setting.options(), Kind::Power) }
}

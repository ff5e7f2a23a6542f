//! What the loop in the cell promises, and what simulated plants show, which share no code with it:
//! `cargo run --release --example plants -- 25`. `docs/cell.md` contains the tables.

#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/cells.rs"]
mod cells;
#[path = "../tests/plants/program.rs"]
mod program;
#[path = "../tests/plants/stations.rs"]
mod stations;
#[path = "../tests/support/mod.rs"]
mod support;

use std::collections::BTreeMap;
use std::path::Path;

use cells::{Cell, cells};
use joulepath::arm::robot::Model;
use joulepath::examine::plant::{
    Campaign, Conditions, CycleTruth, Disturbance, Kind, Plant, Run, Script, Step, Trouble,
    campaign,
};
use joulepath::learn::log::{ColumnMap, scan};
use joulepath::retime::motion::timeline::What;
use joulepath::retime::motion::{Options, simulate};
use joulepath::tool::cell::events;
use joulepath::tool::cell::prove::{
    EventLog, PowerLog, Proof, Settings as Asked, Side, Verdict, prove, stamp,
};
use joulepath::tool::cell::slack::{Planned, plan};
use joulepath::tool::cell::waits::file::WaitsFile;
use joulepath::tool::cell::waits::{Log, find, record};
use joulepath::tool::report::slack::outcome;
use joulepath::tool::retrofit::{Retrofit, Settings, Source, read_program, retrofit};
use program::{retimed, script, standing};
use rayon::prelude::*;
use support::irb1600;

/// Seed of the first plant; the tests use those below, and the development saw 70,000 to 70,199.
const FIRST: u64 = 90_000;
/// Recorded cycles of a shift.
const CYCLES: usize = 200;
/// The stated risk, and what counts as longer, s.
const RISK: f64 = 0.05;
const LONGER_S: f64 = 0.01;
/// What makes the robot wait at one of the waits of each plant; the other waits are drawn.
const SLACK: [Kind; 4] = [Kind::Machine, Kind::Operator, Kind::Takt, Kind::Queue];
/// Plants that are drawn for each one in which slack may be used up.
const PLANTS_PER_USE: u64 = 4;
/// A cycle that lasts so many times the median has a break.
const BREAK: f64 = 1.5;
/// Cycles on each side of a campaign.
const SIDE: usize = 60;

fn main() {
    let count = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(50);
    slack(count);
    proofs(4 * count);
}

/// The programs of `fixtures/cells`, and the example of the README, as far as they wait for a signal.
fn waiting_cells() -> Vec<Cell> {
    let example = support::modules("pick_place");
    let own = Cell { name: "pick_place".to_owned(), files: example, levels: BTreeMap::new() };
    cells().into_iter().chain([own]).filter(waits).collect()
}

/// Whether the cycle waits for a signal.
fn waits(cell: &Cell) -> bool {
    let (program, entry) = read_program(&cell.files, "main").unwrap();
    let simulation = simulate(&program, entry, &irb1600(), &cell.options());
    simulation.events.iter().skip(simulation.repeats_from.unwrap_or(0)).any(|event| {
        matches!(&event.what, What::Wait(of) if of.wait.signal.is_some() && of.wait.duration.is_none())
    })
}

/// Another robot of the same type: friction within 15 %, base power within 10 %.
fn another(model: &Model, seed: u64) -> Model {
    let mut draws = fastrand::Rng::with_seed(seed);
    let mut robot = model.clone();
    let friction = robot.friction.coulomb.iter_mut().chain(&mut robot.friction.viscous);
    friction.for_each(|value| *value *= 0.85 + 0.3 * draws.f64());
    robot.drive.base_w *= 0.9 + 0.2 * draws.f64();
    robot
}

/// What was promised and what came of it.
struct Used {
    /// Share of the cycles that got longer: of the recorded ones, and of those of another day.
    longer: [f64; 2],
    /// J for each cycle: promised with its interval, realised on the recorded days, on another day.
    promised: [f64; 3],
    realised: [f64; 2],
}

fn slack(count: u64) {
    let cells = waiting_cells();
    let model = irb1600();
    let all = PLANTS_PER_USE * count;
    let drawn = (0..all).into_par_iter().map(|at| {
        let cell = &cells[at as usize % cells.len()];
        used(cell, &model, FIRST + at)
    });
    let used: Vec<Used> = drawn.collect::<Vec<_>>().into_iter().flatten().collect();
    let n = used.len();
    println!(
        "slack: {all} plants with a wait for a signal, {n} of them with slack that is used up"
    );
    let share = |is: &dyn Fn(&Used) -> bool| used.iter().filter(|of| is(of)).count();
    for (day, name) in ["the recorded cycles", "other days"].into_iter().enumerate() {
        println!("{name}:");
        let within = share(&|of| of.longer[day] <= RISK);
        println!("  share of longer cycles at most {RISK}: {within} of {n} plants");
        let mut ratios: Vec<f64> =
            used.iter().map(|of| of.realised[day] / of.promised[0]).collect();
        ratios.sort_by(f64::total_cmp);
        let at = |share: f64| ratios[(share * (n - 1) as f64).round() as usize];
        println!(
            "  realised / promised: {:.3} (quartiles {:.3}, {:.3})",
            at(0.5),
            at(0.25),
            at(0.75)
        );
        let holds = share(&|of| {
            let [_, low, high] = of.promised;
            (low..=high).contains(&of.realised[day])
        });
        println!("  interval holds: {holds} of {n}");
    }
}

/// `None` if no slack is used up.
fn used(cell: &Cell, model: &Model, seed: u64) -> Option<Used> {
    let options = cell.options();
    let (program, entry) = read_program(&cell.files, "main").unwrap();
    let simulation = simulate(&program, entry, model, &options);
    let robot = another(model, seed);
    let power = standing(&robot, &simulation);
    let old = script(&robot, &cell.files, &simulation, power);
    let steps = old.variants[0].steps.iter();
    let waits = steps.filter_map(|step| match step {
        Step::Wait { signal, .. } => Some(signal.as_str()),
        _ => None,
    });
    let waits: Vec<&str> = waits.collect();
    let one = waits[seed as usize / SLACK.len() % waits.len()];
    let kind = SLACK[seed as usize % SLACK.len()];
    let mut plant = Plant::draw_with(seed, &old, &[(one, kind)]);
    plant.power = power;
    let recorded = plant.run(&old, CYCLES, seed);
    let (planned, result) = retrofitted(cell, model, &recorded, &options)?;
    let files = emitted(&result);
    let (after, entry) = read_program(&files, "main").unwrap();
    let arrivals = Options { arrivals: planned.arrivals.clone(), ..options };
    let after = simulate(&after, entry, &robot, &arrivals);
    let new = retimed(&old, &script(&robot, &files, &after, power))?;
    let other = plant.run(&old, CYCLES, seed + 1);
    let changed = [plant.run(&new, CYCLES, seed), plant.run(&new, CYCLES, seed + 1)];
    let days = [(&recorded, &changed[0]), (&other, &changed[1])];
    let outcome = outcome(model, &planned, &result);
    let [low, high] = outcome.interval_j?;
    Some(Used {
        longer: days.map(|(before, after)| longer(before, after)),
        promised: [outcome.saving_j, low, high],
        realised: days.map(|(before, after)| {
            (before.energy_j() - after.energy_j()) / before.cycles.len() as f64
        }),
    })
}

/// Waits of a recorded shift, and the program that uses up their slack.
fn retrofitted(
    cell: &Cell,
    model: &Model,
    recorded: &Run,
    options: &Options,
) -> Option<(Planned, Retrofit)> {
    let recording = events::read(recorded.events.as_bytes()).unwrap();
    let log = Log { name: "shift".to_owned(), recording };
    let found = find(&[log], None).ok()?;
    let waits = WaitsFile { program: None, ..record(&found) };
    let (program, entry) = read_program(&cell.files, "main").unwrap();
    let simulated = |options: &Options| simulate(&program, entry, model, options);
    let planned = plan(&waits, (&cell.files, ""), RISK, options, &simulated).ok()?;
    if planned.uses.is_empty() {
        return None;
    }
    let options = Options { arrivals: planned.arrivals.clone(), ..options.clone() };
    let settings = Settings { options, ..Settings::default() };
    let result = retrofit(&cell.files, model, &settings, &|_, _| ()).unwrap();
    assert!(result.verification.passed, "{}", cell.name);
    Some((planned, result))
}

/// The emitted program.
fn emitted(result: &Retrofit) -> Vec<Source> {
    let is_module =
        |path: &str| Path::new(path).extension().is_some_and(|end| end == "mod" || end == "sys");
    let files = result.outputs.iter().filter(|file| is_module(&file.path));
    let file = |(index, file): (usize, &joulepath::tool::retrofit::OutputFile)| {
        let id = joulepath::rapid::text::FileId(index as u32);
        joulepath::rapid::text::SourceFile::new(id, file.path.clone(), file.bytes.clone())
    };
    support::sources(files.enumerate().map(file).collect())
}

/// Share of the cycles that got longer.
fn longer(before: &Run, after: &Run) -> f64 {
    let pairs = before.cycles.iter().zip(&after.cycles);
    let is_longer = |(a, b): &(&CycleTruth, &CycleTruth)| b.duration_s > a.duration_s + LONGER_S;
    pairs.clone().filter(is_longer).count() as f64 / pairs.count() as f64
}

fn proofs(count: u64) {
    let kinds: [(&str, f64, &[Trouble]); 10] = [
        ("other days", 0.0, &[Trouble::OtherDays]),
        ("other days", 0.05, &[Trouble::OtherDays]),
        ("other days, machines 20 % slower", 0.0, &[Trouble::OtherDays, Trouble::Machines(1.2)]),
        ("other days, machines 20 % slower", 0.05, &[Trouble::OtherDays, Trouble::Machines(1.2)]),
        ("other days, hall at 29 °C", 0.0, &[Trouble::OtherDays, Trouble::Ambient(29.0)]),
        ("other days, hall at 29 °C", 0.05, &[Trouble::OtherDays, Trouble::Ambient(29.0)]),
        ("meter 3 % off after", 0.0, &[Trouble::OtherDays, Trouble::Gain(0.97)]),
        ("meter drifts by 2 % an hour", 0.0, &[Trouble::OtherDays, Trouble::Drift(-0.02)]),
        ("a fifth swapped", 0.05, &[Trouble::OtherDays, Trouble::Swapped(0.2)]),
        ("kW after", 0.05, &[Trouble::OtherDays, Trouble::Kilowatts]),
    ];
    println!("| campaigns | saved | says `saves` | interval holds | refused |");
    println!("|---|---|---|---|---|");
    for (name, saving, troubles) in kinds {
        let results: Vec<Option<(f64, Proof)>> =
            (0..count).into_par_iter().map(|at| proved(FIRST + at, saving, troubles)).collect();
        let proved: Vec<&(f64, Proof)> = results.iter().flatten().collect();
        let share = |n: usize| 100.0 * n as f64 / proved.len().max(1) as f64;
        let saves = proved.iter().filter(|(_, proof)| proof.verdict == Verdict::Saves).count();
        let holds = proved.iter().filter(|(truth, proof)| {
            proof.saving.interval.is_none_or(|[low, high]| (low..=high).contains(truth))
        });
        println!(
            "| {name} | {:.0} % | {:.1} % | {:.1} % | {} of {count} |",
            100.0 * saving,
            share(saves),
            share(holds.count()),
            results.len() - proved.len()
        );
    }
}

/// The true saving and the proof of a campaign; `None` if `prove` refuses its logs.
fn proved(seed: u64, saving: f64, troubles: &[Trouble]) -> Option<(f64, Proof)> {
    let old = stations::script(seed);
    let plant = Plant::draw(seed, &old);
    let usual = Conditions::usual(SIDE, seed);
    let [energy, motion] = ordinary(&plant.run_in(&old, &usual));
    let new: Script = old.with_motion_energy(1.0 - saving * energy / motion);
    let Campaign { before, after, .. } = campaign(&plant, (&old, &new), &usual, troubles);
    let settings = Asked { effect: 0.03, promised: None };
    Some((saving, prove(&side("before", &before), &side("after", &after), settings).ok()?))
}

/// Energy and motion energy of the cycles without stops and breaks, J.
fn ordinary(run: &Run) -> [f64; 2] {
    let mut durations: Vec<f64> = run.cycles.iter().map(|cycle| cycle.duration_s).collect();
    durations.sort_by(f64::total_cmp);
    let longest = BREAK * durations[durations.len() / 2];
    let cycles = run
        .cycles
        .iter()
        .filter(|cycle| cycle.disturbance == Disturbance::None && cycle.duration_s < longest);
    cycles.fold([0.0, 0.0], |[energy, motion], cycle| {
        [energy + cycle.energy_j, motion + cycle.motion_j]
    })
}

fn side(name: &str, run: &Run) -> Side {
    let bytes = run.power.as_bytes();
    let map = ColumnMap::parse("").unwrap().with_products();
    let log = joulepath::learn::log::read(bytes, &map).unwrap();
    let (scan, stamp) = (scan(bytes, &map), stamp(bytes));
    let log = PowerLog { shown: format!("{name}.csv"), log, scan, stamp };
    let recording = events::read(run.events.as_bytes()).unwrap();
    let events = EventLog { shown: format!("{name}-events.csv"), recording };
    Side { logs: vec![log], events: vec![events] }
}

//! The alternative to streams: movements stay as they are, and only their programmed speeds change.
//!
//! Runs stand still between each other, so that the virtual controller can try a speed for all of
//! them at once. What it finds is each run's energy over time; the time of the cycle is then shared
//! as for streams, and the speeds are searched that take these times. A programmed speed of a line
//! or arc is never exceeded, zones and targets stay. What is a datum is written as a share of that
//! datum: who lowers it lowers the speed.

use std::collections::{BTreeMap, BTreeSet};

use super::demand::mean_robot;
use super::figures::{OutputFile, OutputKind, Retrofit, SegmentKind, Verification};
use super::goals::cycle;
use super::lower_limits::{self, Lowered};
use super::outputs::{read_again, unchanged};
use super::settings::{Budget, Objective, Settings};
use super::speed_arguments::{Argument, speed_arguments};
use super::uncertainty::{self, ENOUGH, Side};
use super::verify::same_order;
use super::work::{
    RetrofitError, Source, TIME_TOLERANCE, Way, figures, nothing_to_verify, read_program,
};
use super::{notes, padding, segments, signals};
use crate::arm::dynamics::Data;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::Speed;
use crate::rapid::ir::number::number;
use crate::rapid::ir::program::Program;
use crate::rapid::syntax;
use crate::rapid::text::{self, Edit, Span};
use crate::retime::energy::plausible::Robots;
use crate::retime::energy::power::power;
use crate::retime::energy::{Account, account};
use crate::retime::motion::timeline::{Run, What};
use crate::retime::motion::{Simulation, simulate};
use crate::retime::optimize::check::Check;
use crate::retime::optimize::cycle::{Part, TradeOff};
use crate::retime::optimize::freedom::{Bound, Freedom};
use crate::retime::optimize::idle::dwells;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::{Site, not_reached};
use crate::retime::path::joint_path::DOF;

/// Factors on the programmed speeds that are tried for every run.
const FACTORS: [f64; 18] =
    [0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.15, 1.4, 1.8, 2.5, 4.0];
/// Halvings of the range in which a factor is searched.
const HALVINGS: usize = 6;
/// A factor this close to 1 is none.
const UNCHANGED: f64 = 2e-3;
/// The largest programmed speed that a controller takes, m/s.
const FASTEST: f64 = 7.0;
/// Decimals of a speed in mm/s and degrees/s.
const DECIMALS: usize = 1;
/// Decimals of a share of a speed.
const SHARE_DECIMALS: usize = 4;
/// Smallest saving that is worth a change, share of all energy: what is searched on a grid of
/// factors ends elsewhere by about so much when it is searched again.
const WORTHWHILE: f64 = 1e-3;
/// Step of the samples of the verified motions, s.
const STEP: f64 = 0.002;

/// The program before.
pub(super) struct Before<'a> {
    pub(super) files: &'a [Source],
    pub(super) program: &'a Program,
    pub(super) simulation: Simulation,
    /// Under lower limits.
    pub(super) lowered: Vec<Lowered>,
    pub(super) account: Account,
    pub(super) sites: &'a [Site],
}

/// A site whose speeds may change.
struct Slot {
    site: usize,
    speeds: Vec<Programmed>,
}

/// A speed as programmed.
struct Programmed {
    argument: Argument,
    speed: Speed,
    /// Whether it may be exceeded.
    ceiling: bool,
}

/// A program with other speeds as it runs.
struct Tried {
    outputs: Vec<OutputFile>,
    simulation: Simulation,
    account: Account,
}

/// Retrofits a program by its speeds.
pub(super) fn retrofit(
    before: Before<'_>,
    model: &Model,
    settings: &Settings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Retrofit, RetrofitError> {
    let sites = before.sites;
    let mut ways = ways(sites);
    let slots = slots(&before, settings, &mut ways);
    let rounds = FACTORS.len() + HALVINGS + 1;
    let robots = if settings.point_estimate { None } else { Robots::new(model) };
    let mean = mean_robot(model, robots.as_ref(), &before.simulation);
    let aim = mean.as_ref().unwrap_or(model);
    let found = search(&before, aim, settings, &slots, &ways, &|done| progress(done, rounds));
    let original = figures(&before.simulation, &before.account);
    let mut kept = None;
    if let Some((factors, tried)) = found {
        let tried = Tried { account: account(model, &tried.simulation), ..tried };
        let verification = verify(&before, model, settings, &slots, &factors, &tried);
        match reason_to_stay(&before, model, settings, robots.as_ref(), (&tried, &verification)) {
            None => kept = Some((factors, tried, verification)),
            // It is their reason so far.
            Some(Reason::NoSaving) => {}
            Some(reason) => {
                for way in ways.iter_mut().filter(|way| slots.iter().any(|s| s.site == way.site)) {
                    way.outcome = Err(reason.clone());
                }
            }
        }
    }
    let changed: BTreeSet<Span> = kept
        .iter()
        .flat_map(|(factors, ..)| slots.iter().zip(factors))
        .filter(|(slot, factor)| is_changed(slot, **factor))
        .map(|(slot, _)| sites[slot.site].span)
        .collect();
    let (tried, verification) = match kept {
        Some((_, tried, verification)) => (tried, verification),
        None => (as_it_was(&before, model, settings)?, nothing_to_verify()),
    };
    let dwells_before = dwells(model, &before.simulation);
    let mut segments = segments::segments(
        (&before.simulation, &before.account),
        (&tried.simulation, &tried.account),
        sites,
        &ways,
        (&dwells_before, &[]),
        &not_reached(before.program, &before.simulation),
    );
    for segment in &mut segments {
        if segment.kind == SegmentKind::Timing && changed.contains(&segment.span) {
            segment.rewritten = true;
            segment.rewritten_executions = segment.executions;
            segment.reason = None;
        }
    }
    let optimized = figures(&tried.simulation, &tried.account);
    let padding = padding::padding(model, &before.simulation, &optimized);
    let original = original.padded(padding.as_ref());
    let compared = (&original, &optimized, padding.as_ref());
    let notes =
        notes::notes(before.files, model, settings, &before.simulation, &segments, compared);
    let (lower_limits, _) = lower_limits::compare(
        &before.lowered,
        (&before.simulation, &tried.simulation),
        &tried.outputs,
        settings,
        (&[], &[]),
        false,
    );
    let uncertainty = robots.map(|robots| {
        let own = Side { simulation: &before.simulation, account: &before.account };
        let after = Side { simulation: &tried.simulation, account: &tried.account };
        uncertainty::uncertainty(model, &robots, (own, padding.as_ref()), after)
    });
    Ok(Retrofit {
        lower_limits,
        uncertainty,
        guard_instructions: 0,
        original,
        padding,
        optimized,
        potential_j: dwells_before.iter().map(|dwell| dwell.potential_j).fold(0.0, |a, b| a + b),
        segments,
        notes,
        verification,
        signals: signals::signals(&before.simulation, &tried.simulation),
        outputs: tried.outputs,
        before: (before.simulation, before.account),
        after: (tried.simulation, tried.account),
    })
}

/// Why other speeds are not kept, all together.
fn reason_to_stay(
    before: &Before<'_>,
    model: &Model,
    settings: &Settings,
    robots: Option<&Robots>,
    (tried, verification): (&Tried, &Verification),
) -> Option<Reason> {
    if !verification.passed {
        let broken = verification.checks.iter().find(|(_, held)| !held);
        let why = broken.map_or("", |(what, _)| what);
        return Some(Reason::Verification(format!("did not hold: {why}")));
    }
    if settings.objective == Objective::Time || settings.budget != Budget::AsBefore {
        return None;
    }
    let original_j = before.account.total.energy_j();
    if tried.account.total.energy_j() + WORTHWHILE * original_j >= original_j {
        return Some(Reason::NoSaving);
    }
    let own = Side { simulation: &before.simulation, account: &before.account };
    let after = Side { simulation: &tried.simulation, account: &tried.account };
    let share = uncertainty::share_that_saves(model, robots?, own, after);
    (share < ENOUGH).then_some(Reason::UncertainSaving(share))
}

/// Every way with its reason to stay; without one no speed that saves is found yet.
fn ways(sites: &[Site]) -> Vec<Way> {
    let variants = |(site, s): (usize, &Site)| {
        let reasons: Vec<Option<Reason>> =
            s.variants.iter().map(|v| s.reason.clone().or_else(|| v.reason.clone())).collect();
        let way = move |(variant, reason): (usize, Option<Reason>)| {
            Way::new(site, variant, Err(reason.unwrap_or(Reason::NoSaving)))
        };
        reasons.into_iter().enumerate().map(way).collect::<Vec<Way>>()
    };
    sites.iter().enumerate().flat_map(variants).collect()
}

/// The sites whose speeds can be written in their place; the ways of others get their reason.
fn slots(before: &Before<'_>, settings: &Settings, ways: &mut [Way]) -> Vec<Slot> {
    let arguments = speed_arguments(before.program, before.files);
    let mut slots = Vec::new();
    for (index, site) in before.sites.iter().enumerate() {
        let mut own: Vec<&mut Way> = ways.iter_mut().filter(|way| way.site == index).collect();
        if own.iter().any(|way| !matches!(way.outcome, Err(Reason::NoSaving))) {
            continue;
        }
        match slot(before, settings, index, site, &arguments) {
            Ok(slot) => slots.push(slot),
            Err(why) => {
                for way in &mut own {
                    way.outcome = Err(Reason::NotConstant(why.to_owned()));
                }
            }
        }
    }
    slots
}

fn slot(
    before: &Before<'_>,
    settings: &Settings,
    index: usize,
    site: &Site,
    arguments: &BTreeMap<Span, Argument>,
) -> Result<Slot, &'static str> {
    let mut speeds: BTreeMap<Span, Programmed> = BTreeMap::new();
    for event in site.variants.iter().flat_map(|variant| &variant.events) {
        let What::Run(run) = &before.simulation.events[*event].what else { continue };
        for movement in run.moves.iter().map(|record| &record.movement) {
            let Some(argument) = arguments.get(&movement.span).cloned() else {
                return Err("its speed is not one argument that can be written anew");
            };
            let ceiling = settings.freedom.bound(movement) == Bound::Original;
            let here = Programmed { argument, speed: movement.speed, ceiling };
            let known = speeds.entry(movement.span).or_insert(here);
            if known.speed != movement.speed {
                return Err("its speed is another one in another execution");
            }
        }
    }
    Ok(Slot { site: index, speeds: speeds.into_values().collect() })
}

/// The factors that take least energy, and the program with them.
fn search(
    before: &Before<'_>,
    model: &Model,
    settings: &Settings,
    slots: &[Slot],
    ways: &[Way],
    done: &dyn Fn(usize),
) -> Option<(Vec<f64>, Tried)> {
    if slots.is_empty() {
        return None;
    }
    let mut known: Vec<Vec<(f64, f64, f64)>> = vec![Vec::new(); slots.len()];
    for (round, factor) in FACTORS.iter().enumerate() {
        done(round + 1);
        // A cycle may become too long to be simulated.
        let factors = vec![*factor; slots.len()];
        let Some(tried) = try_speeds(before, model, settings, slots, &factors) else { continue };
        for (slot, list) in slots.iter().zip(&mut known) {
            let (time, energy) = mean(before.sites, slot, &tried.simulation, &tried.account);
            list.push((*factor, time, energy));
        }
    }
    if known.iter().any(Vec::is_empty) {
        return None;
    }
    let times = times(before, model, settings, slots, ways, &known)?;
    // Of the factors whose time fits the slowest one, and a slower one whose time does not.
    let mut fits: Vec<f64> = Vec::new();
    let mut slower: Vec<Option<f64>> = Vec::new();
    for (list, time) in known.iter().zip(&times) {
        let first = list.iter().position(|(_, t, _)| *t <= time + TIME_TOLERANCE);
        let first = first.unwrap_or(list.len() - 1);
        fits.push(list[first].0);
        slower.push(first.checked_sub(1).map(|i| list[i].0));
    }
    for round in 0..HALVINGS {
        let middle: Vec<f64> = fits
            .iter()
            .zip(&slower)
            .map(|(fit, slower)| slower.map_or(*fit, |slower| f64::midpoint(*fit, slower)))
            .collect();
        let tried = try_speeds(before, model, settings, slots, &middle)?;
        for (i, slot) in slots.iter().enumerate() {
            let (time, _) = mean(before.sites, slot, &tried.simulation, &tried.account);
            if time <= times[i] + TIME_TOLERANCE {
                fits[i] = middle[i];
            } else {
                slower[i] = Some(middle[i]);
            }
        }
        done(FACTORS.len() + round + 1);
    }
    for factor in &mut fits {
        if (*factor - 1.0).abs() < UNCHANGED {
            *factor = 1.0;
        }
    }
    let tried = try_speeds(before, model, settings, slots, &fits)?;
    done(FACTORS.len() + HALVINGS + 1);
    Some((fits, tried))
}

/// The time of each slot, s.
fn times(
    before: &Before<'_>,
    model: &Model,
    settings: &Settings,
    slots: &[Slot],
    ways: &[Way],
    known: &[Vec<(f64, f64, f64)>],
) -> Option<Vec<f64>> {
    if settings.objective == Objective::Time {
        let least = |list: &Vec<(f64, f64, f64)>| list.iter().map(|k| k.1).fold(f64::MAX, f64::min);
        return Some(known.iter().map(least).collect());
    }
    let time_at_1 =
        |list: &Vec<(f64, f64, f64)>| list.iter().find(|k| k.0 == 1.0).map_or(0.0, |k| k.1);
    let takt = match settings.budget {
        Budget::Factor(x) => return Some(known.iter().map(|list| x * time_at_1(list)).collect()),
        Budget::AsBefore => before.simulation.cycle_s,
        Budget::Takt(takt) => takt,
    };
    let original = (&before.simulation, before.lowered.as_slice());
    let mut cycle = cycle(model, settings, original, before.sites, ways, &[], takt);
    for (i, slot) in slots.iter().enumerate() {
        for event in before.sites[slot.site].variants.iter().flat_map(|v| &v.events) {
            cycle.parts[*event] = Part::Run(i);
        }
    }
    let curves: Option<Vec<TradeOff>> = known
        .iter()
        .map(|list| TradeOff::new(list.iter().map(|(_, time, energy)| (*time, *energy)).collect()))
        .collect();
    cycle.share(&curves?)
}

/// Time (s) and motion energy (J) of an execution of a slot's site in the mean.
fn mean(sites: &[Site], slot: &Slot, simulation: &Simulation, account: &Account) -> (f64, f64) {
    let events = || sites[slot.site].variants.iter().flat_map(|variant| &variant.events);
    let n = events().count().max(1) as f64;
    let time: f64 = events().map(|event| simulation.events[*event].duration).sum();
    let parts = events().flat_map(|event| &account.events[*event]);
    (time / n, parts.map(crate::retime::energy::EnergyParts::motion_energy_j).sum::<f64>() / n)
}

/// The program with these factors; `None` where it does not run as before.
fn try_speeds(
    before: &Before<'_>,
    model: &Model,
    settings: &Settings,
    slots: &[Slot],
    factors: &[f64],
) -> Option<Tried> {
    let edits: Vec<Edit> =
        slots.iter().zip(factors).flat_map(|(slot, factor)| edits(slot, *factor)).collect();
    let mut outputs = Vec::new();
    for (i, source) in before.files.iter().enumerate() {
        let own: Vec<Edit> =
            edits.iter().filter(|edit| edit.span.file.0 as usize == i).cloned().collect();
        let mut output = unchanged(i, source);
        if !own.is_empty() {
            output.bytes = text::apply(&source.file.bytes, &own).ok()?;
            output.kind = OutputKind::Changed;
        }
        outputs.push(output);
    }
    let (program, entry) = read_program(&read_again(&outputs), &settings.entry).ok()?;
    let simulation = simulate(&program, entry, model, &settings.options);
    if !same_order(&before.simulation, &simulation) {
        return None;
    }
    let account = account(model, &simulation);
    Some(Tried { outputs, simulation, account })
}

/// The program as it was.
fn as_it_was(
    before: &Before<'_>,
    model: &Model,
    settings: &Settings,
) -> Result<Tried, RetrofitError> {
    let outputs: Vec<OutputFile> =
        before.files.iter().enumerate().map(|(i, source)| unchanged(i, source)).collect();
    let (program, entry) = read_program(before.files, &settings.entry)?;
    let simulation = simulate(&program, entry, model, &settings.options);
    let account = account(model, &simulation);
    Ok(Tried { outputs, simulation, account })
}

fn edits(slot: &Slot, factor: f64) -> Vec<Edit> {
    let changed = slot.speeds.iter().filter(|speed| factor_of(speed, factor) != 1.0);
    let text = |programmed: &Programmed| Edit {
        span: programmed.argument.span,
        text: speed_text(programmed, factor_of(programmed, factor)).into_bytes(),
    };
    changed.map(text).collect()
}

fn is_changed(slot: &Slot, factor: f64) -> bool {
    slot.speeds.iter().any(|speed| factor_of(speed, factor) != 1.0)
}

/// The factor that a speed gets where its run gets `factor`.
fn factor_of(programmed: &Programmed, factor: f64) -> f64 {
    let most = if programmed.ceiling { 1.0 } else { (FASTEST / programmed.speed.tcp).max(1.0) };
    factor.min(most)
}

/// A `speeddata`. External axes stand in runs that are changed.
fn speed_text(Programmed { argument, speed, .. }: &Programmed, factor: f64) -> String {
    if let Some(datum) = &argument.datum {
        let share = number(down(factor, 1e4), SHARE_DECIMALS);
        let scaled = ["v_tcp", "v_ori"].map(|part| format!("{share}*{datum}.{part}"));
        return format!("[{},{datum}.v_leax,{datum}.v_reax]", scaled.join(","));
    }
    let tcp = down(speed.tcp * 1e3 * factor, 10.0);
    let orientation = down(speed.orientation.to_degrees() * factor, 10.0);
    format!("[{},{},5000,1000]", number(tcp, DECIMALS), number(orientation, DECIMALS))
}

/// Rounded down to what the text says, in parts of 1, so that no ceiling is exceeded by rounding.
fn down(x: f64, parts: f64) -> f64 {
    /// What arithmetic may take from a round figure.
    const SLACK: f64 = 1e-9;
    (x * parts + SLACK).floor().max(1.0) / parts
}

/// What a program with other speeds does against the one before.
fn verify(
    before: &Before<'_>,
    model: &Model,
    settings: &Settings,
    slots: &[Slot],
    factors: &[f64],
    tried: &Tried,
) -> Verification {
    let mut verification = nothing_to_verify();
    let mut note = |what: &str, held: bool| verification.checks.push((what.to_owned(), held));
    let errors = |bytes: &[u8]| syntax::parse(bytes).errors.len();
    let clean = tried.outputs.iter().all(|output| {
        let was = output.input.map_or(0, |i| errors(&before.files[i].file.bytes));
        output.kind == OutputKind::Unchanged || errors(&output.bytes) <= was
    });
    note("the emitted text parses", clean);
    note("movements, waits and outputs come in the same order", true);
    let cycle_s = tried.simulation.cycle_s;
    let kept = match settings.budget {
        Budget::AsBefore => cycle_s <= before.simulation.cycle_s + TIME_TOLERANCE,
        Budget::Takt(takt) => cycle_s <= takt.max(before.simulation.cycle_s) + TIME_TOLERANCE,
        Budget::Factor(_) => true,
    };
    note("the cycle takes no longer than allowed", kept);
    let (mut paths, mut ceilings) = (true, true);
    let mut worst = Check::none();
    for (slot, factor) in slots.iter().zip(factors).filter(|(s, f)| is_changed(s, **f)) {
        let events = before.sites[slot.site].variants.iter().flat_map(|variant| &variant.events);
        for event in events {
            let runs =
                (&before.simulation.events[*event].what, &tried.simulation.events[*event].what);
            let (What::Run(was), What::Run(now)) = runs else { continue };
            paths &= now.problem.is_none() && same_path(was, now);
            ceilings &= *factor <= 1.0 || keeps_ceilings(was, now, &settings.freedom);
            worst = worst.max(&shares(model, now));
        }
    }
    note("targets and zones are those of before", paths);
    note("no programmed speed is exceeded", ceilings);
    verification.worst = worst;
    verification.passed = verification.checks.iter().all(|(_, held)| *held);
    verification
}

fn same_path(was: &Run, now: &Run) -> bool {
    was.legs.len() == now.legs.len()
        && was.legs.iter().zip(&now.legs).all(|(a, b)| {
            a.zone == b.zone
                && a.target == b.target
                && (0..DOF).all(|j| (a.end[j] - b.end[j]).abs() <= TIME_TOLERANCE)
        })
}

fn keeps_ceilings(was: &Run, now: &Run, freedom: &Freedom) -> bool {
    was.moves.iter().zip(&now.moves).all(|(a, b)| {
        freedom.bound(&a.movement) == Bound::Robot || b.movement.speed.tcp <= a.movement.speed.tcp
    })
}

/// Shares of the limits that a run uses as the virtual controller plans it.
fn shares(model: &Model, run: &Run) -> Check {
    let limits = &model.limits;
    let share = |values: &[f64], limit: &Option<Vec<f64>>| {
        limit.as_ref().map_or(0.0, |limit| {
            values.iter().zip(limit).map(|(x, most)| x.abs() / most).fold(0.0, f64::max)
        })
    };
    let mut data = Data::new();
    let mut check = Check::none();
    let count = (run.duration() / STEP).ceil().max(1.0) as usize;
    for i in 0..=count {
        let state = run.at(run.duration() * i as f64 / count as f64);
        let tau = power(model, &mut data, &run.load, &state).tau;
        check = check.max(&Check {
            velocity: share(&state.qd, &limits.velocity),
            acceleration: share(&state.qdd, &limits.acceleration),
            torque: share(&tau, &limits.torque),
            ..Check::none()
        });
    }
    check
}

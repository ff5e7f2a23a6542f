//! The pipeline.

use std::sync::Arc;

use rayon::prelude::*;

use super::demand::{Frugal, mean_robot};
use super::figures::{Figures, LowerLimits, Retrofit, Verification};
use super::goals::{Planning, goals};
use super::guards::Guards;
use super::lower_limits::Lowered;
use super::settings::{Budget, Form, Objective, Settings};
use super::sharing::{keep_to_the_cycle, leave_what_does_not_pay, useful};
use super::uncertainty::{self, Side};
use super::{
    guard_cost, guided, hazards, lower_limits, notes, outputs, padding, recorded, rests, segments,
    signals, speeds, verify,
};
use crate::arm::robot::{Model, NotReady, Use, ready};
use crate::rapid::ir::lower;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::syntax::{self, SyntaxError};
use crate::rapid::text::SourceFile;
use crate::retime::energy::plausible::Robots;
use crate::retime::energy::{Account, account};
use crate::retime::motion::timeline::{Run, What};
use crate::retime::motion::{Simulation, simulate};
use crate::retime::optimize::allowed::Loads;
use crate::retime::optimize::energy_curve::{TimeEnergy, pareto};
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::idle::dwells;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::{PathUse, Retiming, Task, retime};
use crate::retime::optimize::site::{Site, not_constant, not_reached, sites};
use crate::tool::emit::{self, Names};

/// Rounding of a time, s.
pub(super) const TIME_TOLERANCE: f64 = 1e-6;

/// Rounds of leaving out what did not hold; in the last one nothing is kept.
const MOST_ROUNDS: usize = 12;

/// A file of the program.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its bytes and path as given.
    pub file: SourceFile,
    /// Its path below the input.
    pub relative: String,
}

/// Why a program can't be retrofitted at all.
#[derive(Debug, thiserror::Error)]
pub enum RetrofitError {
    /// No routine of that name.
    #[error(
        "no global procedure '{entry}' in the files given; name the routine that starts the \
         program with --entry"
    )]
    NoEntry {
        /// The name.
        entry: String,
    },
    /// More than one routine of that name.
    #[error(
        "the entry routine '{entry}' is declared more than once, in {first} and in {second}: name \
         the files of one program only, or another routine with --entry"
    )]
    TwoEntries {
        /// The name.
        entry: String,
        /// File and line of the first.
        first: String,
        /// File and line of the second.
        second: String,
    },
    /// The program calls streams that are not there.
    #[error(
        "{path}:{line} calls {function} of a module of streams that was not given: the program is \
         optimised already; give '{module}' too (name the folder), or start from the original"
    )]
    NoStreams {
        /// File.
        path: String,
        /// From 1.
        line: u32,
        /// What is called.
        function: String,
        /// The file of the streams.
        module: String,
    },
    /// Nothing to read.
    #[error("'{path}' is empty: it has no procedure '{entry}' to start the program with")]
    Empty {
        /// The file.
        path: String,
        /// The name.
        entry: String,
    },
    /// The module with the entry has syntax errors.
    #[error(
        "{path}:{line}:{column}: {message}; the module holds the entry routine '{entry}', so it \
         has to be mended first (joulepath parse shows all errors)"
    )]
    BrokenEntry {
        /// File.
        path: String,
        /// From 1.
        line: u32,
        /// From 1.
        column: u32,
        /// Of the first error.
        message: String,
        /// The entry routine.
        entry: String,
    },
    /// The robot lacks something.
    #[error(transparent)]
    Robot(#[from] NotReady),
    /// A takt below the possible.
    #[error(
        "a takt of {takt:.3} s is below the possible: the cycle takes at least {least:.3} s with \
         this robot, of which {fixed:.3} s are waits and movements that stay; give --takt {least:.3} \
         or more"
    )]
    Takt {
        /// Asked for, s.
        takt: f64,
        /// Possible, s.
        least: f64,
        /// Not to be changed, s.
        fixed: f64,
    },
    /// A factor below the possible for every run.
    #[error(
        "a time factor of {factor} is below the possible: no run takes less than {least:.3} times \
         as long as before with this robot; give --time-factor {least:.3} or more"
    )]
    Factor {
        /// Asked for.
        factor: f64,
        /// Possible for some run.
        least: f64,
    },
    /// The emission failed.
    #[error("{0}")]
    Emit(#[from] emit::EmitError),
}

/// Parses the files and finds the entry.
///
/// # Errors
/// No entry, or one in a broken module.
pub fn read_program(files: &[Source], entry: &str) -> Result<(Program, RoutineId), RetrofitError> {
    let parsed: Vec<_> = files
        .par_iter()
        .map(|source| {
            let parse = syntax::parse(&source.file.bytes);
            let modules = lower(source.file.id, &parse, &source.file.bytes);
            (parse.errors, modules)
        })
        .collect();
    let mut errors: Vec<Vec<SyntaxError>> = Vec::new();
    let mut modules = Vec::new();
    for (file_errors, file_modules) in parsed {
        errors.push(file_errors);
        modules.extend(file_modules);
    }
    let program = Program::new(modules);
    if let Some(clash) = program.clash(entry) {
        let place = |i: usize| {
            let span = clash.spans[i];
            let file = &files[span.file.0 as usize].file;
            format!("{}:{}", file.path, file.position(span.start).line)
        };
        return Err(RetrofitError::TwoEntries {
            entry: entry.to_owned(),
            first: place(0),
            second: place(1),
        });
    }
    if let Some(missing) = emit::missing_streams(&program) {
        let file = &files[missing.span.file.0 as usize].file;
        return Err(RetrofitError::NoStreams {
            path: file.path.clone(),
            line: file.position(missing.span.start).line,
            function: missing.function,
            module: missing.module,
        });
    }
    // A broken module may hide its entry: then its error is the way out.
    let Some(id) = program.entry(entry) else {
        let broken = errors.iter().position(|list| !list.is_empty());
        let blank = |source: &Source| source.file.bytes.iter().all(u8::is_ascii_whitespace);
        return Err(match (broken, files) {
            (Some(i), _) => broken_entry(&files[i], &errors[i][0], entry),
            (None, [source]) if blank(source) => {
                RetrofitError::Empty { path: source.file.path.clone(), entry: entry.to_owned() }
            }
            (None, _) => RetrofitError::NoEntry { entry: entry.to_owned() },
        });
    };
    let file = program.modules[id.module].span.file.0 as usize;
    match errors[file].first() {
        Some(error) if !is_elsewhere(&program, id, error) => {
            Err(broken_entry(&files[file], error, entry))
        }
        _ => Ok((program, id)),
    }
}

/// An error inside another routine of the module leaves the entry usable.
fn is_elsewhere(program: &Program, entry: RoutineId, error: &SyntaxError) -> bool {
    program.modules[entry.module].routines.iter().enumerate().any(|(index, routine)| {
        index != entry.index && routine.span.start <= error.start && error.end <= routine.span.end
    })
}

fn broken_entry(source: &Source, error: &SyntaxError, entry: &str) -> RetrofitError {
    let position = source.file.position(error.start);
    RetrofitError::BrokenEntry {
        path: source.file.path.clone(),
        line: position.line,
        column: position.column,
        message: error.message.clone(),
        entry: entry.to_owned(),
    }
}

/// A way in which a site runs, with what became of it.
pub(super) struct Way {
    /// Index of the site.
    pub(super) site: usize,
    /// Index of the variant.
    pub(super) variant: usize,
    /// Its stream, or why there is none.
    pub(super) outcome: Outcome,
    /// Its curve of energy over time, if that is asked for.
    pub(super) pareto: Vec<TimeEnergy>,
}

impl Way {
    /// A way without more than its outcome.
    pub(super) fn new(site: usize, variant: usize, outcome: Outcome) -> Way {
        Way { site, variant, outcome, pareto: Vec::new() }
    }
}

/// A stream, or why there is none.
pub(super) type Outcome = Result<Retiming, Reason>;

/// Retrofits a program. `progress` is told how many of how many pieces are done.
///
/// # Errors
/// What makes the whole job impossible; a piece that can't be improved stays as it is.
pub fn retrofit(
    files: &[Source],
    model: &Model,
    settings: &Settings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Retrofit, RetrofitError> {
    ready(model, Use::Optimize)?;
    let (program, entry) = read_program(files, &settings.entry)?;
    let simulation = simulate(&program, entry, model, &settings.options);
    let before = account(model, &simulation);
    let given = settings;
    let settings = &showing(model, &simulation, given);
    let mut sites = sites(&program, &simulation);
    let by_interrupts = hazards::written_by_interrupts(&program);
    let guards = Guards::new(&program, files, by_interrupts, settings);
    hazards::mark(&program, &simulation, &guards, &mut sites);
    if settings.form != Form::Streams {
        leave_what_changes(&simulation, &mut sites);
    }
    let lowered = lower_limits::lowered(&program, entry, model, settings);
    if settings.form == Form::Speeds {
        let before = speeds::Before {
            files,
            program: &program,
            simulation,
            lowered,
            account: before,
            sites: &sites,
        };
        return speeds::retrofit(before, model, settings, progress);
    }
    let robots = if settings.point_estimate { None } else { Robots::new(model) };
    let mean = mean_robot(model, robots.as_ref(), &simulation);
    let (aim, of_aim) = match &mean {
        Some(mean) => (mean, account(mean, &simulation)),
        None => (model, before.clone()),
    };
    // No more is asked of robots of whose limits nothing is known than what they do already.
    let mut frugal = Frugal::of(model, robots.as_ref(), &simulation);
    let mut checks = settings.clone();
    if let (Some(_), Some(loads)) = (&frugal, &mut checks.freedom.loads) {
        loads.torque = Loads::limits(model).torque;
    }
    let planning = Planning {
        model: aim,
        settings: &showing(aim, &simulation, given),
        simulation: &simulation,
        before: &of_aim,
        sites: &sites,
    };
    let mut ways = retime_all(&planning, &lowered, progress)?;
    let originals: Vec<SourceFile> = files.iter().map(|source| source.file.clone()).collect();
    let names = Names::free(&originals);
    let writing = outputs::Writing {
        files,
        guards: &guards,
        robot: outputs::robot(model),
        override_percent: 100.0 * settings.options.speed_override.unwrap_or(1.0),
        recorded: recorded::recorded(&program, files, &names),
        names,
        originals,
        beside: program.modules[entry.module].span.file.0 as usize,
        layout: settings.layout,
    };
    let dwells_before = dwells(model, &simulation);
    let mut restings = rests::restings(model, settings, files, &simulation, &sites, &ways);

    // Each round leaves out what did not hold in the emitted text.
    let mut rounds = 0;
    let (mut checked, lower_limits) = loop {
        let emitted = outputs::emit(&writing, &simulation, &sites, &ways, &restings)?;
        let what = (sites.as_slice(), ways.as_slice(), restings.as_slice());
        let attempt = verify::verify(files, &emitted.files, model, &checks, &simulation, what);
        let nothing_left = restings.is_empty() && ways.iter().all(|way| way.outcome.is_err());
        if attempt.verification.passed || nothing_left {
            let kept = (sites.as_slice(), ways.as_slice());
            let (table, weak) = lower_limits::compare(
                &lowered,
                (&simulation, &attempt.simulation),
                &emitted.files,
                settings,
                kept,
                restings.is_empty(),
            );
            let weak = match &robots {
                // Where more or less time is asked for, runs may take more energy on purpose.
                Some(robots)
                    if weak.is_empty()
                        && restings.is_empty()
                        && settings.budget == Budget::AsBefore
                        && settings.objective == Objective::Energy =>
                {
                    let after = Side { simulation: &attempt.simulation, account: &attempt.account };
                    let before = Side { simulation: &simulation, account: &before };
                    uncertainty::uncertain_ways(model, robots, before, after, &sites, &ways)
                }
                _ => weak,
            };
            if let (true, Some(frugal)) = (weak.is_empty(), &mut frugal)
                && !frugal.hold(&attempt.simulation, &mut ways, &planning)
            {
                continue;
            }
            let kept = (sites.as_slice(), ways.as_slice());
            let weak = if weak.is_empty() {
                guard_cost::costly(model, settings, &simulation, kept, &emitted.guards)
            } else {
                weak
            };
            if weak.is_empty() {
                break ((emitted, attempt), table);
            }
            for (way, reason) in weak {
                ways[way].outcome = Err(reason);
            }
            continue;
        }
        rounds += 1;
        if !attempt.restless.is_empty() {
            rests::mend(&mut restings, &attempt.restless, rounds == 1);
            continue;
        }
        if attempt.failed.is_empty() || rounds == MOST_ROUNDS {
            // No single stream is at fault: none is kept.
            let broken = attempt.verification.checks.iter().find(|(_, held)| !held);
            let why = broken.map_or("the verification failed", |(what, _)| what.as_str());
            for way in ways.iter_mut().filter(|way| way.outcome.is_ok()) {
                way.outcome = Err(Reason::Verification(format!("did not hold: {why}")));
            }
        }
        for (way, reason) in attempt.failed {
            ways[way].outcome = Err(reason);
        }
    };
    let verify::Attempt {
        simulation: mut after_simulation, account: mut after, verification, ..
    } = checked.1;
    let is_free = |way: &Way| matches!(&way.outcome, Ok(it) if it.path == PathUse::Left);
    let freed = ways.iter().any(is_free);
    if settings.form == Form::Guided {
        checked.0.guards.clear();
        checked.0.files =
            guided::files(files, &program, &simulation, &sites, &mut ways, &writing.names)?;
        // The program that runs is the one before.
        after_simulation = simulate(&program, entry, model, &settings.options);
        after = account(model, &after_simulation);
    }
    let mut segments = segments::segments(
        (&simulation, &before),
        (&after_simulation, &after),
        &sites,
        &ways,
        (&dwells_before, &restings),
        &not_reached(&program, &simulation),
    );
    if mean.is_some() {
        // The bounds are of the mean robot, the energies of the model.
        for segment in &mut segments {
            segment.lower_bound_j = None;
        }
    }
    outputs::add_brake_note(&mut checked.0.files, model, &dwells(model, &after_simulation));
    let potential_j = dwells_before.iter().map(|dwell| dwell.potential_j).fold(0.0, |a, b| a + b);
    let optimized = figures(&after_simulation, &after);
    let padding = padding::padding(model, &simulation, &optimized);
    let uncertainty = robots.map(|robots| {
        let before = Side { simulation: &simulation, account: &before };
        let after = Side { simulation: &after_simulation, account: &after };
        uncertainty::uncertainty(model, &robots, (before, padding.as_ref()), after)
    });
    let original = figures(&simulation, &before).padded(padding.as_ref());
    // A padded original waits less where its movements take longer.
    let padded = |lower: LowerLimits| match padding {
        Some(_) => LowerLimits { original_s: lower.original_s.max(original.cycle_s), ..lower },
        None => lower,
    };
    let lower_limits = lower_limits.into_iter().map(padded).collect();
    let compared = (&original, &optimized, padding.as_ref());
    let mut notes = notes::notes(files, model, settings, &simulation, &segments, compared);
    notes.extend(mean.is_some().then(|| notes::of_mean(model)));
    if freed {
        notes.extend(notes::off_path(settings, verification.worst.deviation_m));
    }
    Ok(Retrofit {
        original,
        padding,
        optimized,
        potential_j,
        segments,
        notes,
        lower_limits,
        uncertainty,
        verification,
        signals: signals::signals(&simulation, &after_simulation),
        guard_instructions: checked.0.guards.iter().map(|(_, count)| count).sum(),
        outputs: checked.0.files,
        before: (simulation, before),
        after: (after_simulation, after),
    })
}

/// Settings with what a robot has to do in the original: streams ask no more of its joints.
fn showing(model: &Model, simulation: &Simulation, settings: &Settings) -> Settings {
    let loads = Some(Loads::shown(model, simulation));
    Settings { freedom: Freedom { loads, ..settings.freedom.clone() }, ..settings.clone() }
}

pub(super) fn figures(simulation: &Simulation, account: &Account) -> Figures {
    Figures {
        cycle_s: simulation.cycle_s,
        energy_j: account.total.energy_j(),
        motion_energy_j: account.total.motion_energy_j(),
    }
}

/// The run of a variant.
pub(super) fn run_of<'a>(simulation: &'a Simulation, sites: &[Site], way: &Way) -> Option<&'a Run> {
    let event = *sites[way.site].variants[way.variant].events.first()?;
    match &simulation.events[event].what {
        What::Run(run) => Some(run),
        _ => None,
    }
}

/// Other forms than streams have no guard: what may be another one at the next run stays.
fn leave_what_changes(simulation: &Simulation, sites: &mut [Site]) {
    for variant in sites.iter_mut().flat_map(|site| &mut site.variants) {
        let run = variant.events.first().map(|event| &simulation.events[*event].what);
        if let (None, Some(What::Run(run))) = (&variant.reason, run) {
            variant.reason = run.moves.iter().find_map(|record| not_constant(&record.movement));
        }
    }
}

fn retime_all(
    planning: &Planning<'_>,
    lowered: &[Lowered],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Way>, RetrofitError> {
    let Planning { model, settings, simulation, sites, .. } = *planning;
    let mut ways = Vec::new();
    for (s, site) in sites.iter().enumerate() {
        for (v, variant) in site.variants.iter().enumerate() {
            let reason = site.reason.clone().or_else(|| variant.reason.clone());
            ways.push(Way::new(s, v, Err(reason.unwrap_or(Reason::NoSaving))));
        }
    }
    let open: Vec<usize> =
        (0..ways.len()).filter(|i| matches!(ways[*i].outcome, Err(Reason::NoSaving))).collect();
    let tasks: Vec<(usize, Task<'_>)> = open
        .iter()
        .filter_map(|i| Some((*i, planning.task(&ways[*i], &settings.freedom)?)))
        .collect();
    let mut plan = goals(model, settings, (simulation, lowered), sites, &ways, &tasks)?;
    let done = Arc::new(std::sync::atomic::AtomicUsize::new(0));
    let mut outcomes: Vec<(usize, Outcome)> = tasks
        .par_iter()
        .zip(&plan.goals)
        .map(|((i, task), goal)| {
            let outcome = if settings.budget == Budget::AsBefore {
                useful(task, *goal)
            } else {
                retime(task, *goal)
            };
            let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            progress(count, tasks.len());
            (*i, outcome)
        })
        .collect();
    if settings.budget == Budget::AsBefore {
        keep_to_the_cycle(&mut plan, &tasks, &mut outcomes);
        if settings.objective == Objective::Energy {
            leave_what_does_not_pay(&plan, &tasks, &mut outcomes);
        }
    }
    if let Budget::Factor(factor) = settings.budget {
        let share = |(outcome, task): (&Outcome, &Task<'_>)| match outcome {
            Err(Reason::TooShort(least)) => Some(least / task.run.duration()),
            _ => None,
        };
        let pairs = outcomes.iter().zip(&tasks).map(|((_, outcome), (_, task))| (outcome, task));
        // Where some run can do it, the others stay with that as their reason.
        let shares: Option<Vec<f64>> = pairs.map(share).collect();
        let least = shares.and_then(|list| list.into_iter().reduce(f64::min));
        if let Some(least) = least {
            return Err(RetrofitError::Factor { factor, least: rounded_up(least) });
        }
    }
    for (i, outcome) in outcomes {
        ways[i].outcome = outcome;
    }
    if settings.pareto > 0 {
        let curves: Vec<(usize, Vec<TimeEnergy>)> =
            tasks.par_iter().map(|(i, task)| (*i, pareto(task, settings.pareto))).collect();
        for (i, curve) in curves {
            ways[i].pareto = curve;
        }
    }
    Ok(ways)
}

/// Up to the next figure with three decimals: what a message tells to give has to do.
pub(super) fn rounded_up(x: f64) -> f64 {
    (x * 1e3).ceil() / 1e3
}

/// No verification was made: nothing was changed.
pub(super) fn nothing_to_verify() -> Verification {
    Verification {
        passed: true,
        worst: crate::retime::optimize::check::Check::none(),
        intended_error_rad: 0.0,
        checks: Vec::new(),
    }
}

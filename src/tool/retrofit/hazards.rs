//! Surroundings of a movement that affect a stream differently from the movement: error handlers,
//! interrupt routines, external axes, stop points with a time.

use std::collections::{BTreeMap, BTreeSet};

use super::guards::Guards;
use super::interrupts::interrupt_hazard;
use super::joined::mark_pieces;
use super::settings::Form;
use super::statements::calls;
use crate::rapid::builtins::{self, Cause, is_movement};
use crate::rapid::ir::hir::{BinaryOp, Block, Callee, Expr, ExprKind, Routine, StmtKind};
use crate::rapid::ir::movement::Stop;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::text::Span;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::optimize::eligibility::not_constant;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::{Site, mark_joined, sites};
use crate::tool::emit;

/// The sites of a program; sites and variants that cannot be streams have a reason.
pub(super) fn marked_sites(
    program: &Program,
    entry: RoutineId,
    simulation: &Simulation,
    guards: &Guards<'_>,
    form: Form,
) -> Vec<Site> {
    let handled = handlers(program);
    let interrupt = interrupt_hazard(program);
    let moved = external_axes(simulation);
    let whole = program_hazard(program);
    let argument_error_handler = argument_error_handler(program);
    let mut sites = sites(program, simulation);
    for variant in sites.iter_mut().flat_map(|site| &mut site.variants) {
        let elsewhere = external_axes_differ(simulation, &variant.events);
        let hazard = |run: &Run, event: usize| {
            let mut spans = run.moves.iter().map(|record| record.movement.span);
            let handler = spans.find_map(|span| handled.get(&span));
            let axes = elsewhere || moved.contains(&event);
            handler
                .or(interrupt.as_ref())
                .cloned()
                .or_else(|| axes.then_some(Reason::ExternalAxes))
                .or_else(|| stop_with_time(run))
                .or_else(|| guards.refusal(run))
                .or_else(|| argument_error_handler.clone().filter(|_| guards.may_raise(run)))
        };
        let mut runs = variant.events.iter().filter_map(|event| {
            let What::Run(run) = &simulation.events[*event].what else { return None };
            Some((run, *event))
        });
        // Only streams have a guard: with other forms, variable movements stay, and those under a
        // setting that their new speeds would have to know.
        let varies = |run: &Run| {
            run.moves.iter().find_map(|record| {
                let is_scaled = record.movement.settings.shares() != [1.0; 3];
                let setting = is_scaled.then(|| Reason::Setting("VelSet or AccSet".to_owned()));
                setting.or_else(|| not_constant(&record.movement))
            })
        };
        let unguarded = runs.clone().next().filter(|_| form != Form::Streams);
        variant.reason = std::mem::take(&mut variant.reason)
            .or_else(|| whole.clone())
            .or_else(|| runs.find_map(|(run, event)| hazard(run, event)))
            .or_else(|| unguarded.and_then(|(run, _)| varies(run)));
    }
    match form {
        Form::Streams => {
            mark_pieces(program, entry, guards, argument_error_handler.as_ref(), &mut sites);
        }
        Form::Speeds | Form::Guided => mark_joined(program, &mut sites),
    }
    sites
}

/// Why no movement of the program can become a stream.
fn program_hazard(program: &Program) -> Option<Reason> {
    let redeclared_name =
        || emit::redeclared_name(program).map(|name| Reason::OwnName(name.into()));
    emit::has_streams(program).then_some(Reason::Already).or_else(redeclared_name)
}

/// A stop point with an additional wait; a stream would lose that wait.
fn stop_with_time(run: &Run) -> Option<Reason> {
    let waits = run.moves.iter().any(|record| record.movement.stop != Stop::Fine);
    waits.then(|| Reason::Argument("Inpos".into()))
}

/// Whether the external axes differ between executions of one variant.
fn external_axes_differ(simulation: &Simulation, events: &[usize]) -> bool {
    let mut places = events.iter().filter_map(|event| match &simulation.events[*event].what {
        What::Run(run) => run.moves.first().map(|record| record.movement.external),
        _ => None,
    });
    let first = places.next();
    places.any(|place| Some(place) != first)
}

/// The runs in which external axes may move.
fn external_axes(simulation: &Simulation) -> BTreeSet<usize> {
    let mut moved = BTreeSet::new();
    let mut stand: Option<[f64; 6]> = None;
    for (index, event) in simulation.events.iter().enumerate() {
        match &event.what {
            What::Run(run) => {
                for record in &run.moves {
                    let to = record.movement.external;
                    if to.is_none() || to != stand {
                        moved.insert(index);
                    }
                    stand = to;
                }
            }
            What::Wait(record) if is_movement(&record.wait.instruction) => {
                stand = record.wait.external;
            }
            What::Wait(_) | What::Output(..) => {}
            What::Left(_) => stand = None,
        }
    }
    moved
}

/// The routine that handles an error of an argument: the guard evaluates all arguments before the
/// first movement, so the error would come earlier.
fn argument_error_handler(program: &Program) -> Option<Reason> {
    let takes = |(numbers, block): &(Vec<Expr>, Block)| {
        let named = |number: &Expr| is_number(number, Cause::Argument);
        (numbers.is_empty() || numbers.iter().any(named)) && handles_argument_error(block)
    };
    let routine =
        program.routines().map(|(_, it)| it).find(|routine| routine.error.iter().any(takes))?;
    Some(Reason::Handler(format!(
        "an argument of it may end in an error that {} handles; the guard would raise it before the \
         first movement",
        routine.name.text
    )))
}

/// Whether a handler does more than re-raise an error of an argument.
fn handles_argument_error(block: &Block) -> bool {
    block.iter().any(|stmt| match &stmt.kind {
        StmtKind::If { branches, otherwise } => {
            otherwise.is_some()
                || branches.iter().any(|(condition, _)| may_hold(condition, Cause::Argument))
        }
        StmtKind::Test { value, cases, default } if is_errno(value) => {
            default.is_some()
                || cases.iter().any(|(values, _)| {
                    values.iter().any(|number| is_number(number, Cause::Argument))
                })
        }
        StmtKind::Raise(_) => false,
        _ => true,
    })
}

/// The movements that an error handler prevents from being streams.
fn handlers(program: &Program) -> BTreeMap<Span, Reason> {
    let mut found = BTreeMap::new();
    for (routine, block) in program.routines().flat_map(|(_, r)| r.blocks().map(move |b| (r, b))) {
        let in_body = std::ptr::eq(block, &raw const routine.body);
        let why = if in_body { handler_of(routine) } else { Some("it stands in a handler".into()) };
        if let Some(why) = why {
            let movements = calls(block).filter(|(_, name, _)| is_movement(&name.key));
            found.extend(movements.map(|(stmt, ..)| (stmt.span, Reason::Handler(why.clone()))));
        }
    }
    found
}

/// Why the handlers of a routine prevent streams.
fn handler_of(routine: &Routine) -> Option<String> {
    if routine.backward.is_some() {
        return Some("its routine has a BACKWARD handler, which goes back step by step".into());
    }
    let mut taking = routine.error.iter().filter(|(numbers, _)| {
        numbers.is_empty() || numbers.iter().any(|n| is_number(n, Cause::Movement))
    });
    let again = taking.find_map(|(_, handler)| resuming_statement(handler))?;
    Some(format!(
        "the error handler of its routine may go on within it ({again}) after an error of any kind"
    ))
}

/// The first statement of a handler that resumes an interrupted movement.
fn resuming_statement(block: &Block) -> Option<&'static str> {
    block.iter().find_map(|stmt| match &stmt.kind {
        StmtKind::Retry => Some("RETRY"),
        StmtKind::TryNext => Some("TRYNEXT"),
        StmtKind::Call(call) => match &call.callee {
            Callee::Name(name) if name.key == "startmoveretry" => Some("StartMoveRetry"),
            _ => None,
        },
        StmtKind::If { branches, otherwise } => branches
            .iter()
            .filter(|(condition, _)| may_hold(condition, Cause::Movement))
            .map(|(_, block)| block)
            .chain(otherwise)
            .find_map(resuming_statement),
        StmtKind::Test { value, cases, default } if is_errno(value) => cases
            .iter()
            .filter(|(values, _)| values.iter().any(|n| is_number(n, Cause::Movement)))
            .map(|(_, block)| block)
            .chain(default)
            .find_map(resuming_statement),
        other => other.blocks().into_iter().find_map(resuming_statement),
    })
}

/// Whether a condition can hold after an error of this cause.
fn may_hold(condition: &Expr, cause: Cause) -> bool {
    match &condition.kind {
        ExprKind::Binary(BinaryOp::Eq, a, b) if is_errno(a) => is_number(b, cause),
        ExprKind::Binary(BinaryOp::Eq, a, b) if is_errno(b) => is_number(a, cause),
        ExprKind::Binary(BinaryOp::And, a, b) => may_hold(a, cause) && may_hold(b, cause),
        ExprKind::Binary(BinaryOp::Or, a, b) => may_hold(a, cause) || may_hold(b, cause),
        _ => true,
    }
}

fn is_errno(expr: &Expr) -> bool {
    matches!(&expr.kind, ExprKind::Ref(name) if name.key == "errno")
}

/// Whether this may be the number of an error of this cause.
fn is_number(number: &Expr, cause: Cause) -> bool {
    match &number.kind {
        ExprKind::Ref(name) => builtins::error(&name.key) == Some(cause),
        _ => true,
    }
}

//! What stands around a movement in the program and would treat a stream otherwise than the
//! movement itself: handlers, interrupt routines, external axes, stop points with a time.

use std::collections::{BTreeMap, BTreeSet};

use super::guards::Guards;
use crate::rapid::builtins::{self, Cause, Function, Instruction, Source, is_movement, may_write};
use crate::rapid::ir::hir::{Arg, BinaryOp, Block, Callee, Expr, ExprKind, Routine, StmtKind};
use crate::rapid::ir::movement::Stop;
use crate::rapid::ir::program::{DataId, Program, RoutineId, Symbol};
use crate::rapid::text::Span;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::Site;
use crate::tool::emit;

/// Gives the sites and variants that can't be streams their reasons, where they have none yet.
pub(super) fn mark(
    program: &Program,
    simulation: &Simulation,
    guards: &Guards<'_>,
    sites: &mut [Site],
) {
    let handled = handlers(program);
    let interrupt = interrupts(program);
    let moved = external_axes(simulation);
    let whole = of_the_whole(program);
    let catcher = catcher(program);
    for site in sites {
        for variant in &mut site.variants {
            if variant.reason.is_none() {
                variant.reason.clone_from(&whole);
            }
            let elsewhere = stands_elsewhere(simulation, &variant.events);
            let reason = variant.events.iter().find_map(|event| {
                let What::Run(run) = &simulation.events[*event].what else { return None };
                let mut spans = run.moves.iter().map(|record| record.movement.span);
                let handler = spans.find_map(|span| handled.get(&span));
                handler
                    .or(interrupt.as_ref())
                    .cloned()
                    .or_else(|| {
                        (elsewhere || moved.contains(event)).then_some(Reason::ExternalAxes)
                    })
                    .or_else(|| stop_with_time(run))
                    .or_else(|| guards.refusal(run))
                    .or_else(|| catcher.clone().filter(|_| guards.may_raise(run)))
            });
            if variant.reason.is_none() {
                variant.reason = reason;
            }
        }
    }
}

/// Why no movement of the program can become a stream.
fn of_the_whole(program: &Program) -> Option<Reason> {
    let own_name = || emit::own_name(program).map(|name| Reason::OwnName(name.into()));
    emit::has_streams(program).then_some(Reason::Already).or_else(own_name)
}

/// A stop point that waits for more than standing would lose that at the end of a stream.
fn stop_with_time(run: &Run) -> Option<Reason> {
    let waits = run.moves.iter().any(|record| record.movement.stop != Stop::Fine);
    waits.then(|| Reason::Argument("Inpos".into()))
}

/// Whether the external axes stand at different places in different executions of one way.
fn stands_elsewhere(simulation: &Simulation, events: &[usize]) -> bool {
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

/// A routine that goes on after an error in an argument: the guard evaluates all arguments before the
/// first movement, so that the error would come earlier.
fn catcher(program: &Program) -> Option<Reason> {
    let takes = |(numbers, block): &(Vec<Expr>, Block)| {
        let named = |number: &Expr| is_number(number, Cause::Argument);
        (numbers.is_empty() || numbers.iter().any(named)) && may_take(block)
    };
    let routine = routines(program).find(|routine| routine.error.iter().any(takes))?;
    Some(Reason::Handler(format!(
        "an argument of it may end in an error that {} handles; the guard would raise it before the \
         first movement",
        routine.name.text
    )))
}

/// Whether a handler does something after an error in an argument.
fn may_take(block: &Block) -> bool {
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

/// The movements that a handler keeps from being streams.
fn handlers(program: &Program) -> BTreeMap<Span, Reason> {
    let mut found = BTreeMap::new();
    for (routine, block) in routines(program).flat_map(|r| r.blocks().map(move |b| (r, b))) {
        let in_body = std::ptr::eq(block, &raw const routine.body);
        let why = if in_body { handler_of(routine) } else { Some("it stands in a handler".into()) };
        if let Some(why) = why {
            movements(block, &mut |span| {
                found.insert(span, Reason::Handler(why.clone()));
            });
        }
    }
    found
}

/// What the handlers of a routine do to a movement in it that a stream would not bear.
fn handler_of(routine: &Routine) -> Option<String> {
    if routine.backward.is_some() {
        return Some("its routine has a BACKWARD handler, which goes back step by step".into());
    }
    let mut taking = routine.error.iter().filter(|(numbers, _)| {
        numbers.is_empty() || numbers.iter().any(|n| is_number(n, Cause::Movement))
    });
    let again = taking.find_map(|(_, handler)| resumes(handler))?;
    Some(format!(
        "the error handler of its routine may go on within it ({again}) after an error of any kind"
    ))
}

/// The first statement of a handler that goes on where a movement broke off, if an error of a
/// movement leads there.
fn resumes(block: &Block) -> Option<&'static str> {
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
            .find_map(resumes),
        StmtKind::Test { value, cases, default } if is_errno(value) => cases
            .iter()
            .filter(|(values, _)| values.iter().any(|n| is_number(n, Cause::Movement)))
            .map(|(_, block)| block)
            .chain(default)
            .find_map(resumes),
        other => other.blocks().into_iter().find_map(resumes),
    })
}

/// Whether a condition can hold after an error of a cause.
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

/// Whether a number may be that of an error of a cause.
fn is_number(number: &Expr, cause: Cause) -> bool {
    match &number.kind {
        ExprKind::Ref(name) => builtins::error(&name.key) == Some(cause),
        _ => true,
    }
}

/// What connected interrupt routines may do to a movement.
fn interrupts(program: &Program) -> Option<Reason> {
    traps(program).into_iter().find_map(|(trap, reach)| {
        let what = reach.hazard()?;
        Some(Reason::Interrupt(format!(
            "the interrupt routine {trap} is connected somewhere in the program and may run {what} \
             meanwhile"
        )))
    })
}

/// Module data that connected interrupt routines may write.
pub(super) fn written_by_interrupts(program: &Program) -> BTreeSet<DataId> {
    traps(program).into_iter().flat_map(|(_, reach)| reach.written).collect()
}

/// The connected interrupt routines by name, with what they run.
fn traps(program: &Program) -> Vec<(String, Reach)> {
    let mut found = Vec::new();
    for (m, module) in program.modules.iter().enumerate() {
        for block in module.routines.iter().flat_map(Routine::blocks) {
            let mut traps = Vec::new();
            connected(block, &mut traps);
            for trap in traps {
                let mut reach = Reach::default();
                reach.call(program, m, &trap);
                // A list of routines to look at, not a recursion: calls may be deep.
                while let Some(id) = reach.open.pop() {
                    let routine = program.routine(id);
                    for expr in routine.data.iter().filter_map(|data| data.init.as_ref()) {
                        reach.expr(program, id.module, expr);
                    }
                    for block in routine.blocks() {
                        reach.block(program, id.module, block);
                    }
                }
                found.push((trap, reach));
            }
        }
    }
    found
}

fn connected(block: &Block, traps: &mut Vec<String>) {
    for stmt in block {
        if let StmtKind::Connect { trap, .. } = &stmt.kind {
            traps.push(trap.text.clone());
        }
        for inner in stmt.kind.blocks() {
            connected(inner, traps);
        }
    }
}

/// What an interrupt routine runs, directly or not.
#[derive(Default)]
struct Reach {
    /// Routines that were looked at, by module and index.
    seen: BTreeSet<(usize, usize)>,
    /// Routines still to be looked at.
    open: Vec<RoutineId>,
    /// The first instruction that changes movements.
    changes: Option<String>,
    /// The first movement.
    moves: Option<String>,
    /// Whether the path that it interrupts is kept for later.
    stores_path: bool,
    /// Module data that it may write: what it assigns to, and what it hands to other routines.
    written: BTreeSet<DataId>,
}

impl Reach {
    fn hazard(&self) -> Option<&str> {
        let moves = self.moves.as_deref().filter(|_| !self.stores_path);
        self.changes.as_deref().or(moves)
    }

    fn call(&mut self, program: &Program, module: usize, name: &str) {
        let key = name.to_lowercase();
        let Some(Symbol::Routine(id)) = program.resolve(module, &key) else {
            let instruction = builtins::instruction(&key);
            if instruction.is_some_and(|found| found.changes_motion) {
                self.changes.get_or_insert(name.to_owned());
            }
            if instruction.is_some_and(Instruction::finds_by_name) {
                self.changes
                    .get_or_insert(format!("{name}, which finds data or procedures by name"));
            }
            if is_movement(&key) {
                self.moves.get_or_insert(name.to_owned());
            }
            self.stores_path |= key == "storepath";
            let function = builtins::function(&key);
            let is_known = instruction.is_some_and(Instruction::is_known)
                || function.is_some_and(|found| found.source != Source::NotCalculated);
            if !is_known {
                self.changes.get_or_insert(format!("{name}, of which nothing is known here,"));
            }
            return;
        };
        if self.seen.insert((id.module, id.index)) {
            self.open.push(id);
        }
    }

    fn writes(&mut self, program: &Program, module: usize, target: &Expr) {
        if let Some(name) = target.base()
            && let Some(Symbol::Data(id)) = program.resolve(module, &name.key)
        {
            self.written.insert(id);
        }
    }

    /// Functions, too, may write to data, their own arguments among them.
    fn expr(&mut self, program: &Program, module: usize, expr: &Expr) {
        if let ExprKind::Call(name, args) = &expr.kind {
            self.call(program, module, &name.text);
            if !builtins::function(&name.key).is_some_and(Function::only_reads) {
                for arg in args.iter().filter_map(Arg::value) {
                    self.writes(program, module, arg);
                }
            }
        }
        for part in expr.parts() {
            self.expr(program, module, part);
        }
    }

    fn block(&mut self, program: &Program, module: usize, block: &Block) {
        for stmt in block {
            if let StmtKind::Assign { target, .. } = &stmt.kind {
                self.writes(program, module, target);
            }
            if let StmtKind::Call(call) = &stmt.kind {
                let only_reads = matches!(&call.callee, Callee::Name(name)
                    if program.resolve(module, &name.key).is_none() && !may_write(&name.key));
                if !only_reads {
                    for arg in call.args.iter().filter_map(Arg::value) {
                        self.writes(program, module, arg);
                    }
                }
                match &call.callee {
                    Callee::Name(name) => self.call(program, module, &name.text),
                    Callee::Late(_) => {
                        self.changes.get_or_insert("a procedure with a computed name".into());
                    }
                }
            }
            for expr in stmt.kind.exprs() {
                self.expr(program, module, expr);
            }
            for inner in stmt.kind.blocks() {
                self.block(program, module, inner);
            }
        }
    }
}

fn routines(program: &Program) -> impl Iterator<Item = &Routine> {
    program.modules.iter().flat_map(|module| &module.routines)
}

/// Calls `found` with each movement statement of a block.
fn movements(block: &Block, found: &mut dyn FnMut(Span)) {
    for stmt in block {
        if let StmtKind::Call(call) = &stmt.kind
            && let Callee::Name(name) = &call.callee
            && is_movement(&name.key)
        {
            found(stmt.span);
        }
        for inner in stmt.kind.blocks() {
            movements(inner, found);
        }
    }
}

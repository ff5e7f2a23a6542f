//! Runs of several pieces: what the program may do between two pieces.
//!
//! The stream of such a run stands at its last piece. At the pieces before, the movements are put
//! off. That is right only where the program certainly goes on without a stop, an output or another
//! effect; where another statement may come first, the movements are made up for before it.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::files::file_and_line;
use super::guards::Guards;
use crate::rapid::builtins::{instruction, is_movement};
use crate::rapid::ir::graph::Step;
use crate::rapid::ir::hir::{Arg, Callee, Expr, ParamMode, Stmt, StmtKind};
use crate::rapid::ir::program::{Program, RoutineId, Symbol};
use crate::rapid::ir::upcoming::{Quiet, Unknown, Upcoming};
use crate::rapid::text::Span;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::Site;

/// Sets the stops of sites of several pieces, and refuses those that cannot be put off.
/// `error_handler`: why an error between two pieces would be handled.
pub(super) fn mark_pieces(
    program: &Program,
    entry: RoutineId,
    guards: &Guards<'_>,
    error_handler: Option<&Reason>,
    sites: &mut [Site],
) {
    if sites.iter().all(|site| site.pieces.len() == 1) {
        return;
    }
    let between = Between {
        program,
        guards,
        error_handler: error_handler.is_some(),
        shared: RefCell::default(),
    };
    let upcoming = Upcoming::new(program, entry);
    let place = |span: Span| file_and_line(guards.files(), span);
    for site in sites.iter_mut().filter(|site| site.pieces.len() > 1) {
        if site.pieces.len() > MAX_PIECES {
            let many = format!(", in {} pieces; {MAX_PIECES} are possible", site.pieces.len());
            site.refuse(&Reason::Scattered(many));
            continue;
        }
        let stops = site.pieces.windows(2).map(|pair| {
            let after = upcoming.after(pair[0].last, &|id, step| between.quiet(id, step));
            match after {
                Ok(after) if after.contains(&pair[1].first) => Ok(after),
                Ok(after) => Err(Reason::LogicBetween(between.named(after))),
                Err(Unknown::Decision(span)) => Err(Reason::Scattered(format!(
                    ", and {} decides by what may change while the robot moves",
                    place(span)
                ))),
                Err(Unknown::Handler) => {
                    Err(Reason::Scattered(", from a handler that restores a state".to_owned()))
                }
                Err(Unknown::End(id)) => Err(Reason::Scattered(format!(
                    ", and not only a call may start {}",
                    program.routine(id).name.text
                ))),
            }
        });
        match stops.collect::<Result<Vec<_>, _>>() {
            Ok(stops) => site.stops = stops.into_iter().flatten().collect(),
            Err(reason) => site.refuse(&reason),
        }
    }
}

/// Maximum number of pieces: the procedures that make up for them call each other, and a controller
/// has room for a limited number of nested calls. A careful assumption.
const MAX_PIECES: usize = 50;
/// Maximum number of statements that a reason names.
const NAMED: usize = 2;

struct Between<'a, 'p> {
    program: &'p Program,
    guards: &'a Guards<'p>,
    /// Whether the program handles errors of arguments: an error would then come before the
    /// movements that are put off.
    error_handler: bool,
    /// What statements write that others may read meanwhile, in words.
    shared: RefCell<BTreeMap<Span, String>>,
}

impl Between<'_, '_> {
    /// The statements of which one runs between two pieces: not the movements with which another run
    /// goes on.
    fn named(&self, statements: BTreeSet<Span>) -> String {
        let shared = self.shared.borrow();
        let all = self.program.routines().flat_map(|(_, routine)| routine.statements());
        let called = all.filter_map(|stmt| match &stmt.kind {
            StmtKind::Call(call) => match &call.callee {
                Callee::Name(name) => Some((stmt.span, name.text.as_str())),
                Callee::Late(_) => None,
            },
            _ => None,
        });
        let called: BTreeMap<Span, &str> = called.collect();
        let place = |span: Span| {
            let place = file_and_line(self.guards.files(), span);
            let name = called.get(&span).map_or_else(String::new, |name| format!("{name} in "));
            let remark = shared.get(&span).map_or_else(String::new, |text| format!(" ({text})"));
            format!("{name}{place}{remark}")
        };
        let moves = |span: &Span| called.get(span).is_some_and(|name| is_movement(name));
        let (moving, others): (Vec<Span>, Vec<Span>) = statements.into_iter().partition(moves);
        let shown = if others.is_empty() { moving } else { others };
        let places: Vec<String> = shown.into_iter().take(NAMED).map(place).collect();
        format!("{} runs", places.join(" or "))
    }

    /// Whether nobody can tell if a step runs before or during a movement.
    fn quiet(&self, routine: RoutineId, step: Step<'_>) -> Quiet {
        let is_quiet = match step {
            Step::Entry | Step::Exit => true,
            Step::Condition(expr) | Step::Test(expr) => self.is_steady(routine, expr),
            Step::Count(stmt) | Step::Statement(stmt) => self.statement(routine, stmt),
        };
        if is_quiet { Quiet::Yes } else { Quiet::No }
    }

    fn statement(&self, routine: RoutineId, stmt: &Stmt) -> bool {
        let does_no_more = match &stmt.kind {
            StmtKind::Assign { target, .. } => self.is_own(routine, stmt.span, target),
            StmtKind::Call(call) => match &call.callee {
                Callee::Late(_) => false,
                Callee::Name(name) => match self.program.resolve(routine.module, &name.key) {
                    Some(Symbol::Routine(_)) => true,
                    Some(_) => false,
                    None => instruction(&name.key).is_some_and(|it| {
                        let counted = call.args.iter().find_map(Arg::positional);
                        it.counts() && counted.is_some_and(|to| self.is_own(routine, stmt.span, to))
                    }),
                },
            },
            StmtKind::For { .. }
            | StmtKind::Goto(_)
            | StmtKind::Label(_)
            | StmtKind::Return(_)
            | StmtKind::Data(_) => true,
            _ => false,
        };
        does_no_more && stmt.kind.exprs().into_iter().all(|expr| self.is_steady(routine, expr))
    }

    fn is_steady(&self, routine: RoutineId, expr: &Expr) -> bool {
        let may_raise = self.error_handler && self.guards.may_raise_at(routine, expr);
        !may_raise && self.guards.is_steady(routine, expr)
    }

    /// Whether nothing that runs at the same time can see what a statement writes.
    fn is_own(&self, routine: RoutineId, statement: Span, target: &Expr) -> bool {
        let Some(name) = target.base() else { return true };
        let mut params = self.program.routine(routine).params.iter();
        if let Some(param) = params.find(|param| param.name.key == name.key) {
            if param.mode != ParamMode::In {
                let text = format!("writes through the parameter {}", name.text);
                self.shared.borrow_mut().insert(statement, text);
            }
            return param.mode == ParamMode::In;
        }
        match self.program.resolve(routine.module, &name.key) {
            Some(Symbol::Data(id)) => {
                if self.guards.is_read_elsewhere(id) {
                    let data = &self.program.data(id).name.text;
                    let text = format!("writes {data}; --only-task: no other task reads it");
                    self.shared.borrow_mut().insert(statement, text);
                }
                !self.guards.is_seen_meanwhile(id)
            }
            _ => true,
        }
    }
}

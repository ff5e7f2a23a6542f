//! The next actions on every path through a program, across calls and returns.

use std::collections::{BTreeMap, BTreeSet};

use super::quiet::Quiet;
use crate::rapid::builtins::{self, Instruction};
use crate::rapid::ir::graph::{Graph, NodeId, Step, When};
use crate::rapid::ir::hir::{Callee, Stmt, StmtKind};
use crate::rapid::ir::program::{Program, RoutineId, Symbol};

/// Maximum number of visited statements per search.
const MOST_STEPS: usize = 2_000;

/// A statement, given by routine and node of the graph.
pub type Place = (RoutineId, NodeId);

/// A next action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Next {
    /// A movement.
    Move(Place),
    /// An output is set.
    Output(Place),
    /// The program waits.
    Wait(Place),
    /// A statement that may require standstill.
    Other,
    /// The program ends.
    End,
}

/// The meaning of a statement for the movement before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// No effect.
    Quiet,
    /// It moves.
    Move,
    /// It calls a routine of the program.
    Call(RoutineId),
    /// It sets an output.
    Output,
    /// It waits.
    Wait,
    /// It may require standstill.
    Other,
}

/// Statements that a search passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Through {
    /// Statements without effect.
    Quiet,
    /// Statements without effect, and outputs.
    Outputs,
    /// Everything except movements.
    All,
}

/// The control flow of a program.
pub struct Flow<'p> {
    program: &'p Program,
    entry: Option<RoutineId>,
    graphs: BTreeMap<RoutineId, (Graph<'p>, Vec<bool>)>,
    callers: BTreeMap<RoutineId, Vec<Place>>,
    /// Whether some call has a computed name.
    late: bool,
    quiet: Quiet<'p>,
}

impl<'p> Flow<'p> {
    /// The control flow of a program that starts with `entry`, if known.
    pub fn new(program: &'p Program, entry: Option<RoutineId>) -> Flow<'p> {
        let mut graphs = BTreeMap::new();
        for (module, body) in program.modules.iter().enumerate() {
            for (index, routine) in body.routines.iter().enumerate() {
                let graph = Graph::new(routine);
                let reachable = graph.reachable();
                graphs.insert(RoutineId { module, index }, (graph, reachable));
            }
        }
        let quiet = Quiet::new(program);
        let mut flow =
            Flow { program, entry, graphs, callers: BTreeMap::new(), late: false, quiet };
        flow.find_calls();
        flow
    }

    fn find_calls(&mut self) {
        let mut callers: BTreeMap<RoutineId, Vec<Place>> = BTreeMap::new();
        for (id, (graph, _)) in &self.graphs {
            for (node, content) in graph.nodes.iter().enumerate() {
                let Step::Statement(stmt) = content.step else { continue };
                if let StmtKind::Call(call) = &stmt.kind
                    && matches!(call.callee, Callee::Late(_))
                {
                    self.late = true;
                }
                if let Class::Call(callee) = self.class(*id, stmt) {
                    callers.entry(callee).or_default().push((*id, node));
                }
            }
        }
        self.callers = callers;
    }

    /// The graph of a routine.
    pub fn graph(&self, routine: RoutineId) -> &Graph<'p> {
        &self.graphs[&routine].0
    }

    /// The routines with their graphs, in order.
    pub fn graphs(&self) -> impl Iterator<Item = (RoutineId, &Graph<'p>, &[bool])> {
        self.graphs.iter().map(|(id, (graph, reachable))| (*id, graph, reachable.as_slice()))
    }

    /// Whether some call has a computed name.
    pub fn has_late_calls(&self) -> bool {
        self.late
    }

    /// The calls of a routine.
    pub fn callers(&self, routine: RoutineId) -> &[Place] {
        self.callers.get(&routine).map_or(&[], Vec::as_slice)
    }

    /// The statement at a place.
    pub fn statement(&self, (routine, node): Place) -> Option<&'p Stmt> {
        match self.graphs.get(&routine)?.0.nodes.get(node)?.step {
            Step::Statement(stmt) => Some(stmt),
            _ => None,
        }
    }

    /// The meaning of a statement for the movement before it.
    pub fn class(&self, routine: RoutineId, stmt: &Stmt) -> Class {
        let quiet = |is: bool| if is { Class::Quiet } else { Class::Other };
        match &stmt.kind {
            StmtKind::Assign { target, value } => quiet(
                !self.quiet.is_flag(routine, target)
                    && self.quiet.expression(routine, target)
                    && self.quiet.expression(routine, value),
            ),
            StmtKind::Call(call) => {
                let Callee::Name(name) = &call.callee else { return Class::Other };
                let instruction = builtins::instruction(&name.key);
                if instruction.is_some_and(Instruction::is_movement) {
                    return Class::Move;
                }
                match self.program.resolve(routine.module, &name.key) {
                    Some(Symbol::Routine(id)) => return Class::Call(id),
                    Some(_) => return Class::Other,
                    None => {}
                }
                if instruction.is_some_and(Instruction::sets_output) {
                    Class::Output
                } else if name.key.starts_with("wait")
                    || instruction.is_some_and(Instruction::waits_outside)
                {
                    Class::Wait
                } else {
                    let on_the_fly = instruction.is_some_and(|found| found.on_the_fly);
                    quiet(on_the_fly && self.quiet.arguments(routine, &call.args))
                }
            }
            StmtKind::Return(value) => {
                quiet(value.as_ref().is_none_or(|value| self.quiet.expression(routine, value)))
            }
            StmtKind::Goto(_) | StmtKind::Label(_) | StmtKind::Data(_) => Class::Quiet,
            _ => Class::Other,
        }
    }

    /// The next actions after a place, on every path.
    pub fn following(&self, from: Place, through: Through) -> BTreeSet<Next> {
        let mut found = BTreeSet::new();
        let mut seen = BTreeSet::new();
        let mut open: Vec<Place> = Vec::new();
        self.push_next(from, &mut open);
        while let Some(place) = open.pop() {
            if !seen.insert(place) {
                continue;
            }
            if seen.len() > MOST_STEPS {
                found.insert(Next::Other);
                break;
            }
            let (routine, node) = place;
            match self.graph(routine).nodes[node].step {
                Step::Entry | Step::Count => self.push_next(place, &mut open),
                Step::Exit => self.leave(routine, &mut open, &mut found),
                Step::Condition(expr) | Step::Test(expr) => {
                    if through == Through::All || self.quiet.expression(routine, expr) {
                        self.push_next(place, &mut open);
                    } else {
                        found.insert(Next::Other);
                    }
                }
                Step::Statement(stmt) => {
                    let class = self.class(routine, stmt);
                    let passes = match class {
                        Class::Quiet => true,
                        Class::Output => through != Through::Quiet,
                        Class::Wait => through == Through::All,
                        Class::Other => through == Through::All && !self.is_unknown(stmt),
                        Class::Move | Class::Call(_) => false,
                    };
                    if passes {
                        self.push_next(place, &mut open);
                        continue;
                    }
                    match class {
                        Class::Move => found.insert(Next::Move(place)),
                        Class::Output => found.insert(Next::Output(place)),
                        Class::Wait => found.insert(Next::Wait(place)),
                        Class::Call(callee) => {
                            open.push((callee, 0));
                            false
                        }
                        Class::Quiet | Class::Other => found.insert(Next::Other),
                    };
                }
            }
        }
        found
    }

    /// Whether a routine is the entry.
    pub fn is_entry(&self, routine: RoutineId) -> bool {
        self.entry == Some(routine)
    }

    /// Whether the robot position after a statement is unknown.
    pub fn is_loose(&self, routine: RoutineId, stmt: &Stmt) -> bool {
        self.class(routine, stmt) == Class::Other && self.is_unknown(stmt)
    }

    /// Whether a statement may lead anywhere: it calls something outside the files.
    pub fn is_unknown(&self, stmt: &Stmt) -> bool {
        match &stmt.kind {
            StmtKind::Call(call) => match &call.callee {
                Callee::Name(name) => {
                    builtins::instruction(&name.key).is_none_or(Instruction::may_move)
                }
                Callee::Late(_) => true,
            },
            StmtKind::Broken | StmtKind::Placeholder => true,
            _ => false,
        }
    }

    fn push_next(&self, (routine, node): Place, open: &mut Vec<Place>) {
        let next = &self.graph(routine).nodes[node].next;
        let ways = next.iter().filter(|(when, _)| !matches!(when, When::Error | When::Resume));
        open.extend(ways.map(|(_, to)| (routine, *to)));
    }

    /// Continues a search after the calls of a routine.
    fn leave(&self, routine: RoutineId, open: &mut Vec<Place>, found: &mut BTreeSet<Next>) {
        let callers = self.callers(routine);
        if self.entry == Some(routine) || callers.is_empty() {
            found.insert(Next::End);
        } else if self.late {
            found.insert(Next::Other);
        }
        for caller in callers {
            self.push_next(*caller, open);
        }
    }
}

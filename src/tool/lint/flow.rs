//! The next actions on every path through a program, across calls and returns.

use std::collections::{BTreeMap, BTreeSet};

use super::data_names::DataNames;
use super::statements::{called_instruction, called_name};
use crate::rapid::builtins::{self, Instruction};
use crate::rapid::ir::graph::{Graph, NodeId, Step, When};
use crate::rapid::ir::hir::{Call, Callee, Stmt, StmtKind};
use crate::rapid::ir::program::{Program, RoutineId, Symbol};

/// Maximum number of visited statements per search.
const MAX_STEPS: usize = 2_000;

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
    NoEffect,
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

/// What a setting is in force for.
#[derive(Clone, Debug, Default)]
pub struct InForce {
    /// The movements.
    pub movements: BTreeSet<Place>,
    /// The calls that end it.
    pub ends: BTreeSet<Place>,
    /// Whether the program can end before.
    pub runs_out: bool,
}

/// Statements that a search passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Through {
    /// Statements without effect.
    NoEffect,
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
    /// The routines that a routine calls or connects to an interrupt.
    callees: BTreeMap<RoutineId, BTreeSet<RoutineId>>,
    /// Whether some call has a computed name.
    late: bool,
    /// The names that denote data.
    pub data_names: DataNames<'p>,
}

impl<'p> Flow<'p> {
    /// The control flow of a program that starts with `entry`, if known.
    pub fn new(program: &'p Program, entry: Option<RoutineId>) -> Flow<'p> {
        let graphs = program.routines().map(|(id, routine)| {
            let graph = Graph::new(routine);
            let reachable = graph.reachable();
            (id, (graph, reachable))
        });
        let flow = Flow {
            program,
            entry,
            graphs: graphs.collect(),
            callers: BTreeMap::new(),
            callees: BTreeMap::new(),
            late: false,
            data_names: DataNames::new(program),
        };
        let mut callers: BTreeMap<RoutineId, Vec<Place>> = BTreeMap::new();
        let mut callees: BTreeMap<RoutineId, BTreeSet<RoutineId>> = BTreeMap::new();
        let mut late = false;
        for (place, stmt, _) in flow.statements() {
            late |= matches!(stmt.kind, StmtKind::Call(Call { callee: Callee::Late(_), .. }));
            if let Class::Call(callee) = flow.class(place.0, stmt) {
                callers.entry(callee).or_default().push(place);
                callees.entry(place.0).or_default().insert(callee);
            }
            if let StmtKind::Connect { trap, .. } = &stmt.kind
                && let Some(Symbol::Routine(trap)) = program.resolve(place.0.module, &trap.key)
            {
                callees.entry(place.0).or_default().insert(trap);
            }
        }
        Flow { callers, callees, late, ..flow }
    }

    /// The graph of a routine.
    pub fn graph(&self, routine: RoutineId) -> &Graph<'p> {
        &self.graphs[&routine].0
    }

    /// The statements by routine and node, and whether they are reachable.
    pub fn statements(&self) -> impl Iterator<Item = (Place, &'p Stmt, bool)> {
        self.graphs.iter().flat_map(|(id, (graph, reachable))| {
            statements(graph).map(|(node, stmt)| ((*id, node), stmt, reachable[node]))
        })
    }

    /// The statements of a routine.
    pub fn statements_of(&self, routine: RoutineId) -> impl Iterator<Item = &'p Stmt> {
        statements(self.graph(routine)).map(|(_, stmt)| stmt)
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
        let class = |no_effect: bool| if no_effect { Class::NoEffect } else { Class::Other };
        let names = &self.data_names;
        match &stmt.kind {
            StmtKind::Assign { target, value } => class(
                !names.is_flag(routine, target)
                    && names.has_only_data(routine, target)
                    && names.has_only_data(routine, value),
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
                } else if instruction.is_some_and(Instruction::waits) {
                    Class::Wait
                } else {
                    let on_the_fly = instruction.is_some_and(|found| found.on_the_fly);
                    class(on_the_fly && names.have_only_data(routine, &call.args))
                }
            }
            StmtKind::Return(value) => {
                class(value.as_ref().is_none_or(|value| names.has_only_data(routine, value)))
            }
            StmtKind::Goto(_) | StmtKind::Label(_) | StmtKind::Data(_) => Class::NoEffect,
            _ => Class::Other,
        }
    }

    /// The next actions after a place, on every path.
    pub fn following(&self, from: Place, through: Through) -> BTreeSet<Next> {
        let mut found = BTreeSet::new();
        let mut search = Search::default();
        self.push_next(from, &mut search.open);
        while let Some(place) = search.next() {
            if search.seen.len() > MAX_STEPS {
                found.insert(Next::Other);
                break;
            }
            let (routine, node) = place;
            match self.graph(routine).nodes[node].step {
                Step::Entry | Step::Count(_) => self.push_next(place, &mut search.open),
                Step::Exit => self.leave(routine, &mut search.open, &mut found),
                Step::Condition(expr) | Step::Test(expr) => {
                    if through == Through::All || self.data_names.has_only_data(routine, expr) {
                        self.push_next(place, &mut search.open);
                    } else {
                        found.insert(Next::Other);
                    }
                }
                Step::Statement(stmt) => {
                    let all = through == Through::All;
                    let next = match self.class(routine, stmt) {
                        Class::Call(callee) => {
                            search.open.push((callee, 0));
                            continue;
                        }
                        Class::NoEffect => None,
                        Class::Move => Some(Next::Move(place)),
                        Class::Output => {
                            (through == Through::NoEffect).then_some(Next::Output(place))
                        }
                        Class::Wait => (!all).then_some(Next::Wait(place)),
                        Class::Other => (!all || self.is_opaque(stmt)).then_some(Next::Other),
                    };
                    if next.is_none() {
                        self.push_next(place, &mut search.open);
                    }
                    found.extend(next);
                }
            }
        }
        found
    }

    /// The movements that a statement is in force for, and the statements that end it: it is a call of
    /// the instruction `key`, and each further call of that instruction ends it.
    pub fn in_force(&self, from: Place, key: &str) -> InForce {
        let mut found = InForce::default();
        let mut search = Search::default();
        self.push_next(from, &mut search.open);
        while let Some(place) = search.next() {
            let (routine, node) = place;
            let stmt = match self.graph(routine).nodes[node].step {
                Step::Statement(stmt) => stmt,
                Step::Exit => {
                    let mut ends = BTreeSet::new();
                    self.leave(routine, &mut search.open, &mut ends);
                    found.runs_out |= !ends.is_empty();
                    continue;
                }
                _ => {
                    self.push_next(place, &mut search.open);
                    continue;
                }
            };
            if called_name(stmt).is_some_and(|name| name.key == key) {
                found.ends.insert(place);
                continue;
            }
            match self.class(routine, stmt) {
                Class::Call(callee) => {
                    search.open.push((callee, 0));
                    continue;
                }
                Class::Move => {
                    found.movements.insert(place);
                }
                _ => {}
            }
            self.push_next(place, &mut search.open);
        }
        found
    }

    /// Routines that some routines and their interrupts reach.
    pub fn running(&self, from: impl IntoIterator<Item = RoutineId>) -> BTreeSet<RoutineId> {
        let mut found = BTreeSet::new();
        let mut open: Vec<RoutineId> = from.into_iter().collect();
        while let Some(id) = open.pop() {
            if found.insert(id) {
                open.extend(self.callees.get(&id).into_iter().flatten());
            }
        }
        found
    }

    /// Routines that a routine reaches where nothing fails and no interrupt comes.
    pub fn running_normally(&self, from: RoutineId) -> BTreeSet<RoutineId> {
        let mut found = BTreeSet::new();
        let mut search = Search { open: vec![(from, 0)], ..Search::default() };
        while let Some(place) = search.next() {
            found.insert(place.0);
            let called = self.statement(place).map(|stmt| self.class(place.0, stmt));
            if let Some(Class::Call(callee)) = called {
                search.open.push((callee, 0));
            }
            self.push_next(place, &mut search.open);
        }
        found
    }

    /// Whether a routine is the entry.
    pub fn is_entry(&self, routine: RoutineId) -> bool {
        self.entry == Some(routine)
    }

    /// Whether the robot position after a statement is unknown.
    pub fn loses_position(&self, routine: RoutineId, stmt: &Stmt) -> bool {
        self.class(routine, stmt) == Class::Other && self.is_opaque(stmt)
    }

    /// Whether a statement may lead anywhere: it calls something outside the files.
    pub fn is_opaque(&self, stmt: &Stmt) -> bool {
        match &stmt.kind {
            StmtKind::Call(_) => called_instruction(stmt).is_none_or(Instruction::may_move),
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

/// A search for places, each of which is visited once.
#[derive(Default)]
struct Search {
    open: Vec<Place>,
    seen: BTreeSet<Place>,
}

impl Search {
    fn next(&mut self) -> Option<Place> {
        loop {
            let place = self.open.pop()?;
            if self.seen.insert(place) {
                return Some(place);
            }
        }
    }
}

/// The statements of a graph with their nodes.
fn statements<'p>(graph: &Graph<'p>) -> impl Iterator<Item = (NodeId, &'p Stmt)> {
    graph.nodes.iter().enumerate().filter_map(|(node, content)| match content.step {
        Step::Statement(stmt) => Some((node, stmt)),
        _ => None,
    })
}

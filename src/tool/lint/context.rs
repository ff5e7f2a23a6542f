//! The input of rules: a program with its control flow, its trace and its simulated cycle.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use nalgebra::{Isometry3, Vector3};

use super::evaluate::{Change, Cycle, Difference, difference, evaluate};
use super::flow::{Class, Flow, Next, Place, Through};
use super::group::Group;
use super::saving::Evaluation;
use super::site::{Site, constant, facts_of, site};
use super::statements::{called_instruction, called_name};
use super::system::System;
use super::trace::{self, Recording, TraceStep, executions};
use super::work::Work;
use crate::arm::robot::Model;
use crate::rapid::builtins::Instruction;
use crate::rapid::ir::exec::Note;
use crate::rapid::ir::hir::{Call, Expr, Stmt, StmtKind};
use crate::rapid::ir::movement::{Movement, Settings, Target};
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::ir::value::Datum;
use crate::rapid::text::{SourceFile, Span};
use crate::retime::motion::timeline::{MoveRecord, Run};
use crate::retime::path::Leg;

/// The input of rules: one program.
pub struct Context<'c> {
    /// All files, by their ids.
    pub files: &'c [SourceFile],
    /// The modules.
    pub program: &'c Program,
    /// The routine that starts it, if found.
    pub entry: Option<RoutineId>,
    /// The robot, if known.
    pub model: Option<&'c Model>,
    /// Its simulated cycle, if there is one.
    pub cycle: Option<&'c Cycle>,
    /// Its actions in order; empty without an entry.
    pub trace: Vec<TraceStep<'c>>,
    /// Unresolved places.
    pub unresolved: &'c [Note],
    /// Its control flow.
    pub flow: Flow<'c>,
    /// Its movement statements, in the order of the files.
    pub sites: Vec<Site<'c>>,
    /// The configuration of the controller, from a backup.
    pub system: Option<&'c System>,
    by_place: BTreeMap<Place, usize>,
    /// The movements that can precede each movement, regardless of statements between.
    before: Vec<Vec<usize>>,
    /// Movements before which the robot position is unknown.
    unknown_starts: BTreeSet<usize>,
    /// Which movements are next to work.
    pub(super) work: Work,
    /// The steps of the trace at which a process runs.
    pub(super) process_steps: OnceLock<BTreeSet<usize>>,
    /// The steps of the trace at which the robot holds a part.
    pub(super) carrying_steps: OnceLock<BTreeSet<usize>>,
}

/// The corner at the goal of a movement, the worst case of all its executions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Shortest distance to it, m.
    pub before: f64,
    /// Shortest distance from it, m.
    pub after: f64,
    /// Largest change of direction, rad: 0 straight on, π back.
    pub turn: f64,
    /// Largest rotation of the tool on the way to it or from it, rad.
    pub turned: f64,
    /// Larger cosine between the tool axis and the way to or from the goal: 0 across the axis, 1
    /// along it.
    pub along: f64,
    /// Whether the tool arrives along its axis and leaves across it, as at the start of a bead.
    pub goes_in: bool,
    /// Whether it arrives across its axis and leaves along it, as at the end of a bead.
    pub comes_out: bool,
}

/// Maximum number of movements per wait or output in a program with a process.
const MAX_MOVES: usize = 12;
/// Maximum cosine between tool axis and a way across it: tools may lean by 30°.
const ACROSS: f64 = 0.5;
/// Minimum cosine between tool axis and a way in or out.
const ALONG: f64 = 0.3;

impl Corner {
    /// The shorter distance, m.
    pub fn room(&self) -> f64 {
        self.before.min(self.after)
    }
}

impl<'c> Context<'c> {
    /// Analyses the program of a group, with its simulated cycle or else a recording without a
    /// robot.
    pub fn new(
        files: &'c [SourceFile],
        model: Option<&'c Model>,
        program: &'c Program,
        group: &'c Group,
        cycle: Option<&'c Cycle>,
        recording: Option<&'c Recording>,
    ) -> Context<'c> {
        let entry = program.entry(&group.entry);
        let (trace, unresolved): (Vec<TraceStep<'c>>, &[Note]) = match (cycle, recording) {
            (Some(cycle), _) => {
                (trace::of_events(&cycle.simulation.events), &cycle.simulation.unresolved)
            }
            (None, Some(recording)) => (recording.trace(), &recording.notes),
            (None, None) => (Vec::new(), &[]),
        };
        let flow = Flow::new(program, entry);
        let executed = executions(&trace);
        let compact = program.in_compact_ifs();
        let mut sites = Vec::new();
        for (place, stmt, reachable) in flow.statements() {
            let StmtKind::Call(call) = &stmt.kind else { continue };
            let site = site(program, &flow.data_names, place, stmt, call);
            let Some(mut site) = site else { continue };
            site.reachable = reachable;
            site.compact = compact.contains(&stmt.span);
            site.executions = executed.get(&stmt.span).cloned().unwrap_or_default();
            complete(&mut site, &trace);
            sites.push(site);
        }
        sites.sort_by_key(|site| site.stmt.span);
        let by_place: BTreeMap<Place, usize> =
            sites.iter().enumerate().map(|(index, site)| (site.place, index)).collect();
        let mut before = vec![Vec::new(); sites.len()];
        for (index, site) in sites.iter().enumerate() {
            for next in moves_after(&flow, &by_place, site.place) {
                before[next].push(index);
            }
        }
        let unknown_starts = unknown_starts(program, &flow, &by_place);
        let work = Work::new(&flow, &sites, &by_place, &before);
        Context {
            files,
            program,
            entry,
            model,
            cycle,
            trace,
            unresolved,
            flow,
            sites,
            system: group.system.as_ref(),
            by_place,
            before,
            unknown_starts,
            work,
            process_steps: OnceLock::new(),
            carrying_steps: OnceLock::new(),
        }
    }

    /// Whether the robot position before a movement is unknown: at the start of the program or of
    /// an uncalled routine, after an unknown call, after a stop at which somebody may jog, in an
    /// error handler.
    pub fn is_unknown_before(&self, site: usize) -> bool {
        self.unknown_starts.contains(&site)
    }

    /// Whether a movement is in an error handler of its routine.
    pub fn in_handler(&self, site: &Site<'_>) -> bool {
        let routine = self.program.routine(site.place.0);
        let body = routine.body.first().zip(routine.body.last());
        body.is_none_or(|(first, last)| {
            site.stmt.span.start < first.span.start || site.stmt.span.end > last.span.end
        })
    }

    /// The constant value of an expression in a routine.
    pub fn constant(&self, routine: RoutineId, expr: &Expr) -> Option<Datum> {
        constant(self.program, &self.flow.data_names, routine, expr)
    }

    /// Whether the routines of some movements, or the routines they call, contain a process: a
    /// wait, an output, or another action at standstill. A cycle with very many movements per wait
    /// or output counts as a demonstration without a process.
    pub fn has_process(&self, sites: &[usize]) -> bool {
        let moves = self.trace.iter().filter(|step| step.what.moves()).count();
        let rest = self.trace.len() - moves;
        if moves > MAX_MOVES * rest.max(1) {
            return false;
        }
        let mut open: Vec<RoutineId> = sites.iter().map(|site| self.sites[*site].place.0).collect();
        let mut seen: BTreeSet<RoutineId> = BTreeSet::new();
        while let Some(routine) = open.pop() {
            if !seen.insert(routine) {
                continue;
            }
            for stmt in self.flow.statements_of(routine) {
                match self.flow.class(routine, stmt) {
                    Class::Output | Class::Wait => return true,
                    Class::Call(callee) => open.push(callee),
                    Class::Other if self.flow.is_opaque(stmt) => return true,
                    _ => {}
                }
            }
        }
        false
    }

    /// The reachable calls of instructions with this name (lower case).
    pub fn calls(&self, key: &'static str) -> Vec<(Place, &'c Stmt, &'c Call)> {
        let calls = self.flow.statements().filter_map(|(place, stmt, reachable)| {
            let StmtKind::Call(call) = &stmt.kind else { return None };
            let handles_errors = !self.program.routine(place.0).error.is_empty();
            let meant = called_name(stmt)?.key == key && (reachable || handles_errors);
            meant.then_some((place, stmt, call))
        });
        let mut calls: Vec<_> = calls.collect();
        calls.sort_by_key(|(_, stmt, _)| stmt.span);
        calls
    }

    /// Everything that can follow a movement on any path of the control flow.
    pub fn next(&self, site: usize, through: Through) -> BTreeSet<Next> {
        self.flow.following(self.sites[site].place, through)
    }

    /// The movement statement of a next action.
    pub fn movement(&self, next: &Next) -> Option<usize> {
        match next {
            Next::Move(place) => self.by_place.get(place).copied(),
            _ => None,
        }
    }

    /// The movements that can follow a movement, if nothing else can come first.
    pub fn next_moves(&self, site: usize, through: Through) -> Option<Vec<usize>> {
        let next = self.next(site, through);
        let moves = next.iter().map(|next| self.movement(next));
        moves.collect::<Option<Vec<usize>>>().filter(|moves| !moves.is_empty())
    }

    /// Whether all executions of a movement, if there are any, have settings of a kind.
    pub fn always(&self, site: usize, has: impl Fn(&Settings) -> bool) -> bool {
        let mut executions = self.sites[site].executions.iter();
        executions.all(|step| {
            let movement = self.trace[*step].what.movement();
            movement.is_some_and(|movement| has(&movement.settings))
        })
    }

    /// The movement statement of a span.
    pub fn site_of(&self, span: Span) -> Option<usize> {
        self.sites.binary_search_by_key(&span, |site| site.stmt.span).ok()
    }

    /// The movements that can precede a movement, regardless of statements between.
    pub fn before(&self, site: usize) -> &[usize] {
        &self.before[site]
    }

    /// The text of a span.
    pub fn text(&self, span: Span) -> std::borrow::Cow<'c, str> {
        self.files[span.file.0 as usize].text(span)
    }

    /// The first line of a span, from 1.
    pub fn line(&self, span: Span) -> u32 {
        self.files[span.file.0 as usize].position(span.start).line
    }

    /// The simulated movement of a step of the trace.
    pub fn record(&self, step: usize) -> Option<(&'c Run, &'c MoveRecord, &'c Leg)> {
        let (event, index) = self.trace[step].event?;
        let run = trace::run(&self.cycle?.simulation.events[event])?;
        Some((run, &run.moves[index], &run.legs[index]))
    }

    /// The TCP pose at a step of the trace, in one frame for all steps, if known.
    pub fn pose(&self, step: usize) -> Option<Isometry3<f64>> {
        if let Some((_, _, leg)) = self.record(step) {
            return Some(leg.target);
        }
        self.trace[step].what.movement().and_then(pose_of)
    }

    /// The movement steps before and after a step of the trace.
    pub fn neighbours(&self, step: usize) -> Option<(usize, usize)> {
        let moves = |step: &TraceStep<'_>| step.what.moves();
        let before = self.trace[..step].iter().rposition(moves)?;
        let after = step + 1 + self.trace[step + 1..].iter().position(moves)?;
        let known = |step: usize| self.trace[step].what.movement().is_some();
        (known(before) && known(after)).then_some((before, after))
    }

    /// The corner at a movement's goal: worst case over all executions, or over all paths of the
    /// control flow if never executed.
    pub fn corner(&self, site: usize) -> Option<Corner> {
        let executed = &self.sites[site].executions;
        if executed.is_empty() {
            return self.corner_of_text(site);
        }
        let corners = executed.iter().filter_map(|step| {
            let (before, after) = self.neighbours(*step)?;
            Some(corner(&self.pose(before)?, &self.pose(*step)?, &self.pose(after)?))
        });
        let corners: Vec<Corner> = corners.collect();
        // The last movement of the trace has no successor.
        if corners.len() + 1 < executed.len() {
            return None;
        }
        worst(corners)
    }

    fn corner_of_text(&self, site: usize) -> Option<Corner> {
        let pose = |other: usize| -> Option<Isometry3<f64>> {
            let (a, b) = (&self.sites[site], &self.sites[other]);
            let same = a.wobj_key() == b.wobj_key() && a.tool_key() == b.tool_key();
            if same { b.facts.goal.as_ref()?.pose().copied() } else { None }
        };
        let here = pose(site)?;
        let mut corners = Vec::new();
        for before in self.before(site) {
            for after in self.next_moves(site, Through::All)? {
                corners.push(corner(&pose(*before)?, &here, &pose(after)?));
            }
        }
        worst(corners)
    }

    /// The effect of a change of movements or waits on the cycle, if it can be simulated.
    pub fn difference(&self, spans: &[Span], change: &Change<'_>) -> Option<Difference<'_>> {
        difference(self.model?, self.cycle?, spans, change)
    }

    /// The saving of a change of movements or waits in a cycle.
    ///
    /// # Errors
    /// The change saves nothing.
    pub fn evaluate(&self, spans: &[Span], change: &Change<'_>) -> Evaluation {
        match (self.model, self.cycle) {
            (Some(model), Some(cycle)) => evaluate(model, cycle, spans, change),
            _ => Ok(None),
        }
    }
}

/// The target pose of a movement in world coordinates, if the robot holds the tool and the work
/// object is fixed.
fn pose_of(movement: &Movement) -> Option<Isometry3<f64>> {
    match &movement.target {
        Target::Pose(target) if movement.wobj.fixed && movement.tool.robhold => {
            let shift = movement.settings.displacement.unwrap_or_default();
            Some(movement.wobj.frame * shift * target.pose)
        }
        _ => None,
    }
}

/// The movements that can follow a place, whatever comes between.
fn moves_after(flow: &Flow<'_>, by_place: &BTreeMap<Place, usize>, place: Place) -> Vec<usize> {
    let next = flow.following(place, Through::All).into_iter();
    next.filter_map(|next| match next {
        Next::Move(place) => by_place.get(&place).copied(),
        _ => None,
    })
    .collect()
}

/// Whether an operator may move the robot by hand at a statement: the program stops or asks.
fn lets_jog(stmt: &Stmt) -> bool {
    called_instruction(stmt).is_some_and(Instruction::asks_operator)
}

fn unknown_starts(
    program: &Program,
    flow: &Flow<'_>,
    by_place: &BTreeMap<Place, usize>,
) -> BTreeSet<usize> {
    let starts_anywhere = |routine: &RoutineId| {
        flow.callers(*routine).is_empty() || flow.is_entry(*routine) || flow.has_late_calls()
    };
    let entries = program.routines().map(|(id, _)| id).filter(starts_anywhere);
    let mut sources: Vec<Place> = entries.map(|id| (id, 0)).collect();
    let mut starts = BTreeSet::new();
    for (place, stmt, reachable) in flow.statements() {
        if flow.loses_position(place.0, stmt) || lets_jog(stmt) {
            sources.push(place);
        }
        if !reachable {
            starts.extend(by_place.get(&place).copied());
        }
    }
    starts.extend(sources.into_iter().flat_map(|place| moves_after(flow, by_place, place)));
    starts
}

/// Fills unknown facts of a movement from its executions, if they agree.
fn complete(site: &mut Site<'_>, trace: &[TraceStep<'_>]) {
    let movements = site.executions.iter().filter_map(|step| trace[*step].what.movement());
    let mut executions = movements.map(facts_of);
    let Some(mut first) = executions.next() else { return };
    for other in executions {
        first.zone = first.zone.filter(|zone| Some(*zone) == other.zone);
        first.speed = first.speed.filter(|speed| Some(*speed) == other.speed);
        let same = |goal: &super::site::Goal| other.goal.as_ref().is_some_and(|o| goal.is_same(o));
        first.goal = first.goal.filter(same);
    }
    let facts = &mut site.facts;
    facts.zone = facts.zone.or(first.zone);
    facts.speed = facts.speed.or(first.speed);
    facts.goal = facts.goal.take().or(first.goal);
}

fn corner(a: &Isometry3<f64>, b: &Isometry3<f64>, c: &Isometry3<f64>) -> Corner {
    let [a_at, b_at, c_at]: [Vector3<f64>; 3] = [a, b, c].map(|pose| pose.translation.vector);
    let (to, from) = (b_at - a_at, c_at - b_at);
    let turned = a.rotation.angle_to(&b.rotation).max(b.rotation.angle_to(&c.rotation));
    let axis = b.rotation * Vector3::z();
    let [into, out] = [to, from].map(|way| axis.dot(&way) / way.norm().max(f64::MIN_POSITIVE));
    Corner {
        before: to.norm(),
        after: from.norm(),
        turn: to.angle(&from),
        turned,
        along: into.abs().max(out.abs()),
        goes_in: into > ALONG && out.abs() < ACROSS,
        comes_out: into.abs() < ACROSS && out < -ALONG,
    }
}

fn worst(corners: Vec<Corner>) -> Option<Corner> {
    corners.into_iter().reduce(|a, b| Corner {
        before: a.before.min(b.before),
        after: a.after.min(b.after),
        turn: a.turn.max(b.turn),
        turned: a.turned.max(b.turned),
        along: a.along.min(b.along),
        goes_in: a.goes_in || b.goes_in,
        comes_out: a.comes_out || b.comes_out,
    })
}

//! Sites: the places of a program where a stream can replace movements.
//!
//! A site is the sequence of statements that the simulation executed from one stop point to the
//! next. It consists of pieces: neighbouring statements of one list that each run has all of or none.
//! Each distinct execution (another start, other values of loop variables or parameters) is a variant.

use std::collections::{BTreeMap, BTreeSet};

use super::eligibility::eligibility;
use super::reason::Reason;
use crate::rapid::builtins::{Instruction, instruction, is_movement};
use crate::rapid::ir::hir::{Arg, ArgKind, Block, Callee, Expr, ExprKind, Stmt, StmtKind};
use crate::rapid::ir::movement::{Argument, Output};
use crate::rapid::ir::program::Program;
use crate::rapid::text::Span;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::path::joint_path::{DOF, Joints};

/// A place of the program with its variants.
#[derive(Debug)]
pub struct Site {
    /// From the first statement to the last one; the first one, if they stand in two files.
    pub span: Span,
    /// Its pieces in the order of execution.
    pub pieces: Vec<Piece>,
    /// The statements that may come next after a piece, in some execution, and do more than compute.
    pub stops: BTreeSet<Span>,
    /// The distinct variants.
    pub variants: Vec<Variant>,
    /// Why the whole site stays unchanged, if it does.
    pub reason: Option<Reason>,
}

/// Neighbouring statements that each run has all of or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Piece {
    /// Its first statement.
    pub first: Span,
    /// Its last statement.
    pub last: Span,
    /// Number of statements.
    pub count: usize,
}

impl Piece {
    /// From the first statement to the last one.
    pub fn span(&self) -> Span {
        self.first.to(self.last)
    }
}

/// One distinct execution of a site.
#[derive(Debug)]
pub struct Variant {
    /// Indices of its events in the simulation.
    pub events: Vec<usize>,
    /// The distinct arguments of its movements.
    pub arguments: Vec<Argument>,
    /// Why it stays unchanged, if it does.
    pub reason: Option<Reason>,
}

/// Largest number of variants of a site that is rewritten.
const MAX_VARIANTS: usize = 64;
/// Joint angles closer than this are equal, rad.
const SAME_START: f64 = 1e-6;

/// The sites of a simulated program in source order.
pub fn sites(program: &Program, simulation: &Simulation) -> Vec<Site> {
    let places = Places::new(program);
    let cuts = Cuts::new(&places, simulation);
    let mut sites: BTreeMap<Vec<Piece>, Site> = BTreeMap::new();
    let mut first = true;
    let joined = joined_by_repetition(simulation);
    for (index, event) in simulation.events.iter().enumerate() {
        let What::Run(run) = &event.what else { continue };
        let pieces = cuts.pieces(run);
        let (Some(head), Some(tail)) = (pieces.first(), pieces.last()) else { continue };
        let (head, tail) = (head.first, tail.last);
        let reason = eligibility(run, std::mem::take(&mut first))
            .err()
            .or_else(|| places.in_compact_if(run).then_some(Reason::CompactIf))
            .or_else(|| output_in_motion(simulation, index, run.moves.len()))
            .or_else(|| joined.contains(&index).then_some(Reason::FliesOn))
            .or_else(|| places.ends_in_fly_by(run).then(|| flies_on(simulation, index)));
        let is_forward = head.file == tail.file && head.start <= tail.start;
        let span = if is_forward { head.to(tail) } else { head };
        let site = sites.entry(pieces.clone()).or_insert_with(|| Site {
            span,
            pieces,
            stops: BTreeSet::new(),
            variants: Vec::new(),
            reason: None,
        });
        let arguments = arguments(run);
        let known = site.variants.iter_mut().find(|variant| {
            let other = variant.events.first().map(|i| &simulation.events[*i].what);
            matches!(other, Some(What::Run(other)) if same(run, other))
                && variant.arguments == arguments
        });
        match known {
            Some(variant) => {
                variant.events.push(index);
                if variant.reason.is_none() {
                    variant.reason = reason;
                }
            }
            None => site.variants.push(Variant { events: vec![index], arguments, reason }),
        }
    }
    let mut sites: Vec<Site> = sites.into_values().collect();
    for site in &mut sites {
        let n = site.variants.len();
        if n > MAX_VARIANTS && site.reason.is_none() {
            site.reason = Some(Reason::TooManyVariants(n));
        }
    }
    sites
}

/// Marks sites that share a statement, and sites of several pieces: without a guard at each piece
/// only one of the former could be replaced, and none of the latter.
pub fn mark_joined(program: &Program, sites: &mut [Site]) {
    let places = Places::new(program);
    let mut users: BTreeMap<Piece, usize> = BTreeMap::new();
    for piece in sites.iter().flat_map(|site| site.pieces.iter().collect::<BTreeSet<_>>()) {
        *users.entry(*piece).or_default() += 1;
    }
    for site in sites {
        if site.pieces.iter().any(|piece| users[piece] > 1) {
            site.reason.get_or_insert(Reason::Overlapping);
        }
        if site.pieces.len() > 1 {
            site.refuse(&places.between(&site.pieces));
        }
    }
}

impl Site {
    /// Refuses the variants that have no other reason.
    pub fn refuse(&mut self, reason: &Reason) {
        for variant in &mut self.variants {
            variant.reason.get_or_insert_with(|| reason.clone());
        }
    }
}

/// Why an output that is set during the movements of a run prevents a stream. `count`: the number of
/// movements.
fn output_in_motion(simulation: &Simulation, run: usize, count: usize) -> Option<Reason> {
    let before = simulation.events[..run].iter().rev();
    let outputs = before.map_while(|event| match &event.what {
        What::Output(output, under_way) => Some((output, *under_way)),
        _ => None,
    });
    let during: Vec<_> = outputs.filter(|(_, under_way)| *under_way > 0).collect();
    // The output before the others comes last.
    match during.iter().rev().find(|(_, under_way)| *under_way < count) {
        Some((output, _)) => {
            let Output { instruction, signal, .. } = output;
            Some(Reason::LogicBetween(format!("{instruction} {signal} runs")))
        }
        None => (!during.is_empty()).then_some(Reason::EarlyOutput),
    }
}

/// Why the end of a run in a zone prevents a stream. `run`: its event.
fn flies_on(simulation: &Simulation, run: usize) -> Reason {
    let behind = simulation.events[run + 1..].iter();
    let next = behind.map(|event| &event.what).find(|what| !matches!(what, What::Output(..)));
    match next {
        Some(What::Left(next)) if next.moves => Reason::Unresolved(format!(
            "it ends in a zone, and the movement behind it could not be worked out: {}",
            next.reason
        )),
        _ => Reason::FliesOn,
    }
}

/// The last run and the first run of the repetition, if the last movement ends in a fly-by point
/// and both are one run when the program repeats.
fn joined_by_repetition(simulation: &Simulation) -> Vec<usize> {
    let events = || simulation.events.iter().enumerate();
    let runs = || events().filter(|(_, event)| matches!(event.what, What::Run(_)));
    let last = events().rfind(|(_, event)| !matches!(event.what, What::Output(..)));
    let Some((last, event)) = last else { return Vec::new() };
    let flies_on = match &event.what {
        What::Run(run) => run.moves.last().is_some_and(|record| !record.movement.zone.fine),
        _ => false,
    };
    if !flies_on {
        return Vec::new();
    }
    let from = simulation.repeats_from.unwrap_or(0);
    let first = runs().map(|(index, _)| index).find(|index| *index >= from);
    std::iter::once(last).chain(first).collect()
}

/// The settings that a guard compares: `VelSet`, `AccSet`, `SingArea`.
fn settings(run: &Run) -> Option<([f64; 4], bool)> {
    let settings = &run.moves.first()?.movement.settings;
    Some((settings.limits(), settings.axiswise_wrist()))
}

fn same(a: &Run, b: &Run) -> bool {
    let close = |a: &Joints, b: &Joints| (0..DOF).all(|j| (a[j] - b[j]).abs() < SAME_START);
    close(&a.start, &b.start)
        && a.load == b.load
        && settings(a) == settings(b)
        && a.legs.len() == b.legs.len()
        && a.legs
            .iter()
            .zip(&b.legs)
            .all(|(a, b)| close(&a.end, &b.end) && a.speed == b.speed && a.zone == b.zone)
}

fn arguments(run: &Run) -> Vec<Argument> {
    let mut arguments: Vec<Argument> = Vec::new();
    for argument in run.moves.iter().flat_map(|record| &record.movement.arguments) {
        if !arguments.contains(argument) {
            arguments.push(argument.clone());
        }
    }
    arguments
}

/// Statement list and index of each statement.
#[derive(Default)]
struct Places {
    by_span: BTreeMap<Span, (usize, usize)>,
    /// Statements that wait for a time, at which the robot stops.
    stops: BTreeSet<(usize, usize)>,
    /// Statements of compact IFs.
    compact: BTreeSet<Span>,
}

impl Places {
    fn new(program: &Program) -> Places {
        let mut places = Places { compact: program.in_compact_ifs(), ..Places::default() };
        let mut lists = 0;
        for module in &program.modules {
            for routine in &module.routines {
                for block in routine.blocks() {
                    places.block(block, &mut lists);
                }
            }
        }
        places
    }

    fn block(&mut self, block: &Block, lists: &mut usize) {
        let list = *lists;
        *lists += 1;
        for (index, stmt) in block.iter().enumerate() {
            self.by_span.insert(stmt.span, (list, index));
            if is_wait(stmt) {
                self.stops.insert((list, index));
            }
            for inner in stmt.kind.blocks() {
                self.block(inner, lists);
            }
        }
    }

    /// Whether a run ends in a fly-by point without a timed wait after it. A wait for an input that
    /// is already set, or another branch, does not stop the robot.
    fn ends_in_fly_by(&self, run: &Run) -> bool {
        let Some(last) = run.moves.last().filter(|record| !record.movement.zone.fine) else {
            return false;
        };
        let place = self.by_span.get(&last.movement.span);
        place.is_none_or(|(list, index)| !self.stops.contains(&(*list, index + 1)))
    }

    /// Whether a movement of a run is the statement of a compact IF.
    fn in_compact_if(&self, run: &Run) -> bool {
        run.moves.iter().any(|record| self.compact.contains(&record.movement.span))
    }

    /// Whether a statement follows another directly.
    fn is_next(&self, a: Span, b: Span) -> bool {
        match (self.by_span.get(&a), self.by_span.get(&b)) {
            (Some((a, i)), Some((b, k))) => a == b && *k == i + 1,
            _ => false,
        }
    }

    /// Why pieces are not one sequence of statements.
    fn between(&self, pieces: &[Piece]) -> Reason {
        let is_later = |pair: &[Piece]| {
            let place = |span: Span| self.by_span.get(&span);
            match (place(pair[0].last), place(pair[1].first)) {
                (Some((a, i)), Some((b, k))) => a == b && k > i,
                _ => false,
            }
        };
        if pieces.windows(2).all(is_later) {
            Reason::LogicBetween("other statements stand".to_owned())
        } else {
            Reason::Scattered(String::new())
        }
    }
}

/// The statements at which some run is cut: the pieces of all runs begin and end there.
#[derive(Default)]
struct Cuts {
    starts: BTreeSet<Span>,
    ends: BTreeSet<Span>,
}

impl Cuts {
    fn new(places: &Places, simulation: &Simulation) -> Cuts {
        let mut cuts = Cuts::default();
        for event in &simulation.events {
            let What::Run(run) = &event.what else { continue };
            let statements = statements_of(run);
            cuts.starts.extend(statements.first());
            cuts.ends.extend(statements.last());
            for pair in statements.windows(2).filter(|pair| !places.is_next(pair[0], pair[1])) {
                cuts.ends.insert(pair[0]);
                cuts.starts.insert(pair[1]);
            }
        }
        cuts
    }

    /// The pieces of a run.
    fn pieces(&self, run: &Run) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        for statement in statements_of(run) {
            match pieces.last_mut() {
                Some(piece)
                    if !self.starts.contains(&statement) && !self.ends.contains(&piece.last) =>
                {
                    piece.last = statement;
                    piece.count += 1;
                }
                _ => pieces.push(Piece { first: statement, last: statement, count: 1 }),
            }
        }
        pieces
    }
}

fn statements_of(run: &Run) -> Vec<Span> {
    run.moves.iter().map(|record| record.movement.span).collect()
}

/// Whether a statement waits for a time other than 0.
fn is_wait(stmt: &Stmt) -> bool {
    let StmtKind::Call(call) = &stmt.kind else { return false };
    let is_zero = |arg: &Arg| matches!(&arg.kind, ArgKind::Positional(Expr { kind: ExprKind::Num(x), .. }) if *x == 0.0);
    matches!(&call.callee, Callee::Name(name)
        if instruction(&name.key).is_some_and(Instruction::waits_for_time))
        && !call.args.iter().any(is_zero)
}

/// The movement statements that a simulation did not execute.
pub fn not_reached(program: &Program, simulation: &Simulation) -> Vec<Span> {
    let mut ran: BTreeSet<Span> = BTreeSet::new();
    for event in &simulation.events {
        match &event.what {
            What::Run(run) => ran.extend(run.moves.iter().map(|record| record.movement.span)),
            What::Left(unresolved) => {
                ran.insert(unresolved.span);
            }
            What::Wait(_) | What::Output(..) => {}
        }
    }
    let mut spans = Vec::new();
    for module in &program.modules {
        for routine in &module.routines {
            for block in routine.blocks() {
                movements(block, &mut spans);
            }
        }
    }
    spans.retain(|span| !ran.contains(span));
    spans
}

fn movements(block: &Block, spans: &mut Vec<Span>) {
    for stmt in block {
        if let StmtKind::Call(call) = &stmt.kind
            && let Callee::Name(name) = &call.callee
            && is_movement(&name.key)
        {
            spans.push(stmt.span);
        }
        for inner in stmt.kind.blocks() {
            movements(inner, spans);
        }
    }
}

//! What outputs mean that are on for a while: a part is held, or a process runs along a path.

use std::collections::{BTreeMap, BTreeSet};

use super::context::Context;
use super::trace::{Action, TraceStep};
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::Movement;

/// The tool comes out the way it went in where its direction changes by more, rad.
const MIN_TURN_OUT: f64 = 1.65;
/// It goes on along a path where its direction changes by less, rad.
const MAX_TURN_ON: f64 = 0.9;
/// A movement with a part is a joint movement or faster than a process, m/s.
const MIN_SPEED: f64 = 0.25;
/// Fewest movements with a part.
const MIN_MOVES: usize = 2;
/// Loads up to this are none, kg: `load0` has one gram.
pub(super) const NO_LOAD: f64 = 0.01;
/// Most steps between a set and a reset that belong together.
const MAX_STEPS_BETWEEN: usize = 500;

/// The steps that set an output, in order, each with the step that resets it.
pub(super) fn resets(context: &Context<'_>) -> Vec<(usize, usize)> {
    let mut next: BTreeMap<String, usize> = BTreeMap::new();
    let mut found = Vec::new();
    for (step, done) in context.trace.iter().enumerate().rev() {
        let Action::Output(output) = &done.what else { continue };
        let key = output.signal.to_lowercase();
        if output.value == "0" {
            next.insert(key, step);
        } else if !output.instruction.eq_ignore_ascii_case("pulsedo")
            && let Some(off) = next.get(&key).filter(|off| **off - step <= MAX_STEPS_BETWEEN)
        {
            found.push((step, *off));
        }
    }
    found.reverse();
    found
}

/// Whether what is set in a step and reset in another one holds a part between them.
pub(super) fn carries(context: &Context<'_>, step: usize, off: usize) -> bool {
    let mut moves = context.trace[step..off].iter().filter_map(|done| done.what.movement());
    let carries = |movement: &Movement| is_joint(movement) || movement.speed.tcp >= MIN_SPEED;
    if moves.clone().count() < MIN_MOVES || !moves.any(carries) {
        return false;
    }
    let (Some(on), Some(off)) = (end(context, step), end(context, off)) else { return false };
    let goes_on = |end: &End| end.turn.is_some_and(|turn| turn < MAX_TURN_ON);
    let comes_out = |end: &End| end.turn.is_some_and(|turn| turn > MIN_TURN_OUT);
    let ends = [on, off];
    !ends.iter().any(goes_on) && ends.iter().any(comes_out) && ends.iter().any(|end| end.waits)
}

fn is_joint(movement: &Movement) -> bool {
    matches!(movement.form, MoveForm::Joint | MoveForm::AbsJ)
}

/// The steps of the trace at which a process runs: an output is on that holds no part, and from its
/// set to its reset the robot makes lines and arcs only.
fn process_steps(context: &Context<'_>) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for (on, off) in resets(context) {
        let moves = || context.trace[on..off].iter().filter_map(|done| done.what.movement());
        if moves().next().is_some() && !moves().any(is_joint) && !carries(context, on, off) {
            found.extend(on..off);
        }
    }
    found
}

/// The steps of the trace between a set and a reset that hold a part.
fn carrying_steps(context: &Context<'_>) -> BTreeSet<usize> {
    let carrying = |(on, off): &(usize, usize)| carries(context, *on, *off);
    resets(context).into_iter().filter(carrying).flat_map(|(on, off)| on..off).collect()
}

impl Context<'_> {
    /// Whether the robot holds a part in some execution of a movement.
    pub(super) fn carries_part(&self, site: usize) -> bool {
        let steps = self.carrying_steps.get_or_init(|| carrying_steps(self));
        self.sites[site].executions.iter().any(|step| {
            let movement = self.trace[*step].what.movement();
            let load = movement.and_then(|movement| movement.settings.grip_load);
            steps.contains(step) || load.is_some_and(|load| load.mass > NO_LOAD)
        })
    }

    /// Whether a process runs in some execution of a movement.
    pub(super) fn is_in_process(&self, site: usize) -> bool {
        let steps = self.process_steps.get_or_init(|| process_steps(self));
        self.sites[site].executions.iter().any(|step| steps.contains(step))
    }
}

/// Where an output is set or reset.
struct End {
    /// The change of the tool's direction there, rad, if it is known.
    turn: Option<f64>,
    /// Whether the robot waits there.
    waits: bool,
}

/// The place at which the robot stands in a step; `None` if it passes.
fn end(context: &Context<'_>, step: usize) -> Option<End> {
    let moved = |done: &TraceStep<'_>| done.what.moves();
    let here = context.trace[..step].iter().rposition(moved)?;
    let out = step + context.trace[step..].iter().position(moved)?;
    context.trace[here].what.movement().filter(|movement| movement.zone.fine)?;
    let into = context.trace[..here].iter().rposition(moved);
    let pose = |step: usize| Some(context.pose(step)?.translation.vector);
    let turn = || {
        let [a, b, c] = [pose(into?)?, pose(here)?, pose(out)?];
        Some((b - a).angle(&(c - b)))
    };
    let waits = context.trace[here..out].iter().any(|d| matches!(d.what, Action::Wait(..)));
    Some(End { turn: turn(), waits })
}

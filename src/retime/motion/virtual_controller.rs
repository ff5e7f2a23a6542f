//! The virtual controller: executes a program and lays its movements on a time line.

mod draft;
mod load;
mod replay;
mod time_limit;

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Isometry3;
use rayon::prelude::*;

use draft::{Draft, RunDraft, WaitDraft};
use load::{effective_load, gripped, gripping};
pub use replay::{Step, replay};

use super::controller::assumed;
use super::run_plan::Planned;
use super::timeline::{Event, MoveRecord, Run, Simulation, WaitBasis, WaitRecord, What};
use crate::arm::dynamics::Load;
use crate::arm::kinematics::{Conf, Tcp, fk, ik_conf, ik_near, limits_ok};
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::exec::{Machine, Note, Waited, execute};
use crate::rapid::ir::movement::{Movement, Output, Stop, Target, Tool, Unresolved, Wait};
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::text::Span;
use crate::retime::path::joint_path::{DOF, Joints};
use crate::retime::path::{Leg, LegKind, arrival};

/// What a simulation needs besides the program and the robot.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Where the robot stands at first, rad; otherwise at the target of the first movement if
    /// that is a `MoveAbsJ`, else at zero.
    pub start: Option<Joints>,
    /// Seconds after which an input comes, by lower-case name: counted from the start of the
    /// cycle or from the end of the last wait for it.
    pub inputs: BTreeMap<String, f64>,
    /// Levels of inputs, by lower-case name.
    pub levels: BTreeMap<String, f64>,
    /// Override of all speeds, 1 = 100 %.
    pub speed_override: Option<f64>,
    /// How often the loop that never ends runs; once where it is not said.
    pub passes: Option<u32>,
    /// Time after which the simulation ends, s.
    pub max_time: Option<f64>,
}

/// Time after which a simulation ends where nothing else is said, s: ten hours.
pub const MAX_TIME: f64 = 36_000.0;

/// Runs a program on the virtual controller.
pub fn simulate(
    program: &Program,
    entry: RoutineId,
    model: &Model,
    options: &Options,
) -> Simulation {
    let mut machine = VirtualController::new(model, options);
    let execution = execute(program, entry, &mut machine);
    machine.flush();
    machine.lay_out();
    machine.tell_length();
    let mut assumptions = execution.assumed;
    assumptions.append(&mut machine.assumed);
    assumptions.extend(assumed(model).filter(|_| machine.moved));
    let mut unresolved = execution.unresolved;
    unresolved.append(&mut machine.notes);
    unresolved.sort_by_key(|note| note.span);
    let count = machine.events.len();
    Simulation {
        events: machine.events,
        cycle_s: machine.time,
        repeats_from: machine.repeats_from.filter(|first| *first < count),
        unresolved,
        assumed: assumptions,
        inputs_asked: machine.asked,
    }
}

/// A movement whose geometry is solved and that waits for the rest of its run.
struct Pending {
    movement: Movement,
    leg: Leg,
}

struct VirtualController<'a> {
    model: &'a Model,
    options: &'a Options,
    /// Where the robot stands, or will once the pending movements are done.
    q: Joints,
    /// False after something that may have moved the robot elsewhere, as far as laid out.
    certain: bool,
    /// How long the robot rests after the last run before it can move on, s.
    settling: f64,
    /// True once what is laid out lasts too long.
    late: bool,
    moved: bool,
    /// Tool of the last movement.
    tool: Option<Tool>,
    time: f64,
    events: Vec<Event>,
    pending: Vec<Pending>,
    /// Time that the pending movements take at their speeds, s.
    pending_s: f64,
    /// Time by which the logic is ahead of the motion (`\Conc`), s.
    ahead: f64,
    /// How the wait that was laid out last ended.
    waited_last: Waited,
    /// What was assumed about the controller on the way.
    assumed: Vec<String>,
    /// What is not on the time line yet: each becomes one event.
    drafts: Vec<Draft>,
    notes: Vec<Note>,
    repeats_from: Option<usize>,
    /// End of the last wait for each input.
    waited: BTreeMap<String, f64>,
    /// Lower-case names of the inputs that were waited for.
    asked: BTreeSet<String>,
    /// Movements that were told.
    moves: usize,
}

/// Drafts that are planned together: they share the processors, and an endless program does not
/// run far beyond the time at which it is stopped.
const BATCH: usize = 256;

/// Time constant with which the error of the servos dies away at a stop point, s. Chosen: position
/// loops of such robots close at some 20/s; no measurement of stop points with `inpos` is known.
const SERVO_S: f64 = 0.05;

/// Events of a simulation: more are not kept.
const MAX_EVENTS: usize = 200_000;
/// Movements of a simulation: their motions take memory.
const MAX_MOVES: usize = 50_000;

impl Machine for VirtualController<'_> {
    fn moves(&mut self, movement: Result<Movement, Unresolved>) {
        self.moves += 1;
        let movement = match movement {
            Ok(movement) => movement,
            Err(unresolved) => {
                self.flush();
                if unresolved.moves {
                    self.keep(Draft::Left(unresolved));
                }
                return;
            }
        };
        let first = !std::mem::replace(&mut self.moved, true);
        if first
            && self.options.start.is_none()
            && let Target::Joints(q) = &movement.target
        {
            self.q = *q;
        }
        match self.leg(&movement) {
            Ok(leg) => {
                self.q = leg.end;
                self.tool = Some(gripping(&movement));
                let fine = leg.zone.fine;
                self.pending_s += self.time_at_speed(&leg, &movement);
                self.pending.push(Pending { movement, leg });
                if fine {
                    self.flush();
                } else {
                    self.flush_if_late();
                }
            }
            Err(reason) => {
                self.flush();
                self.note(movement.span, &reason);
                let left = Unresolved { span: movement.span, reason, moves: true };
                self.keep(Draft::Left(left));
            }
        }
    }

    fn waits(&mut self, wait: Wait) -> Waited {
        self.flush();
        let may_time_out = wait.max_time.is_some() && self.input_at(&wait).is_some();
        let load = self
            .tool
            .as_ref()
            .map_or_else(Load::none, |tool| gripped(tool, wait.grip_load.as_ref()));
        self.keep(Draft::Wait(Box::new(WaitDraft { wait, q: self.q, load })));
        if !may_time_out {
            return Waited::Ended;
        }
        self.lay_out();
        self.waited_last
    }

    fn sets(&mut self, output: Output) {
        // Fly-by movements go on while the logic runs; the place in the order is kept.
        let position = self.pending.len();
        self.keep(Draft::Output(output, position));
    }

    fn joints(&mut self) -> Option<Joints> {
        if !self.pending.is_empty() {
            return None;
        }
        self.lay_out();
        self.certain.then_some(self.q)
    }

    fn flange(&self, q: &Joints) -> Option<Isometry3<f64>> {
        Some(self.model.kinematics.base * fk(self.model, q))
    }

    fn override_percent(&self) -> f64 {
        100.0 * self.options.speed_override.unwrap_or(1.0)
    }

    fn robot(&self) -> Option<String> {
        Some(self.model.type_name().to_owned())
    }

    fn repeats(&mut self) {
        // What is pending becomes the next event, and its end belongs to the loop.
        self.repeats_from.get_or_insert(self.events.len() + self.drafts.len());
    }

    fn leaves_loop(&mut self) {
        self.repeats_from = None;
    }

    fn has_come(&mut self, signal: &str) -> Option<bool> {
        let key = signal.to_lowercase();
        let at = self.comes_at(signal)?;
        let come = self.time + self.pending_s >= at;
        if come {
            self.waited.insert(key, at);
        }
        Some(come)
    }

    fn comes_at(&mut self, signal: &str) -> Option<f64> {
        let key = signal.to_lowercase();
        let delay = self.options.inputs.get(&key).copied();
        self.asked.insert(key.clone());
        let delay = delay?;
        self.lay_out();
        Some(self.waited.get(&key).copied().unwrap_or(0.0) + delay)
    }

    fn passes(&self) -> u32 {
        self.options.passes.unwrap_or(1)
    }

    fn stated_level(&self, signal: &str) -> Option<f64> {
        self.options.levels.get(signal).copied()
    }

    fn is_full(&self) -> bool {
        self.is_long() || self.late
    }
}

impl<'a> VirtualController<'a> {
    fn new(model: &'a Model, options: &'a Options) -> VirtualController<'a> {
        VirtualController {
            model,
            options,
            q: options.start.unwrap_or([0.0; DOF]),
            certain: true,
            settling: 0.0,
            late: false,
            moved: false,
            tool: None,
            time: 0.0,
            events: Vec::new(),
            pending: Vec::new(),
            pending_s: 0.0,
            ahead: 0.0,
            waited_last: Waited::Ended,
            assumed: Vec::new(),
            drafts: Vec::new(),
            notes: Vec::new(),
            repeats_from: None,
            waited: BTreeMap::new(),
            asked: BTreeSet::new(),
            moves: 0,
        }
    }

    /// The override of speeds by `VelSet`, `SpeedRefresh` and the user.
    fn speed_override(&self, movement: &Movement) -> f64 {
        let settings = &movement.settings;
        settings.speed_override * settings.refresh * self.options.speed_override.unwrap_or(1.0)
    }

    /// `\T` under the overrides: 50 % takes twice the time.
    fn timed(&self, movement: &Movement) -> Option<f64> {
        movement.time.map(|t| t / self.speed_override(movement))
    }

    fn note(&mut self, span: Span, reason: &str) {
        let note = Note { span, reason: reason.to_owned() };
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    fn push(&mut self, duration: f64, what: What) {
        self.events.push(Event { t_start: self.time, duration, what });
        self.time += duration;
    }

    /// Solves where a movement goes.
    fn leg(&self, movement: &Movement) -> Result<Leg, String> {
        if movement.wobj.robhold == movement.tool.robhold {
            let both = if movement.tool.robhold { "both tool and work" } else { "neither" };
            return Err(format!("the robot holds {both}: robhold of tool or work object is wrong"));
        }
        if !movement.wobj.fixed {
            return Err("a work object on a moving mechanical unit is not simulated".into());
        }
        // What does not move with the robot is stated in the world, solved in its base frame.
        let world = self.model.kinematics.base.inverse();
        let held = movement.tool.robhold;
        // A program displacement moves the targets in the object's frame.
        let displacement = movement.settings.displacement.unwrap_or_else(Isometry3::identity);
        let object = movement.wobj.frame * displacement;
        let base = if held { world * object } else { object };
        let frame = movement.tool.frame;
        let tool = if held { Tcp::Held(frame) } else { Tcp::Stationary(world * frame) };
        let near = |pose: &Isometry3<f64>| {
            ik_near(self.model, pose, &self.q).map_err(|error| error.to_string())
        };
        let mut stated_end = true;
        let (kind, end, target) = match &movement.target {
            Target::Joints(q) => {
                limits_ok(self.model, q).map_err(|error| error.to_string())?;
                (LegKind::Joint, *q, tool.pose(&fk(self.model, q)))
            }
            Target::Pose(target) => {
                let pose = base * target.pose;
                let flange = tool.flange(&pose);
                let linear = movement.form != MoveForm::Joint;
                let stated = if linear {
                    movement.settings.conf_linear
                } else {
                    movement.settings.conf_joint
                };
                let end = if stated {
                    let [cf1, cf4, cf6, cfx] = target.conf;
                    let conf = Conf { cf1, cf4, cf6, cfx };
                    ik_conf(self.model, &flange, conf).map_err(|error| error.to_string())?
                } else {
                    near(&flange)?
                };
                let kind = match (movement.form, &movement.via) {
                    (MoveForm::Circular, Some(via)) => LegKind::Arc(base * via.pose),
                    (MoveForm::Linear, _) => LegKind::Line,
                    _ => LegKind::Joint,
                };
                stated_end = stated || !linear;
                (kind, end, pose)
            }
        };
        let mut speed = movement.speed;
        let factor = self.speed_override(movement);
        speed.tcp = (speed.tcp * factor).min(movement.settings.speed_max);
        speed.orientation *= factor;
        let axiswise = movement.settings.axiswise_wrist();
        let zone = movement.zone;
        let mut leg = Leg { kind, start: self.q, end, tool, target, axiswise, speed, zone };
        if !stated_end && !axiswise {
            // The configuration in which the line arrives.
            leg.end = arrival(self.model, &leg).unwrap_or(end);
        }
        Ok(leg)
    }

    /// Keeps the pending movements as one run to a stop.
    fn flush(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        self.pending_s = 0.0;
        let Some(first) = pending.first() else { return };
        let settings = first.movement.settings.clone();
        let load = effective_load(&first.movement);
        let times = pending.iter().map(|p| self.timed(&p.movement)).collect();
        let (movements, legs) = pending.into_iter().map(|p| (p.movement, p.leg)).unzip();
        self.keep(Draft::Run(Box::new(RunDraft { movements, legs, times, load, settings })));
    }

    fn keep(&mut self, draft: Draft) {
        self.drafts.push(draft);
        if self.drafts.len() >= BATCH {
            self.lay_out();
        }
    }

    /// Plans what is kept, runs side by side, and lays it on the time line.
    fn lay_out(&mut self) {
        let model = self.model;
        let drafts = std::mem::take(&mut self.drafts);
        let plans: Vec<Option<Planned>> = drafts
            .par_iter()
            .map(|draft| match draft {
                Draft::Run(run) => Some(run.plan(model)),
                _ => None,
            })
            .collect();
        for (draft, plan) in drafts.into_iter().zip(plans) {
            if self.late {
                break;
            }
            match (draft, plan) {
                (Draft::Run(run), Some(plan)) => self.lay_run(*run, plan),
                (Draft::Wait(wait), _) => self.lay_wait(*wait),
                (Draft::Output(output, position), _) => {
                    self.push(0.0, What::Output(output, position));
                }
                (Draft::Left(left), _) => {
                    self.certain = false;
                    self.push(0.0, What::Left(left));
                }
                (Draft::Run(_), None) => unreachable!("every run is planned"),
            }
            self.late = self.late || self.time > self.max_time();
        }
    }

    fn lay_run(&mut self, run: RunDraft, plan: Planned) {
        let (run, plan) = self.in_time(run, plan);
        let RunDraft { movements, legs, load, .. } = run;
        let Planned { motions, mut pieces, problem, settling_s } = plan;
        let stands = movements.last().map_or(0.0, |movement| self.stands(movement));
        if let Some((duration, _)) = pieces.last_mut() {
            *duration += stands;
        }
        // The logic goes on when a movement with \Conc begins.
        let under_way = movements.iter().zip(&pieces).rev();
        let under_way = under_way.take_while(|(movement, _)| movement.concurrent);
        let ahead: f64 = under_way.map(|(_, (duration, _))| duration).sum();
        let all = movements.iter().all(|movement| movement.concurrent);
        self.ahead = if all { self.ahead + ahead } else { ahead };
        if let Some((leg, reason)) = &problem {
            self.note(movements[*leg].span, reason);
        }
        let mut records = Vec::with_capacity(movements.len());
        let mut t = 0.0;
        for (movement, (duration, pace)) in movements.into_iter().zip(pieces) {
            records.push(MoveRecord { movement, t_start: t, duration, pace });
            t += duration;
        }
        let run = Run {
            moves: records,
            load,
            start: legs[0].start,
            end: legs[legs.len() - 1].end,
            legs,
            motions,
            settling: stands,
            start_known: self.certain,
            problem: problem.map(|(_, reason)| reason),
        };
        // An output between fly-by movements was noted when the run was not planned yet: it
        // keeps its place in the order before the run's event.
        // Wherever the first movement comes from, it ends where it is told to.
        let first = !self.events.iter().any(|event| matches!(event.what, What::Run(_)));
        self.certain = run.problem.is_none() || (first && self.options.start.is_none());
        if t > 0.0 {
            self.settle();
        }
        self.settling = settling_s;
        self.push(t, What::Run(Box::new(run)));
    }

    /// Between two movements the robot rests at the stop point. A wait takes that time too.
    fn settle(&mut self) {
        let settling = self.settling;
        let own = self.events.iter().rev().take_while(|event| event.is_within_next_run()).count();
        let at = self.events.len() - own;
        let (events, own) = self.events.split_at_mut(at);
        let Some(Event { duration, what: What::Run(before), .. }) = events.last_mut() else {
            return;
        };
        let Some(last) = before.moves.last_mut().filter(|_| *duration > 0.0) else { return };
        before.settling += settling;
        last.duration += settling;
        *duration += settling;
        for event in own {
            event.t_start += settling;
        }
        self.time += settling;
    }

    /// When what a wait waits for comes, s from the start, if the user states it.
    /// When the input of a wait comes, if that is stated, s.
    fn input_at(&self, wait: &Wait) -> Option<f64> {
        let key = wait.signal.as_ref()?.to_lowercase();
        let delay = self.options.inputs.get(&key)?;
        Some(self.waited.get(&key).copied().unwrap_or(0.0) + delay)
    }

    /// Time that the robot stands at a stop point besides settling, s.
    fn stands(&mut self, movement: &Movement) -> f64 {
        match movement.stop {
            Stop::Fine => 0.0,
            Stop::Time(time) => time,
            Stop::InPosition { share, least, most } => {
                let text = format!(
                    "at stop points with inpos the error of the servos dies away over {SERVO_S} s"
                );
                if !self.assumed.contains(&text) {
                    self.assumed.push(text);
                }
                // The error that `fine` allows is reached without a wait; it dies away from there.
                let longer = if share > 0.0 { -SERVO_S * share.ln() } else { f64::INFINITY };
                longer.max(0.0).clamp(least, most)
            }
        }
    }

    fn lay_wait(&mut self, WaitDraft { wait, q, load }: WaitDraft) {
        // What the logic does while a movement with \Conc is under way takes no time of its own.
        let begin = self.time - self.ahead;
        self.waited_last = Waited::Ended;
        let (length, basis) = match (wait.duration, self.input_at(&wait)) {
            (Some(duration), _) => (duration, WaitBasis::Stated),
            (None, Some(at)) => {
                let rest = (at - begin).max(0.0);
                match wait.max_time {
                    Some(most) if most < rest => {
                        self.waited_last = Waited::TimedOut;
                        (most, WaitBasis::Stated)
                    }
                    _ => (rest, WaitBasis::Input),
                }
            }
            (None, None) => {
                let what = match (&wait.signal, &wait.other) {
                    (Some(signal), _) => format!(
                        "{signal}, at a time that is not known: taken as 0 s \
                         (--input {signal}=SECONDS states it)"
                    ),
                    (None, Some(other)) => format!("{other}: taken as 0 s"),
                    (None, None) => {
                        "a condition, at a time that is not known: taken as 0 s".to_owned()
                    }
                };
                self.note(wait.span, &format!("waits for {what}"));
                (0.0, WaitBasis::Unknown)
            }
        };
        if let Some(signal) = &wait.signal {
            self.asked.insert(signal.to_lowercase());
        }
        if let Some(signal) = wait.signal.as_ref().filter(|_| self.waited_last == Waited::Ended) {
            self.waited.insert(signal.to_lowercase(), begin + length);
        }
        let duration = (length - self.ahead).max(0.0);
        self.ahead = (self.ahead - length).max(0.0);
        let record = WaitRecord { wait, basis, q, load, position_known: self.certain };
        self.push(duration, What::Wait(Box::new(record)));
    }
}

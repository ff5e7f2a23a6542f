//! The virtual controller: executes a program and lays its movements on a time line.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{Isometry3, Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::controller::{Planning, assumed, motion_limits};
use super::planner::plan;
use super::sampling::{Loaded, SpeedCap};
use super::stream::Stream;
use super::timed::TimedMotion;
use super::timeline::{Event, MoveRecord, Run, Simulation, WaitBasis, WaitRecord, What};
use crate::dynamics::Load;
use crate::ir::exec::{Machine, Note, execute};
use crate::ir::instructions::MoveForm;
use crate::ir::movement::{LoadData, Movement, Output, Target, Tool, Unresolved, Wait};
use crate::ir::program::{Program, RoutineId};
use crate::kinematics::{Conf, Tcp, fk, ik_conf, ik_near, limits_ok};
use crate::path::joint_path::{DOF, Joints};
use crate::path::{Leg, LegKind, build};
use crate::robot::Model;

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
    let mut machine = VirtualController {
        model,
        options,
        q: options.start.unwrap_or([0.0; DOF]),
        certain: true,
        moved: false,
        tool: None,
        time: 0.0,
        events: Vec::new(),
        pending: Vec::new(),
        notes: Vec::new(),
        repeats_from: None,
        waited: BTreeMap::new(),
    };
    let execution = execute(program, entry, &mut machine);
    machine.flush();
    let mut assumptions = execution.assumed;
    assumptions.extend(assumed(model).filter(|_| machine.moved));
    let mut unresolved = execution.unresolved;
    unresolved.append(&mut machine.notes);
    unresolved.sort_by_key(|note| note.span);
    Simulation {
        events: machine.events,
        cycle_s: machine.time,
        repeats_from: machine.repeats_from,
        unresolved,
        assumed: assumptions,
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
    /// False after something that may have moved the robot elsewhere.
    certain: bool,
    moved: bool,
    /// Tool of the last movement.
    tool: Option<Tool>,
    time: f64,
    events: Vec<Event>,
    pending: Vec<Pending>,
    notes: Vec<Note>,
    repeats_from: Option<usize>,
    /// End of the last wait for each input.
    waited: BTreeMap<String, f64>,
}

/// Events of a simulation: more are not kept.
const MAX_EVENTS: usize = 200_000;

impl Machine for VirtualController<'_> {
    fn moves(&mut self, movement: Result<Movement, Unresolved>) {
        let movement = match movement {
            Ok(movement) => movement,
            Err(unresolved) => {
                self.flush();
                if unresolved.moves {
                    self.certain = false;
                    self.push(0.0, What::Left(unresolved));
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
                self.pending.push(Pending { movement, leg });
                if fine {
                    self.flush();
                }
            }
            Err(reason) => {
                self.flush();
                self.note(movement.span, &reason);
                self.certain = false;
                let left = Unresolved { span: movement.span, reason, moves: true };
                self.push(0.0, What::Left(left));
            }
        }
    }

    fn waits(&mut self, wait: Wait) {
        self.flush();
        let begin = self.time;
        let known = wait.signal.as_ref().and_then(|signal| {
            let key = signal.to_lowercase();
            let delay = self.options.inputs.get(&key)?;
            Some(self.waited.get(&key).copied().unwrap_or(0.0) + delay)
        });
        let (duration, basis) = match (wait.duration, known) {
            (Some(duration), _) => (duration, WaitBasis::Stated),
            (None, Some(at)) => ((at - begin).max(0.0), WaitBasis::Input),
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
            self.waited.insert(signal.to_lowercase(), begin + duration);
        }
        let load = self
            .tool
            .as_ref()
            .map_or_else(Load::none, |tool| gripped(tool, wait.grip_load.as_ref()));
        let record = WaitRecord { wait, basis, q: self.q, load, position_known: self.certain };
        self.push(duration, What::Wait(Box::new(record)));
    }

    fn sets(&mut self, output: Output) {
        // Fly-by movements go on while the logic runs; the place in the order is kept.
        let position = self.pending.len();
        self.push(0.0, What::Output(output, position));
    }

    fn joints(&mut self) -> Option<Joints> {
        (self.pending.is_empty() && self.certain).then_some(self.q)
    }

    fn repeats(&mut self) {
        // What is pending becomes the next event, and its end belongs to the loop.
        self.repeats_from.get_or_insert(self.events.len());
    }

    fn passes(&self) -> u32 {
        self.options.passes.unwrap_or(1)
    }

    fn stated_level(&self, signal: &str) -> Option<f64> {
        self.options.levels.get(signal).copied()
    }

    fn is_full(&self) -> bool {
        self.events.len() + self.pending.len() > MAX_EVENTS || self.is_late()
    }

    fn full_because(&self) -> Option<String> {
        let limit = self.options.max_time.unwrap_or(MAX_TIME);
        self.is_late().then(|| format!("the cycle lasts longer than {limit} s (--max-time)"))
    }
}

impl VirtualController<'_> {
    fn is_late(&self) -> bool {
        self.time > self.options.max_time.unwrap_or(MAX_TIME)
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

    fn note(&mut self, span: crate::text::Span, reason: &str) {
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
        let object = movement.settings.displacement.unwrap_or_else(Isometry3::identity)
            * movement.wobj.frame;
        let base = if held { world * object } else { object };
        let frame = movement.tool.frame;
        let tool = if held { Tcp::Held(frame) } else { Tcp::Stationary(world * frame) };
        let near = |pose: &Isometry3<f64>| {
            ik_near(self.model, pose, &self.q).map_err(|error| error.to_string())
        };
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
                (kind, end, pose)
            }
        };
        let mut speed = movement.speed;
        let factor = self.speed_override(movement);
        speed.tcp = (speed.tcp * factor).min(movement.settings.speed_max);
        speed.orientation *= factor;
        Ok(Leg { kind, start: self.q, end, tool, target, speed, zone: movement.zone })
    }

    /// Plans the pending movements as one run to a stop.
    fn flush(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        let (Some(first), Some(last)) = (pending.first(), pending.last()) else { return };
        let start = first.leg.start;
        let end = last.leg.end;
        let settings = first.movement.settings.clone();
        let planning = Planning::new(self.model, &settings);
        let load = effective_load(&first.movement);
        let legs: Vec<Leg> = pending.iter().map(|p| p.leg.clone()).collect();
        let movements: Vec<Movement> = pending.into_iter().map(|p| p.movement).collect();
        let loaded = Loaded { model: self.model, load: &load };

        let (motions, durations, problem) = match self.as_stream(&start, &legs, &movements) {
            Some(stream) => self.realise(stream, &movements),
            None => self.plan_run(loaded, &legs, &movements, &planning),
        };
        if let Some((leg, reason)) = &problem {
            self.note(movements[*leg].span, reason);
        }
        let moved = durations.iter().sum::<f64>() > 0.0;
        let mut records = Vec::with_capacity(movements.len());
        let mut t = 0.0;
        for (movement, duration) in movements.into_iter().zip(durations) {
            records.push(MoveRecord { movement, t_start: t, duration });
            t += duration;
        }
        let run = Run {
            moves: records,
            legs,
            motions,
            load,
            start,
            end,
            settling: 0.0,
            start_known: self.certain,
            problem: problem.map(|(_, reason)| reason),
        };
        // An output between fly-by movements was noted when the run was not planned yet: it
        // keeps its place in the order before the run's event.
        self.certain = run.problem.is_none();
        if moved {
            self.settle(planning.settling_s);
        }
        self.push(t, What::Run(Box::new(run)));
    }

    /// Between two movements the robot rests at the stop point. A wait takes that time too.
    fn settle(&mut self, settling: f64) {
        let Some(Event { duration, what: What::Run(before), .. }) = self.events.last_mut() else {
            return;
        };
        let Some(last) = before.moves.last_mut().filter(|_| *duration > 0.0) else { return };
        before.settling += settling;
        last.duration += settling;
        *duration += settling;
        self.time += settling;
    }

    /// A run of timed `MoveAbsJ` whose zones are large enough for the half-distance cut.
    fn as_stream(&self, start: &Joints, legs: &[Leg], movements: &[Movement]) -> Option<Stream> {
        let mut intervals = Vec::with_capacity(legs.len());
        for movement in movements {
            if movement.form != MoveForm::AbsJ {
                return None;
            }
            intervals.push(self.timed(movement)?);
        }
        // Distances between neighbouring points; the robot's own place does not count for zones
        // of the points after it.
        for pair in legs.windows(2) {
            let apart = pair[1].target.translation.vector - pair[0].target.translation.vector;
            if pair[0].zone.tcp < 0.5 * apart.norm() {
                return None;
            }
        }
        let points = legs.iter().map(|leg| leg.end).collect();
        Stream::new(*start, points, intervals).ok()
    }

    fn realise(&self, stream: Stream, movements: &[Movement]) -> Planned {
        // What the controller can't reach in time it does later.
        let scale = self.lateness(&stream);
        let stream = if scale > 1.0 {
            let intervals = stream.intervals().iter().map(|t| t * scale).collect();
            Stream::new(*stream.start(), stream.points().to_vec(), intervals).unwrap_or(stream)
        } else {
            stream
        };
        // A point's share of the time: up to the middle of the corner at it.
        let times = stream.knots().times();
        let mut durations = Vec::with_capacity(movements.len());
        for i in 0..movements.len() {
            let end = if i + 1 == movements.len() {
                stream.duration()
            } else {
                0.5 * (times[i + 1] + times[i + 2])
            };
            let begin = if i == 0 { 0.0 } else { 0.5 * (times[i] + times[i + 1]) };
            durations.push(end - begin);
        }
        (vec![(0.0, TimedMotion::Stream(stream))], durations, None)
    }

    /// How much slower than asked a stream runs, for the robot's speeds and accelerations.
    fn lateness(&self, stream: &Stream) -> f64 {
        let limits = &self.model.limits;
        let worst = |values: &Joints, limit: &Option<Vec<f64>>| {
            limit.as_ref().map_or(0.0, |limit| {
                values.iter().zip(limit).map(|(x, l)| x / l).fold(0.0, f64::max)
            })
        };
        let speed = worst(&stream.max_velocity(), &limits.velocity);
        let acceleration = worst(&stream.max_acceleration(), &limits.acceleration).sqrt();
        let scale = speed.max(acceleration);
        if scale > 1.0 + LATENESS_ROUNDING { scale } else { 1.0 }
    }

    fn plan_run(
        &self,
        loaded: Loaded<'_>,
        legs: &[Leg],
        movements: &[Movement],
        planning: &Planning,
    ) -> Planned {
        let caps: Vec<SpeedCap> =
            legs.iter().zip(movements).map(|(leg, movement)| cap(leg, movement)).collect();
        let limits = motion_limits(self.model, 1.0);
        let (paths, problem) = match build(self.model, legs) {
            Ok(paths) => (paths, None),
            Err(error) => {
                // For the time alone: the same points joint by joint.
                let joint: Vec<Leg> =
                    legs.iter().map(|leg| Leg { kind: LegKind::Joint, ..leg.clone() }).collect();
                let problem = Some((error.leg(), error.to_string()));
                (build(self.model, &joint).unwrap_or_default(), problem)
            }
        };
        let mut motions = Vec::new();
        let mut durations = vec![0.0; legs.len()];
        let mut t = 0.0;
        for path in paths {
            let path = Arc::new(path);
            let indices = path.legs();
            let times: Option<f64> = indices.clone().map(|i| self.timed(&movements[i])).sum();
            match plan(loaded, &path, &caps, &limits, planning, times) {
                Ok(motion) => {
                    // Where there is no room for a zone the robot stops as at a stop point.
                    if let (Some(last), false) = (indices.start.checked_sub(1), motions.is_empty())
                    {
                        durations[last] += planning.settling_s;
                        t += planning.settling_s;
                    }
                    let mut before = 0.0;
                    for leg in indices {
                        let at = motion.time_at(path.leg_end(leg));
                        durations[leg] += at - before;
                        before = at;
                    }
                    let duration = motion.duration();
                    motions.push((t, motion));
                    t += duration;
                }
                Err(error) => {
                    return (motions, durations, Some((indices.start, error.to_string())));
                }
            }
        }
        (motions, durations, problem)
    }
}

/// Excess over a limit that is rounding of emitted figures and no reason to be late.
const LATENESS_ROUNDING: f64 = 1e-3;

/// Motions with their start in the run, duration of each move, and what went wrong at which leg.
type Planned = (Vec<(f64, TimedMotion)>, Vec<f64>, Option<(usize, String)>);

/// The programmed speed of a movement as a cap; a timed one has none but its time.
fn cap(leg: &Leg, movement: &Movement) -> SpeedCap {
    let settings = &movement.settings;
    let limits = SpeedCap {
        acceleration: settings.acceleration,
        path_acceleration: settings.path_acceleration,
        world_acceleration: settings.world_acceleration,
        ..SpeedCap::NONE
    };
    match movement.time {
        None => SpeedCap { tcp: leg.speed.tcp, orientation: leg.speed.orientation, ..limits },
        Some(_) => limits,
    }
}

/// Tool and payload at the flange.
pub fn effective_load(movement: &Movement) -> Load {
    if let Some(total) = &movement.total_load {
        return load(total, &Isometry3::identity());
    }
    gripped(&gripping(movement), movement.settings.grip_load.as_ref())
}

/// The tool with the frame in which `GripLoad` states a load: that of the tool, or of the work
/// object where the robot holds that.
fn gripping(movement: &Movement) -> Tool {
    let tool = movement.tool.clone();
    if tool.robhold { tool } else { Tool { frame: movement.wobj.frame, ..tool } }
}

/// A tool with what `GripLoad` says that it holds.
fn gripped(tool: &Tool, grip: Option<&LoadData>) -> Load {
    let alone = load(&tool.load, &Isometry3::identity());
    match grip {
        Some(grip) => alone.with(&load(grip, &tool.frame)),
        None => alone,
    }
}

fn load(data: &LoadData, frame: &Isometry3<f64>) -> Load {
    let [w, x, y, z] = data.axes;
    let axes = frame.rotation * UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    let axes = axes.to_rotation_matrix();
    let principal = Matrix3::from_diagonal(&Vector3::from(data.inertia));
    Load {
        mass: data.mass,
        com: frame * nalgebra::Point3::from(Vector3::from(data.com)) - nalgebra::Point3::origin(),
        inertia: axes * principal * axes.transpose(),
    }
}

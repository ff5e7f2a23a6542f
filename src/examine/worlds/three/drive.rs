//! From a motion to the logged torques: links, gears, friction, motors, reporting, signal path.

use super::arm::Arm;
use super::body::{Bodies, BodyLaw};
use super::everyday::{Day, Dry, Everyday};
use super::fault::{Act, Fault};
use super::law::{Memory, Now};
use super::motion::{STEP, Track};
use super::signal::filter;
use super::spatial::Point;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// What a log says of the rotors' torques.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rotors {
    /// The model has rotors; torques are the motors'.
    InModel,
    /// The model has none; the drive takes the nominal ones off.
    Subtracted,
    /// The model has none, and the torques are the motors'.
    Left,
}

/// A robot with its model.
#[derive(Clone, Debug)]
pub(super) struct World {
    pub(super) nominal: Arm,
    pub(super) real: Arm,
    pub(super) everyday: Everyday,
    pub(super) rotors: Rotors,
}

/// A recording to simulate.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) track: Track,
    pub(super) entry: Option<Track>,
    pub(super) cycles: usize,
    pub(super) day: Day,
    /// Seed of what differs between cycles.
    pub(super) stream: Rng,
}

/// What is the same in each period of a track.
struct Prepared {
    load: Row,
    smooth: Row,
    dry: [Dry; MAX],
}

/// Which rates drive which motors: `motor = joint + ratio · other joint`.
#[derive(Clone, Debug, Default)]
struct Gears {
    couplings: Vec<(usize, usize, f64)>,
}

impl Gears {
    fn motors(&self, joints: &Row) -> Row {
        let mut out = *joints;
        for (from, into, ratio) in &self.couplings {
            out[*into] += ratio * joints[*from];
        }
        out
    }

    /// Torques at the joints of torques at the motors: the transpose.
    fn joints(&self, motors: &Row) -> Row {
        let mut out = *motors;
        for (from, into, ratio) in &self.couplings {
            out[*from] += ratio * motors[*into];
        }
        out
    }

    /// Torques at the motors of torques at the joints: exact while no motor couples twice.
    fn loads(&self, joints: &Row) -> Row {
        let mut out = *joints;
        for (from, into, ratio) in &self.couplings {
            out[*from] -= ratio * joints[*into];
        }
        out
    }
}

/// The faults of a case by stage.
struct Stages<'a> {
    faults: &'a [Fault],
    bodies: Vec<BodyLaw>,
    gears: Gears,
}

impl<'a> Stages<'a> {
    fn new(faults: &'a [Fault]) -> Self {
        let mut bodies = Vec::new();
        let mut gears = Gears::default();
        for act in faults.iter().flat_map(|fault| &fault.acts) {
            match act {
                Act::Body(law) => bodies.push(*law),
                Act::Coupling { from, into, ratio } => gears.couplings.push((*from, *into, *ratio)),
                _ => {}
            }
        }
        Self { faults, bodies, gears }
    }

    /// Loads \[Nm\] at the joints over a track, with springs and cables.
    fn loads(&self, arm: &Arm, track: &Track) -> Vec<Row> {
        let bodies = Bodies::new(arm, &self.bodies);
        let points = bodies.motion(track);
        let mut loads = bodies.torques(&points);
        for act in self.faults.iter().flat_map(|fault| &fault.acts) {
            let Act::Link(joint, law) = act else { continue };
            let mut memory: Memory = [0.0; 4];
            // Hysteresis settles in the first round.
            for round in 0..2 {
                let mut before = points.last().map_or(0.0, |point| point.q[*joint]);
                for (point, load) in points.iter().zip(&mut loads) {
                    let angle = point.q[*joint];
                    let torque = law.torque(angle, angle - before, &mut memory);
                    before = angle;
                    if round == 1 {
                        load[*joint] += torque;
                    }
                }
            }
        }
        loads
    }
}

fn prepare(world: &World, track: &Track, stages: &Stages) -> Vec<Prepared> {
    let arm = &world.real;
    let loads = stages.loads(arm, track);
    let one = |(point, load): (&Point, Row)| {
        let load = stages.gears.loads(&load);
        let rates = stages.gears.motors(&point.v);
        let mut row = Prepared { load, smooth: [0.0; MAX], dry: [Dry::default(); MAX] };
        for (i, habit) in world.everyday.joints.iter().enumerate() {
            row.smooth[i] = habit.smooth(i, point, &world.nominal, load[i]);
            row.dry[i] = habit.dry(arm.coulomb[i], arm.viscous[i], rates[i], point.q[i], load[i]);
        }
        row
    };
    track.points.iter().zip(loads).map(one).collect()
}

/// Memories of a log.
struct Memories {
    gear: [[f64; 2]; MAX],
    heat: Row,
    /// By act of the faults, all in a row.
    acts: Vec<Memory>,
}

/// Logged torques \[Nm\] without noise and quantisation, [`STEP`] apart, all periods.
pub(super) fn logged(world: &World, run: &Run, faults: &[Fault]) -> Vec<Row> {
    let stages = Stages::new(faults);
    let main = prepare(world, &run.track, &stages);
    let entry = run.entry.as_ref().map(|track| (track, prepare(world, track, &stages)));
    let count = world.real.axes();
    let mut memories = Memories {
        gear: [[0.0, 1.0]; MAX],
        heat: [1.0; MAX],
        acts: vec![[0.0; 4]; faults.iter().map(|fault| fault.acts.len()).sum()],
    };
    for (gear, warmth) in memories.gear.iter_mut().zip(run.day.warmth) {
        gear[1] = warmth;
    }
    let period = run.track.points.len() as f64 * STEP;
    let mut stream = run.stream.clone();
    let mut series = Vec::with_capacity(run.track.points.len() * run.cycles);
    for cycle in 0..run.cycles {
        let mut factors = run.day.friction;
        for (factor, habit) in factors.iter_mut().zip(&world.everyday.joints) {
            *factor *= habit.cycle(&mut stream);
        }
        let (track, rows) = match &entry {
            Some((track, rows)) if cycle == 0 => (*track, rows),
            _ => (&run.track, &main),
        };
        for (k, (point, row)) in track.points.iter().zip(rows).enumerate() {
            let phase = k as f64 * STEP;
            let now = Now {
                time: cycle as f64 * period + phase,
                phase,
                dt: STEP,
                q: point.q,
                v: stages.gears.motors(&point.v),
                a: stages.gears.motors(&point.a),
                load: row.load,
            };
            let mut torques = step((world, &stages), &now, row, &factors, &mut memories);
            if world.rotors == Rotors::Subtracted {
                for (i, torque) in torques.iter_mut().enumerate() {
                    *torque -= world.nominal.rotor[i] * point.a[i];
                }
            }
            series.push(torques);
        }
    }
    for act in faults.iter().flat_map(|fault| &fault.acts) {
        if let Act::Signal(law) = act {
            law.apply(&mut series, count);
        }
    }
    filter(&mut series, count, world.everyday.lag, world.everyday.order);
    series
}

/// Logged torques \[Nm\] of one step, before the signal path.
fn step(
    (world, stages): (&World, &Stages),
    now: &Now,
    row: &Prepared,
    factors: &Row,
    memories: &mut Memories,
) -> Row {
    let mut torques = [0.0; MAX];
    for (i, habit) in world.everyday.joints.iter().enumerate() {
        let friction =
            habit.friction(&row.dry[i], now.v[i], now.dt, factors[i], &mut memories.gear[i]);
        torques[i] = row.load[i] + world.real.rotor[i] * now.a[i] + friction + row.smooth[i];
    }
    let mut memory = memories.acts.iter_mut();
    for fault in stages.faults {
        let on = fault.window.is_none_or(|[from, to]| (from..=to).contains(&now.phase));
        for act in &fault.acts {
            let Some(memory) = memory.next() else { break };
            if let Act::Friction(i, law) = act {
                let torque = law.at(*i, now, 0.0, memory);
                torques[*i] += if on { torque } else { 0.0 };
            }
        }
    }
    for (i, habit) in world.everyday.joints.iter().enumerate() {
        let current = habit.motor.current(torques[i], now.v[i], memories.heat[i]);
        habit.motor.warm(&mut memories.heat[i], current, now.dt);
        torques[i] = habit.motor.reported(current) + habit.offset;
    }
    for (act, memory) in stages.faults.iter().flat_map(|fault| &fault.acts).zip(&mut memories.acts)
    {
        if let Act::Report(i, law) = act {
            torques[*i] = law.at(*i, now, torques[*i], memory);
        }
    }
    stages.gears.joints(&torques)
}

impl World {
    /// Torques \[Nm\] of the plain model with the parameters of an arm, as a log would show them.
    pub(super) fn plain(&self, arm: &Arm, at: &Point) -> Row {
        let real = std::ptr::eq(arm, &raw const self.real);
        let mut torques = arm.model(at, real || self.rotors == Rotors::InModel);
        if real && self.rotors == Rotors::Subtracted {
            for (i, torque) in torques.iter_mut().enumerate() {
                *torque -= self.nominal.rotor[i] * at.a[i];
            }
        }
        torques
    }
}

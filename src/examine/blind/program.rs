//! A RAPID program, and how a robot runs it.
//!
//! Each move states its duration (`\T`), so that the motion of a healthy controller is known without a
//! model of one; the simulated robot is a few milliseconds early or late.

use std::fmt::Write as _;

use super::mechanics::Joints;
use super::motion::{Motion, STEP_S, Sample};
use super::random::Random;
use super::workspace::Workspace;
use crate::arm::robot::MAX_DOF;

/// Moves of a cycle, the one back to its start included.
const MOVES: usize = 6;
/// Share of the moves after which the program waits.
const WAITING: f64 = 0.4;
/// By how much a move's time may be longer than the limits ask for.
const SPARE: [f64; 2] = [1.03, 1.6];
/// Line of the file, from 1, on which the first instruction of the cycle stands: the move home.
const FIRST_LINE: usize = 3;
/// Standard deviation of when a move starts \[s\].
pub(super) const JITTER_S: f64 = 0.003;
/// Largest rate and acceleration of a quintic from 0 to 1 in a time of 1.
const PEAKS: [f64; 2] = [1.875, 5.7736];

/// A cycle of moves and waits that ends where it began.
#[derive(Clone, Debug)]
pub(super) struct Program {
    /// Where each move goes, the first target being the start \[rad\].
    targets: Vec<Joints>,
    /// How long each move takes \[s\], the move to the start taking none.
    times: Vec<f64>,
    /// Wait after each move \[s\]; 0: no instruction.
    waits: Vec<f64>,
}

/// Deviations of the controller from the program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conduct {
    /// Shares of the limits of speed and acceleration that it keeps; 1 as usual.
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    /// A wait that is in no program: after which move, how long \[s\], and the part of it that is
    /// random.
    pub(super) pause: Option<(usize, f64, f64)>,
    /// How late the joints are \[s\], and by how many poles.
    pub(super) lag: f64,
    pub(super) poles: usize,
}

impl Conduct {
    /// No deviation.
    pub(super) fn plain() -> Conduct {
        Conduct { speed: 1.0, acceleration: 1.0, pause: None, lag: 0.0, poles: 1 }
    }
}

/// A log's motion, and the marks of its rows.
pub(super) struct Course {
    /// The whole log as one period.
    pub(super) motion: Motion,
    /// For each sample: repetition from 1, movement from 1 or 0 while waiting.
    pub(super) marks: Vec<[usize; 2]>,
}

impl Program {
    pub(super) fn drawn(workspace: &Workspace, random: &mut Random) -> Program {
        let mut program = Program { targets: Vec::new(), times: Vec::new(), waits: Vec::new() };
        let mut at = pose(workspace, random);
        program.targets.push(at);
        program.times.push(0.0);
        program.waits.push(0.0);
        for i in 1..=MOVES {
            let next = if i == MOVES { program.targets[0] } else { pose(workspace, random) };
            let spare = random.between(SPARE[0], SPARE[1]);
            let time = spare * least_time(workspace, &at, &next, &Conduct::plain());
            program.times.push((time * 100.0).ceil() / 100.0);
            let wait = if random.chance(WAITING) { random.between(0.2, 1.2) } else { 0.0 };
            program.waits.push((wait * 10.0).round() / 10.0);
            program.targets.push(next);
            at = next;
        }
        program
    }

    /// Number of moves, the one to the start included.
    pub(super) fn moves(&self) -> usize {
        self.targets.len()
    }

    /// The module.
    pub(super) fn text(&self) -> String {
        let mut text = String::from("MODULE MainModule\n  PROC main()\n");
        for (i, target) in self.targets.iter().enumerate() {
            let angles: Vec<String> =
                target.iter().take(6).map(|q| format!("{:.4}", q.to_degrees())).collect();
            let time = if i == 0 { String::new() } else { format!("\\T:={:.2}", self.times[i]) };
            let _ = writeln!(
                text,
                "    MoveAbsJ [[{}],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v1000{time},fine,tool0;",
                angles.join(",")
            );
            if self.waits[i] > 0.0 {
                let _ = writeln!(text, "    WaitTime {:.1};", self.waits[i]);
            }
        }
        text + "  ENDPROC\nENDMODULE\n"
    }

    /// The line of a move, from 1.
    pub(super) fn line(&self, number: usize) -> usize {
        let waits = self.waits.iter().take(number).filter(|wait| **wait > 0.0).count();
        FIRST_LINE + number + waits
    }

    /// How long each move takes \[s\].
    pub(super) fn durations(&self, workspace: &Workspace, conduct: &Conduct) -> Vec<f64> {
        let mut durations = vec![0.0];
        for i in 1..self.targets.len() {
            let least = least_time(workspace, &self.targets[i - 1], &self.targets[i], conduct);
            durations.push(self.times[i].max(least));
        }
        durations
    }

    /// The program, so many times.
    pub(super) fn run(
        &self,
        workspace: &Workspace,
        conduct: &Conduct,
        cycles: usize,
        random: &mut Random,
    ) -> Course {
        let durations = self.durations(workspace, conduct);
        let mut samples: Vec<Sample> = Vec::new();
        let mut marks = Vec::new();
        let mut clock = 0.0;
        for cycle in 1..=cycles {
            for i in 1..self.targets.len() {
                let (from, to) = (&self.targets[i - 1], &self.targets[i]);
                let began = clock;
                clock += durations[i];
                while (samples.len() as f64) * STEP_S < clock {
                    let x = ((samples.len() as f64) * STEP_S - began) / durations[i];
                    samples.push(between(from, to, x.clamp(0.0, 1.0), durations[i]));
                    marks.push([cycle, i + 1]);
                }
                let late = match conduct.pause {
                    Some((after, pause, spread)) if after == i => {
                        pause * (1.0 + spread * random.between(-1.0, 1.0))
                    }
                    _ => 0.0,
                };
                clock += (self.waits[i] + late + JITTER_S * random.normal_within(3.0)).max(0.0);
                while (samples.len() as f64) * STEP_S < clock {
                    samples.push(between(from, to, 1.0, durations[i]));
                    marks.push([cycle, 0]);
                }
            }
        }
        for _ in 0..conduct.poles {
            lagging(&mut samples, conduct.lag / conduct.poles as f64);
        }
        Course { motion: Motion { samples }, marks }
    }
}

fn pose(workspace: &Workspace, random: &mut Random) -> Joints {
    let mut q = [0.0; MAX_DOF];
    for (joint, [from, to]) in workspace.range.iter().enumerate().take(workspace.dof) {
        let middle = f64::midpoint(*from, *to);
        let degrees = (middle + 0.6 * (random.between(*from, *to) - middle)).to_degrees();
        // As the program has it.
        q[joint] = ((degrees * 1e4).round() / 1e4).to_radians();
    }
    q
}

/// The time that a move needs within the limits \[s\].
fn least_time(workspace: &Workspace, from: &Joints, to: &Joints, conduct: &Conduct) -> f64 {
    (0..workspace.dof)
        .map(|joint| {
            let way = (to[joint] - from[joint]).abs();
            let by_rate = PEAKS[0] * way / (conduct.speed * workspace.velocity[joint]);
            let limit = conduct.acceleration * workspace.acceleration[joint];
            by_rate.max((PEAKS[1] * way / limit).sqrt())
        })
        .fold(0.2, f64::max)
}

/// A quintic's state at the share `x` of its time.
fn between(from: &Joints, to: &Joints, x: f64, lasts: f64) -> Sample {
    let s = x.powi(3) * (10.0 + x * (6.0 * x - 15.0));
    let sd = 30.0 * (x * (1.0 - x)).powi(2) / lasts;
    let sdd = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (lasts * lasts);
    let mut sample = Sample { q: *from, qd: [0.0; MAX_DOF], qdd: [0.0; MAX_DOF] };
    for joint in 0..MAX_DOF {
        let way = to[joint] - from[joint];
        sample.q[joint] += way * s;
        sample.qd[joint] = way * sd;
        sample.qdd[joint] = way * sdd;
    }
    sample
}

/// A pole behind the motion; positions, rates and accelerations pass through the same one.
fn lagging(samples: &mut [Sample], lag: f64) {
    let Some(first) = samples.first().copied().filter(|_| lag > 0.0) else { return };
    let kept = lag / (lag + STEP_S);
    let mut state = first;
    for sample in samples {
        for joint in 0..MAX_DOF {
            for (state, now) in [
                (&mut state.q[joint], &mut sample.q[joint]),
                (&mut state.qd[joint], &mut sample.qd[joint]),
                (&mut state.qdd[joint], &mut sample.qdd[joint]),
            ] {
                *state = *now + kept * (*state - *now);
                *now = *state;
            }
        }
    }
}

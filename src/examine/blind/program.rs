//! A RAPID program and its execution by a robot.
//!
//! Each move states its duration (`\T`), so that the healthy motion needs no controller model; the
//! simulated robot is a few milliseconds early or late.

use std::fmt::Write as _;

use super::mechanics::Joints;
use super::motion::{Motion, STEP_S, Sample};
use super::profile::Profile;
use super::random::Random;
use super::workspace::Workspace;
use crate::arm::robot::MAX_DOF;

/// Moves of a cycle, including the one back to the start.
const MOVES: usize = 6;
/// Share of the moves that are followed by a wait.
const WAITING: f64 = 0.4;
/// Factor of a move's duration over the least one within the limits.
const SPARE: [f64; 2] = [1.03, 1.6];
/// Line of the first instruction of the cycle, from 1: the move to the start.
const FIRST_LINE: usize = 3;
/// Standard deviation of the start of a move \[s\].
pub(super) const JITTER_S: f64 = 0.003;
/// Least duration of a move \[s\].
const LEAST_S: f64 = 0.2;

/// A cycle of moves and waits that ends at its start.
#[derive(Clone, Debug)]
pub(super) struct Program {
    /// Target of each move \[rad\]; the first target is the start.
    targets: Vec<Joints>,
    /// Duration of each move \[s\]; 0 for the move to the start.
    times: Vec<f64>,
    /// Wait after each move \[s\]; 0: no instruction.
    waits: Vec<f64>,
}

/// Deviations of the controller from the program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conduct {
    /// Factors of the limits of speed and acceleration; 1 without a deviation.
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    /// An additional pause: the move before it, its duration \[s\], and its random share.
    pub(super) pause: Option<(usize, f64, f64)>,
    /// Lag of the joints \[s\], and number of its poles.
    pub(super) lag: f64,
    pub(super) poles: usize,
}

impl Conduct {
    /// No deviation.
    pub(super) fn plain() -> Conduct {
        Conduct { speed: 1.0, acceleration: 1.0, pause: None, lag: 0.0, poles: 1 }
    }
}

/// The motion of a log, and the marks of its rows.
pub(super) struct Course {
    /// The whole log as one period.
    pub(super) motion: Motion,
    /// For each sample, the repetition from 1, and the movement from 1 or 0 during a wait.
    pub(super) marks: Vec<[usize; 2]>,
}

impl Program {
    pub(super) fn drawn(workspace: &Workspace, random: &mut Random) -> Program {
        let mut at = pose(workspace, random);
        let mut program = Program { targets: vec![at], times: vec![0.0], waits: vec![0.0] };
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

    /// Number of moves, including the one to the start.
    pub(super) fn moves(&self) -> usize {
        self.targets.len()
    }

    /// The text of the module.
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

    /// Duration of each move \[s\].
    pub(super) fn durations(&self, workspace: &Workspace, conduct: &Conduct) -> Vec<f64> {
        let mut durations = vec![0.0];
        for i in 1..self.targets.len() {
            let least = least_time(workspace, &self.targets[i - 1], &self.targets[i], conduct);
            durations.push(self.times[i].max(least));
        }
        durations
    }

    /// The motion of several repetitions of the program.
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
        // Rounded as in the program text.
        q[joint] = ((degrees * 1e4).round() / 1e4).to_radians();
    }
    q
}

/// The least duration of a move within the limits \[s\].
fn least_time(workspace: &Workspace, from: &Joints, to: &Joints, conduct: &Conduct) -> f64 {
    let limits = [conduct.speed, conduct.acceleration];
    Profile::Quintic.least_time(workspace, limits, from, to).max(LEAST_S)
}

/// The state of a quintic at the normalised time `x`.
fn between(from: &Joints, to: &Joints, x: f64, lasts: f64) -> Sample {
    let [s, sd, sdd] = Profile::Quintic.at(x);
    let (sd, sdd) = (sd / lasts, sdd / (lasts * lasts));
    let mut sample = Sample { q: *from, ..Sample::ZERO };
    for joint in 0..MAX_DOF {
        let way = to[joint] - from[joint];
        sample.q[joint] += way * s;
        sample.qd[joint] = way * sd;
        sample.qdd[joint] = way * sdd;
    }
    sample
}

/// A first-order lag of the motion; positions, rates and accelerations pass the same filter.
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

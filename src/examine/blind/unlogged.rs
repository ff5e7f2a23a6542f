//! Noiseless motions of a case's robot outside its files, as ground truth for claims.

use super::bench::{Bench, Settings};
use super::fourier::fourier;
use super::mechanics::Joints;
use super::model_error::variation;
use super::motion::{Motion, PER_ROW, Sample};
use super::noise::ROW_S;
use super::pick_place::pick_place;
use super::simulate::{Row, simulate};
use crate::arm::robot::MAX_DOF;

/// Number of periods until the states of the robot have settled.
const ROUNDS: usize = 2;

/// One period of a motion, by joint and row.
#[derive(Clone, Debug, PartialEq)]
pub struct Unlogged {
    /// Times on the clock of the case's logs \[s\].
    pub t: Vec<f64>,
    /// Logged positions \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Rates \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<Vec<f64>>,
    /// Torques \[Nm\].
    pub tau: Vec<Vec<f64>>,
    /// Electrical power \[W\].
    pub power: Vec<f64>,
}

/// `count` further motions of a case's robot, of the same kind and at the same time as the held-out
/// log. `None` for program runs, or if the catalogue lacks the robot.
#[must_use]
pub fn unlogged(settings: &Settings, number: usize, count: usize) -> Option<Vec<Unlogged>> {
    let bench = Bench::drawn(settings, number).filter(|bench| !bench.with_program)?;
    let (_, disturbances) = bench.wrong();
    let robot = bench.robot(disturbances.iter().collect());
    let clock = bench.clocks()[2];
    let mut draws = bench.stream("unlogged");
    let motions = (0..count).map(|_| {
        if bench.heldout_works {
            pick_place(&bench.workspace, settings.period_s, &mut draws)
        } else {
            fourier(&bench.workspace, settings.period_s, &mut draws)
        }
    });
    let steady = [[1.0; MAX_DOF]; ROUNDS];
    let dof = robot.plant.dof;
    let last = |of| last_round(&of, &simulate(&robot, &of, clock, &steady), clock, dof);
    Some(motions.map(last).collect())
}

/// Pause before a further log \[s\].
const PAUSE_S: f64 = 30.0;

/// The log of a further motion of a case's robot, as CSV: `states` are position, rate and acceleration
/// of one repetition every 2 ms, `cycles` the repetitions. `None` for program runs, or if the catalogue
/// lacks the robot.
#[must_use]
pub fn further(
    settings: &Settings,
    number: usize,
    states: &[[Joints; 3]],
    cycles: usize,
) -> Option<String> {
    let bench = Bench::drawn(settings, number).filter(|bench| !bench.with_program)?;
    let (_, disturbances) = bench.wrong();
    let robot = bench.robot(disturbances.iter().collect());
    let lasts = settings.cycles as f64 * settings.period_s;
    let clock = bench.clocks()[2] + lasts + PAUSE_S;
    let samples = states.iter().map(|[q, qd, qdd]| Sample { q: *q, qd: *qd, qdd: *qdd }).collect();
    let mut draws = bench.stream("further");
    let factors = variation(cycles, bench.variation, &mut draws);
    let rows = simulate(&robot, &Motion { samples }, clock, &factors);
    Some(bench.noise.log(&rows, bench.plant.dof, clock, None, &mut draws))
}

fn last_round(motion: &Motion, rows: &[Row], clock: f64, dof: usize) -> Unlogged {
    let samples: Vec<&Sample> = motion.samples.iter().step_by(PER_ROW).collect();
    let rows = &rows[rows.len() - samples.len()..];
    let by_joint = |value: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
        (0..dof).map(|joint| (0..rows.len()).map(|row| value(row, joint)).collect()).collect()
    };
    let began = clock + (ROUNDS - 1) as f64 * motion.period_s();
    Unlogged {
        t: (0..rows.len()).map(|row| began + ROW_S * row as f64).collect(),
        q: by_joint(&|row, joint| rows[row].q[joint]),
        qd: by_joint(&|row, joint| samples[row].qd[joint]),
        qdd: by_joint(&|row, joint| samples[row].qdd[joint]),
        tau: by_joint(&|row, joint| rows[row].tau[joint]),
        power: rows.iter().map(|row| row.power).collect(),
    }
}

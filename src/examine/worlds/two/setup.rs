//! What all cases share: robot, files, plan of the logs.

use super::everyday::{Everyday, Scale, scale};
use super::motion::{Motion, Shape, draw, rooms};
use super::plant::{Gains, PathSpec, Plant};
use super::robot::{self, Robot};
use crate::examine::worlds::model::{CAD, COMMISSIONED, MAX, Row, Spread};
use crate::examine::worlds::random::Rng;

/// Robot and file.
#[derive(Clone, Debug)]
pub(super) struct Setup {
    pub(super) nominal: Robot,
    pub(super) robot: Robot,
    pub(super) spread: Spread,
    /// Whether the file is TOML; else URDF.
    pub(super) toml: bool,
    pub(super) baseline: bool,
    /// Rotor inertias in the file \[kg m²\].
    pub(super) in_file: Row,
    /// Rotor inertias whose torque the drive takes off \[kg m²\].
    pub(super) subtract: Row,
}

impl Setup {
    /// Name and text of the robot's file.
    pub(super) fn file(&self) -> (String, String) {
        self.nominal.sheet().file(!self.toml)
    }
}

pub(super) fn setup(
    always_baseline: bool,
    toml_only: bool,
    six_only: bool,
    rng: &mut Rng,
) -> Setup {
    let nominal = robot::draw(six_only, rng);
    let baseline = always_baseline || rng.chance(0.6);
    let known = if baseline { 0.6 } else { 0.45 };
    let spread = if rng.chance(known) { COMMISSIONED } else { CAD };
    let robot = robot::perturbed(&nominal, &spread, rng);
    let toml = toml_only || rng.chance(0.55);
    let take_off = !toml && rng.chance(0.6);
    let rotor = nominal.arm.rotor;
    Setup {
        in_file: if toml { rotor } else { [0.0; MAX] },
        subtract: if take_off { rotor } else { [0.0; MAX] },
        nominal,
        robot,
        spread,
        toml,
        baseline,
    }
}

/// Plan of the logs.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// Motions of the logs; baseline logs have the same.
    pub(super) motions: Vec<Motion>,
    pub(super) heldout: Motion,
    pub(super) baselines: usize,
    pub(super) cycles: usize,
    pub(super) heldout_cycles: usize,
    pub(super) transient: bool,
    /// Sampling rate \[Hz\].
    pub(super) rate: f64,
    /// Step of the simulation \[s\].
    pub(super) dt: f64,
    /// Period of the logs \[s\].
    pub(super) period: f64,
}

/// Simulated time of a case \[s\]: what fits in the time per case.
const BUDGET: f64 = 250.0;
/// Most rows of a case.
const ROWS: f64 = 60_000.0;
/// Run-up of each log \[s\].
const RUN_UP: f64 = 2.4;
/// Simulated times above which steps are 0.5 ms and 1 ms instead of 0.25 ms \[s\].
const COARSE: (f64, f64) = (125.0, 265.0);

/// Draws the motions and numbers of logs; `waits`: moves with long dwells.
pub(super) fn plan(setup: &Setup, waits: bool, rng: &mut Rng) -> Plan {
    let logs = rng.pick(&[1, 1, 1, 2, 2, 3]);
    let baselines = if setup.baseline { rng.pick(&[1, 1, 2]) } else { 0 };
    let repeated = rng.chance(0.82);
    let count = (logs + baselines) as f64;
    let (period, cycles, heldout_cycles) = if repeated {
        let share = BUDGET / (count + 0.7) - RUN_UP;
        let period = (rng.log_between(5.0, 20.0).min(share / 3.0) * 20.0).round() / 20.0;
        let cycles = (3 + rng.below(8)).min((share / period) as usize).max(3);
        (period, cycles, 3.min(cycles))
    } else {
        let longest = (BUDGET / (count + 1.0) - RUN_UP).clamp(31.0, 60.0);
        (rng.between(30.0, longest).round(), 1, 1)
    };
    let shapes = [
        Shape::Fourier,
        Shape::Fourier,
        Shape::Trapezoid,
        Shape::SCurve,
        Shape::SCurve,
        Shape::Chirp,
    ];
    let rooms = rooms(&setup.nominal, rng);
    let draw_one = |rng: &mut Rng, k: usize| {
        // A slow sweep is one of several logs.
        let shape = if waits {
            Shape::Waits
        } else if k == 1 && rng.chance(0.3) {
            Shape::Slow
        } else {
            rng.pick(&shapes)
        };
        draw(&setup.nominal, shape, period, &rooms, rng)
    };
    let motions: Vec<Motion> = (0..logs).map(|k| draw_one(rng, k)).collect();
    let heldout = draw_one(rng, 0);
    let total = period * (count * cycles as f64 + heldout_cycles as f64) + RUN_UP * (count + 1.0);
    let rates: Vec<f64> = [50.0, 100.0, 125.0, 250.0, 500.0, 100.0, 250.0]
        .into_iter()
        .filter(|rate| rate * total < ROWS)
        .collect();
    let dt = if total > COARSE.1 {
        1e-3
    } else if total > COARSE.0 {
        5e-4
    } else {
        2.5e-4
    };
    Plan {
        motions,
        heldout,
        baselines,
        cycles,
        heldout_cycles,
        transient: rng.chance(0.15),
        rate: rng.pick(&rates),
        dt,
        period,
    }
}

/// Levels of all motions, and the rows they are from.
pub(super) fn levels(setup: &Setup, plan: &Plan) -> (Scale, Vec<(Row, Row, Row)>) {
    let rows: Vec<_> = plan.motions.iter().flat_map(|motion| motion.thinned(200)).collect();
    (scale(&setup.robot, &rows), rows)
}

/// The plant of a case.
pub(super) fn plant(
    setup: &Setup,
    scale: &Scale,
    rows: &[(Row, Row, Row)],
    rng: &mut Rng,
) -> Plant {
    let everyday = Everyday::draw(&setup.robot, rows, scale, rng);
    let lag = rng.between(0.5e-3, 4e-3);
    let path = match rng.below(3) {
        0 => PathSpec { poles: [lag, 0.0], mean: 0.0, delay: rng.between(0.0, 2e-3) },
        1 => PathSpec { poles: [0.5 * lag, 0.5 * lag], mean: 0.0, delay: rng.between(0.0, 2e-3) },
        _ => PathSpec { poles: [0.0, 0.0], mean: 2.0 * lag, delay: rng.between(0.0, 2e-3) },
    };
    let gains = Gains {
        speed: std::f64::consts::TAU * rng.between(10.0, 22.0),
        position: rng.between(0.15, 0.3),
        integral: rng.between(0.1, 0.25),
        forward: 1.0,
    };
    Plant {
        nominal: setup.nominal.clone(),
        robot: setup.robot.clone(),
        everyday,
        path,
        subtract: setup.subtract,
        gains,
    }
}

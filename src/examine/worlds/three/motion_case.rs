//! Cases of motion: a RAPID program and logs of positions.

use super::arm::Arm;
use super::build::nominal;
use super::motion::STEP;
use super::planner::{Step, Tuning, Wait, execute};
use super::program::moves;
use crate::examine::worlds::api::{Case, Kind, MODULE, Truth, nats, program_options};
use crate::examine::worlds::model::MAX;
use crate::examine::worlds::program::{Move, Recorder, module};
use crate::examine::worlds::random::Rng;

/// Share of the cases in which nothing is wrong.
const HEALTHY: f64 = 0.4;
/// Rows of a log at most, unless the fault slows the program.
const MOST_ROWS: f64 = 12_000.0;
/// Longest cycle \[s\].
const LONGEST: f64 = 20.0;
/// Rows of the evidence by joint.
const ROWS: usize = 300;

/// A fault of motion, and the moves, from 0, at which it appears.
struct MotionFault {
    truth: Truth,
    tuning: Tuning,
    at: Vec<usize>,
}

/// A controller as it was tuned.
fn tuned(rng: &mut Rng) -> Tuning {
    Tuning {
        zone: 1.0,
        acceleration: [1.0; MAX],
        speed: 1.0,
        cap: f64::INFINITY,
        lag: [rng.between(0.002, 0.006); MAX],
        delay: 0.0,
        wait: None,
        ramp: rng.between(0.05, 0.15),
        scatter: rng.log_between(0.0005, 0.004),
    }
}

/// A fault of a controller.
fn fault(id: &str, arm: &Arm, moves: &[Move], before: &Tuning, rng: &mut Rng) -> MotionFault {
    let mut tuning = before.clone();
    let second = rng.chance(0.5);
    let down = rng.chance(0.75);
    let of = |wanted: &dyn Fn(&Move) -> bool| -> Vec<usize> {
        (0..moves.len()).filter(|k| wanted(&moves[*k])).collect()
    };
    let mut at = of(&|_| true);
    // From barely visible to strong, slower three times in four.
    let mut factor = |strongest: f64| {
        let change = rng.log_between(1.03, strongest);
        if down { 1.0 / change } else { change }
    };
    let (form, name, value, graded) = match id {
        "zone_blending" => {
            tuning.zone = factor(4.0);
            at = of(&|step| step.zone > 0.0);
            ("overlap of the moves", "factor", tuning.zone, true)
        }
        "acceleration_limit" => {
            let value = factor(3.0);
            // Main axes only: a heavier load in the load data.
            for acceleration in tuning.acceleration.iter_mut().take(if second { 3 } else { MAX }) {
                *acceleration *= value;
            }
            (if second { "main axes only" } else { "all axes" }, "factor", value, !second)
        }
        "speed_limit" if second => {
            // A cap for the tool among the speeds of the program.
            let value = 1.0 / rng.log_between(1.1, 4.0);
            tuning.cap = value * moves.iter().map(|step| step.speed).fold(0.0, f64::max);
            at = of(&|step| step.speed > tuning.cap);
            ("cap of the tool's speed", "factor", value, false)
        }
        "speed_limit" => {
            tuning.speed = 1.0 / rng.log_between(1.03, 3.0);
            ("override", "factor", tuning.speed, true)
        }
        "program_wait" => {
            let after = rng.pick(&of(&|step| step.zone == 0.0));
            let time = rng.log_between(0.05, 3.0);
            let scatter = if second { 0.3 } else { 0.0 };
            tuning.wait = Some(Wait { after, time, scatter, running: rng.chance(0.4) });
            at = vec![after];
            (if second { "handshake that varies" } else { "constant" }, "wait", time, !second)
        }
        _ => {
            let lag = rng.log_between(0.012, 0.15);
            tuning.delay = if second { (0.7 * lag / STEP).round() * STEP } else { 0.0 };
            for (i, own) in tuning.lag.iter_mut().enumerate().take(arm.axes()) {
                // Main axes lag more than the wrist.
                let unequal = 0.3 * if i < 3 { 1.3 } else { 0.7 };
                *own += lag * if second { unequal } else { 1.0 };
            }
            let form = if second { "delay and unequal lags" } else { "soft position loops" };
            (form, "lag", lag, true)
        }
    };
    let mut truth = Truth::new(id, form, &[]);
    truth.tell(name, None, value, graded);
    MotionFault { truth, tuning, at }
}

/// Evidence \[nats\] of a changed motion: angles at the same times of a cycle, against the scatter of
/// times and 0.2 mrad of the servos.
fn evidence(arm: &Arm, program: &[Move], before: &Tuning, after: &Tuning) -> f64 {
    let still = |tuning: &Tuning| Tuning { scatter: 0.0, ..tuning.clone() };
    let mut rng = Rng::stream(0, 0, "evidence");
    // Two cycles: a wait at the end shows in the second.
    let old = execute(arm, program, &still(before), 2, &mut rng);
    let new = execute(arm, program, &still(after), 2, &mut rng);
    let longest = old.len().max(new.len());
    let at = |rows: &[Step], k: usize, i: usize| rows[k.min(rows.len() - 1)].0[i];
    let (mut delta, mut sd) = (Vec::new(), Vec::new());
    for i in 0..arm.axes() {
        let steps = (0..ROWS).map(|row| row * longest / ROWS);
        delta.push(steps.map(|k| at(&new, k, i) - at(&old, k, i)).collect::<Vec<f64>>());
        let moved: f64 = old.windows(2).map(|pair| (pair[1].0[i] - pair[0].0[i]).powi(2)).sum();
        let rate = (moved / old.len() as f64).sqrt() / STEP;
        sd.push((rate * 3.0 * before.scatter).hypot(0.0002));
    }
    nats(&delta, &sd, &[])
}

/// A motion case; in [`HEALTHY`] of them nothing is wrong.
pub(super) fn case(seed: u64, number: usize) -> Case {
    let stream = |purpose: &str| Rng::stream(seed, number, purpose);
    let mut rng = stream("motion");
    let arm = nominal(&mut stream("robot"), number, true);
    let before = tuned(&mut rng);
    let mut program = moves(&arm, &mut rng);
    let mut length = execute(&arm, &program, &before, 1, &mut rng).len() as f64 * STEP;
    while length > LONGEST && program.len() > 4 {
        program.remove(1);
        length = execute(&arm, &program, &before, 1, &mut rng).len() as f64 * STEP;
    }
    let (text, of_moves) = module(&program, arm.axes());
    let wrong = (!rng.chance(HEALTHY)).then(|| {
        let mut ids = vec!["tracking_lag", "acceleration_limit", "speed_limit", "program_wait"];
        if program.iter().any(|step| step.zone > 0.0) {
            ids.push("zone_blending");
        }
        fault(rng.pick(&ids), &arm, &program, &before, &mut rng)
    });
    let cycles = rng.whole(3, 10).min((120.0 / length) as usize).max(2);
    let mut rates = vec![50.0, 100.0, 125.0, 250.0];
    rates.retain(|rate| *rate == 50.0 || rate * length * cycles as f64 <= MOST_ROWS);
    let recorder = Recorder {
        n: arm.axes(),
        rate: rng.pick(&rates),
        cycles: rng.chance(0.5),
        noise: rng.log_between(2e-6, 5e-5),
        step: 1e-6,
        start: if rng.chance(0.6) { 0.0 } else { rng.log_between(1.0, 1e4).round() },
        lost: if rng.chance(0.2) { 0.001 } else { 0.0 },
    };
    let now = wrong.as_ref().map_or(&before, |fault| &fault.tuning);
    let mut files = vec![arm.sheet().file(false), (MODULE.to_owned(), text)];
    let mut add = |name: String, tuning: &Tuning, cycles: usize| {
        let mut rng = stream(&name);
        let rows = execute(&arm, &program, tuning, cycles, &mut rng);
        files.push((name, recorder.csv(&rows, STEP, &mut rng)));
    };
    for k in 1..=rng.whole(1, 2) {
        add(format!("log-{k}.csv"), now, cycles);
    }
    add("heldout.csv".to_owned(), now, cycles.min(4));
    for k in 1..=rng.whole(1, 2) {
        add(format!("baseline-{k}.csv"), &before, cycles);
    }
    let options = program_options(&files[0].0, "commissioned");
    let mut case = Case::new(files, options, Kind::Healthy);
    if let Some(fault) = wrong {
        case.kind = Kind::Motion;
        case.lines = fault.at.iter().map(|k| of_moves[*k]).collect();
        let nats = evidence(&arm, &program, &before, &fault.tuning);
        case.effects.push(Truth { nats, ..fault.truth });
    }
    case
}

//! Cases of motion: a RAPID program and logs of positions.

use crate::api::{Case, Kind, TrueParameter, Truth, nats};
use crate::arm::Arm;
use crate::build::nominal;
use crate::model_file;
use crate::motion::STEP;
use crate::planner::{Row, Tuning, Wait, execute};
use crate::program::{Move, moves, rapid};
use crate::rng::Rng;
use crate::spatial::MAX;
use serde_json::json;
use std::fmt::Write;

/// Share of the cases in which nothing is wrong.
const HEALTHY: f64 = 0.4;
/// Rows of a log at most, unless the fault slows the program.
const MOST_ROWS: f64 = 12_000.0;
/// Longest cycle \[s\].
const LONGEST: f64 = 20.0;
/// Rows of the evidence by joint.
const ROWS: usize = 300;

/// A fault of motion.
struct MotionFault {
    id: &'static str,
    form: &'static str,
    tuning: Tuning,
    parameter: Option<(&'static str, f64, bool)>,
    /// Moves at which it appears, from 0.
    at: Vec<usize>,
}

/// A controller as it was tuned.
fn tuned(rng: &mut Rng) -> Tuning {
    Tuning {
        zone: 1.0,
        acceleration: [1.0; MAX],
        speed: 1.0,
        cap: f64::INFINITY,
        lag: [rng.range(0.002, 0.006); MAX],
        delay: 0.0,
        wait: None,
        ramp: rng.range(0.05, 0.15),
        scatter: rng.log_range(0.0005, 0.004),
    }
}

/// A fault of a controller.
fn fault(id: &'static str, arm: &Arm, moves: &[Move], before: &Tuning, rng: &mut Rng) -> MotionFault {
    let mut tuning = before.clone();
    let second = rng.chance(0.5);
    let down = rng.chance(0.75);
    let all: Vec<usize> = (0..moves.len()).collect();
    // From barely visible to strong, slower three times in four.
    let mut factor = |strongest: f64| {
        let change = rng.log_range(1.03, strongest);
        if down { 1.0 / change } else { change }
    };
    match id {
        "zone_blending" => {
            let value = factor(4.0);
            tuning.zone = value;
            let at =
                all.into_iter().filter(|k| moves.get(*k).is_some_and(|step| step.zone.is_some())).collect();
            MotionFault {
                id,
                form: "overlap of the moves",
                tuning,
                parameter: Some(("factor", value, true)),
                at,
            }
        }
        "acceleration_limit" => {
            let value = factor(3.0);
            // Main axes only: a heavier load in the load data.
            let some = if second { 3 } else { MAX };
            for acceleration in tuning.acceleration.iter_mut().take(some) {
                *acceleration *= value;
            }
            let form = if second { "main axes only" } else { "all axes" };
            MotionFault { id, form, tuning, parameter: Some(("factor", value, !second)), at: all }
        }
        "speed_limit" => {
            if second {
                // A cap for the tool among the speeds of the program.
                let fastest = moves.iter().map(|step| step.speed).max().unwrap_or(1000) as f64 / 1000.0;
                let value = 1.0 / rng.log_range(1.1, 4.0);
                tuning.cap = fastest * value;
                let slower =
                    |k: &usize| moves.get(*k).is_some_and(|step| step.speed as f64 / 1000.0 > tuning.cap);
                let at = all.into_iter().filter(slower).collect();
                return MotionFault {
                    id,
                    form: "cap of the tool's speed",
                    tuning,
                    parameter: Some(("factor", value, false)),
                    at,
                };
            }
            let value = 1.0 / rng.log_range(1.03, 3.0);
            tuning.speed = value;
            MotionFault { id, form: "override", tuning, parameter: Some(("factor", value, true)), at: all }
        }
        "program_wait" => {
            let stops: Vec<usize> =
                all.into_iter().filter(|k| moves.get(*k).is_some_and(|step| step.zone.is_none())).collect();
            let after = rng.pick(&stops, 0);
            let time = rng.log_range(0.05, 3.0);
            let scatter = if second { 0.3 } else { 0.0 };
            tuning.wait = Some(Wait { after, time, scatter, running: rng.chance(0.4) });
            let form = if second { "handshake that varies" } else { "constant" };
            MotionFault { id, form, tuning, parameter: Some(("wait", time, !second)), at: vec![after] }
        }
        _ => {
            let lag = rng.log_range(0.012, 0.15);
            if second {
                tuning.delay = (0.7 * lag / STEP).round() * STEP;
                for (i, own) in tuning.lag.iter_mut().enumerate().take(arm.axes()) {
                    // Main axes lag more than the wrist.
                    *own += 0.3 * lag * if i < 3 { 1.3 } else { 0.7 };
                }
            } else {
                tuning.lag = tuning.lag.map(|own| own + lag);
            }
            let form = if second { "delay and unequal lags" } else { "soft position loops" };
            MotionFault { id: "tracking_lag", form, tuning, parameter: Some(("lag", lag, true)), at: all }
        }
    }
}

/// The CSV of a log.
fn csv(arm: &Arm, rows: &[Row], rate: f64, cycle_column: bool, rng: &mut Rng) -> String {
    let mut out = "t".to_owned();
    for i in 1..=arm.axes() {
        let _ = write!(out, ",q{i}");
    }
    out.push_str(if cycle_column { ",cmd,cycle\n" } else { ",cmd\n" });
    let noise = rng.log_range(2e-6, 5e-5);
    let start = if rng.chance(0.6) { 0.0 } else { rng.log_range(1.0, 1e4).round() };
    let count = (rows.len() as f64 * STEP * rate).floor() as usize;
    let lost = if rng.chance(0.2) { 0.001 } else { 0.0 };
    for k in 0..count {
        let time = k as f64 / rate;
        let Some((q, cmd, cycle)) = rows.get((time / STEP).round() as usize) else { break };
        if k > 0 && rng.chance(lost) {
            continue;
        }
        let _ = write!(out, "{:.4}", start + time);
        for angle in q.iter().take(arm.axes()) {
            let _ = write!(out, ",{:.6}", angle + noise * rng.normal());
        }
        let _ = write!(out, ",{cmd}");
        if cycle_column {
            let _ = write!(out, ",{cycle}");
        }
        out.push('\n');
    }
    out
}

/// Evidence \[nats\] of a changed motion: angles at the same times of a cycle, against the scatter of
/// times and 0.2 mrad of the servos.
fn evidence(arm: &Arm, program: &[Move], before: &Tuning, after: &Tuning) -> f64 {
    let still = |tuning: &Tuning| Tuning { scatter: 0.0, ..tuning.clone() };
    let mut rng = Rng::new(0, 0, "evidence");
    // Two cycles: a wait at the end shows in the second.
    let old = execute(arm, program, &still(before), 2, &mut rng);
    let new = execute(arm, program, &still(after), 2, &mut rng);
    let longest = old.len().max(new.len());
    let at = |rows: &[Row], k: usize, i: usize| rows.get(k).or(rows.last()).map_or(0.0, |row| row.0[i]);
    let mut delta = Vec::new();
    let mut sd = Vec::new();
    for i in 0..arm.axes() {
        let steps = (0..ROWS).map(|row| row * longest / ROWS);
        delta.push(steps.map(|k| at(&new, k, i) - at(&old, k, i)).collect::<Vec<f64>>());
        let moved: f64 = (1..old.len()).map(|k| (at(&old, k, i) - at(&old, k - 1, i)).powi(2)).sum();
        let rate = (moved / old.len().max(1) as f64).sqrt() / STEP;
        sd.push((0.0002_f64.powi(2) + (rate * 3.0 * before.scatter).powi(2)).sqrt());
    }
    nats(&delta, &sd, &[])
}

/// The logs, the held-out log and the baselines.
struct Logs<'a> {
    arm: &'a Arm,
    program: &'a [Move],
    rate: f64,
    cycle_column: bool,
}

impl Logs<'_> {
    fn taken(&self, name: String, tuning: &Tuning, cycles: usize, seed: (u64, usize)) -> model_file::File {
        let mut rng = Rng::new(seed.0, seed.1, &name);
        let rows = execute(self.arm, self.program, tuning, cycles, &mut rng);
        let text = csv(self.arm, &rows, self.rate, self.cycle_column, &mut rng);
        (name, text)
    }
}

/// A motion case; in [`HEALTHY`] of them nothing is wrong.
#[must_use]
pub fn case(seed: u64, number: usize) -> Case {
    let mut rng = Rng::new(seed, number, "motion");
    let arm = nominal(&mut Rng::new(seed, number, "robot"), number, true);
    let before = tuned(&mut rng);
    let mut program = moves(&arm, &mut rng);
    let mut length = execute(&arm, &program, &before, 1, &mut rng).len() as f64 * STEP;
    while length > LONGEST && program.len() > 4 {
        program.remove(1);
        length = execute(&arm, &program, &before, 1, &mut rng).len() as f64 * STEP;
    }
    let text = rapid(&arm, &mut program);
    let ids = ["tracking_lag", "zone_blending", "acceleration_limit", "speed_limit", "program_wait"];
    let mut wrong = None;
    if !rng.chance(HEALTHY) {
        let mut id = rng.pick(&ids, "tracking_lag");
        if id == "zone_blending" && program.iter().all(|step| step.zone.is_none()) {
            id = "tracking_lag";
        }
        wrong = Some(fault(id, &arm, &program, &before, &mut rng));
    }
    let cycles = rng.between(3, 10).min((120.0 / length) as usize).max(2);
    let mut rates = vec![50.0, 100.0, 125.0, 250.0];
    rates.retain(|rate| rate * length * cycles as f64 <= MOST_ROWS);
    let logs =
        Logs { arm: &arm, program: &program, rate: rng.pick(&rates, 50.0), cycle_column: rng.chance(0.5) };
    let now = wrong.as_ref().map_or(&before, |fault| &fault.tuning);
    let seeds = (seed, number);
    let mut files = vec![model_file::toml(&arm), ("program/MainModule.mod".to_owned(), text)];
    let present = rng.between(1, 2);
    let earlier = rng.between(1, 2);
    let mut names = [Vec::new(), Vec::new()];
    for k in 1..=present {
        names[0].push(format!("log-{k}.csv"));
        files.push(logs.taken(format!("log-{k}.csv"), now, cycles, seeds));
    }
    files.push(logs.taken("heldout.csv".to_owned(), now, cycles.min(4), seeds));
    for k in 1..=earlier {
        names[1].push(format!("baseline-{k}.csv"));
        files.push(logs.taken(format!("baseline-{k}.csv"), &before, cycles, seeds));
    }
    let options = json!({
        "robot": "nominal.toml",
        "trust": "commissioned",
        "program": "program/MainModule.mod",
        "log": names[0],
        "heldout": ["heldout.csv"],
        "baseline": names[1],
    });
    let mut lines = Vec::new();
    let mut effects = Vec::new();
    if let Some(fault) = &wrong {
        lines.extend(fault.at.iter().filter_map(|k| program.get(*k)).map(|step| step.line));
        let parameter = |(name, value, graded): (&str, f64, bool)| TrueParameter {
            name: name.to_owned(),
            joint: None,
            value,
            graded,
        };
        effects.push(Truth {
            id: fault.id.to_owned(),
            form: fault.form.to_owned(),
            joints: Vec::new(),
            parameters: fault.parameter.map(parameter).into_iter().collect(),
            window: None,
            equivalents: Vec::new(),
            nats: evidence(&arm, &program, &before, &fault.tuning),
        });
    }
    let kind = if wrong.is_some() { Kind::Motion } else { Kind::Healthy };
    Case { files, options, kind, effects, place: None, lines, heldout: Vec::new() }
}

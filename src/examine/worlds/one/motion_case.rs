//! Cases of motion: a RAPID program, and logs of its runs without torques.

use crate::api::{self, Case, Kind, TrueParameter, Truth};
use crate::arm::{Arm, MAX, Row, factor};
use crate::case::Plan;
use crate::controller::{Motion, Move, TICK, Tuning, run};
use crate::rng::Rng;
use serde_json::json;
use std::fmt::Write as _;

/// Share of programs in which nothing is wrong.
const HEALTHY: f64 = 0.4;
/// Moves of a program.
const MOVES: (usize, usize) = (5, 12);
/// Predefined speeds of RAPID \[mm/s\].
const SPEEDS: [f64; 9] = [200.0, 300.0, 400.0, 500.0, 600.0, 800.0, 1000.0, 1500.0, 2000.0];
/// Predefined zones of RAPID \[mm\].
const ZONES: [f64; 8] = [5.0, 10.0, 15.0, 20.0, 30.0, 50.0, 80.0, 100.0];
/// Share of moves that stop.
const FINE: f64 = 0.4;
/// Share of stops that wait, and for how long \[s\].
const WAITS: (f64, (f64, f64)) = (0.4, (0.2, 1.5));
/// Most seconds of a log.
const LONGEST: f64 = 90.0;
/// Lag of healthy servos \[s\].
const LAG: (f64, f64) = (0.004, 0.015);
/// Accelerations and speeds of a healthy robot differ from what is planned by these shares.
const OFF: (f64, f64) = (0.02, 0.004);
/// A controller's clock slips by up to this time \[s\] at each stop.
const SLIP: f64 = 0.004;
/// Repeatability of the program's clock \[s\].
const CLOCK: f64 = 0.004;
/// Noise of an angle beyond its quantisation \[rad\].
const NOISE: f64 = 0.000_02;
/// Rows in which motions are compared.
const ROWS: usize = 160;
/// Sampling rates \[Hz\].
const RATES: [f64; 4] = [50.0, 100.0, 125.0, 250.0];
/// A move's duration changes visibly from this share and time \[s\] on.
const VISIBLE: (f64, f64) = (0.015, 0.008);
/// Faults and forms.
const FAULTS: [(&str, [&str; 2]); 5] = [
    ("tracking_lag", ["first_order_servos", "second_order_servos"]),
    ("zone_blending", ["overlap_by_radius", "overlap_by_time"]),
    ("acceleration_limit", ["all_axes", "main_axes"]),
    ("speed_limit", ["override", "tool_ceiling"]),
    ("program_wait", ["constant", "polled_input"]),
];

/// A random program: moves, and its text.
fn program(arm: &Arm, rng: &mut Rng) -> (Row, Vec<Move>) {
    let pose = |rng: &mut Rng| {
        let mut q = [0.0; MAX];
        for j in 0..arm.count() {
            let (middle, half) =
                (0.5 * (arm.lower[j] + arm.upper[j]), 0.5 * (arm.upper[j] - arm.lower[j]));
            let degrees = (middle + 0.5 * half.min(2.4) * rng.uniform((-1.0, 1.0))).to_degrees();
            q[j] = ((degrees * 10.0).round() / 10.0).to_radians();
        }
        q
    };
    let home = pose(rng);
    let count = MOVES.0 + rng.below(MOVES.1 - MOVES.0 + 1);
    let (from, to) = (rng.below(3), 5 + rng.below(4));
    let mut moves = Vec::new();
    for k in 0..count {
        let last = k + 1 == count;
        let fine = last || rng.chance(FINE);
        let wait = if fine && rng.chance(WAITS.0) {
            (rng.uniform(WAITS.1) * 20.0).round() / 20.0
        } else {
            0.0
        };
        moves.push(Move {
            to: if last { home } else { pose(rng) },
            speed: SPEEDS[from + rng.below(to - from)] / 1000.0,
            zone: if fine { 0.0 } else { ZONES[rng.below(ZONES.len())] / 1000.0 },
            wait,
            line: 0,
        });
    }
    (home, moves)
}

/// A jointtarget in degrees.
fn target(name: &str, q: &Row) -> String {
    let axes: Vec<String> = q[..6].iter().map(|x| format!("{:.1}", x.to_degrees())).collect();
    format!("  CONST jointtarget {name} := [[{}],[9E9,9E9,9E9,9E9,9E9,9E9]];\n", axes.join(","))
}

/// The text of the program; sets the lines of the moves.
fn text(home: &Row, moves: &mut [Move]) -> String {
    let mut out = "MODULE MainModule\n".to_owned();
    out.push_str(&target("jHome", home));
    let count = moves.len();
    for (k, part) in moves.iter().enumerate().take(count - 1) {
        out.push_str(&target(&format!("jPos{}", k + 1), &part.to));
    }
    out.push_str("\n  PROC main()\n");
    for (k, part) in moves.iter_mut().enumerate() {
        part.line = out.lines().count() + 1;
        let name = if k + 1 == count { "jHome".to_owned() } else { format!("jPos{}", k + 1) };
        let zone =
            if part.zone > 0.0 { format!("z{:.0}", part.zone * 1000.0) } else { "fine".to_owned() };
        let _ = writeln!(out, "    MoveAbsJ {name},v{:.0},{zone},tool0;", part.speed * 1000.0);
        if part.wait > 0.0 {
            let _ = writeln!(out, "    WaitTime {};", part.wait);
        }
    }
    out.push_str("  ENDPROC\nENDMODULE\n");
    out
}

/// A fault of motion.
struct Fault {
    number: usize,
    form: usize,
    value: f64,
    after: usize,
}

impl Fault {
    /// A random one that the program can show.
    fn new(moves: &[Move], rng: &mut Rng) -> Self {
        let stops: Vec<usize> = (0..moves.len() - 1).filter(|k| moves[*k].zone == 0.0).collect();
        let zones = moves.iter().filter(|m| m.zone >= 0.02).count();
        let mut number = rng.below(FAULTS.len());
        while (number == 1 && zones < 2) || (number == 4 && stops.is_empty()) {
            number = rng.below(FAULTS.len());
        }
        let value = match number {
            0 => rng.log((0.012, 0.15)),
            1 if rng.chance(0.5) => rng.log((0.15, 0.75)),
            1 => rng.log((1.35, 4.0)),
            2 if rng.chance(0.3) => rng.log((1.12, 1.8)),
            2 => rng.log((0.35, 0.93)),
            3 => rng.log((0.4, 0.96)),
            _ => rng.log((0.04, 2.0)),
        };
        let after = if stops.is_empty() { 0 } else { stops[rng.below(stops.len())] };
        Self { number, form: rng.below(2), value, after }
    }

    /// The controller with the fault.
    fn on(&self, healthy: &Tuning, moves: &[Move], cycles: usize, rng: &mut Rng) -> Tuning {
        let mut out = healthy.clone();
        match (self.number, self.form) {
            (0, form) => {
                for lag in &mut out.lag {
                    *lag += self.value * if form == 0 { 1.0 + 0.06 * rng.normal() } else { 1.0 };
                }
                out.second = form == 1;
            }
            (1, 0) => out.zone *= self.value,
            (1, _) => out.overlap *= self.value,
            (2, form) => {
                let axes = if form == 0 { MAX } else { 3 };
                for a in out.acceleration.iter_mut().take(axes) {
                    *a *= self.value;
                }
            }
            (3, 0) => out.speed *= self.value,
            (3, _) => {
                let top = moves.iter().map(|m| m.speed).fold(0.0, f64::max);
                out.ceiling = top * self.value;
            }
            (_, form) => {
                let waits = (0..cycles)
                    .map(|_| {
                        if form == 0 {
                            self.value
                        } else {
                            // An input is polled every 50 ms; it comes earlier or later.
                            (self.value * rng.uniform((0.4, 1.6)) / 0.05).ceil() * 0.05
                        }
                    })
                    .collect();
                out.waits = Some((self.after, waits));
            }
        }
        out
    }

    /// The parameter.
    fn parameter(&self) -> TrueParameter {
        let name = ["lag", "factor", "factor", "factor", "wait"][self.number];
        let graded = matches!((self.number, self.form), (0, _) | (1..=3 | 4, 0));
        TrueParameter { name: name.to_owned(), joint: None, value: self.value, graded }
    }
}

/// Angles of one cycle at rows from its start, the cycle's end being held.
fn rows(motion: &Motion, span: usize) -> Vec<Row> {
    let start = motion.starts.first().copied().unwrap_or(0);
    let end = motion.starts.get(1).copied().unwrap_or(motion.q.len()).max(start + 1);
    let last = motion.q.len() - 1;
    (0..ROWS).map(|k| motion.q[(start + k * span / ROWS).min(end - 1).min(last)]).collect()
}

/// Differences of rows by joint.
fn difference(a: &[Row], b: &[Row], count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|j| a.iter().zip(b).map(|(x, y)| x[j] - y[j]).collect()).collect()
}

/// Expected log-likelihood ratio \[nats\] of a fault against the clock's slip, and small changes of the
/// planner and the servos.
fn nats(
    arm: &Arm,
    setting: (&Row, &[Move]),
    healthy: &Tuning,
    faulty: &Tuning,
    cycles: usize,
) -> f64 {
    let (home, moves) = setting;
    let plain = run(arm, home, moves, healthy, 1);
    let with = run(arm, home, moves, faulty, 1);
    let span = plain.q.len().max(with.q.len());
    let (a, b) = (rows(&plain, span), rows(&with, span));
    let count = arm.count();
    let near = |change: &dyn Fn(&mut Tuning)| {
        let mut tuning = healthy.clone();
        change(&mut tuning);
        difference(&rows(&run(arm, home, moves, &tuning, 1), span), &a, count)
    };
    let columns = [
        near(&|t| t.lag = t.lag.map(|x| x + 0.001)),
        near(&|t| t.speed *= 1.0 + OFF.1),
        near(&|t| t.acceleration = t.acceleration.map(|x| x * 1.005)),
        near(&|t| t.zone *= 1.03),
    ];
    let mut sd = [0.0; MAX];
    for j in 0..count {
        let speeds = plain.q.windows(2).map(|w| ((w[1][j] - w[0][j]) / TICK).powi(2)).sum::<f64>();
        let speed = (speeds / plain.q.len() as f64).sqrt();
        sd[j] = (CLOCK * speed / (cycles as f64).sqrt()).max(NOISE * 5.0);
    }
    api::nats(&difference(&b, &a, count), &sd[..count], &columns)
}

/// A log as CSV.
fn csv(motion: &Motion, arm: &Arm, habit: (f64, bool, f64, f64), rng: &mut Rng) -> String {
    let (rate, with_cycle, clock, step) = habit;
    let mut out = "t,q1,q2,q3,q4,q5,q6,cmd".to_owned();
    out.push_str(if with_cycle { ",cycle\n" } else { "\n" });
    let count = (motion.q.len() as f64 * TICK * rate).floor() as usize;
    for k in 0..count {
        let t = k as f64 / rate + 0.02 * rng.uniform((0.0, 1.0)) / rate;
        let place = t / TICK;
        let (at, x) = (place as usize, place.fract());
        let next = (at + 1).min(motion.q.len() - 1);
        let at = at.min(next);
        let _ = write!(out, "{:.5}", t + clock);
        for j in 0..arm.count() {
            let q =
                motion.q[at][j] + x * (motion.q[next][j] - motion.q[at][j]) + NOISE * rng.normal();
            let _ = write!(out, ",{:.6}", (q / step).round() * step);
        }
        let _ = write!(out, ",{}", motion.command[at]);
        if with_cycle {
            let _ = write!(out, ",{}", motion.cycle[at]);
        }
        out.push('\n');
    }
    out
}

/// A healthy controller.
fn healthy(rng: &mut Rng) -> Tuning {
    let lag = rng.log(LAG);
    let off = factor(rng, OFF.0);
    let mut tuning = Tuning {
        speed: factor(rng, OFF.1),
        ceiling: f64::MAX,
        acceleration: [off; MAX],
        zone: factor(rng, 0.03),
        overlap: 1.0,
        lag: [lag; MAX],
        second: false,
        waits: None,
    };
    for j in 0..MAX {
        tuning.lag[j] *= factor(rng, 0.1);
        tuning.acceleration[j] *= factor(rng, 0.5 * OFF.0);
    }
    tuning
}

/// Lines at which a fault shows.
fn lines(fault: &Fault, moves: &[Move], plain: &Motion, with: &Motion) -> Vec<usize> {
    match fault.number {
        0 => Vec::new(),
        1 => moves.iter().filter(|m| m.zone > 0.0).map(|m| m.line).collect(),
        4 => vec![moves[fault.after].line, moves[(fault.after + 1) % moves.len()].line],
        _ => moves
            .iter()
            .zip(plain.durations.iter().zip(&with.durations))
            .filter(|(_, (a, b))| {
                let change = f64::abs(*b - *a);
                change > VISIBLE.1 && change > VISIBLE.0 * **a
            })
            .map(|(m, _)| m.line)
            .collect(),
    }
}

/// Makes a case.
pub fn make(plan: &Plan) -> Case {
    let mut rng = plan.rng("program");
    let arm = &plan.nominal;
    let (home, mut moves) = program(arm, &mut rng);
    let code = text(&home, &mut moves);
    let tuning = healthy(&mut rng);
    let one = run(arm, &home, &moves, &tuning, 1);
    let period = one.q.len() as f64 * TICK;
    let cycles = (3 + rng.below(6)).min((LONGEST / period) as usize).max(2);
    let fault = (!rng.chance(HEALTHY)).then(|| Fault::new(&moves, &mut rng));
    let habit = (
        RATES[rng.below(RATES.len())],
        rng.chance(0.5),
        if rng.chance(0.25) { rng.log((10.0, 50_000.0)).round() } else { 0.0 },
        rng.log((1e-6, 1e-4)),
    );
    let (file, robot) = plan.robot_file();
    let mut files = vec![(file, robot), ("program/MainModule.mod".to_owned(), code)];
    let mut effects = Vec::new();
    let mut shown = Vec::new();
    let record = |name: &str, faulty: bool, files: &mut Vec<(String, String)>| {
        let mut own = plan.rng(name);
        let mut day = moves.clone();
        for part in &mut day {
            // Stops take a little longer or shorter each day.
            part.wait += if part.wait > 0.0 { SLIP * own.unit() } else { 0.0 };
        }
        let tuned = match &fault {
            Some(fault) if faulty => fault.on(&tuning, &moves, cycles, &mut plan.rng("fault")),
            _ => tuning.clone(),
        };
        files.push((
            name.to_owned(),
            csv(&run(arm, &home, &day, &tuned, cycles), arm, habit, &mut own),
        ));
    };
    record("log-1.csv", true, &mut files);
    record("heldout.csv", true, &mut files);
    record("baseline-1.csv", false, &mut files);
    if let Some(fault) = &fault {
        let faulty = fault.on(&tuning, &moves, cycles, &mut plan.rng("fault"));
        shown = lines(fault, &moves, &one, &run(arm, &home, &moves, &faulty, 1));
        effects.push(Truth {
            id: FAULTS[fault.number].0.to_owned(),
            form: FAULTS[fault.number].1[fault.form].to_owned(),
            joints: Vec::new(),
            parameters: vec![fault.parameter()],
            window: None,
            equivalents: Vec::new(),
            nats: nats(arm, (&home, &moves), &tuning, &faulty, cycles),
        });
    }
    let list = |name: &str| vec![name.to_owned()];
    let names = [list("log-1.csv"), list("heldout.csv"), list("baseline-1.csv")];
    let mut options = plan.options([&names[0], &names[1], &names[2]], 0.0);
    options["program"] = json!("program");
    let kind = if fault.is_some() { Kind::Motion } else { Kind::Healthy };
    Case { files, options, kind, effects, place: None, lines: shown, heldout: Vec::new() }
}

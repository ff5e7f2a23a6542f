//! Cases of motion: a RAPID program, and logs of its runs without torques.

use super::arm::{Arm, factor};
use super::controller::{Motion, TICK, Tuning, run};
use super::plan::Plan;
use crate::examine::worlds::api::{self, Case, Kind, MODULE, Truth, program_options};
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::program::{Move, Recorder, module};
use crate::examine::worlds::random::Rng;

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
        });
    }
    (home, moves)
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
                    *lag += self.value * if form == 0 { 1.0 + 0.06 * rng.spread(1.0) } else { 1.0 };
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

    fn truth(&self) -> Truth {
        let (id, forms) = FAULTS[self.number];
        let name = ["lag", "factor", "factor", "factor", "wait"][self.number];
        let graded = self.number == 0 || self.form == 0;
        let mut truth = Truth::new(id, forms[self.form], &[]);
        truth.tell(name, None, self.value, graded);
        truth
    }
}

/// Angles of one cycle at rows from its start, the cycle's end being held.
fn rows(motion: &Motion, span: usize) -> Vec<Row> {
    let start = motion.starts.first().copied().unwrap_or(0);
    let end = motion.starts.get(1).copied().unwrap_or(motion.rows.len()).max(start + 1);
    let last = motion.rows.len() - 1;
    (0..ROWS).map(|k| motion.rows[(start + k * span / ROWS).min(end - 1).min(last)].0).collect()
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
    let span = plain.rows.len().max(with.rows.len());
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
        let speeds =
            plain.rows.windows(2).map(|w| ((w[1].0[j] - w[0].0[j]) / TICK).powi(2)).sum::<f64>();
        let speed = (speeds / plain.rows.len() as f64).sqrt();
        sd[j] = (CLOCK * speed / (cycles as f64).sqrt()).max(NOISE * 5.0);
    }
    api::nats(&difference(&b, &a, count), &sd[..count], &columns)
}

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

/// Moves, from 0, at which a fault shows.
fn shown(fault: &Fault, moves: &[Move], plain: &Motion, with: &Motion) -> Vec<usize> {
    let changes = |k: &usize| {
        let change = (with.durations[*k] - plain.durations[*k]).abs();
        change > VISIBLE.1 && change > VISIBLE.0 * plain.durations[*k]
    };
    match fault.number {
        0 => Vec::new(),
        1 => (0..moves.len()).filter(|k| moves[*k].zone > 0.0).collect(),
        4 => vec![fault.after, (fault.after + 1) % moves.len()],
        _ => (0..moves.len()).filter(changes).collect(),
    }
}

pub(super) fn make(plan: &Plan) -> Case {
    let mut rng = plan.rng("program");
    let arm = &plan.nominal;
    let (home, moves) = program(arm, &mut rng);
    let (code, lines) = module(&moves, arm.count());
    let tuning = healthy(&mut rng);
    let one = run(arm, &home, &moves, &tuning, 1);
    let period = one.rows.len() as f64 * TICK;
    let cycles = (3 + rng.below(6)).min((LONGEST / period) as usize).max(2);
    let fault = (!rng.chance(HEALTHY)).then(|| Fault::new(&moves, &mut rng));
    let recorder = Recorder {
        n: arm.count(),
        rate: rng.pick(&RATES),
        cycles: rng.chance(0.5),
        start: if rng.chance(0.25) { rng.log((10.0, 50_000.0)).round() } else { 0.0 },
        step: rng.log((1e-6, 1e-4)),
        noise: NOISE,
        lost: 0.0,
    };
    let faulty =
        fault.as_ref().map(|fault| fault.on(&tuning, &moves, cycles, &mut plan.rng("fault")));
    let mut files = vec![plan.robot_file(), (MODULE.to_owned(), code)];
    let tuned = faulty.as_ref().unwrap_or(&tuning);
    for (name, tuning) in
        [("log-1.csv", tuned), ("heldout.csv", tuned), ("baseline-1.csv", &tuning)]
    {
        let mut own = plan.rng(name);
        let mut day = moves.clone();
        for part in day.iter_mut().filter(|part| part.wait > 0.0) {
            // Stops take a little longer each day.
            part.wait += SLIP * own.unit();
        }
        let motion = run(arm, &home, &day, tuning, cycles);
        files.push((name.to_owned(), recorder.csv(&motion.rows, TICK, &mut own)));
    }
    let options = program_options(&files[0].0, plan.spread.trust);
    let mut case = Case::new(files, options, Kind::Healthy);
    if let (Some(fault), Some(faulty)) = (&fault, &faulty) {
        let with = run(arm, &home, &moves, faulty, 1);
        case.kind = Kind::Motion;
        case.lines = shown(fault, &moves, &one, &with).into_iter().map(|k| lines[k]).collect();
        let nats = nats(arm, (&home, &moves), &tuning, faulty, cycles);
        case.effects.push(Truth { nats, ..fault.truth() });
    }
    case
}

//! Cases of motion: logs of a program without torques.

use super::everyday::{Day, scale};
use super::fault::{Action, Fault};
use super::logger::{Style, csv};
use super::motion::{GRID, Motion};
use super::plant::{Plant, Record, Run};
use super::program::{Planned, Planner, draw, plan};
use super::setup::{Setup, plant, setup};
use super::sim::run;
use crate::examine::worlds::api::{Case, Kind, MODULE, Truth, nats, program_options};
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::program::{Move, module};
use crate::examine::worlds::random::Rng;

/// Share of cases without a fault.
const HEALTHY: f64 = 0.4;
/// Simulated time of one log \[s\].
const LONGEST: f64 = 45.0;
/// Steps of the simulation \[s\]: of shorter and longer logs, and the time of a log between them \[s\].
const STEP: (f64, f64) = (5e-4, 1e-3);
const LONG: f64 = 45.0;
/// Everyday error of the time \[s\] and of angles \[rad\].
const EVERYDAY: (f64, f64) = (0.003, 2e-4);

/// How the servos follow in a faulty robot.
#[derive(Clone, Copy, Debug, Default)]
struct Servo {
    /// Lag from a low gain without feed-forward \[s\].
    soft: f64,
    /// Dead time of the reference \[s\].
    dead: f64,
    /// Moving average of the reference \[s\].
    mean: f64,
}

/// Draws a fault of motion.
fn draw_fault(program: &[Move], rng: &mut Rng) -> (Fault, Planner, Servo) {
    let (mut planner, mut servo) = (Planner::default(), Servo::default());
    let second = rng.chance(0.5);
    let begin = |id: &str, form: &str| Fault::new(id, form, &[], Action::Nothing);
    let fastest = program.iter().map(|step| step.speed).fold(0.0, f64::max);
    let zones = program.iter().filter(|step| step.zone > 0.0).count();
    let mut which = rng.below(5);
    if which == 1 && zones < 3 {
        which = 0;
    }
    let fault = match which {
        0 => {
            let lag = rng.log_between(0.012, 0.12);
            let form = rng.below(3);
            match form {
                0 => servo.soft = lag,
                1 => servo.dead = lag,
                _ => servo.mean = 2.0 * lag,
            }
            let name =
                ["low gain without feed-forward", "dead time of the reference", "moving average"]
                    [form];
            begin("tracking_lag", name).graded("lag", None, lag)
        }
        1 => {
            if second {
                planner.zone.1 = rng.between(0.001, 0.006);
                begin("zone_blending", "zones are clipped").own("factor", None, 0.2)
            } else {
                planner.zone.0 = rng.pick(&[0.0, 0.1, 0.3, 2.5, 4.0]);
                begin("zone_blending", "all zones").graded("factor", None, planner.zone.0)
            }
        }
        2 => {
            let factor = rng.pick(&[0.3, 0.45, 0.6, 0.75, 1.4]);
            planner.acceleration = (factor, if second { 3 } else { MAX });
            let name = if second { "main axes alone" } else { "all axes" };
            begin("acceleration_limit", name).parameter("factor", None, factor, !second)
        }
        3 => {
            let factor = rng.between(0.35, 0.85);
            if second {
                planner.speed.1 = factor * fastest;
            } else {
                planner.speed.0 = factor;
            }
            let name = if second { "fast moves are capped" } else { "override" };
            begin("speed_limit", name).parameter("factor", None, factor, !second)
        }
        _ => {
            let wait = rng.log_between(0.06, 2.0);
            let place = rng.below(program.len() - 1);
            let spread = if second { 0.4 } else { 0.0 };
            planner.wait = (wait, place, spread, rng.chance(0.3));
            let name = if second { "differs from cycle to cycle" } else { "always as long" };
            begin("program_wait", name).graded("wait", None, wait)
        }
    };
    (fault, planner, servo)
}

/// Moves, from 0, at which a fault appears.
fn shown(fault: &Fault, planner: &Planner, program: &[Move]) -> Vec<usize> {
    match fault.truth.id.as_str() {
        "program_wait" => vec![planner.wait.1, planner.wait.1 + 1],
        "zone_blending" => (0..program.len()).filter(|k| program[*k].zone > 0.0).collect(),
        _ => Vec::new(),
    }
}

/// A reference that is late in the faulty way.
fn late(planned: &Planned, servo: &Servo) -> Motion {
    let motion = &planned.motion;
    let dead = (servo.dead / GRID).round() as usize;
    let mean = ((servo.mean / GRID).round() as usize).max(1);
    if dead == 0 && mean == 1 {
        return motion.clone();
    }
    let filtered = |rows: &[Row]| -> Vec<Row> {
        let mut sum = rows.first().copied().unwrap_or([0.0; MAX]).map(|x| x * mean as f64);
        let at = |k: usize, back: usize| rows[k.saturating_sub(back)];
        (0..rows.len())
            .map(|k| {
                let (new, old) = (at(k, dead), at(k, dead + mean));
                for i in 0..MAX {
                    sum[i] += new[i] - old[i];
                }
                sum.map(|x| x / mean as f64)
            })
            .collect()
    };
    Motion { q: filtered(&motion.q), v: filtered(&motion.v), a: filtered(&motion.a) }
}

/// What all logs of a case share.
struct Bench<'a> {
    plant: Plant,
    style: &'a Style,
    rate: f64,
    dt: f64,
    count: bool,
}

impl Bench<'_> {
    fn log(&self, planned: &Planned, servo: &Servo, rng: &mut Rng) -> (Record, String) {
        let mut plant = self.plant.clone();
        if servo.soft > 0.0 {
            // The lag of a cascade without feed-forward is 1/gain: both are lowered together.
            let gain = plant.gains.position * plant.gains.speed;
            let lower = gain.min(0.95 / servo.soft);
            plant.gains.position = lower / plant.gains.speed;
            plant.gains.forward = 1.0 - servo.soft * lower;
            plant.gains.integral = 0.0;
        }
        let motion = late(planned, servo);
        let n = plant.robot.arm.n();
        let day = Day::draw(n, 1, rng);
        let set =
            Run { motion: &motion, cycles: 1, dt: self.dt, rate: self.rate, transient: false, day };
        let record = run(&plant, &[], &set, rng);
        let at = |list: &[usize]| -> Vec<f64> {
            record
                .t
                .iter()
                .map(|t| list.get((t / GRID + 0.5) as usize).copied().unwrap_or(0) as f64)
                .collect()
        };
        let mut extra = vec![("cmd", 0, at(&planned.command))];
        if self.count {
            extra.push(("cycle", 0, at(&planned.cycle)));
        }
        let text = csv(self.style, &record, false, &extra, rng);
        (record, text)
    }
}

/// Makes a case of motion.
pub(super) fn case(seed: u64, number: usize) -> Case {
    let stream = |purpose: &str| Rng::stream(seed, number, purpose);
    let mut rng = stream("motion");
    let setup = setup(true, false, true, &mut stream("robot"));
    let n = setup.nominal.arm.n();
    let program = draw(&setup.nominal, &mut stream("program"));
    let (module, of_moves) = module(&program, n);
    let one = plan(&setup.nominal, &program, &Planner::default(), 1, &mut stream("one"));
    let cycles = ((LONGEST / one.motion.period()) as usize).clamp(3, 8);
    let healthy = rng.chance(HEALTHY);
    let (fault, planner, servo) = draw_fault(&program, &mut rng);
    let rows = one.motion.thinned(200);
    let levels = scale(&setup.robot, &rows);
    let rate = rng.pick(&[50.0, 100.0, 125.0, 250.0]);
    let style = Style::draw(n, &levels.torque, &setup.nominal.torque, rate, &mut stream("style"));
    let bench = Bench {
        plant: plant(&setup, &levels, &rows, &mut stream("plant")),
        style: &style,
        rate,
        dt: if one.motion.period() * cycles as f64 > LONG { STEP.1 } else { STEP.0 },
        count: rng.chance(0.5),
    };
    let mut files = vec![setup.file(), (MODULE.to_owned(), module)];
    let (changed, follow) =
        if healthy { (Planner::default(), Servo::default()) } else { (planner, servo) };
    let mut noise = stream("noise");
    let logs = 1 + rng.below(2);
    let mut delta = 0.0;
    for k in 0..=logs {
        let planned = plan(&setup.nominal, &program, &changed, cycles, &mut noise);
        let (record, csv) = bench.log(&planned, &follow, &mut noise);
        let name = if k == logs { "heldout.csv".to_owned() } else { format!("log-{}.csv", k + 1) };
        files.push((name, csv));
        if k == 0 && !healthy {
            delta = information(&setup, &one, &planned, &record, cycles);
        }
    }
    for k in 0..=rng.below(2) {
        let planned = plan(&setup.nominal, &program, &Planner::default(), cycles, &mut noise);
        let (_, csv) = bench.log(&planned, &Servo::default(), &mut noise);
        files.push((format!("baseline-{}.csv", k + 1), csv));
    }
    let options = program_options(&files[0].0, setup.spread.trust);
    let mut case = Case::new(files, options, Kind::Healthy);
    if !healthy {
        case.kind = Kind::Motion;
        let at = shown(&fault, &planner, &program);
        case.lines = at.into_iter().filter_map(|k| of_moves.get(k)).copied().collect();
        case.effects.push(Truth { nats: delta, ..fault.truth });
    }
    case
}

/// Information \[nats\]: angles of the last cycle against those of a healthy plan, time from its start.
fn information(
    setup: &Setup,
    one: &Planned,
    planned: &Planned,
    record: &Record,
    cycles: usize,
) -> f64 {
    let n = setup.nominal.arm.n();
    let (start, own) =
        (planned.starts.last().copied().unwrap_or(0.0), one.starts.first().copied().unwrap_or(0.0));
    let length = one.motion.period() - own - 0.4;
    let (mut delta, mut speed) = (vec![Vec::new(); n], vec![Vec::new(); n]);
    let count = 120;
    for k in 0..count {
        let t = length * f64::from(k) / f64::from(count);
        let row = record.t.partition_point(|x| *x < start + t);
        let (q, v, _) = one.motion.at(own + record.t.get(row).map_or(t, |x| x - start));
        if let Some(real) = record.q.get(row) {
            for i in 0..n {
                delta[i].push(real[i] - q[i]);
                speed[i].push(v[i]);
            }
        }
    }
    let sd: Vec<f64> = speed
        .iter()
        .map(|list| {
            let rms = (list.iter().map(|x| x * x).sum::<f64>() / list.len().max(1) as f64).sqrt();
            (EVERYDAY.0 * rms).hypot(EVERYDAY.1) / (cycles as f64).sqrt()
        })
        .collect();
    nats(&delta, &sd, &[])
}

//! Cases of electric power.

use super::logger::{Style, csv};
use super::plant::{Plant, Record};
use super::power::{self, Everyday, Loss, Means, power};
use super::robot::Robot;
use super::setup::{Plan, Setup, levels, plan, plant, setup};
use super::torque_case::{simulate, told};
use super::truth;
use crate::examine::worlds::api::{Case, Kind, Truth, largest, nats, options};
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Relative standard deviation of the meter's noise, of the mean power.
const NOISE: (f64, f64) = (0.003, 0.012);
/// Rows for the information.
const ROWS: usize = 150;
/// Standard deviations of the base load and of the share that is given back, and of the torque's gain.
const BELIEF: (f64, f64, f64) = (0.05, 0.1, 0.02);

/// What makes the power logs of a case.
struct Meter<'a> {
    plant: &'a Plant,
    plan: &'a Plan,
    everyday: Everyday,
    style: &'a Style,
    noise: f64,
}

impl Meter<'_> {
    fn text(&self, record: &Record, fault: Option<&Loss>, rng: &mut Rng) -> String {
        let (mut watts, _, _) =
            power(&self.plant.robot, &self.everyday, fault, record, self.plan.rate);
        for x in &mut watts {
            *x += self.noise * rng.normal();
        }
        csv(self.style, record, true, &[("power", 2, watts)], rng)
    }
}

fn squares(record: &Record) -> (Row, Row) {
    let count = record.t.len().max(1) as f64;
    let (mut torque, mut speed) = ([0.0; MAX], [0.0; MAX]);
    for (v, tau) in record.v.iter().zip(&record.motor) {
        for i in 0..MAX {
            torque[i] += tau[i] * tau[i] / count;
            speed[i] += v[i] * v[i] / count;
        }
    }
    (torque, speed)
}

fn everyday(robot: &Robot, rng: &mut Rng) -> Everyday {
    Everyday {
        warm: rng.between(0.0, 0.05),
        inverter: rng.between(0.0, 0.02),
        meter: rng.between(0.004, 0.03),
        base: (0.01 * robot.base_w * rng.unit(), rng.between(0.02, 0.2)),
    }
}

/// Mean power given back \[W\].
fn braking(robot: &Robot, record: &Record) -> f64 {
    let rows = record.v.iter().zip(&record.motor);
    let sum: f64 =
        rows.map(|(v, tau)| v.iter().zip(tau).map(|(a, b)| (-a * b).max(0.0)).sum::<f64>()).sum();
    robot.regeneration * sum / record.t.len().max(1) as f64
}

/// Makes a case of power.
pub(super) fn case(seed: u64, number: usize) -> Case {
    let stream = |purpose: &str| Rng::stream(seed, number, purpose);
    let mut rng = stream("power");
    let which = rng.below(6);
    let setup = {
        let mut setup = setup(true, true, false, &mut stream("robot"));
        let share = if which == 3 { rng.between(0.6, 0.95) } else { setup.nominal.regeneration };
        setup.nominal.regeneration = (share * 100.0).round() / 100.0;
        setup.robot.regeneration =
            setup.nominal.regeneration * (1.0 + 0.02 * rng.normal()).min(1.03);
        setup
    };
    let plan = plan(&setup, which == 5, &mut stream("plan"));
    let (scale, rows) = levels(&setup, &plan);
    let plant = plant(&setup, &scale, &rows, &mut stream("plant"));
    let n = setup.nominal.arm.n();
    let style =
        Style::draw(n, &scale.torque, &setup.nominal.torque, plan.rate, &mut stream("style"));
    let mut days = stream("days");
    let records: Vec<Record> = plan
        .motions
        .iter()
        .map(|motion| simulate(&plant, &[], motion, (&plan, plan.cycles), &mut days))
        .collect();
    let mut meter = Meter {
        plant: &plant,
        plan: &plan,
        everyday: everyday(&setup.robot, &mut rng),
        style: &style,
        noise: 0.0,
    };
    let first = &records[0];
    let (plain, _, _) = power(&setup.robot, &meter.everyday, None, first, plan.rate);
    let mean = plain.iter().sum::<f64>() / plain.len().max(1) as f64;
    meter.noise = rng.log_between(NOISE.0, NOISE.1) * mean;
    let (torque, speed) = squares(first);
    let means = Means {
        base: setup.robot.base_w,
        power: (mean - setup.robot.base_w).max(0.05 * mean),
        torque: &torque,
        speed: &speed,
        braking: braking(&setup.robot, first),
        n,
    };
    let (fault, loss) = power::draw(which, &means, &mut rng);
    finish(&setup, &meter, &records, (fault, &loss), &stream)
}

/// Writes the logs and the truth.
fn finish(
    setup: &Setup,
    meter: &Meter,
    records: &[Record],
    (mut fault, loss): (Truth, &Loss),
    stream: &dyn Fn(&str) -> Rng,
) -> Case {
    let (plan, plant) = (meter.plan, meter.plant);
    let (mut days, mut noise) = (stream("more days"), stream("noise"));
    let mut files = vec![setup.file()];
    for (k, record) in records.iter().enumerate() {
        files.push((format!("log-{}.csv", k + 1), meter.text(record, Some(loss), &mut noise)));
    }
    let held = simulate(plant, &[], &plan.heldout, (plan, plan.heldout_cycles), &mut days);
    files.push(("heldout.csv".to_owned(), meter.text(&held, Some(loss), &mut noise)));
    for k in 0..plan.baselines.max(1) {
        let motion = &plan.motions[k % plan.motions.len()];
        let record = simulate(plant, &[], motion, (plan, plan.cycles), &mut days);
        files.push((format!("baseline-{}.csv", k + 1), meter.text(&record, None, &mut noise)));
    }
    fault.nats = information(meter, records, loss);
    let shares = power(&plant.robot, &meter.everyday, Some(loss), &records[0], plan.rate).2;
    let told = told(plan, &mut stream("options"));
    let options = options(&files[0].0, setup.spread.trust, told);
    Case {
        place: if fault.joints.is_empty() { None } else { largest(&shares) },
        effects: vec![fault],
        heldout: truth::levels(plant, &setup.in_file, &held),
        ..Case::new(files, options, Kind::Power)
    }
}

/// Information about the fault \[nats\]: one row of powers.
fn information(meter: &Meter, records: &[Record], loss: &Loss) -> f64 {
    let robot = &meter.plant.robot;
    let n = robot.arm.n();
    let mut delta = Vec::new();
    let mut columns = vec![Vec::new(); n + 3];
    let mut mean = 0.0;
    for record in records {
        let (watts, added, _) = power(robot, &meter.everyday, Some(loss), record, meter.plan.rate);
        let step = (record.t.len() / ROWS).max(1);
        for row in (0..record.t.len()).step_by(step) {
            delta.push(added[row]);
            mean += watts[row].abs();
            let (v, tau) = (&record.v[row], &record.motor[row]);
            let mechanical: Vec<f64> = (0..n).map(|i| v[i] * tau[i]).collect();
            for i in 0..n {
                columns[i].push(0.1 * robot.loss[i] * tau[i] * tau[i]);
            }
            columns[n].push(BELIEF.0 * robot.base_w);
            columns[n + 1].push(BELIEF.1 * mechanical.iter().map(|p| p.min(0.0)).sum::<f64>());
            columns[n + 2].push(BELIEF.2 * mechanical.iter().map(|p| p.max(0.0)).sum::<f64>());
        }
    }
    mean /= delta.len().max(1) as f64;
    let sd = (meter.noise.powi(2) / meter.plan.cycles as f64).sqrt().hypot(0.01 * mean);
    let columns: Vec<Vec<Vec<f64>>> = columns.into_iter().map(|column| vec![column]).collect();
    nats(&[delta], &[sd], &columns)
}

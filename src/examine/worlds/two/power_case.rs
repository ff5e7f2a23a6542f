//! Cases of electric power.

use crate::api::{self, Case, Kind};
use crate::everyday::Scale;
use crate::logger::{Style, csv};
use crate::power::{self, Everyday, Loss, Means, power};
use crate::rigid::{Joints, MAX};
use crate::rng::Rng;
use crate::robot::Robot;
use crate::setup::{Plan, Setup, levels, plan, plant, setup};
use crate::sim::{Plant, Record};
use crate::torque_case::{Files, options, robot_file, simulate};
use crate::truth;

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
        let (mut watts, _, _) = power(&self.plant.robot, &self.everyday, fault, record, self.plan.rate);
        for x in &mut watts {
            *x += self.noise * rng.normal();
        }
        csv(self.style, record, true, &[("power", 2, watts)], rng)
    }
}

/// Means of a record.
fn squares(record: &Record) -> (Joints, Joints) {
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
        warm: rng.range(0.0, 0.05),
        inverter: rng.range(0.0, 0.02),
        meter: rng.range(0.004, 0.03),
        base: (0.01 * robot.base_w * rng.unit(), rng.range(0.02, 0.2)),
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
pub fn case(seed: u64, number: usize) -> Case {
    let stream = |purpose: &str| Rng::new(seed, number, purpose);
    let mut rng = stream("power");
    let which = rng.below(6);
    let setup = {
        let mut setup = setup(true, true, false, &mut stream("robot"));
        let share = if which == 3 { rng.range(0.6, 0.95) } else { setup.nominal.regeneration };
        setup.nominal.regeneration = (share * 100.0).round() / 100.0;
        setup.robot.regeneration = setup.nominal.regeneration * (1.0 + 0.02 * rng.normal()).min(1.03);
        setup
    };
    let plan = plan(&setup, which == 5, &mut stream("plan"));
    let (scale, rows) = levels(&setup, &plan);
    let plant = plant(&setup, &scale, &rows, &mut stream("plant"));
    let n = setup.nominal.arm.n();
    let style = Style::draw(n, &scale.torque, &setup.nominal.torque, plan.rate, &mut stream("style"));
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
    let Some(first) = records.first() else { return empty() };
    let (plain, _, _) = power(&setup.robot, &meter.everyday, None, first, plan.rate);
    let mean = plain.iter().sum::<f64>() / plain.len().max(1) as f64;
    meter.noise = rng.log_range(NOISE.0, NOISE.1) * mean;
    let (torque, speed) = squares(first);
    let means = Means {
        base: setup.robot.base_w,
        power: (mean - setup.robot.base_w).max(0.05 * mean),
        torque: &torque,
        speed: &speed,
        braking: braking(&setup.robot, first),
        n,
    };
    let (mut fault, loss) = power::draw(which, &means, &mut rng);
    finish(&setup, &meter, (&records, &scale), (&mut fault.truth, &loss), &stream)
}

fn empty() -> Case {
    Case {
        files: Vec::new(),
        options: serde_json::Value::Null,
        kind: Kind::Power,
        effects: Vec::new(),
        place: None,
        lines: Vec::new(),
        heldout: Vec::new(),
    }
}

/// Writes the logs and the truth.
fn finish(
    setup: &Setup,
    meter: &Meter,
    (records, scale): (&[Record], &Scale),
    (fault, loss): (&mut api::Truth, &Loss),
    stream: &dyn Fn(&str) -> Rng,
) -> Case {
    let (plan, plant) = (meter.plan, meter.plant);
    let (mut days, mut noise) = (stream("more days"), stream("noise"));
    let mut files = Files::default();
    let file = robot_file(setup, &mut files);
    for (k, record) in records.iter().enumerate() {
        files.add(0, format!("log-{}.csv", k + 1), meter.text(record, Some(loss), &mut noise));
    }
    let held = simulate(plant, &[], &plan.heldout, (plan, plan.heldout_cycles), &mut days);
    files.add(1, "heldout.csv".to_owned(), meter.text(&held, Some(loss), &mut noise));
    for k in 0..plan.baselines.max(1) {
        if let Some(motion) = plan.motions.get(k % plan.motions.len().max(1)) {
            let record = simulate(plant, &[], motion, (plan, plan.cycles), &mut days);
            files.add(2, format!("baseline-{}.csv", k + 1), meter.text(&record, None, &mut noise));
        }
    }
    fault.nats = information(meter, records, loss);
    let shares = records
        .first()
        .map(|record| power(&plant.robot, &meter.everyday, Some(loss), record, plan.rate).2);
    let _ = scale;
    Case {
        options: options(setup, file, plan, &files, &mut stream("options")),
        files: files.list,
        kind: Kind::Power,
        place: place(fault, shares),
        effects: vec![fault.clone()],
        lines: Vec::new(),
        heldout: truth::levels(plant, &setup.in_file, &held),
    }
}

/// The joint with the largest share, where the fault is of joints.
fn place(fault: &api::Truth, shares: Option<Joints>) -> Option<(usize, f64)> {
    let shares = shares?;
    let whole: f64 = shares.iter().sum();
    let best = *fault.joints.iter().max_by(|a, b| shares[**a - 1].total_cmp(&shares[**b - 1]))?;
    (whole > 0.0).then(|| (best, shares[best - 1] / whole))
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
    api::nats(&[delta], &[sd], &columns)
}

//! One case: a robot, its logs, and what is wrong with it.

use super::detect::{self, Pair, Setting};
use super::disturbance::{self, Disturbance, Scale};
use super::fourier::fourier;
use super::label::{HeldOut, Kind, Label, TrueParameter, Truth};
use super::mechanics::Joints;
use super::model_error::{ModelError, variation};
use super::motion::{Motion, PER_ROW, Sample};
use super::noise::Noise;
use super::pick_place::pick_place;
use super::plant::Plant;
use super::random::Random;
use super::robots;
use super::simulate::{Robot, Row, Supply, simulate};
use super::trust::Trust;
use super::workspace::Workspace;
use crate::robot::{MAX_DOF, Model, to_toml};

/// What is generated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The same seed gives the same bytes.
    pub seed: u64,
    /// Periods in each log.
    pub cycles: usize,
    /// Length of a period \[s\].
    pub period_s: f64,
}

impl Settings {
    /// Two motions of 7 periods of 10 s.
    #[must_use]
    pub fn new(seed: u64) -> Settings {
        Settings { seed, cycles: 7, period_s: 10.0 }
    }
}

/// A case with its files and its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Such as `case-0001`.
    pub name: String,
    /// Names in the case's folder, and contents.
    pub files: Vec<(String, String)>,
    /// The truth.
    pub label: Label,
    /// Sealed with the truth.
    pub salt: String,
}

/// Pause between two logs \[s\].
const PAUSE_S: [f64; 2] = [5.0, 60.0];
/// Relative change of friction from period to period.
const VARIATION: [f64; 2] = [0.001, 0.006];
/// Poses of the first look at a robot's torques, in samples of the simulation.
const LOOK: usize = 10;
/// A joint slower than this rests: it has no part in the figures of a log \[rad/s\].
const RESTS: f64 = 0.02;
/// Drawn again, a pair has two different effects.
const DRAWS: usize = 32;

/// The case with a number, from 1. `None` where the catalogue has none of the robots.
#[must_use]
pub fn case(settings: &Settings, number: usize) -> Option<Case> {
    let stream = |purpose: &str| Random::new(settings.seed, number as u64, purpose);
    let name = format!("case-{number:04}");
    let nominal_model = nominal(&mut stream("robot"))?;
    let nominal = Plant::of(&nominal_model);
    let workspace = Workspace::of(&nominal_model);

    let mut draws = stream("setting");
    // Before what is wrong is drawn, so that nothing in the folder hints at it.
    let with_baseline = draws.chance(0.5);
    let trust = if with_baseline || draws.chance(0.4) { Trust::Commissioned } else { Trust::Cad };
    let variation_size = draws.log_between(VARIATION[0], VARIATION[1]);
    let heldout_works = draws.chance(0.5);

    let mut draws = stream("motions");
    let exciting = |draws: &mut Random| fourier(&workspace, settings.period_s, draws);
    let motions = [exciting(&mut draws), exciting(&mut draws)];
    let heldout = if heldout_works {
        pick_place(&workspace, settings.period_s, &mut draws)
    } else {
        exciting(&mut draws)
    };
    let baseline = exciting(&mut draws);

    let sizes = sizes(&nominal, &motions);
    let (supply_nominal, ratio) = supply(&nominal_model);
    let power = rms_power(&nominal, &supply_nominal, &motions);
    let noise = Noise::drawn(&sizes.rms, &sizes.peak, power, &mut stream("noise levels"));
    let error = ModelError::drawn(
        nominal.dof,
        &sizes.rms,
        &sizes.fastest,
        &noise.torque,
        &ratio,
        &mut stream("model error"),
    );
    let mut draws = stream("spread");
    let plant = trust.real(&nominal, &mut draws);
    let mut supply = supply_nominal.clone();
    supply.base *= 1.0 + 0.02 * draws.normal_within(2.0);
    for loss in &mut supply.loss {
        *loss *= 1.0 + 0.5 * trust.friction() * draws.normal_within(2.0);
    }

    let scale = Scale {
        plant: &plant,
        workspace: &workspace,
        trust,
        period_s: settings.period_s,
        ratio,
        rms: sizes.rms,
        peak: sizes.peak,
        fastest: sizes.fastest,
        load: sizes.load,
        power,
    };
    let (kind, disturbances) = wrong(&scale, with_baseline, &mut stream("truth"));

    let steady = vec![[1.0; MAX_DOF]; settings.cycles];
    let mut draws = stream("clock");
    let lasts = settings.cycles as f64 * settings.period_s;
    let mut clocks = [0.0; 3];
    for i in 1..clocks.len() {
        clocks[i] = clocks[i - 1] + lasts + draws.between(PAUSE_S[0], PAUSE_S[1]).round();
    }
    let robot = Operation { plant: &plant, error: &error, supply: &supply };
    let all: Vec<&Disturbance> = disturbances.iter().collect();

    // What is logged, with the noise of its own.
    let mut files = vec![("nominal.toml".to_owned(), to_toml(&nominal_model))];
    let logged = [("log-1", &motions[0]), ("log-2", &motions[1]), ("heldout", &heldout)];
    for ((file, motion), clock) in logged.into_iter().zip(clocks) {
        let mut draws = stream(file);
        let factors = variation(settings.cycles, variation_size, &mut draws);
        let rows = simulate(&robot.with(all.clone()), motion, clock, &factors);
        files.push((format!("{file}.csv"), noise.log(&rows, plant.dof, clock, &mut draws)));
    }
    if with_baseline {
        let mut draws = stream("baseline-1");
        let factors = variation(settings.cycles, variation_size, &mut draws);
        let rows = simulate(&robot.with(Vec::new()), &baseline, 0.0, &factors);
        files.push(("baseline-1.csv".into(), noise.log(&rows, plant.dof, 0.0, &mut draws)));
    }
    let options = serde_json::json!({ "trust": trust.name(), "period": settings.period_s });
    files.push(("case.json".into(), format!("{options}\n")));

    // What can be seen of each thing that is wrong, the others being there.
    let train = [(&motions[0], clocks[0]), (&motions[1], clocks[1])];
    let run = |of: &[&Disturbance]| -> Vec<Vec<Row>> {
        let robot = robot.with(of.to_vec());
        train.iter().map(|(motion, clock)| simulate(&robot, motion, *clock, &steady)).collect()
    };
    let with_all = run(&all);
    let setting = Setting {
        nominal: &nominal,
        trust,
        error: &error,
        noise: &noise,
        variation: variation_size,
    };
    let mut effects = Vec::new();
    for (i, disturbance) in disturbances.iter().enumerate() {
        let others: Vec<&Disturbance> =
            all.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, other)| *other).collect();
        let without = run(&others);
        let pairs: Vec<Pair<'_>> = (0..train.len())
            .map(|k| Pair { motion: train[k].0, with: &with_all[k], without: &without[k] })
            .collect();
        let nats = match kind {
            Kind::Power => detect::power_nats(&noise, &pairs),
            _ => detect::torque_nats(&setting, &pairs),
        };
        effects.push(truth(disturbance, nats));
    }
    let (place, share) = match kind {
        Kind::Power => (None, None),
        _ if disturbances.is_empty() => (None, None),
        _ => largest_share(plant.dof, &with_all, &run(&[])),
    };
    let held = held_out(&nominal, &heldout, &robot.with(all), &robot.with(Vec::new()), clocks[2]);
    let label = Label {
        case: name.clone(),
        kind,
        trust: trust.name().into(),
        effects,
        place,
        share,
        line: None,
        heldout: held,
    };
    let mut draws = stream("salt");
    let salt = format!("{:016x}{:016x}", draws.bits(), draws.bits());
    Some(Case { name, files, label, salt })
}

/// A robot to which something may happen.
struct Operation<'a> {
    plant: &'a Plant,
    error: &'a ModelError,
    supply: &'a Supply,
}

impl<'a> Operation<'a> {
    fn with(&self, disturbances: Vec<&'a Disturbance>) -> Robot<'a> {
        let Operation { plant, error, supply } = *self;
        Robot { plant, error, supply, disturbances }
    }
}

/// A robot, with a drive that gives braking power back in some cases.
fn nominal(random: &mut Random) -> Option<Model> {
    let mut model = robots::robot(random)?;
    if random.chance(0.5) {
        model.drive.regeneration = (random.between(0.5, 0.9) * 100.0).round() / 100.0;
    }
    Some(model)
}

/// What is wrong.
fn wrong(scale: &Scale<'_>, with_baseline: bool, random: &mut Random) -> (Kind, Vec<Disturbance>) {
    match random.unit() {
        x if x < 0.20 => (Kind::Healthy, Vec::new()),
        x if x < 0.28 => (Kind::ParametersOnly, vec![disturbance::link_parameters(scale, random)]),
        x if x < 0.66 => (Kind::One, vec![disturbance::torque_effect(scale, random)]),
        x if x < 0.78 => {
            let first = disturbance::torque_effect(scale, random);
            let mut second = disturbance::torque_effect(scale, random);
            for _ in 0..DRAWS {
                if second.id != first.id && !first.equivalents.contains(&second.id) {
                    break;
                }
                second = disturbance::torque_effect(scale, random);
            }
            (Kind::Two, vec![first, second])
        }
        x if x < 0.92 || !with_baseline => {
            (Kind::Outside, vec![disturbance::outside(scale, random)])
        }
        _ => (Kind::Power, vec![disturbance::power_effect(scale, random)]),
    }
}

fn truth(disturbance: &Disturbance, nats: f64) -> Truth {
    let parameters = disturbance.parameters.iter().map(|parameter| TrueParameter {
        name: parameter.name.into(),
        joint: parameter.joint.map(|joint| joint + 1),
        value: parameter.value,
        graded: parameter.graded,
    });
    Truth {
        id: disturbance.id.into(),
        form: disturbance.form.into(),
        joints: disturbance.joints.iter().map(|joint| joint + 1).collect(),
        parameters: parameters.collect(),
        window: disturbance.window,
        equivalents: disturbance.equivalents.iter().map(|&id| id.to_owned()).collect(),
        nats,
    }
}

/// Sizes of the torques of some motions.
struct Sizes {
    rms: Joints,
    peak: Joints,
    fastest: Joints,
    load: Joints,
}

fn sizes(plant: &Plant, motions: &[Motion]) -> Sizes {
    let mut sizes = Sizes {
        rms: [0.0; MAX_DOF],
        peak: [0.0; MAX_DOF],
        fastest: [0.0; MAX_DOF],
        load: [0.0; MAX_DOF],
    };
    let mut count = 0.0;
    for sample in motions.iter().flat_map(|motion| motion.samples.iter().step_by(LOOK)) {
        let tau = plant.torque(&sample.q, &sample.qd, &sample.qdd);
        let load = plant.through_gears(plant.rigid(&sample.q, &sample.qd, &sample.qdd));
        let rate = plant.motor(&sample.qd);
        count += 1.0;
        for joint in 0..plant.dof {
            sizes.rms[joint] += tau[joint] * tau[joint];
            sizes.load[joint] += load[joint] * load[joint];
            sizes.peak[joint] = sizes.peak[joint].max(tau[joint].abs());
            sizes.fastest[joint] = sizes.fastest[joint].max(rate[joint].abs());
        }
    }
    for joint in 0..plant.dof {
        sizes.rms[joint] = (sizes.rms[joint] / f64::max(count, 1.0)).sqrt().max(1e-3);
        sizes.load[joint] = (sizes.load[joint] / f64::max(count, 1.0)).sqrt().max(1e-3);
    }
    sizes
}

/// The electrical side of a model, and the gear ratios.
fn supply(model: &Model) -> (Supply, Joints) {
    let (mut loss, mut ratio) = ([0.0; MAX_DOF], [1.0; MAX_DOF]);
    if let Some(motors) = &model.motors {
        for joint in 0..model.dof {
            loss[joint] = motors.loss_constant[joint];
            ratio[joint] = motors.ratio[joint];
        }
    }
    let drive = &model.drive;
    (Supply { base: drive.base_w, loss, regeneration: drive.regeneration }, ratio)
}

/// Rms of the power that changes with the motion \[W\].
fn rms_power(plant: &Plant, supply: &Supply, motions: &[Motion]) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for sample in motions.iter().flat_map(|motion| motion.samples.iter().step_by(LOOK)) {
        let tau = plant.torque(&sample.q, &sample.qd, &sample.qdd);
        let watts: f64 =
            (0..plant.dof).map(|j| tau[j] * sample.qd[j] + supply.loss[j] * tau[j] * tau[j]).sum();
        squares += watts * watts;
        count += 1.0;
    }
    (squares / f64::max(count, 1.0)).sqrt()
}

/// The joint, from 1, whose torques change most for their size, and its share.
fn largest_share(
    dof: usize,
    with: &[Vec<Row>],
    without: &[Vec<Row>],
) -> (Option<usize>, Option<f64>) {
    let mut shares = [0.0; MAX_DOF];
    for joint in 0..dof {
        let (mut change, mut size) = (0.0, 0.0);
        for (with, without) in with.iter().flatten().zip(without.iter().flatten()) {
            change += (with.tau[joint] - without.tau[joint]).powi(2);
            size += with.tau[joint].powi(2);
        }
        shares[joint] = change / f64::max(size, 1e-12);
    }
    let sum: f64 = shares.iter().sum();
    let largest = (0..dof).max_by(|a, b| shares[*a].total_cmp(&shares[*b]));
    match largest {
        Some(joint) if sum > 0.0 => (Some(joint + 1), Some(shares[joint] / sum)),
        _ => (None, None),
    }
}

/// Rms figures of the held-out motion, of its first period.
fn held_out(
    nominal: &Plant,
    motion: &Motion,
    ill: &Robot<'_>,
    healthy: &Robot<'_>,
    clock: f64,
) -> Vec<HeldOut> {
    let once = [[1.0; MAX_DOF]];
    let (ill, well) =
        (simulate(ill, motion, clock, &once), simulate(healthy, motion, clock, &once));
    let samples: Vec<&Sample> = motion.samples.iter().step_by(PER_ROW).collect();
    let expected: Vec<Joints> = samples
        .iter()
        .zip(&ill)
        .map(|(sample, row)| nominal.torque(&row.q, &sample.qd, &sample.qdd))
        .collect();
    let plain: Vec<Joints> = samples
        .iter()
        .map(|sample| healthy.plant.torque(&sample.q, &sample.qd, &sample.qdd))
        .collect();
    let rms = |joint: usize, of: &dyn Fn(usize) -> f64| {
        let moving = (0..ill.len()).filter(|i| samples[*i].qd[joint].abs() >= RESTS);
        let squares: Vec<f64> = moving.map(|i| of(i).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    };
    (0..nominal.dof)
        .map(|j| HeldOut {
            joint: j + 1,
            torque: rms(j, &|i| ill[i].tau[j]),
            model: rms(j, &|i| ill[i].tau[j] - expected[i][j]),
            effects: rms(j, &|i| ill[i].tau[j] - well[i].tau[j]),
            left: rms(j, &|i| well[i].tau[j] - plain[i][j]),
        })
        .collect()
}

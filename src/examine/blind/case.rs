//! One case: a robot, its logs, and what is wrong with it.

use super::conduct;
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
use super::program::{Conduct, Program};
use super::random::Random;
use super::robots;
use super::simulate::{Robot, Row, Supply, simulate};
use super::trust::Trust;
use super::workspace::Workspace;
use crate::arm::robot::{MAX_DOF, Model, to_toml};

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
/// Share of the cases that are runs of a program, and of those in which nothing is wrong.
const PROGRAMS: f64 = 0.12;
const HEALTHY_PROGRAMS: f64 = 0.4;
/// Drawn again, a pair has two different effects.
const DRAWS: usize = 32;

/// The case with a number, from 1. `None` where the catalogue has none of the robots.
#[must_use]
pub fn case(settings: &Settings, number: usize) -> Option<Case> {
    let bench = Bench::drawn(settings, number)?;
    Some(if bench.with_program { program_case(&bench) } else { torque_case(&bench) })
}

/// A robot with its sensors, before anything is wrong.
pub(super) struct Bench<'a> {
    pub(super) settings: &'a Settings,
    number: usize,
    model: Model,
    nominal: Plant,
    pub(super) workspace: Workspace,
    trust: Trust,
    /// Drawn before what is wrong, so that nothing in the folder hints at it.
    pub(super) with_program: bool,
    with_baseline: bool,
    #[cfg(feature = "internals")]
    pub(super) heldout_works: bool,
    variation: f64,
    /// Two to learn from, one held out, one from before.
    motions: [Motion; 4],
    sizes: Sizes,
    ratio: Joints,
    /// Rms power \[W\].
    power: f64,
    plant: Plant,
    supply: Supply,
    error: ModelError,
    noise: Noise,
}

impl<'a> Bench<'a> {
    pub(super) fn drawn(settings: &'a Settings, number: usize) -> Option<Bench<'a>> {
        let stream = |purpose: &str| Random::new(settings.seed, number as u64, purpose);
        let model = nominal(&mut stream("robot"))?;
        let nominal = Plant::of(&model);
        let workspace = Workspace::of(&model);

        let mut draws = stream("setting");
        let with_program = draws.chance(PROGRAMS);
        let with_baseline = with_program || draws.chance(0.5);
        let trust =
            if with_baseline || draws.chance(0.4) { Trust::Commissioned } else { Trust::Cad };
        let variation = draws.log_between(VARIATION[0], VARIATION[1]);
        let heldout_works = draws.chance(0.5);

        let mut draws = stream("motions");
        let exciting = |draws: &mut Random| fourier(&workspace, settings.period_s, draws);
        let motions = [
            exciting(&mut draws),
            exciting(&mut draws),
            if heldout_works {
                pick_place(&workspace, settings.period_s, &mut draws)
            } else {
                exciting(&mut draws)
            },
            exciting(&mut draws),
        ];
        let sizes = sizes(&nominal, &motions[..2]);
        let (of_model, ratio) = supply(&model);
        let power = rms_power(&nominal, &of_model, &motions[..2]);
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
        let mut supply = of_model;
        supply.base *= 1.0 + 0.02 * draws.normal_within(2.0);
        for loss in &mut supply.loss {
            *loss *= 1.0 + 0.5 * trust.friction() * draws.normal_within(2.0);
        }
        Some(Bench {
            settings,
            number,
            model,
            nominal,
            workspace,
            trust,
            with_program,
            with_baseline,
            #[cfg(feature = "internals")]
            heldout_works,
            variation,
            motions,
            sizes,
            ratio,
            power,
            plant,
            supply,
            error,
            noise,
        })
    }

    pub(super) fn stream(&self, purpose: &str) -> Random {
        Random::new(self.settings.seed, self.number as u64, purpose)
    }

    /// What is wrong with a robot whose torques or power are logged.
    pub(super) fn wrong(&self) -> (Kind, Vec<Disturbance>) {
        let scale = Scale {
            nominal: &self.nominal,
            plant: &self.plant,
            workspace: &self.workspace,
            trust: self.trust,
            period_s: self.settings.period_s,
            ratio: self.ratio,
            rms: self.sizes.rms,
            peak: self.sizes.peak,
            fastest: self.sizes.fastest,
            load: self.sizes.load,
            power: self.power,
        };
        wrong(&scale, self.with_baseline, &mut self.stream("truth"))
    }

    /// When three logs begin \[s\]: two to learn from, one to grade by.
    pub(super) fn clocks(&self) -> [f64; 3] {
        let lasts = self.settings.cycles as f64 * self.settings.period_s;
        clocks(lasts, &mut self.stream("clock"))
    }

    pub(super) fn robot<'b>(&'b self, disturbances: Vec<&'b Disturbance>) -> Robot<'b> {
        let Bench { plant, error, supply, .. } = self;
        Robot { plant, error, supply, disturbances }
    }

    fn sealed(
        &self,
        mut files: Vec<(String, String)>,
        options: &serde_json::Value,
        kind: Kind,
        label: impl FnOnce(&mut Label),
    ) -> Case {
        let name = format!("case-{:04}", self.number);
        files.insert(0, ("nominal.toml".into(), to_toml(&self.model)));
        files.push(("case.json".into(), format!("{options}\n")));
        let mut sealed = Label {
            case: name.clone(),
            kind,
            trust: self.trust.name().into(),
            effects: Vec::new(),
            place: None,
            share: None,
            lines: Vec::new(),
            heldout: Vec::new(),
        };
        label(&mut sealed);
        let mut draws = self.stream("salt");
        let salt = format!("{:016x}{:016x}", draws.bits(), draws.bits());
        Case { name, files, label: sealed, salt }
    }
}

/// Times at which three logs begin, each of this length \[s\].
fn clocks(lasts: f64, random: &mut Random) -> [f64; 3] {
    let mut clocks = [0.0; 3];
    for i in 1..clocks.len() {
        clocks[i] = clocks[i - 1] + lasts + random.between(PAUSE_S[0], PAUSE_S[1]).round();
    }
    clocks
}

/// A case of torques or power.
fn torque_case(bench: &Bench<'_>) -> Case {
    let Bench { settings, nominal, plant, noise, trust, .. } = bench;
    let (kind, disturbances) = bench.wrong();
    let all: Vec<&Disturbance> = disturbances.iter().collect();
    let [first, second, heldout, before] = &bench.motions;
    let clocks = bench.clocks();

    // What is logged, with the noise of its own.
    let logged = |file: &str, motion: &Motion, clock: f64, of: &[&Disturbance]| {
        let mut draws = bench.stream(file);
        let factors = variation(settings.cycles, bench.variation, &mut draws);
        let rows = simulate(&bench.robot(of.to_vec()), motion, clock, &factors);
        (file.to_owned(), noise.log(&rows, plant.dof, clock, None, &mut draws))
    };
    let mut files = vec![
        logged("log-1.csv", first, clocks[0], &all),
        logged("log-2.csv", second, clocks[1], &all),
        logged("heldout.csv", heldout, clocks[2], &all),
    ];
    if bench.with_baseline {
        files.push(logged("baseline-1.csv", before, 0.0, &[]));
    }

    // What can be seen of each thing that is wrong, the others being there.
    let steady = vec![[1.0; MAX_DOF]; settings.cycles];
    let train = [(first, clocks[0]), (second, clocks[1])];
    let run = |of: &[&Disturbance]| -> Vec<Vec<Row>> {
        let robot = bench.robot(of.to_vec());
        train.iter().map(|(motion, clock)| simulate(&robot, motion, *clock, &steady)).collect()
    };
    let with_all = run(&all);
    let setting =
        Setting { nominal, trust: *trust, error: &bench.error, noise, variation: bench.variation };
    let mut effects = Vec::new();
    for (i, disturbance) in disturbances.iter().enumerate() {
        let others: Vec<&Disturbance> =
            all.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, other)| *other).collect();
        let without = run(&others);
        let pairs: Vec<Pair<'_>> = (0..train.len())
            .map(|k| Pair { motion: train[k].0, with: &with_all[k], without: &without[k] })
            .collect();
        let nats = match kind {
            Kind::Power => detect::power_nats(noise, &pairs),
            _ => detect::torque_nats(&setting, &pairs),
        };
        effects.push(truth(disturbance, nats));
    }
    let (place, share) = match kind {
        Kind::Power => (None, None),
        _ if disturbances.is_empty() => (None, None),
        _ => largest_share(plant.dof, &with_all, &run(&[])),
    };
    let held = held_out(nominal, heldout, &bench.robot(all), &bench.robot(Vec::new()), clocks[2]);
    let options = serde_json::json!({ "trust": trust.name(), "period": settings.period_s });
    bench.sealed(files, &options, kind, |label| {
        label.effects = effects;
        (label.place, label.share) = (place, share);
        label.heldout = held;
    })
}

/// A case of a program's run.
fn program_case(bench: &Bench<'_>) -> Case {
    let Bench { settings, workspace, plant, noise, .. } = bench;
    let program = Program::drawn(workspace, &mut bench.stream("program"));
    let plain = Conduct::plain();
    let mut draws = bench.stream("truth");
    let wrong = (!draws.chance(HEALTHY_PROGRAMS))
        .then(|| conduct::motion_effect(&program, workspace, &mut draws));
    let conduct = wrong.as_ref().map_or(plain, |wrong| wrong.conduct);
    let logged = |file: &str, conduct: &Conduct, clock: f64| {
        let mut draws = bench.stream(file);
        let course = program.run(workspace, conduct, settings.cycles, &mut draws);
        let rows = simulate(&bench.robot(Vec::new()), &course.motion, clock, &[[1.0; MAX_DOF]]);
        let marks: Vec<[usize; 2]> = course.marks.iter().step_by(PER_ROW).copied().collect();
        (file.to_owned(), noise.log(&rows, plant.dof, clock, Some(&marks), &mut draws))
    };
    let lasts = settings.cycles as f64 * program.durations(workspace, &conduct).iter().sum::<f64>();
    let clocks = clocks(2.0 * lasts, &mut bench.stream("clock"));
    let files = vec![
        logged("log-1.csv", &conduct, clocks[0]),
        logged("log-2.csv", &conduct, clocks[1]),
        logged("heldout.csv", &conduct, clocks[2]),
        logged("baseline-1.csv", &plain, 0.0),
        ("program/MainModule.mod".to_owned(), program.text()),
    ];
    let options = serde_json::json!({ "trust": bench.trust.name(), "program": "program" });
    let kind = if wrong.is_some() { Kind::Motion } else { Kind::Healthy };
    bench.sealed(files, &options, kind, |label| {
        if let Some(wrong) = wrong {
            let logs = 2.0 * settings.cycles as f64;
            label.lines = wrong.lines;
            label.effects = vec![Truth { nats: wrong.nats_per_cycle * logs, ..wrong.truth }];
        }
    })
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
        for (to, from) in [(&mut loss, &motors.loss_constant), (&mut ratio, &motors.ratio)] {
            for (to, from) in to.iter_mut().zip(from) {
                *to = *from;
            }
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

//! A case: the logs of a robot and its true faults.

use super::bench::{Bench, Settings, clocks};
use super::conduct;
use super::detect::{self, Pair, Setting};
use super::fault::Disturbance;
use super::label::{HeldOut, Kind, Label, Truth};
use super::mechanics::Joints;
use super::model_error::variation;
use super::motion::{Motion, PER_ROW, Sample};
use super::plant::Plant;
use super::program::{Conduct, Program};
use super::simulate::{Robot, Row, simulate};
use crate::arm::robot::{MAX_DOF, to_toml};

/// A case with its files and its true faults.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name, such as `case-0001`.
    pub name: String,
    /// Names in the folder of the case, and contents.
    pub files: Vec<(String, String)>,
    /// The true faults.
    pub label: Label,
    /// Salt of the seal.
    pub salt: String,
}

/// Rate below which a joint counts as at rest \[rad/s\].
const RESTS: f64 = 0.02;
/// Share of the program runs without a fault.
const HEALTHY_PROGRAMS: f64 = 0.4;

/// The case with a number, from 1; `None` if the catalogue contains none of the robots.
#[must_use]
pub fn case(settings: &Settings, number: usize) -> Option<Case> {
    let bench = Bench::drawn(settings, number)?;
    Some(if bench.with_program { program_case(&bench) } else { torque_case(&bench) })
}

impl Bench<'_> {
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
            trust: self.trust.name.into(),
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

/// A case with torques or power.
fn torque_case(bench: &Bench<'_>) -> Case {
    let Bench { settings, nominal, plant, noise, trust, .. } = bench;
    let (kind, disturbances) = bench.wrong();
    let all: Vec<&Disturbance> = disturbances.iter().collect();
    let [first, second, heldout, before] = &bench.motions;
    let clocks = bench.clocks();

    // Each log has its own noise.
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

    // Detectability of each fault in addition to the others.
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
        effects.push(Truth { nats, ..disturbance.truth.clone() });
    }
    let (place, share) = match kind {
        Kind::Power => (None, None),
        _ if disturbances.is_empty() => (None, None),
        _ => largest_share(plant.dof, &with_all, &run(&[])),
    };
    let held = held_out(nominal, heldout, &bench.robot(all), &bench.robot(Vec::new()), clocks[2]);
    let options = serde_json::json!({ "trust": trust.name, "period": settings.period_s });
    bench.sealed(files, &options, kind, |label| {
        label.effects = effects;
        (label.place, label.share) = (place, share);
        label.heldout = held;
    })
}

/// A case with runs of a program.
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
    let options = serde_json::json!({ "trust": bench.trust.name, "program": "program" });
    let kind = if wrong.is_some() { Kind::Motion } else { Kind::Healthy };
    bench.sealed(files, &options, kind, |label| {
        if let Some(wrong) = wrong {
            let logs = 2.0 * settings.cycles as f64;
            label.lines = wrong.lines;
            label.effects = vec![Truth { nats: wrong.nats_per_cycle * logs, ..wrong.truth }];
        }
    })
}

/// The joint, from 1, with the largest relative change of its torques, and its share.
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

/// Rms values of the first period of the held-out motion.
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

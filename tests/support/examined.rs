//! Cases of the examination as records, for tests, examples and benches.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each user takes its part of this module; an expectation would fail in the others"
)]

use joulepath::arm::effects::from_toml;
use joulepath::arm::robot::Model;
use joulepath::examine::blind::{Case, Settings, Unlogged};
use joulepath::gap::{Record, Trust};
use joulepath::learn::identify::{Block, Hints, Samples, Source, prepare};
use joulepath::learn::log::{Channel, ColumnMap, read_csv};

/// A case after reading.
pub(crate) struct Examined {
    pub(crate) nominal: Model,
    pub(crate) train: Vec<Samples>,
    pub(crate) heldout: Vec<Samples>,
    pub(crate) trust: Trust,
}

/// The text of a file in a case.
pub(crate) fn file<'a>(case: &'a Case, name: &str) -> &'a str {
    &case.files.iter().find(|(other, _)| other == name).unwrap().1
}

/// A case's model and logs.
pub(crate) fn examined(case: &Case, settings: &Settings) -> Examined {
    let nominal = from_toml("nominal.toml", file(case, "nominal.toml")).unwrap();
    let samples = |name: &str| -> Samples {
        let log = read_csv(file(case, name).as_bytes(), &ColumnMap::default()).unwrap();
        let tau: Vec<Vec<f64>> = (0..nominal.dof)
            .map(|joint| log.column(Channel::Torque(joint)).unwrap().to_vec())
            .collect();
        prepare(&log, &tau, Hints { period: Some(settings.period_s), cutoff: None }).unwrap()
    };
    let train = ["log-1.csv", "log-2.csv"].map(&samples).into();
    let heldout = vec![samples("heldout.csv")];
    let trust = if case.label.trust == "cad" { Trust::Cad } else { Trust::Commissioned };
    Examined { nominal, train, heldout, trust }
}

/// Logs as records of a model.
pub(crate) fn records<'a>(model: &'a Model, logs: &[Samples]) -> Vec<Record<'a>> {
    logs.iter().flat_map(|log| Record::all(model, log)).collect()
}

/// Motions outside the files, as noiseless logs.
pub(crate) fn noiseless(motions: &[Unlogged], settings: &Settings) -> Vec<Samples> {
    let samples = |of: &Unlogged| {
        let n = of.q.len();
        let block = Block {
            t: of.t.clone(),
            q: of.q.clone(),
            qd: of.qd.clone(),
            qdd: of.qdd.clone(),
            tau: of.tau.clone(),
            clipped: vec![Vec::new(); n],
        };
        Samples {
            step: of.t[1] - of.t[0],
            source: Source::Periodic {
                period: settings.period_s,
                periods: 1,
                harmonics: block.instants() / 2,
            },
            blocks: vec![block],
            rest: vec![0.0; n],
            resting: Vec::new(),
            noise: None,
            repetitions: None,
        }
    };
    motions.iter().map(samples).collect()
}

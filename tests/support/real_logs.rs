//! Public logs of real robots: training part, held-out part, and the model without the effect.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each user takes its part of this module; an expectation would fail in the others"
)]

use std::fmt::Write as _;
use std::ops::Range;

use joulepath::arm::effects::{ALL, from_toml};
use joulepath::arm::robot::{Model, import_urdf};
use joulepath::gap::{Diagnosis, Record, Settings, Trust, Tunables, diagnose};
use joulepath::learn::identify::{
    Free, Hints, Samples, Settings as Identify, Source, Weighting, identify, prepare, torques,
};
use joulepath::learn::log::{ColumnMap, Log, read_csv};

/// Share of the log for training; the rest is held out.
const TRAINED: f64 = 0.7;
/// A coupling that counts as stated and disables the search.
const STATED: f64 = 1e-12;

/// A robot of the shared data: its files, and whether rates are logged.
pub(crate) struct RealRobot {
    pub(crate) urdf: &'static str,
    pub(crate) csv: &'static str,
    pub(crate) has_rates: bool,
}

/// Coupled wrist, motor torques.
pub(crate) const TX40: RealRobot = RealRobot {
    urdf: "tx40/tx40_mdh_modified.urdf",
    csv: "tx40/tx40_joint_space.csv",
    has_rates: false,
};
/// Friction beyond Coulomb and viscous, torques from currents.
pub(crate) const UR10: RealRobot = RealRobot {
    urdf: "ur10_unisa/ur10_cb3_mdh_dummy_inertia.urdf",
    csv: "ur10_unisa/ur10_exciting_trajectory.csv",
    has_rates: true,
};
/// Torques measured at the joint side of the gears.
pub(crate) const PANDA: RealRobot = RealRobot {
    urdf: "ur10_unisa/panda_mdh_dummy_inertia.urdf",
    csv: "ur10_unisa/panda_exciting_trajectory.csv",
    has_rates: true,
};

/// Identifies a model from the first part of a robot's log and diagnoses it with the other part.
/// The texts are those of its files.
pub(crate) fn diagnosed(robot: &RealRobot, urdf: &str, csv: &str, trust: Trust) -> Diagnosis {
    let text = import_urdf(robot.urdf, urdf).unwrap();
    let bare = from_toml(robot.urdf, &text).unwrap();
    let log = log(&bare, csv, robot);
    let count = log.time().len();
    let cut = (TRAINED * count as f64) as usize;
    let [first, last] = split(&bare, &log, [0..cut, cut..count]);
    let nominal = nominal(&bare, &first);
    let settings = Settings { trust, effects: ALL.iter().collect(), tunables: Tunables::DEFAULT };
    let held = Record::all(&nominal, &last);
    diagnose(&nominal, Record::all(&nominal, &first), &held, &settings)
}

/// Ids of the asserted effects.
pub(crate) fn named(found: &Diagnosis) -> Vec<&'static str> {
    found.effects.iter().map(|asserted| asserted.effect.id).collect()
}

/// The log in a robot's file.
pub(crate) fn log(model: &Model, csv: &str, robot: &RealRobot) -> Log {
    let mut map = String::from("t=t_s");
    for joint in 1..=model.dof {
        let _ = write!(map, ",q{joint}=q_rad_{joint},tau{joint}=tau_Nm_{joint}");
        if robot.has_rates {
            let _ = write!(map, ",qd{joint}=qd_rad_s_{joint}");
        }
    }
    read_csv(csv.as_bytes(), &ColumnMap::parse(&map).unwrap()).unwrap()
}

/// The samples in two parts of a log: for training and held out.
pub(crate) fn split(model: &Model, log: &Log, [first, last]: [Range<usize>; 2]) -> [Samples; 2] {
    let samples = |range: Range<usize>, hints| {
        let log = log.of_rows(&range.collect::<Vec<_>>());
        prepare(&log, &torques(model, &log).unwrap().tau, hints).unwrap()
    };
    let training = samples(first, Hints::default());
    let Source::Filtered { cutoff } = training.source else { panic!("{:?}", training.source) };
    let held_out = samples(last, Hints { period: None, cutoff: Some(cutoff) });
    [training, held_out]
}

/// The model identified from the first part, without a wrist coupling.
fn nominal(bare: &Model, samples: &Samples) -> Model {
    let mut stated = bare.clone();
    stated.wrist.coupling = STATED;
    let settings =
        Identify { free: Free::All, weighting: Weighting::Joint, source: "a log".into() };
    let mut found = identify(&stated, samples, &[], &settings).unwrap().model;
    found.wrist.coupling = 0.0;
    found
}

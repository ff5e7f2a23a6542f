//! Effects of real robots, withheld from the model that is believed.

use std::fmt::Write as _;

use joulepath::effects::{ALL, from_toml};
use joulepath::gap::{Diagnosis, Record, Settings, Trust, diagnose};
use joulepath::identify::{
    Free, Hints, Samples, Settings as Identify, Source, Weighting, identify, prepare, torques,
};
use joulepath::log::{ColumnMap, Log, read_csv};
use joulepath::robot::{Model, import_urdf};

/// Part of the log that is fitted; the rest grades.
const TRAINED: f64 = 0.7;
/// A coupling that counts as stated, so that none is looked for.
const STATED: f64 = 1e-12;
/// Torques that the TX40's joints 5 and 6 may miss at most, held-out \[Nm\].
const TX40: [f64; 2] = [1.4, 1.0];
/// Share of its error that the UR10's first joint may keep, once the law of its friction is there.
const HALVED: f64 = 0.5;

/// Both parts of a log: what is fitted, what grades.
fn parts(model: &Model, csv: &str, rates: bool) -> [Samples; 2] {
    let mut map = String::from("t=t_s");
    for joint in 1..=model.dof {
        let _ = write!(map, ",q{joint}=q_rad_{joint},tau{joint}=tau_Nm_{joint}");
        if rates {
            let _ = write!(map, ",qd{joint}=qd_rad_s_{joint}");
        }
    }
    let log = read_csv(csv.as_bytes(), &ColumnMap::parse(&map).unwrap()).unwrap();
    let cut = (TRAINED * log.time().len() as f64) as usize;
    let rows = |range: std::ops::Range<usize>| Log {
        channels: log.channels.clone(),
        values: log.values.iter().map(|x| x[range.clone()].to_vec()).collect(),
        rows: log.rows[range].to_vec(),
        rejected: Vec::new(),
        degrees: Vec::new(),
    };
    let samples =
        |log: &Log, hints| prepare(log, &torques(model, log).unwrap().tau, hints).unwrap();
    let first = samples(&rows(0..cut), Hints::default());
    let Source::Filtered { cutoff } = first.source else { panic!("{:?}", first.source) };
    let hints = Hints { period: None, cutoff: Some(cutoff) };
    let last = samples(&rows(cut..log.time().len()), hints);
    [first, last]
}

/// The model that the first part tells, without a coupling of the wrist.
fn nominal(bare: &Model, samples: &Samples) -> Model {
    let mut stated = bare.clone();
    stated.wrist.coupling = STATED;
    let settings =
        Identify { free: Free::All, weighting: Weighting::Joint, source: "a test".into() };
    let mut found = identify(&stated, samples, &[], &settings).unwrap().model;
    found.wrist.coupling = 0.0;
    found
}

fn diagnosed(nominal: &Model, [first, last]: &[Samples; 2]) -> Diagnosis {
    let settings = Settings { trust: Trust::Commissioned, effects: ALL.iter().collect() };
    let found =
        diagnose(nominal, Record::all(nominal, first), &Record::all(nominal, last), &settings);
    let rms = |of: fn(&joulepath::gap::JointGap) -> f64| -> Vec<f64> {
        found.shrink.joints.iter().map(of).collect()
    };
    eprintln!(
        "{}: {:?} {:?}, held out {:.2?} → {:.2?} → {:.2?}",
        nominal.name,
        found.verdict,
        named(&found),
        rms(|of| of.model),
        rms(|of| of.refit),
        rms(|of| of.refit_plus_effect)
    );
    found
}

fn named(found: &Diagnosis) -> Vec<&'static str> {
    found.effects.iter().map(|said| said.effect.id).collect()
}

#[test]
fn the_coupled_wrist_of_a_tx40_is_named() {
    let (urdf, csv) = ("tx40/tx40_mdh_modified.urdf", "tx40/tx40_joint_space.csv");
    let (Some(robot), Some(csv)) = (super::shared(urdf), super::shared(csv)) else { return };
    let bare = from_toml(urdf, &import_urdf(urdf, &robot).unwrap()).unwrap();
    let parts = parts(&bare, &csv, false);
    let found = diagnosed(&nominal(&bare, &parts[0]), &parts);
    assert_eq!(named(&found), ["wrist_coupling"]);
    for (joint, most) in [4, 5].into_iter().zip(TX40) {
        let missed = found.shrink.joints[joint].refit_plus_effect;
        assert!(missed <= most, "joint {}: {missed} Nm", joint + 1);
    }
}

#[test]
fn friction_of_a_ur10_that_grows_with_speed_is_named() {
    let (urdf, csv) =
        ("ur10_unisa/ur10_cb3_mdh_dummy_inertia.urdf", "ur10_unisa/ur10_exciting_trajectory.csv");
    let (Some(robot), Some(csv)) = (super::shared(urdf), super::shared(csv)) else { return };
    let bare = from_toml(urdf, &import_urdf(urdf, &robot).unwrap()).unwrap();
    let parts = parts(&bare, &csv, true);
    let found = diagnosed(&nominal(&bare, &parts[0]), &parts);
    assert_eq!(named(&found), ["stribeck"]);
    let first = &found.shrink.joints[0];
    assert!(first.refit_plus_effect < HALVED * first.model, "{first:?}");
}

#[test]
fn a_panda_has_no_effect() {
    let (urdf, csv) =
        ("ur10_unisa/panda_mdh_dummy_inertia.urdf", "ur10_unisa/panda_exciting_trajectory.csv");
    let (Some(robot), Some(csv)) = (super::shared(urdf), super::shared(csv)) else { return };
    let bare = from_toml(urdf, &import_urdf(urdf, &robot).unwrap()).unwrap();
    let parts = parts(&bare, &csv, true);
    let found = diagnosed(&nominal(&bare, &parts[0]), &parts);
    assert!(named(&found).is_empty(), "{:?}", named(&found));
}

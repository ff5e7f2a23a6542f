//! Intervals of estimated torques compared with published bodies; `examples/coverage` has more.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

#[path = "../examples/coverage/torques.rs"]
mod torques;

use std::path::Path;

use joulepath::arm::robot::{Model, find, load};
use torques::{Kind, held, unknown};

/// Accepted coverage of 90 % intervals over arms of many makers.
const COVERAGE: std::ops::RangeInclusive<f64> = 0.80..=0.97;

/// The arms in a folder.
fn arms(folder: &str) -> Vec<Model> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/coverage").join(folder);
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| load(path.to_str().unwrap()).unwrap())
        .collect()
}

/// Coverage of the torques of arms.
fn rate(arms: &[Model], kind: Kind) -> f64 {
    let all: Vec<bool> = arms.iter().flat_map(|arm| held(arm, &unknown(arm), kind)).collect();
    all.iter().filter(|held| **held).count() as f64 / all.len() as f64
}

#[test]
fn intervals_contain_gravity_and_inertia_of_other_makers_arms() {
    for folder in ["makers/chosen", "makers/unseen", "."] {
        for kind in [Kind::Gravity, Kind::Acceleration] {
            let rate = rate(&arms(folder), kind);
            assert!(COVERAGE.contains(&rate), "{folder}, {kind:?}: {rate}");
        }
    }
}

/// For the Panda the friction behind the torque sensors is known, for the `UR5e` none.
#[test]
fn intervals_contain_identified_friction() {
    let mut arms = arms(".");
    arms.retain(|arm| arm.name.contains("UR10") || arm.name.contains("TX40"));
    arms.push(find("IRB1600-10/1.45").unwrap());
    let rate = rate(&arms, Kind::Friction);
    assert!(arms.len() == 3 && COVERAGE.contains(&rate), "{rate}");
}

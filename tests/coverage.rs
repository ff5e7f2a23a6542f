//! Intervals of estimated torques against bodies that other makers publish. `examples/coverage` counts more.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

#[path = "../examples/coverage/torques.rs"]
mod torques;

use std::path::Path;

use joulepath::robot::load;
use torques::{Kind, held, unknown};

/// Share of cases that 90 % intervals have to hold over arms of many makers.
const COVERAGE: std::ops::RangeInclusive<f64> = 0.80..=0.97;

/// Share of the torques of the arms in a folder that the intervals hold.
fn rate(folder: &str, kind: Kind) -> f64 {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/coverage").join(folder);
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let truth = load(path.to_str().unwrap()).unwrap();
            all.extend(held(&truth, &unknown(&truth), kind));
        }
    }
    all.iter().filter(|held| **held).count() as f64 / all.len() as f64
}

#[test]
fn intervals_hold_gravity_and_inertia_of_other_makers_arms() {
    for folder in ["makers/chosen", "makers/unseen", "."] {
        for kind in [Kind::Gravity, Kind::Acceleration] {
            let rate = rate(folder, kind);
            assert!(COVERAGE.contains(&rate), "{folder}, {kind:?}: {rate}");
        }
    }
}

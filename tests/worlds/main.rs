//! The worlds of the examination: agreement with the library without faults, seals and grades.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

#[path = "../command/mod.rs"]
mod command;

use std::collections::BTreeSet;
use std::fs;

use command::{json, refused, run};
use joulepath::arm::dynamics::{self, Data, Load};
use joulepath::arm::robot::{self, Model};
use joulepath::examine::blind::{self, Kind, Sealed, seal};
use joulepath::examine::worlds::{self, World};
use joulepath::learn::log::{Channel, ColumnMap, read_csv};
use serde_json::Value;

const WORLDS: [World; 3] = [World::A, World::B, World::C];
/// Largest difference of two formulations of the dynamics, relative to the joint's torque.
const SAME: f64 = 1e-9;
/// Numbers of a seed among which all kinds are looked for.
const NUMBERS: usize = 150;

fn loaded(name: &str, text: &str) -> Model {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    robot::load(path.to_str().unwrap()).unwrap()
}

#[test]
fn worlds_agree_with_the_library_without_faults() {
    for world in WORLDS {
        for seed in 1..=6 {
            let plain = worlds::plain(world, seed);
            for (file, name) in ["nominal.toml", "nominal.urdf"].into_iter().enumerate() {
                let model = loaded(name, &plain.files[file]);
                let (n, mut data) = (model.dof, Data::new());
                for ([q, v, a], torques) in plain.states.iter().zip(&plain.torques) {
                    let (q, v, a) = (&q[..n], &v[..n], &a[..n]);
                    let told = dynamics::torque(&model, &mut data, &Load::none(), q, v, a);
                    for i in 0..n {
                        let (own, told) = (torques[file][i], told.rigid[i] + told.friction[i]);
                        let missed = (own - told).abs();
                        assert!(
                            missed <= SAME * (1.0 + told.abs()),
                            "{world:?} {name} {own} {told}"
                        );
                    }
                }
            }
        }
    }
}

/// The first case of each kind: its files can be read, and its truth is complete.
fn each_kind_is_complete(world: World) {
    let kinds = [
        Kind::Healthy,
        Kind::ParametersOnly,
        Kind::One,
        Kind::Two,
        Kind::Outside,
        Kind::Power,
        Kind::Motion,
    ];
    let mut left: BTreeSet<Kind> = kinds.into_iter().collect();
    for number in 1..NUMBERS {
        if left.is_empty() || !worlds::kinds(4, number).iter().any(|kind| left.contains(kind)) {
            continue;
        }
        let case = worlds::case(world, 4, number);
        if !left.remove(&case.label.kind) {
            continue;
        }
        let file = |name: &str| {
            let found = case.files.iter().find(|(other, _)| other == name);
            &found.unwrap_or_else(|| panic!("{world:?} {number} lacks {name}")).1
        };
        let options: Value = serde_json::from_str(file("case.json")).unwrap();
        let robot = options["robot"].as_str().unwrap();
        let model = loaded(robot, file(robot));
        assert_eq!(options["trust"].as_str().unwrap(), case.label.trust);
        let kind = case.label.kind;
        let is_log =
            |name: &str| ["log-", "heldout", "baseline-"].iter().any(|of| name.starts_with(of));
        for (name, text) in case.files.iter().filter(|(name, _)| is_log(name)) {
            let log = read_csv(text.as_bytes(), &ColumnMap::default()).unwrap();
            let has = |channel| log.column(channel).is_some();
            let torques = (0..model.dof).all(|joint| has(Channel::Torque(joint)));
            assert_eq!(torques, options.get("program").is_none(), "{name}");
            assert_eq!(has(Channel::Power), kind == Kind::Power, "{name}");
        }
        file("log-1.csv");
        file("heldout.csv");
        let expected = match kind {
            Kind::Healthy => 0,
            Kind::Two => 2,
            _ => 1,
        };
        assert_eq!(case.label.effects.len(), expected, "{world:?} {number} {kind:?}");
        for truth in &case.label.effects {
            assert!(truth.nats.is_finite() && truth.nats > 0.0, "{truth:?}");
            assert!(truth.parameters.iter().all(|of| of.value.is_finite()), "{truth:?}");
        }
        let held = &case.label.heldout;
        assert_eq!(held.len(), if options.get("program").is_some() { 0 } else { model.dof });
        assert!(held.iter().all(|of| of.left > 0.0 && of.left < of.torque), "{held:?}");
    }
    assert!(left.is_empty(), "{world:?} lacks {left:?}");
}

#[test]
fn each_kind_of_case_of_world_a_is_complete() {
    each_kind_is_complete(World::A);
}

#[test]
fn each_kind_of_case_of_world_b_is_complete() {
    each_kind_is_complete(World::B);
}

#[test]
fn each_kind_of_case_of_world_c_is_complete() {
    each_kind_is_complete(World::C);
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    for world in WORLDS {
        let once = worlds::case(world, 5, 3);
        assert_eq!(once, worlds::case(world, 5, 3));
        assert_ne!(once.files, worlds::case(world, 6, 3).files);
        assert_ne!(once.files, worlds::case(world, 5, 4).files);
    }
}

#[test]
fn labels_are_sealed_and_opened() {
    let labels: Vec<_> = WORLDS
        .into_iter()
        .zip(1..)
        .map(|(world, number)| {
            let case = worlds::case(world, 7, number);
            (case.label, case.salt)
        })
        .collect();
    let Sealed { seals, key } = seal(&labels).unwrap();
    let opened = blind::open(&Sealed { seals, key }).unwrap();
    assert_eq!(opened, labels.into_iter().map(|(label, _)| label).collect::<Vec<_>>());
}

/// `blind generate --world` writes cases that `blind grade` opens; an equivalent of the truth is right.
#[test]
fn cases_are_generated_and_graded() {
    for world in ["A", "B", "c"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("cases");
        let out = out.to_str().unwrap();
        run(&[
            "blind", "generate", "--world", world, "--out", out, "--seed", "9", "--count", "3",
            "-q",
        ]);
        let key: Value =
            serde_json::from_str(&fs::read_to_string(format!("{out}/labels.key")).unwrap())
                .unwrap();
        for entry in key["labels"].as_array().unwrap() {
            let label: Value = serde_json::from_str(entry["label"].as_str().unwrap()).unwrap();
            let named: Vec<Value> = label["effects"]
                .as_array()
                .unwrap()
                .iter()
                .filter(|_| label["kind"] != "outside" && label["kind"] != "parameters_only")
                .map(
                    |of| serde_json::json!({ "id": of["equivalents"].get(0).unwrap_or(&of["id"]) }),
                )
                .collect();
            let verdict = if named.is_empty() { "unknown" } else { "effect" };
            let told = serde_json::json!({ "verdict": verdict, "effects": named }).to_string();
            fs::write(format!("{out}/{}/diagnosis.json", entry["case"].as_str().unwrap()), told)
                .unwrap();
        }
        let grades = json(&["blind", "grade", out, "--format", "json"]);
        assert_eq!(grades["cases"], 3);
        assert_eq!(grades["wrong"], serde_json::json!([]));
    }
    let args = ["blind", "generate", "--world", "A", "--cycles", "3", "--out", "x", "--seed", "1"];
    refused(&args, "--cycles");
}

/// The robot that a case names reaches the diagnosis, here a URDF that cannot be read.
#[test]
fn the_robot_of_a_case_reaches_the_diagnosis() {
    let case = (1..NUMBERS)
        .filter(|number| worlds::kinds(2, *number) == [Kind::Healthy])
        .map(|number| worlds::case(World::A, 2, number))
        .find(|case| case.files[0].0 == "nominal.urdf")
        .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join(&case.name);
    fs::create_dir(&at).unwrap();
    for (name, text) in &case.files {
        let text = if name == "nominal.urdf" { "<robot" } else { text.as_str() };
        fs::write(at.join(name), text).unwrap();
    }
    let sealed = seal(&[(case.label, case.salt)]).unwrap();
    fs::write(folder.path().join("labels.key"), sealed.key).unwrap();
    fs::write(folder.path().join("seals.csv"), sealed.seals).unwrap();
    refused(&["blind", "grade", folder.path().to_str().unwrap()], "nominal.urdf");
}

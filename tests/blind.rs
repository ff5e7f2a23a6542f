//! The simulator of the examination compared with the library's dynamics; its seals and grades.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use command::{json, refused, run, stdout};
use joulepath::arm::dynamics::{self, Data, Load};
use joulepath::arm::robot::{self, MAX_DOF, Model};
use joulepath::examine::blind::{self, Case, Grades, Kind, Label, Settings, TrueParameter, Truth};
use joulepath::learn::log::{ColumnMap, read_csv};
use serde_json::Value;

/// Largest difference of two formulations of the dynamics, relative to the largest torque.
const SAME: f64 = 1e-9;
/// Relative tolerance between a residual of averaged and differentiated logs and its label.
const RESIDUAL: f64 = 0.15;
/// Resolution of a duration in a log \[s\].
const TWO_ROWS: f64 = 0.02;
/// Rate below which a joint counts as at rest \[rad/s\].
const RESTS: f64 = 0.02;

/// A state of a robot: angles, rates, accelerations.
fn state(k: usize) -> [[f64; MAX_DOF]; 3] {
    let wave = |offset: f64, size: f64| {
        std::array::from_fn(|joint| size * (offset + 1.7 * k as f64 + 2.3 * joint as f64).sin())
    };
    [wave(0.0, 1.5), wave(1.0, 2.0), wave(2.0, 9.0)]
}

fn same_torques(model: &Model) {
    let mut data = Data::new();
    for k in 0..40 {
        let [q, qd, qdd] = state(k);
        let n = model.dof;
        let theirs =
            dynamics::torque(model, &mut data, &Load::none(), &q[..n], &qd[..n], &qdd[..n]);
        let own = blind::torque(model, &q, &qd, &qdd);
        for joint in 0..n {
            let theirs = theirs.rigid[joint] + theirs.friction[joint];
            let missed = (own[joint] - theirs).abs();
            assert!(missed <= SAME * (1.0 + theirs.abs()), "{}: {own:?} {theirs}", model.name);
        }
    }
}

#[test]
fn virtual_work_and_newton_euler_give_the_same_torques() {
    same_torques(&robot::find("IRB1600-10/1.45").unwrap());
    for file in ["fixtures/dynamics/skew.toml", "fixtures/dynamics/seven.toml"] {
        same_torques(&robot::load(file).unwrap());
    }
    let coupled = "name = \"coupled\"\nextends = \"IRB1600-10/1.45\"\n[wrist]\ncoupling = -0.7\n\
        [kinematics.base]\norigin = [0.0, 0.0, 0.0]\nrpy = [0.3, 1.2, 0.0]\n";
    same_torques(&robot::from_toml("coupled.toml", coupled).unwrap());
}

fn short(seed: u64) -> Settings {
    Settings { cycles: 3, period_s: 4.0, ..Settings::new(seed) }
}

fn file<'a>(case: &'a Case, name: &str) -> &'a str {
    &case.files.iter().find(|(other, _)| other == name).unwrap().1
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let (once, again) = (blind::case(&short(5), 3).unwrap(), blind::case(&short(5), 3).unwrap());
    assert_eq!(once, again);
    assert_ne!(once.files, blind::case(&short(6), 3).unwrap().files);
    assert_ne!(once.files, blind::case(&short(5), 4).unwrap().files);
}

/// Names, order and headers of the files do not reveal the kind of a case.
#[test]
fn case_files_do_not_reveal_the_kind_of_a_case() {
    for number in 1..=12 {
        let case = blind::case(&short(8), number).unwrap();
        let names: Vec<&str> = case.files.iter().map(|(name, _)| name.as_str()).collect();
        if has_a_program(&case) {
            continue;
        }
        let mut expected = vec!["nominal.toml", "log-1.csv", "log-2.csv", "heldout.csv"];
        if names.contains(&"baseline-1.csv") {
            expected.push("baseline-1.csv");
        }
        expected.push("case.json");
        assert_eq!(names, expected);
        for name in &expected[1..expected.len() - 1] {
            let text = file(&case, name);
            let header = text.lines().next().unwrap();
            assert_eq!(header, "t,q1,q2,q3,q4,q5,q6,tau1,tau2,tau3,tau4,tau5,tau6,power");
            assert_eq!(text.lines().count(), 1201, "{name} of case {number}");
        }
        let options: Value = serde_json::from_str(file(&case, "case.json")).unwrap();
        assert_eq!(options.as_object().unwrap().len(), 2);
        assert!(robot::from_toml("nominal.toml", file(&case, "nominal.toml")).is_ok());
    }
}

fn has_a_program(case: &Case) -> bool {
    case.files.iter().any(|(name, _)| name.starts_with("program/"))
}

/// The first case of a kind.
fn first(kind: Kind, settings: &Settings) -> Case {
    let mut cases = (1..200).map(|number| blind::case(settings, number).unwrap());
    cases.find(|case| case.label.kind == kind && !case.label.heldout.is_empty()).unwrap()
}

/// The moves of a program have the stated durations; an extra wait follows the stated move.
#[test]
fn program_logs_agree_with_stated_durations_and_labels() {
    let settings = short(4);
    let cases = (1..80).map(|number| blind::case(&settings, number).unwrap());
    let (mut healthy, mut late) = (0, 0);
    for case in cases.filter(has_a_program) {
        let program = file(&case, "program/MainModule.mod");
        let log = read_csv(file(&case, "log-1.csv").as_bytes(), &ColumnMap::default()).unwrap();
        let column = |channel| log.column(channel).unwrap();
        let moving = column(joulepath::learn::log::Channel::Command);
        let cycle = column(joulepath::learn::log::Channel::Cycle);
        let mut missed = Vec::new();
        let moves = program.lines().filter(|line| line.contains("MoveAbsJ"));
        for (number, text) in moves.enumerate().skip(1) {
            let stated = text.split("T:=").nth(1).unwrap().split(',').next().unwrap();
            let stated: f64 = stated.parse().unwrap();
            let rows =
                moving.iter().zip(cycle).filter(|(m, c)| **m == number as f64 + 1.0 && **c == 2.0);
            missed.push(rows.count() as f64 * 0.01 - stated);
        }
        let late_by: f64 = missed.iter().sum();
        match case.label.effects.first().map(|truth| truth.id.as_str()) {
            None => {
                healthy += 1;
                assert!(missed.iter().all(|late| late.abs() < TWO_ROWS), "{missed:?}");
            }
            Some("acceleration_limit" | "speed_limit") if case.label.effects[0].nats > 1e3 => {
                late += 1;
                assert!(late_by > TWO_ROWS, "{missed:?}");
            }
            Some("program_wait") => {
                let line = program.lines().nth(case.label.lines[0] - 1).unwrap();
                assert!(line.contains("MoveAbsJ"), "{line}");
            }
            Some(_) => {}
        }
    }
    assert!(healthy > 0 && late > 0, "{healthy} healthy, {late} late");
}

/// Mean of a column over the periods.
fn averaged(column: &[f64], count: usize) -> Vec<f64> {
    let cycles = column.len() / count;
    (0..count)
        .map(|i| (0..cycles).map(|m| column[m * count + i]).sum::<f64>() / cycles as f64)
        .collect()
}

/// The residual of the nominal model on a healthy log agrees with the label.
#[test]
fn residuals_of_a_healthy_log_agree_with_its_label() {
    let settings = Settings { cycles: 6, period_s: 8.0, ..Settings::new(21) };
    let case = first(Kind::Healthy, &settings);
    let model = robot::from_toml("nominal.toml", file(&case, "nominal.toml")).unwrap();
    let log = read_csv(file(&case, "heldout.csv").as_bytes(), &ColumnMap::default()).unwrap();
    let motion = log.motion();
    let count = (settings.period_s * 100.0).round() as usize;
    let tau: Vec<Vec<f64>> = (0..model.dof)
        .map(|joint| {
            averaged(log.column(joulepath::learn::log::Channel::Torque(joint)).unwrap(), count)
        })
        .collect();
    let mut data = Data::new();
    let mut sums = vec![(0.0, 0.0); model.dof];
    // The middle period has rows on both sides for the derivatives.
    for (row, t) in motion.time.iter().enumerate() {
        let k = ((t - log.time()[0]) * 100.0).round() as usize;
        if !(2 * count..3 * count).contains(&k) {
            continue;
        }
        let at = |columns: &[Vec<f64>]| -> Vec<f64> { columns.iter().map(|c| c[row]).collect() };
        let [q, qd, qdd] = [at(&motion.q), at(&motion.qd), at(&motion.qdd)];
        let expected = dynamics::torque(&model, &mut data, &Load::none(), &q, &qd, &qdd);
        for joint in 0..model.dof {
            if qd[joint].abs() > RESTS {
                let missed =
                    tau[joint][k % count] - expected.rigid[joint] - expected.friction[joint];
                sums[joint].0 += missed * missed;
                sums[joint].1 += 1.0;
            }
        }
    }
    let mut near = 0;
    for (held, (squares, rows)) in case.label.heldout.iter().zip(sums) {
        let rms = f64::sqrt(squares / rows);
        near += usize::from((rms / held.model - 1.0).abs() < RESIDUAL);
    }
    // Noise is a larger share of the small wrist torques.
    assert!(near >= 4, "{near} of 6 joints");
}

/// A label with one truth.
fn label(case: &str, kind: Kind, ids: &[&str]) -> Label {
    let truth = |id: &&str| Truth {
        id: (*id).to_owned(),
        form: "linear".into(),
        joints: vec![2],
        parameters: vec![TrueParameter {
            name: "offset".into(),
            joint: Some(2),
            value: 1.0,
            graded: true,
        }],
        window: None,
        equivalents: Vec::new(),
        nats: 50.0,
    };
    Label {
        case: case.into(),
        kind,
        trust: "cad".into(),
        effects: ids.iter().map(truth).collect(),
        place: (!ids.is_empty()).then_some(2),
        share: Some(0.9),
        lines: Vec::new(),
        heldout: Vec::new(),
    }
}

fn asserted(id: &str, joints: &[usize], class: &[&str], offset: f64) -> Value {
    serde_json::json!({"id": id, "joints": joints, "class": class, "probability": 0.97,
        "parameters": {"offset": {"value": offset, "sd": 0.1, "unit": "Nm"}}})
}

fn diagnosis(verdict: &str, effects: &[Value]) -> Value {
    serde_json::json!({"verdict": verdict, "effects": effects, "candidates": [], "generic": [],
        "where": [{"joint": 2, "share_percent": 40.0}, {"joint": 1, "share_percent": 35.0},
                  {"joint": 2, "share_percent": 25.0}], "gap": [], "model": null})
}

/// Labels and diagnoses with manually counted grades.
fn manually_graded() -> (Vec<Label>, Vec<Value>) {
    let offset =
        |joints: &[usize], class: &[&str], value| asserted("torque_offset", joints, class, value);
    vec![
        (label("a", Kind::Healthy, &[]), diagnosis("no_gap", &[])),
        (label("b", Kind::Healthy, &[]), diagnosis("effect", &[offset(&[1], &[], 1.0)])),
        (label("c", Kind::Healthy, &[]), diagnosis("parameters_only", &[])),
        (label("d", Kind::One, &["torque_offset"]), diagnosis("effect", &[offset(&[2], &[], 1.2)])),
        (
            label("e", Kind::One, &["torque_offset"]),
            diagnosis("effect", &[asserted("cable", &[3], &["cable", "torque_offset"], 1.0)]),
        ),
        (
            label("f", Kind::One, &["torque_offset"]),
            diagnosis("effect", &[asserted("cable", &[2], &["cable"], 1.0)]),
        ),
        (label("g", Kind::One, &["torque_offset"]), diagnosis("unknown", &[])),
        (label("h", Kind::One, &["torque_offset"]), diagnosis("effect", &[offset(&[2], &[], 1.4)])),
        (
            label("i", Kind::Two, &["torque_offset", "cable"]),
            diagnosis("effect", &[offset(&[2], &[], 1.0), asserted("cable", &[2], &[], 1.0)]),
        ),
        (
            label("j", Kind::Two, &["torque_offset", "cable"]),
            diagnosis("partial", &[offset(&[2], &[], 1.0)]),
        ),
        (label("k", Kind::Outside, &["outside"]), diagnosis("unknown", &[])),
        (label("l", Kind::Outside, &["outside"]), diagnosis("no_gap", &[])),
    ]
    .into_iter()
    .unzip()
}

fn hits(grades: &Grades, name: &str) -> (usize, usize) {
    let rate = grades.rates.iter().find(|rate| rate.name == name).unwrap();
    (rate.hits, rate.of)
}

#[test]
fn rates_agree_with_a_manual_count() {
    let (labels, diagnoses) = manually_graded();
    let grades = blind::grade(&labels, &diagnoses, None).unwrap();
    for (name, counted) in [
        ("healthy_named", (1, 3)),
        ("parameters_only_named", (0, 0)),
        ("one_right_or_class", (3, 5)),
        ("one_wrong_name", (1, 5)),
        ("one_joints", (2, 3)),
        ("one_place", (4, 4)),
        // 1.2 lies within three times 0.1 of 1, and 1.4 does not.
        ("parameters_within_3_sd", (4, 5)),
        ("two_both", (1, 2)),
        ("two_wrong_name", (0, 2)),
        ("outside_abstains", (1, 2)),
    ] {
        assert_eq!(hits(&grades, name), counted, "{name}");
    }
    let wrong: Vec<&str> = grades.wrong.iter().map(|wrong| wrong.case.as_str()).collect();
    assert_eq!(wrong, ["b", "f"]);
    assert_eq!(grades.confusion["torque_offset"]["right_name"], 2);
    assert_eq!(grades.confusion["torque_offset"]["right_class"], 1);
    // Eight effects have a stated probability of 0.97; those of b and f are absent.
    let bin = grades.reliability.iter().find(|bin| bin.of > 0).unwrap();
    assert_eq!((bin.hits, bin.of), (6, 8));
}

#[test]
fn a_left_out_effect_accepts_unknown_or_its_class() {
    let (labels, diagnoses) = manually_graded();
    let grades = blind::grade(&labels, &diagnoses, Some("torque_offset")).unwrap();
    assert_eq!(grades.cases, 5);
    assert_eq!(hits(&grades, "left_out_unknown_or_class"), (4, 5));
    assert_eq!(hits(&grades, "left_out_wrong_name"), (1, 5));
    // Every torque effect belongs to a family.
    let family = blind::grade(&labels, &diagnoses, Some(blind::FAMILY)).unwrap();
    assert_eq!((family.cases, family.rates), (5, grades.rates));
}

#[test]
fn effects_with_little_evidence_are_not_graded() {
    let (mut labels, diagnoses) = manually_graded();
    for label in &mut labels {
        for truth in &mut label.effects {
            truth.nats = 0.5;
        }
    }
    let grades = blind::grade(&labels, &diagnoses, None).unwrap();
    assert_eq!(hits(&grades, "one_right_or_class"), (0, 0));
    assert_eq!(hits(&grades, "healthy_named"), (1, 3));
}

#[test]
fn opening_the_seals_detects_a_changed_key() {
    let labels = vec![
        (label("case-0001", Kind::Healthy, &[]), "salt".to_owned()),
        (label("case-0002", Kind::One, &["cable"]), "pepper".to_owned()),
    ];
    let sealed = blind::seal(&labels).unwrap();
    let opened = blind::open(&sealed).unwrap();
    assert_eq!(opened, [labels[0].0.clone(), labels[1].0.clone()]);
    for (from, to) in [("cable", "ripple"), ("pepper", "sugar"), ("case-0002", "case-0003")] {
        let mut changed = sealed.clone();
        changed.key = changed.key.replace(from, to);
        assert_ne!(changed.key, sealed.key);
        assert!(blind::open(&changed).is_err(), "{from} became {to}");
    }
    let mut swapped = labels.clone();
    swapped.swap(0, 1);
    (swapped[0].0.case, swapped[1].0.case) = ("case-0001".into(), "case-0002".into());
    let other = blind::seal(&swapped).unwrap();
    let mixed = blind::Sealed { seals: sealed.seals.clone(), key: other.key };
    assert!(blind::open(&mixed).unwrap_err().to_string().contains("is broken"));
    assert!(!sealed.seals.contains("cable") && !sealed.seals.contains("salt"));
}

#[test]
fn grade_reads_the_cases_that_generate_writes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("cases");
    let shown = out.to_str().unwrap();
    let generate =
        ["blind", "generate", "--out", shown, "--seed", "3", "--count", "4", "--cycles", "2"];
    let generate = [&generate[..], &["--period", "4", "--quiet"]].concat();
    run(&generate);
    refused(&generate, "name a new folder");
    let diagnosis = diagnosis("unknown", &[]).to_string();
    for number in 1..=4 {
        let case = out.join(format!("case-{number:04}"));
        fs::write(case.join("diagnosis.json"), &diagnosis).unwrap();
    }
    let grades = json(&["blind", "grade", shown, "--format", "json"]);
    assert_eq!(grades["cases"], 4);
    let page = folder.path().join("grades.html");
    let output = run(&["blind", "grade", shown, "--report", page.to_str().unwrap()]);
    assert!(stdout(&output).contains("healthy_named"));
    let page = fs::read_to_string(page).unwrap();
    for text in ["4 cases", "healthy_named", "What stated probabilities are worth", "</html>"] {
        assert!(page.contains(text), "no {text}");
    }
    refused(&["blind", "grade", shown, "--leave-out", "nonsense"], "name one that");

    damaged_cases_are_refused(&out, shown);
}

/// No effect of a pair is left out.
#[test]
fn cases_with_two_effects_cannot_leave_one_out() {
    let folder = tempfile::tempdir().unwrap();
    let settings = short(13);
    let pairs = (1..200).map(|number| blind::case(&settings, number).unwrap());
    let pair = pairs.into_iter().find(|case| case.label.kind == Kind::Two).unwrap();
    let sealed = blind::seal(&[(pair.label.clone(), pair.salt)]).unwrap();
    fs::write(folder.path().join(blind::KEY), sealed.key).unwrap();
    fs::write(folder.path().join(blind::SEALS), sealed.seals).unwrap();
    let (shown, id) = (folder.path().to_str().unwrap(), &pair.label.effects[0].id);
    refused(&["blind", "grade", shown, "--leave-out", id], "no case has this effect alone");
}

/// The library lacks the family; the diagnosis names none of its effects.
#[test]
fn leaving_out_a_family_removes_all_its_effects() {
    let folder = tempfile::tempdir().unwrap();
    let settings = short(13);
    let number = (1..200)
        .find(|number| {
            let label = blind::case(&settings, *number).unwrap().label;
            label.kind == Kind::One && label.effects[0].id == "wrist_coupling"
        })
        .unwrap();
    let case = blind::case(&settings, number).unwrap();
    let out = folder.path();
    for (name, text) in &case.files {
        fs::create_dir_all(out.join(&case.name)).unwrap();
        fs::write(out.join(&case.name).join(name), text).unwrap();
    }
    let sealed = blind::seal(&[(case.label.clone(), case.salt.clone())]).unwrap();
    fs::write(out.join(blind::KEY), sealed.key).unwrap();
    fs::write(out.join(blind::SEALS), sealed.seals).unwrap();
    let shown = out.to_str().unwrap();
    let grades = json(&["blind", "grade", shown, "--leave-out", "family", "--format", "json"]);
    assert_eq!((&grades["cases"], &grades["left_out"]), (&1.into(), &"family".into()));
    let kept = out.join(&case.name).join("diagnosis-without-family.json");
    let kept: Value = serde_json::from_str(&fs::read_to_string(kept).unwrap()).unwrap();
    let all =
        kept["effects"].as_array().unwrap().iter().chain(kept["candidates"].as_array().unwrap());
    for effect in all {
        let id = effect["id"].as_str().unwrap();
        let of_family =
            ["wrist_coupling", "ripple", "backlash", "elasticity", "rotor_inertia", "brake_drag"];
        assert!(!of_family.contains(&id), "{id}");
    }
}

/// Damaged, missing or changed files.
fn damaged_cases_are_refused(out: &Path, shown: &str) {
    let diagnosis = out.join("case-0002/diagnosis.json");
    let good = fs::read(&diagnosis).unwrap();
    for (text, way_out) in [
        ("{", "write it again with diagnose"),
        ("[]", "write it again with diagnose"),
        ("{\"verdict\":\"maybe\",\"effects\":[]}", "write it again with diagnose"),
        ("{\"verdict\":\"unknown\",\"effects\":3}", "write it again with diagnose"),
    ] {
        fs::write(&diagnosis, text).unwrap();
        refused(&["blind", "grade", shown], way_out);
    }
    fs::write(&diagnosis, good).unwrap();
    let key = out.join(blind::KEY);
    let sealed = fs::read_to_string(&key).unwrap();
    fs::write(&key, sealed.replace("case-0001", "../../etc")).unwrap();
    refused(&["blind", "grade", shown], "both have to be of one examination");
    fs::write(&key, sealed.replacen("salt\": \"", "salt\": \"0", 1)).unwrap();
    refused(&["blind", "grade", shown], "is broken");
    fs::write(&key, "{}").unwrap();
    refused(&["blind", "grade", shown], "take the one that was written");
    fs::remove_file(&key).unwrap();
    refused(&["blind", "grade", shown], "name the folder that");
}

/// A phase is compared modulo a turn; a parameter without a deviation has to be exact.
#[test]
fn parameters_are_compared_with_their_deviation() {
    let truth = 3.1;
    for (name, value, sd, is_within) in [
        ("phase", truth - TAU, 0.01, true),
        ("phase", -truth, 0.01, false),
        ("offset", truth - TAU, 0.01, false),
        ("offset", truth, 0.0, true),
        ("offset", truth + 1e-9, 0.0, false),
    ] {
        let mut label = label("a", Kind::One, &["ripple"]);
        let parameter = &mut label.effects[0].parameters[0];
        (parameter.name, parameter.value) = (name.into(), truth);
        let mut said = asserted("ripple", &[2], &[], 0.0);
        said["parameters"] = serde_json::json!({name: {"value": value, "sd": sd, "unit": ""}});
        let grades = blind::grade(&[label], &[diagnosis("effect", &[said])], None).unwrap();
        let counted = hits(&grades, "parameters_within_3_sd");
        assert_eq!(counted, (usize::from(is_within), 1), "{name} {value} {sd}");
    }
}

//! Held-out claims of `diagnose`, recomputed from the output of `predict`.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::path::Path;

use command::{joulepath, parsed, rows, run, stdout};
use joulepath::examine::blind::{self, Case, Settings};
use joulepath::learn::log::{Channel, ColumnMap, Log, read_csv};
use serde_json::Value;

/// Repetitions of each log.
const CYCLES: usize = 4;
/// Rate below which a joint counts as at rest \[rad/s\].
const RESTS: f64 = 0.02;
/// Tolerance relative to the claim, and relative to the noise of the mean.
const CLAIM_TOLERANCE: f64 = 0.05;
const NOISE_TOLERANCE: f64 = 0.25;
/// Offset of an angle against its log \[rad\].
const OFFSET: f64 = 0.04;
/// Tolerance of the claimed reduction in percentage points.
const SHRINK_TOLERANCE: f64 = 4.0;

/// The rows of a log.
fn log(text: &str) -> Log {
    read_csv(text.as_bytes(), &ColumnMap::default()).unwrap()
}

/// Rms of the residuals and of the torques by joint: of the mean of the repetitions, while the
/// joint moves.
fn residuals(robot: &str, held: &str) -> [Vec<f64>; 2] {
    let output = run(&["predict", "--robot", robot, "--log", held, "--quiet"]);
    let predicted = rows(&stdout(&output));
    let log = log(&fs::read_to_string(held).unwrap());
    let time = log.time();
    assert_eq!(predicted.len(), time.len());
    let count = time.len() / CYCLES;
    let rms = |joint: usize| {
        let q = log.column(Channel::Position(joint)).unwrap();
        let tau = log.column(Channel::Torque(joint)).unwrap();
        let mean = |of: &dyn Fn(usize) -> f64, phase: usize| -> f64 {
            (0..CYCLES).map(|k| of(k * count + phase % count)).sum::<f64>() / CYCLES as f64
        };
        let step = time[1] - time[0];
        let (mut moving, mut squares, mut size) = (0.0, 0.0, 0.0);
        for phase in 0..count {
            let change = mean(&|row| q[row], phase + 1) - mean(&|row| q[row], phase + count - 1);
            if change.abs() > 2.0 * step * RESTS {
                moving += 1.0;
                squares += mean(&|row| tau[row] - predicted[row][1 + joint], phase).powi(2);
                size += mean(&|row| tau[row], phase).powi(2);
            }
        }
        [f64::sqrt(squares / moving), f64::sqrt(size / moving)]
    };
    let all: Vec<[f64; 2]> = (0..log.joints()).map(rms).collect();
    [all.iter().map(|of| of[0]).collect(), all.iter().map(|of| of[1]).collect()]
}

/// A case of the examination with short logs.
fn case(seed: u64, number: usize) -> Case {
    let settings = Settings { cycles: CYCLES, period_s: 5.0, ..Settings::new(seed) };
    blind::case(&settings, number).unwrap()
}

/// Verifies the claims for an examination case in which the effect `id` is asserted; returns the
/// reduction, %. How often effects are asserted is the examination's subject, not this one's.
fn check_case(seed: u64, number: usize, id: &str) -> f64 {
    let case = case(seed, number);
    assert!(case.label.effects.iter().any(|truth| truth.id == id), "{:?}", case.label.effects);
    check_claims(&case, id)
}

/// Verifies the claims for a case in which the only effect that may be found is asserted; returns the
/// reduction, %.
fn check_claims(case: &Case, id: &str) -> f64 {
    let (found, claimed) = verified(case, id);
    assert_eq!(found["effects"][0]["id"], id, "{found:#}");
    claimed
}

/// Diagnoses a case with one effect of the library and verifies its claims with `predict`; returns
/// the answer and the reduction, %.
fn verified(case: &Case, id: &str) -> (Value, f64) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in &case.files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let at = |name: &str| Path::join(folder.path(), name).display().to_string();
    let (nominal, better) = (at("nominal.toml"), at("better.toml"));
    // The second log has no jumps of the acceleration, so that both differentiations agree.
    let (first, last, held) = (at("log-1.csv"), at("heldout.csv"), at("log-2.csv"));
    let args = ["diagnose", "--robot", &nominal, "--log", &first, &last, "--heldout", &held];
    let rest = ["--trust", &case.label.trust, "--period", "5", "--effects", id];
    let more = ["--out", &better, "--format", "json", "--quiet"];
    let found = parsed(&joulepath(&[&args[..], &rest, &more].concat()));
    let gap = found["gap"][0].clone();
    let [before, size] = residuals(&nominal, &held);
    let [after, _] = residuals(&better, &held);
    let mut sums = [0.0; 2];
    for (joint, claim) in gap["per_joint"].as_array().unwrap().iter().enumerate() {
        let claimed_rms = |name: &str| claim[name].as_f64().unwrap();
        let noise = claimed_rms("noise");
        let pairs = [
            (claimed_rms("model"), before[joint]),
            (claimed_rms("refit_plus_effect"), after[joint]),
        ];
        for (k, (claimed, rms)) in pairs.into_iter().enumerate() {
            let recomputed = (rms * rms - noise * noise).max(0.0).sqrt();
            let may = CLAIM_TOLERANCE * claimed + NOISE_TOLERANCE * noise;
            assert!(
                (recomputed - claimed).abs() <= may,
                "{id}, joint {}: claimed {claimed}, recomputed {recomputed}, noise {noise}",
                joint + 1
            );
            sums[k] += (recomputed / size[joint]).powi(2);
        }
    }
    let shrink = 100.0 * (1.0 - (sums[1] / sums[0]).sqrt());
    let claimed = gap["shrink_percent"]["value"].as_f64().unwrap();
    assert!((shrink - claimed).abs() <= SHRINK_TOLERANCE, "{id}: claimed {claimed} %, {shrink} %");
    (found, claimed)
}

#[test]
fn claims_hold_for_a_payload() {
    check_case(11, 24, "payload");
}

#[test]
fn claims_hold_for_stiction() {
    // A curve of less than twice the everyday error, which is not asserted.
    verified(&case(15, 45), "stribeck");
    check_case(23, 19, "stribeck");
    check_case(24, 23, "stribeck");
}

#[test]
fn claims_hold_for_a_time_delay() {
    check_case(22, 28, "time_delay");
}

#[test]
fn claims_hold_for_a_flipped_current_sign() {
    check_case(13, 53, "current_sign");
}

/// A healthy robot with an offset of the second angle in its logs.
#[test]
fn claims_hold_for_an_encoder_offset() {
    let mut case = case(11, 5);
    for (_, text) in case.files.iter_mut().filter(|(_, text)| text.starts_with("t,")) {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for line in &mut lines[1..] {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            let angle: f64 = fields[2].parse().unwrap();
            fields[2] = format!("{:.6}", angle - OFFSET);
            *line = fields.join(",");
        }
        *text = lines.join("\n") + "\n";
    }
    check_claims(&case, "encoder_offset");
}

#[test]
fn claims_hold_for_a_tilted_base() {
    // A tilt with 11 nats, which is not asserted.
    verified(&case(12, 12), "base_tilt");
    check_case(42, 14, "base_tilt");
}

#[test]
fn claims_hold_for_a_coupled_wrist() {
    check_case(13, 38, "wrist_coupling");
}

/// Friction of motor 6 with a smooth change of sign over a few per cent of its rate: rows at such
/// slow rates contain no information on its coupling.
#[test]
fn claims_hold_for_a_coupled_wrist_with_smooth_friction() {
    let shrink = check_case(13, 1, "wrist_coupling");
    assert!(shrink > 75.0, "{shrink}");
}

#[test]
fn claims_hold_for_a_dragging_brake() {
    check_case(14, 14, "brake_drag");
}

#[test]
fn claims_hold_for_an_external_force() {
    check_case(13, 26, "contact");
}

/// A robot that is cold at the start of the log clock and warms up.
#[test]
fn warm_up_friction_depends_on_the_time_in_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let model = at("cold.toml");
    let text = "name = \"cold\"\nextends = \"IRB1600-10/1.45\"\n[effects.warm_up]\njoint = 1\n\
        coulomb = 10.0\ntime_constant = 100.0\n";
    fs::write(&model, text).unwrap();
    let friction = |start: f64| -> f64 {
        let lines = (0..200).map(|row| {
            let t = 0.01 * f64::from(row);
            format!("{},{t},0,0,0,0,0", start + t)
        });
        let csv = format!("t,q1,q2,q3,q4,q5,q6\n{}\n", lines.collect::<Vec<_>>().join("\n"));
        let log = at("log.csv");
        fs::write(&log, csv).unwrap();
        let output = run(&["predict", "--robot", &model, "--log", &log, "--quiet"]);
        rows(&stdout(&output))[99][1]
    };
    let warmed = friction(0.0) - friction(1000.0);
    assert!((warmed - 10.0).abs() < 0.2, "{warmed} Nm");
}

//! `joulepath optimize` with idle states: the rest of the takt, the curve of the whole cycle.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;

use command::{KNOWN_LIMITS, number};
use serde_json::Value;

/// Tolerance of a sum of energies, J.
const ROUNDING_J: f64 = 1e-6;
/// Rounding of the times of a stream, s.
const ROUNDING_S: f64 = 1e-3;

const PROGRAM: &str = "MODULE M\n\
    CONST jointtarget jA:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST jointtarget jB:=[[60,20,0,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    PROC main()\n\
    MoveAbsJ jA,v1000,fine,tool0;\n\
    MoveAbsJ jB,v1000,fine,tool0;\n\
    WaitDI diPart,1;\n\
    MoveAbsJ jA,v1000,fine,tool0;\n\
    ENDPROC\n\
    ENDMODULE\n";
const SLEEP: &str = "[idle.sleep]\npower_w = 20\nwake_s = 3\nwake_j = 15\n";
/// Cheaper than sleep, but not awake in time.
const DEEP: &str = "[idle.deep]\npower_w = 0\nwake_s = 60\n";

fn optimize(config: &str, options: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("joulepath.toml"), config).unwrap();
    let result =
        command::optimize(folder.path(), PROGRAM, &[&["--robot", KNOWN_LIMITS], options].concat());
    for side in ["original", "optimized"] {
        let whole = &result["whole_cycle"][side];
        let parts = ["motion_j", "standing_j", "brake_j", "base_j", "rest_j"];
        let sum: f64 = parts.iter().map(|part| whole[part].as_f64().unwrap()).sum();
        assert!((sum - number(whole, "/energy_j")).abs() < ROUNDING_J, "{whole}");
    }
    result
}

/// The takt that leaves so many seconds after the cycle of today.
fn takt(rest: f64) -> (f64, String) {
    let today = number(&optimize("", &[]), "/original/cycle_s");
    (today, (today + rest).to_string())
}

fn note_of(result: &Value, state: &str) -> String {
    let is_of = |note: &&str| note.starts_with(&format!("idle state '{state}'"));
    let notes = result["notes"].as_array().unwrap().iter().filter_map(Value::as_str);
    notes.into_iter().find(is_of).unwrap().to_owned()
}

#[test]
fn the_rest_of_the_takt_is_spent_in_the_cheapest_state() {
    let (today, takt) = takt(20.0);
    let awake = optimize("", &["--takt", &takt]);
    let config = format!("{SLEEP}{DEEP}[idle.hot]\npower_w = 9000\nwake_s = 1\n");
    for form in [&[][..], &["--emit", "retime"]] {
        let asleep = optimize(&config, &[&["--takt", &takt], form].concat());
        assert_eq!(asleep["takt"]["basis"], "given");
        assert_eq!(asleep["whole_cycle"]["optimized"]["rest_state"], "sleep");
        assert!(note_of(&asleep, "sleep").contains("is used for the rest of the takt"));
        assert!(note_of(&asleep, "deep").contains("it takes 60 s to wake up"));
        assert!(note_of(&asleep, "hot").contains("is never used: it takes 9000 W"));
        // Time asleep is worth more than slower travel, and no run is faster than today.
        let cycle = |result| number(result, "/optimized/cycle_s");
        assert!(cycle(&awake) > today + 0.5, "{} s", cycle(&awake));
        assert!(cycle(&asleep) < today + 0.5, "{} s", cycle(&asleep));
        for segment in asleep["segments"].as_array().unwrap() {
            let [before, after] =
                ["time_before_s", "time_after_s"].map(|key| segment[key].as_f64());
            assert!(after.unwrap() > before.unwrap() - ROUNDING_S, "{segment}");
        }
        // The standing power follows from a takt in which the robot stands.
        let standing = optimize("", &["--takt", &takt, "--objective", "time"]);
        let rest = |result: &Value, key: &str| {
            number(result, &format!("/whole_cycle/optimized/rest_{key}"))
        };
        let standing_w = rest(&standing, "j") / rest(&standing, "s");
        let expected = 20.0 * (rest(&asleep, "s") - 3.0) + 3.0 * standing_w + 15.0;
        assert!((rest(&asleep, "j") - expected).abs() < 1e-3, "{} J", rest(&asleep, "j"));
        let energy = |result| number(result, "/whole_cycle/optimized/energy_j");
        assert!(energy(&asleep) < 0.8 * energy(&awake));
        // The padding of the original is the difference of the rests.
        let saved = |at: &str| {
            number(&asleep, &format!("{at}original/energy_j"))
                - number(&asleep, &format!("{at}optimized/energy_j"))
        };
        let (saved, in_takt) = (saved("/"), saved("/whole_cycle/"));
        assert!((saved - in_takt).abs() <= 0.01 * saved, "{saved} J, {in_takt} J");
    }
}

#[test]
fn a_state_is_not_used_in_a_rest_that_is_too_short() {
    let (_, takt) = takt(2.5);
    let result = optimize(SLEEP, &["--takt", &takt]);
    assert_eq!(result["whole_cycle"]["optimized"]["rest_state"], Value::Null);
    assert!(note_of(&result, "sleep").contains("it takes 3 s to wake up"));
    let without = optimize("", &["--takt", &takt]);
    assert_eq!(result["optimized"], without["optimized"]);
}

#[test]
fn waits_with_stated_times_give_the_takt() {
    let stated = optimize("", &["--input", "diPart=6"]);
    assert_eq!(stated["takt"]["basis"], "waits");
    assert_eq!(stated["takt"]["value_s"], stated["original"]["cycle_s"]);
    let notes = stated["notes"].to_string();
    assert!(notes.contains("the takt is ") && notes.contains("waits for inputs"), "{notes}");
    let unknown = optimize("", &[]);
    assert_eq!(unknown["takt"]["basis"], "as before");
    assert!(!unknown["notes"].to_string().contains("the takt is "));
}

#[test]
fn the_curve_of_the_cycle_holds_today_and_the_retrofit() {
    let state = "[idle.nap]\npower_w = 60\nwake_s = 0.5\n";
    for (config, options) in [("", &["--input", "diPart=4"][..]), (state, &["--takt", "9"])] {
        let result = optimize(config, &[&["--pareto", "9"], options].concat());
        let curve = &result["cycle_curve"];
        let points = curve["points"].as_array().unwrap();
        assert_eq!(points.len(), 9);
        let times: Vec<f64> = points.iter().map(|point| number(point, "/time_s")).collect();
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
        for point in points {
            let [bound, energy] = ["/lower_bound_j", "/energy_j"].map(|key| number(point, key));
            assert!(bound <= energy && bound > 0.95 * energy, "{point}");
        }
        let takt = number(&result, "/takt/value_s");
        assert!(times[0] < takt && times[8] >= takt);
        let at_takt = points.iter().find(|point| number(point, "/time_s") == takt).unwrap();
        let least = number(at_takt, "/energy_j");
        let [today, proposed] = ["today", "proposed"].map(|side| number(&curve[side], "/energy_j"));
        assert!(today >= least && proposed <= today, "{least} J, {proposed} J, {today} J");
        assert!((0.9999..1.01).contains(&(proposed / least)), "{least} J, {proposed} J");
        let naps = points.iter().filter(|point| point["rest_state"] == "nap").count();
        assert_eq!(naps > 0, !config.is_empty(), "{curve}");
    }
    let without = optimize("", &[]);
    assert!(without.get("cycle_curve").is_none() && without.get("spacings").is_none());
}

#[test]
fn the_table_of_spacings_has_what_a_retrofit_with_each_spacing_saves() {
    let result = optimize("", &["--input", "diPart=4", "--pareto", "2"]);
    let rows = result["spacings"].as_array().unwrap();
    assert!(
        rows.windows(2).all(|pair| number(&pair[0], "/spacing_s") < number(&pair[1], "/spacing_s"))
    );
    for row in rows {
        let spacing = number(row, "/spacing_s").to_string();
        let own: &[&str] = if row["used"] == true { &[] } else { &["--spacing", &spacing] };
        let alone = optimize("", &[&["--input", "diPart=4"], own].concat());
        let [before, after] =
            ["original", "optimized"].map(|side| number(&alone[side], "/energy_j"));
        assert!((number(row, "/saved_j") - (before - after)).abs() < 1e-9, "{row}");
    }
    let saved = |row: usize| number(&rows[row], "/saved_j");
    assert!(rows.len() == 5 && saved(0) > saved(4), "{rows:?}");
}

#[test]
fn the_report_shows_the_curve_of_the_cycle() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["--robot", KNOWN_LIMITS, "--input", "diPart=4", "--report", "r.html"];
    let page = |options: &[&str]| {
        command::optimize(folder.path(), PROGRAM, &[&args[..], options].concat());
        fs::read_to_string(folder.path().join("r.html")).unwrap()
    };
    let with = page(&["--pareto", "5"]);
    let (_, figure) = with.split_once("Energy over time of the whole cycle").unwrap();
    let (figure, _) = figure.split_once("</svg>").unwrap();
    let parts = [
        "<polyline class=\"curve\"",
        "<polyline class=\"bound\"",
        "<title>today: ",
        "<title>retrofit: ",
        "time of the whole cycle (s)",
        "energy of the whole cycle (J)",
    ];
    for part in parts {
        assert!(figure.contains(part), "{part}: {figure}");
    }
    assert!(!page(&[]).contains("Energy over time of the whole cycle"));
}

#[test]
fn wrong_idle_states_are_refused() {
    let (folder, path) = command::module(PROGRAM);
    let config =
        command::written(&folder, "joulepath.toml", "[idle.off]\npower_w = -5\nwake_s = 1");
    let args = ["optimize", &path, "--robot", KNOWN_LIMITS, "--config", &config];
    let message = command::refused(&args, "[idle.NAME] with power_w, wake_s and wake_j");
    assert!(message.contains("[idle.off]: power_w = -5: give a number of W"), "{message}");
}

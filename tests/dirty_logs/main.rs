//! `predict` on dirty logs: the rows that stay have the torques of the clean log, and few rows go.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod battery;
#[path = "../command/mod.rs"]
mod command;

use std::collections::HashMap;
use std::fs;
use std::process::Output;

use battery::{Dirty, FORMS, LOSSES, Table, periodic, program};
use command::{joulepath, refused, rows, stderr, stdout, written};
use tempfile::TempDir;

/// The seven joints of a fixture, with friction.
fn seven(folder: &TempDir) -> String {
    let arm = fs::canonicalize("fixtures/dynamics/seven.toml").unwrap();
    let text = format!(
        "extends = \"{}\"\nname = \"seven\"\n[friction]\ncoulomb = [4, 4, 3, 2, 1, 1, 0.5]\n\
         viscous = [3, 3, 2, 2, 1, 0.5, 0.5]\n",
        arm.display()
    );
    written(folder, "seven.toml", text)
}

/// A clean log, and what a robot predicts for it.
struct Clean {
    folder: TempDir,
    robot: String,
    log: Table,
    /// The torques by the bits of the time.
    torques: HashMap<u64, Vec<f64>>,
    /// Root mean square of each joint's torque \[Nm\].
    rms: Vec<f64>,
}

impl Clean {
    fn new(robot: fn(&TempDir) -> String, log: Table) -> Clean {
        let folder = tempfile::tempdir().unwrap();
        let robot = robot(&folder);
        let (torques, rms) = (HashMap::new(), Vec::new());
        let mut clean = Clean { folder, robot, log, torques, rms };
        let predicted = Clean::torques(&clean.predicted(&clean.log.plain()));
        assert_eq!(predicted.len(), clean.log.rows.len());
        let mean = |joint: usize| {
            let squares = predicted.iter().map(|(_, tau)| tau[joint].powi(2));
            (squares.sum::<f64>() / predicted.len() as f64).sqrt()
        };
        clean.rms = (0..predicted[0].1.len()).map(mean).collect();
        clean.torques = predicted.into_iter().collect();
        clean
    }

    fn predicted(&self, log: &[u8]) -> Output {
        let path = written(&self.folder, "log.csv", log);
        let output = joulepath(&["predict", "--robot", &self.robot, "--log", &path]);
        assert!(output.status.success(), "{}", stderr(&output));
        output
    }

    /// Bits of the time and torques of each row of a prediction.
    fn torques(output: &Output) -> Vec<(u64, Vec<f64>)> {
        let of = |row: Vec<f64>| (row[0].to_bits(), row[1..row.len() - 2].to_vec());
        rows(&stdout(output)).into_iter().map(of).collect()
    }

    /// What is wrong with the prediction of a dirty log, within the tolerance.
    fn misses(&self, dirty: &Dirty, tolerance: &Tolerance) -> Option<String> {
        let log = (dirty.bytes)(&self.log);
        let output = self.predicted(&log);
        let predicted = Self::torques(&output);
        let mut off = Vec::new();
        for (time, tau) in &predicted {
            let Some(clean) = self.torques.get(time) else {
                return Some(format!("a row at {} s, which is not there", f64::from_bits(*time)));
            };
            for joint in 0..tau.len() {
                let rests = |beside: f64| {
                    (self.log.motion)(joint, f64::from_bits(*time) + beside)[1] == 0.0
                };
                if rests(-tolerance.verge) == rests(tolerance.verge) {
                    off.push((tau[joint] - clean[joint]).abs() / self.rms[joint]);
                }
            }
        }
        let worst = off.into_iter().fold(0.0, f64::max);
        let gone = self.torques.len() - predicted.len();
        let given = String::from_utf8_lossy(&log).lines().count() - 1;
        let is_silent =
            dirty.lost > 0 && predicted.len() < given && !stderr(&output).contains("left out");
        let fails = worst > tolerance.off
            || !(dirty.lost..=dirty.lost + tolerance.beside).contains(&gone)
            || is_silent;
        fails.then(|| {
            let said = stderr(&output);
            format!("{}: {gone} rows are gone, torques are {worst:.4} off; {said}", dirty.name)
        })
    }

    /// Checks dirty versions of the log.
    fn check<'a>(&self, all: impl IntoIterator<Item = &'a Dirty>, tolerance: &Tolerance) {
        let misses = |dirty: &Dirty| self.misses(dirty, tolerance);
        let misses: Vec<String> = all.into_iter().filter_map(misses).collect();
        assert!(misses.is_empty(), "{}", misses.join("\n"));
    }
}

/// What may change in the rows that are not lost.
struct Tolerance {
    /// Largest disagreement, as a share of a joint's RMS torque.
    off: f64,
    /// Time before and after the beginning and the end of a joint's motion in which it is not
    /// compared \[s\]: within the window of its derivatives, there may be Coulomb friction or not.
    verge: f64,
    /// Rows that may be left out beside the lost ones.
    beside: usize,
}

const OF_POSITIONS: Tolerance = Tolerance { off: 0.01, verge: 0.004, beside: 8 };
/// With rates and accelerations the rows are independent.
const OF_RATES: Tolerance = Tolerance { off: 0.0, verge: 0.0, beside: 0 };

#[test]
fn rows_of_a_periodic_motion_stay_as_they_are() {
    let log = Table::new([6, 1, 750], 125.0, periodic);
    Clean::new(|_| "IRB1600-10/1.45".into(), log).check(LOSSES, &OF_POSITIONS);
}

#[test]
fn rows_of_a_program_stay_as_they_are() {
    Clean::new(seven, Table::new([7, 1, 1000], 1000.0, program)).check(LOSSES, &OF_POSITIONS);
}

#[test]
fn rows_with_rates_are_independent() {
    let log = Table::new([7, 3, 400], 125.0, periodic);
    Clean::new(seven, log).check(FORMS.iter().chain(LOSSES), &OF_RATES);
}

/// States in any order, one of which differs from the others in one joint, are no spikes.
#[test]
fn states_without_a_motion_are_all_used() {
    let folder = tempfile::tempdir().unwrap();
    let mut log = Table::new([7, 3, 40], 125.0, |joint, _| [0.2 * joint as f64, 0.0, 0.0]);
    for (joint, row) in log.rows.iter_mut().skip(7).take(7).enumerate() {
        row[1 + joint] = "1.5".into();
    }
    let path = written(&folder, "states.csv", log.plain());
    let output = joulepath(&["predict", "--robot", &seven(&folder), "--log", &path]);
    assert_eq!(rows(&stdout(&output)).len(), 40, "{}", stderr(&output));
}

#[test]
fn ambiguous_numbers_are_refused_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let log = Table::new([7, 3, 40], 125.0, periodic).cells(|cell| cell.replace('.', ","));
    let robot = seven(&folder);
    let refuse = |text: String, way_out: &str| {
        let path = written(&folder, "log.csv", text);
        refused(&["predict", "--robot", &robot, "--log", &path, "-q"], way_out);
    };
    refuse(log.text(","), "write decimal points");
    // 1.250 may be a thousand, as the other columns have decimal commas.
    let mut grouped = log;
    grouped.header.push("power".into());
    grouped.rows.iter_mut().for_each(|row| row.push("1.250".into()));
    refuse(grouped.text(";"), "may be decimal or group the digits");
}

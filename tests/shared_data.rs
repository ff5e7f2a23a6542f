//! Comparison with targets and joints of real controllers. The measurements are not part of the
//! crate; without them these tests print a note, and fail in CI.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
#![expect(clippy::print_stderr, reason = "tests report figures and what they skip")]

#[path = "shared_data/controller_runs.rs"]
mod controller_runs;
#[path = "shared_data/diagnosis.rs"]
mod diagnosis;
#[path = "shared_data/injected.rs"]
mod injected;
#[path = "support/measurements.rs"]
mod measurements;
#[path = "support/real_logs.rs"]
mod real_logs;
mod support;

use joulepath::arm::kinematics::{Conf, conf_of, fk, ik_all, ik_conf};
use joulepath::arm::robot::{find, from_toml, import_urdf};
use measurements::shared;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

/// Median distance of the forward kinematics from the target \[m\]: the nominal
/// geometry on the virtual controller, a calibrated arm in reality.
const VIRTUAL_MEDIAN: f64 = 0.05e-3;
const REAL_MEDIAN: f64 = 0.15e-3;
/// Largest difference of a logged joint from the inverse kinematics \[rad\].
const JOINT: f64 = 1e-3;

fn pose(trans_mm: [f64; 3], wxyz: [f64; 4]) -> Isometry3<f64> {
    let [w, x, y, z] = wxyz;
    Isometry3::from_parts(
        Translation3::from(Vector3::from(trans_mm) * 1e-3),
        UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
    )
}

struct Row {
    real: bool,
    target: Isometry3<f64>,
    conf: Conf,
    joints: [f64; 6],
}

fn rows(text: &str) -> Vec<Row> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |i: usize| cells[i].parse::<f64>().unwrap();
            let cf = |i: usize| number(i) as i32;
            Row {
                real: cells[0] == "real",
                target: pose(
                    [number(5), number(6), number(7)],
                    [number(8), number(9), number(10), number(11)],
                ),
                conf: Conf { cf1: cf(12), cf4: cf(13), cf6: cf(14), cfx: cf(15) },
                joints: std::array::from_fn(|i| number(16 + i).to_radians()),
            }
        })
        .collect()
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn logged_joints_of_an_irb6640_agree_with_the_kinematics() {
    let Some(text) = shared("pairs/irb6640_180_255_controller_fine.csv") else { return };
    let model = find("IRB6640-180/2.55").unwrap();
    // The tool of all logged programs.
    let tool = pose([75.0, 0.0, 493.301_270_19], [0.965_925_8, 0.0, 0.258_819_0, 0.0]);
    let rows = rows(&text);
    assert!(rows.len() > 100);

    let miss = |row: &Row| {
        (fk(&model, &row.joints) * tool).translation.vector - row.target.translation.vector
    };
    let misses =
        |real: bool| rows.iter().filter(|r| r.real == real).map(|r| miss(r).norm()).collect();
    let (virtual_median, real_median) = (median(misses(false)), median(misses(true)));
    eprintln!("median: virtual {virtual_median:.2e} m, real {real_median:.2e} m");
    assert!(virtual_median <= VIRTUAL_MEDIAN && real_median <= REAL_MEDIAN);

    let mut largest = 0.0_f64;
    for row in &rows {
        let found = ik_conf(&model, &(row.target * tool.inverse()), row.conf).unwrap();
        let off = found.iter().zip(&row.joints).map(|(a, b)| (a - b).abs());
        largest = off.fold(largest, f64::max);
    }
    let on_edge = rows.iter().filter(|row| conf_of(&model, &row.joints) != row.conf).count();
    eprintln!(
        "largest joint difference: {largest:.2e} rad on {} rows, {on_edge} of them with an angle \
         at the edge of a quadrant",
        rows.len()
    );
    assert!(largest <= JOINT);
}

#[test]
fn robotstudio_targets_of_an_irb1600_are_reached() {
    let Some(text) = shared("pairs/irb1600_145_robotstudio_targets.json") else { return };
    let model = find("IRB1600-10/1.45").unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    for target in document["targets"].as_array().unwrap() {
        let goal = pose(
            numbers(&target["trans_mm"]).try_into().unwrap(),
            numbers(&target["rot_wxyz"]).try_into().unwrap(),
        );
        let cf: Vec<i32> = numbers(&target["conf"]).iter().map(|&x| x as i32).collect();
        let conf = Conf { cf1: cf[0], cf4: cf[1], cf6: cf[2], cfx: cf[3] };
        let q = ik_conf(&model, &goal, conf).unwrap();
        let miss = fk(&model, &q).translation.vector - goal.translation.vector;
        assert!(miss.norm() < 1e-6, "{}: {miss}", target["name"]);
        if target["name"] != "Home" {
            // The home position has joints at exactly 0: both quarters next to it are correct.
            assert_eq!(conf_of(&model, &q), conf, "{}", target["name"]);
        }
    }
}

#[test]
fn single_pairs_of_targets_and_joints_agree_with_the_kinematics() {
    let Some(text) = shared("pairs/single_pairs.json") else { return };
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    for pair in document["pairs"].as_array().unwrap() {
        // The arm of the IRB1600 is the same for every payload.
        let name = pair["robot"].as_str().unwrap().replace("IRB1600-x", "IRB1600-10");
        let joints: [f64; 6] = numbers(&pair["joints_deg"]).try_into().unwrap();
        let target = pose(
            numbers(&pair["trans_mm"]).try_into().unwrap(),
            numbers(&pair["rot_wxyz"]).try_into().unwrap(),
        );
        let found = fk(&find(&name).unwrap(), &joints.map(f64::to_radians));
        let miss = (found.translation.vector - target.translation.vector).norm();
        eprintln!("{name}: {miss:.1e} m");
        assert!(miss < 1e-5 && found.rotation.angle_to(&target.rotation) < 1e-5, "{name}: {miss}");
    }
}

#[test]
fn robots_of_published_logs_are_read() {
    for (path, joints) in [
        ("tx40/tx40_mdh_modified.urdf", 6),
        ("ur10_unisa/ur10_cb3_mdh_dummy_inertia.urdf", 6),
        ("ur10_unisa/panda_mdh_dummy_inertia.urdf", 7),
    ] {
        let Some(text) = shared(path) else { return };
        let model = from_toml(path, &import_urdf(path, &text).unwrap()).unwrap();
        assert_eq!((model.dof, model.links.len()), (joints, joints), "{path}");
        if joints == 6 {
            let q = [0.3, -0.8, 0.9, 0.4, 0.7, -0.2];
            let pose = fk(&model, &q);
            let same = |found: &[f64; 6]| found.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(ik_all(&model, &pose).unwrap().iter().any(same), "{path}");
        }
    }
}

//! `place` through the binary: what it promises is what `simulate` says, nothing accepted is beyond a
//! limit, and wrong requests have a way out.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::{IRB1600 as ROBOT, number, parsed, refused, run_in};
use joulepath::arm::kinematics::{Body, KeepOut, Obstacle};
use joulepath::arm::robot::find;
use nalgebra::{Isometry3, Point3, Vector3};
use serde_json::Value;

/// A fixture on a table, visited in lines between joint movements. The table can be nearer.
const PROGRAM: &str = "MODULE M\n\
    PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[10,0,60],[1,0,0,0],0,0,0]];\n\
    PERS wobjdata wobjTable:=[FALSE,TRUE,\"\",[[900,300,200],[1,0,0,0]],[[0,50,0],[1,0,0,0]]];\n\
    PERS wobjdata wobjSet:=[FALSE,TRUE,\"\",[[900,300,200],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
    PERS wobjdata wobjUnit:=[FALSE,FALSE,\"STN1\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
    PERS wobjdata wobjUnused:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
    CONST jointtarget jHome:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pIn:=[[0,0,150],[0,0,1,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pAt:=[[0,0,20],[0,0,1,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    PROC main()\n\
    MoveAbsJ jHome,v1000,fine,tGrip;\n\
    wobjSet.uframe.trans.x:=900;\n\
    MoveJ pIn,v1000,fine,tGrip\\WObj:=wobjTable;\n\
    MoveL pAt,v500,fine,tGrip\\WObj:=wobjTable;\n\
    WaitTime 0.5;\n\
    MoveL pIn,v500,fine,tGrip\\WObj:=wobjTable;\n\
    MoveAbsJ jHome,v1000,fine,tGrip;\n\
    ENDPROC\n\
    ENDMODULE\n";
const MOVE: &str = "wobjTable:x=-150..100,y=-150..150,rz=-40..40";
/// Rounding of a result in JSON, J and s.
const ROUNDING: f64 = 1e-9;
/// Rounding of a distance, m.
const DISTANCE: f64 = 1e-6;
/// A box beside the way, m.
const BOX: [[f64; 3]; 2] = [[0.55, 0.05, -0.2], [0.75, 0.15, 0.5]];
const TOOL: [f64; 3] = [0.0, 0.0, 0.15];

fn folder(config: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    fs::write(folder.path().join("in/m.mod"), PROGRAM).unwrap();
    fs::write(folder.path().join("joulepath.toml"), config).unwrap();
    folder
}

fn place(folder: &Path, options: &[&str]) -> Value {
    let fixed = ["place", "in", "--robot", ROBOT, "--quiet", "--format", "json"];
    parsed(&run_in(folder, &[&fixed[..], options].concat()))
}

fn simulate(folder: &Path, program: &str, robot: &str) -> Value {
    let args = ["simulate", program, "--robot", robot, "--quiet", "--format", "json"];
    parsed(&run_in(folder, &args))
}

#[test]
fn the_written_placement_saves_what_was_promised() {
    let folder = folder("");
    let options = ["--move", MOVE, "--candidates", "200", "--out", "out", "--report", "r.html"];
    let result = place(folder.path(), &options);
    let best = &result["best"][0];
    let now = simulate(folder.path(), "out", ROBOT);
    for figure in ["energy_j", "motion_energy_j", "cycle_s"] {
        assert!(
            (number(&now, &format!("/{figure}")) - best[figure].as_f64().unwrap()).abs() < ROUNDING
        );
    }
    let before = number(&simulate(folder.path(), "in", ROBOT), "/energy_j");
    let saving = 100.0 * (1.0 - number(&now, "/energy_j") / before);
    assert!((saving - best["saving_percent"].as_f64().unwrap()).abs() < ROUNDING);
    assert!(saving > 1.0, "the nearer table saves {saving} %");
    assert!(number(&now, "/cycle_s") <= number(&result, "/original/cycle_s") + ROUNDING);
    let [low, high] = [0, 1].map(|i| best["saving_interval_percent"][i].as_f64().unwrap());
    assert!(low < saving && saving < high, "{low} to {high}");
    // Only the numbers of the frame have changed.
    let text = fs::read_to_string(folder.path().join("out/m.mod")).unwrap();
    let changed: Vec<(&str, &str)> =
        PROGRAM.lines().zip(text.lines()).filter(|(a, b)| a != b).collect();
    assert_eq!(changed.len(), 1);
    assert!(changed[0].1.starts_with("PERS wobjdata wobjTable:=[FALSE,TRUE,\"\",[["));
    assert!(changed[0].1.ends_with(",[[0,50,0],[1,0,0,0]]];"));
    let page = fs::read_to_string(folder.path().join("r.html")).unwrap();
    assert!(page.contains("class=\"cell\"") && page.contains("chosen"));
}

#[test]
fn a_moved_base_is_a_robot_that_stands_elsewhere() {
    let folder = folder("");
    let options = ["--move", "base:x=0..200,z=-100..100,rz=-20..20", "--candidates", "100"];
    let result = place(folder.path(), &[&options[..], &["--out", "out"]].concat());
    let now = simulate(folder.path(), "out", "out/robot.toml");
    let promised = number(&result, "/best/0/energy_j");
    assert!((number(&now, "/energy_j") - promised).abs() < promised * 1e-9);
    let text = fs::read_to_string(folder.path().join("out/m.mod")).unwrap();
    assert_eq!(text, PROGRAM, "the program itself stays");
}

/// Accepted placements are simulated again, and the motion is looked at with distances of its own.
#[test]
fn nothing_accepted_is_in_a_keep_out_or_late() {
    let config = format!("[[keep_out]]\nbox = {BOX:?}\n");
    let folder = folder(&config);
    let options = ["--move", MOVE, "--candidates", "100", "--csv", "all.csv"];
    let result = place(folder.path(), &options);
    let refused = number(&result, "/candidates/refused/keep_out");
    assert!(refused > 0.0, "the box is in the way of some placements: {}", result["candidates"]);
    let table = fs::read_to_string(folder.path().join("all.csv")).unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    assert_eq!(rows.len() as f64, number(&result, "/candidates/accepted"));
    let model = find(ROBOT).unwrap();
    let corners = BOX.map(Point3::from);
    let obstacle = Obstacle::KeepOut(KeepOut::between(corners[0], corners[1]));
    let body = Body::new(&model, Vector3::from(TOOL), &[obstacle]);
    let today = number(&result, "/original/cycle_s");
    for row in rows.iter().step_by(7) {
        let (x, y, rz) = (row[0], row[1], row[5].to_radians());
        let turn = Isometry3::rotation(Vector3::z() * rz);
        // The object's frame stands at (900, 350, 200).
        let object = Isometry3::translation(900.0 + x, 350.0 + y, 200.0) * turn;
        let user = object * Isometry3::translation(0.0, 50.0, 0.0).inverse();
        let frame = user.translation.vector;
        let [w, k] = [user.rotation.w, user.rotation.k];
        let pose = format!("[[{},{},{}],[{w},0,0,{k}]]", frame.x, frame.y, frame.z);
        let text = PROGRAM.replacen("[[900,300,200],[1,0,0,0]]", &pose, 1);
        fs::write(folder.path().join("moved.mod"), text).unwrap();
        run_in(
            folder.path(),
            &["simulate", "moved.mod", "--robot", ROBOT, "--quiet", "--trajectory", "t.csv"],
        );
        let motion = fs::read_to_string(folder.path().join("t.csv")).unwrap();
        let mut last = 0.0;
        for line in motion.lines().skip(1) {
            let values: Vec<f64> = line.split(',').take(7).map(|x| x.parse().unwrap()).collect();
            assert!(body.margins(&values[1..])[0] > -DISTANCE, "{x} {y} {rz}");
            last = values[0];
        }
        assert!(last <= today + DISTANCE, "{last} s");
        // Numbers in the text are rounded, so the durations are nearly the same.
        assert!((last - row[6]).abs() < 1e-3, "{last} is not {}", row[6]);
    }
}

#[test]
fn unusable_requests_have_a_way_out() {
    let folder = folder("");
    let program = folder.path().join("in");
    let program = program.to_str().unwrap();
    for (asked, way_out) in [
        ("wobjTabel:x=0..10", "did you mean wobjTable?"),
        ("wobjTable:x=10", "no LOW..HIGH"),
        ("wobj0:x=0..10", "move base"),
        ("tGrip:x=0..10", "give rz alone"),
        ("wobjSet:x=0..10", "m.mod:4: the program writes it"),
        ("wobjUnit:x=0..10", "a mechanical unit moves"),
        ("wobjUnused:x=0..10", "no movement of the cycle depends on"),
        ("tGrip+wobjTable:rz=0..10", "separate --move"),
        ("wobjTable+wobjTable:x=0..10", "named twice"),
    ] {
        refused(&["place", program, "--robot", ROBOT, "--move", asked], way_out);
    }
}

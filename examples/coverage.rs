//! How often the 90 % intervals of estimated robots hold what is known of robots with published
//! dynamics: `cargo run --release --example coverage > docs/coverage.md`.
//!
//! Of each robot only the geometry, the limits, the total mass and the payload are given to the
//! estimate. Poses, motions and programs are drawn with a fixed seed.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::fmt::Write as _;
use std::path::Path;

use joulepath::dynamics::{Data, Load, friction, gravity, rigid_bodies};
use joulepath::effects::{drawn, with_estimates};
use joulepath::energy::account;
use joulepath::energy::plausible::{DRAWS, Interval, plausibility};
use joulepath::kinematics::limits_ok;
use joulepath::motion::{Options, simulate};
use joulepath::retrofit::{Settings, Source, read_program, retrofit};
use joulepath::robot::prior::Spread;
use joulepath::robot::{Model, find, from_toml, load, to_toml};
use joulepath::text::{FileId, SourceFile};
use rayon::prelude::*;

/// Poses, motions and programs of a robot.
const CASES: usize = 40;
/// Torques below this share of the largest of the joint are not compared.
const SMALL: f64 = 0.05;
/// Speeds and accelerations of motions, over the robot's limits, at most.
const LIVELY: f64 = 0.8;
/// Movements of a program.
const MOVES: usize = 6;

/// What is published of a robot.
struct Robot {
    name: &'static str,
    model: Model,
    friction: bool,
    /// Motors, drive and brakes: energies can be told.
    power: bool,
}

fn main() {
    let mut robots = vec![Robot {
        name: "IRB1600-10/1.45",
        model: find("IRB1600-10/1.45").unwrap(),
        friction: true,
        power: true,
    }];
    for (name, file, friction) in [
        ("UR10", "ur10", true),
        ("UR5e", "ur5e", false),
        ("Panda", "panda", false),
        ("TX40", "tx40", true),
    ] {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("fixtures/coverage/{file}.toml"));
        if let Ok(model) = load(path.to_str().unwrap()) {
            robots.push(Robot { name, model, friction, power: false });
        }
    }
    println!("# Coverage of the estimates\n");
    println!("Written by `cargo run --release --example coverage > docs/coverage.md`.\n");
    println!(
        "Of each robot below somebody published dynamics. Geometry, limits, total mass and payload alone \
         were given to the estimate; the table has the share of cases in which the 90 % interval over \
         plausible robots holds the published robot's value. {CASES} poses and motions a robot; torques \
         count by joint, those below {:.0} % of the joint's largest are left out.\n",
        100.0 * SMALL
    );
    println!(
        "| robot | gravity torque | torque of acceleration | friction torque | motion energy | saving |"
    );
    println!("|---|---|---|---|---|---|");
    for robot in &robots {
        let unknown = unknown(&robot.model, robot.name);
        let gravity = torques(&robot.model, &unknown, Kind::Gravity);
        let inertial = torques(&robot.model, &unknown, Kind::Acceleration);
        let rubbing = robot.friction.then(|| torques(&robot.model, &unknown, Kind::Friction));
        let energies = robot.power.then(|| energies(&robot.model, &unknown));
        println!(
            "| {} | {} | {} | {} | {} | {} |",
            robot.name,
            rate(Some(&gravity)),
            rate(Some(&inertial)),
            rate(rubbing.as_ref()),
            rate(energies.as_ref().map(|(motion, _)| motion)),
            rate(energies.as_ref().map(|(_, saving)| saving)),
        );
    }
    println!("\n## Published powers\n");
    println!(
        "Mean powers that ABB publishes, of the path E1 to E4 of the ISO cube at full speed and load and of \
         rest with open brakes; where the rule of the power at rest follows from the robot itself, the robot \
         is left out of it.\n"
    );
    println!("| robot | motion | published, W | 90 % interval, W | held |\n|---|---|---|---|---|");
    let mut held = Vec::new();
    for entry in &PUBLISHED {
        let (name, motion, watts) = entry;
        let motion = match motion {
            Motion::Cube(speed) => format!("ISO cube, {speed}"),
            Motion::Rest => "rest, brakes open".to_owned(),
        };
        let Some((interval, holds)) = published(entry) else {
            println!("| {name} | {motion} | {watts:.0} | does not reach it | not counted |");
            continue;
        };
        held.push(holds);
        let answer = if holds { "yes" } else { "no" };
        println!(
            "| {name} | {motion} | {watts:.0} | {:.0} to {:.0} | {answer} |",
            interval.low, interval.high
        );
    }
    println!("\nHeld: {}. Each robot counts with all its figures.", rate(Some(&held)));
}

/// Mean power of the path on the ISO cube with full load: robot, programmed speed, W; and of rest with
/// open brakes. Of ABB's data sheets and product specifications, but for those of the IRB2400 and the
/// IRB6640, which are from memory of them.
type Published = (&'static str, Motion, f64);

#[derive(Clone, Copy, PartialEq)]
enum Motion {
    Cube(&'static str),
    Rest,
}

const PUBLISHED: [Published; 23] = [
    ("IRB120-3/0.58", Motion::Cube("vmax"), 240.0),
    ("IRB140-6/0.81", Motion::Cube("vmax"), 440.0),
    ("IRB140-6/0.81", Motion::Cube("v1000"), 390.0),
    ("IRB140-6/0.81", Motion::Cube("v500"), 360.0),
    ("IRB140-6/0.81", Motion::Cube("v100"), 340.0),
    ("IRB1200-5/0.9", Motion::Cube("vmax"), 390.0),
    ("IRB1200-7/0.7", Motion::Cube("vmax"), 390.0),
    ("IRB1520ID-4/1.5", Motion::Cube("vmax"), 750.0),
    ("IRB1520ID-4/1.5", Motion::Rest, 233.0),
    ("IRB1600-10/1.2", Motion::Cube("vmax"), 580.0),
    ("IRB1600-10/1.45", Motion::Cube("vmax"), 580.0),
    ("IRB1600-6/1.2", Motion::Cube("vmax"), 580.0),
    ("IRB1600-6/1.45", Motion::Cube("vmax"), 580.0),
    ("IRB1600-8/1.45", Motion::Cube("vmax"), 580.0),
    ("IRB2400", Motion::Cube("vmax"), 670.0),
    ("IRB2400-12/1.55", Motion::Cube("vmax"), 670.0),
    ("IRB6640-180/2.55", Motion::Cube("vmax"), 2700.0),
    ("IRB6640-185/2.8", Motion::Cube("vmax"), 2700.0),
    ("IRB6640-235/2.55", Motion::Cube("vmax"), 2700.0),
    ("IRB6650S-125/3.5", Motion::Cube("vmax"), 2400.0),
    ("IRB6650S-200/3.0", Motion::Cube("vmax"), 2400.0),
    ("IRB6650S-90/3.9", Motion::Cube("vmax"), 2400.0),
    ("IRB140-6/0.81", Motion::Rest, 335.0),
];
/// Edge of the cube by the reach up to which it is used \[m\]: known of the IRB140 and the IRB1520ID, of the
/// others the next of ISO 9283's sizes that fits.
const EDGES: [(f64, f64); 4] = [(0.85, 0.25), (1.6, 0.4), (2.2, 0.63), (f64::INFINITY, 1.0)];
/// Distance of the cube's centre from axis 1 over the reach; heights over the reach and tilts of the flange
/// (0 up, 180 down, degrees) that are tried in turn: data sheets do not say.
const FORWARDS: f64 = 0.57;
const HEIGHTS: [f64; 4] = [0.45, 0.3, 0.15, 0.6];
const TILTS: [f64; 4] = [90.0, 120.0, 150.0, 180.0];
/// Share of the cube's edge from which the rectangle of ISO 9283 is.
const OF_EDGE: f64 = 0.8;
/// The rule of the power at rest: W at 100 kg, and the power of the mass.
const REST: (f64, f64) = (240.0, 0.15);

/// Level of that rule without a robot, over the one with it.
fn left_out(name: &str) -> f64 {
    let at_rest: Vec<(f64, &str)> = PUBLISHED
        .iter()
        .filter(|(_, motion, _)| *motion == Motion::Rest)
        .map(|(name, _, w)| {
            let mass = table(name, "mass");
            (w / (mass / 100.0).powf(REST.1), *name)
        })
        .collect();
    let others: Vec<f64> =
        at_rest.iter().filter(|(_, of)| *of != name).map(|(level, _)| level.ln()).collect();
    if others.len() == at_rest.len() {
        return 1.0;
    }
    (others.iter().sum::<f64>() / others.len() as f64).exp() / REST.0
}

fn table(name: &str, key: &str) -> f64 {
    let tables: toml::Table =
        toml::from_str(include_str!("../src/robot/prior/robots.toml")).unwrap();
    tables[name][key].as_float().unwrap()
}

/// Whether the interval of a mean power holds the published one, with the interval; `None` where the robot
/// does not reach the cube.
fn published((name, motion, watts): &Published) -> Option<(Interval, bool)> {
    let mut model = with_estimates(find(name).unwrap()).unwrap();
    model.drive.base_w *= left_out(name);
    let simulated = |text: &str| {
        let (program, entry) = read_program(&[source(text)], "main").unwrap();
        simulate(&program, entry, &model, &Options::default())
    };
    let simulation = match motion {
        Motion::Rest => simulated(REST_PROGRAM),
        Motion::Cube(speed) => {
            let poses =
                HEIGHTS.iter().flat_map(|height| TILTS.iter().map(move |tilt| (height, tilt)));
            let mut cubes =
                poses.map(|(height, tilt)| simulated(&iso_cube(name, speed, *height, *tilt)));
            cubes.find(|simulation| simulation.unresolved.is_empty())?
        }
    };
    let all = plausibility(&model, &simulation, &account(&model, &simulation)).unwrap().energy_j;
    let per_s = |j: f64| j / simulation.cycle_s;
    let power = Interval { median: per_s(all.median), low: per_s(all.low), high: per_s(all.high) };
    Some((power, (power.low..=power.high).contains(watts)))
}

/// Open brakes at rest.
const REST_PROGRAM: &str = "MODULE Rest
  CONST jointtarget j:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ j,v100,fine,tool0;
    WaitTime 1000;
  ENDPROC
ENDMODULE
";

/// The rectangle E1 to E4 of the cube at full speed, its first corner reached before.
fn iso_cube(name: &str, speed: &str, height: f64, tilt: f64) -> String {
    let [payload, reach] = ["payload", "reach"].map(|key| table(name, key));
    let edge = EDGES.iter().find(|(most, _)| reach <= *most).map_or(1.0, |(_, edge)| *edge);
    let centre = [FORWARDS * reach, 0.0, height * reach];
    let (w, y_axis) = ((0.5 * tilt.to_radians()).cos(), (0.5 * tilt.to_radians()).sin());
    let half = 0.5 * OF_EDGE * edge;
    let mut text = format!(
        "MODULE Cube\n  PERS tooldata tLoad:=[TRUE,[[0,0,0],[1,0,0,0]],[{payload},[0,0,100],[1,0,0,0],0,0,0]];\n"
    );
    let mut moves = String::new();
    // A diagonal plane: x and z change together, y by itself.
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    for (i, (along, y)) in corners.into_iter().enumerate() {
        let _ = writeln!(
            text,
            "  CONST robtarget e{i}:=[[{},{},{}],[{w:.8},0,{y_axis:.8},0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
            1e3 * (centre[0] + along * half),
            1e3 * (centre[1] + y * half),
            1e3 * (centre[2] + along * half)
        );
        let _ = writeln!(moves, "      MoveL e{i},{speed},fine,tLoad;");
    }
    text + "  PROC main()\n    ConfL\\Off;\n    ConfJ\\Off;\n    MoveJ e3,v1000,fine,tLoad;\n    FOR i FROM 1 TO 20 DO\n"
        + &moves
        + "    ENDFOR\n  ENDPROC\nENDMODULE\n"
}

fn rate(held: Option<&Vec<bool>>) -> String {
    let Some(held) = held.filter(|held| !held.is_empty()) else { return "not published".into() };
    let count = held.iter().filter(|held| **held).count();
    format!("{:.0} % of {}", 100.0 * count as f64 / held.len() as f64, held.len())
}

/// Tables of a robot file that are left out.
const DYNAMICS: [&str; 9] =
    ["link", "arm_load", "friction", "motors", "wrist", "drive", "brakes", "standstill", "effects"];

/// The robot without its dynamics, estimated.
fn unknown(model: &Model, name: &str) -> Model {
    let mut table: toml::Table = toml::from_str(&to_toml(model)).unwrap();
    for key in DYNAMICS {
        table.remove(key);
    }
    let limits = table.get_mut("limits").and_then(toml::Value::as_table_mut).unwrap();
    limits.retain(|key, _| !key.starts_with("torque"));
    let text = toml::to_string(&table).unwrap();
    with_estimates(from_toml(name, &text).unwrap()).unwrap()
}

#[derive(Clone, Copy)]
enum Kind {
    Gravity,
    Acceleration,
    Friction,
}

/// Whether intervals hold the torques of random poses and motions.
fn torques(truth: &Model, unknown: &Model, kind: Kind) -> Vec<bool> {
    let of = |model: &Model, [q, qd, qdd]: &[Vec<f64>; 3]| -> Vec<f64> {
        let (mut data, load) = (Data::new(), Load::none());
        let still = gravity(model, &mut data, &load, q);
        let all = match kind {
            Kind::Gravity => still,
            Kind::Acceleration => {
                let moved = rigid_bodies(model, &mut data, &load, q, &[], qdd);
                let still = rigid_bodies(model, &mut data, &load, q, &[], &[]);
                std::array::from_fn(|j| moved[j] - still[j])
            }
            Kind::Friction => friction(model, qd, &still),
        };
        all[..model.dof].to_vec()
    };
    let states = states(truth);
    let truths: Vec<Vec<f64>> = states.iter().map(|state| of(truth, state)).collect();
    let spread = Spread::of(unknown);
    let draws = spread.draws(unknown, DRAWS).robots;
    let models: Vec<Model> = draws.iter().map(|robot| drawn(unknown, robot).unwrap()).collect();
    let mut held = Vec::new();
    for j in 0..truth.dof {
        let largest = truths.iter().map(|tau| tau[j].abs()).fold(0.0, f64::max);
        for (state, tau) in states.iter().zip(&truths) {
            if tau[j].abs() > SMALL * largest && largest > 1e-6 {
                let values: Vec<f64> = models.par_iter().map(|model| of(model, state)[j]).collect();
                let Interval { low, high, .. } = Interval::of(&values);
                held.push((low..=high).contains(&tau[j]));
            }
        }
    }
    held
}

/// Random poses with velocities and accelerations.
fn states(model: &Model) -> Vec<[Vec<f64>; 3]> {
    let mut random = fastrand::Rng::with_seed(1600);
    let speeds = model.limits.velocity.clone().unwrap();
    (0..CASES)
        .map(|_| {
            let q = pose(model, &mut random);
            let sign = |random: &mut fastrand::Rng| 2.0 * random.f64() - 1.0;
            let qd = speeds.iter().map(|v| LIVELY * v * sign(&mut random)).collect();
            let qdd = speeds.iter().map(|v| 4.0 * v * sign(&mut random)).collect();
            [q, qd, qdd]
        })
        .collect()
}

fn pose(model: &Model, random: &mut fastrand::Rng) -> Vec<f64> {
    loop {
        let q: Vec<f64> = model
            .limits
            .position
            .iter()
            .map(|[low, high]| {
                let (low, high) = (low.max(-2.5), high.min(2.5));
                low + (high - low) * random.f64()
            })
            .collect();
        if limits_ok(model, &q).is_ok() {
            return q;
        }
    }
}

/// Whether intervals hold the motion energy and the saving of random programs.
fn energies(truth: &Model, unknown: &Model) -> (Vec<bool>, Vec<bool>) {
    let mut random = fastrand::Rng::with_seed(1601);
    let programs: Vec<String> = (0..CASES).map(|_| program(truth, &mut random)).collect();
    let held: Vec<(bool, Option<bool>)> = programs
        .par_iter()
        .map(|text| {
            let files = [source(text)];
            let done = retrofit(&files, unknown, &Settings::default(), &|_, _| ()).unwrap();
            let holds = |Interval { low, high, .. }: Interval, x: f64| (low..=high).contains(&x);
            let (before, after) = (&done.before, &done.after);
            let plausible = plausibility(unknown, &before.0, &before.1).unwrap();
            let [was, is] =
                [&before.0, &after.0].map(|s| account(truth, s).total.motion_energy_j());
            let saving = done
                .uncertainty
                .filter(|_| done.optimized.motion_energy_j != done.original.motion_energy_j);
            let saved = saving.map(|all| holds(all.saving_percent[1], 100.0 * (was - is) / was));
            (holds(plausible.motion_energy_j, was), saved)
        })
        .collect();
    (
        held.iter().map(|(motion, _)| *motion).collect(),
        held.iter().filter_map(|(_, s)| *s).collect(),
    )
}

fn source(text: &str) -> Source {
    let file = SourceFile::new(FileId(0), "program.mod".to_owned(), text.as_bytes().to_vec());
    Source { relative: file.path.clone(), file }
}

/// Joint movements between random poses.
fn program(model: &Model, random: &mut fastrand::Rng) -> String {
    let mut text = String::from("MODULE Random\n");
    let mut moves = String::new();
    for k in 0..=MOVES {
        let q: Vec<String> =
            pose(model, random).iter().map(|x| format!("{:.3}", x.to_degrees())).collect();
        let _ = writeln!(
            text,
            "  CONST jointtarget j{k}:=[[{}],[9E9,9E9,9E9,9E9,9E9,9E9]];",
            q.join(",")
        );
        let speed = [500, 1000, 2000][random.usize(0..3)];
        let _ = writeln!(moves, "    MoveAbsJ j{k},v{speed},fine,tool0;");
    }
    text + "  PROC main()\n" + &moves + "  ENDPROC\nENDMODULE\n"
}

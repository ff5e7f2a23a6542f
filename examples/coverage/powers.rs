//! Powers published by ABB.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use joulepath::arm::effects::with_estimates;
use joulepath::arm::robot::prior::Spread;
use joulepath::arm::robot::{Model, find};
use joulepath::retime::energy::account;
use joulepath::retime::energy::plausible::{DRAWS, Interval, Robots, moments};
use joulepath::retime::motion::{Options, simulate};
use joulepath::tool::retrofit::read_program;

use super::{rate, source};

/// Robot, motion, power in W.
type Published = (&'static str, Motion, f64);

#[derive(Clone, Copy, PartialEq)]
enum Motion {
    /// The path E1 to E4 on the ISO cube at this speed with full load.
    Cube(&'static str),
    /// Rest with open brakes in the calibration position.
    Rest,
    /// Rest with engaged brakes.
    Engaged,
}

/// From ABB data sheets and product specifications that state the motion.
const STATED: [Published; 13] = [
    ("IRB120-3/0.58", Motion::Cube("vmax"), 240.0),
    ("IRB140-6/0.81", Motion::Cube("vmax"), 440.0),
    ("IRB140-6/0.81", Motion::Cube("v1000"), 390.0),
    ("IRB140-6/0.81", Motion::Cube("v500"), 360.0),
    ("IRB140-6/0.81", Motion::Cube("v100"), 340.0),
    ("IRB1520ID-4/1.5", Motion::Cube("vmax"), 750.0),
    ("IRB1520ID-4/1.5", Motion::Rest, 233.0),
    ("IRB1520ID-4/1.5", Motion::Engaged, 206.0),
    ("IRB1600-10/1.2", Motion::Cube("vmax"), 580.0),
    ("IRB1600-10/1.45", Motion::Cube("vmax"), 580.0),
    ("IRB1600-6/1.2", Motion::Cube("vmax"), 580.0),
    ("IRB1600-6/1.45", Motion::Cube("vmax"), 580.0),
    ("IRB1600-8/1.45", Motion::Cube("vmax"), 580.0),
];
/// From those that do not state a motion.
const UNSTATED: [Published; 5] = [
    ("IRB1200-5/0.9", Motion::Cube("vmax"), 390.0),
    ("IRB1200-7/0.7", Motion::Cube("vmax"), 390.0),
    ("IRB6650S-125/3.5", Motion::Cube("vmax"), 2400.0),
    ("IRB6650S-200/3.0", Motion::Cube("vmax"), 2400.0),
    ("IRB6650S-90/3.9", Motion::Cube("vmax"), 2400.0),
];
/// Powers at rest with open brakes that determine the rule \[W\]; the first one is unverified.
const AT_REST: [(&str, f64); 3] =
    [("IRB120-3/0.58", 173.0), ("IRB140-6/0.81", 335.0), ("IRB1520ID-4/1.5", 233.0)];

/// Unstated properties of a motion.
struct Open {
    /// Loads over the rated one.
    loads: &'static [f64],
    /// Accelerations, in standard deviations.
    accelerations: &'static [f64],
    /// Required number of reachable places of the cube.
    places: usize,
}

/// One motion for each figure.
const ONE: Open = Open { loads: &[1.0], accelerations: &[0.0], places: 1 };
/// With a spread of equally probable accelerations.
const SPREAD: Open =
    Open { accelerations: &[-1.28, -0.52, 0.0, 0.52, 1.28], places: usize::MAX, ..ONE };
/// With a spread of loads, too.
const SPREAD_WITH_LOAD: Open = Open { loads: &[1.0, 0.5, 0.0], ..SPREAD };

pub(crate) fn print() {
    println!("## Published powers\n");
    println!(
        "Mean powers of ABB's data sheets: of the path E1 to E4 of the ISO cube with full load, and of rest in \
         the calibration position. The power at rest follows from three robots; each of them is left out for \
         its own figures. The sheets of the IRB1200 and the IRB6650S give one power for all variants and say \
         neither motion nor load: the cube at full speed is assumed; that of the IRB6650S offers controllers \
         that take 20 % less, too. These two were separated from the others after their errors were known.\n\n\
         No sheet says where the cube is, and accelerations are assumed. The first interval is that of one \
         place, with full load: what `simulate` says. The second is over all places that the robot reaches \
         and over the spread of the accelerations ({ACCELERATION} of their logarithm), where the load is not \
         stated also over full, half and no load. It was added after the errors of the first were known.\n"
    );
    println!(
        "| robot | motion | published, W | one motion, W | held | spread of motions, W | held |\n\
         |---|---|---|---|---|---|---|"
    );
    let stated = by_robot(&STATED, &SPREAD);
    let unstated = by_robot(&UNSTATED, &SPREAD_WITH_LOAD);
    println!("\nRobots with all figures held:\n");
    for (i, motion) in ["one motion", "spread of motions"].into_iter().enumerate() {
        let [stated, unstated] = [&stated, &unstated]
            .map(|held| -> Vec<bool> { held.iter().map(|held| held[i]).collect() });
        println!(
            "- {motion}: {} where the motion is stated, {} where it is not, {} together.",
            rate(&stated),
            rate(&unstated),
            rate(&[stated.clone(), unstated.clone()].concat())
        );
    }
}

/// Prints the figures. For each robot, the result states whether all of its figures are covered
/// with one motion, and with a spread of motions.
fn by_robot(figures: &[Published], spread: &Open) -> Vec<[bool; 2]> {
    let mut held: BTreeMap<&str, [bool; 2]> = BTreeMap::new();
    for figure in figures {
        let (name, motion, watts) = figure;
        let motion = match motion {
            Motion::Cube(speed) => format!("ISO cube, {speed}"),
            Motion::Rest => "rest, brakes open".to_owned(),
            Motion::Engaged => "rest, brakes engaged".to_owned(),
        };
        print!("| {name} | {motion} | {watts:.0} |");
        let of_robot = held.entry(name).or_insert([true; 2]);
        for (open, of_robot) in [&ONE, spread].into_iter().zip(of_robot) {
            let Interval { low, high, .. } = Interval::from_values(&powers(figure, open));
            let holds = (low..=high).contains(watts);
            *of_robot &= holds;
            print!(" {low:.0} to {high:.0} | {} |", if holds { "yes" } else { "no" });
        }
        println!();
    }
    held.into_values().collect()
}

/// Edge of the cube by the largest reach \[m\]: published for IRB140 and IRB1520ID; otherwise the
/// next suitable size of ISO 9283.
const EDGES: [(f64, f64); 4] = [(0.85, 0.25), (1.6, 0.4), (2.2, 0.63), (f64::INFINITY, 1.0)];
/// Distance of the cube's centre from axis 1 over the reach; heights over the reach and tilts of
/// the flange (0 up, 180 down, degrees) that are tried: data sheets do not state them.
const FORWARDS: f64 = 0.57;
const HEIGHTS: [f64; 4] = [0.45, 0.3, 0.15, 0.6];
const TILTS: [f64; 4] = [90.0, 120.0, 150.0, 180.0];
/// Size of the ISO 9283 rectangle over the cube's edge.
const OF_EDGE: f64 = 0.8;
/// Rule of the power at rest: W at 100 kg, and exponent of the mass.
const REST: (f64, f64) = (240.0, 0.15);

/// Level of the rule fitted without a robot, over that with all robots.
fn left_out(name: &str) -> f64 {
    if AT_REST.iter().all(|(of, _)| *of != name) {
        return 1.0;
    }
    let others = AT_REST.iter().filter(|(of, _)| *of != name);
    let levels = others.map(|(of, w)| (w / (table(of, "mass") / 100.0).powf(REST.1)).ln());
    let levels: Vec<f64> = levels.collect();
    (levels.iter().sum::<f64>() / levels.len() as f64).exp() / REST.0
}

fn table(name: &str, key: &str) -> f64 {
    let tables: toml::Table =
        toml::from_str(include_str!("../../src/arm/robot/prior/robots.toml")).unwrap();
    tables[name][key].as_float().unwrap()
}

/// Standard deviation of the logarithm of an acceleration, in the mean squares: of the largest torques of
/// axes 1 to 3 over their rule (0.22, 0.17, 0.34) and of the share left to accelerate (0.18).
const ACCELERATION: f64 = 0.31;

/// Mean powers \[W\] of plausible robots in the motions possible for a figure.
fn powers((name, motion, _): &Published, open: &Open) -> Vec<f64> {
    let mut model = with_estimates(find(name).unwrap()).unwrap();
    model.drive.base_w *= left_out(name);
    match motion {
        Motion::Engaged => {
            let draws = Spread::new(&model).draws(&model, DRAWS).robots;
            draws.iter().map(|robot| robot.base_w).collect()
        }
        Motion::Rest => mean_powers(&model, REST_PROGRAM).unwrap(),
        Motion::Cube(speed) => {
            let models: Vec<Model> =
                open.accelerations.iter().map(|z| accelerated(&model, z * ACCELERATION)).collect();
            let places = HEIGHTS.iter().flat_map(|height| TILTS.map(|tilt| (*height, tilt)));
            let of_place = |place| -> Option<Vec<f64>> {
                let cubes = open.loads.iter().map(|load| iso_cube(name, speed, place, *load));
                let cubes: Vec<String> = cubes.collect();
                let pairs = cubes.iter().flat_map(|cube| models.iter().map(move |it| (it, cube)));
                let powers = pairs.map(|(model, cube)| mean_powers(model, cube));
                Some(powers.collect::<Option<Vec<_>>>()?.concat())
            };
            places.filter_map(of_place).take(open.places).flatten().collect()
        }
    }
}

/// The model with scaled accelerations.
fn accelerated(model: &Model, logarithm: f64) -> Model {
    let mut model = model.clone();
    let limits = [&mut model.limits.acceleration, &mut model.limits.jerk];
    for limit in limits.into_iter().flatten().flatten() {
        *limit *= logarithm.exp();
    }
    model
}

/// Mean powers of all plausible robots \[W\]; `None` if a target is out of reach.
fn mean_powers(model: &Model, text: &str) -> Option<Vec<f64>> {
    let (program, entry) = read_program(&[source(text)], "main").unwrap();
    let simulation = simulate(&program, entry, model, &Options::default());
    if !simulation.unresolved.is_empty() {
        return None;
    }
    let own = account(model, &simulation).total.energy_j();
    let changes = Robots::new(model)?.changes(model, &moments(model, &simulation));
    let of_robot = |energy_j: f64| (own + energy_j) / simulation.cycle_s;
    Some(changes.iter().map(|change| of_robot(change.energy_j())).collect())
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

/// The rectangle E1 to E4 of the cube at full speed, after a move to its first corner.
fn iso_cube(name: &str, speed: &str, (height, tilt): (f64, f64), load: f64) -> String {
    let [payload, reach] = ["payload", "reach"].map(|key| table(name, key));
    let payload = load * payload;
    let edge = EDGES.iter().find(|(most, _)| reach <= *most).map_or(1.0, |(_, edge)| *edge);
    let centre = [FORWARDS * reach, 0.0, height * reach];
    let (w, y_axis) = ((0.5 * tilt.to_radians()).cos(), (0.5 * tilt.to_radians()).sin());
    let half = 0.5 * OF_EDGE * edge;
    let mut text = format!(
        "MODULE Cube\n  PERS tooldata tLoad:=[TRUE,[[0,0,0],[1,0,0,0]],[{payload},[0,0,100],[1,0,0,0],0,0,0]];\n"
    );
    let mut moves = String::new();
    // A diagonal plane: x and z change together, y independently.
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

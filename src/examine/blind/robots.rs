//! Robots of the examination: arms of the catalogue, with generated dynamics where these are
//! missing or incomplete.

use nalgebra::{Matrix3, Vector3};

use super::mechanics::Joints;
use super::plant::Plant;
use super::random::Random;
use super::workspace::Workspace;
use crate::arm::robot::{self, Link, MAX_DOF, Model, Motors, Wrist};

/// Robots of the cases: serial arms with six joints of different size.
const ARMS: [&str; 10] = [
    "IRB1600-10/1.45",
    "IRB1600-6/1.2",
    "IRB120-3/0.58",
    "IRB1200-5/0.9",
    "IRB140-6/0.81",
    "IRB1300-11/0.9",
    "IRB2600-20/1.65",
    "IRB4600-60/2.05",
    "IRB1660ID-6/1.55",
    "IRB6640-180/2.55",
];

/// Moving mass over squared reach \[kg/m²\], and shares of the links.
const MASS_PER_REACH: [f64; 2] = [55.0, 110.0];
const SHARES: [f64; 6] = [0.36, 0.28, 0.22, 0.09, 0.035, 0.015];
/// Least mass of a link, with bearings and gears \[kg\].
const LIGHTEST: f64 = 0.25;

/// Least rated torque of a motor, at the joint \[Nm\].
const LEAST_TORQUE: f64 = 8.0;

/// A robot with dynamics; `None` if the catalogue contains none of the arms.
pub(super) fn robot(random: &mut Random) -> Option<Model> {
    let first = random.below(ARMS.len());
    let mut found = (0..ARMS.len()).filter_map(|i| {
        let model = robot::find(ARMS[(first + i) % ARMS.len()]).ok()?;
        (model.dof == 6).then_some(model)
    });
    let mut model = found.next()?;
    model.name = "arm".into();
    model.origins.clear();
    model.effects.clear();
    model.limits.position_if.clear();
    model.limits.acceleration_by_pose = None;
    // In half of the cases an arm keeps its published bodies.
    if model.links.len() != model.dof || random.chance(0.5) {
        model.links = links(&model, random);
    }
    model.wrist =
        Wrist { coupling: if random.chance(0.3) { random.between(-1.0, 1.0) } else { 0.0 } };
    drives(&mut model, random);
    Some(model)
}

/// Boxes from each joint to the next, slightly off the line.
fn links(model: &Model, random: &mut Random) -> Vec<Link> {
    let joints = &model.kinematics.joints;
    let reach: f64 = joints.iter().skip(1).map(|joint| joint.translation.norm()).sum();
    let total = random.log_between(MASS_PER_REACH[0], MASS_PER_REACH[1]) * reach * reach;
    (0..model.dof)
        .map(|i| {
            let next = match joints.get(i + 1) {
                Some(joint) => joint.translation,
                None => model.kinematics.flange.translation.vector,
            };
            let share = SHARES.get(i).copied().unwrap_or(LIGHTEST);
            let mass = (share * total * random.between(0.8, 1.25)).max(LIGHTEST);
            // Volume of a box with three times the density of water.
            let width = (mass / 3000.0).cbrt() * random.between(0.8, 1.3);
            let off = Vector3::from_fn(|_, _| 0.2 * width * random.normal_within(2.0));
            let com = next * random.between(0.3, 0.6) + off;
            let sides = next.map(|x| 0.8 * x.abs() + width);
            let square = |axis: usize| sides[axis] * sides[axis] / 12.0;
            let inertia = Matrix3::from_diagonal(&Vector3::new(
                mass * (square(1) + square(2)),
                mass * (square(0) + square(2)),
                mass * (square(0) + square(1)),
            ));
            Link { mass, com, inertia }
        })
        .collect()
}

/// Gears, rotors, friction and losses in proportion to the bodies.
fn drives(model: &mut Model, random: &mut Random) {
    let n = model.dof;
    model.motors = None;
    let plant = Plant::new(model);
    let workspace = Workspace::new(model);
    let mut largest: Joints = [0.0; MAX_DOF];
    let mut inertia: Joints = [0.0; MAX_DOF];
    let still = [0.0; MAX_DOF];
    for _ in 0..24 {
        let mut q = still;
        for joint in 0..n {
            let [low, high] = workspace.range[joint];
            q[joint] = random.between(low, high);
        }
        let gravity = plant.rigid(&q, &still, &still);
        for joint in 0..n {
            let column = plant.inertia_column(&q, joint);
            inertia[joint] += column[joint] / 24.0;
            let push = column[joint] * workspace.acceleration[joint];
            largest[joint] = largest[joint].max(gravity[joint].abs() + push);
        }
    }
    let each = |random: &mut Random, low: f64, high: f64| -> Vec<f64> {
        (0..n).map(|_| random.log_between(low, high)).collect()
    };
    let wide = |joint: usize| if joint < 3 { 1.0 } else { 2.0 };
    model.friction.coulomb = each(random, 0.03, 0.08)
        .iter()
        .enumerate()
        .map(|(joint, share)| wide(joint) * share * largest[joint].max(LEAST_TORQUE))
        .collect();
    model.friction.viscous = each(random, 0.04, 0.12)
        .iter()
        .enumerate()
        .map(|(joint, x)| {
            wide(joint) * x * largest[joint].max(LEAST_TORQUE) / workspace.velocity[joint]
        })
        .collect();
    model.friction.stribeck = None;
    model.friction.load_friction = None;
    model.friction.viscous_asymmetry = None;
    model.friction.coulomb_asymmetry = None;
    let ratio: Vec<f64> =
        (0..n).map(|_| (random.log_between(50.0, 160.0) * 10.0).round() / 10.0).collect();
    let rotor_inertia: Vec<f64> = (0..n)
        .map(|joint| {
            let at_joint = inertia[joint].max(0.02) * random.log_between(0.15, 0.7);
            (at_joint / ratio[joint].powi(2)).min(0.4)
        })
        .collect();
    let torque: Vec<f64> = (0..n).map(|joint| 2.5 * largest[joint].max(LEAST_TORQUE)).collect();
    // Typical copper loss at the largest torque: some hundred watts.
    let loss_constant: Vec<f64> =
        torque.iter().map(|tau| random.log_between(300.0, 900.0) / (tau * tau)).collect();
    model.motors = Some(Motors {
        ratio,
        torque_constant: None,
        rotor_inertia,
        loss_constant,
        peak_current: None,
        rated_current: None,
    });
    model.limits.torque = Some(torque);
    model.drive.base_w = random.between(80.0, 300.0).round();
    model.drive.regeneration = 0.0;
}

//! Random nominal arms.
//!
//! Sizes follow data sheets of industrial robots: reach and mass as powers of the payload.

use super::arm::Arm;
use super::spatial::{GRAVITY, Point, inertia_of, joined, joint};
use crate::examine::worlds::model::{Body, Joint, M3, MAX, Row, V3};
use crate::examine::worlds::random::Rng;
use nalgebra::Rotation3;

/// How an arm is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Build {
    /// Elbow arm, wrist axes meet in a point.
    Elbow,
    /// Six axes, wrist axes offset, as cobots have.
    OffsetWrist,
    /// Seven axes in a row.
    Seven,
}

/// Joint axes and places at the angle 0, and what belongs to the architecture.
struct Skeleton {
    places: Vec<V3>,
    axes: Vec<V3>,
    lower: Row,
    upper: Row,
    middle: Row,
    span: Row,
    shares: Row,
    /// Joints from the base that count as main axes.
    main: usize,
}

/// Significant digits of the numbers in a model file.
const DIGITS: i32 = 7;

/// A number with as many digits as the model file has.
pub(super) fn rounded(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return 0.0;
    }
    let digits = usize::try_from(DIGITS - 1).unwrap_or(6);
    format!("{x:.digits$e}").parse().unwrap_or(x)
}

/// A vector with as many digits as the model file has.
fn rounded3(v: &V3) -> V3 {
    let tiny = |x: f64| if x.abs() < 1e-12 { 0.0 } else { rounded(x) };
    v.map(tiny)
}

/// A nominal arm; `six` asks for six axes.
pub(super) fn nominal(rng: &mut Rng, number: usize, six: bool) -> Arm {
    // Most arms of this world are of middle size: 3 to 80 kg.
    let payload =
        if rng.chance(0.6) { rng.log_between(3.0, 80.0) } else { rng.log_between(0.5, 300.0) };
    let build = if !six && rng.chance(0.2) {
        Build::Seven
    } else if rng.chance(if payload < 20.0 { 0.35 } else { 0.05 }) {
        Build::OffsetWrist
    } else {
        Build::Elbow
    };
    let reach = 0.62 * payload.powf(0.27) * rng.between(0.85, 1.15);
    let mass = 14.0 * payload.powf(0.8) * rng.between(0.75, 1.3);
    let bones = skeleton(build, reach, rng);
    let count = bones.axes.len();
    let along = rng.chance(0.5);
    let (joints, frames) = frames(&bones, along);
    let mut bodies = Vec::with_capacity(count);
    for i in 0..count {
        let body = link(&bones, i, mass * bones.shares[i] * rng.between(0.8, 1.25), reach, rng);
        let body = if i + 1 == count { tool(&body, &bones, payload, rng) } else { body };
        bodies.push(into_frame(&body, &frames[i], &bones.places[i]));
    }
    let mut arm = Arm {
        name: format!("arm-{number:04}"),
        payload,
        joints,
        bodies,
        lower: bones.lower,
        upper: bones.upper,
        speed: [0.0; MAX],
        acceleration: [0.0; MAX],
        torque: [0.0; MAX],
        coulomb: [0.0; MAX],
        viscous: [0.0; MAX],
        ratio: [0.0; MAX],
        rotor: [0.0; MAX],
        loss: [0.0; MAX],
        base: rounded(rng.between(60.0, 250.0) + 2.0 * payload),
        regeneration: if rng.chance(0.3) { 0.0 } else { rounded(rng.between(0.4, 0.9)) },
        middle: bones.middle,
        span: bones.span,
        usual: [0.0; MAX],
    };
    motors(&mut arm, bones.main, rng);
    arm
}

/// Bones of an architecture with a reach \[m\].
fn skeleton(build: Build, reach: f64, rng: &mut Rng) -> Skeleton {
    let (x, y, z) = (V3::x(), V3::y(), V3::z());
    let mut at = |x: f64, y: f64, z: f64| V3::new(x, y, z) * (reach * rng.between(0.92, 1.08));
    match build {
        Build::Elbow => {
            let one = at(0.0, 0.0, 0.16);
            let two = one + at(0.09, 0.0, 0.17);
            let three = two + at(0.0, 0.0, 0.42);
            let four = three + at(0.16, 0.0, 0.07);
            let five = four + at(0.3, 0.0, 0.0);
            let six = five + at(0.06, 0.0, 0.0);
            let tip = six + at(0.05, 0.0, 0.0);
            Skeleton {
                places: vec![one, two, three, four, five, six, tip],
                axes: vec![z, y, y, x, y, x],
                lower: [-2.9, -1.6, -2.6, -3.4, -2.1, -6.2, 0.0],
                upper: [2.9, 2.3, 1.3, 3.4, 2.1, 6.2, 0.0],
                middle: [0.0, 0.3, -0.2, 0.0, 0.6, 0.0, 0.0],
                span: [1.4, 0.6, 0.7, 1.6, 1.1, 2.2, 0.0],
                shares: [0.27, 0.2, 0.17, 0.07, 0.025, 0.008, 0.0],
                main: 3,
            }
        }
        Build::OffsetWrist => {
            let one = at(0.0, 0.0, 0.1);
            let two = one + at(0.0, 0.12, 0.02);
            let three = two + at(0.44, -0.05, 0.0);
            let four = three + at(0.4, 0.0, 0.0);
            let five = four + at(0.0, 0.09, 0.0);
            let six = five + at(0.0, 0.0, -0.09);
            let tip = six + at(0.0, 0.07, 0.0);
            Skeleton {
                places: vec![one, two, three, four, five, six, tip],
                axes: vec![z, y, y, y, -z, y],
                lower: [-6.2, -6.2, -3.1, -6.2, -6.2, -6.2, 0.0],
                upper: [6.2, 6.2, 3.1, 6.2, 6.2, 6.2, 0.0],
                middle: [0.0, -1.1, 1.3, -0.5, -1.3, 0.0, 0.0],
                span: [1.6, 0.6, 0.8, 1.2, 1.2, 2.0, 0.0],
                shares: [0.2, 0.36, 0.15, 0.06, 0.06, 0.015, 0.0],
                main: 3,
            }
        }
        Build::Seven => {
            let mut places = vec![at(0.0, 0.0, 0.16)];
            for height in [0.14, 0.2, 0.18, 0.17, 0.16, 0.08, 0.06] {
                let before = places.last().copied().unwrap_or_default();
                places.push(before + at(0.0, 0.0, height));
            }
            Skeleton {
                places,
                axes: vec![z, y, z, -y, z, y, z],
                lower: [-2.9, -2.0, -2.9, -2.1, -2.9, -2.0, -3.0],
                upper: [2.9, 2.0, 2.9, 2.1, 2.9, 2.0, 3.0],
                middle: [0.0, 0.5, 0.1, 0.9, 0.0, 0.7, 0.0],
                span: [1.4, 0.7, 1.2, 0.7, 1.5, 0.9, 1.8],
                shares: [0.16, 0.17, 0.14, 0.13, 0.09, 0.06, 0.012],
                main: 4,
            }
        }
    }
}

/// Joints whose axes are x, y, z of parallel frames, or (`along`) z of turned frames; and the axes
/// of each frame at the angle 0 in the base frame.
fn frames(bones: &Skeleton, along: bool) -> (Vec<Joint>, Vec<M3>) {
    let mut joints: Vec<Joint> = Vec::new();
    let mut all: Vec<M3> = Vec::new();
    let mut before = M3::identity();
    let mut place = V3::zeros();
    for (axis, at) in bones.axes.iter().zip(&bones.places) {
        let wanted = if along {
            Rotation3::rotation_between(&V3::z(), axis)
                .unwrap_or_else(|| Rotation3::from_axis_angle(&V3::x_axis(), std::f64::consts::PI))
        } else {
            Rotation3::identity()
        };
        let relative = Rotation3::from_matrix_unchecked(before.transpose() * wanted.into_inner());
        let (roll, pitch, yaw) = relative.euler_angles();
        // All digits: wrist axes must still meet in a point.
        let rpy = V3::new(roll, pitch, yaw).map(|x| if x.abs() < 1e-12 { 0.0 } else { x });
        let own = if along { V3::z() } else { *axis };
        let joint = joint(rounded3(&(before.transpose() * (at - place))), rpy, own);
        place += before * joint.origin;
        before *= joint.rotation;
        all.push(before);
        joints.push(joint);
    }
    (joints, all)
}

/// A link's body between its joint and the next, base frame at the angle 0.
fn link(bones: &Skeleton, i: usize, mass: f64, reach: f64, rng: &mut Rng) -> Body {
    let from = bones.places[i];
    let to = bones.places.get(i + 1).copied().unwrap_or(from);
    let length = (to - from).norm().max(0.02 * reach);
    let along = (to - from).try_normalize(1e-9).unwrap_or_else(V3::z);
    let width = rng.between(0.08, 0.15) * reach * if i < bones.main { 1.0 } else { 0.6 };
    // The drives of the next joints sit near their joints: the centre is not in the middle.
    let side = V3::new(rng.spread(0.12), rng.spread(0.12), rng.spread(0.12)) * width;
    let com = from + along * (length * rng.between(0.25, 0.6)) + side;
    let thick = width * width / 12.0;
    let mut second = along * along.transpose() * (length * length / 12.0) + M3::identity() * thick;
    let tilt = V3::new(rng.normal(), rng.normal(), rng.normal()) * (0.25 * width);
    second += tilt * tilt.transpose() / 12.0;
    Body { mass, com, inertia: inertia_of(&(second * mass)) }
}

/// The last link with the tool that it carries for its work.
fn tool(body: &Body, bones: &Skeleton, payload: f64, rng: &mut Rng) -> Body {
    let mass = payload * rng.between(0.05, 0.7);
    let tip = bones.places.last().copied().unwrap_or_default();
    let axis = bones.axes.last().copied().unwrap_or_else(V3::z);
    let size = 0.05 * mass.cbrt() * rng.between(0.8, 1.3);
    let shift = V3::new(rng.normal(), rng.normal(), rng.normal()) * (0.4 * size);
    let com = tip + axis * size + shift;
    let sides = V3::new(rng.between(0.5, 1.5), rng.between(0.5, 1.5), rng.between(0.5, 1.5)) * size;
    let second = M3::from_diagonal(&sides.component_mul(&sides)) * (mass / 3.0);
    joined(body, &Body { mass, com, inertia: inertia_of(&second) })
}

/// A body in the frame of its joint, with the digits of a model file.
fn into_frame(body: &Body, frame: &M3, place: &V3) -> Body {
    let inertia = (frame.transpose() * body.inertia * frame).map(rounded);
    Body {
        mass: rounded(body.mass),
        com: (frame.transpose() * (body.com - place)).map(rounded),
        inertia: (inertia + inertia.transpose()) * 0.5,
    }
}

/// Rates, rotors, friction, limits and losses of an arm with links.
fn motors(arm: &mut Arm, main: usize, rng: &mut Rng) {
    let count = arm.axes();
    let fast = 3.3 * arm.payload.powf(-0.12) * rng.between(0.8, 1.2);
    let inertia = arm.own_inertia();
    for i in 0..count {
        let wrist = i >= main;
        let factor = if wrist { rng.between(1.5, 2.2) } else { rng.between(0.85, 1.15) };
        arm.speed[i] = rounded(fast * factor * if i + 1 == count { 1.2 } else { 1.0 });
        let time = if wrist { rng.between(0.15, 0.3) } else { rng.between(0.25, 0.45) };
        arm.acceleration[i] = arm.speed[i] / time;
        arm.ratio[i] =
            rounded(if wrist { rng.between(45.0, 110.0) } else { rng.between(90.0, 190.0) });
        let share = if wrist { rng.log_between(0.4, 2.5) } else { rng.log_between(0.12, 0.7) };
        arm.rotor[i] = share * inertia[i].max(1e-5);
        // The file states the motor's own inertia: the reflected one follows from the rounded value.
        let squared = arm.ratio[i] * arm.ratio[i];
        arm.rotor[i] = rounded(arm.rotor[i] / squared) * squared;
    }
    let most;
    (arm.usual, most) = usual(arm, rng);
    for i in 0..count {
        let all = rng.log_between(0.06, 0.3) * arm.usual[i];
        let dry = rng.between(0.4, 0.8);
        arm.coulomb[i] = rounded(all * dry);
        arm.viscous[i] = rounded(all * (1.0 - dry) / (0.4 * arm.speed[i]));
        // The payload on the lever of a usual tool counts for each joint's limit.
        let carried = 0.04 * arm.payload.powf(4.0 / 3.0) * GRAVITY;
        arm.torque[i] = rounded((most[i] + all + carried) * rng.between(1.2, 1.7));
        arm.loss[i] = rounded(rng.between(0.04, 0.15) * arm.speed[i] / arm.usual[i]);
    }
}

/// Rms torques \[Nm\] by joint over random states of usual work, and the largest of the hardest work.
fn usual(arm: &Arm, rng: &mut Rng) -> (Row, Row) {
    /// States looked at: enough for 10 %.
    const STATES: usize = 128;
    /// Share of the limits of rate and acceleration in usual work.
    const EFFORT: f64 = 0.45;
    let (mut squares, mut most) = ([0.0; MAX], [0.0_f64; MAX]);
    for _ in 0..STATES {
        let (mut at, mut hard) = (Point::default(), Point::default());
        for i in 0..arm.axes() {
            at.q[i] = arm.middle[i] + arm.span[i] * rng.between(-1.0, 1.0);
            at.v[i] = arm.speed[i] * EFFORT * rng.between(-1.0, 1.0);
            at.a[i] = arm.acceleration[i] * EFFORT * rng.between(-1.0, 1.0);
            hard.v[i] = arm.speed[i] * rng.between(-1.0, 1.0);
            hard.a[i] = arm.acceleration[i] * rng.sign();
        }
        hard.q = at.q;
        let (soft, hardest) = (arm.rigid(&at), arm.rigid(&hard));
        for i in 0..arm.axes() {
            squares[i] += (soft[i] + arm.rotor[i] * at.a[i]).powi(2) / STATES as f64;
            most[i] = most[i].max((hardest[i] + arm.rotor[i] * hard.a[i]).abs());
        }
    }
    (squares.map(f64::sqrt), most)
}

//! Random arms that make sense for their payload. Scaling laws are fits by eye to data sheets of
//! industrial arms: reach with the fourth root of the payload, mass with its power 0.8.

use super::arm::{Arm, box_inertia, neat};
use super::dynamics::{inertias, inverse, pose, turn};
use crate::examine::worlds::model::{Body, Joint, M3, MAX, Row, V3};
use crate::examine::worlds::random::Rng;
use std::f64::consts::FRAC_PI_2;

/// Payloads \[kg\].
const PAYLOAD: (f64, f64) = (0.5, 300.0);
/// Share of robots with seven axes.
const SEVEN_SHARE: f64 = 0.2;
/// Share of six-axis arms with an offset wrist; heavy ones have none.
const OFFSET_SHARE: f64 = 0.3;
/// Payload \[kg\] above which arms have RV gears and spherical wrists.
const HEAVY: f64 = 25.0;
/// Reach \[m\] at 1 kg, and its power of the payload: 0.5 m at 0.5 kg, 2.6 m at 300 kg.
const REACH: (f64, f64) = (0.62, 0.25);
/// Moving mass \[kg\] at 1 kg of payload, and its power: 8 kg to 1100 kg.
const MASS: (f64, f64) = (11.5, 0.8);
/// Spread of sizes between makers.
const MAKERS: (f64, f64) = (0.8, 1.25);
/// Shares of the moving mass by link, six axes.
const SHARES_SIX: [f64; MAX] = [0.3, 0.28, 0.2, 0.13, 0.07, 0.02, 0.0];
/// The same, seven axes.
const SHARES_SEVEN: [f64; MAX] = [0.22, 0.2, 0.16, 0.16, 0.12, 0.1, 0.04];
/// Speed \[rad/s\] of the main axes at 1 kg, and its power of the payload.
const SPEED: (f64, f64) = (4.0, -0.14);
/// The wrist turns faster than the main axes.
const WRIST_SPEED: (f64, f64) = (1.5, 2.2);
/// Time \[s\] in which an axis reaches its speed.
const RISE: (f64, f64) = (0.22, 0.5);
/// Random states from which torque levels are taken.
const STATES: usize = 48;
/// Limit of the torque over the largest torque of the random states.
const RESERVE: (f64, f64) = (1.1, 1.8);
/// Inertia of the rotor over that of the links: main axes, wrist.
const ROTOR: [(f64, f64); 2] = [(0.08, 0.45), (0.5, 1.6)];
/// Gear ratios: RV gears of main axes, wrists, harmonic drives.
const RATIOS: [(f64, f64); 3] = [(90.0, 190.0), (50.0, 110.0), (80.0, 160.0)];
/// Coulomb friction over the rms torque.
const COULOMB: (f64, f64) = (0.03, 0.14);
/// Viscous friction at the largest speed over the rms torque.
const VISCOUS: (f64, f64) = (0.04, 0.2);
/// Copper loss at the largest torque over the largest mechanical power.
const COPPER: (f64, f64) = (0.08, 0.35);

/// Points \[m\] and axes of the joints at the angles 0, base frame.
struct Layout {
    points: Vec<V3>,
    axes: Vec<V3>,
    flange: V3,
}

/// An elbow arm with a spherical wrist.
fn elbow(r: f64, rng: &mut Rng) -> Layout {
    let (upper, fore) = (r * rng.uniform((0.37, 0.45)), r * rng.uniform((0.4, 0.48)));
    let shoulder = V3::new(r * rng.uniform((0.03, 0.15)), 0.0, r * rng.uniform((0.25, 0.4)));
    let tip = shoulder + V3::z() * upper;
    let four = tip + V3::new(0.35 * fore, 0.0, r * rng.uniform((0.0, 0.09)));
    let five = four + V3::x() * (0.65 * fore);
    let six = five + V3::x() * (r * rng.uniform((0.05, 0.09)));
    let side = V3::y() * rng.sign();
    Layout {
        points: vec![V3::z() * (0.15 * r), shoulder, tip, four, five, six],
        axes: vec![V3::z(), side, side, V3::x() * rng.sign(), side, V3::x()],
        flange: six + V3::x() * (0.04 * r),
    }
}

/// An arm whose wrist axes do not meet.
fn offset(r: f64, rng: &mut Rng) -> Layout {
    let side = V3::y() * rng.sign();
    let shoulder = V3::new(0.0, 0.0, 0.17 * r) + side * (0.12 * r);
    let tip = shoulder + V3::z() * (0.45 * r) - side * (0.1 * r);
    let four = tip + V3::x() * (r * rng.uniform((0.38, 0.44)));
    let five = four + side * (r * rng.uniform((0.09, 0.13)));
    let six = five + V3::x() * (r * rng.uniform((0.08, 0.11)));
    Layout {
        points: vec![V3::z() * (0.1 * r), shoulder, tip, four, five, six],
        axes: vec![V3::z(), side, side, side, V3::x(), side],
        flange: six + side * (0.08 * r),
    }
}

fn seven(r: f64, rng: &mut Rng) -> Layout {
    let bend = V3::x() * (r * rng.uniform((0.0, 0.05)));
    let heights = [0.12, 0.28, 0.46, 0.66, 0.85, 1.02];
    let mut points: Vec<V3> = heights.iter().map(|h| V3::z() * (h * r)).collect();
    points[3] += bend;
    points.push(V3::z() * (1.08 * r) + V3::x() * (r * rng.uniform((0.0, 0.06))));
    let side = V3::y() * rng.sign();
    Layout {
        flange: points[6] + V3::z() * (0.06 * r),
        points,
        axes: vec![V3::z(), side, V3::z(), -side, V3::z(), side, V3::z()],
    }
}

/// Smallest rotation that turns z into an axis.
fn facing(axis: &V3) -> M3 {
    let way = V3::z().cross(axis);
    if way.norm() > 0.5 {
        turn(&way, FRAC_PI_2)
    } else if axis.z < 0.0 {
        turn(&V3::x(), std::f64::consts::PI)
    } else {
        M3::identity()
    }
}

/// An angle \[rad\] without the rounding of the turns: a wrist stays spherical.
fn tidy(angle: f64) -> f64 {
    let quarters = (angle / FRAC_PI_2).round();
    if (angle - quarters * FRAC_PI_2).abs() < 1e-9 { quarters * FRAC_PI_2 + 0.0 } else { angle }
}

/// The joints of a layout, and the orientation of each frame at the angles 0.
fn frames(layout: &Layout, rng: &mut Rng) -> (Vec<Joint>, Vec<M3>) {
    // Half of the makers draw all frames parallel, the others turn z into the axis.
    let along = rng.chance(0.5);
    let (mut last, mut before) = (V3::zeros(), M3::identity());
    let (mut joints, mut turns) = (Vec::new(), Vec::new());
    for (point, axis) in layout.points.iter().zip(&layout.axes) {
        let frame = if along { facing(axis) } else { M3::identity() };
        let angles = nalgebra::Rotation3::from_matrix_unchecked(before.transpose() * frame);
        let (roll, pitch, yaw) = angles.euler_angles();
        let rpy = V3::new(roll, pitch, yaw).map(tidy);
        joints.push(Joint {
            origin: (before.transpose() * (point - last)).map(neat),
            rpy,
            rotation: *nalgebra::Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z).matrix(),
            axis: (frame.transpose() * axis).map(|x| neat(x.round())),
        });
        turns.push(frame);
        (last, before) = (*point, frame);
    }
    (joints, turns)
}

/// Two bodies that are one.
pub(super) fn joined(a: &Body, b: &Body) -> Body {
    let mass = a.mass + b.mass;
    let com = (a.com * a.mass + b.com * b.mass) / mass;
    let shifted = |body: &Body| {
        let d = body.com - com;
        body.inertia + (M3::identity() * d.norm_squared() - d * d.transpose()) * body.mass
    };
    Body { mass, com, inertia: shifted(a) + shifted(b) }
}

/// The bodies: a box along each link, and a tool at the flange.
fn bodies(layout: &Layout, turns: &[M3], size: (f64, f64, f64), rng: &mut Rng) -> Vec<Body> {
    let (reach, moving, payload) = size;
    let count = layout.points.len();
    let shares = if count == MAX { SHARES_SEVEN } else { SHARES_SIX };
    let mut out = Vec::new();
    for k in 0..count {
        let next = layout.points.get(k + 1).copied().unwrap_or(layout.flange);
        let span = next - layout.points[k];
        let mass = moving * shares[k] * rng.uniform(MAKERS);
        // Links get thinner towards the wrist; the centre lies beside the line of the joints.
        let width = reach * (0.17 - 0.12 * k as f64 / count as f64);
        let aside = V3::from_fn(|_, _| 0.25 * width * rng.spread(1.0));
        let centre = span * rng.uniform((0.25, 0.6)) + aside;
        let sides = span.map(|x| x.abs() + width * rng.uniform((0.7, 1.3)));
        let tilt = turn(&V3::z(), 0.2 * rng.spread(1.0)) * turn(&V3::y(), 0.2 * rng.spread(1.0));
        let inertia = tilt * box_inertia(mass, sides) * tilt.transpose();
        let mut body = Body { mass, com: centre, inertia };
        if k + 1 == count {
            let tool_mass = payload * rng.uniform((0.15, 0.75));
            let away = (layout.flange - layout.points[k]).normalize();
            let tool = reach * rng.uniform((0.03, 0.1));
            let com = layout.flange - layout.points[k]
                + away * tool
                + V3::from_fn(|_, _| 0.3 * tool * rng.spread(1.0));
            let sides = V3::from_fn(|_, _| tool * rng.uniform((0.8, 2.0)));
            body = joined(
                &body,
                &Body { mass: tool_mass, com, inertia: box_inertia(tool_mass, sides) },
            );
        }
        let inverse = turns[k].transpose();
        out.push(Body {
            mass: neat(body.mass),
            com: (inverse * body.com).map(neat),
            inertia: (inverse * body.inertia * turns[k]).map(neat),
        });
    }
    out
}

/// Limits of the angles \[rad\]: about the zero pose, where the upper arm stands.
fn ranges(count: usize, spherical: bool) -> [(f64, f64); MAX] {
    if count == MAX {
        let (wide, bend) = ((-2.9, 2.9), (-2.0, 2.0));
        [wide, bend, wide, bend, wide, bend, (-3.0, 3.0)]
    } else if spherical {
        [(-2.9, 2.9), (-1.1, 1.7), (-2.4, 1.1), (-3.3, 3.3), (-2.0, 2.0), (-5.2, 5.2), (0.0, 0.0)]
    } else {
        [(-3.1, 3.1), (-1.7, 1.7), (-2.5, 2.5), (-3.1, 3.1), (-3.1, 3.1), (-6.2, 6.2), (0.0, 0.0)]
    }
}

/// Whether a joint belongs to the wrist.
pub(super) const fn is_wrist(count: usize, joint: usize) -> bool {
    joint + 3 >= count
}

/// Rms and largest torque \[Nm\] of random states.
fn levels(arm: &Arm, rng: &mut Rng) -> (Row, Row) {
    let (mut squares, mut most) = ([0.0; MAX], [0.0_f64; MAX]);
    for _ in 0..STATES {
        let (mut q, mut v, mut a) = ([0.0; MAX], [0.0; MAX], [0.0; MAX]);
        for j in 0..arm.count() {
            q[j] = rng.uniform((0.8 * arm.lower[j], 0.8 * arm.upper[j]));
            v[j] = 0.4 * arm.velocity[j] * rng.spread(1.0);
            a[j] = 0.4 * arm.acceleration[j] * rng.spread(1.0);
        }
        let tau = inverse(arm, &pose(arm, &q), &v, &a);
        for j in 0..arm.count() {
            let torque = tau[j] + arm.rotor[j] * a[j];
            squares[j] += torque * torque / STATES as f64;
            most[j] = most[j].max(torque.abs());
        }
    }
    (squares.map(f64::sqrt), most)
}

/// Rotors, friction, limits and losses, which follow from the torques.
fn drives(arm: &mut Arm, rng: &mut Rng) {
    let count = arm.count();
    let heavy = arm.payload > HEAVY;
    let mut links = [0.0; MAX];
    for _ in 0..STATES {
        let mut q = [0.0; MAX];
        for j in 0..count {
            q[j] = rng.uniform((0.8 * arm.lower[j], 0.8 * arm.upper[j]));
        }
        let own = inertias(arm, &pose(arm, &q));
        for j in 0..count {
            links[j] += own[j] / STATES as f64;
        }
    }
    for j in 0..count {
        let wrist = is_wrist(count, j);
        let kind = if heavy { usize::from(wrist) } else { 2 };
        arm.ratio[j] = neat((rng.uniform(RATIOS[kind]) * 10.0).round() / 10.0);
        let square = arm.ratio[j] * arm.ratio[j];
        arm.rotor[j] = links[j] * rng.log(ROTOR[usize::from(wrist)]);
        arm.rotor[j] = neat(arm.rotor[j] / square) * square;
    }
    let (rms, most) = levels(arm, rng);
    for j in 0..count {
        arm.effort[j] = neat((most[j] * rng.uniform(RESERVE) + 0.2 * rms[j]).max(0.05));
        arm.coulomb[j] = neat(rms[j] * rng.log(COULOMB));
        arm.viscous[j] = neat(rms[j] * rng.log(VISCOUS) / arm.velocity[j]);
        arm.loss[j] = neat(rng.log(COPPER) * arm.velocity[j] / arm.effort[j]);
    }
    arm.base_w = neat((60.0 + 25.0 * arm.payload.sqrt() * rng.uniform(MAKERS)).round());
    arm.regeneration =
        if rng.chance(0.3) { 0.0 } else { neat((rng.uniform((0.4, 0.9)) * 20.0).round() / 20.0) };
}

/// A random nominal arm; `six` excludes seven axes, `heavy` keeps the payload from 10 kg.
pub(super) fn design(rng: &mut Rng, six: bool) -> Arm {
    let payload = neat(rng.log(PAYLOAD));
    let reach = REACH.0 * payload.powf(REACH.1) * rng.uniform(MAKERS);
    let moving = MASS.0 * payload.powf(MASS.1) * rng.uniform(MAKERS);
    let many = rng.chance(SEVEN_SHARE) && !six;
    let spherical = payload > HEAVY || !rng.chance(OFFSET_SHARE);
    let layout = if many {
        seven(reach, rng)
    } else if spherical {
        elbow(reach, rng)
    } else {
        offset(reach, rng)
    };
    let (joints, turns) = frames(&layout, rng);
    let bodies = bodies(&layout, &turns, (reach, moving, payload), rng);
    let count = joints.len();
    let last = turns[count - 1].transpose() * (layout.flange - layout.points[count - 1]);
    let zero = [0.0; MAX];
    let mut arm = Arm {
        joints,
        bodies,
        flange: last,
        payload,
        coulomb: zero,
        viscous: zero,
        ratio: [1.0; MAX],
        rotor: zero,
        lower: zero,
        upper: zero,
        velocity: [1.0; MAX],
        acceleration: [1.0; MAX],
        effort: [1.0; MAX],
        loss: zero,
        base_w: 0.0,
        regeneration: 0.0,
    };
    let limits = ranges(count, spherical);
    let speed = SPEED.0 * payload.powf(SPEED.1) * rng.uniform((0.85, 1.2));
    let rise = rng.uniform(RISE);
    for j in 0..count {
        (arm.lower[j], arm.upper[j]) = limits[j];
        let faster = if is_wrist(count, j) { rng.uniform(WRIST_SPEED) } else { 1.0 };
        arm.velocity[j] = neat((speed * faster * 100.0).round() / 100.0);
        arm.acceleration[j] = arm.velocity[j] / rise;
    }
    drives(&mut arm, rng);
    arm
}

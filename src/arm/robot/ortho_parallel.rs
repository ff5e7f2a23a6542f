//! Recognises the OPW form of a chain given joint by joint.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Rotation3, Unit, UnitQuaternion, Vector3};

use super::geometry::{Joint, OffsetWrist, Opw};

/// Largest difference of the two chains \[m\] and \[rad\]; URDF numbers are rounded.
const SAME: f64 = 1e-6;

/// The OPW parameters of the chain, if it has that form.
///
/// They are read from the zero pose and accepted only if both chains have the same poses.
pub(super) fn recognise(joints: &[Joint], flange: &Isometry3<f64>) -> Option<Opw> {
    if joints.len() != 6 {
        return None;
    }
    let zero = Lines::at(joints, flange, &[0.0; 6]);
    let [z1, y2, y3, z4, y5, z6] = zero.axis;
    let meets = crossing(zero.origin[3], z4, zero.origin[4], y5)?;

    // Choose one of two equivalent descriptions: OPW angles of the transverse axes within ±π/2.
    let s1 = z1.z.signum();
    let theta1 = folded((-y2.x).atan2(y2.y));
    let across = Rotation3::from_axis_angle(&Vector3::z_axis(), theta1) * Vector3::y();
    let forward = across.cross(&Vector3::z());
    let (s2, s3) = (y2.dot(&across).signum(), y3.dot(&across).signum());
    let shoulder = on_plane(zero.origin[1], y2, across);
    let elbow = on_plane(zero.origin[2], y3, across);
    let arm = elbow - shoulder;
    let theta2 = arm.dot(&forward).atan2(arm.z);

    let forearm = meets - elbow;
    let s4 = if forearm.dot(&z4) < 0.0 { -1.0 } else { 1.0 };
    let along = z4 * s4;
    let theta23 = along.dot(&forward).atan2(along.z);
    let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), theta1)
        * Rotation3::from_axis_angle(&Vector3::y_axis(), theta23);
    let y5_in = turned.inverse() * y5;
    let theta4 = folded((-y5_in.x).atan2(y5_in.y));
    let turned = turned * Rotation3::from_axis_angle(&Vector3::z_axis(), theta4);
    let s5 = (turned.inverse() * y5).y.signum();

    let out = zero.flange.rotation * Vector3::z();
    let s6 = out.dot(&z6).signum();
    let out_in = turned.inverse() * out;
    let theta5 = out_in.x.atan2(out_in.z);
    let turned = turned * Rotation3::from_axis_angle(&Vector3::y_axis(), theta5);
    let last = turned.inverse() * zero.flange.rotation.to_rotation_matrix();
    let theta6 = last[(1, 0)].atan2(last[(0, 0)]);

    let back = Rotation3::from_axis_angle(&Vector3::y_axis(), -theta23)
        * Rotation3::from_axis_angle(&Vector3::z_axis(), -theta1);
    let forearm = back * forearm;
    let found = Opw {
        a1: shoulder.dot(&forward),
        a2: forearm.x,
        b: meets.dot(&across),
        c1: shoulder.z,
        c2: arm.norm(),
        c3: forearm.z,
        c4: (zero.flange.translation.vector - meets).dot(&out),
        offsets: [theta1, theta2, theta23 - theta2, theta4, theta5, theta6].map(|theta| -theta),
        signs: [s1, s2, s3, s4, s5, s6],
    };
    is_same(&found, joints, flange).then_some(found)
}

/// The arm up to axis 5, if it has OPW form with an axis 6 through the intersection of axes 4 and 5
/// at a right angle to axis 5.
pub(super) fn offset_wrist(joints: &[Joint]) -> Option<OffsetWrist> {
    let [_, _, _, fourth, fifth, _] = joints else { return None };
    // Both axes in the frame of joint 5, at angle 0.
    let into = fifth.rotation.inverse();
    let origin4 = into * -fifth.translation;
    let axis4 = into * fourth.axis.into_inner();
    let axis5 = fifth.axis.into_inner();
    let crossing = crossing(origin4, axis4, Vector3::zeros(), axis5)?;
    let out = Unit::try_new(axis4 - axis5 * axis4.dot(&axis5), SAME)?;
    let turn = Rotation3::rotation_between(&Vector3::z_axis(), &out)
        .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), PI));
    let sixth = Joint { translation: crossing, rotation: Rotation3::identity(), axis: out };
    let flange =
        Isometry3::from_parts(Vector3::zeros().into(), UnitQuaternion::from_rotation_matrix(&turn));
    let chain: Vec<Joint> = joints[..5].iter().cloned().chain([sixth]).collect();
    let arm = recognise(&chain, &flange)?;
    Some(OffsetWrist { arm, crossing: Isometry3::from_parts(crossing.into(), flange.rotation) })
}

/// Joint axes and flange in the base frame.
struct Lines {
    origin: [Vector3<f64>; 6],
    axis: [Vector3<f64>; 6],
    flange: Isometry3<f64>,
}

impl Lines {
    fn at(joints: &[Joint], flange: &Isometry3<f64>, q: &[f64; 6]) -> Lines {
        let mut frame = Isometry3::identity();
        let mut origin = [Vector3::zeros(); 6];
        let mut axis = [Vector3::zeros(); 6];
        for (i, joint) in joints.iter().enumerate() {
            let rotation = Rotation3::from_matrix_unchecked(joint.rotation_at(q[i]));
            frame *= Isometry3::from_parts(
                joint.translation.into(),
                UnitQuaternion::from_rotation_matrix(&rotation),
            );
            origin[i] = frame.translation.vector;
            axis[i] = frame.rotation * joint.axis.into_inner();
        }
        Lines { origin, axis, flange: frame * flange }
    }
}

/// The point of the second line nearest to the first; `None` for parallel lines.
fn crossing(
    p: Vector3<f64>,
    u: Vector3<f64>,
    r: Vector3<f64>,
    v: Vector3<f64>,
) -> Option<Vector3<f64>> {
    let cos = u.dot(&v);
    let across = 1.0 - cos * cos;
    let between = r - p;
    (across > SAME).then(|| r + v * ((cos * between.dot(&u) - between.dot(&v)) / across))
}

/// The intersection of a line with the plane of the arm.
fn on_plane(point: Vector3<f64>, along: Vector3<f64>, normal: Vector3<f64>) -> Vector3<f64> {
    point - along * (point.dot(&normal) / along.dot(&normal))
}

/// The angle shifted by ±π into −π/2 … π/2.
fn folded(angle: f64) -> f64 {
    if angle > FRAC_PI_2 {
        angle - PI
    } else if angle < -FRAC_PI_2 {
        angle + PI
    } else {
        angle
    }
}

fn is_same(opw: &Opw, joints: &[Joint], flange: &Isometry3<f64>) -> bool {
    let (own, own_flange) = opw.chain();
    let poses = [
        [0.0; 6],
        [0.3, -0.5, 0.7, 1.1, -1.3, 2.0],
        [-2.1, 0.9, -1.7, -0.4, 0.8, -1.5],
        [1.4, 1.2, 2.5, 2.9, 2.3, 0.6],
    ];
    let length_is_sound = opw.c2 > SAME && opw.a2.hypot(opw.c3) > SAME;
    length_is_sound
        && poses.iter().all(|q| {
            let [a, b] =
                [Lines::at(joints, flange, q).flange, Lines::at(&own, &own_flange, q).flange];
            (a.translation.vector - b.translation.vector).norm() < SAME
                && a.rotation.angle_to(&b.rotation) < SAME
        })
}

//! The nominal model as URDF or TOML.

use std::fmt::Write as _;

use nalgebra::{Matrix3, Vector3};

use crate::robot::Robot;

fn list(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|x| format!("{x:?}")).collect();
    format!("[{}]", texts.join(", "))
}

fn triple(v: &Vector3<f64>) -> String {
    list(&[v.x, v.y, v.z])
}

fn six(m: &Matrix3<f64>) -> [f64; 6] {
    [m.m11, m.m22, m.m33, m.m12, m.m13, m.m23]
}

/// The model as TOML, with rotors.
pub fn toml(robot: &Robot, name: &str) -> String {
    let n = robot.arm.n();
    let mut out = format!("name = \"{name}\"\n");
    for joint in &robot.arm.joints {
        let _ = write!(
            out,
            "\n[[joint]]\norigin = {}\nrpy = {}\naxis = {}\n",
            triple(&joint.origin),
            triple(&joint.rpy),
            triple(&joint.axis)
        );
    }
    let pairs: Vec<String> = (0..n).map(|i| list(&[robot.low[i], robot.high[i]])).collect();
    let _ = write!(
        out,
        "\n[limits]\nposition = [{}]\nvelocity = {}\ntorque = {}\n",
        pairs.join(", "),
        list(&robot.speed[..n]),
        list(&robot.torque[..n])
    );
    for body in &robot.arm.bodies {
        let _ = write!(
            out,
            "\n[[link]]\nmass = {:?}\ncom = {}\ninertia = {}\n",
            body.mass,
            triple(&body.com),
            list(&six(&body.inertia))
        );
    }
    let rotor: Vec<f64> =
        (0..n).map(|i| robot.arm.rotor[i] / (robot.ratio[i] * robot.ratio[i])).collect();
    let _ = write!(
        out,
        "\n[friction]\ncoulomb = {}\nviscous = {}\n\n[motors]\nratio = {}\nrotor_inertia = {}\n\
         loss_constant = {}\n\n[drive]\nbase_w = {:?}\nregeneration = {:?}\n",
        list(&robot.coulomb[..n]),
        list(&robot.viscous[..n]),
        list(&robot.ratio[..n]),
        list(&rotor),
        list(&robot.loss[..n]),
        robot.base_w,
        robot.regeneration
    );
    out
}

fn xyz(v: &Vector3<f64>) -> String {
    format!("{:?} {:?} {:?}", v.x, v.y, v.z)
}

/// The model as URDF, without rotors.
pub fn urdf(robot: &Robot, name: &str) -> String {
    let mut out = format!("<?xml version=\"1.0\"?>\n<robot name=\"{name}\">\n  <link name=\"base\"/>\n");
    for (i, body) in robot.arm.bodies.iter().enumerate() {
        let [xx, yy, zz, xy, xz, yz] = six(&body.inertia);
        let _ = write!(
            out,
            "  <link name=\"link_{}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      \
             <mass value=\"{:?}\"/>\n      <inertia ixx=\"{xx:?}\" iyy=\"{yy:?}\" izz=\"{zz:?}\" \
             ixy=\"{xy:?}\" ixz=\"{xz:?}\" iyz=\"{yz:?}\"/>\n    </inertial>\n  </link>\n",
            i + 1,
            xyz(&body.com),
            body.mass
        );
    }
    for (i, joint) in robot.arm.joints.iter().enumerate() {
        let parent = if i == 0 { "base".to_owned() } else { format!("link_{i}") };
        let _ = write!(
            out,
            "  <joint name=\"joint_{k}\" type=\"revolute\">\n    <parent link=\"{parent}\"/>\n    \
             <child link=\"link_{k}\"/>\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    <axis xyz=\"{}\"/>\n    \
             <limit lower=\"{:?}\" upper=\"{:?}\" velocity=\"{:?}\" effort=\"{:?}\"/>\n    \
             <dynamics damping=\"{:?}\" friction=\"{:?}\"/>\n  </joint>\n",
            xyz(&joint.origin),
            xyz(&joint.rpy),
            xyz(&joint.axis),
            robot.low[i],
            robot.high[i],
            robot.speed[i],
            robot.torque[i],
            robot.viscous[i],
            robot.coulomb[i],
            k = i + 1,
        );
    }
    out.push_str("</robot>\n");
    out
}

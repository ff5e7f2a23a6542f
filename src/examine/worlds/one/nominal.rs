//! The nominal robot as a file.

use crate::arm::{Arm, Row, V3};
use std::fmt::Write as _;

/// A list of numbers in brackets.
fn list(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|x| format!("{x:?}")).collect();
    format!("[{}]", texts.join(", "))
}

/// The numbers of the joints.
fn row(values: &Row, count: usize) -> String {
    list(&values[..count])
}

/// A vector in brackets.
fn triple(v: &V3) -> String {
    list(&[v.x, v.y, v.z])
}

/// The robot as TOML, with rotors and drives.
pub fn toml(arm: &Arm, name: &str) -> String {
    let count = arm.count();
    let mut out = format!("name = \"{name}\"\n");
    for joint in &arm.joints {
        let _ = write!(
            out,
            "\n[[joint]]\norigin = {}\nrpy = {}\naxis = {}\n",
            triple(&joint.origin),
            list(&joint.rpy),
            triple(&joint.axis)
        );
    }
    let range: Vec<String> = (0..count).map(|j| list(&[arm.lower[j], arm.upper[j]])).collect();
    let _ = write!(
        out,
        "\n[limits]\nposition = [{}]\nvelocity = {}\ntorque = {}\n",
        range.join(", "),
        row(&arm.velocity, count),
        row(&arm.effort, count)
    );
    for body in &arm.bodies {
        let i = &body.inertia;
        let six = [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]];
        let _ = write!(
            out,
            "\n[[link]]\nmass = {:?}\ncom = {}\ninertia = {}\n",
            body.mass,
            triple(&body.com),
            list(&six)
        );
    }
    let mut rotors = arm.rotor;
    for j in 0..count {
        rotors[j] /= arm.ratio[j] * arm.ratio[j];
    }
    let _ = write!(
        out,
        "\n[friction]\ncoulomb = {}\nviscous = {}\n\n[motors]\nratio = {}\nrotor_inertia = {}\nloss_constant = {}\n",
        row(&arm.coulomb, count),
        row(&arm.viscous, count),
        row(&arm.ratio, count),
        row(&rotors, count),
        row(&arm.loss, count)
    );
    let _ = write!(
        out,
        "\n[drive]\nbase_w = {:?}\nregeneration = {:?}\n",
        arm.base_w, arm.regeneration
    );
    out
}

/// Three numbers with blanks.
fn blanks(v: [f64; 3]) -> String {
    format!("{:?} {:?} {:?}", v[0], v[1], v[2])
}

/// The robot as a URDF: links, joints, limits and friction, no rotors.
pub fn urdf(arm: &Arm, name: &str) -> String {
    let mut out =
        format!("<?xml version=\"1.0\"?>\n<robot name=\"{name}\">\n  <link name=\"base_link\"/>\n");
    for (j, (joint, body)) in arm.joints.iter().zip(&arm.bodies).enumerate() {
        let (parent, n) =
            (if j == 0 { "base_link".to_owned() } else { format!("link_{j}") }, j + 1);
        let i = &body.inertia;
        let _ = write!(
            out,
            "  <link name=\"link_{n}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{:?}\"/>\n      <inertia ixx=\"{:?}\" ixy=\"{:?}\" ixz=\"{:?}\" iyy=\"{:?}\" iyz=\"{:?}\" izz=\"{:?}\"/>\n    </inertial>\n  </link>\n",
            blanks([body.com.x, body.com.y, body.com.z]),
            body.mass,
            i[(0, 0)],
            i[(0, 1)],
            i[(0, 2)],
            i[(1, 1)],
            i[(1, 2)],
            i[(2, 2)]
        );
        let _ = write!(
            out,
            "  <joint name=\"joint_{n}\" type=\"revolute\">\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    <parent link=\"{parent}\"/>\n    <child link=\"link_{n}\"/>\n    <axis xyz=\"{}\"/>\n    <limit lower=\"{:?}\" upper=\"{:?}\" velocity=\"{:?}\" effort=\"{:?}\"/>\n    <dynamics damping=\"{:?}\" friction=\"{:?}\"/>\n  </joint>\n",
            blanks([joint.origin.x, joint.origin.y, joint.origin.z]),
            blanks(joint.rpy),
            blanks([joint.axis.x, joint.axis.y, joint.axis.z]),
            arm.lower[j],
            arm.upper[j],
            arm.velocity[j],
            arm.effort[j],
            arm.viscous[j],
            arm.coulomb[j]
        );
    }
    out.push_str("</robot>\n");
    out
}

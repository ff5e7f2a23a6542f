//! The nominal model as URDF or TOML.

use crate::arm::Arm;
use crate::spatial::{Axes, M3, V3};
use std::fmt::Write;

/// A model file: name and text.
pub type File = (String, String);

/// Three numbers with spaces between them; adding 0 takes the sign off a zero.
fn spaced(v: &V3) -> String {
    format!("{} {} {}", v.x + 0.0, v.y + 0.0, v.z + 0.0)
}

/// Three numbers as a TOML list.
fn listed(v: &V3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x + 0.0, v.y + 0.0, v.z + 0.0)
}

/// The values of the arm's joints as a TOML list.
fn list(arm: &Arm, values: &Axes) -> String {
    let texts: Vec<String> = values.iter().take(arm.axes()).map(|x| format!("{x:?}")).collect();
    format!("[{}]", texts.join(", "))
}

/// xx yy zz xy xz yz.
fn six(m: &M3) -> [f64; 6] {
    [m.m11, m.m22, m.m33, m.m12, m.m13, m.m23]
}

/// `nominal.urdf`: links and friction, no rotors.
#[must_use]
pub fn urdf(arm: &Arm) -> File {
    let mut out =
        format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base_link\"/>\n", arm.name);
    for (i, (joint, body)) in arm.joints.iter().zip(&arm.bodies).enumerate() {
        let number = i + 1;
        let parent = if i == 0 { "base_link".to_owned() } else { format!("link_{i}") };
        let [xx, yy, zz, xy, xz, yz] = six(&body.inertia);
        let _ = write!(
            out,
            "  <joint name=\"joint_{number}\" type=\"revolute\">\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    \
             <parent link=\"{parent}\"/>\n    <child link=\"link_{number}\"/>\n    <axis xyz=\"{}\"/>\n    \
             <limit lower=\"{}\" upper=\"{}\" velocity=\"{}\" effort=\"{}\"/>\n    \
             <dynamics damping=\"{}\" friction=\"{}\"/>\n  </joint>\n",
            spaced(&joint.origin),
            spaced(&joint.rpy),
            spaced(&joint.axis),
            arm.lower[i],
            arm.upper[i],
            arm.speed[i],
            arm.torque[i],
            arm.viscous[i],
            arm.coulomb[i]
        );
        let _ = write!(
            out,
            "  <link name=\"link_{number}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      \
             <mass value=\"{}\"/>\n      <inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" \
             iyz=\"{yz}\" izz=\"{zz}\"/>\n    </inertial>\n  </link>\n",
            spaced(&body.com),
            body.mass
        );
    }
    out.push_str("</robot>\n");
    ("nominal.urdf".to_owned(), out)
}

/// `nominal.toml`: with rotors and losses.
#[must_use]
pub fn toml(arm: &Arm) -> File {
    let mut out = format!("name = \"{}\"\n", arm.name);
    for joint in &arm.joints {
        let _ = write!(
            out,
            "\n[[joint]]\norigin = {}\nrpy = {}\naxis = {}\n",
            listed(&joint.origin),
            listed(&joint.rpy),
            listed(&joint.axis)
        );
    }
    let ranges: Vec<String> =
        (0..arm.axes()).map(|i| format!("[{:?}, {:?}]", arm.lower[i], arm.upper[i])).collect();
    let _ = write!(
        out,
        "\n[limits]\nposition = [{}]\nvelocity = {}\ntorque = {}\n",
        ranges.join(", "),
        list(arm, &arm.speed),
        list(arm, &arm.torque)
    );
    for body in &arm.bodies {
        let texts: Vec<String> = six(&body.inertia).iter().map(|x| format!("{x:?}")).collect();
        let _ = write!(
            out,
            "\n[[link]]\nmass = {:?}\ncom = {}\ninertia = [{}]\n",
            body.mass,
            listed(&body.com),
            texts.join(", ")
        );
    }
    let mut rotors = [0.0; crate::spatial::MAX];
    for (i, rotor) in rotors.iter_mut().enumerate().take(arm.axes()) {
        *rotor = crate::build::rounded(arm.rotor[i] / (arm.ratio[i] * arm.ratio[i]));
    }
    let _ = write!(
        out,
        "\n[friction]\ncoulomb = {}\nviscous = {}\n\n[motors]\nratio = {}\nrotor_inertia = {}\nloss_constant = \
         {}\n\n[drive]\nbase_w = {:?}\nregeneration = {:?}\n",
        list(arm, &arm.coulomb),
        list(arm, &arm.viscous),
        list(arm, &arm.ratio),
        list(arm, &rotors),
        list(arm, &arm.loss),
        arm.base,
        arm.regeneration
    );
    ("nominal.toml".to_owned(), out)
}

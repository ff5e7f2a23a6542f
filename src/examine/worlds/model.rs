//! Data of robot models that all worlds have, and their files: TOML with rotors, URDF without.

use nalgebra::{Matrix3, Vector3};
use std::fmt::Write as _;

/// Most joints of an arm.
pub(super) const MAX: usize = 7;
/// A value for each joint; those beyond the arm's joints are 0.
pub(super) type Row = [f64; MAX];
/// A vector.
pub(super) type V3 = Vector3<f64>;
/// A matrix.
pub(super) type M3 = Matrix3<f64>;

/// A joint, as in a URDF: origin \[m\] and roll, pitch, yaw \[rad\] in the frame before, their
/// rotation, and the axis in its own frame.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    pub(super) origin: V3,
    pub(super) rpy: V3,
    pub(super) rotation: M3,
    pub(super) axis: V3,
}

/// A rigid body in the frame of its joint: mass \[kg\], centre of mass \[m\], inertia about it
/// \[kg m²\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) mass: f64,
    pub(super) com: V3,
    pub(super) inertia: M3,
}

/// How a nominal model is believed: standard deviations of a mass, relative, of a coordinate of a
/// centre of mass \[m\], of inertias and rotors and of friction, relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spread {
    pub(super) trust: &'static str,
    pub(super) mass: f64,
    pub(super) com: f64,
    pub(super) inertia: f64,
    pub(super) friction: f64,
}

/// Identified on the robot.
pub(super) const COMMISSIONED: Spread =
    Spread { trust: "commissioned", mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05 };
/// From drawings.
pub(super) const CAD: Spread =
    Spread { trust: "cad", mass: 0.1, com: 0.015, inertia: 0.2, friction: 0.25 };

/// Parameters of a body that [`one_off`] changes.
pub(super) const PARAMETERS: usize = 7;

/// A body with one parameter, 0 to 6, off by a standard deviation.
pub(super) fn one_off(body: &Body, parameter: usize, spread: &Spread) -> Body {
    let mut body = *body;
    match parameter {
        0 => body.mass *= 1.0 + spread.mass,
        1..=3 => body.com[parameter - 1] += spread.com,
        _ => body.inertia[(parameter - 4, parameter - 4)] *= 1.0 + spread.inertia,
    }
    body
}

/// What a robot's file says. Angles \[rad\], rates \[rad/s\], torques \[Nm\], Coulomb \[Nm\] and
/// viscous friction \[Nm s/rad\], rotors behind the gear \[kg m²\], losses \[W/(Nm)²\], base load
/// \[W\], share of the braking power that is given back.
pub(super) struct Sheet<'a> {
    pub(super) name: String,
    pub(super) joints: &'a [Joint],
    pub(super) bodies: &'a [Body],
    pub(super) lower: &'a Row,
    pub(super) upper: &'a Row,
    pub(super) velocity: &'a Row,
    pub(super) torque: &'a Row,
    pub(super) coulomb: &'a Row,
    pub(super) viscous: &'a Row,
    pub(super) ratio: &'a Row,
    pub(super) rotor: &'a Row,
    pub(super) loss: &'a Row,
    pub(super) base_w: f64,
    pub(super) regeneration: f64,
}

/// Numbers between separators; adding 0 takes the sign off a zero.
fn list(values: &[f64], between: &str) -> String {
    let texts: Vec<String> = values.iter().map(|x| format!("{:?}", x + 0.0)).collect();
    texts.join(between)
}

/// xx yy zz xy xz yz.
fn six(m: &M3) -> [f64; 6] {
    [m.m11, m.m22, m.m33, m.m12, m.m13, m.m23]
}

impl Sheet<'_> {
    /// Name and text of the file: `nominal.urdf` or `nominal.toml`.
    pub(super) fn file(&self, urdf: bool) -> (String, String) {
        if urdf {
            ("nominal.urdf".into(), self.urdf())
        } else {
            ("nominal.toml".into(), self.toml())
        }
    }

    fn toml(&self) -> String {
        let n = self.joints.len();
        let array = |values: &[f64]| format!("[{}]", list(values, ", "));
        let row = |values: &Row| array(&values[..n]);
        let mut out = format!("name = \"{}\"\n", self.name);
        for Joint { origin, rpy, axis, .. } in self.joints {
            let [origin, rpy, axis] = [origin, rpy, axis].map(|v| array(v.as_slice()));
            let _ = write!(out, "\n[[joint]]\norigin = {origin}\nrpy = {rpy}\naxis = {axis}\n");
        }
        let pairs: Vec<String> = (0..n).map(|i| array(&[self.lower[i], self.upper[i]])).collect();
        let _ = write!(
            out,
            "\n[limits]\nposition = [{}]\nvelocity = {}\ntorque = {}\n",
            pairs.join(", "),
            row(self.velocity),
            row(self.torque)
        );
        for Body { mass, com, inertia } in self.bodies {
            let (com, inertia) = (array(com.as_slice()), array(&six(inertia)));
            let _ = write!(out, "\n[[link]]\nmass = {mass:?}\ncom = {com}\ninertia = {inertia}\n");
        }
        let rotor: Vec<f64> =
            (0..n).map(|i| self.rotor[i] / (self.ratio[i] * self.ratio[i])).collect();
        let _ = write!(
            out,
            "\n[friction]\ncoulomb = {}\nviscous = {}\n\n[motors]\nratio = {}\nrotor_inertia = {}\n\
             loss_constant = {}\n\n[drive]\nbase_w = {:?}\nregeneration = {:?}\n",
            row(self.coulomb),
            row(self.viscous),
            row(self.ratio),
            array(&rotor),
            row(self.loss),
            self.base_w,
            self.regeneration
        );
        out
    }

    fn urdf(&self) -> String {
        let spaced = |v: &V3| list(v.as_slice(), " ");
        let mut out = format!(
            "<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base\"/>\n",
            self.name
        );
        for (i, (joint, body)) in self.joints.iter().zip(self.bodies).enumerate() {
            let parent = if i == 0 { "base".to_owned() } else { format!("link_{i}") };
            let [xx, yy, zz, xy, xz, yz] = six(&body.inertia);
            let _ = write!(
                out,
                "  <link name=\"link_{k}\">\n    <inertial>\n      \
                 <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{:?}\"/>\n      \
                 <inertia ixx=\"{xx:?}\" iyy=\"{yy:?}\" izz=\"{zz:?}\" ixy=\"{xy:?}\" \
                 ixz=\"{xz:?}\" iyz=\"{yz:?}\"/>\n    </inertial>\n  </link>\n  \
                 <joint name=\"joint_{k}\" type=\"revolute\">\n    <parent link=\"{parent}\"/>\n    \
                 <child link=\"link_{k}\"/>\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    \
                 <axis xyz=\"{}\"/>\n    <limit lower=\"{:?}\" upper=\"{:?}\" velocity=\"{:?}\" \
                 effort=\"{:?}\"/>\n    <dynamics damping=\"{:?}\" friction=\"{:?}\"/>\n  </joint>\n",
                spaced(&body.com),
                body.mass,
                spaced(&joint.origin),
                spaced(&joint.rpy),
                spaced(&joint.axis),
                self.lower[i],
                self.upper[i],
                self.velocity[i],
                self.torque[i],
                self.viscous[i],
                self.coulomb[i],
                k = i + 1,
            );
        }
        out + "</robot>\n"
    }
}

//! An effect with a law of one size.

use super::arm::Arm;
use super::motion::{Joints, rms};
use crate::arm::robot::MAX_DOF;
use crate::examine::blind::random::Random;
use crate::examine::blind::{TrueParameter, Truth};

/// Width of smooth signs over the rms rate of the joint.
const SIGN_WIDTH: f64 = 0.01;

/// An effect with a law of one size.
pub(super) struct Law<'a> {
    /// The effect without parameters that depend on the size.
    pub(super) truth: Truth,
    /// Usual sizes: least and largest.
    pub(super) sizes: [f64; 2],
    torques: Box<dyn Fn(f64) -> Vec<Joints> + 'a>,
    parameters: Box<dyn Fn(f64) -> Vec<TrueParameter> + 'a>,
}

/// Draws the law of an effect at a joint, from 0; an effect of the whole arm ignores the joint.
/// `None` if the robot or its motion cannot show it.
pub(super) type Draw = for<'a> fn(&'a Arm, usize, &mut Random) -> Option<Law<'a>>;

impl<'a> Law<'a> {
    /// An effect with the torques that `torques(size)` adds at each row \[Nm\].
    pub(super) fn new(
        id: &str,
        form: &str,
        joints: &[usize],
        sizes: [f64; 2],
        torques: impl Fn(f64) -> Vec<Joints> + 'a,
    ) -> Law<'a> {
        let truth = Truth {
            id: id.into(),
            form: form.into(),
            joints: joints.iter().map(|joint| joint + 1).collect(),
            parameters: Vec::new(),
            window: None,
            equivalents: Vec::new(),
            nats: 0.0,
        };
        Law { truth, sizes, torques: Box::new(torques), parameters: Box::new(|_| Vec::new()) }
    }

    /// An effect of one joint: `torque(row)` times the size \[Nm\].
    pub(super) fn scaled(
        [id, form]: [&str; 2],
        arm: &'a Arm,
        joint: usize,
        sizes: [f64; 2],
        torque: impl FnMut(usize) -> f64,
    ) -> Law<'a> {
        let unit: Vec<f64> = (0..arm.motion.rows()).map(torque).collect();
        Law::new(id, form, &[joint], sizes, move |size| {
            unit.iter().map(|unit| at(joint, size * unit)).collect()
        })
    }

    /// With parameters of an effect, of its only joint if it has one: name, value, and whether it
    /// means the same in every form of the law.
    pub(super) fn with(
        mut self,
        values: impl Fn(f64) -> Vec<(&'static str, f64, bool)> + 'a,
    ) -> Law<'a> {
        let joint = self.truth.joints.first().copied();
        self.parameters = Box::new(move |size| {
            let parameter = |(name, value, graded): (&str, f64, bool)| TrueParameter {
                name: name.into(),
                joint,
                value,
                graded,
            };
            values(size).into_iter().map(parameter).collect()
        });
        self
    }

    /// Acts within an interval of the log's time \[s\].
    pub(super) fn within(mut self, window: [f64; 2]) -> Law<'a> {
        self.truth.window = Some(window);
        self
    }

    /// With other effects that add exactly the same torques.
    pub(super) fn like(mut self, equivalents: &[&str]) -> Law<'a> {
        self.truth.equivalents = equivalents.iter().map(|&id| id.to_owned()).collect();
        self
    }

    /// The largest share of the joints that it is at.
    pub(super) fn share(&self, shares: &[f64]) -> f64 {
        let joints = &self.truth.joints;
        let of = (1..).zip(shares).filter(|(joint, _)| joints.is_empty() || joints.contains(joint));
        of.map(|(_, share)| *share).fold(0.0, f64::max)
    }

    /// Torques that it adds at each row \[Nm\].
    pub(super) fn torques(&self, size: f64) -> Vec<Joints> {
        (self.torques)(size)
    }

    /// The effect with the parameters of a size.
    pub(super) fn truth(&self, size: f64) -> Truth {
        Truth { parameters: (self.parameters)(size), ..self.truth.clone() }
    }
}

/// A torque of one joint \[Nm\].
pub(super) fn at(joint: usize, torque: f64) -> Joints {
    let mut joints = [0.0; MAX_DOF];
    joints[joint] = torque;
    joints
}

/// The smooth sign of a joint's rate at each row: a hyperbolic tangent.
pub(super) fn signs(arm: &Arm, joint: usize) -> Vec<f64> {
    let width = SIGN_WIDTH * arm.motion.rms_rate(joint);
    arm.motion.qd.iter().map(|qd| (qd[joint] / width).tanh()).collect()
}

/// A friction torque of usual size \[Nm\]: the Coulomb friction of the joint, or a share of its
/// torque where the log shows hardly any friction.
pub(super) fn usual_friction(arm: &Arm, joint: usize) -> f64 {
    /// Coulomb friction of an average robot joint over its rms torque.
    const SHARE: f64 = 0.1;
    arm.model.friction.coulomb[joint].max(SHARE * arm.rms[joint])
}

/// An interval of the log's time \[s\] that lasts a share of the log between these two.
pub(super) fn window(arm: &Arm, shares: [f64; 2], random: &mut Random) -> [f64; 2] {
    let lasts = random.between(shares[0], shares[1]);
    // Not at the ends, where the log may have no block of the part.
    let starts = random.between(0.1, 0.9 - lasts);
    let time = |share: f64| arm.motion.t[0] + share * arm.motion.duration();
    [time(starts), time(starts + lasts)]
}

/// A smooth window over time: 1 within, 0 outside, with logistic edges.
pub(super) fn gate(t: f64, [start, end]: [f64; 2]) -> f64 {
    /// Steepness of the edges over the length of the window.
    const STEEP: f64 = 40.0;
    let edge = |x: f64| 1.0 / (1.0 + (-STEEP * x / (end - start)).exp());
    edge(t - start) * edge(end - t)
}

/// Rms torque of each joint over the rms of its measured torque, in the rows in which it moves \[1\].
pub(super) fn shares(arm: &Arm, rows: &[usize], torques: &[Joints]) -> Vec<f64> {
    let share = |joint: usize| {
        let moving = || rows.iter().filter(|row| !arm.rests(**row, joint));
        let of = |torques: &[Joints]| rms(moving().map(|row| torques[*row][joint]));
        of(torques) / of(&arm.tau).max(f64::MIN_POSITIVE)
    };
    (0..arm.dof()).map(share).collect()
}

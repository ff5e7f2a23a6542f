//! A real robot: its measured log and a plain model of it.

use super::error::InjectError;
use super::motion::{Joints, Motion, rms};
use crate::arm::dynamics::{Data, Load, apparent_torques, rigid_bodies, torque};
use crate::arm::robot::{MAX_DOF, Model};
use crate::learn::identify::{Free, Hints, Settings, Weighting, identify, prepare, torques};
use crate::learn::log::{Channel, Log};

/// A coupling that counts as stated, so that none is identified.
const STATED: f64 = 1e-12;
/// Rate below which a joint rests \[rad/s\].
const RESTS: f64 = 0.02;

/// A real robot: its measured log and a plain model of it.
#[derive(Debug)]
pub struct Arm {
    /// Rigid bodies, rotors, Coulomb and viscous friction, and offsets.
    pub(super) model: Model,
    /// Whether the log has rates.
    pub(super) rates: Option<Vec<Joints>>,
    pub(super) motion: Motion,
    /// Measured torques \[Nm\].
    pub(super) tau: Vec<Joints>,
    /// Torques of the rigid bodies: those through the gears \[Nm\].
    pub(super) gears: Vec<Joints>,
    /// Measured torques less those of the model \[Nm\].
    pub(super) residual: Vec<Joints>,
    /// Root mean square of the measured torques \[Nm\].
    pub(super) rms: Joints,
}

impl Arm {
    /// The robot with the geometry of `bare`, and the model that is identified from its log.
    ///
    /// # Errors
    /// The torques cannot be read, or no model can be identified.
    pub fn new(bare: &Model, log: &Log) -> Result<Arm, InjectError> {
        let tau = torques(bare, log)?.tau;
        let samples = prepare(log, &tau, Hints::default())?;
        let mut stated = bare.clone();
        let may_be_coupled = bare.dof == 6 && bare.wrist.coupling == 0.0;
        if may_be_coupled {
            stated.wrist.coupling = STATED;
        }
        let settings =
            Settings { free: Free::All, weighting: Weighting::Joint, source: bare.name.clone() };
        let mut model = identify(&stated, &samples, &[], &settings)?.model;
        if may_be_coupled {
            model.wrist.coupling = 0.0;
        }
        // Their sources name files.
        model.origins.clear();
        Ok(Arm::of(model, log, &tau))
    }

    /// The robot `model` with the torques `tau` \[Nm\], by joint, then by row of the log.
    pub(super) fn of(model: Model, log: &Log, tau: &[Vec<f64>]) -> Arm {
        let whole = log.of_joints(Channel::Position).unwrap_or_default();
        let motion = Motion::new(log.time(), &whole);
        let moving = |row: &usize| motion.qd[*row].iter().any(|rate| rate.abs() >= RESTS);
        let first = (0..motion.rows()).find(moving).unwrap_or(0);
        let last = (0..motion.rows()).rfind(moving).unwrap_or(0);
        let kept = first..last + 1;
        let by_row = |columns: &[&[f64]]| -> Vec<Joints> {
            let row = |row: usize| {
                let mut joints = [0.0; MAX_DOF];
                joints.iter_mut().zip(columns).for_each(|(to, column)| *to = column[row]);
                joints
            };
            kept.clone().map(row).collect()
        };
        let columns: Vec<&[f64]> = tau.iter().map(Vec::as_slice).collect();
        let tau = by_row(&columns);
        let rates = log.of_joints(Channel::Velocity).map(|columns| by_row(&columns));
        let motion = Motion {
            t: motion.t[kept.clone()].to_vec(),
            q: motion.q[kept.clone()].to_vec(),
            qd: motion.qd[kept.clone()].to_vec(),
            qdd: motion.qdd[kept.clone()].to_vec(),
        };
        let (mut gears, mut residual) = (Vec::new(), Vec::new());
        let mut data = Data::new();
        let n = model.dof;
        for (row, measured) in tau.iter().enumerate() {
            let [q, qd, qdd] = [&motion.q, &motion.qd, &motion.qdd].map(|of| &of[row][..n]);
            gears.push(rigid_bodies(&model, &mut data, &Load::none(), q, qd, qdd));
            let parts = torque(&model, &mut data, &Load::none(), q, qd, qdd);
            let apparent = apparent_torques(&model, qd, qdd);
            let mut left = [0.0; MAX_DOF];
            for joint in 0..n {
                let offset = model.sensors.torque_offset[joint];
                let expected =
                    parts.rigid[joint] + parts.friction[joint] + apparent[joint] + offset;
                left[joint] = measured[joint] - expected;
            }
            residual.push(left);
        }
        let rms = std::array::from_fn(|joint| rms(tau.iter().map(|tau| tau[joint])));
        Arm { model, rates, motion, tau, gears, residual, rms }
    }

    /// Whether a joint rests at a row.
    pub(super) fn rests(&self, row: usize, joint: usize) -> bool {
        self.motion.qd[row][joint].abs() < RESTS
    }

    /// Number of joints.
    pub(super) fn dof(&self) -> usize {
        self.model.dof
    }

    /// Torque of the gear of a joint at the rows \[Nm\].
    pub(super) fn gear(&self, joint: usize) -> Vec<f64> {
        self.gears.iter().map(|tau| tau[joint]).collect()
    }

    /// Root mean square torque through the gear of a joint \[Nm\].
    pub(super) fn gear_rms(&self, joint: usize) -> f64 {
        rms(self.gears.iter().map(|tau| tau[joint]))
    }

    /// Inertia of the rotor of a joint at the joint \[kg m²\].
    pub(super) fn rotor(&self, joint: usize) -> f64 {
        self.model.motors.as_ref().map_or(0.0, |motors| motors.reflected_inertia(joint))
    }

    /// Change of the rigid bodies' torques with other states \[Nm\]; `state(row)` gives \[q, q̇, q̈\].
    pub(super) fn moved(&self, state: impl Fn(usize) -> [Joints; 3]) -> Vec<Joints> {
        self.loaded(&self.model, &Load::none(), state)
    }

    /// Change of the rigid bodies' torques on the measured motion with another model and load \[Nm\].
    pub(super) fn changed(&self, model: &Model, load: &Load) -> Vec<Joints> {
        let Motion { q, qd, qdd, .. } = &self.motion;
        self.loaded(model, load, |row| [q[row], qd[row], qdd[row]])
    }

    /// Torques of the bodies of `model` with `load` at the given states, less those of this arm.
    fn loaded(
        &self,
        model: &Model,
        load: &Load,
        state: impl Fn(usize) -> [Joints; 3],
    ) -> Vec<Joints> {
        let mut data = Data::new();
        let n = self.dof();
        let change = |(row, before): (usize, &Joints)| {
            let [q, qd, qdd] = state(row);
            let mut after = rigid_bodies(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            after.iter_mut().zip(before).for_each(|(after, before)| *after -= before);
            after
        };
        self.gears.iter().enumerate().map(change).collect()
    }
}

//! A motion, and the torques of the model in it.

use std::sync::{Arc, OnceLock};

use crate::arm::dynamics::{
    Data, Load, apparent_torques, friction_of_senses, laws, motor_rates, motor_torques,
    rigid_bodies, rnea, sense,
};
use crate::arm::robot::{LawState, MAX_DOF, Model};

/// Rows of a motion with the model's torques. Series are by joint, then by row.
#[derive(Clone, Debug)]
pub struct Motion<'a> {
    /// The robot.
    pub model: &'a Model,
    /// Times \[s\].
    pub t: Vec<f64>,
    /// Positions as the log has them \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Rates \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<Vec<f64>>,
    /// Whether the last row is followed by the first one.
    pub closed: bool,
    /// Rate of each motor, at its joint, at or below which it has no sense \[rad/s\].
    pub rest: Vec<f64>,
    /// Rates of the motors over the gear ratios \[rad/s\].
    pub rates: Vec<Vec<f64>>,
    /// Their senses: 1, −1, or 0 at rest.
    pub senses: Vec<Vec<f64>>,
    /// Torques of the rigid bodies through the gears \[Nm\].
    pub gear: Vec<Vec<f64>>,
    /// Torques that a log shows, by the model \[Nm\].
    pub torque: Vec<Vec<f64>>,
    /// The model with the bodies of another model, where laws use these.
    carried: Option<Arc<Model>>,
    /// Torques that a log shows by that model, once they are asked for.
    shown: OnceLock<Vec<Vec<f64>>>,
    /// Torques of the rigid bodies, once they are asked for.
    bodies: OnceLock<Vec<Vec<f64>>>,
    /// By joint, inertias of what it turns, once they are asked for.
    inertia: [OnceLock<Vec<f64>>; MAX_DOF],
}

impl<'a> Motion<'a> {
    /// The rows `t` \[s\], `motion` = q, q̇, q̈ by joint. A motor that turns no faster than
    /// `rest` \[rad/s\] of its joint has no sense.
    #[must_use]
    pub fn new(
        model: &'a Model,
        t: Vec<f64>,
        [q, qd, qdd]: [Vec<Vec<f64>>; 3],
        rest: &[f64],
        closed: bool,
    ) -> Motion<'a> {
        let (n, rows) = (model.dof, t.len());
        let empty = || vec![Vec::with_capacity(rows); n];
        let mut motion = Motion {
            model,
            t,
            q,
            qd,
            qdd,
            closed,
            rest: rest.to_vec(),
            rates: empty(),
            senses: empty(),
            gear: empty(),
            torque: Vec::new(),
            carried: None,
            shown: OnceLock::new(),
            bodies: OnceLock::new(),
            inertia: Default::default(),
        };
        let mut data = Data::new();
        for row in 0..rows {
            let [mut q, qd, qdd] = motion.state(row);
            for (q, offset) in q.iter_mut().zip(&model.sensors.position_offset) {
                *q += offset;
            }
            let rates = motor_rates(model, &qd[..n]);
            let state = [&q[..n], &qd[..n], &qdd[..n]];
            let gear = motor_torques(
                model,
                rigid_bodies(model, &mut data, &Load::none(), state[0], state[1], state[2]),
            );
            for joint in 0..n {
                motion.rates[joint].push(rates[joint]);
                let resting = rates[joint].abs() <= rest.get(joint).copied().unwrap_or(0.0);
                motion.senses[joint].push(if resting { 0.0 } else { sense(rates[joint]) });
                motion.gear[joint].push(gear[joint]);
            }
        }
        motion.torque = motion.torques_of(model, &Load::none());
        motion
    }

    /// Takes the torques through the gears from another model.
    pub fn carry(&mut self, other: &Model) {
        let series = [self.q.clone(), self.qd.clone(), self.qdd.clone()];
        self.gear = Motion::new(other, self.t.clone(), series, &self.rest, self.closed).gear;
    }

    /// Makes all laws use the bodies of another model.
    pub fn go_by(&mut self, other: &Model) {
        self.carry(other);
        self.carried = Some(Arc::new(Model { links: other.links.clone(), ..self.model.clone() }));
        (self.shown, self.bodies, self.inertia) = Default::default();
    }

    /// Whether laws use the bodies of another model.
    #[must_use]
    pub fn has_other_bodies(&self) -> bool {
        self.carried.is_some()
    }

    /// The model with the bodies that laws use.
    pub(super) fn there(&self) -> &Model {
        self.carried.as_deref().unwrap_or(self.model)
    }

    /// Torques that a log of the motion shows by that model, effects of the whole motion left out.
    pub(super) fn shown(&self) -> &[Vec<f64>] {
        self.shown.get_or_init(|| self.torques_of(self.there(), &Load::none()))
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.t.len()
    }

    /// Interval of the rows \[s\].
    #[must_use]
    pub fn step(&self) -> f64 {
        match self.t.as_slice() {
            [first, .., last] => (last - first) / (self.rows() - 1) as f64,
            _ => 0.0,
        }
    }

    /// Position, rate and acceleration in a row.
    #[must_use]
    pub fn state(&self, row: usize) -> [[f64; MAX_DOF]; 3] {
        [&self.q, &self.qd, &self.qdd].map(|series| {
            let mut at = [0.0; MAX_DOF];
            at.iter_mut().zip(series).for_each(|(to, of)| *to = of[row]);
            at
        })
    }

    /// What laws of a joint depend on.
    #[must_use]
    pub fn law_state(&self, row: usize, joint: usize) -> LawState {
        LawState {
            t: self.t[row],
            q: self.q[joint][row],
            rate: self.rates[joint][row],
            sense: self.senses[joint][row],
            gear: self.gear[joint][row],
        }
    }

    /// Torques that a log of the motion shows by another model, effects of the whole motion
    /// left out.
    #[must_use]
    pub fn torques_of(&self, model: &Model, load: &Load) -> Vec<Vec<f64>> {
        let n = model.dof;
        let mut torques = vec![Vec::with_capacity(self.rows()); n];
        let mut data = Data::new();
        for row in 0..self.rows() {
            let [mut q, qd, qdd] = self.state(row);
            for (q, offset) in q.iter_mut().zip(&model.sensors.position_offset) {
                *q += offset;
            }
            let mut senses = [0.0; MAX_DOF];
            senses.iter_mut().zip(&self.senses).for_each(|(to, of)| *to = of[row]);
            if model.wrist.coupling != self.model.wrist.coupling {
                // Another motor 6 turns back at other times. There its torques count, so that
                // the likely sense is better than none.
                senses[n - 1] = sense(motor_rates(model, &qd[..n])[n - 1]);
            }
            let tau = rnea(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            let gear = rigid_bodies(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            let friction = friction_of_senses(model, &qd[..n], &gear, &senses);
            let state = [&q[..n], &qd[..n]];
            let [between, rubbing] = laws(model, self.t[row], state, &gear, &senses);
            let apparent = apparent_torques(model, &qd[..n], &qdd[..n]);
            let sensors = &model.sensors;
            for joint in 0..n {
                let torque = tau[joint] + friction[joint] + between[joint] + rubbing[joint];
                torques[joint].push(
                    torque * (1.0 + sensors.torque_error[joint])
                        + sensors.torque_offset[joint]
                        + apparent[joint],
                );
            }
        }
        torques
    }

    /// Torques of the rigid bodies without the rotors \[Nm\].
    #[must_use]
    pub fn rigid(&self, model: &Model, load: &Load) -> Vec<Vec<f64>> {
        let n = model.dof;
        let mut torques = vec![Vec::with_capacity(self.rows()); n];
        let mut data = Data::new();
        for row in 0..self.rows() {
            let [q, qd, qdd] = self.state(row);
            let tau = rigid_bodies(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            torques.iter_mut().zip(tau).for_each(|(to, tau)| to.push(tau));
        }
        torques
    }

    /// Torques of the rigid bodies that laws use, without the rotors \[Nm\].
    pub(super) fn bodies(&self) -> &[Vec<f64>] {
        self.bodies.get_or_init(|| self.rigid(self.there(), &Load::none()))
    }

    /// Inertia of what a joint turns, of the motion as it was made \[kg m²\].
    pub(super) fn inertias(&self, joint: usize) -> &[f64] {
        self.inertia[joint].get_or_init(|| self.turned(joint))
    }

    fn turned(&self, joint: usize) -> Vec<f64> {
        let mut data = Data::new();
        let n = self.model.dof;
        let inertia = |row| {
            let [q, ..] = self.state(row);
            let mut unit = [0.0; MAX_DOF];
            let none = [0.0; MAX_DOF];
            let mut torque = |qdd: &[f64]| {
                rigid_bodies(self.there(), &mut data, &Load::none(), &q[..n], &none[..n], qdd)
                    [joint]
            };
            let weight = torque(&none[..n]);
            unit[joint] = 1.0;
            torque(&unit[..n]) - weight
        };
        (0..self.rows()).map(inertia).collect()
    }

    /// A torque of a motor, over its gear ratio, at the joints that it turns.
    #[must_use]
    pub fn at_joints(&self, motor: usize, series: Vec<f64>) -> Vec<(usize, Vec<f64>)> {
        let coupling = self.model.wrist.coupling;
        if motor == 5 && coupling != 0.0 {
            let fifth = series.iter().map(|tau| coupling * tau).collect();
            return vec![(4, fifth), (5, series)];
        }
        vec![(motor, series)]
    }

    /// The rate of change of a series, by central differences.
    #[must_use]
    pub fn changes(&self, x: &[f64]) -> Vec<f64> {
        let n = x.len();
        let step = self.step();
        (0..n)
            .map(|i| {
                let (before, after, span) = if self.closed {
                    ((i + n - 1) % n, (i + 1) % n, 2.0)
                } else {
                    let (a, b) = (i.saturating_sub(1), (i + 1).min(n - 1));
                    (a, b, (b - a).max(1) as f64)
                };
                (x[after] - x[before]) / (span * step)
            })
            .collect()
    }

    /// Motors whose friction a joint feels.
    pub(super) fn motors_of(&self, joint: usize) -> Vec<usize> {
        if joint == 4 && self.model.wrist.coupling != 0.0 && self.model.dof > 5 {
            vec![4, 5]
        } else {
            vec![joint]
        }
    }
}

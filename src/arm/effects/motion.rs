//! A motion with the torques of the model.

use std::sync::{Arc, OnceLock};

use crate::arm::dynamics::{
    Data, Load, apparent_torques, friction_with_signs, laws, motor_rates, motor_torques,
    rigid_bodies, rnea, sign,
};
use crate::arm::robot::{LawState, MAX_DOF, Model};

/// Rows of a motion with the torques of the model. Series are per joint, then per row.
#[derive(Clone, Debug)]
pub struct Motion<'a> {
    /// The robot.
    pub model: &'a Model,
    /// Times \[s\].
    pub t: Vec<f64>,
    /// Logged positions \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Velocities \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<Vec<f64>>,
    /// Whether the motion is periodic: the first row follows the last one.
    pub closed: bool,
    /// Speed of each motor, at its joint, up to which it is at rest \[rad/s\].
    pub rest: Vec<f64>,
    /// Motor speeds over the gear ratios \[rad/s\].
    pub rates: Vec<Vec<f64>>,
    /// Their signs: 1, −1, or 0 at rest.
    pub senses: Vec<Vec<f64>>,
    /// Rigid-body torques through the gears \[Nm\].
    pub gear: Vec<Vec<f64>>,
    /// Logged torques predicted by the model \[Nm\].
    pub torque: Vec<Vec<f64>>,
    /// The model with the links of another model, if laws use these.
    carried: Option<Arc<Model>>,
    /// Logged torques predicted by that model, computed on demand.
    shown: OnceLock<Vec<Vec<f64>>>,
    /// Inertias moved by each joint, computed on demand.
    inertia: [OnceLock<Vec<f64>>; MAX_DOF],
    /// By joint, how its motion changes the torques of all joints, computed on demand.
    slopes: [OnceLock<Vec<Slopes>>; MAX_DOF],
}

/// By row, derivatives of a torque with respect to position, speed and acceleration of a joint.
pub(super) type Slopes = Vec<[f64; 3]>;

/// Step of position over which torques are differentiated \[rad\].
const TURNED: f64 = 1e-4;

impl<'a> Motion<'a> {
    /// The rows `t` \[s\], `motion` = q, q̇, q̈ per joint. A motor is at rest up to the speed
    /// `rest` \[rad/s\] of its joint.
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
            inertia: Default::default(),
            slopes: Default::default(),
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
                motion.senses[joint].push(if resting { 0.0 } else { sign(rates[joint]) });
                motion.gear[joint].push(gear[joint]);
            }
        }
        motion.torque = motion.torques_of(model, &Load::none());
        motion
    }

    /// Takes the gear torques from another model.
    pub fn carry(&mut self, other: &Model) {
        let series = [self.q.clone(), self.qd.clone(), self.qdd.clone()];
        self.gear = Motion::new(other, self.t.clone(), series, &self.rest, self.closed).gear;
    }

    /// Makes all laws use the links of another model.
    pub fn go_by(&mut self, other: &Model) {
        self.carry(other);
        self.carried = Some(Arc::new(Model { links: other.links.clone(), ..self.model.clone() }));
        (self.shown, self.inertia, self.slopes) = Default::default();
    }

    /// Whether laws use the links of another model.
    #[must_use]
    pub fn has_other_bodies(&self) -> bool {
        self.carried.is_some()
    }

    /// The model with the links that laws use.
    pub(super) fn there(&self) -> &Model {
        self.carried.as_deref().unwrap_or(self.model)
    }

    /// Logged torques predicted by that model, without effects of the whole motion.
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

    /// Position, velocity and acceleration in a row.
    #[must_use]
    pub fn state(&self, row: usize) -> [[f64; MAX_DOF]; 3] {
        [&self.q, &self.qd, &self.qdd].map(|series| {
            let mut at = [0.0; MAX_DOF];
            at.iter_mut().zip(series).for_each(|(to, of)| *to = of[row]);
            at
        })
    }

    /// The arguments of the laws of a joint.
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

    /// Logged torques predicted by another model, without effects of the whole motion.
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
                // With another coupling motor 6 reverses at other times, where the computed sign is
                // more likely than 0.
                senses[n - 1] = sign(motor_rates(model, &qd[..n])[n - 1]);
            }
            let tau = rnea(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            let gear = rigid_bodies(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            let friction = friction_with_signs(model, &qd[..n], &gear, &senses);
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

    /// Inertia moved by a joint, in the original motion \[kg m²\].
    pub(super) fn inertias(&self, joint: usize) -> &[f64] {
        self.inertia[joint].get_or_init(|| self.turned(joint))
    }

    /// Mean inertia moved by a joint \[kg m²\].
    #[must_use]
    pub fn mean_inertia(&self, joint: usize) -> f64 {
        let inertias = self.inertias(joint);
        inertias.iter().sum::<f64>() / inertias.len().max(1) as f64
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

    /// By joint, how the motion of one joint changes the rigid-body torques that laws use.
    pub(super) fn slopes(&self, joint: usize) -> &[Slopes] {
        self.slopes[joint].get_or_init(|| {
            let n = self.model.dof;
            let mut data = Data::new();
            let mut slopes = vec![Vec::with_capacity(self.rows()); n];
            for row in 0..self.rows() {
                let mut state = self.state(row);
                let mut moved = |order: usize, by: f64| {
                    let before = state[order][joint];
                    state[order][joint] += by;
                    let [q, qd, qdd] = state.each_ref().map(|of| &of[..n]);
                    let tau = rigid_bodies(self.there(), &mut data, &Load::none(), q, qd, qdd);
                    state[order][joint] = before;
                    tau
                };
                // Torques are quadratic in speeds and linear in accelerations: any step is exact.
                let differences = [(0, TURNED), (1, 1.0), (2, 1.0)].map(|(order, step)| {
                    let [after, before] = [step, -step].map(|by| moved(order, by));
                    (after, before, 0.5 / step)
                });
                for (k, slopes) in slopes.iter_mut().enumerate() {
                    slopes.push(differences.each_ref().map(|(a, b, share)| (a[k] - b[k]) * share));
                }
            }
            slopes
        })
    }

    /// A motor torque, over its gear ratio, at the joints that it moves.
    #[must_use]
    pub fn at_joints(&self, motor: usize, series: Vec<f64>) -> Vec<(usize, Vec<f64>)> {
        let coupling = self.model.wrist.coupling;
        if motor == 5 && coupling != 0.0 {
            let fifth = series.iter().map(|tau| coupling * tau).collect();
            return vec![(4, fifth), (5, series)];
        }
        vec![(motor, series)]
    }

    /// Time derivative of a series by central differences.
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

    /// Motors whose friction acts on a joint.
    pub(super) fn motors_of(&self, joint: usize) -> Vec<usize> {
        if joint == 4 && self.model.wrist.coupling != 0.0 && self.model.dof > 5 {
            vec![4, 5]
        } else {
            vec![joint]
        }
    }
}

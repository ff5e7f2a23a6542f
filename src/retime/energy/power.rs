//! Power at one state of the robot, and its integral over a motion.

use super::parts::EnergyParts;
use super::quadrature::{Powers, integral};
use crate::arm::dynamics::{
    Data, Load, Torque, kinetic_energy, motor_rates, motor_torques, potential_energy, torque,
    torque_each,
};
use crate::arm::robot::{MAX_DOF, Model, Sharing};
use crate::retime::motion::timed::{JointState, TimedMotion};
use crate::retime::path::joint_path::Joints;

/// Torques and powers at one state.
#[derive(Clone, Copy, Debug)]
pub struct Power {
    /// Joint torques with friction, Nm.
    pub tau: [f64; MAX_DOF],
    /// Σ `τ_rigid` q̇, W.
    pub rigid_w: f64,
    /// Σ `τ_friction` q̇, W.
    pub friction_w: f64,
    /// Copper loss, W.
    pub copper_w: f64,
    /// Drive loss, W.
    pub drive_w: f64,
}

impl Power {
    /// Σ τ q̇ with friction, W.
    pub fn mechanical_w(&self) -> f64 {
        self.rigid_w + self.friction_w
    }

    /// Power of the drive from the grid without base power, W.
    pub fn electrical_w(&self) -> f64 {
        self.mechanical_w() + self.copper_w + self.drive_w
    }
}

/// Torques and powers of a loaded robot in a state.
pub fn power(model: &Model, data: &mut Data, load: &Load, state: &JointState) -> Power {
    power_at(model, data, load, [&state.q, &state.qd, &state.qdd])
}

/// The same for any number of joints, at position, velocity and acceleration.
pub fn power_at(model: &Model, data: &mut Data, load: &Load, state: [&[f64]; 3]) -> Power {
    let [q, qd, qdd] = state;
    from_torque(model, qd, &torque(model, data, load, q, qd, qdd))
}

/// [`power`] in several states together, which is faster.
#[inline]
fn power_each<const N: usize>(model: &Model, load: &Load, states: &[JointState; N]) -> [Power; N] {
    let lists = states.each_ref().map(|s| -> [&[f64]; 3] { [&s.q, &s.qd, &s.qdd] });
    let torques = torque_each(model, load, lists);
    std::array::from_fn(|k| from_torque(model, &states[k].qd, &torques[k]))
}

fn from_torque(model: &Model, qd: &[f64], Torque { rigid, friction }: &Torque) -> Power {
    let all = std::array::from_fn(|j| rigid[j] + friction[j]);
    let motor = motor_torques(model, all);
    let rates = motor_rates(model, qd);
    let (mut rigid_w, mut friction_w, mut copper_w) = (0.0, 0.0, 0.0);
    let mut lost_by_joint = 0.0;
    for (j, velocity) in qd.iter().enumerate().take(model.dof) {
        rigid_w += rigid[j] * velocity;
        friction_w += friction[j] * velocity;
        copper_w += model.motors.as_ref().map_or(0.0, |m| m.loss_constant[j]) * motor[j] * motor[j];
        lost_by_joint += (-motor[j] * rates[j]).max(0.0);
    }
    // Negative mechanical power: per joint, or of the sum on a common bus.
    let lost = match model.drive.sharing {
        Sharing::None => lost_by_joint,
        Sharing::Bus => (-(rigid_w + friction_w)).max(0.0),
    };
    let drive_w = lost * (1.0 - model.drive.regeneration);
    Power { tau: all, rigid_w, friction_w, copper_w, drive_w }
}

/// Power of the whole robot, W: base power and brake coils, plus `power` in motion or holding power
/// at rest.
pub fn supply_w(
    model: &Model,
    data: &mut Data,
    load: &Load,
    state: [&[f64]; 3],
    power: &Power,
) -> f64 {
    let [q, qd, qdd] = state;
    let base =
        model.drive.base_w + model.brakes.as_ref().map_or(0.0, |brakes| brakes.power_released_w);
    if qd.iter().chain(qdd).any(|x| *x != 0.0) {
        base + power.electrical_w()
    } else {
        base + holding_at(model, data, load, q).iter().sum::<f64>()
    }
}

/// Holding power of a loaded robot per joint, W: copper loss of the gravity torque and the constant
/// of the robot file.
pub fn holding_w(model: &Model, load: &Load, q: &Joints) -> Joints {
    let holding = holding_at(model, &mut Data::new(), load, q);
    std::array::from_fn(|j| holding[j])
}

fn holding_at(model: &Model, data: &mut Data, load: &Load, q: &[f64]) -> [f64; MAX_DOF] {
    // Gravity torque less the part of a balancer.
    let still = torque(model, data, load, q, &[], &[]).rigid;
    let tau = motor_torques(model, still);
    std::array::from_fn(|j| {
        if j >= model.dof {
            return 0.0;
        }
        let loss = model.motors.as_ref().map_or(0.0, |m| m.loss_constant[j]);
        loss * tau[j] * tau[j] + model.standstill.holding_w.get(j).copied().unwrap_or(0.0)
    })
}

/// Kinks closer to each other than this are ignored, s: their effect on the acceleration is small.
const MIN_STEP: f64 = 0.004;

/// The motion energy (without idle and brake parts) between two times of a motion.
pub fn motion_energy(
    model: &Model,
    load: &Load,
    motion: &TimedMotion,
    from: f64,
    to: f64,
) -> EnergyParts {
    let all = motion.knots();
    let inner = all.partition_point(|t| *t <= from)..all.partition_point(|t| *t < to);
    let mut knots = vec![from];
    for knot in &all[inner] {
        if knot - knots[knots.len() - 1] > MIN_STEP && to - knot > MIN_STEP {
            knots.push(*knot);
        }
    }
    knots.push(to);
    reversals(motion, &mut knots);
    // Rigid work is the change of kinetic and potential energy; the other parts are integrated.
    let ends = [from, to].map(|t| motion.at(t));
    let [before, after] = ends.map(|JointState { q, qd, .. }| {
        kinetic_energy(model, load, &q, &qd) + potential_energy(model, load, &q)
    });
    let mut sum = EnergyParts { mechanical_j: after - before, ..EnergyParts::default() };
    let drawn = Drawn { model, load, motion };
    for pair in knots.windows(2) {
        let [friction_j, copper_j, drive_j, _] = integral(pair[0], pair[1], &drawn);
        sum += EnergyParts { friction_j, copper_j, drive_j, ..EnergyParts::default() };
    }
    sum
}

/// Friction, copper and drive loss, and the rigid power, at whose sign changes the drive loss has a
/// kink.
struct Drawn<'a> {
    model: &'a Model,
    load: &'a Load,
    motion: &'a TimedMotion,
}

impl Powers<4> for Drawn<'_> {
    fn at<const K: usize>(&self, times: [f64; K]) -> [[f64; 4]; K] {
        let powers = power_each(self.model, self.load, &times.map(|t| self.motion.at(t)));
        powers.map(|p| [p.friction_w, p.copper_w, p.drive_w, p.rigid_w])
    }
}

/// Longest step of the search for reversals, s: within it no joint reverses twice by a relevant
/// distance between two kinks.
const LOOK: f64 = 0.06;
/// Most steps between two kinks; a motion that slow changes little in each.
const MOST_LOOKS: f64 = 2000.0;
/// Bisection steps to a reversal, down to 0.1 µs.
const HALVINGS: usize = 18;

/// Adds the times at which a joint reverses, where Coulomb friction jumps.
fn reversals(motion: &TimedMotion, knots: &mut Vec<f64>) {
    let mut found = Vec::new();
    let mut before = motion.rates(knots[0]);
    for pair in knots.windows(2) {
        let steps = ((pair[1] - pair[0]) / LOOK).ceil().clamp(1.0, MOST_LOOKS);
        let h = (pair[1] - pair[0]) / steps;
        for i in 0..steps as usize {
            let (a, b) = (pair[0] + h * i as f64, pair[0] + h * (i + 1) as f64);
            let after = motion.rates(b);
            for j in 0..after.len() {
                if before[j] * after[j] >= 0.0 {
                    continue;
                }
                let (mut low, mut high) = (a, b);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    let same = motion.rates(middle)[j] * before[j] > 0.0;
                    *(if same { &mut low } else { &mut high }) = middle;
                }
                found.push(0.5 * (low + high));
            }
            before = after;
        }
    }
    knots.extend(found);
    knots.sort_by(f64::total_cmp);
}

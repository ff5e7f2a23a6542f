//! Simulation of a robot with disturbances, logged without noise.

use super::action::{Action, Change, Moment, PowerChange};
use super::compliance::Compliance;
use super::fault::Disturbance;
use super::mechanics::{Joints, add};
use super::model_error::ModelError;
use super::motion::{Motion, PER_ROW, STEP_S, Sample};
use super::plant::Plant;
use crate::arm::robot::MAX_DOF;

/// Motor rate below which a joint counts as at rest \[rad/s\].
const RESTS: f64 = 1e-6;
/// Share of dry friction that remains in a gear at rest.
const LEFT_AT_REST: f64 = 0.3;

/// The electrical supply of the drives.
#[derive(Clone, Debug)]
pub(super) struct Supply {
    /// Base power \[W\].
    pub(super) base: f64,
    /// Loss coefficient \[W/(Nm)²\].
    pub(super) loss: Joints,
    /// Share of the braking power that is regenerated.
    pub(super) regeneration: f64,
}

/// A robot in operation.
pub(super) struct Robot<'a> {
    pub(super) plant: &'a Plant,
    pub(super) error: &'a ModelError,
    pub(super) supply: &'a Supply,
    pub(super) disturbances: Vec<&'a Disturbance>,
}

/// A row of a log: positions \[rad\], torques \[Nm\], power \[W\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) q: Joints,
    pub(super) tau: Joints,
    pub(super) power: f64,
}

/// Simulates periods of a motion from the time `clock` \[s\]; `variation` contains friction factors
/// for each period. Rows have a fifth of the simulation's rate.
pub(super) fn simulate(
    robot: &Robot<'_>,
    motion: &Motion,
    clock: f64,
    variation: &[Joints],
) -> Vec<Row> {
    let mut plant = robot.plant.clone();
    let (mut changes, compliances) = begun(&robot.disturbances, &mut plant);
    let mut links = motion.samples.clone();
    for compliance in compliances {
        links = deflected(&plant, &links, &compliance);
    }
    let rigid: Vec<Joints> =
        links.iter().map(|sample| plant.rigid(&sample.q, &sample.qd, &sample.qdd)).collect();
    let loads: Vec<Joints> = rigid.iter().map(|tau| plant.through_gears(*tau)).collect();

    let mut held = [0.0; MAX_DOF];
    let mut rows = Vec::with_capacity(variation.len() * motion.samples.len() / PER_ROW);
    for (cycle, factors) in variation.iter().enumerate() {
        let began = clock + cycle as f64 * motion.period_s();
        for (i, sample) in motion.samples.iter().enumerate() {
            let rate = plant.motor(&sample.qd);
            let in_period = i as f64 * STEP_S;
            let moment = Moment {
                t: began + in_period,
                in_period,
                dt: STEP_S,
                q: sample.q,
                qd: sample.qd,
                rate,
                acceleration: plant.motor(&sample.qdd),
                sign: dry_friction_signs(&rate, &mut held, plant.dof),
                load: loads[i],
                coulomb: plant.coulomb,
                viscous: plant.viscous,
            };
            let mut row = changes.row(robot, &plant, &moment, rigid[i], factors);
            if i % PER_ROW == 0 {
                apply(&mut changes.positions, &moment, &mut row.q);
                rows.push(row);
            }
        }
    }
    rows
}

/// Time-dependent changes by disturbances.
#[derive(Default)]
struct Changes {
    gears: Vec<Change>,
    joints: Vec<Change>,
    torques: Vec<Change>,
    positions: Vec<Change>,
    powers: Vec<PowerChange>,
}

/// Starts the changes of a log, and applies those of the plant.
fn begun(disturbances: &[&Disturbance], plant: &mut Plant) -> (Changes, Vec<Compliance>) {
    let mut changes = Changes::default();
    let mut compliances = Vec::new();
    for action in disturbances.iter().flat_map(|disturbance| &disturbance.actions) {
        match action {
            Action::Plant(change) => change(plant),
            Action::Gears(begin) => changes.gears.push(begin()),
            Action::Joints(begin) => changes.joints.push(begin()),
            Action::Torques(begin) => changes.torques.push(begin()),
            Action::Positions(begin) => changes.positions.push(begin()),
            Action::Power(begin) => changes.powers.push(begin()),
            Action::Compliance(compliance) => compliances.push(*compliance),
        }
    }
    (changes, compliances)
}

impl Changes {
    /// The row of an instant, with true positions, the torques `rigid` of the bodies \[Nm\] and the
    /// friction factors `factors`.
    fn row(
        &mut self,
        robot: &Robot<'_>,
        plant: &Plant,
        moment: &Moment,
        rigid: Joints,
        factors: &Joints,
    ) -> Row {
        let mut at_motors = [0.0; MAX_DOF];
        for joint in 0..plant.dof {
            let friction = plant.coulomb[joint] * moment.sign[joint]
                + plant.viscous[joint] * moment.rate[joint];
            at_motors[joint] =
                plant.rotor[joint] * moment.acceleration[joint] + friction * factors[joint];
        }
        apply(&mut self.gears, moment, &mut at_motors);
        let mut tau = rigid;
        add(&mut tau, &plant.at_joints(at_motors));
        apply(&mut self.joints, moment, &mut tau);
        robot.error.add(moment, &mut tau);
        let mut watts: f64 = (0..plant.dof)
            .map(|j| tau[j] * moment.qd[j] + robot.supply.loss[j] * tau[j] * tau[j])
            .sum();
        for change in &mut self.powers {
            watts = change(moment, &tau, watts);
        }
        let given_back = if watts < 0.0 { robot.supply.regeneration } else { 1.0 };
        apply(&mut self.torques, moment, &mut tau);
        Row { q: moment.q, tau, power: robot.supply.base + given_back * watts }
    }
}

fn apply(changes: &mut [Change], moment: &Moment, values: &mut Joints) {
    for change in changes {
        change(moment, values);
    }
}

/// Directions of dry friction; a gear at rest keeps a part of the last one, stored in `held`.
fn dry_friction_signs(rate: &Joints, held: &mut Joints, dof: usize) -> Joints {
    let mut sign = [0.0; MAX_DOF];
    for joint in 0..dof {
        if rate[joint].abs() > RESTS {
            held[joint] = rate[joint].signum();
            sign[joint] = held[joint];
        } else {
            sign[joint] = LEFT_AT_REST * held[joint];
        }
    }
    sign
}

/// Motion of the links with an elastic gear.
fn deflected(plant: &Plant, motion: &[Sample], compliance: &Compliance) -> Vec<Sample> {
    let joint = compliance.joint;
    let load = |sample: &Sample| {
        plant.through_gears(plant.rigid(&sample.q, &sample.qd, &sample.qdd))[joint]
    };
    let loads: Vec<f64> = motion.iter().map(load).collect();
    let inertia: Vec<f64> =
        motion.iter().map(|sample| plant.inertia_column(&sample.q, joint)[joint]).collect();
    let delta = compliance.deflections(&loads, &inertia, STEP_S);
    let count = delta.len();
    let mut links = motion.to_vec();
    for (i, sample) in links.iter_mut().enumerate() {
        let (before, after) = (delta[(i + count - 1) % count], delta[(i + 1) % count]);
        sample.q[joint] -= delta[i];
        sample.qd[joint] -= (after - before) / (2.0 * STEP_S);
        sample.qdd[joint] -= (after - 2.0 * delta[i] + before) / (STEP_S * STEP_S);
    }
    links
}

//! Torques of random poses and motions: estimated and published dynamics.

use joulepath::arm::dynamics::{Data, Load, friction, gravity, rigid_bodies};
use joulepath::arm::effects::{drawn, with_estimates};
use joulepath::arm::kinematics::limits_ok;
use joulepath::arm::robot::prior::Spread;
use joulepath::arm::robot::{Model, from_toml, to_toml};
use joulepath::retime::energy::plausible::{DRAWS, Interval};
use rayon::prelude::*;

/// Poses and motions per robot.
pub(crate) const CASES: usize = 40;
/// Least compared torque over the largest one of the joint.
pub(crate) const SMALL: f64 = 0.05;
/// Largest share of the robot's speed limits, and the default speed limit \[rad/s\].
const LIVELY: f64 = 0.8;
const USUAL_SPEED: f64 = 3.0;
/// Acceleration over speed \[1/s\].
const RATE: f64 = 4.0;

/// Tables of the robot file that are removed.
const DYNAMICS: [&str; 9] =
    ["link", "arm_load", "friction", "motors", "wrist", "drive", "brakes", "standstill", "effects"];

/// The robot with estimated instead of published dynamics.
pub(crate) fn unknown(model: &Model) -> Model {
    let mut table: toml::Table = toml::from_str(&to_toml(model)).unwrap();
    for key in DYNAMICS {
        table.remove(key);
    }
    let limits = table.get_mut("limits").and_then(toml::Value::as_table_mut).unwrap();
    limits.retain(|key, _| !key.starts_with("torque"));
    let text = toml::to_string(&table).unwrap();
    with_estimates(from_toml(&model.name, &text).unwrap()).unwrap()
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Gravity,
    Acceleration,
    Friction,
}

/// Whether each interval contains the true torque of a random pose or motion.
pub(crate) fn held(truth: &Model, unknown: &Model, kind: Kind) -> Vec<bool> {
    let part = |model: &Model, [q, qd, qdd]: &[Vec<f64>; 3]| -> Vec<f64> {
        let (mut data, load) = (Data::new(), Load::none());
        let still = gravity(model, &mut data, &load, q);
        let all = match kind {
            Kind::Gravity => still,
            Kind::Acceleration => {
                let moved = rigid_bodies(model, &mut data, &load, q, &[], qdd);
                let still = rigid_bodies(model, &mut data, &load, q, &[], &[]);
                std::array::from_fn(|j| moved[j] - still[j])
            }
            Kind::Friction => friction(model, qd, &still),
        };
        all[..model.dof].to_vec()
    };
    let states = states(truth);
    let truths: Vec<Vec<f64>> = states.iter().map(|state| part(truth, state)).collect();
    let spread = Spread::new(unknown);
    let draws = spread.draws(unknown, DRAWS).robots;
    let models: Vec<Model> = draws.iter().map(|robot| drawn(unknown, robot).unwrap()).collect();
    let mut held = Vec::new();
    for j in 0..truth.dof {
        let largest = truths.iter().map(|tau| tau[j].abs()).fold(0.0, f64::max);
        for (state, tau) in states.iter().zip(&truths) {
            if tau[j].abs() > SMALL * largest && largest > 1e-6 {
                let values: Vec<f64> =
                    models.par_iter().map(|model| part(model, state)[j]).collect();
                let Interval { low, high, .. } = Interval::from_values(&values);
                held.push((low..=high).contains(&tau[j]));
            }
        }
    }
    held
}

/// Random poses with velocities and accelerations.
fn states(model: &Model) -> Vec<[Vec<f64>; 3]> {
    let mut random = fastrand::Rng::with_seed(1600);
    let speeds = model.limits.velocity.clone().unwrap_or_else(|| vec![USUAL_SPEED; model.dof]);
    (0..CASES)
        .map(|_| {
            let q = pose(model, &mut random);
            let sign = |random: &mut fastrand::Rng| 2.0 * random.f64() - 1.0;
            let qd = speeds.iter().map(|v| LIVELY * v * sign(&mut random)).collect();
            let qdd = speeds.iter().map(|v| RATE * v * sign(&mut random)).collect();
            [q, qd, qdd]
        })
        .collect()
}

pub(crate) fn pose(model: &Model, random: &mut fastrand::Rng) -> Vec<f64> {
    loop {
        let q: Vec<f64> = model
            .limits
            .position
            .iter()
            .map(|[low, high]| {
                let (low, high) = (low.max(-2.5), high.min(2.5));
                low + (high - low) * random.f64()
            })
            .collect();
        if limits_ok(model, &q).is_ok() {
            return q;
        }
    }
}

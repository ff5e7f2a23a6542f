//! Points of action of a disturbance on the simulated robot.

use super::compliance::Compliance;
use super::mechanics::Joints;
use super::plant::Plant;

/// State of the simulated robot at one instant.
pub(super) struct Moment {
    /// Time since the start of the first log \[s\].
    pub(super) t: f64,
    /// Time since the start of the period \[s\].
    pub(super) in_period: f64,
    /// Time since the previous instant \[s\].
    pub(super) dt: f64,
    /// Joint angles \[rad\] and rates.
    pub(super) q: Joints,
    pub(super) qd: Joints,
    /// Rates and accelerations of the motors, divided by the gear ratios.
    pub(super) rate: Joints,
    pub(super) acceleration: Joints,
    /// Direction of dry friction: the sign of `rate`; at rest, a part of the last one.
    pub(super) sign: Joints,
    /// Torque through the gears \[Nm\].
    pub(super) load: Joints,
    /// The robot's own friction \[Nm, Nm s/rad\].
    pub(super) coulomb: Joints,
    pub(super) viscous: Joints,
}

/// Changes a value of each joint as a function of time.
pub(super) type Change = Box<dyn FnMut(&Moment, &mut Joints)>;
/// Creates a change at the start of a log.
pub(super) type Begin = Box<dyn Fn() -> Change + Send + Sync>;
/// Changes the power \[W\] at an instant with known torques.
pub(super) type PowerChange = Box<dyn FnMut(&Moment, &Joints, f64) -> f64>;
pub(super) type BeginPower = Box<dyn Fn() -> PowerChange + Send + Sync>;

/// Point of action of a disturbance.
pub(super) enum Action {
    /// Parameters of the robot.
    Plant(Box<dyn Fn(&mut Plant) + Send + Sync>),
    /// Adds torques at the motors.
    Gears(Begin),
    /// Adds torques at the joints.
    Joints(Begin),
    /// Changes the logged torques.
    Torques(Begin),
    /// Changes the logged positions.
    Positions(Begin),
    /// Elasticity between motor and link.
    Compliance(Compliance),
    /// Electrical power.
    Power(BeginPower),
}

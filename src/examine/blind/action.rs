//! Where and how a disturbance acts on the simulated robot.

use super::compliance::Compliance;
use super::mechanics::Joints;
use super::plant::Plant;

/// A moment of the simulated robot.
pub(super) struct Moment {
    /// Since the first log began \[s\].
    pub(super) t: f64,
    /// Since the period began \[s\].
    pub(super) in_period: f64,
    /// Time since the last moment \[s\].
    pub(super) dt: f64,
    /// Joints \[rad\], with rates and accelerations.
    pub(super) q: Joints,
    pub(super) qd: Joints,
    /// Rates and accelerations of the motors, divided by the gear ratios.
    pub(super) rate: Joints,
    pub(super) acceleration: Joints,
    /// Direction of dry friction: the sign of `rate`, and a part of the last one at rest.
    pub(super) sign: Joints,
    /// Torque through the gears \[Nm\].
    pub(super) load: Joints,
    /// The robot's own friction \[Nm, Nm s/rad\].
    pub(super) coulomb: Joints,
    pub(super) viscous: Joints,
}

/// Changes a value for each joint as time goes by.
pub(super) type Change = Box<dyn FnMut(&Moment, &mut Joints)>;
/// Begins a change at the start of a log.
pub(super) type Begin = Box<dyn Fn() -> Change + Send + Sync>;
/// Changes the power \[W\] of a moment, knowing the torques.
pub(super) type PowerChange = Box<dyn FnMut(&Moment, &Joints, f64) -> f64>;
pub(super) type BeginPower = Box<dyn Fn() -> PowerChange + Send + Sync>;

/// Where a disturbance acts.
pub(super) enum Action {
    /// On what the robot is.
    Plant(Box<dyn Fn(&mut Plant) + Send + Sync>),
    /// Adds torques at the motors.
    Gears(Begin),
    /// Adds torques at the joints.
    Joints(Begin),
    /// Changes the logged torques.
    Torques(Begin),
    /// Changes the logged positions.
    Positions(Begin),
    /// Between motor and link.
    Compliance(Compliance),
    /// On the electrical power.
    Power(BeginPower),
}

//! Implausible values of a robot, usually due to wrong units.

use super::fields::is_endless;
use super::link::Link;
use super::model::Model;

/// Joint speed that no arm reaches \[rad/s\].
const MAX_SPEED: f64 = 30.0;
/// Shortest time to full joint speed \[s\].
const MIN_RAMP_S: f64 = 0.01;
/// Largest acceleration of a joint of unknown speed \[rad/s²\].
const MAX_ACCELERATION: f64 = 500.0;
/// Largest bound of a joint that is neither endless nor the last \[rad\].
const PLAUSIBLE_BOUND: f64 = 13.0;
/// Longest chain of joints \[m\].
const MAX_LENGTH: f64 = 10.0;

/// Messages about implausible values of a robot, each with a remedy.
#[must_use]
pub fn implausible(model: &Model) -> Vec<String> {
    let mut found = Vec::new();
    for (i, link) in model.links.iter().enumerate() {
        if let Some(why) = Link::impossible(link) {
            found.push(format!("[[link]] {}: {why}; correct its mass and inertia", i + 1));
        }
    }
    let limits = &model.limits;
    for (i, range) in limits.position.iter().enumerate().take(model.dof.saturating_sub(1)) {
        let bound = range[0].abs().max(range[1].abs());
        if bound > PLAUSIBLE_BOUND && !is_endless(bound) {
            found.push(format!(
                "limits.position of joint {}: up to {bound} rad are {:.0} deg; give radians",
                i + 1,
                bound.to_degrees()
            ));
        }
    }
    for joint in 0..model.dof {
        let figure = |list: &Option<Vec<f64>>| list.as_ref().and_then(|l| l.get(joint)).copied();
        let (speed, acceleration) = (figure(&limits.velocity), figure(&limits.acceleration));
        if let Some(speed) = speed.filter(|speed| *speed > MAX_SPEED) {
            found.push(format!(
                "limits.velocity of joint {}: {speed} rad/s are {:.0} deg/s; give rad/s",
                joint + 1,
                speed.to_degrees()
            ));
        }
        let most = speed.map_or(MAX_ACCELERATION, |speed| speed / MIN_RAMP_S);
        if let Some(acceleration) = acceleration.filter(|acceleration| *acceleration > most) {
            found.push(format!(
                "limits.acceleration of joint {}: {acceleration} rad/s2 are {:.0} deg/s2, more than \
                 a joint of its speed has; give rad/s2",
                joint + 1,
                acceleration.to_degrees()
            ));
        }
    }
    let geometry = &model.kinematics;
    let length = geometry.joints.iter().map(|joint| joint.translation.norm()).sum::<f64>()
        + geometry.flange.translation.vector.norm();
    if length > MAX_LENGTH {
        found.push(format!("kinematics: the chain is {length:.1} m long; give its lengths in m"));
    }
    found
}

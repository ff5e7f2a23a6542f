//! Why an effect is not asserted.

use super::effect_ids::{GATED, STRIBECK};
use super::findings::Said;
use super::fitted::{Fitted, Polished};
use super::nuisance::Trust;
use super::search::Search;
use super::sizes::{beside_missed, fades, missed, noise, size};

/// Most ids that say anything.
pub(super) const LARGEST_CLASS: usize = 5;
/// Deviations that the largest coordinate of an effect has to have.
pub(super) const SIGNIFICANT: f64 = 3.0;
/// A change of parameters within so many deviations is no effect.
const BEYOND: f64 = 3.0;
/// Share of its joint's torque that an effect has to have, the same in a log that does not tell its
/// noise or is late, and where it brings as many nats and is no smooth torque, which models miss
/// anyway.
const RELEVANT: f64 = 0.005;
const RELEVANT_OPEN: f64 = 0.01;
const CLEARLY: f64 = 0.001;
const CLEAR: f64 = 30.0;
/// Joints at which brakes drag at once.
const BRAKES: usize = 2;
/// Friction at breakaway below this share of Coulomb friction is a form of that.
const OF_COULOMB: f64 = 0.1;
/// Share by which torque constants are off in any drive.
const OF_CONSTANT: f64 = 0.01;
/// A contact that is shorter is a jump of something else \[s\].
const TOUCH: f64 = 0.05;
/// An effect that is so many times what the model misses is there against others.
const CANCELS: f64 = 3.0;
const SMOOTH: [&str; 6] = [
    "torque_offset",
    "cable",
    "gravity_spring",
    "viscous_asymmetry",
    "nonlinear_viscous",
    "warm_up",
];
/// In a log that does not tell its noise, what an effect has to be at some joint, and at each
/// joint that is told, of what is missed beside it: real robots have a little of all effects.
const OF_MISSED: f64 = 0.8;
const AT_JOINT: f64 = 0.5;

/// Why an effect is not asserted.
pub(super) struct Refused {
    pub(super) why: String,
    /// Whether something is there all the same that is not known.
    pub(super) is_open: bool,
}

/// Why an effect is not asserted, if it is not.
pub(super) fn refused(
    search: &Search<'_, '_>,
    said: &Said,
    fitted: &[&Fitted],
    polished: &Polished,
    least: f64,
) -> Option<Refused> {
    let no = |why: String| Some(Refused { why, is_open: false });
    let open = |why: String| Some(Refused { why, is_open: true });
    let id = said.effect.id;
    if ["link_parameters", "apparent_torque"].contains(&id) {
        return no("a matter of parameters".to_owned());
    }
    if said.class.len() > LARGEST_CLASS {
        return open(format!("cannot be told from {}", said.class.join(", ")));
    }
    // The form of a filter leaves something wherever torques jump.
    let relevant = if search.late.is_some() {
        RELEVANT_OPEN
    } else if said.nats > CLEAR && !SMOOTH.contains(&id) {
        CLEARLY
    } else if search.is_open() {
        RELEVANT_OPEN
    } else {
        RELEVANT
    };
    if said.size < relevant {
        return no(format!("is less than {} % of the torque", 100.0 * relevant));
    }
    if search.is_open() && beside_missed(search, said.effect, fitted) < OF_MISSED {
        return no("is less than what stays unexplained".to_owned());
    }
    if said.size > CANCELS * missed(search, fitted) {
        return no("is there to cancel others".to_owned());
    }
    if id == "ripple" && fitted.iter().all(|of| of.parameters[0] < noise(search, of.joint)) {
        return no("is below the noise, as any motor's".to_owned());
    }
    if id == "ripple" && search.is_open() {
        return no("is there in any motor: a baseline would tell what changed".to_owned());
    }
    if GATED.contains(&id) && fitted.len() > BRAKES {
        return open("is at more joints than let go too late at once".to_owned());
    }
    if id == "torque_constant" && 2 * fitted.len() > search.dof() {
        return open("is at most joints: other masses or another unit".to_owned());
    }
    if id == "torque_constant" && said.size < OF_CONSTANT {
        return no("is no more than constants are off by".to_owned());
    }
    if id == "contact" && fitted.iter().all(|of| of.parameters[2] - of.parameters[1] < TOUCH) {
        return open("is over before anything is touched".to_owned());
    }
    if id == "warm_up" && !fitted.iter().any(|of| fades(search, of)) {
        return no("is no more than friction differs by from hour to hour".to_owned());
    }
    let is_step = |of: &Fitted| {
        of.joint.is_some_and(|j| of.parameters[0].abs() < OF_COULOMB * search.coulomb(polished, j))
    };
    if id == STRIBECK && !search.is_open() && fitted.iter().all(|of| is_step(of)) {
        return no("is no more than any step of friction is rounded by".to_owned());
    }
    if said.nats < least {
        return no(format!("brings {:.1} nats only", said.nats));
    }
    if fitted.iter().all(|of| of.significance < SIGNIFICANT) {
        return no("is not significant".to_owned());
    }
    if let Some(of) = fitted.iter().find(|of| search.cannot_be(polished, of, SIGNIFICANT)) {
        return open(format!("{} cannot be", of.effect.title));
    }
    // Without stiffness a spring is an offset.
    if ["cable", "gravity_spring"].contains(&id)
        && fitted.iter().any(|of| of.parameters[0].abs() < SIGNIFICANT * of.deviations[0])
    {
        return open("is no more than an offset".to_owned());
    }
    let of_parameters: &[&str] = match id {
        "friction_level" => &["coulomb", "viscous"],
        "rotor_inertia" => &["rotor_inertia"],
        "payload" => &[],
        _ => return None,
    };
    if search.trust == Trust::Unknown {
        return no("nothing is known of the parameters".to_owned());
    }
    let within = |of: &&&Fitted| {
        let Some(joint) = of.joint else { return false };
        of_parameters.iter().enumerate().all(|(k, name)| {
            let key = format!("joint {} {name}", joint + 1);
            let Some(at) = search.table.parameters.iter().position(|name| *name == key) else {
                return true;
            };
            let total = of.coordinates[k] / search.table.deviations[at].max(1e-12)
                + polished.parameters[at];
            total.abs() <= BEYOND
        })
    };
    if !of_parameters.is_empty() && fitted.iter().filter(within).count() == fitted.len() {
        return no("within what the parameters are believed".to_owned());
    }
    None
}

/// Whether an effect at a joint is large enough to be told.
pub(super) fn matters(search: &Search<'_, '_>, polished: &Polished, of: &Fitted) -> bool {
    let is_ripple = of.effect.id == "ripple";
    if search.is_open()
        && (beside_missed(search, of.effect, &[of]) < AT_JOINT
            || search.cannot_be(polished, of, SIGNIFICANT))
    {
        return false;
    }
    if of.effect.id == "warm_up" && !fades(search, of) {
        return false;
    }
    size(search, of.effect, &[of]) >= CLEARLY
        && !(is_ripple && of.parameters[0] < noise(search, of.joint))
}

/// Whether it is a brake that drags all the time, which is Coulomb friction as any other.
pub(super) fn drags_always(of: &Fitted) -> bool {
    of.effect.id == "brake_drag" && of.parameters[2] <= of.parameters[1]
}

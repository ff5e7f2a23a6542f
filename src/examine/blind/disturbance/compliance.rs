//! Elasticity and backlash of a gear.

use super::super::action::Action;
use super::super::compliance::{Compliance, Spring};
use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::Scale;

/// Stiffness that deflects by milliradians under the typical load of the gear \[Nm/rad\].
fn stiffness(scale: &Scale<'_>, joint: usize, random: &mut Random) -> f64 {
    scale.load[joint].max(1.0) / random.log_between(0.5e-3, 8e-3)
}

pub(super) fn elasticity(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let stiffness = stiffness(scale, joint, random);
    let (form, name) = random.form(["oscillator", "quasi_static", "hardening", "well_damped"]);
    let spring = match form {
        2 => Spring::Hardening(0.5 * scale.load[joint].max(1.0)),
        _ => Spring::Linear,
    };
    let damping = match form {
        1 => None,
        3 => Some(random.between(0.3, 0.7)),
        _ => Some(random.between(0.03, 0.15)),
    };
    Disturbance::at_joint("elasticity", name, joint)
        .with("stiffness", stiffness)
        .acting(Action::Compliance(Compliance { joint, stiffness, spring, damping }))
}

pub(super) fn backlash(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let gap = random.log_between(0.5e-3, 12e-3);
    let stiffness = 4.0 * stiffness(scale, joint, random);
    let (form, name) = random.form(["dead_zone", "soft_dead_zone", "quasi_static"]);
    let spring = if form == 1 { Spring::SoftGap(0.5 * gap) } else { Spring::Gap(gap) };
    let damping = (form != 2).then(|| random.between(0.2, 0.6));
    Disturbance::at_joint("backlash", name, joint)
        .with("gap", gap)
        .acting(Action::Compliance(Compliance { joint, stiffness, spring, damping }))
}

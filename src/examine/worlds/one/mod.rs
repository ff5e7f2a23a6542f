//! World one: prescribed motion of the links, virtual work with closed-form Jacobians, dynamic
//! friction and gear states integrated along the motion. Its emphasis is industrial arms with RV gears.

mod arm;
mod bench;
mod controller;
mod design;
mod dynamics;
mod everyday;
mod faults;
mod friction;
mod law;
mod logger;
mod motion;
mod motion_case;
mod plan;
mod plant;
mod power_case;
mod profile;
mod scene;
mod torque_case;
mod truth;

use super::api::{self, Case, Kind};

/// Case `number` of a seed: the same arguments give the same bytes.
pub(super) fn case(seed: u64, number: usize) -> Case {
    let plan = plan::Plan::new(seed, number, api::kind(seed, number));
    if plan.kind == Kind::Motion { motion_case::make(&plan) } else { torque_case::make(&plan) }
}

/// A nominal robot and its torques.
#[cfg(feature = "internals")]
pub(super) fn plain(seed: u64) -> super::plain::Plain {
    let rng = &mut super::random::Rng::stream(seed, 0, "plain");
    let arm = design::design(rng, false);
    super::plain::Plain::new(&arm.sheet("plain".into()), rng, |[q, v, a], rotors| {
        let signs = v.map(f64::signum);
        dynamics::model(&arm, (q, v, a), &signs, rotors == super::plain::Rotors::With)
    })
}

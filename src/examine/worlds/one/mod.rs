//! World one: prescribed motion of the links, virtual work with closed-form Jacobians, dynamic
//! friction and gear states integrated along the motion. Its emphasis is industrial arms with RV gears.

mod arm;
mod bench;
mod case;
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
mod plant;
mod power_case;
mod profile;

mod torque_case;
mod truth;

pub(super) use case::case;

/// A nominal robot and its torques.
#[cfg(feature = "internals")]
pub(super) fn plain(seed: u64) -> super::Plain {
    let rng = &mut super::random::Rng::stream(seed, 0, "plain");
    let arm = design::design(rng, false);
    super::Plain::new(&arm.sheet("plain".into()), rng, |[q, v, a], rotors| {
        let signs = v.map(f64::signum);
        dynamics::model(&arm, (q, v, a), &signs, rotors == super::plain::Rotors::With)
    })
}

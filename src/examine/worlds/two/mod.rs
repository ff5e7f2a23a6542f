//! World two: arms in closed loop. Forward dynamics of rigid links with motors, a cascaded controller
//! with feed-forward, friction with bristles, and a drive that reports filtered torques.

mod arm;
mod body_faults;
mod drive_faults;
mod everyday;
mod fault;
mod friction_faults;
mod logger;
mod motion;
mod motion_case;
mod outside;
mod plant;
mod power;
mod power_case;
mod program;
mod rigid;
mod robot;
mod sample;
mod sensor;
mod setup;
mod sim;
mod state;
mod structure;
mod terms;
#[cfg(test)]
mod tests;
mod torque_case;
mod truth;

use super::api::{self, Case, Kind};

/// Case `number` of a seed: the same arguments give the same bytes.
pub(super) fn case(seed: u64, number: usize) -> Case {
    match api::kind(seed, number) {
        Kind::Power => power_case::case(seed, number),
        Kind::Motion => motion_case::case(seed, number),
        kind => torque_case::case(seed, number, kind, None),
    }
}

/// A nominal robot and its torques.
#[cfg(feature = "internals")]
pub(super) fn plain(seed: u64) -> super::plain::Plain {
    let rng = &mut super::random::Rng::stream(seed, 0, "plain");
    let robot = robot::draw(false, rng);
    super::plain::Plain::new(&robot.sheet(), rng, |[q, v, a], rotors| {
        let with = rotors == super::plain::Rotors::With;
        let rotor = if with { robot.arm.rotor } else { Default::default() };
        truth::model(&robot, &rotor, q, v, a)
    })
}

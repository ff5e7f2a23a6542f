//! What a robot still lacks for each command.

use super::model::Model;

/// Joints of the robots that RAPID programs are run for.
const RAPID_JOINTS: usize = 6;

/// What each command that runs or models a robot lacks, in words; an empty list
/// where nothing is lacking.
#[must_use]
pub fn lacking(model: &Model) -> Vec<(&'static str, Vec<&'static str>)> {
    let limits = &model.limits;
    let joints = (model.dof == RAPID_JOINTS, "6 joints");
    let speeds = (limits.velocity.is_some(), "joint speeds");
    let accelerations = (limits.acceleration.is_some(), "joint accelerations");
    let torques = (limits.torque.is_some(), "joint torques");
    let bodies = (model.has_dynamics(), "dynamics (masses, inertias)");
    let motors = (model.motors.is_some(), "motor data");
    let needs: [(&str, &[(bool, &'static str)]); 7] = [
        ("simulate", &[joints, speeds]),
        ("optimize", &[joints, speeds, accelerations, torques, bodies, motors]),
        ("standstill", &[bodies, motors]),
        ("excite", &[joints, speeds, accelerations]),
        ("identify", &[]),
        ("predict", &[bodies]),
        ("diagnose", &[bodies]),
    ];
    let missing = |all: &[(bool, &'static str)]| {
        all.iter().filter(|(there, _)| !there).map(|(_, what)| *what).collect()
    };
    needs.iter().map(|(command, all)| (*command, missing(all))).collect()
}

//! Missing data of a robot per command.

use std::fmt;

use thiserror::Error;

use super::model::Model;

/// Number of joints of robots for RAPID programs.
const RAPID_JOINTS: usize = 6;

/// Use of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Simulation on the virtual controller.
    Simulate,
    /// Optimisation of programs.
    Optimize,
    /// Power at rest.
    Standstill,
    /// Design of an excitation trajectory.
    Excite,
    /// Identification of the dynamics.
    Identify,
    /// Torque prediction of a logged motion.
    Predict,
    /// Diagnosis of missing model terms.
    Diagnose,
}

impl Use {
    /// All of them, in the order of work.
    pub const ALL: [Use; 7] = [
        Use::Simulate,
        Use::Optimize,
        Use::Standstill,
        Use::Excite,
        Use::Identify,
        Use::Predict,
        Use::Diagnose,
    ];
}

impl fmt::Display for Use {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Use::Simulate => "simulate",
            Use::Optimize => "optimize",
            Use::Standstill => "standstill",
            Use::Excite => "excite",
            Use::Identify => "identify",
            Use::Predict => "predict",
            Use::Diagnose => "diagnose",
        })
    }
}

/// Missing data of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// It has fewer or more than six joints.
    SixJoints,
    /// Masses and inertias.
    Bodies,
    /// Largest speeds of the joints.
    Speeds,
    /// Largest joint accelerations.
    Accelerations,
    /// Largest joint torques.
    Torques,
    /// Motors and gears.
    Motors,
    /// Copper losses.
    Losses,
}

impl fmt::Display for Lack {
    /// In words, with the keys of the robot file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Lack::SixJoints => "6 joints",
            Lack::Bodies => "dynamics (masses and inertias, [[link]])",
            Lack::Speeds => "joint speeds (limits.velocity)",
            Lack::Accelerations => "joint accelerations (limits.acceleration)",
            Lack::Torques => "joint torques (limits.torque)",
            Lack::Motors => "motor data ([motors])",
            Lack::Losses => "copper losses (motors.loss_constant or motors.resistance)",
        })
    }
}

/// The missing data for one use; empty if the robot is ready.
#[must_use]
pub fn lacking(model: &Model, purpose: Use) -> Vec<Lack> {
    let needs: &[Lack] = match purpose {
        // Missing accelerations are assumed.
        Use::Simulate => &[Lack::SixJoints, Lack::Speeds],
        Use::Excite => &[Lack::SixJoints, Lack::Speeds, Lack::Accelerations],
        Use::Optimize => &[
            Lack::SixJoints,
            Lack::Bodies,
            Lack::Speeds,
            Lack::Accelerations,
            Lack::Torques,
            Lack::Motors,
        ],
        Use::Standstill => &[Lack::SixJoints, Lack::Bodies, Lack::Losses],
        Use::Identify => &[],
        Use::Predict | Use::Diagnose => &[Lack::Bodies],
    };
    needs.iter().copied().filter(|need| lacks(model, *need)).collect()
}

fn lacks(model: &Model, what: Lack) -> bool {
    let limits = &model.limits;
    match what {
        Lack::SixJoints => model.dof != RAPID_JOINTS,
        Lack::Bodies => !model.has_dynamics(),
        Lack::Speeds => limits.velocity.is_none(),
        Lack::Accelerations => limits.acceleration.is_none(),
        Lack::Torques => limits.torque.is_none(),
        Lack::Motors => model.motors.is_none(),
        Lack::Losses => {
            let losses = model.motors.as_ref().map_or(&[][..], |motors| &motors.loss_constant);
            losses.iter().all(|loss| *loss == 0.0)
        }
    }
}

/// A robot that is not ready for a use.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotReady {
    /// Another number of joints.
    #[error(
        "{robot} has {joints} joints; {purpose} is for robots with 6: name another with --robot"
    )]
    Joints {
        /// The robot.
        robot: String,
        /// Its number of joints.
        joints: usize,
        /// The use.
        purpose: Use,
    },
    /// Missing figures.
    #[error(
        "{robot} has no {}: {purpose} needs {}; give a robot file that adds what is missing \
         (--robot FILE.toml with extends = \"{base}\")",
        words(lacks), if lacks.len() == 1 { "it" } else { "them" }
    )]
    Figures {
        /// The robot.
        robot: String,
        /// Its file, or its name in the catalogue.
        base: String,
        /// The missing data.
        lacks: Vec<Lack>,
        /// The use.
        purpose: Use,
    },
}

/// Checks that the robot has all data for one use.
///
/// # Errors
/// The missing data, and how to provide it.
pub fn ready(model: &Model, purpose: Use) -> Result<(), NotReady> {
    let lacks = lacking(model, purpose);
    let robot = model.name.clone();
    if lacks.contains(&Lack::SixJoints) {
        return Err(NotReady::Joints { robot, joints: model.dof, purpose });
    }
    if lacks.is_empty() {
        return Ok(());
    }
    let base = model.file.clone().unwrap_or_else(|| robot.clone());
    Err(NotReady::Figures { robot, base, lacks, purpose })
}

fn words(lacks: &[Lack]) -> String {
    lacks.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

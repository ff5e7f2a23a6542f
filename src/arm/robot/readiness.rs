//! What a robot still lacks for each command.

use std::fmt;

use thiserror::Error;

use super::model::Model;

/// Joints of the robots that RAPID programs are run for.
const RAPID_JOINTS: usize = 6;

/// What a robot is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Running programs on the virtual controller.
    Simulate,
    /// Rewriting programs.
    Optimize,
    /// Power at rest.
    Standstill,
    /// Designing an excitation.
    Excite,
    /// Identifying the dynamics.
    Identify,
    /// Torques of a logged motion.
    Predict,
    /// Finding what a model lacks.
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

/// Something that a robot lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// It has fewer or more than six joints.
    SixJoints,
    /// Masses and inertias.
    Bodies,
    /// Largest speeds of the joints.
    Speeds,
    /// Their largest accelerations.
    Accelerations,
    /// Their largest torques.
    Torques,
    /// Motors and gears.
    Motors,
    /// Copper losses.
    Losses,
}

impl fmt::Display for Lack {
    /// In words, with the keys of a robot file that mend it.
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

/// What the robot lacks for one use; nothing where it can be used.
#[must_use]
pub fn lacking(model: &Model, purpose: Use) -> Vec<Lack> {
    let needs: &[Lack] = match purpose {
        // Accelerations are assumed where there are none.
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

/// A robot that can't be used for something.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotReady {
    /// Another number of joints.
    #[error(
        "{robot} has {joints} joints; {purpose} is for robots with 6: name another with --robot"
    )]
    Joints {
        /// The robot.
        robot: String,
        /// Its joints.
        joints: usize,
        /// What for.
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
        /// Its file, or its name where it is one of the catalogue.
        base: String,
        /// What it lacks.
        lacks: Vec<Lack>,
        /// What for.
        purpose: Use,
    },
}

/// Whether the robot has all that one use needs.
///
/// # Errors
/// What is missing, and how it can be given.
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

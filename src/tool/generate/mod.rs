//! From points or a trajectory to RAPID that was read again and simulated.

mod follow;
mod measure;
mod moves;
mod program;
pub mod table;

pub use follow::FollowError;
pub use measure::Measure;
pub use moves::MovesError;

use crate::arm::robot::Model;
use crate::rapid::ir::number::number;
use crate::tool::emit::{self, EmitError};
use crate::tool::retrofit::OutputFile;
use table::{Points, Table};

/// What the points become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `MoveAbsJ`; a stream of them for a trajectory.
    AbsJ,
    /// `MoveJ`.
    MoveJ,
    /// `MoveL`.
    MoveL,
    /// A file of joint positions for externally guided motion, and the module that runs it.
    Egm,
}

/// How points become RAPID.
#[derive(Clone, Debug)]
pub struct Settings {
    /// What they become.
    pub form: Form,
    /// Name of the file, for names in the program.
    pub name: String,
    /// Least time between two points of a stream, s.
    pub spacing_s: f64,
}

/// The program with what its simulation showed.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The files, with paths below the folder of the output.
    pub outputs: Vec<OutputFile>,
    /// Points of the emitted program.
    pub points: usize,
    /// Time from the first point to the last, s.
    pub duration_s: f64,
    /// Shares of the limits and the distance from a trajectory; `None` for movements, which the
    /// controller plans within its limits.
    pub measure: Option<Measure>,
    /// What was checked.
    pub checks: Vec<String>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Why nothing is generated.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// The robot is of another kind, or lacks something.
    #[error("{robot} {what}")]
    Robot {
        /// Its name.
        robot: String,
        /// What is wrong, with the way out.
        what: String,
    },
    /// Externally guided motion needs times.
    #[error("--as egm needs a timed trajectory: give a column t beside q1..q6")]
    EgmWithoutTime,
    /// A trajectory becomes a stream.
    #[error(
        "a timed trajectory becomes joint targets: give --as absj or egm, or leave out the column t"
    )]
    TimedPoses,
    /// The trajectory can't be followed.
    #[error(transparent)]
    Follow(#[from] FollowError),
    /// A point can't be reached.
    #[error(transparent)]
    Moves(#[from] MovesError),
    /// A template failed.
    #[error(transparent)]
    Emit(#[from] EmitError),
    /// The emitted text does not do what it should.
    #[error("nothing is written, as the emitted program did not hold: {0}")]
    Verification(String),
}

/// Generates a program from the points of a file.
///
/// # Errors
/// A robot, a point or a limit that stands against it; the message says which.
pub fn generate(
    model: &Model,
    table: &Table,
    settings: &Settings,
) -> Result<Generated, GenerateError> {
    let robot = |what: String| GenerateError::Robot { robot: model.name.clone(), what };
    if model.dof != 6 {
        return Err(robot(format!("has {} joints; RAPID is generated for 6", model.dof)));
    }
    if model.limits.velocity.is_none() || model.limits.acceleration.is_none() {
        return Err(robot(
            "has no joint speed or acceleration limits, so that nothing can be verified; add them \
             in a robot file (--robot FILE.toml with extends)"
                .into(),
        ));
    }
    let names = emit::GeneratedNames::of(&settings.name);
    let mut notes = table.notes.clone();
    if !model.has_dynamics() || model.limits.torque.is_none() {
        notes.push(format!(
            "{} has no dynamics or torque limits: torques are not checked",
            model.name
        ));
    }
    match (&table.points, settings.form) {
        (Points::Trajectory(t, q), Form::Egm) => {
            let followed = follow::sampled(model, t, q)?;
            let outputs = program::egm(&names, &followed)?;
            Ok(Generated {
                points: followed.positions.len(),
                duration_s: followed.duration(),
                measure: Some(followed.measure),
                checks: vec![
                    "the module parses".into(),
                    "the positions sent keep every joint limit".into(),
                ],
                outputs,
                notes,
            })
        }
        (_, Form::Egm) => Err(GenerateError::EgmWithoutTime),
        (Points::Trajectory(t, q), Form::AbsJ) => {
            if table.speeds.iter().chain(&table.zones).any(Option::is_some) {
                notes.push("speed and zone are not used: the times say how fast it goes".into());
            }
            let followed = follow::follow(model, t, q, settings.spacing_s)?;
            let outputs = program::stream(&names, &followed.stream)?;
            let measure = program::verify_stream(model, &outputs, &followed)?;
            Ok(Generated {
                points: followed.stream.points().len(),
                duration_s: followed.stream.duration(),
                measure: Some(measure),
                checks: vec![
                    "the emitted text parses".into(),
                    "its motion keeps every limit between the points".into(),
                    format!(
                        "its motion is at most {} mm from the trajectory at each time",
                        number(follow::TOLERANCE * 1e3, 3)
                    ),
                ],
                outputs,
                notes,
            })
        }
        (Points::Trajectory(..), _) => Err(GenerateError::TimedPoses),
        (Points::Joints(_) | Points::Poses(_), form) => {
            let moves = moves::moves(model, table, form)?;
            notes.extend(moves.notes.iter().cloned());
            let outputs = program::moves(&names, &moves)?;
            let duration_s = program::verify_moves(model, &outputs, &moves)?;
            Ok(Generated {
                points: moves.targets.len(),
                duration_s,
                measure: None,
                checks: vec![
                    "the emitted text parses".into(),
                    "every point is reached in its configuration".into(),
                    "every joint stays in its range".into(),
                ],
                outputs,
                notes,
            })
        }
    }
}

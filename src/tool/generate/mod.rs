//! Generates RAPID from points or a trajectory, then reads and simulates it.

mod error;
mod follow;
mod measure;
mod moves;
mod program;
mod settings;
pub mod table;

pub use error::GenerateError;
pub use measure::Measure;
pub use settings::{Form, Settings};

use crate::arm::robot::Model;
use crate::rapid::ir::number::number;
use crate::retime::path::joint_path::Joints;
use crate::tool::emit::GeneratedNames;
use crate::tool::retrofit::OutputFile;
use table::{Points, Table};

/// The generated program with figures of its simulation.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The files, with paths relative to the output folder.
    pub outputs: Vec<OutputFile>,
    /// Number of points in the emitted program.
    pub points: usize,
    /// Time from the first point to the last, s.
    pub duration_s: f64,
    /// Use of limits and distance from the trajectory; `None` for movements, which the controller
    /// plans.
    pub measure: Option<Measure>,
    /// The checks in words.
    pub checks: Vec<String>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// Generates a program from the points of a file.
///
/// # Errors
/// The robot, a point or a limit prevents the generation; the message states which.
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
    let names = GeneratedNames::from_file_name(&settings.name);
    let mut notes = table.notes.clone();
    if !model.has_dynamics() || model.limits.torque.is_none() {
        notes.push(format!(
            "{} has no dynamics or torque limits: torques are not checked",
            model.name
        ));
    }
    let mut generated = match (&table.points, settings.form) {
        (Points::Trajectory(t, q), Form::Egm) => positions(model, &names, t, q)?,
        (_, Form::Egm) => return Err(GenerateError::EgmWithoutTime),
        (Points::Trajectory(t, q), Form::AbsJ) => {
            if table.speeds.iter().chain(&table.zones).any(Option::is_some) {
                notes.push("speed and zone are not used: the times say how fast it goes".into());
            }
            stream(model, &names, (t, q), settings.spacing_s)?
        }
        (Points::Trajectory(..), _) => return Err(GenerateError::TimedPoses),
        (Points::Joints(_) | Points::Poses(_), form) => movements(model, &names, table, form)?,
    };
    notes.append(&mut generated.notes);
    Ok(Generated { notes, ..generated })
}

/// A trajectory as positions for externally guided motion.
fn positions(
    model: &Model,
    names: &GeneratedNames,
    t: &[f64],
    q: &[Joints],
) -> Result<Generated, GenerateError> {
    let followed = follow::sampled(model, t, q)?;
    Ok(Generated {
        outputs: program::egm(names, &followed)?,
        points: followed.positions.len(),
        duration_s: followed.duration(),
        measure: Some(followed.measure),
        checks: vec![
            "the module parses".into(),
            "the positions sent keep every joint limit".into(),
        ],
        notes: Vec::new(),
    })
}

/// A trajectory as a stream.
fn stream(
    model: &Model,
    names: &GeneratedNames,
    (t, q): (&[f64], &[Joints]),
    spacing_s: f64,
) -> Result<Generated, GenerateError> {
    let followed = follow::follow(model, t, q, spacing_s)?;
    let outputs = program::stream(names, &followed.stream)?;
    Ok(Generated {
        points: followed.stream.points().len(),
        duration_s: followed.stream.duration(),
        measure: Some(program::verify_stream(model, &outputs, &followed)?),
        checks: vec![
            "the emitted text parses".into(),
            "its motion keeps every limit between the points".into(),
            format!(
                "its motion is at most {} mm from the trajectory at each time",
                number(follow::TOLERANCE * 1e3, 3)
            ),
        ],
        outputs,
        notes: Vec::new(),
    })
}

/// Points as movements.
fn movements(
    model: &Model,
    names: &GeneratedNames,
    table: &Table,
    form: Form,
) -> Result<Generated, GenerateError> {
    let moves = moves::moves(model, table, form)?;
    let outputs = program::moves(names, &moves)?;
    Ok(Generated {
        points: moves.targets.len(),
        duration_s: program::verify_moves(model, &outputs, &moves)?,
        measure: None,
        checks: vec![
            "the emitted text parses".into(),
            "every point is reached in its configuration".into(),
            "every joint stays in its range".into(),
        ],
        outputs,
        notes: moves.notes,
    })
}

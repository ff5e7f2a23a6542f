//! Which runs a stream may replace.

use super::reason::Reason;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::{Movement, Settings};
use crate::rapid::ir::value::Dependence;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::{MoveRecord, Run};
use crate::retime::path::joint_path::{JointPath, PieceKind};

/// Whether a run may be replaced at all.
pub(super) fn eligibility(run: &Run, first: bool) -> Result<(), Reason> {
    if first {
        return Err(Reason::FirstMovement);
    }
    for record in &run.moves {
        movement_is_eligible(&record.movement)?;
    }
    if run.moves.iter().any(|record| !record.movement.tool.robhold) {
        return Err(Reason::Setting("a stationary tool".into()));
    }
    if run.moves.windows(2).any(|pair| pair[0].movement.tool != pair[1].movement.tool) {
        return Err(Reason::Setting("a change of tool".into()));
    }
    let limits = |record: &MoveRecord| {
        (record.movement.settings.limits(), record.movement.settings.axiswise_wrist())
    };
    if run.moves.windows(2).any(|pair| limits(&pair[0]) != limits(&pair[1])) {
        return Err(Reason::Setting("a change of VelSet, AccSet or SingArea".into()));
    }
    if !run.start_known {
        return Err(Reason::UnknownStart("a movement before it could not be worked out".into()));
    }
    if let Some(problem) = &run.problem {
        return Err(Reason::Path(problem.clone()));
    }
    match run.motions.as_slice() {
        [] => Err(Reason::NoMotion),
        [(_, TimedMotion::Path(path, _))] if passes_singularity(path) => {
            Err(Reason::Path("a line passes close to a singularity".into()))
        }
        [(_, TimedMotion::Path(path, _))] if path.legs().any(|leg| path.extent(leg).flat_arc) => {
            Err(Reason::Path("the three points of an arc lie on a line".into()))
        }
        [(_, TimedMotion::Path(..))] => Ok(()),
        [(_, TimedMotion::Stream(_))] => Err(Reason::Timed),
        _ => Err(Reason::SharpCorner),
    }
}

/// Whether joints move so fast along a line or arc (rad per m) that small model errors matter.
fn passes_singularity(path: &JointPath) -> bool {
    const NEAR_SINGULAR: f64 = 30.0;
    path.pieces().iter().any(|piece| {
        matches!(piece.kind, PieceKind::Cartesian | PieceKind::CartesianZone)
            && piece.eval(piece.s).q1.iter().any(|rate| rate.abs() > NEAR_SINGULAR)
    })
}

fn movement_is_eligible(movement: &Movement) -> Result<(), Reason> {
    if !movement.plain || movement.form == MoveForm::ExternalJoint {
        return Err(Reason::Instruction(movement.instruction.to_string()));
    }
    if movement.time.is_some() {
        return Err(Reason::Timed);
    }
    if movement.concurrent {
        return Err(Reason::Argument("Conc".into()));
    }
    if movement.total_load.is_some() {
        return Err(Reason::Argument("TLoad".into()));
    }
    if let Some(name) = movement.other_arguments.first() {
        return Err(Reason::Argument(name.to_string()));
    }
    let settings = &movement.settings;
    let bends_line = !settings.axiswise_wrist()
        && matches!(movement.form, MoveForm::Linear | MoveForm::Circular);
    match &settings.sing_area {
        Some(option) if bends_line => Err(Reason::Setting(option.to_string())),
        _ => settings_allow(settings),
    }
}

/// Why the arguments of a movement may change until the next run, if they may; an unconditional
/// replacement would then be wrong.
pub fn not_constant(movement: &Movement) -> Option<Reason> {
    let what = |dependence: &Dependence| match dependence {
        Dependence::Local(_) | Dependence::TrustedPersistent(_) => None,
        Dependence::Inner(name) => {
            Some(format!("it is computed from {name}, which only its function can name"))
        }
        Dependence::Variable(name) => {
            Some(format!("it is computed from the variable {name}, which the program changes"))
        }
        Dependence::Persistent(name) => {
            Some(format!("it uses PERS {name}, whose stored value can differ from the source"))
        }
        Dependence::Exposed(name, call) => {
            Some(format!("it uses {name}, which {call} may change: {call} is in no file given"))
        }
        Dependence::Input(name) => Some(format!("it is computed from the signal {name}")),
        Dependence::RobotState => Some("it is computed from where the robot stands".to_owned()),
    };
    movement.origin.iter().find_map(what).map(Reason::NotConstant)
}

fn settings_allow(settings: &Settings) -> Result<(), Reason> {
    let limits_path = settings.path_acceleration.iter().any(|limit| limit.is_finite());
    let in_force = [
        (settings.fine_point_ramp != 1.0, "AccSet\\FinePointRamp"),
        (settings.refresh != 1.0, "SpeedRefresh"),
        (limits_path, "PathAccLim"),
        (settings.world_acceleration.is_finite(), "WorldAccLim"),
        (settings.displacement.is_some(), "PDispSet"),
    ];
    let first = in_force.into_iter().find(|(is_set, _)| *is_set).map(|(_, name)| name.to_owned());
    let setting = first.or_else(|| settings.other.first().map(ToString::to_string));
    setting.map_or(Ok(()), |name| Err(Reason::Setting(name)))
}

//! Movement statements, with the facts that the text alone determines.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::data_names::DataNames;
use super::flow::Place;
use crate::rapid::builtins::{MoveForm, MoveKind, MoveSignature, movement};
use crate::rapid::ir::exec::evaluate;
use crate::rapid::ir::hir::{ArgKind, Call, Callee, Expr, ExprKind, Stmt};
use crate::rapid::ir::movement::{Movement, Speed, Target, Zone};
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::ir::value::Datum;
use crate::rapid::text::Span;

/// A movement statement.
#[derive(Debug)]
pub struct Site<'p> {
    /// Its place in the control flow.
    pub place: Place,
    /// The statement.
    pub stmt: &'p Stmt,
    /// The instruction as written.
    pub name: &'p str,
    /// Span of the instruction's name.
    pub name_span: Span,
    /// Its form.
    pub signature: MoveSignature,
    /// The argument with the target.
    pub target: &'p Expr,
    /// The argument with the speed.
    pub speed: &'p Expr,
    /// The argument with the zone.
    pub zone: Option<&'p Expr>,
    /// The argument with the tool.
    pub tool: Option<&'p Expr>,
    /// The work object.
    pub wobj: Option<&'p Expr>,
    /// Names of the options, in lower case.
    pub options: Vec<&'p str>,
    /// Whether it is reachable.
    pub reachable: bool,
    /// Whether it is the only statement of a compact `IF`.
    pub compact: bool,
    /// The known facts.
    pub facts: Facts,
    /// Its executions: indices into the trace.
    pub executions: Vec<usize>,
}

/// Facts of a movement that hold for every execution and need no robot.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// Its zone.
    pub zone: Option<Zone>,
    /// Its speed.
    pub speed: Option<Speed>,
    /// Its goal.
    pub goal: Option<Goal>,
}

/// What RAPID writes for an external axis that does not exist.
const NO_AXIS: f64 = 9e9;

/// The goal of a movement.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Where the robot goes.
    pub robot: RobotGoal,
    /// Where the external axes go, in RAPID's units, if it is known.
    external: Option<[f64; 6]>,
}

/// The goal of a robot.
#[derive(Clone, Debug, PartialEq)]
pub enum RobotGoal {
    /// Joints, rad.
    Joints([f64; 6]),
    /// A pose in a work object, m.
    Pose(Isometry3<f64>, [i32; 4]),
}

impl Goal {
    /// The pose; `None` for joints.
    pub fn pose(&self) -> Option<&Isometry3<f64>> {
        match &self.robot {
            RobotGoal::Pose(pose, _) => Some(pose),
            RobotGoal::Joints(_) => None,
        }
    }

    /// Whether two goals are equal.
    pub fn is_same(&self, other: &Goal) -> bool {
        /// m and rad.
        const TOLERANCE: f64 = 1e-5;
        let is_same_place = match (&self.robot, &other.robot) {
            (RobotGoal::Joints(a), RobotGoal::Joints(b)) => {
                a.iter().zip(b).all(|(a, b)| (a - b).abs() < TOLERANCE)
            }
            (RobotGoal::Pose(a, conf), RobotGoal::Pose(b, other)) => {
                conf == other
                    && (a.translation.vector - b.translation.vector).norm() < TOLERANCE
                    && a.rotation.angle_to(&b.rotation) < TOLERANCE
            }
            _ => false,
        };
        is_same_place && moves_no_axis(self.external.as_ref(), other.external.as_ref())
    }
}

/// Whether external axes stay between two goals. An axis with 9E9 does not exist; unknown goals differ.
fn moves_no_axis(a: Option<&[f64; 6]>, b: Option<&[f64; 6]>) -> bool {
    let is_still = |(a, b): (&f64, &f64)| a == b || a.max(*b) >= NO_AXIS;
    a.zip(b).is_some_and(|(a, b)| a.iter().zip(b).all(is_still))
}

impl Site<'_> {
    /// Whether it only moves, without options that couple it to other actions.
    pub fn is_plain(&self) -> bool {
        self.signature.kind == MoveKind::Plain
            && self.signature.form != MoveForm::ExternalJoint
            && self.options.iter().all(|key| {
                matches!(*key, "wobj" | "tool" | "speed" | "zone" | "topoint" | "tojointpos")
                    || matches!(*key, "noeoffs" | "v" | "cirpoint")
            })
    }

    /// Whether it is a line or an arc.
    pub fn is_linear(&self) -> bool {
        matches!(self.signature.form, MoveForm::Linear | MoveForm::Circular)
    }

    /// Whether it is a stop point.
    pub fn is_stop(&self) -> bool {
        self.facts.zone.is_some_and(|zone| zone.fine)
    }

    /// The lower-case name of the tool, if it is a name.
    pub fn tool_key(&self) -> Option<&str> {
        named(self.tool?)
    }

    /// The lower-case name of the work object; `wobj0` by default.
    pub fn wobj_key(&self) -> Option<&str> {
        self.wobj.map_or(Some("wobj0"), named)
    }
}

fn named(expr: &Expr) -> Option<&str> {
    match &expr.kind {
        ExprKind::Ref(name) => Some(&name.key),
        _ => None,
    }
}

/// The movement statement of a call; `None` for other instructions.
pub fn site<'p>(
    program: &Program,
    names: &DataNames<'_>,
    place: Place,
    stmt: &'p Stmt,
    call: &'p Call,
) -> Option<Site<'p>> {
    let Callee::Name(name) = &call.callee else { return None };
    let signature = movement(&name.key)?;
    let mut positional = Vec::new();
    let mut options: Vec<(&str, Option<&Expr>)> = Vec::new();
    for arg in &call.args {
        match &arg.kind {
            ArgKind::Positional(expr) => positional.push(expr),
            ArgKind::Named(name, expr) => options.push((&name.key, Some(expr))),
            ArgKind::Optional(name, expr) => options.push((&name.key, expr.as_ref())),
            ArgKind::Conditional(name, _) => options.push((&name.key, None)),
        }
    }
    let option = |key: &str| options.iter().find(|(k, _)| *k == key).and_then(|(_, expr)| *expr);
    let mut positional = positional.into_iter().skip(signature.before);
    let mut take = |key: &str| option(key).or_else(|| positional.next());
    if signature.form == MoveForm::Circular {
        take("cirpoint")?;
    }
    let target =
        if signature.form == MoveForm::AbsJ { take("tojointpos")? } else { take("topoint")? };
    let speed = take("speed")?;
    for _ in 0..signature.between {
        take("")?;
    }
    let zone = if signature.zone { Some(take("zone")?) } else { None };
    let tool = take("tool");
    let wobj = option("wobj");
    let value = |expr: &Expr| constant(program, names, place.0, expr);
    let stops = options.iter().any(|(key, _)| *key == "inpos");
    let own = options.iter().any(|(key, _)| *key == "z" || *key == "v" || *key == "t");
    let facts = Facts {
        zone: zone
            .and_then(value)
            .and_then(|datum| zone_of(&datum))
            .filter(|_| !own)
            .map(|zone| Zone { fine: zone.fine || stops, ..zone }),
        speed: value(speed).and_then(|datum| speed_of(&datum)).filter(|_| !own),
        goal: value(target).and_then(|datum| goal_of(&datum)),
    };
    Some(Site {
        place,
        stmt,
        name: &name.text,
        name_span: name.span,
        signature,
        target,
        speed,
        zone,
        tool,
        wobj,
        options: options.iter().map(|(key, _)| *key).collect(),
        reachable: true,
        compact: false,
        facts,
        executions: Vec::new(),
    })
}

/// The value of an expression if it is the same in every execution of its routine.
pub fn constant(
    program: &Program,
    names: &DataNames<'_>,
    routine: RoutineId,
    expr: &Expr,
) -> Option<Datum> {
    if reads_local(names, routine, expr) {
        return None;
    }
    let value = evaluate(program, routine.module, expr);
    value.datum.first_unknown().is_none().then_some(value.datum)
}

fn reads_local(names: &DataNames<'_>, routine: RoutineId, expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Ref(name) => names.is_local(routine, &name.key),
        ExprKind::Call(_, args)
            if args.iter().any(|arg| matches!(arg.kind, ArgKind::Conditional(..))) =>
        {
            true
        }
        _ => expr.parts().into_iter().any(|part| reads_local(names, routine, part)),
    }
}

/// The facts of an executed movement.
pub fn facts_of(movement: &Movement) -> Facts {
    let robot = match &movement.target {
        Target::Joints(q) => RobotGoal::Joints(*q),
        Target::Pose(target) => RobotGoal::Pose(target.pose, target.conf),
    };
    let goal = Goal { robot, external: movement.external };
    Facts { zone: Some(movement.zone), speed: Some(movement.speed), goal: Some(goal) }
}

/// The parts of a record or an array.
pub(super) fn parts(datum: &Datum) -> Option<&[Datum]> {
    match datum {
        Datum::List(parts) => Some(parts),
        _ => None,
    }
}

/// The numbers of an array.
pub(super) fn numbers(datum: &Datum) -> Option<Vec<f64>> {
    parts(datum)?.iter().map(Datum::num).collect()
}

fn zone_of(datum: &Datum) -> Option<Zone> {
    let (Datum::Bool(fine), rest) = parts(datum)?.split_first()? else { return None };
    let sizes = rest.iter().map(Datum::num).collect::<Option<Vec<f64>>>()?;
    let [tcp, orientation, _, angle, ..] = sizes.as_slice() else { return None };
    Some(Zone {
        fine: *fine,
        tcp: tcp.max(0.0) * 1e-3,
        orientation: orientation.max(*tcp) * 1e-3,
        angle: angle.to_radians(),
    })
}

fn speed_of(datum: &Datum) -> Option<Speed> {
    let [tcp, orientation, ..] = *numbers(datum)?.as_slice() else { return None };
    Some(Speed { tcp: tcp * 1e-3, orientation: orientation.to_radians() })
}

fn goal_of(datum: &Datum) -> Option<Goal> {
    let (external, robot) = parts(datum)?.split_last()?;
    let external = numbers(external).and_then(|axes| axes.try_into().ok());
    let robot = match robot {
        [joints] => {
            let joints: [f64; 6] = numbers(joints)?.try_into().ok()?;
            RobotGoal::Joints(joints.map(f64::to_radians))
        }
        [position, turn, conf] => {
            let [x, y, z] = *numbers(position)?.as_slice() else { return None };
            let [w, i, j, k] = *numbers(turn)?.as_slice() else { return None };
            let conf: [f64; 4] = numbers(conf)?.try_into().ok()?;
            let turn = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 0.5)?;
            let place = Translation3::from(Vector3::new(x, y, z) * 1e-3);
            RobotGoal::Pose(Isometry3::from_parts(place, turn), conf.map(|c| c.round() as i32))
        }
        _ => return None,
    };
    Some(Goal { robot, external })
}

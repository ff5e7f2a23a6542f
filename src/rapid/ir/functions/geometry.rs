//! Functions of positions, orientations, poses and targets.

use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::arguments::{EvaluatedArguments, Function, TypedDatum, num};
use crate::rapid::ir::convert;
use crate::rapid::ir::value::Datum;

/// Vectors shorter than this have no direction, mm.
const SHORTEST: f64 = 1e-6;

/// The function of a name in lower case.
pub(super) fn lookup(name: &str) -> Option<Function> {
    let function: Function = match name {
        "offs" => |g| {
            let offset = [g.num(1)?, g.num(2)?, g.num(3)?];
            Some((convert::offs(g.args.first()?, offset).ok()?, "robtarget"))
        },
        "reltool" => |g| {
            let offset = [g.num(1)?, g.num(2)?, g.num(3)?];
            let turn = [g.option("rx", 0.0)?, g.option("ry", 0.0)?, g.option("rz", 0.0)?];
            Some((convert::rel_tool(g.args.first()?, offset, turn).ok()?, "robtarget"))
        },
        "posemult" => |g| Some((convert::pose_datum(&(pose(g, 0)? * pose(g, 1)?)), "pose")),
        "poseinv" => |g| Some((convert::pose_datum(&pose(g, 0)?.inverse()), "pose")),
        "posevect" => |g| {
            let point = pose(g, 0)? * Point3::from(g.vector(1)? * 1e-3);
            Some((Datum::nums(point.coords.iter().map(|x| x * 1e3)), "pos"))
        },
        "orientzyx" => |g| {
            let [z, y, x] = [g.num(0)?, g.num(1)?, g.num(2)?].map(f64::to_radians);
            Some(orient(&UnitQuaternion::from_euler_angles(x, y, z)))
        },
        "eulerzyx" => euler_zyx,
        "norient" => |g| Some(orient(&direction(g)?)),
        "defframe" => define_frame,
        _ => return None,
    };
    Some(function)
}

/// `pos * pos`: cross product. `orient * orient`: second rotation in the frame of the first.
pub(in crate::rapid::ir) fn product(left: &Datum, right: &Datum) -> Option<Datum> {
    let vector = |datum| convert::nums::<3>(datum, "the vector").ok().map(Vector3::from);
    if let (Some(left), Some(right)) = (vector(left), vector(right)) {
        return Some(Datum::nums(left.cross(&right).iter().copied()));
    }
    let turn = |datum| {
        let [w, x, y, z] = convert::nums::<4>(datum, "the orientation").ok()?;
        Some(Quaternion::new(w, x, y, z))
    };
    let q = turn(left)? * turn(right)?;
    Some(Datum::nums([q.w, q.i, q.j, q.k]))
}

fn pose(arguments: &EvaluatedArguments<'_>, index: usize) -> Option<Isometry3<f64>> {
    convert::pose(arguments.args.get(index)?, "the pose").ok()
}

fn orient(rotation: &UnitQuaternion<f64>) -> TypedDatum {
    (Datum::nums([rotation.w, rotation.i, rotation.j, rotation.k]), "orient")
}

/// The first argument as a normalised orientation.
fn direction(arguments: &EvaluatedArguments<'_>) -> Option<UnitQuaternion<f64>> {
    let [w, x, y, z] = convert::nums::<4>(arguments.args.first()?, "the orientation").ok()?;
    UnitQuaternion::try_new(Quaternion::new(w, x, y, z), f64::EPSILON)
}

/// `EulerZYX(\X | \Y | \Z, orient)`
fn euler_zyx(arguments: &EvaluatedArguments<'_>) -> Option<TypedDatum> {
    let (x, y, z) = direction(arguments)?.euler_angles();
    let angle = match arguments.options.first()?.0 {
        "x" => x,
        "y" => y,
        "z" => z,
        _ => return None,
    };
    num(angle.to_degrees())
}

/// `DefFrame(p1, p2, p3 \Origin)`: x from p1 to p2, p3 at positive y. The origin is p1, with
/// `\Origin:=2` p2, with `\Origin:=3` the projection of p3 on the x axis.
fn define_frame(arguments: &EvaluatedArguments<'_>) -> Option<TypedDatum> {
    let [p1, p2, p3] = [point(arguments, 0)?, point(arguments, 1)?, point(arguments, 2)?];
    let x = (p2 - p1).try_normalize(SHORTEST)?;
    let along = p1 + x * x.dot(&(p3 - p1));
    let y = (p3 - along).try_normalize(SHORTEST)?;
    let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let origin = match arguments.option("origin", 1.0)? as u32 {
        1 => p1,
        2 => p2,
        3 => along,
        _ => return None,
    };
    let pose = Isometry3::from_parts((origin * 1e-3).into(), rotation);
    Some((convert::pose_datum(&pose), "pose"))
}

/// The position of a robtarget, mm.
fn point(arguments: &EvaluatedArguments<'_>, index: usize) -> Option<Vector3<f64>> {
    let Datum::List(parts) = arguments.args.get(index)? else { return None };
    convert::nums::<3>(parts.first()?, "the target").ok().map(Vector3::from)
}

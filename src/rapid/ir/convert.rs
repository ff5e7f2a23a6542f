//! From RAPID values (mm, degrees, aggregates) to SI data.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::movement::{LoadData, RobTarget, Speed, Stop, Tool, WorkObject, Zone};
use super::value::Datum;

const MM: f64 = 1e-3;
/// Largest deviation of an orientation's norm from 1 that the controller accepts.
const NORM_TOLERANCE: f64 = 0.01;

/// Largest mass of a load that is accepted as plausible, kg.
const HEAVIEST: f64 = 1e4;

type Converted<T> = Result<T, String>;

/// The numbers of a list with exactly `N` components.
pub(super) fn nums<const N: usize>(datum: &Datum, what: &str) -> Converted<[f64; N]> {
    let list = list(datum, what)?;
    if list.len() != N {
        return Err(format!("{what} has {} components instead of {N}", list.len()));
    }
    let mut out = [0.0; N];
    for (value, item) in out.iter_mut().zip(list) {
        *value = num(item, what)?;
    }
    Ok(out)
}

/// A finite number.
pub(super) fn num(datum: &Datum, what: &str) -> Converted<f64> {
    match datum {
        Datum::Num(x) if x.is_finite() => Ok(*x),
        Datum::Num(_) => Err(format!("{what} is out of the range of numbers")),
        Datum::Unknown(u) => Err(u.reason.clone()),
        Datum::Signal(name) => Err(format!("'{name}' is not declared in the files given")),
        _ => Err(format!("{what} is not a number")),
    }
}

fn list<'a>(datum: &'a Datum, what: &str) -> Converted<&'a [Datum]> {
    match datum {
        Datum::List(items) => Ok(items),
        Datum::Unknown(u) => Err(u.reason.clone()),
        Datum::Signal(name) => Err(format!("'{name}' is not declared in the files given")),
        _ => Err(format!("{what} is not an aggregate")),
    }
}

fn parts<'a, const N: usize>(datum: &'a Datum, what: &str) -> Converted<&'a [Datum; N]> {
    let items = list(datum, what)?;
    items.try_into().map_err(|_| format!("{what} has {} components instead of {N}", items.len()))
}

fn boolean(datum: &Datum, what: &str) -> Converted<bool> {
    match datum {
        Datum::Bool(b) => Ok(*b),
        Datum::Unknown(u) => Err(u.reason.clone()),
        _ => Err(format!("{what} is not TRUE or FALSE")),
    }
}

fn orient(datum: &Datum, what: &str) -> Converted<UnitQuaternion<f64>> {
    let [w, x, y, z] = nums::<4>(datum, what)?;
    let quaternion = Quaternion::new(w, x, y, z);
    if (quaternion.norm() - 1.0).abs() > NORM_TOLERANCE {
        return Err(format!("{what} is not a unit quaternion (norm {:.4})", quaternion.norm()));
    }
    Ok(UnitQuaternion::from_quaternion(quaternion))
}

/// A `pose`.
pub(super) fn pose(datum: &Datum, what: &str) -> Converted<Isometry3<f64>> {
    let [trans, rot] = parts::<2>(datum, what)?;
    frame(trans, rot, what)
}

fn frame(trans: &Datum, rot: &Datum, what: &str) -> Converted<Isometry3<f64>> {
    let [x, y, z] = nums::<3>(trans, what)?;
    let rotation = orient(rot, &format!("orientation of {what}"))?;
    Ok(Isometry3::from_parts(Translation3::new(x * MM, y * MM, z * MM), rotation))
}

/// The inverse of [`pose`].
pub(super) fn pose_datum(pose: &Isometry3<f64>) -> Datum {
    Datum::List(pose_parts(pose).to_vec())
}

/// `trans` and `rot` of a `pose`.
pub(super) fn pose_parts(pose: &Isometry3<f64>) -> [Datum; 2] {
    let t = pose.translation.vector / MM;
    let q = pose.rotation;
    [Datum::nums([t.x, t.y, t.z]), Datum::nums([q.w, q.i, q.j, q.k])]
}

/// The external axes of a `robtarget` or `jointtarget`, in RAPID's units.
pub(super) fn external(target: &Datum) -> Option<[f64; 6]> {
    nums(list(target, "the target").ok()?.last()?, "the external axes").ok()
}

/// A `robtarget` without its external axes.
pub(super) fn robtarget(datum: &Datum) -> Converted<RobTarget> {
    let [trans, rot, conf, _] = parts::<4>(datum, "the robtarget")?;
    let conf = nums::<4>(conf, "the configuration")?;
    Ok(RobTarget {
        pose: frame(trans, rot, "the robtarget")?,
        conf: conf.map(|c| c.round() as i32),
    })
}

/// The robot axes of a `jointtarget`, rad.
pub(super) fn jointtarget(datum: &Datum) -> Converted<[f64; 6]> {
    let [joints, _] = parts::<2>(datum, "the jointtarget")?;
    Ok(nums::<6>(joints, "the jointtarget")?.map(f64::to_radians))
}

/// A `speeddata`.
pub(super) fn speed(datum: &Datum) -> Converted<Speed> {
    let [tcp, ori, _, _] = nums::<4>(datum, "the speed")?;
    if tcp <= 0.0 || ori <= 0.0 {
        return Err("the programmed speed is not positive".into());
    }
    Ok(Speed { tcp: tcp * MM, orientation: ori.to_radians() })
}

/// A `zonedata`.
pub(super) fn zone(datum: &Datum) -> Converted<Zone> {
    let [fine, sizes @ ..] = parts::<7>(datum, "the zone")?;
    let [tcp, ori, _, angle, _, _] =
        nums::<6>(&Datum::List(sizes.to_vec()), "the zone")?.map(|x| x.max(0.0));
    Ok(Zone {
        fine: boolean(fine, "finep of the zone")?,
        tcp: tcp * MM,
        // The controller raises pzone_ori to pzone_tcp.
        orientation: ori.max(tcp) * MM,
        angle: angle.to_radians(),
    })
}

/// A `stoppointdata`.
pub(super) fn stop(datum: &Datum) -> Converted<Stop> {
    const WHAT: &str = "the stop point";
    let [kind, _, inpos, stop_time, follow_time, ..] = parts::<8>(datum, WHAT)?;
    let time = |datum: &Datum| Ok(Stop::Time(num(datum, WHAT)?.max(0.0)));
    match num(kind, WHAT)? {
        1.0 => {
            let [position, speed, least, most] = nums::<4>(inpos, WHAT)?;
            let share = (position.min(speed) / 100.0).max(0.0);
            let least = least.max(0.0);
            Ok(Stop::InPosition { share, least, most: most.max(least) })
        }
        2.0 => time(stop_time),
        3.0 => time(follow_time),
        kind => Err(format!("{WHAT} has the type {kind}: give inpos, stoptime or fllwtime")),
    }
}

/// A `loaddata`.
pub(super) fn load(datum: &Datum) -> Converted<LoadData> {
    let [mass, cog, axes, ix, iy, iz] = parts::<6>(datum, "the load")?;
    let mass = num(mass, "the mass of the load")?;
    if mass < 0.0 {
        return Err("the mass of the load is negative".into());
    }
    if mass > HEAVIEST {
        return Err(format!("the mass of the load is {mass:e} kg, more than any robot carries"));
    }
    let inertia = |datum| num(datum, "inertia of the load");
    let axes = orient(axes, "axes of the load")?;
    Ok(LoadData {
        mass,
        com: nums::<3>(cog, "the centre of gravity")?.map(|x| x * MM),
        inertia: [inertia(ix)?, inertia(iy)?, inertia(iz)?],
        axes: [axes.w, axes.i, axes.j, axes.k],
    })
}

/// A `tooldata` of this name.
pub(super) fn tool(datum: &Datum, name: &str) -> Converted<Tool> {
    let [robhold, tframe, tload] = parts::<3>(datum, "the tool")?;
    Ok(Tool {
        name: name.into(),
        robhold: boolean(robhold, "robhold of the tool")?,
        frame: pose(tframe, "the tool frame")?,
        load: load(tload)?,
    })
}

/// A `wobjdata`.
pub(super) fn work_object(datum: &Datum) -> Converted<WorkObject> {
    let [robhold, fixed, _, user, object] = parts::<5>(datum, "the work object")?;
    Ok(WorkObject {
        robhold: boolean(robhold, "robhold of the work object")?,
        fixed: boolean(fixed, "ufprog of the work object")?,
        frame: pose(user, "the user frame")? * pose(object, "the object frame")?,
    })
}

/// `Offs`: displaced in the object frame, mm.
pub(super) fn offs(target: &Datum, offset: [f64; 3]) -> Converted<Datum> {
    let [trans, rot, conf, external] = parts::<4>(target, "the robtarget")?;
    let [x, y, z] = nums::<3>(trans, "the robtarget")?;
    let moved = Datum::nums([x + offset[0], y + offset[1], z + offset[2]]);
    Ok(Datum::List(vec![moved, rot.clone(), conf.clone(), external.clone()]))
}

/// `RelTool`: displaced (mm) and then turned (degrees, about x, y, z in this order)
/// in the tool's frame.
pub(super) fn rel_tool(target: &Datum, offset: [f64; 3], turn: [f64; 3]) -> Converted<Datum> {
    let [trans, rot, conf, external] = parts::<4>(target, "the robtarget")?;
    let frame = frame(trans, rot, "the robtarget")?;
    let [rx, ry, rz] = turn.map(f64::to_radians);
    let turned = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), rx)
        * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), ry)
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), rz);
    let [dx, dy, dz] = offset;
    let moved = frame * Isometry3::from_parts(Translation3::new(dx * MM, dy * MM, dz * MM), turned);
    let [trans, rot] = pose_parts(&moved);
    Ok(Datum::List(vec![trans, rot, conf.clone(), external.clone()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(trans: [f64; 3], rot: [f64; 4]) -> Datum {
        Datum::List(vec![
            Datum::nums(trans),
            Datum::nums(rot),
            Datum::nums([0.0; 4]),
            Datum::nums([9e9; 6]),
        ])
    }

    #[test]
    fn rel_tool_moves_along_the_tools_axes() {
        // A tool that points down: its z is -z of the object frame.
        let down = target([600.0, 0.0, 400.0], [0.0, 0.0, 1.0, 0.0]);
        let moved = rel_tool(&down, [0.0, 0.0, 50.0], [0.0; 3]).expect("valid");
        let pose = robtarget(&moved).expect("valid").pose;
        assert!((pose.translation.z - 0.350).abs() < 1e-12);
        assert!((pose.translation.x - 0.600).abs() < 1e-12);
    }

    #[test]
    fn wrong_quaternions_and_lengths_are_named() {
        let bad = robtarget(&target([0.0; 3], [1.0, 1.0, 0.0, 0.0])).expect_err("norm");
        assert!(bad.contains("unit quaternion"), "{bad}");
        let short = jointtarget(&Datum::List(vec![Datum::nums([0.0; 5]), Datum::nums([9e9; 6])]));
        assert!(short.expect_err("short").contains("5 components instead of 6"));
    }
}

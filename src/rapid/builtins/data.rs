//! Predefined data and error numbers.
//!
//! Values: RAPID reference of `RobotWare` 6 (speeddata, zonedata, stoppointdata).

/// Predefined speeds `vN`, mm/s; the last two in `RobotWare` 5 and later.
const SPEEDS: [u32; 25] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500,
    3000, 4000, 5000, 6000, 7000,
];
/// TCP speed of `vmax` unless the robot states another, mm/s.
const VMAX: f64 = 7000.0;
/// Speeds of reorientation (°/s), linear (mm/s) and rotating (°/s) external axes of all `vN`.
const OTHER_SPEEDS: [f64; 3] = [500.0, 5000.0, 1000.0];

/// Predefined speeds `vrotN` of rotating external axes, °/s.
const TURNING: [u32; 7] = [1, 2, 5, 10, 20, 50, 100];
/// Predefined speeds `vlinN` of linear external axes, mm/s.
const LINEAR: [u32; 7] = [10, 20, 50, 100, 200, 500, 1000];
/// Stop points `inposN`: % of the errors of position and speed that `fine` allows.
const IN_POSITION: [u32; 3] = [20, 50, 100];
/// Longest waiting time of `inposN`, s.
const IN_POSITION_WAIT: f64 = 2.0;
/// Stop points `stoptimeT` and `fllwtimeT`, s.
const STOP_TIMES: [(&str, f64); 3] = [("0_5", 0.5), ("1_0", 1.0), ("1_5", 1.5)];

/// `zN`: `pzone_tcp, pzone_ori, pzone_eax` (mm), `zone_ori` (deg), `zone_leax, zone_reax`.
const ZONES: [(&str, [f64; 6]); 15] = [
    ("z0", [0.3, 0.3, 0.3, 0.03, 0.3, 0.03]),
    ("z1", [1.0, 1.0, 1.0, 0.1, 1.0, 0.1]),
    ("z5", [5.0, 8.0, 8.0, 0.8, 8.0, 0.8]),
    ("z10", [10.0, 15.0, 15.0, 1.5, 15.0, 1.5]),
    ("z15", [15.0, 23.0, 23.0, 2.3, 23.0, 2.3]),
    ("z20", [20.0, 30.0, 30.0, 3.0, 30.0, 3.0]),
    ("z30", [30.0, 45.0, 45.0, 4.5, 45.0, 4.5]),
    ("z40", [40.0, 60.0, 60.0, 6.0, 60.0, 6.0]),
    ("z50", [50.0, 75.0, 75.0, 7.5, 75.0, 7.5]),
    ("z60", [60.0, 90.0, 90.0, 9.0, 90.0, 9.0]),
    ("z80", [80.0, 120.0, 120.0, 12.0, 120.0, 12.0]),
    ("z100", [100.0, 150.0, 150.0, 15.0, 150.0, 15.0]),
    ("z150", [150.0, 225.0, 225.0, 23.0, 225.0, 23.0]),
    ("z200", [200.0, 300.0, 300.0, 30.0, 300.0, 30.0]),
    ("fine", [0.0; 6]),
];

/// The cause of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A movement without process or `\Conc`, while it runs.
    Movement,
    /// The evaluation of an argument: a division by zero, an index out of range.
    Argument,
    /// Something else.
    Other,
}

/// Error numbers for comparison with `ERRNO`, and their causes. Sorted by name.
const ERRORS: [(&str, Cause); 21] = [
    ("ERR_ACC_TOO_LOW", Cause::Other),
    ("ERR_AO_LIM", Cause::Other),
    ("ERR_ARRAYINDEX", Cause::Argument),
    ("ERR_COLL_STOP", Cause::Movement),
    ("ERR_CONC_MAX", Cause::Other),
    ("ERR_DIVZERO", Cause::Argument),
    ("ERR_FILEOPEN", Cause::Other),
    ("ERR_GO_LIM", Cause::Other),
    ("ERR_NORUNUNIT", Cause::Other),
    ("ERR_NO_ALIASIO_DEF", Cause::Other),
    ("ERR_OUTOFBND", Cause::Other),
    ("ERR_PATH_STOP", Cause::Movement),
    ("ERR_ROBLIMIT", Cause::Other),
    ("ERR_SIGSUPSEARCH", Cause::Other),
    ("ERR_SIG_NOT_VALID", Cause::Other),
    ("ERR_SOCK_CLOSED", Cause::Other),
    ("ERR_SOCK_TIMEOUT", Cause::Other),
    ("ERR_SPEED_REFRESH_LIM", Cause::Other),
    ("ERR_WAIT_MAXTIME", Cause::Other),
    ("ERR_WHLSEARCH", Cause::Other),
    ("LONG_JMP_ALL_ERR", Cause::Movement),
];
/// Error numbers without a value here: a comparison with one is not evaluated.
const WITHOUT_VALUE: [&str; 3] = ["ERR_ARRAYINDEX", "ERR_COLL_STOP", "LONG_JMP_ALL_ERR"];

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    /// A number.
    Num(f64),
    /// `TRUE` or `FALSE`.
    Bool(bool),
    /// A string, or the name of an error number.
    Text(&'static str),
    /// The components of a record.
    List(Vec<Literal>),
}

/// A predefined constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Predefined {
    /// Its type, in lower case.
    pub type_name: &'static str,
    /// Its value.
    pub value: Literal,
}

/// Names of the predefined zones and their `pzone_tcp`, mm, from the smallest one.
pub fn zones() -> impl Iterator<Item = (&'static str, f64)> {
    ZONES.iter().filter(|(name, _)| *name != "fine").map(|(name, sizes)| (*name, sizes[0]))
}

/// The predefined speeds `vN`, mm/s, from the slowest one.
pub fn speeds() -> impl Iterator<Item = u32> {
    SPEEDS.into_iter()
}

/// The cause of an error number; `key` in lower case.
pub fn error(key: &str) -> Option<Cause> {
    error_entry(key).map(|(_, cause)| cause)
}

fn error_entry(key: &str) -> Option<(&'static str, Cause)> {
    ERRORS.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(key))
}

/// Whether predefined data of this name (lower case) differ between controllers: `vmax` depends
/// on the robot; `tool0`, `wobj0` and `load0` depend on the version.
pub fn is_controller_specific(key: &str) -> bool {
    matches!(key, "vmax" | "tool0" | "wobj0" | "load0")
}

/// The predefined constant of this name; `key` in lower case.
pub fn predefined(key: &str) -> Option<Predefined> {
    let of = |type_name, value| Some(Predefined { type_name, value });
    let num = |type_name, value| of(type_name, Literal::Num(value));
    let list = |type_name, parts| of(type_name, Literal::List(parts));
    match key {
        "vmax" => Some(speed([VMAX, OTHER_SPEEDS[0], OTHER_SPEEDS[1], OTHER_SPEEDS[2]])),
        "tool0" => list("tooldata", vec![Literal::Bool(true), identity_pose(), light_load()]),
        "wobj0" => {
            let mut parts = vec![Literal::Bool(false), Literal::Bool(true), Literal::Text("")];
            parts.extend([identity_pose(), identity_pose()]);
            list("wobjdata", parts)
        }
        "load0" => of("loaddata", light_load()),
        "pi" => num("num", std::f64::consts::PI),
        "high" | "edge" => num("num", 1.0),
        "low" => num("num", 0.0),
        "inpos" => num("stoppoint", 1.0),
        "stoptime" => num("stoppoint", 2.0),
        "fllwtime" => num("stoppoint", 3.0),
        "stempty" => of("string", Literal::Text("")),
        _ => zone(key).or_else(|| error_number(key)).or_else(|| numbered(key)),
    }
}

fn error_number(key: &str) -> Option<Predefined> {
    let (name, _) = error_entry(key).filter(|(name, _)| !WITHOUT_VALUE.contains(name))?;
    Some(Predefined { type_name: "errnum", value: Literal::Text(name) })
}

/// Data with a number in their name: `v100`, `vrot10`, `inpos50`, `stoptime0_5`.
fn numbered(key: &str) -> Option<Predefined> {
    let [ori, leax, reax] = OTHER_SPEEDS;
    let number = |prefix: &str, list: &[u32]| known(key.strip_prefix(prefix)?, list);
    let time = |prefix: &str| {
        let text = key.strip_prefix(prefix)?;
        STOP_TIMES.iter().find(|(name, _)| *name == text).map(|(_, seconds)| *seconds)
    };
    number("inpos", &IN_POSITION)
        .map(|percent| stop(1.0, percent, 0.0, 0.0))
        .or_else(|| time("stoptime").map(|seconds| stop(2.0, 0.0, seconds, 0.0)))
        .or_else(|| time("fllwtime").map(|seconds| stop(3.0, 0.0, 0.0, seconds)))
        .or_else(|| number("vrot", &TURNING).map(|v| speed([0.0, 0.0, 0.0, v])))
        .or_else(|| number("vlin", &LINEAR).map(|v| speed([0.0, 0.0, v, 0.0])))
        .or_else(|| number("v", &SPEEDS).map(|v| speed([v, ori, leax, reax])))
}

/// The number in a name, if the list contains it.
fn known(text: &str, list: &[u32]) -> Option<f64> {
    let number: u32 = text.parse().ok()?;
    list.contains(&number).then_some(f64::from(number))
}

fn nums<const N: usize>(values: [f64; N]) -> Literal {
    Literal::List(values.map(Literal::Num).to_vec())
}

/// The mass of `tool0` and `load0` is 1 g: the controller rejects a mass of 0.
fn light_load() -> Literal {
    let mut parts = vec![Literal::Num(0.001), nums([0.0, 0.0, 0.001]), nums([1.0, 0.0, 0.0, 0.0])];
    parts.extend([0.0; 3].map(Literal::Num));
    Literal::List(parts)
}

fn identity_pose() -> Literal {
    Literal::List(vec![nums([0.0; 3]), nums([1.0, 0.0, 0.0, 0.0])])
}

/// `v_tcp, v_ori, v_leax, v_reax`
fn speed(speeds: [f64; 4]) -> Predefined {
    Predefined { type_name: "speeddata", value: nums(speeds) }
}

/// A stop point of this type: % of the errors of `fine`, stop time and follow time, s.
fn stop(kind: f64, percent: f64, stands: f64, follows: f64) -> Predefined {
    let inpos = if percent > 0.0 { [percent, percent, 0.0, IN_POSITION_WAIT] } else { [0.0; 4] };
    let value = Literal::List(vec![
        Literal::Num(kind),
        Literal::Bool(stands <= 0.0),
        nums(inpos),
        Literal::Num(stands),
        Literal::Num(follows),
        Literal::Text(""),
        Literal::Num(0.0),
        Literal::Num(0.0),
    ]);
    Predefined { type_name: "stoppointdata", value }
}

fn zone(key: &str) -> Option<Predefined> {
    let (_, sizes) = ZONES.iter().find(|(name, _)| *name == key)?;
    let fine = Literal::Bool(key == "fine");
    let list = std::iter::once(fine).chain(sizes.map(Literal::Num)).collect();
    Some(Predefined { type_name: "zonedata", value: Literal::List(list) })
}

//! Names that every controller knows: speeds, zones, tool0, wobj0, load0.
//!
//! Values: RAPID reference of `RobotWare` 6 (speeddata, zonedata).

use super::value::{Datum, Value};

/// Speeds that exist as `vN`, mm/s.
const SPEEDS: [u32; 23] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500,
    3000, 4000, 5000,
];
/// The two above, of `RobotWare` 5 and later.
const FAST_SPEEDS: [u32; 2] = [6000, 7000];
/// TCP speed of `vmax` where the robot does not state another, mm/s.
const VMAX: f64 = 7000.0;
/// Reorientation, linear and rotating external axis speed of all `vN`.
const OTHER_SPEEDS: [f64; 3] = [500.0, 5000.0, 1000.0];

/// Speeds of turning external axes that exist as `vrotN`, °/s.
const TURNING: [u32; 7] = [1, 2, 5, 10, 20, 50, 100];
/// Speeds of linear external axes that exist as `vlinN`, mm/s.
const LINEAR: [u32; 7] = [10, 20, 50, 100, 200, 500, 1000];
/// Stop points `inposN`: % of the errors of position and speed that `fine` allows.
const IN_POSITION: [u32; 3] = [20, 50, 100];
/// Longest time that they wait, s.
const IN_POSITION_WAIT: f64 = 2.0;
/// Stop points `stoptimeT` and `fllwtimeT`, s.
const STOP_TIMES: [(&str, f64); 3] = [("0_5", 0.5), ("1_0", 1.0), ("1_5", 1.5)];

/// Error numbers that handlers compare `ERRNO` with; a number stands for itself here.
const ERRORS: [&str; 18] = [
    "err_acc_too_low",
    "err_ao_lim",
    "err_conc_max",
    "err_divzero",
    "err_fileopen",
    "err_go_lim",
    "err_no_aliasio_def",
    "err_norununit",
    "err_outofbnd",
    "err_path_stop",
    "err_roblimit",
    "err_sig_not_valid",
    "err_sigsupsearch",
    "err_sock_closed",
    "err_sock_timeout",
    "err_speed_refresh_lim",
    "err_wait_maxtime",
    "err_whlsearch",
];

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

/// The value of a predefined name; `key` in lower case.
pub fn lookup(key: &str) -> Option<Value> {
    if let Some((_, sizes)) = ZONES.iter().find(|(name, _)| *name == key) {
        return Some(zone(key == "fine", *sizes));
    }
    Some(match key {
        "vmax" => speed(VMAX),
        "tool0" => Value::constant(
            Datum::List(vec![Datum::Bool(true), identity_pose(), light_load()]),
            "tooldata",
        ),
        "wobj0" => Value::constant(
            Datum::List(vec![
                Datum::Bool(false),
                Datum::Bool(true),
                Datum::Text("".into()),
                identity_pose(),
                identity_pose(),
            ]),
            "wobjdata",
        ),
        "load0" => Value::constant(light_load(), "loaddata"),
        "pi" => Value::constant(Datum::Num(std::f64::consts::PI), "num"),
        "high" | "edge" => Value::constant(Datum::Num(1.0), "num"),
        "low" => Value::constant(Datum::Num(0.0), "num"),
        "inpos" => Value::constant(Datum::Num(1.0), "stoppoint"),
        "stoptime" => Value::constant(Datum::Num(2.0), "stoppoint"),
        "fllwtime" => Value::constant(Datum::Num(3.0), "stoppoint"),
        "stempty" => Value::constant(Datum::Text("".into()), "string"),
        _ if ERRORS.contains(&key) => {
            Value::constant(Datum::Text(key.to_uppercase().into()), "errnum")
        }
        _ => {
            if let Some(share) = key.strip_prefix("inpos") {
                return known(share, &IN_POSITION).map(|share| stop(1.0, share, 0.0, 0.0));
            }
            for (prefix, kind) in [("stoptime", 2.0), ("fllwtime", 3.0)] {
                if let Some(seconds) = key.strip_prefix(prefix) {
                    let (_, time) = STOP_TIMES.iter().find(|(name, _)| *name == seconds)?;
                    let (stands, follows) = if kind < 3.0 { (*time, 0.0) } else { (0.0, *time) };
                    return Some(stop(kind, 0.0, stands, follows));
                }
            }
            if let Some(turning) = key.strip_prefix("vrot") {
                return known(turning, &TURNING).map(|v| external_speed([0.0, v]));
            }
            if let Some(linear) = key.strip_prefix("vlin") {
                return known(linear, &LINEAR).map(|v| external_speed([v, 0.0]));
            }
            let number: u32 = key.strip_prefix('v')?.parse().ok()?;
            let known = SPEEDS.contains(&number) || FAST_SPEEDS.contains(&number);
            return known.then(|| speed(f64::from(number)));
        }
    })
}

/// The controller refuses a mass of 0: `tool0` and `load0` weigh a gram.
fn light_load() -> Datum {
    Datum::List(vec![
        Datum::Num(0.001),
        Datum::nums([0.0, 0.0, 0.001]),
        Datum::nums([1.0, 0.0, 0.0, 0.0]),
        Datum::Num(0.0),
        Datum::Num(0.0),
        Datum::Num(0.0),
    ])
}

fn identity_pose() -> Datum {
    Datum::List(vec![Datum::nums([0.0; 3]), Datum::nums([1.0, 0.0, 0.0, 0.0])])
}

/// The number in a name, if it is one of the list.
fn known(text: &str, list: &[u32]) -> Option<f64> {
    let number: u32 = text.parse().ok()?;
    list.contains(&number).then_some(f64::from(number))
}

/// A `speeddata` for external axes alone: linear and turning.
fn external_speed([linear, turning]: [f64; 2]) -> Value {
    Value::constant(Datum::nums([0.0, 0.0, linear, turning]), "speeddata")
}

/// A `stoppointdata`.
fn stop(kind: f64, share: f64, stands: f64, follows: f64) -> Value {
    let inpos = if share > 0.0 { [share, share, 0.0, IN_POSITION_WAIT] } else { [0.0; 4] };
    let list = vec![
        Datum::Num(kind),
        Datum::Bool(stands <= 0.0),
        Datum::nums(inpos),
        Datum::Num(stands),
        Datum::Num(follows),
        Datum::Text("".into()),
        Datum::Num(0.0),
        Datum::Num(0.0),
    ];
    Value::constant(Datum::List(list), "stoppointdata")
}

fn speed(v_tcp: f64) -> Value {
    let [ori, leax, reax] = OTHER_SPEEDS;
    Value::constant(Datum::nums([v_tcp, ori, leax, reax]), "speeddata")
}

fn zone(fine: bool, sizes: [f64; 6]) -> Value {
    let mut list = vec![Datum::Bool(fine)];
    list.extend(sizes.map(Datum::Num));
    Value::constant(Datum::List(list), "zonedata")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_and_zones_have_the_manuals_values() {
        let speed = lookup("v1500").map(|v| v.datum);
        assert_eq!(speed, Some(Datum::nums([1500.0, 500.0, 5000.0, 1000.0])));
        assert!(lookup("v1501").is_none());
        let Some(Value { datum: Datum::List(z50), .. }) = lookup("z50") else {
            unreachable!("z50 is predefined")
        };
        assert_eq!(z50[0], Datum::Bool(false));
        assert_eq!(z50[4], Datum::Num(7.5));
    }
}

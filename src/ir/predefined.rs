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
        "stempty" => Value::constant(Datum::Text("".into()), "string"),
        _ => {
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
        nums(&[0.0, 0.0, 0.001]),
        nums(&[1.0, 0.0, 0.0, 0.0]),
        Datum::Num(0.0),
        Datum::Num(0.0),
        Datum::Num(0.0),
    ])
}

fn nums(values: &[f64]) -> Datum {
    Datum::List(values.iter().copied().map(Datum::Num).collect())
}

fn identity_pose() -> Datum {
    Datum::List(vec![nums(&[0.0; 3]), nums(&[1.0, 0.0, 0.0, 0.0])])
}

fn speed(v_tcp: f64) -> Value {
    let [ori, leax, reax] = OTHER_SPEEDS;
    Value::constant(nums(&[v_tcp, ori, leax, reax]), "speeddata")
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
        assert_eq!(speed, Some(nums(&[1500.0, 500.0, 5000.0, 1000.0])));
        assert!(lookup("v1501").is_none());
        let Some(Value { datum: Datum::List(z50), .. }) = lookup("z50") else {
            unreachable!("z50 is predefined")
        };
        assert_eq!(z50[0], Datum::Bool(false));
        assert_eq!(z50[4], Datum::Num(7.5));
    }
}

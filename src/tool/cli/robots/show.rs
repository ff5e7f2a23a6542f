//! `joulepath robots show`: the data of a robot.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde_json::{Value, json};

use crate::arm::effects;
use crate::arm::robot::prior::{Plausible, Spread};
use crate::arm::robot::{Model, Provenance};
use crate::retime::energy::plausible::{DRAWS, Interval};
use crate::tool::cli::common::{Format, print};

pub(super) fn run(robot: &str, format: Format) -> anyhow::Result<ExitCode> {
    let model = effects::load_estimated(robot)?;
    print(format, || document(&model), || text(&model))
}

fn text(model: &Model) -> String {
    let mut text = format!("{}, {} joints\n", model.name, model.dof);
    let degrees = |list: &[f64]| {
        list.iter().map(|x| format!("{:.1}", x.to_degrees())).collect::<Vec<_>>().join(" ")
    };
    // Two decimals at most, and no -0.
    let shown = |angle: f64| (angle.to_degrees() * 100.0).round() / 100.0 + 0.0;
    let range = |[low, high]: &[f64; 2]| format!("{}…{}", shown(*low), shown(*high));
    let ranges: Vec<String> = model.limits.position.iter().map(range).collect();
    let _ = writeln!(text, "position deg: {}", ranges.join(" "));
    for wider in &model.limits.position_if {
        let _ = writeln!(
            text,
            "  axis {}: {} while axis {} is within {}",
            wider.joint + 1,
            range(&wider.position),
            wider.if_joint + 1,
            range(&wider.if_within)
        );
    }
    if let Some(coupled) = &model.limits.coupled {
        let _ = writeln!(text, "  axis 3 minus axis 2: {}", range(coupled));
    }
    for (what, list) in [
        ("speed deg/s", &model.limits.velocity),
        ("acceleration deg/s2", &model.limits.acceleration),
    ] {
        let figures = list.as_ref().map_or_else(|| "not known".into(), |list| degrees(list));
        let _ = writeln!(text, "{what}: {figures}");
    }
    let estimated = model.provenance_of("link 1", "mass") == Some(Provenance::Estimated);
    let dynamics = if estimated {
        "estimated"
    } else if model.has_dynamics() {
        "yes"
    } else {
        "no: energies can't be computed"
    };
    let _ = writeln!(text, "dynamics: {dynamics}");
    if let Some(calibration) = &model.calibration {
        let _ = writeln!(text, "calibrated: {} robots fit the log", calibration.robots);
    }
    let figures = figures(model);
    if !figures.is_empty() {
        let _ = writeln!(text, "\n{:<29} {:<11} {:>9}  90 % within", "figure", "known", "value");
    }
    for Figure { what, provenance, value, range: Interval { low, high, .. } } in &figures {
        let known = provenance.map_or_else(String::new, |it| it.to_string());
        let [value, low, high] = [*value, *low, *high].map(three_figures);
        let _ = writeln!(text, "{what:<29} {known:<11} {value:>9}  {low} to {high}");
    }
    for (title, lines) in [("estimated", model.estimated()), ("assumed", model.assumed())] {
        if !lines.is_empty() {
            let _ = writeln!(text, "\n{title}:");
        }
        for line in lines {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

/// A number with three significant figures.
fn three_figures(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let digits = 2 - x.abs().log10().floor() as i32;
    if (0..=5).contains(&digits) {
        format!("{x:.0$}", digits as usize)
    } else if digits < 0 {
        format!("{x:.0}")
    } else {
        format!("{x:.2e}")
    }
}

/// A figure of the dynamics with its uncertainty.
struct Figure {
    what: String,
    provenance: Option<Provenance>,
    value: f64,
    /// Its interval over plausible robots.
    range: Interval,
}

/// Label, table and key, value of a joint.
type JointFigure = (&'static str, [&'static str; 2], fn(&Plausible, usize) -> f64);
/// The same for the whole robot.
type RobotFigure = (&'static str, [&'static str; 2], fn(&Plausible) -> f64);

/// All quantities in which plausible robots differ; empty without dynamics.
fn figures(model: &Model) -> Vec<Figure> {
    if !model.has_dynamics() {
        return Vec::new();
    }
    let robots = Spread::new(model).draws(model, DRAWS).robots;
    let own = Plausible::nominal(model);
    let figure = |what: String, table: &str, key: &str, of: &dyn Fn(&Plausible) -> f64| {
        let values: Vec<f64> = robots.iter().map(of).collect();
        let value = of(&own);
        let one = Interval { median: value, low: value, high: value };
        Figure {
            what,
            provenance: model.provenance_of(table, key),
            value,
            range: if values.is_empty() { one } else { Interval::from_values(&values) },
        }
    };
    let mut all = Vec::new();
    for j in 0..model.dof {
        let link = format!("link {}", j + 1);
        all.push(figure(format!("{link}: mass, kg"), &link, "mass", &|robot| robot.links[j].mass));
    }
    let joint_figures: [JointFigure; 4] = [
        ("Coulomb friction, Nm", ["friction", "coulomb"], |robot, j| robot.coulomb[j]),
        ("viscous friction, Nm s/rad", ["friction", "viscous"], |robot, j| robot.viscous[j]),
        ("rotor at the joint, kg m2", ["motors", "rotor_inertia"], |robot, j| robot.rotors[j]),
        ("copper loss, W/(Nm)2", ["motors", "loss_constant"], |robot, j| robot.loss[j]),
    ];
    for (what, [table, key], of) in joint_figures {
        for j in 0..model.dof {
            all.push(figure(format!("{}: {what}", j + 1), table, key, &|robot| of(robot, j)));
        }
    }
    let robot_figures: [RobotFigure; 3] = [
        ("base power, W", ["drive", "base_w"], |robot| robot.base_w),
        ("coils of open brakes, W", ["brakes", "power_released_w"], |robot| robot.coils_w),
        ("release of the brakes, J", ["brakes", "energy_per_release_j"], |robot| robot.release_j),
    ];
    for (what, [table, key], of) in robot_figures {
        all.push(figure(what.to_owned(), table, key, &of));
    }
    all
}

fn document(model: &Model) -> Value {
    let figures: Vec<Value> = figures(model)
        .into_iter()
        .map(|figure| {
            json!({
                "figure": figure.what,
                "provenance": figure.provenance.map(|p| p.to_string()),
                "value": figure.value,
                "interval": [figure.range.low, figure.range.high],
            })
        })
        .collect();
    let origins: Vec<Value> = model
        .origins
        .iter()
        .map(|origin| {
            json!({
                "table": origin.table,
                "key": origin.key,
                "provenance": origin.provenance.map(|p| p.to_string()),
                "source": origin.source,
                "sd": origin.sd,
            })
        })
        .collect();
    let limits = &model.limits;
    json!({
        "name": model.name,
        "joints": model.dof,
        "position_rad": limits.position,
        "velocity_rad_s": limits.velocity,
        "acceleration_rad_s2": limits.acceleration,
        "torque_nm": limits.torque,
        "tcp_speed_m_s": limits.tcp_speed,
        "dynamics": model.has_dynamics(),
        "calibrated_robots": model.calibration.as_ref().map(|calibration| calibration.robots),
        "figures": figures,
        "estimated": model.estimated(),
        "assumed": model.assumed(),
        "origins": origins,
    })
}

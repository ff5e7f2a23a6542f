//! Energies over plausible robots: sums over a motion compared with the energy of each robot.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use joulepath::arm::dynamics::{Data, Load, gravity, torque};
use joulepath::arm::effects::{applied, drawn, with_estimates};
use joulepath::arm::robot::prior::{Spread, estimated};
use joulepath::arm::robot::{Brakes, Coupling, Model, find, from_toml, to_toml};
use joulepath::retime::energy::change::Changes;
use joulepath::retime::energy::plausible::{DRAWS, Robots, moments, plausibility};
use joulepath::retime::energy::power::holding_w;
use joulepath::retime::energy::{Account, EnergyParts, account};
use joulepath::retime::motion::{Options, Simulation};

/// Number of compared robots.
const ROBOTS: usize = 12;
/// Tolerance relative to the change of the energy: the sums use the braking phases of the model,
/// not of each robot.
const OFF: f64 = 0.03;
/// Tolerance relative to the energy of the motions: the quadrature is coarse, and braking ends as
/// in the model.
const COARSE: f64 = 0.006;

/// Largest logarithms of the ratios of the moments about axes 2 and 3 and of the inertia about axis
/// 1: 2.5 standard deviations of the rule and of the share of the foot.
const FAR: [f64; 3] = [0.5, 0.75, 0.6];

fn simulated(model: &Model) -> (Simulation, Account) {
    let files = support::modules("pick_place");
    let simulation = support::simulated(model, &files, &Options::default());
    let account = account(model, &simulation);
    (simulation, account)
}

#[test]
fn sums_over_a_motion_give_the_energy_of_each_robot() {
    let model = find("IRB1600-10/1.45").unwrap();
    let (simulation, own) = simulated(&model);
    let sums = moments(&model, &simulation);
    let draws = Spread::new(&model).draws(&model, ROBOTS);
    for robot in &draws.robots {
        let theirs = account(&robot.applied(&model), &simulation).total;
        let change = sums.changes(&model, &Changes::from_one(&model, robot))[0];
        for (name, part) in PARTS {
            let exact = part(&theirs) - part(&own.total);
            let found = part(&change);
            let allowed = OFF * exact.abs() + COARSE * own.total.motion_energy_j();
            assert!((found - exact).abs() < allowed, "{name}: {found:.1} J, {exact:.1} J");
        }
    }
}

type Part = fn(&EnergyParts) -> f64;

const PARTS: [(&str, Part); 7] = [
    ("mechanical", |parts| parts.mechanical_j),
    ("friction", |parts| parts.friction_j),
    ("copper", |parts| parts.copper_j),
    ("drive", |parts| parts.drive_j),
    ("idle", |parts| parts.idle_j),
    ("brakes", |parts| parts.brake_j),
    ("all", EnergyParts::energy_j),
];

/// Moments about axes 2 and 3 of the arm with its forearm level, and about axis 1 \[Nm, kg m²\].
fn moments_of(model: &Model) -> [f64; 3] {
    let level = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
    let mut data = Data::new();
    let load = Load::none();
    let still = gravity(model, &mut data, &load, &level);
    let turning = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let rests = torque(model, &mut data, &load, &level, &[0.0; 6], &[0.0; 6]).rigid[0];
    let moved = torque(model, &mut data, &load, &level, &[0.0; 6], &turning).rigid[0];
    [still[1].abs(), still[2].abs(), moved - rests]
}

/// Arms with unknown name and bodies and with the mass and payload of known robots: the rule by
/// axes compared with meshes. A tenth may exceed [`FAR`].
#[test]
fn estimates_from_axes_are_close_to_estimates_from_meshes() {
    let tables: toml::Table =
        toml::from_str(include_str!("../src/arm/robot/prior/robots.toml")).unwrap();
    let mut far = Vec::new();
    let mut all: Vec<[f64; 3]> = Vec::new();
    for name in joulepath::arm::robot::names().filter(|name| !name.starts_with("IRB14000")) {
        let bare = find(name).unwrap();
        if bare.has_dynamics() || bare.kinematics.coupling != Coupling::None {
            continue;
        }
        let meshes = estimated(bare.clone());
        let origins = meshes.origin_of("link 1", "mass").unwrap();
        assert!(origins.source.as_ref().unwrap().contains("meshes"), "{name}");
        let known = |key: &str| tables[name][key].as_float();
        let unknown =
            Model { name: "an arm".into(), mass: known("mass"), payload: known("payload"), ..bare };
        let axes = estimated(unknown);
        for link in &axes.links {
            assert!(link.impossible().is_none(), "{name}: {:?}", link.impossible());
        }
        let (a, b) = (moments_of(&axes), moments_of(&meshes));
        let ratios: [f64; 3] = std::array::from_fn(|i| (a[i] / b[i]).ln());
        all.push(ratios);
        if (0..3).any(|i| ratios[i].abs() > FAR[i]) {
            far.push(format!("{name}: {ratios:.2?}"));
        }
    }
    let count = all.len();
    let sd = |i: usize| {
        let mean = all.iter().map(|ratios| ratios[i]).sum::<f64>() / count as f64;
        (all.iter().map(|r| (r[i] - mean).powi(2)).sum::<f64>() / count as f64).sqrt()
    };
    let summary = format!("{} of {count}, {:.2?}: {far:#?}", far.len(), [sd(0), sd(1), sd(2)]);
    assert!(count > 60 && far.len() * 10 <= count, "{summary}");
}

#[test]
fn an_arm_without_dynamics_gets_estimated_ones() {
    for name in joulepath::arm::robot::names().filter(|name| !name.starts_with("IRB14000")) {
        let bare = find(name).unwrap();
        let model = applied(estimated(bare.clone())).unwrap();
        assert!(model.has_dynamics(), "{name}");
        if !bare.has_dynamics() {
            for link in &model.links {
                assert!(link.impossible().is_none(), "{name}: {:?}", link.impossible());
            }
            let spread = Spread::new(&model);
            for robot in &spread.draws(&model, ROBOTS).robots {
                for link in &robot.links {
                    assert!(link.impossible().is_none(), "{name}: {:?}", link.impossible());
                }
            }
        }
    }
}

/// Relative difference of the mean robot's energy and the robots' mean energy.
const MEAN_OFF: f64 = 0.01;

#[test]
fn the_mean_robot_needs_the_mean_energy() {
    let model = with_estimates(find("IRB2600-20/1.65").unwrap()).unwrap();
    let (simulation, _) = simulated(&model);
    let robots = Robots::new(&model).unwrap();
    let mean = robots.mean(&model, &moments(&model, &simulation)).unwrap();
    let draws = Spread::new(&model).draws(&model, DRAWS).robots;
    let each = draws
        .iter()
        .map(|robot| account(&drawn(&model, robot).unwrap(), &simulation).total.motion_energy_j());
    let expected = each.sum::<f64>() / draws.len() as f64;
    let found = account(&mean, &simulation).total.motion_energy_j();
    assert!((found - expected).abs() < MEAN_OFF * expected, "{found:.0} J, {expected:.0} J");
    let own = account(&model, &simulation).total.motion_energy_j();
    assert!((own - expected).abs() > MEAN_OFF * expected, "the model itself takes {own:.0} J");
}

#[test]
fn a_balancer_reduces_the_holding_power() {
    let model = with_estimates(find("IRB6700-200/2.6").unwrap()).unwrap();
    let without = Model { laws: Vec::new(), ..model.clone() };
    let forwards = [0.0, 1.0, 0.0, 0.0, 0.5, 0.0];
    let [with, without] = [&model, &without].map(|m| holding_w(m, &Load::none(), &forwards)[1]);
    // Copper loss is proportional to the square of the torque.
    let torque = torque(&model, &mut Data::new(), &Load::none(), &forwards, &[], &[]).rigid[1];
    let loss = model.motors.as_ref().unwrap().loss_constant[1];
    assert!((with - loss * torque * torque).abs() < 1e-9 * with, "{with} W");
    assert!(with < 0.5 * without, "{with} W, {without} W");
}

#[test]
fn a_renamed_robot_has_the_spread_of_its_type() {
    let known = with_estimates(find("IRB2600-20/1.65").unwrap()).unwrap();
    let text = "extends = \"IRB2600-20/1.65\"\nname = \"line 4\"\n";
    let renamed = with_estimates(from_toml("cell.toml", text).unwrap()).unwrap();
    assert_eq!(renamed.name, "line 4");
    let copied = with_estimates(from_toml("copy.toml", &to_toml(&renamed)).unwrap()).unwrap();
    let (simulation, own) = simulated(&known);
    let energies = |model: &Model| plausibility(model, &simulation, &own).unwrap();
    assert_eq!(energies(&known), energies(&renamed));
    assert_eq!(energies(&known), energies(&copied));
}

#[test]
fn missing_values_of_a_table_are_estimated() {
    let whole = with_estimates(find("IRB2600-20/1.65").unwrap()).unwrap();
    let with = |lines: &str| {
        let text = format!("extends = \"IRB2600-20/1.65\"\n{lines}");
        with_estimates(from_toml("cell.toml", &text).unwrap()).unwrap()
    };
    let estimated = whole.brakes.as_ref().unwrap();
    let brakes = with("[brakes]\npower_released_w = 20\n").brakes.unwrap();
    assert_eq!(brakes, Brakes { power_released_w: 20.0, ..estimated.clone() });
    // Writing a model without estimates does not turn these into stated values.
    let text = "extends = \"IRB2600-20/1.65\"\n[brakes]\npower_released_w = 20\n";
    let written = to_toml(&from_toml("cell.toml", text).unwrap());
    let again = with_estimates(from_toml("again.toml", &written).unwrap()).unwrap();
    assert_eq!(again.brakes.unwrap(), brakes);
}

#[test]
fn stated_standard_deviations_are_used_and_absurd_ones_refused() {
    let with = |lines: &str| {
        let text = format!("extends = \"IRB2600-20/1.65\"\n[drive]\nbase_w = 250\n{lines}");
        with_estimates(from_toml("cell.toml", &text).unwrap())
    };
    let width = |model: &Model| {
        let (simulation, own) = simulated(model);
        let all = plausibility(model, &simulation, &own).unwrap().energy_j;
        all.high - all.low
    };
    let [exact, stated] = ["base_w_sd = 2\n", ""].map(|lines| width(&with(lines).unwrap()));
    assert!(exact < 0.9 * stated, "{exact} J, {stated} J");
    let message = with("base_w_sd = 2500\n").unwrap_err().to_string();
    assert!(message.contains("base power"), "{message}");
}

#[test]
fn impossible_masses_are_refused_by_name() {
    let bare = find("IRB2600-20/1.65").unwrap();
    let text = to_toml(&Model { name: "an arm".into(), ..bare });
    let with_mass = |mass: &str| {
        let text = text.replacen('\n', &format!("\nmass = {mass}\n"), 1);
        let model = from_toml("arm.toml", &text).map_err(|error| error.to_string())?;
        with_estimates(model).map_err(|error| error.to_string())
    };
    for mass in ["-250.0", "0.0", "2.5", "19000.0", "1e6"] {
        let message = with_mass(mass).unwrap_err();
        assert!(message.contains("mass") && message.contains("kg"), "{mass}: {message}");
    }
    for factor in [0.0, 1000.0] {
        let mut model = with_estimates(find("IRB2600-20/1.65").unwrap()).unwrap();
        model.links.iter_mut().for_each(|link| {
            link.mass *= factor;
            link.inertia *= factor;
        });
        let read = from_toml("arm.toml", &to_toml(&model));
        let message = read.and_then(with_estimates).unwrap_err().to_string();
        assert!(message.contains("[[link]] mass"), "{message}");
    }
    let stated = with_mass("280.0").unwrap();
    let unknown = with_estimates(from_toml("arm.toml", &text).unwrap()).unwrap();
    let width = |model: &Model| {
        let (simulation, own) = simulated(model);
        let all = plausibility(model, &simulation, &own).unwrap().motion_energy_j;
        (all.high / all.low).ln()
    };
    assert!(width(&unknown) > width(&stated), "{} {}", width(&unknown), width(&stated));
}

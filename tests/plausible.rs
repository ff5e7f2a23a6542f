//! Energies over plausible robots: sums over a motion against the energy of each robot by itself.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::path::Path;

use joulepath::effects::applied;
use joulepath::energy::moments::Change;
use joulepath::energy::plausible::moments;
use joulepath::energy::{Account, EnergyParts, account};
use joulepath::motion::{Options, Simulation, simulate};
use joulepath::retrofit::{Source, read_program};
use joulepath::robot::prior::{Spread, estimated};
use joulepath::robot::{Model, find};
use joulepath::text::{FileId, SourceFile};

/// Robots that are compared.
const ROBOTS: usize = 12;
/// Difference of both ways over the change of the energy: the drive's braking is taken where the
/// model brakes, not where the robot does.
const OFF: f64 = 0.03;
/// The same over the energy of the motions: the sums are worked out by a coarse rule, and where braking
/// ends is that of the model.
const COARSE: f64 = 0.006;

fn simulated(model: &Model) -> (Simulation, Account) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/pick_place");
    let mut files = Vec::new();
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    for path in
        paths.iter().filter(|path| path.extension().is_some_and(|e| e == "mod" || e == "sys"))
    {
        let id = FileId(files.len() as u32);
        let file = SourceFile::new(id, path.display().to_string(), std::fs::read(path).unwrap());
        files.push(Source { relative: file.path.clone(), file });
    }
    let (program, entry) = read_program(&files, "main").unwrap();
    let simulation = simulate(&program, entry, model, &Options::default());
    let account = account(model, &simulation);
    (simulation, account)
}

#[test]
fn sums_over_a_motion_tell_the_energy_of_each_robot() {
    let model = find("IRB1600-10/1.45").unwrap();
    let (simulation, own) = simulated(&model);
    let sums = moments(&model, &simulation);
    let draws = Spread::of(&model).draws(&model, ROBOTS);
    for robot in &draws.robots {
        let theirs = account(&robot.applied(&model), &simulation).total;
        let change = sums.change(&model, &Change::of(&model, robot));
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

#[test]
fn an_arm_without_dynamics_gets_them() {
    for name in joulepath::robot::names().filter(|name| !name.starts_with("IRB14000")) {
        let bare = find(name).unwrap();
        let model = applied(estimated(bare.clone())).unwrap();
        assert!(model.has_dynamics(), "{name}");
        if !bare.has_dynamics() {
            for link in &model.links {
                assert!(link.impossible().is_none(), "{name}: {:?}", link.impossible());
            }
            let spread = Spread::of(&model);
            for robot in &spread.draws(&model, ROBOTS).robots {
                for link in &robot.links {
                    assert!(link.impossible().is_none(), "{name}: {:?}", link.impossible());
                }
            }
        }
    }
}

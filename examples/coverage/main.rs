//! Coverage of the 90 % intervals of estimated robots: `cargo run --release --example coverage >
//! docs/coverage.md`. The estimates use only geometry, limits, total mass and payload of each
//! robot. Poses, motions and programs are drawn with a fixed seed.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

mod energies;
mod powers;
mod torques;

use std::path::{Path, PathBuf};

use joulepath::arm::robot::{Model, find, load};
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::tool::retrofit::Source;
use torques::{CASES, Kind, SMALL, held, unknown};

fn main() {
    println!("# Coverage of the estimates\n");
    println!("Written by `cargo run --release --example coverage > docs/coverage.md`.\n");
    println!(
        "Geometry, limits, total mass and payload alone are given to the estimate. The tables have the share \
         of cases in which the 90 % interval over plausible robots holds the published value. {CASES} poses \
         and motions a robot; torques count by joint, those below {:.0} % of the joint's largest are left \
         out.\n",
        100.0 * SMALL
    );
    published_dynamics();
    bodies_of_makers();
    powers::print();
}

/// Quantities of the first table.
const QUANTITIES: [&str; 5] =
    ["gravity torque", "torque of acceleration", "friction torque", "motion energy", "saving"];

fn published_dynamics() {
    println!("## Robots with published dynamics\n");
    println!(
        "Three rules rest on the IRB1600, too: friction (its joints 1 to 3 are one of eleven sources), copper \
         loss (its joint 2), the release of the brakes. The other arms were used for none \
         of them. The estimate was found to be wrong for other makers on these arms, and was corrected with the \
         arms of the next table and five others.\n"
    );
    println!("| robot | {} |", QUANTITIES.join(" | "));
    println!("|---|{}", "---|".repeat(QUANTITIES.len()));
    let mut all: [Vec<bool>; 5] = Default::default();
    for (name, has_friction, has_power) in [
        ("IRB1600-10/1.45", true, true),
        ("ur10", true, false),
        ("ur5e", false, false),
        // Its friction is that behind the torque sensors, without the gears.
        ("panda", false, false),
        ("tx40", true, false),
    ] {
        let truth = find(name).unwrap_or_else(|_| read(&fixtures().join(format!("{name}.toml"))));
        let unknown = unknown(&truth);
        let torques = |kind: Kind| held(&truth, &unknown, kind);
        let (motion, saving) =
            if has_power { energies::held(&truth, &unknown) } else { Default::default() };
        let row = [
            torques(Kind::Gravity),
            torques(Kind::Acceleration),
            if has_friction { torques(Kind::Friction) } else { Vec::new() },
            motion,
            saving,
        ];
        println!("| {} | {} |", truth.name, row.each_ref().map(|held| rate(held)).join(" | "));
        all.iter_mut().zip(row).for_each(|(all, held)| all.extend(held));
    }
    println!("| all | {} |\n", all.map(|held| rate(&held)).join(" | "));
}

fn bodies_of_makers() {
    println!("## Bodies that other makers publish\n");
    println!(
        "The spread of bodies that follow from the axes alone was chosen on the first group; the arms of \
         the second are from makers whose data were not looked at before. The makers were split \
         alphabetically.\n"
    );
    println!("| arm | gravity torque | torque of acceleration |\n|---|---|---|");
    for (folder, group) in [("chosen", "chosen on"), ("unseen", "not looked at")] {
        let mut paths: Vec<PathBuf> = std::fs::read_dir(fixtures().join("makers").join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        paths.sort();
        let mut all: [Vec<bool>; 2] = Default::default();
        for path in paths {
            let truth = read(&path);
            let unknown = unknown(&truth);
            let row = [Kind::Gravity, Kind::Acceleration].map(|kind| held(&truth, &unknown, kind));
            println!("| {} | {} |", truth.name, row.each_ref().map(|held| rate(held)).join(" | "));
            all.iter_mut().zip(row).for_each(|(all, held)| all.extend(held));
        }
        println!("| **all, {group}** | {} |", all.map(|held| rate(&held)).join(" | "));
    }
    println!();
}

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/coverage")
}

fn read(path: &Path) -> Model {
    load(path.to_str().unwrap()).unwrap()
}

fn rate(held: &[bool]) -> String {
    if held.is_empty() {
        return "not published".into();
    }
    let count = held.iter().filter(|held| **held).count();
    format!("{:.0} % of {}", 100.0 * count as f64 / held.len() as f64, held.len())
}

fn source(text: &str) -> Source {
    let file = SourceFile::new(FileId(0), "program.mod".to_owned(), text.as_bytes().to_vec());
    Source { relative: file.path.clone(), file }
}

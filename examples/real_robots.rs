//! Diagnosis of public logs of real robots, with models that lack some effects: `cargo run
//! --release --example real_robots -- FOLDER`. docs/gap.md describes the sources of the logs and
//! the layout of the folder.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/real_logs.rs"]
mod real_logs;

use std::fs;
use std::path::PathBuf;

use joulepath::gap::Trust;
use real_logs::{PANDA, TX40, UR10, diagnosed, named};

fn main() {
    let Some(folder) = std::env::args().nth(1).map(PathBuf::from) else {
        println!("give the folder that has {}", TX40.csv);
        return;
    };
    for (name, robot) in [
        ("TX40, coupling of the wrist withheld", TX40),
        ("UR10 CB3, friction beyond Coulomb and viscous withheld", UR10),
        ("Panda, torques behind the gears", PANDA),
    ] {
        let read = |path: &str| fs::read_to_string(folder.join(path));
        let (Ok(urdf), Ok(csv)) = (read(robot.urdf), read(robot.csv)) else {
            println!("{name}: {} or {} is not in {}\n", robot.urdf, robot.csv, folder.display());
            continue;
        };
        let found = diagnosed(&robot, &urdf, &csv, Trust::Commissioned);
        println!("{name}: {}, named {:?}", found.verdict.name(), named(&found));
        println!("held-out rms, Nm: joint, torque, nominal, refitted, with effects");
        for (joint, of) in found.shrink.joints.iter().enumerate() {
            println!(
                "{:>6} {:>8.2} {:>8.2} {:>8.2} {:>8.2}",
                joint + 1,
                of.torque,
                of.model,
                of.refit,
                of.refit_plus_effect
            );
        }
        println!();
    }
}

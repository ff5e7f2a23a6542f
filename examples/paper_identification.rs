//! The chain of Paes et al. 2014 on a simulated IRB1600: an excitation as RAPID, three phase
//! currents at 3,200 Hz over seven periods, and from them the parameters and the power.
//!
//! `cargo run --release --example paper_identification -- DIR`

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::f64::consts::{SQRT_2, TAU};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, ensure};
use joulepath::dynamics::{Data, Load, torque};
use joulepath::robot::find;

const ROBOT: &str = "IRB1600-10/1.45";
/// Of the analyser \[s\].
const STEP: f64 = 1.0 / 3200.0;
const PERIODS: f64 = 7.0;
const POLE_PAIRS: f64 = 4.0;
/// Of a phase current \[A\], and of an angle \[rad\].
const NOISE: [f64; 2] = [0.05, 2e-6];

fn main() -> anyhow::Result<()> {
    let folder =
        std::env::args().nth(1).map_or_else(|| PathBuf::from("target/paper"), PathBuf::from);
    let at = |name: &str| folder.join(name).display().to_string();
    let joulepath = |args: &[&str]| -> anyhow::Result<()> {
        println!("\n$ joulepath {}", args.join(" "));
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        let run = ["run", "--quiet", "--release", "--bin", "joulepath", "--"];
        let status = Command::new(cargo).args(run).args(args).status()?;
        ensure!(status.success(), "joulepath failed");
        Ok(())
    };
    let out = folder.display().to_string();
    // The gate of the paper stands 80 cm behind the robot.
    let plane = ["--plane", "1,0,0,-0.8"];
    joulepath(&[&["excite", "--robot", ROBOT, "-q", "--out", &out], &plane[..]].concat())?;
    simulate(&at("excitation.csv"), &at("run.csv"), 1)?;
    let other = at("other");
    let seed = ["--seed", "7", "--harmonics", "1,2,5"];
    joulepath(&[&["excite", "--robot", ROBOT, "-q", "--out", &other], &plane[..], &seed].concat())?;
    simulate(&at("other/excitation.csv"), &at("validation.csv"), 2)?;
    let (run, validation, model, page) =
        (at("run.csv"), at("validation.csv"), at("model.toml"), at("report.html"));
    joulepath(&[
        "identify",
        "--robot",
        ROBOT,
        "--log",
        &run,
        "--validate",
        &validation,
        "--out",
        &model,
        "--report",
        &page,
    ])?;
    println!("\nmodel in {model}, plots of torque and power in {page}");
    Ok(())
}

/// The currents that an analyser would have recorded while the robot ran a table seven times.
fn simulate(table: &str, out: &str, seed: u64) -> anyhow::Result<()> {
    let model = find(ROBOT)?;
    let motors = model.motors.as_ref().context("the robot has motors")?;
    let constants = motors.torque_constant.as_ref().context("the robot has torque constants")?;
    let text = std::fs::read_to_string(table).with_context(|| table.to_owned())?;
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    let interval = rows[1][0] - rows[0][0];
    let mut random = fastrand::Rng::with_seed(seed);
    let mut noise = move |size: f64| {
        let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
        size * radius * (TAU * random.f64()).cos()
    };
    let mut csv = String::from("t");
    for name in ["q", "ia", "ib", "ic"] {
        for joint in 1..=6 {
            let _ = write!(csv, ",{name}{joint}");
        }
    }
    csv.push('\n');
    let mut data = Data::new();
    let count = (PERIODS * interval * rows.len() as f64 / STEP).round() as usize;
    for k in 0..count {
        let t = STEP * k as f64;
        let place = t / interval;
        let row = place.floor() as usize;
        let share = place - place.floor();
        let at = |column: usize| {
            let value = |row: usize| rows[row % rows.len()][column];
            value(row) * (1.0 - share) + value(row + 1) * share
        };
        let of = |first: usize| -> Vec<f64> { (first..first + 6).map(at).collect() };
        let [q, qd, qdd] = [of(1), of(7), of(13)];
        let parts = torque(&model, &mut data, &Load::none(), &q, &qd, &qdd);
        let _ = write!(csv, "{t:.7}");
        for q in &q {
            let _ = write!(csv, ",{:.8}", q + noise(NOISE[1]));
        }
        for phase in 0..3 {
            for joint in 0..6 {
                let tau = parts.rigid[joint] + parts.friction[joint];
                let amplitude = SQRT_2 * tau / (constants[joint] * motors.ratio[joint]);
                let angle =
                    POLE_PAIRS * motors.ratio[joint] * q[joint] - f64::from(phase) * TAU / 3.0;
                let _ = write!(csv, ",{:.4}", amplitude * angle.cos() + noise(NOISE[0]));
            }
        }
        csv.push('\n');
    }
    std::fs::write(out, csv).with_context(|| out.to_owned())
}

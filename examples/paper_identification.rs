//! The chain of Paes et al. 2014 on a simulated IRB1600: an excitation as RAPID, executed by the
//! virtual controller, three phase currents at 3,200 Hz over seven periods, and the identified
//! parameters of joints 1 to 3 (table 2) and the power.
//!
//! `cargo run --release --example paper_identification -- DIR`

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::f64::consts::{SQRT_2, TAU};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, ensure};
use joulepath::arm::dynamics::{Data, Load, base_parameters, parameters, torque};
use joulepath::arm::robot::find;
use serde_json::Value;

const ROBOT: &str = "IRB1600-10/1.45";
/// Sampling interval of the analyser \[s\].
const STEP: f64 = 1.0 / 3200.0;
const POLE_PAIRS: f64 = 4.0;
/// Noise of a phase current \[A\] and of an angle \[rad\].
const NOISE: [f64; 2] = [0.05, 2e-6];

fn main() -> anyhow::Result<()> {
    let folder =
        std::env::args().nth(1).map_or_else(|| PathBuf::from("target/paper"), PathBuf::from);
    let at = |name: &str| folder.join(name).display().to_string();
    let joulepath = |args: &[&str]| -> anyhow::Result<Vec<u8>> {
        println!("$ joulepath {}", args.join(" "));
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        let run = ["run", "--quiet", "--release", "--bin", "joulepath", "--"];
        let output = Command::new(cargo).args(run).args(args).stderr(Stdio::inherit()).output()?;
        ensure!(output.status.success(), "joulepath failed");
        Ok(output.stdout)
    };
    // The gate of the paper is 80 cm behind the robot.
    let plane = ["--plane", "1,0,0,-0.8"];
    let other = ["--seed", "7", "--harmonics", "1,2,5"];
    let runs: [(&str, &[&str], u64); 2] = [("run", &[], 1), ("validation", &other, 2)];
    for (name, more, seed) in runs {
        let rapid = at(name);
        let table = at(&format!("{name}_motion.csv"));
        let excite = ["excite", "--robot", ROBOT, "-q", "--out", &rapid];
        joulepath(&[&excite[..], &plane[..], more].concat())?;
        let module = format!("{rapid}/JoulepathExcitation.mod");
        let entry = ["--entry", "jpExciteRun", "--robot", ROBOT, "-q", "--trajectory", &table];
        joulepath(&[&["simulate", &module], &entry[..]].concat())?;
        record(&table, &at(&format!("{name}.csv")), seed)?;
    }
    let (run, validation, model, page) =
        (at("run.csv"), at("validation.csv"), at("model.toml"), at("report.html"));
    let found = joulepath(&[
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
        "--format",
        "json",
    ])?;
    show(&serde_json::from_slice(&found)?)?;
    println!("\nmodel in {model}, plots of torque and power in {page}");
    Ok(())
}

/// Table 2: identified and true parameters of joints 1 to 3.
fn show(found: &Value) -> anyhow::Result<()> {
    let model = find(ROBOT)?;
    let base = base_parameters(&model);
    let truth = base.of_parameters(&parameters(&model, &Load::none()));
    println!("\n{:>10} {:>10} {:>8} {:>5}  base parameter", "simulated", "identified", "sd", "off");
    let number = |entry: &Value, key: &str| entry[key].as_f64().context("a number");
    for entry in found["base_parameters"].as_array().context("base parameters")? {
        let name = entry["name"].as_str().context("a name")?;
        let row = (0..base.rank()).find(|row| base.name(*row) == name);
        let head = name.split_whitespace().next().unwrap_or_default();
        if let Some(row) = row.filter(|_| head.ends_with(['1', '2', '3'])) {
            let (value, sd) = (number(entry, "value")?, number(entry, "sd")?);
            let off = (value - truth[row]) / sd;
            println!("{:>10.4} {value:>10.4} {sd:>8.4} {off:>5.1}  {name}", truth[row]);
        }
    }
    for part in ["train", "validation"] {
        println!("RMS, {part} (Nm): {}", found["rms"][part]);
    }
    Ok(())
}

/// The currents recorded by an analyser while the robot executes a trajectory.
fn record(table: &str, out: &str, seed: u64) -> anyhow::Result<()> {
    let model = find(ROBOT)?;
    let motors = model.motors.as_ref().context("the robot has motors")?;
    let constants = motors.torque_constant.as_ref().context("the robot has torque constants")?;
    let text = std::fs::read_to_string(table).with_context(|| table.to_owned())?;
    // Time, positions, rates.
    let mut rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').take(13).map(|x| x.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    rows.dedup_by(|later, before| later[0] <= before[0]);
    let last = rows.last().context("the trajectory has rows")?[0];
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
    let mut after = 1;
    for k in 0..(last / STEP) as usize {
        let t = STEP * k as f64;
        while after + 1 < rows.len() && rows[after][0] <= t {
            after += 1;
        }
        let (from, to) = (&rows[after - 1], &rows[after]);
        let (into, long) = (t - from[0], to[0] - from[0]);
        // Rates are linear between rows; accelerations jump at points of the stream.
        let qdd: [f64; 6] = std::array::from_fn(|j| (to[7 + j] - from[7 + j]) / long);
        let qd: [f64; 6] = std::array::from_fn(|j| from[7 + j] + into * qdd[j]);
        let q: [f64; 6] =
            std::array::from_fn(|j| from[1 + j] + into * (from[7 + j] + 0.5 * into * qdd[j]));
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

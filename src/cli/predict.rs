//! `joulepath predict`: the torques and powers of a logged motion.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use super::{common, output};
use crate::dynamics::{Data, Load};
use crate::energy::power::{power_at, supply_w};
use crate::log::{Channel, Log, read_csv};
use crate::robot::{self, Model};

/// Torques and powers that a model predicts for a logged motion, as CSV.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath predict --robot IRB1600-10/1.45 --log motion.csv --out torque.csv"
)]
pub struct PredictArgs {
    /// The robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    robot: String,

    /// The motion: columns `t`, `q1…`, `qd1…`, `qdd1…` (or `q1_deg…`).
    #[arg(long, value_name = "FILE.csv")]
    log: PathBuf,

    /// Where the prediction goes, instead of standard output.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// A model without dynamics, a log that can't be used, or output that can't be written.
pub fn run(args: &PredictArgs) -> anyhow::Result<ExitCode> {
    let model = robot::load(&args.robot)?;
    if !model.has_dynamics() {
        let name = &model.name;
        bail!("{name} has no dynamics: give its links, [[link]], in a robot file with --robot");
    }
    let shown = args.log.display();
    let bytes = fs::read(&args.log).with_context(|| format!("can't read '{shown}'"))?;
    let log = read_csv(&bytes).with_context(|| shown.to_string())?;
    for rejected in &log.rejected {
        let text = format!("{shown}: row {} left out: {}", rejected.row, rejected.reason);
        common::note(args.quiet, &text);
    }
    for text in model.assumed() {
        common::note(args.quiet, &text);
    }
    let csv = prediction(&model, &log).with_context(|| shown.to_string())?;
    match &args.out {
        Some(path) => output::write(path, csv.as_bytes())?,
        None => std::io::stdout().lock().write_all(csv.as_bytes())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// `t,tau1..taun,p_mech,p_elec`, numbers in shortest round-trip form.
fn prediction(model: &Model, log: &Log) -> anyhow::Result<String> {
    let n = model.dof;
    if log.joints() != n {
        let name = &model.name;
        bail!("positions of {} joints are logged, {name} has {n}", log.joints());
    }
    let columns = |channel: fn(usize) -> Channel, name: &str| {
        log.of_joints(channel).with_context(|| {
            format!("a prediction needs the columns {name}1 to {name}{n} beside q1 to q{n}")
        })
    };
    let q = columns(Channel::Position, "q")?;
    let qd = columns(Channel::Velocity, "qd")?;
    let qdd = columns(Channel::Acceleration, "qdd")?;

    let mut csv = String::from("t");
    for joint in 1..=n {
        let _ = write!(csv, ",tau{joint}");
    }
    csv.push_str(",p_mech,p_elec\n");
    let (mut data, load) = (Data::new(), Load::none());
    for (row, t) in log.time().iter().enumerate() {
        let at = |columns: &[&[f64]]| columns.iter().map(|column| column[row]).collect::<Vec<_>>();
        let [q, qd, qdd] = [at(&q), at(&qd), at(&qdd)];
        let state: [&[f64]; 3] = [&q, &qd, &qdd];
        let power = power_at(model, &mut data, &load, state);
        let supply = supply_w(model, &mut data, &load, state, &power);
        let _ = write!(csv, "{t}");
        for tau in &power.tau[..n] {
            let _ = write!(csv, ",{tau}");
        }
        let _ = writeln!(csv, ",{},{supply}", power.mechanical_w());
    }
    Ok(csv)
}

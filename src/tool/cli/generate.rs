//! `joulepath generate`: RAPID from points or a trajectory in CSV.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use serde_json::json;

use super::common::{self, ProgramArgs};
use super::optimize::spacing;
use super::output;
use crate::tool::generate::{Form, Generated, Settings, generate, table};

/// Turn points or a timed joint trajectory into verified RAPID.
#[derive(Debug, Args)]
#[command(
    mut_arg("paths", |paths| paths.value_name("FILE.csv").num_args(1)
        .help("CSV with the columns t,q1..q6 or q1..q6 (rad; q1_deg.. for degrees) or \
               x,y,z,w,i,j,k[,cf1,cf4,cf6,cfx] (m; x_mm.. for mm), and speed,zone as wanted")),
    mut_arg("inputs", |inputs| inputs.hide(true)),
    mut_arg("entry", |entry| entry.hide(true)),
    mut_arg("start", |start| start.hide(true)),
    after_help = "A timed trajectory becomes a stream of joint targets that follows it within \
        1 mm at each time. Points become one movement each, at v200 and fine where the file \
        says nothing else; numbers in speed and zone are in m/s and m, in a file with degrees \
        or mm in mm/s and mm.\n\n\
        Example: joulepath generate trajectory.csv --robot IRB1600-10/1.45 --out generated"
)]
pub(super) struct GenerateArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// The folder that receives the program.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// What the points become.
    #[arg(long = "as", value_enum, default_value_t = FormArg::Absj)]
    form: FormArg,

    /// Least time between two points of a stream, s.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    spacing: Option<f64>,
}

/// What the points become.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FormArg {
    /// Joint targets; a stream of them for a timed trajectory.
    Absj,
    /// Joint movements to poses.
    Movej,
    /// Lines; to the first point a joint movement.
    Movel,
    /// A file of positions for externally guided motion, and a module that runs it.
    Egm,
}

pub(super) fn run(args: &GenerateArgs) -> anyhow::Result<ExitCode> {
    let [path] = args.program.cell.paths.as_slice() else { bail!("give one CSV file") };
    let bytes = std::fs::read(path)
        .with_context(|| format!("cannot read '{}'; check the path", path.display()))?;
    let points = table::read(&bytes).with_context(|| path.display().to_string())?;
    let model = common::robot(&args.program.cell)?;
    let settings = Settings {
        form: match args.form {
            FormArg::Absj => Form::AbsJ,
            FormArg::Movej => Form::MoveJ,
            FormArg::Movel => Form::MoveL,
            FormArg::Egm => Form::Egm,
        },
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        spacing_s: spacing(args.spacing)?,
    };
    let generated =
        generate(&model, &points, &settings).with_context(|| path.display().to_string())?;
    common::notes(args.program.cell.quiet, generated.notes.iter().chain(&model.assumed()));
    let files = &generated.outputs;
    output::write_folder(&args.out, files.iter().map(|file| (&file.path, &file.bytes)))?;
    let written: Vec<String> =
        files.iter().map(|file| args.out.join(&file.path).display().to_string()).collect();
    common::print(
        args.program.format,
        || json(&model.name, &generated, &written),
        || text(&generated, &written),
    )
}

fn json(robot: &str, generated: &Generated, written: &[String]) -> serde_json::Value {
    let ratios = generated.measure.map(|measure| {
        json!({
            "velocity": measure.velocity,
            "acceleration": measure.acceleration,
            "torque": measure.torque,
            "tcp_speed": measure.tcp_speed,
        })
    });
    json!({
        "robot": robot,
        "points": generated.points,
        "duration_s": generated.duration_s,
        "verification": {
            "passed": true,
            "max_ratio": ratios,
            "max_path_deviation_m": generated.measure.map(|measure| measure.deviation_m),
            "checks": generated.checks,
        },
        "notes": generated.notes,
        "outputs": written,
    })
}

fn text(generated: &Generated, written: &[String]) -> String {
    let mut text = format!("{} points, {:.3} s\n", generated.points, generated.duration_s);
    if let Some(measure) = &generated.measure {
        let _ = writeln!(
            text,
            "of the limits: speed {:.0} %, acceleration {:.0} %, torque {:.0} %",
            100.0 * measure.velocity,
            100.0 * measure.acceleration,
            100.0 * measure.torque
        );
    }
    for path in written {
        let _ = writeln!(text, "wrote {path}");
    }
    text
}

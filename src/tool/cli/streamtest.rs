//! `joulepath streamtest`: tests whether a controller runs streams as joulepath assumes.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;
use nalgebra::Vector3;
use serde_json::json;

use super::common::{self, Format};
use super::excite::floor;
use super::output;
use crate::arm::effects;
use crate::arm::kinematics::{Body, Obstacle, limits_ok};
use crate::arm::robot::Model;
use crate::learn::excite::{Finding, Measured, Rows, StreamTest, measured, stream_tests};
use crate::learn::log::{self, Channel, ColumnMap};
use crate::retime::motion::stream::Joints;
use crate::tool::emit::{TestStream, stream_test};

/// Row interval of the predicted log \[s\].
const STEP: f64 = 0.004;
/// Standstill around each test in the predicted log \[s\].
const REST: f64 = 0.2;

/// Test how a controller runs streams: RAPID to run and log, and what the log says.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples: joulepath streamtest --robot IRB1600-10/1.45 --out test\n          joulepath streamtest --robot IRB1600-10/1.45 --log streamtest_log.csv"
)]
pub(super) struct StreamtestArgs {
    /// The robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    robot: String,

    /// Where the RAPID modules and the predicted log, streamtest.csv, go.
    #[arg(long, value_name = "DIR", required_unless_present = "log")]
    out: Option<PathBuf>,

    /// A log of the test: compare it with the motion that joulepath assumes.
    #[arg(long, value_name = "FILE", conflicts_with = "out")]
    log: Option<PathBuf>,

    /// The pose around which the robot moves, axes in degrees; the same for a log.
    #[arg(long, value_name = "DEG,…", allow_hyphen_values = true, default_value = "0,0,0,0,30,0")]
    start: String,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &StreamtestArgs) -> anyhow::Result<ExitCode> {
    let model = effects::load(&args.robot)?;
    common::require_six_joints(&model, "RAPID is written for robots with 6")?;
    let start = common::six_degrees("--start", &args.start)?;
    if let Err(violation) = limits_ok(&model, &start) {
        bail!("--start {}: {violation}", args.start);
    }
    let obstacles: Vec<Obstacle> = floor(&model).into_iter().collect();
    let body = Body::new(&model, Vector3::zeros(), &obstacles);
    let tests = stream_tests(&model, &body, &start)?;
    match (&args.out, &args.log) {
        (Some(folder), _) => write(args, &model, &tests, folder),
        (None, Some(path)) => compare(args, &tests, path),
        (None, None) => bail!("give --out DIR for the test, or --log FILE for what it says"),
    }
}

fn write(
    args: &StreamtestArgs,
    model: &Model,
    tests: &[StreamTest],
    folder: &std::path::Path,
) -> anyhow::Result<ExitCode> {
    let streams: Vec<_> = tests
        .iter()
        .map(|StreamTest { what, stream }| TestStream {
            what,
            start: stream.start(),
            points: stream.points(),
            intervals: stream.intervals(),
        })
        .collect();
    let [motion, logger] = stream_test(&model.name, &streams)?;
    let table = ("streamtest.csv".to_owned(), predicted(tests));
    let limits = |text: &String| text.starts_with("limits.");
    common::notes(args.quiet, model.assumed().into_iter().filter(limits));
    let mut outputs = Vec::new();
    for (name, text) in [motion, logger, table] {
        let path = folder.join(name);
        output::write(&path, text.as_bytes())?;
        outputs.push(path.display().to_string());
    }
    let json = || {
        let test = |test: &StreamTest| {
            json!({
                "what": test.what,
                "points": test.stream.points().len(),
                "duration_s": test.stream.duration(),
            })
        };
        json!({ "tests": tests.iter().map(test).collect::<Vec<_>>(), "outputs": outputs })
    };
    let text = || {
        let mut text = String::new();
        for (index, test) in tests.iter().enumerate() {
            let (points, seconds) = (test.stream.points().len(), test.stream.duration());
            let number = index + 1;
            let _ = writeln!(text, "test {number}: {}: {points} points, {seconds:.2} s", test.what);
        }
        for path in &outputs {
            let _ = writeln!(text, "wrote {path}");
        }
        text
    };
    common::print(args.format, json, text)
}

/// The log of a controller that runs streams as assumed.
fn predicted(tests: &[StreamTest]) -> String {
    let mut csv = String::from("t,cmd,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n");
    let mut row = 0;
    for (index, test) in tests.iter().enumerate() {
        let count = ((test.stream.duration() + 2.0 * REST) / STEP).ceil() as usize;
        for k in 0..=count {
            let q = test.stream.eval(STEP * k as f64 - REST).0;
            let _ = write!(csv, "{:.3},{}", STEP * f64::from(row), index + 1);
            for x in q {
                let _ = write!(csv, ",{:.5}", x.to_degrees());
            }
            csv.push('\n');
            row += 1;
        }
    }
    csv
}

fn compare(
    args: &StreamtestArgs,
    tests: &[StreamTest],
    path: &std::path::Path,
) -> anyhow::Result<ExitCode> {
    let shown = path.display();
    let bytes = std::fs::read(path)
        .with_context(|| format!("cannot read '{shown}'; check the path and its permissions"))?;
    let log = log::read(&bytes, &ColumnMap::default()).with_context(|| format!("'{shown}'"))?;
    let Some(command) = log.column(Channel::Command) else {
        bail!("'{shown}' has no column cmd, the number of the test: give the logger's file");
    };
    let Some(q) = log.of_joints(Channel::Position).filter(|q| q.len() == 6) else {
        bail!("'{shown}' needs the positions of six joints, q1_deg to q6_deg");
    };
    let mut found = Vec::new();
    for (index, test) in tests.iter().enumerate() {
        let number = index + 1;
        let mut rows = Rows::default();
        for row in (0..command.len()).filter(|row| command[*row] == number as f64) {
            rows.t.push(log.time()[row]);
            rows.q.push(std::array::from_fn::<f64, 6, _>(|joint| q[joint][row]) as Joints);
        }
        let Some(measured) = measured(test, &rows) else {
            bail!(
                "'{shown}': test {number} has {} rows; it needs rows at most 0.02 s apart that begin \
                 at --start {} and move: give the logger's file, and the --robot and --start that \
                 the test was made with",
                rows.t.len(),
                args.start
            );
        };
        found.push((test, measured));
    }
    let holds = found.iter().all(|(_, measured)| measured.finding == Finding::Law);
    let json = || {
        let tests: Vec<_> = found.iter().map(|(test, m)| document(test, m)).collect();
        json!({ "law_holds": holds, "tests": tests })
    };
    let lines = || {
        let tests = found.iter().enumerate();
        let tests =
            tests.map(|(i, (test, m))| format!("test {}: {}: {}\n", i + 1, test.what, text(m)));
        tests.collect::<String>() + conclusion(holds) + "\n"
    };
    common::print(args.format, json, lines)?;
    Ok(if holds { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

fn name(finding: Finding) -> &'static str {
    match finding {
        Finding::Law => "as expected",
        Finding::Visits => "the points are visited",
        Finding::Other => "not as expected",
    }
}

fn document(test: &StreamTest, m: &Measured) -> serde_json::Value {
    json!({
        "what": test.what,
        "finding": name(m.finding),
        "deviation_rad": m.deviation,
        "time_s": m.time[0],
        "expected_time_s": m.time[1],
        "corner_share": m.corners,
    })
}

fn text(m: &Measured) -> String {
    let corners = m.corners.map_or_else(String::new, |share| {
        format!(", passes its points at {share:.2} of the expected distance")
    });
    format!(
        "{}: within {:.2} mrad, {:.3} s ({:.3} s expected){corners}",
        name(m.finding),
        1e3 * m.deviation,
        m.time[0],
        m.time[1],
    )
}

fn conclusion(holds: bool) -> &'static str {
    if holds {
        "This controller runs streams as joulepath assumes."
    } else {
        "This controller does not run streams as joulepath assumes: do not run retrofits on it. \
         docs/safety.md says how to read these figures."
    }
}

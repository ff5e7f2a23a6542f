//! The RAPID of the stream tests: a motion module, and a logger for a second task.

use serde::Serialize;
use tera::{Context, Tera};

use super::excitation::{INTERVAL, TASK};
use crate::rapid::ir::number::{TIME_DECIMALS, joints, number};

const MOTION_TEMPLATE: &str = include_str!("../../../templates/streamtest.mod.tera");
const LOGGER_TEMPLATE: &str = include_str!("../../../templates/streamtest_logger.mod.tera");
/// Prefix of all declared names.
const PREFIX: &str = "jpTest";
const LOG: &str = "streamtest_log.csv";
/// Time around each test, and extra time of the logger \[s\].
const AROUND: f64 = 1.0;
const MORE: f64 = 5.0;

/// A stream to emit.
#[derive(Clone, Copy, Debug)]
pub struct TestStream<'a> {
    /// Purpose of the test.
    pub what: &'a str,
    /// Start position \[rad\].
    pub start: &'a [f64; 6],
    /// Points \[rad\].
    pub points: &'a [[f64; 6]],
    /// `\T` of each point \[s\].
    pub intervals: &'a [f64],
}

#[derive(Serialize)]
struct Test<'a> {
    what: &'a str,
    points: Vec<String>,
    times: Vec<String>,
    fly_by: usize,
}

/// File names and texts of the motion module and of its logger, for streams with a common start.
///
/// # Errors
/// A template does not fit its data.
pub fn stream_test(
    robot: &str,
    streams: &[TestStream<'_>],
) -> Result<[(String, String); 2], tera::Error> {
    let (motion, logger) = ("JoulepathTest", "JoulepathTestLogger");
    let start = streams.first().map(|stream| joints(stream.start)).unwrap_or_default();
    let of_point = |stream: &TestStream<'_>, q: &[f64; 6]| {
        q.iter().zip(stream.start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let of_stream = |stream: &TestStream<'_>| {
        stream.points.iter().map(|q| of_point(stream, q)).fold(0.0, f64::max)
    };
    let reach = streams.iter().map(of_stream).fold(0.0, f64::max).to_degrees();
    let of_stream = |stream: &TestStream<'_>| stream.intervals.iter().sum::<f64>() + AROUND;
    let duration: f64 = streams.iter().map(of_stream).sum();
    let tests: Vec<Test<'_>> = streams
        .iter()
        .map(|stream| Test {
            what: stream.what,
            points: stream.points.iter().map(|q| joints(q)).collect(),
            times: stream.intervals.iter().map(|d| number(*d, TIME_DECIMALS)).collect(),
            fly_by: stream.points.len().saturating_sub(1),
        })
        .collect();
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("prefix", PREFIX);
    context.insert("robot", robot);
    context.insert("reach", &number(reach.ceil(), 0));
    context.insert("start", &start);
    context.insert("tests", &tests);
    context.insert("module", motion);
    let motion_text = Tera::one_off(MOTION_TEMPLATE, &context, false)?;
    context.insert("module", logger);
    context.insert("motion", motion);
    context.insert("task", TASK);
    context.insert("file", LOG);
    context.insert("rows", &((duration + MORE) / INTERVAL).ceil().to_string());
    context.insert("interval", &number(INTERVAL, TIME_DECIMALS));
    context.insert("joints", &["1", "2", "3", "4", "5", "6"]);
    let logger_text = Tera::one_off(LOGGER_TEMPLATE, &context, false)?;
    Ok([(format!("{motion}.mod"), motion_text), (format!("{logger}.mod"), logger_text)])
}

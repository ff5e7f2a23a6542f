//! The RAPID of an excitation trajectory: a motion module, and a logger for a second task.

use serde::Serialize;
use tera::{Context, Tera};

use crate::rapid::ir::number::{TIME_DECIMALS, joints, number};

const MOTION_TEMPLATE: &str = include_str!("../../../templates/excitation.mod.tera");
const LOGGER_TEMPLATE: &str = include_str!("../../../templates/excitation_logger.mod.tera");
/// Prefix of all declared names.
const PREFIX: &str = "jpExcite";
/// Names of the motion task, the mechanical unit and the synchronisation signal on the controller.
pub(super) const TASK: &str = "T_ROB1";
const UNIT: &str = "ROB_1";
const SIGNAL: &str = "doJpSync";
const RATIO_DECIMALS: usize = 5;
/// Interval of the logger \[s\]: the shortest of test signals.
pub(super) const INTERVAL: f64 = 0.004;
/// Maximum number of logger rows: limited by the size of a RAPID array in a task's memory.
const MAX_ROWS: usize = 30_000;

/// Points of one part of the motion, in their order.
#[derive(Clone, Debug)]
pub struct Points {
    /// Description for comments.
    pub what: &'static str,
    /// Suffix of their name.
    pub name: &'static str,
    /// Whether they are repeated.
    pub repeated: bool,
    /// \[rad\].
    pub points: Vec<[f64; 6]>,
}

/// The source of the logged torques.
#[derive(Clone, Debug, PartialEq)]
pub enum LoggedTorques {
    /// Test signal 4002: arm side.
    TestSignals,
    /// `GetMotorTorque`, motor side.
    Motors {
        /// Gear ratios.
        ratio: Vec<f64>,
        /// Turns of motor 6 per turn of axis 5, relative to its ratio (wrist coupling).
        coupling: f64,
    },
}

/// A motion to emit.
#[derive(Clone, Debug)]
pub struct Excitation {
    /// Purpose of the motion.
    pub title: String,
    /// The robot.
    pub robot: String,
    /// Number of repetitions.
    pub cycles: usize,
    /// Duration of one repetition \[s\].
    pub period: f64,
    /// Time between points \[s\].
    pub spacing: f64,
    /// Start position \[rad\].
    pub start: [f64; 6],
    /// The points.
    pub lists: Vec<Points>,
    /// End position \[rad\].
    pub stop: [f64; 6],
    /// Angles of joint 1 at which the synchronisation signal falls and rises \[rad\].
    pub marks: [f64; 2],
    /// The source of the torques.
    pub torques: LoggedTorques,
}

#[derive(Serialize)]
struct List {
    what: &'static str,
    name: String,
    repeated: bool,
    points: Vec<String>,
}

/// File names and texts of the motion module and of its logger.
///
/// # Errors
/// A template does not fit its data.
pub fn excitation(of: &Excitation) -> Result<[(String, String); 2], tera::Error> {
    let lists: Vec<List> = of
        .lists
        .iter()
        .filter(|list| !list.points.is_empty())
        .map(|list| List {
            what: list.what,
            name: format!("{PREFIX}{}", list.name),
            repeated: list.repeated,
            points: list.points.iter().map(|q| joints(q)).collect(),
        })
        .collect();
    let count: usize = of
        .lists
        .iter()
        .map(|list| list.points.len() * if list.repeated { of.cycles } else { 1 })
        .sum();
    let duration = of.spacing * count as f64 + 3.0;
    // A long motion is logged at a longer interval instead of being cut off.
    let every = (duration / MAX_ROWS as f64 / INTERVAL).ceil().max(1.0);
    let interval = INTERVAL * every;
    let rows = (duration / interval).ceil() as usize;
    let (motion, logger) = ("JoulepathExcitation", "JoulepathLogger");
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("module", motion);
    context.insert("prefix", PREFIX);
    context.insert("title", &of.title);
    context.insert("robot", &of.robot);
    context.insert("cycles", &of.cycles.to_string());
    context.insert("period", &number(of.period, TIME_DECIMALS));
    context.insert("spacing", &number(of.spacing, TIME_DECIMALS));
    context.insert("start", &joints(&of.start));
    context.insert("stop", &joints(&of.stop));
    context.insert("lists", &lists);
    context.insert("tool", "tool0");
    let motion_text = Tera::one_off(MOTION_TEMPLATE, &context, false)?;
    context.insert("module", logger);
    context.insert("motion", motion);
    context.insert("task", TASK);
    context.insert("unit", UNIT);
    context.insert("signal", SIGNAL);
    context.insert("file", "joulepath_log.csv");
    context.insert("rows", &rows.to_string());
    context.insert("interval", &number(interval, TIME_DECIMALS));
    context.insert("mark_low", &number(of.marks[0].to_degrees(), 2));
    context.insert("mark_high", &number(of.marks[1].to_degrees(), 2));
    context.insert("joints", &["1", "2", "3", "4", "5", "6"]);
    match &of.torques {
        LoggedTorques::TestSignals => context.insert("test_signals", &true),
        LoggedTorques::Motors { ratio, coupling } => {
            let shown: Vec<String> = ratio.iter().map(|n| number(*n, RATIO_DECIMALS)).collect();
            context.insert("test_signals", &false);
            context.insert("ratios", &shown);
            let coupled = *coupling != 0.0;
            context.insert("coupling", &coupled.then(|| number(*coupling, RATIO_DECIMALS)));
        }
    }
    let logger_text = Tera::one_off(LOGGER_TEMPLATE, &context, false)?;
    Ok([(format!("{motion}.mod"), motion_text), (format!("{logger}.mod"), logger_text)])
}

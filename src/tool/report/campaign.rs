//! The state of a campaign as text, and what its steps found.

use std::fmt::Write;

use serde::Serialize;
use serde_json::Value;

/// A step of a campaign.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Done {
    /// What is done by it.
    pub name: &'static str,
    /// Whether it is.
    pub is_done: bool,
    /// Its page beside the report.
    pub page: Option<String>,
}

/// The state as text. `experiments`: commands that would tell more of the waits.
pub fn text(done: &[Done], next: &str, experiments: &[String]) -> String {
    let mut out = String::new();
    for step in done {
        let _ = writeln!(out, "{} {}", if step.is_done { "done" } else { "    " }, step.name);
    }
    let _ = writeln!(out, "next: {next}");
    if !experiments.is_empty() {
        let _ = writeln!(out, "or first, to tell what more waits are (logs go beside the others):");
    }
    for command in experiments {
        let _ = writeln!(out, "    {command}");
    }
    out
}

/// What the recorder takes.
pub fn recorded(result: &Value) -> Option<String> {
    let extra = &result["extra_time"];
    Some(format!(
        "The recorder takes {:.0} ms in a cycle, {:.1} ms for each movement.",
        extra["cycle_ms"].as_f64()?,
        extra["movement_ms"].as_f64()?
    ))
}

/// What was found of the waits.
pub fn waits(result: &Value) -> Option<String> {
    let waits = result["waits"].as_array()?;
    let count = |kind: &str| waits.iter().filter(|wait| wait["kind"] == kind).count();
    Some(format!(
        "Waits: {} slack, {} of the process, {} not told apart.",
        count("slack"),
        count("process"),
        count("unknown")
    ))
}

/// What the retrofit promises.
pub fn promised(result: &Value) -> Option<String> {
    let waits = &result["waits"];
    Some(format!(
        "The retrofit promises {:.1} % of all energy, {:.1} % of the motion energy; {} of {} recorded cycles would have \
         become longer.",
        waits["expected_saving_percent"].as_f64()?,
        result["motion_saving_percent"].as_f64()?,
        waits["longer"].as_u64()?,
        waits["cycles"].as_u64()?
    ))
}

/// What was measured.
pub fn proved(result: &Value) -> Option<String> {
    let saving = &result["saving_percent"];
    Some(format!(
        "Measured: {:.1} % ({:.1} to {:.1}) saved.",
        saving["value"].as_f64()?,
        saving["low"].as_f64()?,
        saving["high"].as_f64()?
    ))
}

//! `optimize --waits`: the slack of recorded waits.

use std::path::Path;

use anyhow::{Context, bail};

use super::common::Job;
use crate::retime::motion::simulate;
use crate::tool::cell::program_hash;
use crate::tool::cell::slack::{Planned, plan};
use crate::tool::cell::waits::file::WaitsFile;
use crate::tool::retrofit::read_program;

/// Default risk.
pub(super) const RISK: &str = "5%";
/// Largest risk.
const LARGEST_RISK: f64 = 0.5;

/// Reads `waits.toml` and sets the arrivals of the waits in the options of the simulation.
pub(super) fn use_waits(job: &mut Job, path: &Path, risk: &str) -> anyhow::Result<Planned> {
    let risk = share(risk)?;
    let shown = path.display();
    if !job.inputs.is_empty() {
        bail!(
            "--waits {shown} and stated times of inputs exclude each other: leave out --input, and [inputs] in \
             joulepath.toml"
        );
    }
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("cannot read '{shown}'; joulepath waits writes it"))?;
    let waits = WaitsFile::parse(&text).with_context(|| shown.to_string())?;
    let (program, entry) = read_program(&job.files, &job.entry)?;
    let hash = program_hash(&job.files);
    let planned = plan(&waits, (&job.files, &hash), risk, &job.options, &|options| {
        simulate(&program, entry, &job.model, options)
    })
    .with_context(|| shown.to_string())?;
    job.options.arrivals.clone_from(&planned.arrivals);
    Ok(planned)
}

/// A share such as `5%` or `0.05`.
pub(super) fn share(text: &str) -> anyhow::Result<f64> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text.trim(), 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(x) if x > 0.0 && x * unit <= LARGEST_RISK => Ok(x * unit),
        _ => bail!("--risk {text}: give more than 0 and at most 50%, such as 5%"),
    }
}

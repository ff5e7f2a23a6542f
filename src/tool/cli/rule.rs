//! `joulepath rule`: the documentation of a lint.

use std::io::Write;
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;

use crate::arm::robot::nearest;
use crate::tool::lint::{ALL, find};

/// Show the documentation of a lint, or list all.
#[derive(Debug, Args)]
#[command(after_help = "Example: joulepath rule EW101")]
pub(super) struct RuleArgs {
    /// Its code or name; without one all are listed.
    code: Option<String>,
}

pub(super) fn run(args: &RuleArgs) -> anyhow::Result<ExitCode> {
    let mut out = std::io::stdout().lock();
    let Some(code) = &args.code else {
        for rule in ALL {
            writeln!(out, "{} {:<34} {}", rule.code, rule.name, rule.summary())?;
        }
        return Ok(ExitCode::SUCCESS);
    };
    let Some(rule) = find(code) else {
        let names = ALL.iter().flat_map(|rule| [rule.code, rule.name]);
        let meant = nearest(&code.to_uppercase(), names.clone()).or_else(|| nearest(code, names));
        let meant = meant.map_or_else(String::new, |near| format!("did you mean {near}? "));
        bail!("there is no lint '{code}'; {meant}joulepath rule lists them");
    };
    writeln!(out, "# {} {}\n\n{}", rule.code, rule.name, rule.manual())?;
    Ok(ExitCode::SUCCESS)
}

//! `joulepath campaign`: the loop in the cell as a folder, from the first log to the proven saving.

mod inputs;
mod state;
mod steps;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;
use serde_json::json;

use super::common::{self, Format};
use super::{output, slack};
use crate::tool::report::campaign as report;
use crate::tool::report::html::campaign_report;
use state::State;
use steps::{Next, Steps};

/// Lead a campaign: record, find the slack, retrofit, record again, prove. Each call does what can be
/// done and says what comes next.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath campaign target/campaign --program fixtures/pick_place\n\n\
    The folder has only plain files. campaign.toml states the program and the options; recorded/, logs/before/, \
    waits.toml, optimized/, recorded-after/, logs/after/ and proof.json are the steps. A step whose result is there \
    is not done again, unless its inputs have changed (inputs.json) and the cell does not use it yet: delete a \
    result to have it made anew."
)]
pub(super) struct CampaignArgs {
    /// The folder of the campaign.
    folder: PathBuf,

    /// The program, at the first call: module, folder, .pgf file or backup.
    #[arg(long, value_name = "PATH")]
    program: Option<PathBuf>,

    /// The robot, at the first call, unless a joulepath.toml beside or above the program names it.
    #[arg(long, value_name = "NAME|FILE")]
    robot: Option<String>,

    /// Share of cycles that may become longer, at the first call.
    #[arg(long, value_name = "SHARE", requires = "program")]
    risk: Option<String>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &CampaignArgs) -> anyhow::Result<ExitCode> {
    let state = match &args.program {
        Some(program) => begin(args, program)?,
        None => State::read(&args.folder)?,
    };
    let mut steps = Steps::new(&args.folder, &state)?;
    let next = loop {
        match steps.next()? {
            Next::Do(step) => {
                common::note(args.quiet, &format!("{}: {}", step.name, step.shown()));
                steps.execute(&step)?;
                // A campaign whose first step fails has not begun.
                state.write(&args.folder)?;
            }
            waiting => break waiting,
        }
    };
    let proposals = steps.proposals()?;
    let done = steps.done();
    let page = campaign_report(&state.program, &done, next.text(), &proposals, &steps.figures()?)?;
    let path = args.folder.join(REPORT);
    output::write(&path, page.as_bytes())?;
    common::note(args.quiet, &format!("wrote {}", path.display()));
    common::print(
        args.format,
        || {
            let finished = matches!(next, Next::Finished(_));
            json!({
                "program": state.program,
                "done": done,
                "next": next.text(),
                "experiments": proposals,
                "finished": finished,
            })
        },
        || report::text(&done, next.text(), &proposals),
    )
}

/// The report of the campaign.
const REPORT: &str = "report.html";

/// The state of a new campaign.
fn begin(args: &CampaignArgs, program: &std::path::Path) -> anyhow::Result<State> {
    if State::path(&args.folder).exists() {
        bail!(
            "'{}' is a campaign already: leave out --program to go on with it, or name another folder",
            args.folder.display()
        );
    }
    let program = std::path::absolute(program)?;
    if !program.exists() {
        bail!("cannot find the program '{}'; correct --program", program.display());
    }
    let folder = std::path::absolute(&args.folder)?;
    if folder.starts_with(&program) {
        bail!(
            "'{}' lies in the program's folder, so that its files would be read as a part of the program; name \
             another folder",
            folder.display()
        );
    }
    if let Some(risk) = &args.risk {
        slack::share(risk)?;
    }
    Ok(State {
        program: program.display().to_string(),
        robot: args.robot.clone(),
        risk: args.risk.clone(),
    })
}

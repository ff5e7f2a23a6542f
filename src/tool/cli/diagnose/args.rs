//! The options of `joulepath diagnose`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::super::common::Format;
use super::super::excite::ExperimentArgs;

/// Find where a model differs from logs of its robot, which effect explains it, and how far the gap
/// shrinks.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath diagnose --robot nominal.toml --log run1.csv run2.csv --heldout other.csv --out model.toml"
)]
pub(in crate::tool::cli) struct DiagnoseArgs {
    /// The nominal model of the robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) robot: String,

    /// Logs of the robot as it is now, CSV or Parquet: `t`, `q1…` and `tau1…`, `i1…` or
    /// `ia1,ib1,ic1…`.
    #[arg(long, value_name = "FILE", required = true, num_args = 1..)]
    pub(super) log: Vec<PathBuf>,

    /// Logs used only for the evaluation; otherwise the last of several logs.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(super) heldout: Vec<PathBuf>,

    /// Logs from when the model was believed true.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(super) baseline: Vec<PathBuf>,

    /// The program that ran while the logs were recorded; their column `cmd` numbers its movements.
    #[arg(long, value_name = "PATH")]
    pub(super) program: Option<PathBuf>,

    /// How much the model's parameters are believed; by default commissioned with a baseline,
    /// otherwise cad.
    #[arg(long, value_enum)]
    pub(super) trust: Option<TrustArg>,

    /// Effects that may be found, such as payload,stribeck; with a minus before the first, all
    /// but these.
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(super) effects: Option<String>,

    /// Columns under other names, such as `q1_deg=J1,tau1=Torque_1`.
    #[arg(long, value_name = "CHANNEL=COLUMN,…", default_value = "", hide_default_value = true)]
    pub(super) map: String,

    /// Duration of a repetition, seconds; otherwise it is found.
    #[arg(long, value_name = "SECONDS")]
    pub(super) period: Option<f64>,

    /// Where the improved model goes, Robot TOML.
    #[arg(long, value_name = "MODEL.toml")]
    pub(super) out: Option<PathBuf>,

    /// A page with residuals, shapes of the effects and shares of the gap.
    #[arg(long, value_name = "FILE.html")]
    pub(super) report: Option<PathBuf>,

    /// Where the RAPID of the experiment goes that tells apart what is left.
    #[arg(long, value_name = "DIR")]
    pub(super) next: Option<PathBuf>,

    #[command(flatten, next_help_heading = "The next experiment (--next)")]
    pub(super) experiment: ExperimentArgs,

    /// Print the answers of all gates that lead to the verdict.
    #[arg(long)]
    pub(super) explain: bool,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(super) format: Format,

    /// No notes on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// How much parameters are believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::tool::cli) enum TrustArg {
    /// Identified on this robot.
    Commissioned,
    /// From drawings.
    Cad,
    /// Not at all.
    Unknown,
}

impl TrustArg {
    pub(super) fn name(self) -> &'static str {
        match self {
            TrustArg::Commissioned => "commissioned",
            TrustArg::Cad => "cad",
            TrustArg::Unknown => "unknown",
        }
    }
}

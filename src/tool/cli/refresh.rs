//! `joulepath refresh`: plans the streams of a retrofitted program again from its current data.

use std::process::ExitCode;

use clap::Args;

use super::optimize::{self, OptimizeArgs};

/// Make the streams of a retrofitted program anew from its present data, and show the difference.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath refresh optimized --robot IRB1600-10/1.45 --in-place\n\n\
                  The streams are taken out: what remains is the original program with the points, \
                  tools and other data of today. It is optimised again. Give the options that were \
                  given to optimize."
)]
pub(super) struct RefreshArgs {
    #[command(flatten)]
    optimize: OptimizeArgs,
}

pub(super) fn run(args: &RefreshArgs) -> anyhow::Result<ExitCode> {
    optimize::refresh(&args.optimize)
}

//! Cases of an examination as files.

use std::path::Path;
use std::process::ExitCode;

use anyhow::bail;
use rayon::prelude::*;

use super::super::{common, output};
use crate::examine::blind::{Case, KEY, SEALS, seal};

/// Writes the cases with the numbers 1 to `count` and their seals.
pub(super) fn write_cases(
    out: &Path,
    count: u32,
    quiet: bool,
    case: impl Fn(usize) -> anyhow::Result<Case> + Sync,
) -> anyhow::Result<ExitCode> {
    if out.join(KEY).exists() || out.join(SEALS).exists() {
        bail!(
            "'{}' has cases with seals already; name a new folder with --out, or remove that one",
            out.display()
        );
    }
    let progress = common::progress(quiet, Some(u64::from(count)));
    let labels: anyhow::Result<Vec<_>> = (1..=count as usize)
        .into_par_iter()
        .map(|number| {
            let case = case(number)?;
            let files = case.files.iter().map(|(name, text)| (name, text));
            output::write_folder(&out.join(&case.name), files)?;
            progress.inc(1);
            Ok((case.label, case.salt))
        })
        .collect();
    let sealed = seal(&labels?)?;
    output::write(&out.join(KEY), sealed.key.as_bytes())?;
    output::write(&out.join(SEALS), sealed.seals.as_bytes())?;
    progress.finish_and_clear();
    let text = format!("{count} cases in '{}', the truth sealed in {KEY}", out.display());
    common::note(quiet, &text);
    Ok(ExitCode::SUCCESS)
}

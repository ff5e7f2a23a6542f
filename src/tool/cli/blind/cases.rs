//! Cases of an examination as files.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, bail};
use rayon::prelude::*;
use serde_json::Value;

use super::super::{common, diagnose, output};
use crate::examine::blind::{Case, KEY, Label, SEALS, Sealed, open, seal};

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

/// The unsealed labels of a folder.
pub(super) fn labels(cases: &Path) -> anyhow::Result<Vec<Label>> {
    let sealed = Sealed { seals: read(&cases.join(SEALS))?, key: read(&cases.join(KEY))? };
    let labels = open(&sealed)?;
    // A case name must not lead out of the folder.
    let leads_out =
        |label: &&Label| label.case.contains(['/', '\\']) || label.case.starts_with('.');
    if let Some(label) = labels.iter().find(leads_out) {
        bail!("{KEY}: '{}' is not a case name; use the file that was generated", label.case);
    }
    Ok(labels)
}

/// The options of a case.
pub(super) fn options(case: &Path) -> anyhow::Result<Value> {
    serde_json::from_str(&read(&case.join("case.json"))?)
        .with_context(|| format!("'{}' has no case.json", case.display()))
}

/// The text of a file of a folder that `blind generate` wrote.
pub(super) fn read(path: &Path) -> anyhow::Result<String> {
    let shown = path.display();
    fs::read_to_string(path).with_context(|| {
        format!("cannot read '{shown}'; name the folder that joulepath blind generate wrote")
    })
}

/// A diagnosis that was written.
pub(super) fn known_diagnosis(path: &Path) -> anyhow::Result<Value> {
    let shown = path.display();
    serde_json::from_str(&read(path)?)
        .with_context(|| format!("'{shown}' is no JSON; write it again with diagnose"))
}

/// The JSON of `diagnose` for a case without some effects; stored as `name` in the case folder.
pub(super) fn diagnosis_of_case(
    case: &Path,
    name: &str,
    without: &[&str],
) -> anyhow::Result<Value> {
    let value = diagnose::diagnose_case(case, &options(case)?, without)
        .with_context(|| case.display().to_string())?;
    // A cache for the next grading.
    let text = format!("{value:#}\n");
    output::write(&case.join(name), text.as_bytes())?;
    Ok(value)
}

//! The files of the emitted program.

use super::candidate::Candidate;
use super::emission_context::EmissionContext;
use super::emitted_sites::{emitted_site, emitted_wait};
use super::error::RetrofitError;
use super::files::{OutputFile, unchanged, with_edits};
use super::job::Original;
use super::relocated_waits::RelocatedWait;
use crate::rapid::text::Span;
use crate::tool::emit;

/// Emits the streams of the candidates and the relocated waits; other files stay unchanged.
pub(super) fn emitted(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    candidates: &[Candidate],
    waits: &[RelocatedWait],
) -> Result<Outputs, RetrofitError> {
    let files = context.files;
    let mut emitted_sites: Vec<emit::Site> = (0..original.sites.len())
        .filter_map(|site| emitted_site(context, original, candidates, site))
        .collect();
    emitted_sites.extend(waits.iter().filter_map(|wait| emitted_wait(context, original, wait)));
    if emitted_sites.is_empty() {
        return Ok(Outputs { files: unchanged(files), guards: Vec::new() });
    }
    let emitted = emit::emit(&context.emission, &emitted_sites)?;
    // Insertions at distinct places cannot overlap.
    let mut outputs =
        with_edits(files, emitted.edits.into_iter()).unwrap_or_else(|| unchanged(files));
    let entry_file = &files[context.beside];
    let folder = entry_file.relative.rsplit_once('/').map_or("", |(folder, _)| folder);
    let end_of_line = emit::end_of_line(&entry_file.file.bytes);
    for (name, text) in emitted.modules {
        let path =
            if folder.is_empty() { format!("{name}.mod") } else { format!("{folder}/{name}.mod") };
        outputs.push(OutputFile::added(path, text.replace('\n', end_of_line)));
    }
    let guards = emitted_sites.iter().map(|site| site.span).zip(emitted.instructions).collect();
    Ok(Outputs { files: outputs, guards })
}

pub(super) struct Outputs {
    pub(super) files: Vec<OutputFile>,
    /// Places with guards, and the number of RAPID instructions of these in a cycle.
    pub(super) guards: Vec<(Span, usize)>,
}

//! The files of the emitted program.

use std::collections::BTreeSet;

use super::candidate::{Candidate, with_stream};
use super::emission_context::EmissionContext;
use super::emitted_sites::{EmittedPiece, emitted_pieces, emitted_wait};
use super::error::RetrofitError;
use super::files::{OutputFile, unchanged, with_edits};
use super::job::Original;
use super::relocated_waits::RelocatedWait;
use crate::rapid::text::{FileId, Span};
use crate::retime::motion::timeline::{Event, What};
use crate::tool::emit::{self, Stop};

/// Emits the streams of the candidates and the relocated waits; other files stay unchanged.
pub(super) fn emitted(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    candidates: &[Candidate],
    waits: &[RelocatedWait],
) -> Result<Outputs, RetrofitError> {
    let files = context.files;
    let pieces = emitted_pieces(context, original, candidates);
    let mut sites: Vec<emit::Site> = pieces.iter().map(|piece| piece.site.clone()).collect();
    sites.extend(waits.iter().filter_map(|wait| emitted_wait(context, original, wait)));
    if sites.is_empty() {
        return Ok(Outputs { files: unchanged(files), guards: Vec::new() });
    }
    let stops = stops(original, candidates, &sites);
    let emitted = emit::emit(&context.emission, &sites, &stops)?;
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
    let alone = std::iter::repeat_with(|| None);
    let guards = pieces.into_iter().map(Some).chain(alone).zip(emitted.instructions);
    let guards = guards.map(|(piece, instructions)| Guarded { piece, instructions });
    let made_up_for = stops.iter().map(|stop| Guarded {
        piece: None,
        instructions: MAKE_UP * executions(original, stop.span),
    });
    Ok(Outputs { files: outputs, guards: guards.chain(made_up_for).collect() })
}

/// Instructions before a stop if no movement is put off.
const MAKE_UP: usize = 4;

/// Number of executions of a movement, wait or output in a cycle.
fn executions(original: &Original<'_>, stmt: Span) -> usize {
    let executed = |event: &Event| match &event.what {
        What::Run(run) => run.moves.iter().filter(|it| it.movement.span == stmt).count(),
        What::Wait(record) => usize::from(record.wait.span == stmt),
        What::Output(output, _) => usize::from(output.span == stmt),
        What::Left(left) => usize::from(left.span == stmt),
    };
    original.cycle.simulation.events.iter().map(executed).sum()
}

/// The statements without a guard before which movements that were put off are made up for.
fn stops(original: &Original<'_>, candidates: &[Candidate], sites: &[emit::Site]) -> Vec<Stop> {
    let begins: BTreeSet<(FileId, u32)> =
        sites.iter().map(|site| (site.span.file, site.span.start)).collect();
    let stops: BTreeSet<Span> = with_stream(candidates)
        .flat_map(|(_, candidate)| original.sites[candidate.site].stops.iter().copied())
        .filter(|stop| !begins.contains(&(stop.file, stop.start)))
        .collect();
    let compact = original.program.in_compact_ifs();
    let stop = |span: Span| Stop { span, is_compact: compact.contains(&span) };
    stops.into_iter().map(stop).collect()
}

pub(super) struct Outputs {
    pub(super) files: Vec<OutputFile>,
    pub(super) guards: Vec<Guarded>,
}

/// A guard in the emitted program, or a statement before which movements are made up for.
pub(super) struct Guarded {
    /// Its piece; `None` for a wait or such a statement.
    piece: Option<EmittedPiece>,
    /// Number of RAPID instructions in a cycle.
    pub(super) instructions: usize,
}

impl Guarded {
    /// Number of instructions in a cycle for a site of the original.
    pub(super) fn instructions_of(&self, site: usize) -> f64 {
        let share = self.piece.as_ref().map_or(0.0, |piece| piece.share_of(site));
        share * self.instructions as f64
    }
}

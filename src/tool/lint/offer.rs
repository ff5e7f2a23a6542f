//! Which fixes are offered: each is made in the text and simulated before.

use std::sync::Arc;

use super::evaluate::Cycle;
use super::group::Group;
use super::job::Job;
use super::parsed::{ParsedFile, program};
use super::process::{Kept, same_order, same_process};
use super::rule::{Family, Finding};
use super::runs;
use crate::rapid::text::{Edit, FileId};

/// Rounding of an energy, J.
pub(super) const ROUNDING: f64 = 1e-6;

/// Takes the fixes back that are not simulated, or after which the program takes more energy, or has
/// not the same targets, waits and outputs in the same order. Fixes of comments need no simulation.
pub(super) fn offer_fixes(
    job: &Job<'_>,
    group: &Group,
    read: &[Arc<ParsedFile>],
    cycle: Option<&Cycle>,
    findings: &mut [Finding],
) {
    let is_meant = |it: &Finding| it.fix.is_some() && it.rule.family != Family::Comments;
    let mut open: Vec<usize> =
        (0..findings.len()).filter(|index| is_meant(&findings[*index])).collect();
    open.retain(|index| {
        let kept = cycle.is_some() && findings[*index].saving.is_some();
        if !kept {
            findings[*index].fix = None;
        }
        kept
    });
    let Some(before) = cycle else { return };
    while !open.is_empty() {
        // Fixes of different places are tried together: most of them hold.
        let together = disjoint(&open, findings);
        let fixes = |of: &[usize]| -> Vec<Edit> {
            let fixes = of.iter().filter_map(|index| findings[*index].fix.as_ref());
            fixes.flat_map(|fix| fix.edits.iter().cloned()).collect()
        };
        let holds = |of: &[usize]| keeps_work(job, group, read, before, &fixes(of));
        let lost: Vec<usize> = if holds(&together) {
            Vec::new()
        } else if together.len() == 1 {
            together.clone()
        } else {
            together.iter().copied().filter(|index| !holds(&[*index])).collect()
        };
        for index in lost {
            findings[index].fix = None;
        }
        open.retain(|index| !together.contains(index));
    }
}

/// The largest leading choice of findings whose fixes change no text of each other.
fn disjoint(open: &[usize], findings: &[Finding]) -> Vec<usize> {
    let mut taken = Places::default();
    open.iter().copied().filter(|index| taken.take(&findings[*index])).collect()
}

/// Places of texts that fixes change.
#[derive(Default)]
pub(super) struct Places(Vec<(FileId, u32, u32)>);

impl Places {
    /// Whether the statement and the edits of a finding are free; then they are taken.
    pub(super) fn take(&mut self, finding: &Finding) -> bool {
        let mut places = vec![(finding.span.file, finding.span.start, finding.span.end)];
        let edits = finding.fix.iter().flat_map(|fix| &fix.edits);
        places.extend(edits.map(|edit| (edit.span.file, edit.span.start, edit.span.end)));
        let is_free = places.iter().all(|(file, start, end)| {
            !self.0.iter().any(|(f, s, e)| f == file && start < e && s < end)
        });
        if is_free {
            self.0.extend(places);
        }
        is_free
    }
}

/// Whether the program with some edits takes no more energy for the same work in the same order.
fn keeps_work(
    job: &Job<'_>,
    group: &Group,
    read: &[Arc<ParsedFile>],
    before: &Cycle,
    edits: &[Edit],
) -> bool {
    let mut read = read.to_vec();
    for index in &group.files {
        let file = &job.files[*index];
        let own: Vec<Edit> = edits.iter().filter(|edit| edit.span.file == file.id).cloned().collect();
        if own.is_empty() {
            continue;
        }
        let Ok(edited) = file.edited(&own) else { return false };
        let parsed = ParsedFile::new(&edited);
        if parsed.errors.len() > read[*index].errors.len() {
            return false;
        }
        read[*index] = Arc::new(parsed);
    }
    let program = program(group, &read);
    let after = runs::cycle(job, &program, program.entry(&group.entry));
    job.model.zip(after).is_some_and(|(model, after)| {
        after.account.total.energy_j() <= before.account.total.energy_j() + ROUNDING
            && same_order(&before.simulation, &after.simulation)
            && same_process(model, &before.simulation, &after.simulation, Kept::Waits)
    })
}

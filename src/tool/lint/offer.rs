//! Which fixes are offered: each is made in the text and simulated before.

use std::sync::Arc;

use super::evaluate::Cycle;
use super::group::Group;
use super::job::Job;
use super::known::Known;
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
    known: Option<&Known>,
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
        let together = disjoint(&open, findings);
        open.retain(|index| !together.contains(index));
        let holds = |of: &[usize]| {
            let fixes = of.iter().filter_map(|index| findings[*index].fix.as_ref());
            let edits: Vec<Edit> = fixes.flat_map(|fix| fix.edits.iter().cloned()).collect();
            keeps_work(job, known, group, read, before, &edits)
        };
        for index in failing(&together, &holds) {
            findings[index].fix = None;
        }
    }
}

/// Those of some fixes that do not hold. Most do, so that they are tried together, and by halves where
/// that fails.
fn failing(of: &[usize], holds: &(impl Fn(&[usize]) -> bool + Sync)) -> Vec<usize> {
    if holds(of) {
        return Vec::new();
    }
    if of.len() == 1 {
        return of.to_vec();
    }
    let (left, right) = of.split_at(of.len() / 2);
    let (left, right) = rayon::join(|| failing(left, holds), || failing(right, holds));
    [left, right].concat()
}

/// The first findings whose fixes change no text of each other.
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
    known: Option<&Known>,
    group: &Group,
    read: &[Arc<ParsedFile>],
    before: &Cycle,
    edits: &[Edit],
) -> bool {
    let mut read = read.to_vec();
    for index in &group.files {
        let file = &job.files[*index];
        let own: Vec<Edit> =
            edits.iter().filter(|edit| edit.span.file == file.id).cloned().collect();
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
    let after = runs::cycle(job, known, &program, program.entry(&group.entry));
    job.model.zip(after).is_some_and(|(model, after)| {
        after.account.total.energy_j() <= before.account.total.energy_j() + ROUNDING
            && same_order(&before.simulation, &after.simulation)
            && same_process(model, &before.simulation, &after.simulation, Kept::Waits)
    })
}

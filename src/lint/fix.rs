//! Applies fixes, and takes them back where the cycle does not get better by them.

use std::collections::BTreeSet;

use super::engine::{Job, cycles, lint};
use super::finding::{Applicability, Finding};
use super::rule::Family;
use super::weigh::Cycle;
use super::{Report, trace};
use crate::lint::trace::Deed;
use crate::motion::timeline::What;
use crate::path::joint_path::{DOF, Joints};
use crate::syntax;
use crate::text::{Edit, FileId, SourceFile, apply};

/// Rounds of fixing what was found after the last one.
const MOST_ROUNDS: usize = 12;
/// Distance of two places that count as one, rad.
const SAME: f64 = 1e-4;
/// Rounding of an energy, J.
const ROUNDING: f64 = 1e-6;

/// What became of the files.
#[derive(Debug)]
pub struct Fixed {
    /// All files, as they are now.
    pub files: Vec<SourceFile>,
    /// Fixes that stayed.
    pub applied: usize,
    /// Fixes that were taken back.
    pub withdrawn: usize,
    /// What is left to find.
    pub report: Report,
}

/// Applies the fixes up to an applicability until nothing is left to fix. Each is simulated
/// before and after, and stays only where the cycle takes less energy with the same waits and
/// outputs in the same order at the same places.
#[must_use]
pub fn fix(job: &Job<'_>, most: Applicability) -> Fixed {
    let mut files = job.files.to_vec();
    let mut refused: BTreeSet<(u32, &'static str, Vec<u8>)> = BTreeSet::new();
    let mut applied = 0;
    for _ in 0..MOST_ROUNDS {
        let now =
            Job { files: &files, groups: job.groups.clone(), options: job.options.clone(), ..*job };
        let report = lint(&now);
        let mut chosen = candidates(&report, &files, most);
        chosen.retain(|finding| !refused.contains(&key(finding, &files)));
        if chosen.is_empty() {
            break;
        }
        let before = cycles(&now);
        // All at once if they go together, else one after the other.
        if let Some(after) = attempt(job, &files, &before, &chosen) {
            applied += chosen.len();
            files = after;
            continue;
        }
        let mut any = false;
        for finding in &chosen {
            if let Some(after) = attempt(job, &files, &before, &[finding]) {
                applied += 1;
                files = after;
                any = true;
                // What else was found may stand elsewhere now.
                break;
            }
            refused.insert(key(finding, &files));
        }
        if !any {
            break;
        }
    }
    let now =
        Job { files: &files, groups: job.groups.clone(), options: job.options.clone(), ..*job };
    let report = lint(&now);
    Fixed { applied, withdrawn: refused.len(), report, files }
}

/// What tells a fix from others while other places change: file, rule and text.
fn key(finding: &Finding, files: &[SourceFile]) -> (u32, &'static str, Vec<u8>) {
    let file = &files[finding.span.file.0 as usize];
    (finding.span.file.0, finding.rule.code, file.slice(finding.span).to_vec())
}

/// Fixes that can be tried together: the largest savings first, none of them about a statement
/// or a text that another one changes.
fn candidates<'r>(
    report: &'r Report,
    files: &[SourceFile],
    most: Applicability,
) -> Vec<&'r Finding> {
    let simulated = |finding: &&Finding| {
        let comment = finding.rule.family == Family::Comments;
        let fix = finding.fix.as_ref();
        (finding.saving.is_some() || comment) && fix.is_some_and(|fix| fix.applicability <= most)
    };
    let mut list: Vec<&Finding> = report.findings.iter().filter(simulated).collect();
    let joules = |finding: &Finding| finding.saving.map_or(0.0, |saving| saving.energy_j);
    list.sort_by(|a, b| joules(b).total_cmp(&joules(a)));
    let mut taken: Vec<(FileId, u32, u32)> = Vec::new();
    list.retain(|finding| {
        let mut places = vec![(finding.span.file, finding.span.start, finding.span.end)];
        let edits = finding.fix.iter().flat_map(|fix| &fix.edits);
        places.extend(edits.map(|edit| (edit.span.file, edit.span.start, edit.span.end)));
        let free = places.iter().all(|(file, start, end)| {
            !taken.iter().any(|(f, s, e)| f == file && start < e && s < end)
                && file.0 < files.len() as u32
        });
        if free {
            taken.extend(places);
        }
        free
    });
    list
}

/// The files with the fixes, if they hold.
fn attempt(
    job: &Job<'_>,
    files: &[SourceFile],
    before: &[Option<Cycle>],
    findings: &[&Finding],
) -> Option<Vec<SourceFile>> {
    let mut changed = files.to_vec();
    for (index, file) in files.iter().enumerate() {
        let edits: Vec<Edit> = findings
            .iter()
            .filter_map(|finding| finding.fix.as_ref())
            .flat_map(|fix| fix.edits.iter().filter(|edit| edit.span.file == file.id).cloned())
            .collect();
        if edits.is_empty() {
            continue;
        }
        let bytes = apply(&file.bytes, &edits).ok()?;
        let errors = |bytes: &[u8]| syntax::parse(bytes).errors.len();
        if errors(&bytes) > errors(&file.bytes) {
            return None;
        }
        let stored = file.stored(&bytes).into_owned();
        changed[index] = SourceFile::new(file.id, file.path.clone(), stored);
    }
    let comments = findings.iter().all(|finding| finding.rule.family == Family::Comments);
    let now =
        Job { files: &changed, groups: job.groups.clone(), options: job.options.clone(), ..*job };
    let after = cycles(&now);
    let mut better = comments;
    for (before, after) in before.iter().zip(&after) {
        match (before, after) {
            (Some(before), Some(after)) => {
                let spared = before.account.total.energy_j() - after.account.total.energy_j();
                if spared < -ROUNDING || !same_process(before, after) {
                    return None;
                }
                better |= spared > ROUNDING;
            }
            (None, None) => {}
            _ => return None,
        }
    }
    (better && before.len() == after.len()).then_some(changed)
}

/// Whether two cycles wait for the same and set the same outputs, in the same order and at the
/// same places, and end at the same place.
fn same_process(before: &Cycle, after: &Cycle) -> bool {
    let deeds = |cycle: &Cycle| -> Vec<String> {
        let trace = trace::of_simulation(&cycle.simulation);
        let deeds = trace.iter().filter_map(|done| match &done.what {
            Deed::Output(output) => Some(format!("{} {}", output.signal, output.value)),
            Deed::Wait(wait, basis) => {
                let length = wait.duration.unwrap_or_default();
                Some(format!("{} {:?} {basis:?} {length}", wait.instruction, wait.signal))
            }
            Deed::Left(_) => Some("elsewhere".to_owned()),
            Deed::Move(_) => None,
        });
        deeds.collect()
    };
    let places = |cycle: &Cycle| -> Vec<Joints> {
        let events = &cycle.simulation.events;
        let waits = events.iter().filter_map(|event| match &event.what {
            What::Wait(wait) => Some(wait.q),
            _ => None,
        });
        let last = events.iter().rev().find_map(|event| match &event.what {
            What::Run(run) => Some(run.end),
            _ => None,
        });
        waits.chain(last).collect()
    };
    let sound = |cycle: &Cycle| {
        cycle
            .simulation
            .events
            .iter()
            .filter(|event| match &event.what {
                What::Run(run) => run.problem.is_some(),
                _ => false,
            })
            .count()
    };
    let (a, b) = (places(before), places(after));
    let near = |(a, b): (&Joints, &Joints)| (0..DOF).all(|j| (a[j] - b[j]).abs() <= SAME);
    deeds(before) == deeds(after)
        && a.len() == b.len()
        && a.iter().zip(&b).all(near)
        && sound(after) <= sound(before)
}

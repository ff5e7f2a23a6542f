//! Runs all rules on all programs.

use std::collections::BTreeSet;
use std::sync::Arc;

use rayon::prelude::*;

use super::context::Context;
use super::coverage::Coverage;
use super::evaluate::Cycle;
use super::group::Group;
use super::job::Job;
use super::known::Known;
use super::offer::offer_fixes;
use super::parsed::{ParsedFile, program, programs, read};
use super::ranking::severity;
use super::register::ALL;
use super::report::Report;
use super::rule::{CycleFigures, Finding};
use super::rules::unused_suppression;
use super::runs;
use super::stored::{Reports, Store};
use super::weighing::state_needs;
use crate::arm::robot::Model;
use crate::rapid::text::Span;

pub use super::parsed::ReadCache;

/// A report with the simulated cycle of each program, in program order; `None` without a robot or
/// an entry.
pub struct Examined {
    /// The report.
    pub report: Report,
    /// The cycles.
    pub cycles: Vec<Option<Cycle>>,
    /// The files of each program.
    pub programs: Vec<Vec<usize>>,
}

/// Lints all programs.
#[must_use]
pub fn lint(job: &Job<'_>) -> Report {
    lint_programs(job, None)
}

/// Lints the programs that have changed since their reports were kept in a store.
#[must_use]
pub fn lint_changed(job: &Job<'_>, store: &dyn Store) -> Report {
    lint_programs(job, Some(&Reports::new(job, store)))
}

fn lint_programs(job: &Job<'_>, reports: Option<&Reports<'_>>) -> Report {
    let read = read(job);
    // Cycles are not kept: those of all programs of a plant would fill the memory.
    let known = job.model.map(Known::new);
    let report = |group: &Group| {
        let lint = || lint_group(job, known.as_ref(), group, &read).0;
        match reports {
            Some(reports) => reports.report(group, lint),
            None => lint(),
        }
    };
    let mut report = merged(programs(job, &read).par_iter().map(report).collect());
    let modules: BTreeSet<usize> =
        job.groups.iter().flat_map(|group| group.files.iter().copied()).collect();
    let errors = modules.into_iter().map(|file| (file, read[file].errors.clone()));
    report.syntax_errors = errors.filter(|(_, errors)| !errors.is_empty()).collect();
    report
}

/// Lints all programs; also returns their cycles. `known` belongs to the robot of the job.
#[must_use]
pub fn examine(job: &Job<'_>, known: Option<&Known>) -> Examined {
    let read = read(job);
    let groups = programs(job, &read);
    examine_programs(job, known, &groups, &read)
}

/// Lints the programs that contain a file; only changed files are parsed again, and only changed movements
/// are simulated again.
#[must_use]
pub fn examine_file(job: &Job<'_>, file: usize, kept: &mut ReadCache) -> Examined {
    let read = kept.read(job);
    let mut groups = programs(job, &read);
    groups.retain(|group| group.files.contains(&file));
    let known = kept.known(job.model);
    examine_programs(job, known.as_ref(), &groups, &read)
}

fn examine_programs(
    job: &Job<'_>,
    known: Option<&Known>,
    groups: &[Group],
    read: &[Arc<ParsedFile>],
) -> Examined {
    let (reports, cycles) =
        groups.par_iter().map(|group| lint_group(job, known, group, read)).unzip();
    let programs = groups.iter().map(|group| group.files.clone()).collect();
    Examined { report: merged(reports), cycles, programs }
}

fn merged(reports: Vec<Report>) -> Report {
    let mut all = Report::default();
    for report in reports {
        all.findings.extend(report.findings);
        all.unresolved += report.unresolved;
        all.coverage.add(report.coverage);
        if let Some(energy) = report.cycle_energy_j {
            *all.cycle_energy_j.get_or_insert(0.0) += energy;
        }
    }
    all.findings.sort_by_key(|it| (it.span.file, it.span.start, it.span.end, it.rule.code));
    all.findings.dedup_by(|a, b| a.span == b.span && a.rule.code == b.rule.code);
    all
}

/// The simulated cycle of each program, in program order; `None` without a robot or an entry.
#[must_use]
pub fn cycles(job: &Job<'_>, known: Option<&Known>) -> Vec<Option<Cycle>> {
    let read = read(job);
    let cycle = |group: &Group| {
        let program = program(group, &read);
        runs::cycle(job, known, &program, program.entry(&group.entry))
    };
    programs(job, &read).par_iter().map(cycle).collect()
}

fn lint_group(
    job: &Job<'_>,
    known: Option<&Known>,
    group: &Group,
    read: &[Arc<ParsedFile>],
) -> (Report, Option<Cycle>) {
    let program = program(group, read);
    let entry = program.entry(&group.entry);
    let cycle = runs::cycle(job, known, &program, entry);
    let recording = cycle.is_none().then(|| runs::recording(&program, entry));
    let context =
        Context::new(job.files, job.model, &program, group, cycle.as_ref(), recording.as_ref());
    let mut findings = Vec::new();
    for rule in ALL.iter().filter(|rule| job.settings.selects(rule)) {
        (rule.check)(&context, &mut findings);
    }
    suppress(job, group, read, &mut findings);
    let settings = job.settings;
    findings.retain(|finding| {
        let path = &job.files[finding.span.file.0 as usize].path;
        let worth = finding
            .saving
            .is_none_or(|saving| saving.energy_j >= settings.threshold_j(finding.rule));
        worth && !settings.ignores_in(finding.rule, path)
    });
    let dynamics = job.model.is_some_and(Model::has_dynamics);
    // An endless wait has infinite energy, which cannot be added up.
    let energy = cycle
        .as_ref()
        .filter(|_| dynamics)
        .map(|cycle| cycle.account.total.energy_j())
        .filter(|energy| energy.is_finite());
    let coverage = Coverage::new(&context);
    let unresolved = context.unresolved.len();
    let time = cycle.as_ref().map(|cycle| cycle.simulation.cycle_s);
    let figures = energy.zip(time).map(|(energy_j, time_s)| CycleFigures { energy_j, time_s });
    offer_fixes(job, known, group, read, cycle.as_ref(), &mut findings);
    state_needs(&context, &mut findings);
    for finding in &mut findings {
        finding.cycle = figures;
        finding.severity = severity(finding);
    }
    let report =
        Report { findings, cycle_energy_j: energy, unresolved, coverage, ..Report::default() };
    (report, cycle)
}

/// Removes the suppressed findings, and adds findings for unused suppressions.
fn suppress(job: &Job<'_>, group: &Group, read: &[Arc<ParsedFile>], findings: &mut Vec<Finding>) {
    // Keys: file, comment, code of the comment.
    let mut used: BTreeSet<(usize, usize, usize)> = BTreeSet::new();
    findings.retain(|finding| {
        let file = finding.span.file.0 as usize;
        let Some(read) = read.get(file) else { return true };
        let line = |at: u32| job.files[file].position(at).line;
        let Span { start, end, .. } = finding.span;
        let lines = line(start)..=line(end.saturating_sub(1).max(start));
        let mut kept = true;
        for (index, suppression) in read.suppressions.iter().enumerate() {
            if lines.contains(&suppression.line) {
                for code in suppression.naming(finding.rule) {
                    used.insert((file, index, code));
                    kept = false;
                }
            }
        }
        kept
    });
    if !job.settings.selects(&unused_suppression::RULE) {
        return;
    }
    for file in &group.files {
        for (index, suppression) in read[*file].suppressions.iter().enumerate() {
            let codes = suppression.codes.iter().enumerate();
            let unused = codes.filter(|(code, _)| !used.contains(&(*file, index, *code)));
            let unused: Vec<&str> = unused.map(|(_, code)| code.as_str()).collect();
            unused_suppression::report_unused(job, &ALL, suppression, &unused, findings);
        }
    }
}

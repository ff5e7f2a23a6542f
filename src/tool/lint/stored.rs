//! Reports that are kept between runs, so that unchanged programs are not linted again.

use serde::{Deserialize, Serialize};

use super::coverage::Coverage;
use super::group::Group;
use super::job::Job;
use super::register;
use super::report::Report;
use super::rule::{Applicability, Confidence, CycleFigures, Finding, Fix};
use super::saving::Saving;
use crate::rapid::diagnostics::Severity;
use crate::rapid::text::{Edit, FileId, Span};
use crate::retime::motion::memo::{Key, key};

/// Texts that are kept by name.
pub trait Store: Sync {
    /// The version of what writes the texts: a new one reads no old texts.
    fn version(&self) -> &str;
    /// The text with a name; `None` if there is none.
    fn read(&self, name: &str) -> Option<String>;
    /// Keeps a text.
    fn write(&self, name: &str, text: &str);
}

/// The reports of a job in a store.
pub(super) struct Reports<'j> {
    job: &'j Job<'j>,
    store: &'j dyn Store,
    /// The key of what all programs share: version, robot, options and settings.
    common: Key,
}

impl<'j> Reports<'j> {
    pub(super) fn new(job: &'j Job<'j>, store: &'j dyn Store) -> Reports<'j> {
        let common = key(&(store.version(), job.model, &job.options, job.settings));
        Reports { job, store, common }
    }

    /// The report of a program: the kept one if nothing has changed that it depends on.
    pub(super) fn report(&self, group: &Group, lint: impl FnOnce() -> Report) -> Report {
        let files = files(group);
        let texts: Vec<_> = files.iter().map(|file| &self.job.files[*file]).collect();
        let paths: Vec<&str> = texts.iter().map(|file| file.path.as_str()).collect();
        let bytes: Vec<Key> = texts.iter().map(|file| key(&file.bytes)).collect();
        let motion = group.system.as_ref().map(|system| (system.io.is_some(), &system.motion));
        let name = hex(&key(&(&self.common, &group.entry, paths)));
        let of = hex(&key(&(bytes, motion)));
        let kept = self.store.read(&name).and_then(|text| Stored::read(&text));
        let kept = kept.filter(|kept| kept.of == of);
        if let Some(report) = kept.and_then(|kept| kept.report(&files)) {
            return report;
        }
        let report = lint();
        let stored = Stored::new(of, &report, &files);
        if let Some(text) = stored.and_then(|stored| stored.text()) {
            self.store.write(&name, &text);
        }
        report
    }
}

/// The files that a report depends on.
fn files(group: &Group) -> Vec<usize> {
    let io = group.system.as_ref().and_then(|system| system.io);
    let io = io.map(|id| id.0 as usize).filter(|io| !group.files.contains(io));
    group.files.iter().copied().chain(io).collect()
}

/// The first half of a key as text: enough to tell programs apart.
fn hex(key: &Key) -> String {
    format!("{:032x}", u128::from_be_bytes(std::array::from_fn(|i| key[i])))
}

/// A number by its bits: no digit is lost, and it need not be finite.
type Bits = u64;

/// A span: place of its file among those of the program, start and end.
type Place = (usize, u32, u32);

/// A place and its new text.
type StoredEdit = (Place, Vec<u8>);

/// A report as it is kept.
#[derive(Serialize, Deserialize)]
struct Stored {
    /// The key of the texts.
    of: String,
    findings: Vec<StoredFinding>,
    cycle_energy_j: Option<Bits>,
    unresolved: usize,
    coverage: Coverage,
}

#[derive(Serialize, Deserialize)]
struct StoredFinding {
    rule: String,
    place: Place,
    message: String,
    change: String,
    /// Energy with its interval, time.
    saving: Option<[Bits; 4]>,
    assumptions: Vec<String>,
    /// Whether it is safe, and its edits.
    fix: Option<(bool, Vec<StoredEdit>)>,
    related: Vec<(Place, String)>,
    severity: u8,
    doubtful: bool,
    at_stake_j: Option<Bits>,
    needs: Option<String>,
    count: usize,
    /// Energy and time.
    cycle: Option<[Bits; 2]>,
}

const SEVERITIES: [Severity; 3] = [Severity::Info, Severity::Warning, Severity::Error];

impl Stored {
    /// The report as a text, with the key of the text before it: a damaged one is noticed.
    fn text(&self) -> Option<String> {
        let text = serde_json::to_string(self).ok()?;
        Some(format!("{}\n{text}", hex(&key(&text))))
    }

    /// `None` if the text is damaged.
    fn read(text: &str) -> Option<Stored> {
        let (sum, text) = text.split_once('\n')?;
        let whole = sum == hex(&key(&text));
        whole.then(|| serde_json::from_str(text).ok())?
    }

    /// `None` if a span is in none of the files.
    fn new(of: String, report: &Report, files: &[usize]) -> Option<Stored> {
        let place = |span: Span| {
            let file = files.iter().position(|file| *file == span.file.0 as usize)?;
            Some((file, span.start, span.end))
        };
        let finding = |it: &Finding| {
            let edits = |fix: &Fix| {
                let edits =
                    fix.edits.iter().map(|edit| Some((place(edit.span)?, edit.text.clone())));
                Some((fix.applicability == Applicability::Safe, edits.collect::<Option<_>>()?))
            };
            let related = it.related.iter().map(|(span, text)| Some((place(*span)?, text.clone())));
            let saving = it.saving.map(|saving| {
                [saving.energy_j, saving.low_j, saving.high_j, saving.time_s].map(f64::to_bits)
            });
            Some(StoredFinding {
                rule: it.rule.code.to_owned(),
                place: place(it.span)?,
                message: it.message.clone(),
                change: it.change.clone(),
                saving,
                assumptions: it.assumptions.clone(),
                fix: match &it.fix {
                    Some(fix) => Some(edits(fix)?),
                    None => None,
                },
                related: related.collect::<Option<_>>()?,
                severity: SEVERITIES.iter().position(|of| *of == it.severity)? as u8,
                doubtful: it.confidence == Confidence::Low,
                at_stake_j: it.at_stake_j.map(f64::to_bits),
                needs: it.needs.clone(),
                count: it.count,
                cycle: it.cycle.map(|cycle| [cycle.energy_j, cycle.time_s].map(f64::to_bits)),
            })
        };
        Some(Stored {
            of,
            findings: report.findings.iter().map(finding).collect::<Option<_>>()?,
            cycle_energy_j: report.cycle_energy_j.map(f64::to_bits),
            unresolved: report.unresolved,
            coverage: report.coverage.clone(),
        })
    }

    /// The report of the files; `None` if it is damaged.
    fn report(self, files: &[usize]) -> Option<Report> {
        let span = |(file, start, end): Place| {
            Some(Span { file: FileId(*files.get(file)? as u32), start, end })
        };
        let finding = |it: StoredFinding| {
            let edits = |(safe, edits): (bool, Vec<StoredEdit>)| {
                let edits =
                    edits.into_iter().map(|(at, text)| Some(Edit { span: span(at)?, text }));
                let applicability = if safe { Applicability::Safe } else { Applicability::Unsafe };
                Some(Fix { applicability, edits: edits.collect::<Option<_>>()? })
            };
            let related = it.related.into_iter().map(|(at, text)| Some((span(at)?, text)));
            let saving = it.saving.map(|bits| {
                let [energy_j, low_j, high_j, time_s] = bits.map(f64::from_bits);
                Saving { energy_j, low_j, high_j, time_s }
            });
            let cycle = it.cycle.map(|bits| {
                let [energy_j, time_s] = bits.map(f64::from_bits);
                CycleFigures { energy_j, time_s }
            });
            Some(Finding {
                rule: register::find(&it.rule)?,
                span: span(it.place)?,
                message: it.message,
                change: it.change,
                saving,
                assumptions: it.assumptions,
                fix: match it.fix {
                    Some(fix) => Some(edits(fix)?),
                    None => None,
                },
                related: related.collect::<Option<_>>()?,
                severity: *SEVERITIES.get(usize::from(it.severity))?,
                confidence: if it.doubtful { Confidence::Low } else { Confidence::Usual },
                at_stake_j: it.at_stake_j.map(f64::from_bits),
                needs: it.needs,
                count: it.count,
                cycle,
            })
        };
        Some(Report {
            findings: self.findings.into_iter().map(finding).collect::<Option<_>>()?,
            cycle_energy_j: self.cycle_energy_j.map(f64::from_bits),
            unresolved: self.unresolved,
            coverage: self.coverage,
            syntax_errors: Vec::new(),
        })
    }
}

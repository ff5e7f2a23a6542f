//! What is found, as `waits.toml`.

use super::file::{
    After, EventEntry, FORMAT, KindEntry, RecordEntry, WaitEntry, WaitsFile, WayEntry,
};
use super::find::{Found, Wait};
use super::reference::Kind;
use super::samples::{Candidate, Sample};
use super::spread::median;
use super::verdict::{Reason, WaitKind};

/// Decimals of times: what a controller's clock resolves.
const PER_SECOND: f64 = 10_000.0;

/// The file of what is found.
#[must_use]
pub fn record(found: &Found) -> WaitsFile {
    let count = found.shift.frequencies().len();
    WaitsFile {
        format: FORMAT,
        program: found.shift.program.clone(),
        cycles: found.shift.cycles.len(),
        wait: found.waits.iter().map(entry).collect(),
        way: (0..count).map(|way| way_entry(found, way)).collect(),
    }
}

impl WaitKind {
    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            WaitKind::Slack => "slack",
            WaitKind::Process => "process",
            WaitKind::Unknown => "unknown",
        }
    }
}

impl Reason {
    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Reason::CountsFrom => "counts-from",
            Reason::Answers => "answers",
            Reason::Stated => "stated",
            Reason::AlwaysThere => "always-there",
            Reason::TooFew => "too-few",
            Reason::CannotTell => "cannot-tell",
            Reason::Coupled => "coupled",
            Reason::Differs => "differs",
        }
    }
}

impl Wait {
    /// The reference of a slack.
    #[must_use]
    pub fn after(&self) -> Option<&Candidate> {
        let index = self.verdict.after.filter(|_| self.verdict.kind == WaitKind::Slack)?;
        self.samples.candidates.get(index)
    }
}

fn rounded(x: f64) -> f64 {
    // Without negative zeros.
    (x * PER_SECOND).round() / PER_SECOND + 0.0
}

fn entry(wait: &Wait) -> WaitEntry {
    let key = &wait.samples.key;
    let is_known = wait.quantiles_s.iter().all(|x| x.is_finite());
    // Any number as large says the same.
    let log_odds = wait.verdict.log_odds.clamp(-1e4, 1e4);
    WaitEntry {
        file: key.place.file.clone(),
        line: key.place.line,
        signal: key.signal.clone(),
        kind: match wait.verdict.kind {
            WaitKind::Slack => KindEntry::Slack,
            WaitKind::Process => KindEntry::Process,
            WaitKind::Unknown => KindEntry::Unknown,
        },
        reason: wait.verdict.reason.word().to_owned(),
        n: wait.samples.samples.len(),
        compared: wait.verdict.cycles,
        log_odds: (log_odds * 10.0).round() / 10.0 + 0.0,
        slope: wait.verdict.slope.map(|of| [of.value, of.low, of.high].map(rounded)),
        quantiles_s: is_known.then(|| wait.quantiles_s.map(rounded)),
        request: wait.samples.has_request(),
        after: wait.after().map(after),
    }
}

fn after(candidate: &Candidate) -> After {
    let mut after = After {
        event: EventEntry::Cycle,
        before: candidate.reference.before,
        file: None,
        line: None,
        signal: None,
        level: None,
    };
    let mut place = candidate.place.as_ref();
    match &candidate.reference.kind {
        Kind::Cycle => {}
        Kind::Start(at) => (after.event, place) = (EventEntry::Start, Some(at)),
        Kind::Arrive(at) => (after.event, place) = (EventEntry::Arrive, Some(at)),
        Kind::End(at) => (after.event, place) = (EventEntry::End, Some(at)),
        Kind::Output(name, level) | Kind::Signal(name, level) => {
            let is_output = matches!(candidate.reference.kind, Kind::Output(..));
            after.event = if is_output { EventEntry::Output } else { EventEntry::Signal };
            (after.signal, after.level) = (Some(name.clone()), Some(level.0));
        }
    }
    after.file = place.map(|place| place.file.clone());
    after.line = place.map(|place| place.line);
    after
}

/// A visit with the moment from which its times count.
type Visit<'a> = (&'a Sample, f64);

fn way_entry(found: &Found, way: usize) -> WayEntry {
    let shift = &found.shift;
    let of_way: Vec<usize> =
        (0..shift.cycles.len()).filter(|cycle| shift.ways[*cycle] == way).collect();
    let share = of_way.len() as f64 / shift.cycles.len() as f64;
    // Where the visits of each cycle are.
    let mut visits: Vec<Vec<(&Wait, Visit<'_>)>> = vec![Vec::new(); shift.cycles.len()];
    for wait in &found.waits {
        let start = |sample: &Sample| shift.cycles[sample.cycle].start;
        let pairs = |of: &Candidate| {
            let all = wait.samples.samples.iter().zip(of.times.clone());
            all.filter_map(|(sample, t)| Some(t? - start(sample))).collect::<Vec<f64>>()
        };
        // Where the log lacks the event in a cycle, it counts as being at its usual place: a cycle that is
        // left out because it was unusual would make the others look safer than they are.
        let usual = wait.after().map(|of| median(pairs(of)));
        for (index, sample) in wait.samples.samples.iter().enumerate() {
            let from = match wait.after() {
                None => start(sample),
                Some(of) if of.reference.before && !shift.follows[sample.cycle] => continue,
                Some(of) => of.times[index].unwrap_or(start(sample) + usual.unwrap_or_default()),
            };
            visits[sample.cycle].push((wait, (sample, from)));
        }
    }
    for visits in &mut visits {
        visits.sort_by(|a, b| a.1.0.came.total_cmp(&b.1.0.came));
    }
    let is_complete = |cycle: &&usize| visits[**cycle].len() == shift.cycles[**cycle].visits.len();
    let complete: Vec<usize> = of_way.iter().filter(is_complete).copied().collect();
    let Some(first) = complete.first() else {
        return WayEntry { share, cycle_s: Vec::new(), record: Vec::new() };
    };
    let record = visits[*first].iter().map(|(wait, (sample, _))| {
        let occurrence = sample.occurrence;
        let mut entry = RecordEntry {
            file: wait.samples.key.place.file.clone(),
            line: wait.samples.key.place.line,
            occurrence,
            came_s: Vec::new(),
            signal_s: Vec::new(),
        };
        for cycle in &complete {
            let same = visits[*cycle].iter().find(|(other, (sample, _))| {
                other.samples.key.place == wait.samples.key.place && sample.occurrence == occurrence
            });
            if let Some((_, (sample, from))) = same {
                entry.came_s.push(rounded(sample.came - from));
                entry.signal_s.push(rounded(sample.end() - from));
            }
        }
        entry
    });
    WayEntry {
        share: rounded(share),
        record: record.collect(),
        cycle_s: complete.iter().map(|cycle| rounded(shift.cycles[*cycle].duration())).collect(),
    }
}

//! Whether a wait is slack or process.
//!
//! The hypotheses of [`super::evidence`] are compared pairwise. A wait is slack if the best reference before
//! the robot's last movement beats every form of process, and process if that beats every such
//! reference; the odds asked for are those at which the error would be affordable.

use super::evidence::{Evidence, LogDensities};
use super::reference::{AT_ONCE_S, Kind};
use super::samples::{Candidate, Key, Samples};
use super::shift::Shift;
use super::slope::{Slope, slope};
use super::spread::{median, quantile, sorted};

/// Odds for slack: a process that a slower robot uses up makes every cycle longer.
const SLACK_ODDS: f64 = 1000.0;
/// Odds for process, and for a machine that answers in part: the error leaves a saving unused.
const PROCESS_ODDS: f64 = 20.0;
/// Most that one cycle counts, nats: no claim rests on a few cycles.
const MOST_OF_CYCLE: f64 = 2.0;
/// Odds of process before the log is seen: an output that the robot sets where it waits asks for an
/// answer.
const REQUEST_ODDS: f64 = 4.0;
const NO_REQUEST_ODDS: f64 = 0.5;
/// Odds of references: outputs that no wait has answered yet, and the wait's own signal; outputs that
/// have their answer; signals of others; what the robot alone does, which a machine hardly sees.
const PENDING_ODDS: f64 = 1.0;
const ANSWERED_ODDS: f64 = 0.1;
const OTHER_ODDS: f64 = 0.2;
const UNSEEN_ODDS: f64 = 0.05;
/// Odds of machines that answer in part.
const PARTLY_ODDS: f64 = 0.1;
/// Slopes of machines that answer in part.
const PARTLY: [f64; 3] = [0.25, 0.5, 0.75];
/// Fewest cycles from which anything is told.
const MIN_CYCLES: usize = 12;
/// Share of visits that find everything ready from which on there is nothing to learn.
const ALWAYS: f64 = 0.95;
/// What is there already in a larger share of the visits does not answer the robot: an output that it
/// sets where it waits (a door may be open already), or its mere coming.
const ANSWERS_OUTPUT: f64 = 0.5;
const ANSWERS_COMING: f64 = 0.1;
/// A wait for no signal that varies no more, s, lasts as long as the program says.
const STATED_S: f64 = 0.02;

/// Kinds of waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitKind {
    /// Arriving later shortens it.
    Slack,
    /// It keeps its length.
    Process,
    /// Neither is proved.
    Unknown,
}

/// Why a wait is of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The time counts from an event before the robot's last movement.
    CountsFrom,
    /// The time counts from the robot's coming.
    Answers,
    /// The program states its length.
    Stated,
    /// What it waits for is there already.
    AlwaysThere,
    /// Fewer cycles than needed.
    TooFew,
    /// Both hypotheses predict about equally well.
    CannotTell,
    /// Arriving later delays the machine in part.
    Coupled,
    /// Its executions in a cycle are of different kinds.
    Differs,
}

/// What a log says about a wait.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Its kind.
    pub kind: WaitKind,
    /// Why.
    pub reason: Reason,
    /// Index of the reference of a slack among the candidates; for others of the one that predicts best.
    pub after: Option<usize>,
    /// ln of the odds of slack against process.
    pub log_odds: f64,
    /// How much later it ends if the robot comes later.
    pub slope: Option<Slope>,
    /// Number of cycles that were compared.
    pub cycles: usize,
}

/// The verdict on a wait with all its executions.
#[must_use]
pub fn verdict(shift: &Shift, samples: &Samples) -> Verdict {
    let pooled = of(shift, samples);
    let last = samples.samples.iter().map(|sample| sample.occurrence).max().unwrap_or(0);
    if last == 0 || matches!(pooled.reason, Reason::Stated | Reason::AlwaysThere) {
        return pooled;
    }
    let single: Vec<Verdict> =
        (0..=last).map(|occurrence| of(shift, &samples.of_occurrence(occurrence))).collect();
    let has = |kind: WaitKind| single.iter().any(|verdict| verdict.kind == kind);
    if has(WaitKind::Slack) && (has(WaitKind::Process) || pooled.kind == WaitKind::Process)
        || has(WaitKind::Process) && pooled.kind == WaitKind::Slack
    {
        return Verdict { kind: WaitKind::Unknown, reason: Reason::Differs, ..pooled };
    }
    pooled
}

fn of(shift: &Shift, samples: &Samples) -> Verdict {
    let evidence = Evidence::new(shift, samples);
    let cycles = evidence.cycles;
    let because = |kind: WaitKind, reason: Reason| Verdict {
        kind,
        reason,
        after: None,
        log_odds: 0.0,
        slope: None,
        cycles,
    };
    let lengths = sorted(samples.lengths());
    let varies = quantile(&lengths, 0.95) - quantile(&lengths, 0.05);
    if samples.key.signal.is_none() && lengths.len() > 1 && varies < STATED_S {
        return because(WaitKind::Process, Reason::Stated);
    }
    if !lengths.is_empty() && quantile(&lengths, ALWAYS) <= AT_ONCE_S {
        return because(WaitKind::Unknown, Reason::AlwaysThere);
    }
    if cycles < MIN_CYCLES {
        return because(WaitKind::Unknown, Reason::TooFew);
    }
    Comparison::new(samples, &evidence).verdict()
}

/// Odds of a reference before the log is seen.
fn odds(key: &Key, candidate: &Candidate) -> f64 {
    match &candidate.reference.kind {
        Kind::Output(..) if candidate.answered => ANSWERED_ODDS,
        Kind::Output(..) => PENDING_ODDS,
        Kind::End(place) if *place == key.place => PENDING_ODDS,
        Kind::Signal(name, _) if Some(name) == key.signal.as_ref() => PENDING_ODDS,
        Kind::End(_) | Kind::Signal(..) if candidate.answered => UNSEEN_ODDS,
        Kind::End(_) | Kind::Signal(..) => OTHER_ODDS,
        Kind::Cycle | Kind::Start(_) | Kind::Arrive(_) => UNSEEN_ODDS,
    }
}

/// A reference before the last movement, with what it predicts.
struct Rival<'a> {
    index: usize,
    candidate: &'a Candidate,
    slack: LogDensities,
    /// ln of the odds before the log is seen, against a reference that a machine sees.
    prior: f64,
    /// Advantage over process as a whole.
    over_process: f64,
    /// The best machine that answers in part: its advantage over the robot's coming, with its prior.
    partly: f64,
}

struct Comparison<'a> {
    evidence: &'a Evidence<'a>,
    answers: LogDensities,
    rivals: Vec<Rival<'a>>,
    /// Whether few enough visits find everything ready for an answer to the robot.
    may_answer: bool,
}

impl<'a> Comparison<'a> {
    fn new(samples: &'a Samples, evidence: &'a Evidence<'a>) -> Comparison<'a> {
        let answers = evidence.answers();
        let candidates = || samples.candidates.iter().enumerate();
        let near = samples.candidates.iter().filter(|candidate| candidate.stands);
        let far = candidates().filter(|(_, candidate)| !candidate.stands);
        let standing: Vec<LogDensities> =
            near.map(|candidate| evidence.counts_from(candidate, 0.0)).collect();
        let request = if samples.has_request() { REQUEST_ODDS } else { NO_REQUEST_ODDS };
        let waited = samples.lengths().into_iter().filter(|length| *length > AT_ONCE_S);
        let length = median(waited);
        let rivals = far.map(|(index, candidate)| {
            let slack = evidence.counts_from(candidate, 0.0);
            let advantage = evidence.advantage(&slack, &answers, MOST_OF_CYCLE);
            let prior = odds(&samples.key, candidate).ln();
            // Times of machines have no scale: a short wait would be a coincidence for a long time.
            let scale = (samples.median_after(candidate) / length).max(1.0).ln();
            let over = standing.iter().map(|of| evidence.advantage(&slack, of, MOST_OF_CYCLE));
            let over_process = over.fold(advantage, f64::min) + prior - request.ln() - scale;
            // Of what no machine sees, none answers in part.
            let is_seen = prior > UNSEEN_ODDS.ln();
            let partly = PARTLY.into_iter().filter(|_| is_seen).map(|b| {
                let of = evidence.counts_from(candidate, b);
                let over_slack = evidence.advantage(&of, &slack, MOST_OF_CYCLE);
                let over_answers = evidence.advantage(&of, &answers, MOST_OF_CYCLE);
                over_slack.min(over_answers)
            });
            let partly = partly.fold(f64::NEG_INFINITY, f64::max) + prior + PARTLY_ODDS.ln();
            Rival { index, candidate, slack, prior, over_process, partly }
        });
        let rivals: Vec<Rival<'a>> = rivals.collect();
        let ready = samples.samples.iter().filter(|sample| sample.at_once()).count();
        let at_once = ready as f64 / samples.samples.len().max(1) as f64;
        let may_answer =
            at_once <= if samples.has_request() { ANSWERS_OUTPUT } else { ANSWERS_COMING };
        Comparison { evidence, answers, rivals, may_answer }
    }

    fn verdict(&self) -> Verdict {
        let cycles = self.evidence.cycles;
        let verdict = |kind, reason, log_odds, after: Option<usize>, slope| Verdict {
            kind,
            reason,
            after,
            log_odds,
            slope,
            cycles,
        };
        let tried = (self.rivals.len().max(1) as f64).ln();
        let Some(best) = self.best() else {
            // No movement before the wait: nothing that a slower robot could use.
            return verdict(WaitKind::Process, Reason::Answers, f64::NEG_INFINITY, None, None);
        };
        let of = |rival: &Rival<'_>| slope(self.evidence, rival.candidate, MOST_OF_CYCLE);
        let log_odds = best.over_process;
        let decided = SLACK_ODDS.ln() + tried;
        if log_odds >= decided {
            let after = self.latest_like(best, decided);
            let slope = of(after);
            let (kind, reason) = if after.partly >= PROCESS_ODDS.ln() || slope.low > 0.25 {
                (WaitKind::Unknown, Reason::Coupled)
            } else if slope.high < 0.5 {
                (WaitKind::Slack, Reason::CountsFrom)
            } else {
                (WaitKind::Unknown, Reason::CannotTell)
            };
            return verdict(kind, reason, log_odds, Some(after.index), Some(slope));
        }
        let partly = self.rivals.iter().max_by(|a, b| a.partly.total_cmp(&b.partly));
        if let Some(partly) = partly.filter(|of| of.partly >= PROCESS_ODDS.ln() + tried) {
            let slope = of(partly);
            let after = Some(partly.index);
            return verdict(WaitKind::Unknown, Reason::Coupled, log_odds, after, Some(slope));
        }
        let strongest = self.rivals.iter().max_by(|a, b| a.over_process.total_cmp(&b.over_process));
        let log_odds = strongest.map_or(log_odds, |rival| rival.over_process);
        let slope = strongest.map(of);
        let is_process = log_odds <= -PROCESS_ODDS.ln() && self.may_answer;
        let (kind, reason) = if is_process {
            (WaitKind::Process, Reason::Answers)
        } else {
            (WaitKind::Unknown, Reason::CannotTell)
        };
        let after = strongest.map(|rival| rival.index);
        verdict(kind, reason, log_odds, after, slope)
    }

    /// The reference that predicts best.
    fn best(&self) -> Option<&Rival<'a>> {
        let score = |rival: &Rival<'_>| {
            self.evidence.advantage(&rival.slack, &self.answers, f64::INFINITY) + rival.prior
        };
        let scores: Vec<f64> = self.rivals.iter().map(score).collect();
        let best = (0..scores.len()).max_by(|a, b| scores[*a].total_cmp(&scores[*b]))?;
        self.rivals.get(best)
    }

    /// The latest reference that predicts about as well: only movements after it may use the slack.
    fn latest_like<'b>(&'b self, best: &'b Rival<'a>, decided: f64) -> &'b Rival<'a> {
        let later = |rival: &Rival<'_>| {
            let pairs = rival.candidate.times.iter().zip(&best.candidate.times);
            median(pairs.filter_map(|(t, of_best)| Some((*t)? - (*of_best)?)))
        };
        let is_like = |rival: &&Rival<'_>| {
            let worse = self.evidence.advantage(&best.slack, &rival.slack, MOST_OF_CYCLE);
            let is_likely = rival.prior >= best.prior && rival.over_process >= decided;
            is_likely && worse < PROCESS_ODDS.ln()
        };
        let alike = self.rivals.iter().filter(is_like);
        alike.max_by(|a, b| later(a).total_cmp(&later(b))).unwrap_or(best)
    }
}

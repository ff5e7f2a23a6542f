//! The laws by which a signal comes.

use super::random::Random;
use super::spread::Spread;

/// What makes a signal come. Each is a machine, a line or a person of a real cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Gripper, clamp, camera: answers the robot's arrival or the output just before the wait.
    Answer,
    /// A machine that an output or the robot's departure starts.
    Machine,
    /// A person who loads after the robot has left.
    Operator,
    /// A line that moves by a fixed takt.
    Takt,
    /// A conveyor with a queue of parts that arrive at random intervals.
    Queue,
    /// A door that opens when the machine is done and the robot asks.
    OnRequest,
    /// A person who begins another job if the robot is not there.
    OtherJob,
    /// A machine that cools while it stands and has to warm up again.
    WarmUp,
    /// A place that another robot uses at times of its own.
    Shared,
}

/// The law of one signal. Times that count from an event of the robot are named `work`.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Law {
    Answer { time: Spread },
    Machine { work: Spread },
    Operator { work: Spread },
    Takt { period_s: f64, phase_s: f64, jitter_s: f64, transfer_s: f64 },
    Queue { interval: Spread, buffer: usize, advance_s: f64 },
    OnRequest { work: Spread, answer: Spread },
    OtherJob { work: Spread, job: Spread },
    WarmUp { work: Spread, per_second: f64, most_s: f64 },
    Shared { busy: Spread, free: Spread, answer: Spread },
}

/// The circumstances of one wait. Times are those of the plant's clock \[s\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment<'a> {
    pub(super) signal: &'a str,
    pub(super) seed: u64,
    /// Number of the cycle, and of the wait for this signal in it.
    pub(super) visit: [u64; 2],
    /// When the robot comes.
    pub(super) arrived: f64,
    /// Since when it has asked, by an output just before the wait \[s\].
    pub(super) lead: f64,
    /// The event that the machine starts from.
    pub(super) anchor: Option<f64>,
    /// When the signal fell for the last time.
    pub(super) fell: f64,
    /// \[°C\]
    pub(super) temperature: f64,
    /// Factor of all times of machines and people.
    pub(super) factor: f64,
    /// Factor and addition of the operator's mood and break.
    pub(super) mood: (f64, f64),
}

/// What a law keeps from visit to visit.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    /// A queue: parts so far, arrival of the last one, and the times at which parts were taken.
    parts: usize,
    arrived: f64,
    pub(super) taken: Vec<f64>,
    /// A shared place: the latest busy interval, and its number.
    busy: (f64, f64),
    intervals: u64,
}

/// Most other jobs that a person begins one after another.
const MOST_JOBS: usize = 40;

impl Moment<'_> {
    fn times(&self, purpose: &str) -> Random {
        Random::of(self.seed, &format!("{purpose} {}", self.signal), &self.visit)
    }

    fn nth(&self, purpose: &str, number: u64) -> Random {
        Random::of(self.seed, &format!("{purpose} {}", self.signal), &[number])
    }

    fn sample(&self, of: &Spread, draws: &mut Random) -> f64 {
        self.factor * of.sample(self.temperature, draws)
    }
}

impl Law {
    /// When the signal comes \[s\]; `None` if it is there since the start. A later call sees what
    /// `memory` keeps.
    pub(super) fn comes(&self, moment: &Moment, memory: &mut Memory) -> Option<f64> {
        let mut draws = moment.times("visit");
        match self {
            Law::Answer { time } => {
                Some(moment.arrived - moment.lead + moment.sample(time, &mut draws))
            }
            Law::Machine { work } => moment.anchor.map(|at| at + moment.sample(work, &mut draws)),
            Law::Operator { work } => {
                let (slow, pause) = moment.mood;
                moment.anchor.map(|at| at + slow * moment.sample(work, &mut draws) + pause)
            }
            Law::Takt { period_s, phase_s, jitter_s, transfer_s } => {
                let ready = moment.fell.max(0.0) + transfer_s;
                let tick = ((ready - phase_s) / period_s).ceil().max(0.0);
                let jitter = jitter_s * moment.nth("tick", tick as u64).unit();
                Some(phase_s + tick * period_s + jitter)
            }
            Law::Queue { interval, buffer, advance_s } => {
                let mut draws = moment.nth("part", memory.parts as u64);
                memory.arrived += moment.sample(interval, &mut draws);
                // A full conveyor holds the next part until a place is free.
                if let Some(free) = memory.parts.checked_sub(*buffer).map(|k| memory.taken.get(k)) {
                    memory.arrived = memory.arrived.max(free.copied().unwrap_or_default());
                }
                memory.parts += 1;
                Some(memory.arrived.max(moment.fell + advance_s))
            }
            Law::OnRequest { work, answer } => {
                let done = moment.anchor.map(|at| at + moment.sample(work, &mut draws));
                let asked = done.map_or(moment.arrived, |done| done.max(moment.arrived));
                Some(asked + moment.sample(answer, &mut draws))
            }
            Law::OtherJob { work, job } => {
                let mut free = moment.anchor? + moment.sample(work, &mut draws);
                for _ in 0..MOST_JOBS {
                    if free >= moment.arrived {
                        break;
                    }
                    free += moment.sample(job, &mut draws);
                }
                Some(free)
            }
            Law::WarmUp { work, per_second, most_s } => {
                let ready = moment.anchor? + moment.sample(work, &mut draws);
                let stood = moment.arrived - ready;
                Some(if stood <= 0.0 {
                    ready
                } else {
                    moment.arrived + (per_second * stood).min(*most_s)
                })
            }
            Law::Shared { busy, free, answer } => {
                while memory.busy.1 < moment.arrived {
                    let mut draws = moment.nth("interval", memory.intervals);
                    let from = memory.busy.1 + moment.sample(free, &mut draws);
                    memory.busy = (from, from + moment.sample(busy, &mut draws));
                    memory.intervals += 1;
                }
                let (from, to) = memory.busy;
                let granted = if moment.arrived < from { moment.arrived } else { to };
                Some(granted + moment.sample(answer, &mut draws))
            }
        }
    }
}

//! What a cell is like: a law for each awaited signal.

use std::collections::BTreeMap;

use super::law::{Kind, Law};
use super::random::Random;
use super::script::{Script, Step, Variant};
use super::spread::Spread;
use super::timeline::Timeline;
use super::truth::{After, Event, Truth};

/// What makes a signal come, and how it behaves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Machine {
    pub(super) law: Law,
    /// The event that it starts from.
    pub(super) starter: Option<Event>,
    /// Probability that the signal stays until the next cycle: the door is open, the part is there.
    pub(super) stays: f64,
    /// From the robot's departure or next output to the fall of the signal \[s\].
    pub(super) falls_s: f64,
}

impl Machine {
    pub(super) fn truth(&self) -> Truth {
        match (&self.law, &self.starter) {
            (Law::Answer { .. }, _) => Truth::Process,
            (Law::Machine { .. } | Law::Operator { .. }, Some(starter)) => {
                Truth::Slack { after: After::Event(starter.clone()) }
            }
            (Law::Takt { .. } | Law::Queue { .. }, _) => Truth::Slack { after: After::Clock },
            _ => Truth::Coupled,
        }
    }
}

/// Kinds and their weights for a signal that the program awaits once in a cycle.
const ONCE: [(Kind, f64); 9] = [
    (Kind::Answer, 0.26),
    (Kind::Machine, 0.26),
    (Kind::Operator, 0.1),
    (Kind::Takt, 0.06),
    (Kind::Queue, 0.1),
    (Kind::OnRequest, 0.08),
    (Kind::OtherJob, 0.05),
    (Kind::WarmUp, 0.04),
    (Kind::Shared, 0.05),
];
/// Probability that a signal is the answer to an output just before the wait.
const ANSWERS_OUTPUT: f64 = 0.75;
/// Share of machines whose signal is there at times without the robot's doing.
const SOMETIMES_THERE: f64 = 0.25;
/// Share of machines with which the robot mostly need not wait.
const MOSTLY_READY: f64 = 0.15;
/// What lines are slower than the planned cycle at most: faults and breaks are in their takt.
const SLOWER_LINE: f64 = 0.2;
const SLOWER_TAKT: f64 = 0.06;
/// Shortest time of a machine \[s\].
const SHORTEST_S: f64 = 0.8;

/// What is decided about a signal before the durations are known.
struct Plan {
    kind: Kind,
    /// Time of the wait for which the rest is planned; below 0 the signal is there before \[s\].
    aim_s: f64,
    /// Time of an answer.
    answer: Spread,
    draws: Random,
}

impl Plan {
    fn drawn(kind: Kind, mut draws: Random) -> Plan {
        let answer_s = match kind {
            // Cameras and clamps with a long way, else small grippers.
            Kind::Answer if draws.chance(0.25) => draws.between(0.8, 4.0),
            Kind::OnRequest => draws.between(0.4, 2.5),
            _ => draws.log_between(0.12, 1.2),
        };
        let answer = Spread::device(answer_s, &mut draws);
        let aim_s = match kind {
            Kind::Answer | Kind::Shared => answer.expected_s(),
            Kind::OnRequest => draws.between(-0.7, 0.7) + answer.expected_s(),
            Kind::OtherJob | Kind::WarmUp => draws.between(-0.5, 1.0),
            Kind::Machine if draws.chance(MOSTLY_READY) => draws.between(-2.0, 0.3),
            Kind::Machine | Kind::Takt | Kind::Queue => draws.log_between(0.4, 6.0),
            Kind::Operator => draws.between(0.5, 5.0),
        };
        Plan { kind, aim_s, answer, draws }
    }

    /// The law for a machine of which `lag_s` after its start the robot comes, in cycles of `cycle_s`.
    fn law(&mut self, lag_s: f64, cycle_s: f64) -> Law {
        let draws = &mut self.draws;
        let work_s = (lag_s + self.aim_s).max(SHORTEST_S);
        let answer = self.answer.clone();
        match self.kind {
            Kind::Answer => Law::Answer { time: answer },
            Kind::Machine => {
                let sd_s = draws.log_between(0.01, 0.6);
                Law::Machine { work: Spread::machine(work_s, sd_s, draws) }
            }
            Kind::Operator => Law::Operator { work: Spread::hands(work_s, draws) },
            Kind::Takt => Law::Takt {
                period_s: cycle_s * draws.between(1.0, 1.0 + SLOWER_TAKT),
                phase_s: cycle_s * draws.unit(),
                jitter_s: draws.log_between(0.005, 0.1),
                transfer_s: draws.between(0.2, 0.6),
            },
            Kind::Queue => {
                let (mean_s, cv) =
                    (cycle_s * draws.between(1.0, 1.0 + SLOWER_LINE), draws.between(0.04, 0.5));
                Law::Queue {
                    interval: Spread::plain(mean_s, cv, draws),
                    buffer: 2 + draws.below(7),
                    advance_s: draws.between(0.5, 1.5),
                }
            }
            Kind::OnRequest => {
                let sd_s = draws.between(0.5, 1.5);
                Law::OnRequest {
                    work: Spread::machine(
                        (work_s - answer.expected_s()).max(SHORTEST_S),
                        sd_s,
                        draws,
                    ),
                    answer,
                }
            }
            Kind::OtherJob => {
                let (cv, job_s) = (draws.between(0.05, 0.2), draws.between(1.0, 6.0));
                Law::OtherJob {
                    work: Spread::plain(work_s, cv, draws),
                    job: Spread::hands(job_s, draws),
                }
            }
            Kind::WarmUp => {
                let sd_s = draws.between(0.5, 1.5);
                Law::WarmUp {
                    work: Spread::machine(work_s, sd_s, draws),
                    per_second: draws.between(0.2, 0.8),
                    most_s: draws.between(3.0, 15.0),
                }
            }
            Kind::Shared => {
                let busy_s = cycle_s * draws.between(0.08, 0.3);
                let free_s = cycle_s * draws.between(0.15, 0.6);
                Law::Shared {
                    busy: Spread::plain(busy_s, draws.between(0.1, 0.4), draws),
                    free: Spread::plain(free_s, draws.between(0.2, 0.8), draws),
                    answer,
                }
            }
        }
    }
}

/// Whether a wait for the signal comes directly after an output, and whether a cycle has several.
fn circumstances(script: &Script, signal: &str) -> (bool, bool) {
    let awaits = |step: &Step| matches!(step, Step::Wait { signal: of, .. } if of == signal);
    let answers = |variant: &Variant| {
        let pairs = variant.steps.windows(2);
        let mut pairs = pairs.filter(|pair| matches!(pair[0], Step::Output { .. }));
        pairs.any(|pair| awaits(&pair[1]))
    };
    let several = |of: &Variant| of.steps.iter().filter(|step| awaits(step)).count() > 1;
    (script.variants.iter().any(answers), script.variants.iter().any(several))
}

fn kind(script: &Script, signal: &str, draws: &mut Random) -> Kind {
    let (answers, several) = circumstances(script, signal);
    if answers && draws.chance(ANSWERS_OUTPUT) {
        return Kind::Answer;
    }
    // What an event starts comes once after it.
    if several {
        return if draws.chance(0.7) { Kind::Answer } else { Kind::Shared };
    }
    ONCE[draws.weighted(&ONCE.map(|of| of.1))].0
}

/// The machines of a cell by signal, and the mean cycle as planned \[s\]. The kinds of the signals in
/// `given` are not drawn.
pub(super) fn machines(
    seed: u64,
    script: &Script,
    given: &[(&str, Kind)],
) -> (BTreeMap<String, Machine>, f64) {
    let mut plans: BTreeMap<String, Plan> = BTreeMap::new();
    for signal in script.awaited() {
        let mut draws = Random::of(seed, &format!("machine {signal}"), &[]);
        let drawn = kind(script, &signal, &mut draws);
        let chosen = given.iter().find(|(of, _)| *of == signal).map_or(drawn, |(_, kind)| *kind);
        // Two takts in one cell are one takt.
        let taken = chosen == Kind::Takt && plans.values().any(|plan| plan.kind == Kind::Takt);
        let chosen = if taken { Kind::Queue } else { chosen };
        plans.insert(signal, Plan::drawn(chosen, draws));
    }
    let expected: BTreeMap<String, f64> =
        plans.iter().map(|(signal, plan)| (signal.clone(), plan.aim_s.max(0.0))).collect();
    let expected = |signal: &str| expected.get(signal).copied().unwrap_or_default();
    let mut variants: Vec<&Variant> = script.variants.iter().collect();
    variants.sort_by(|a, b| b.frequency.total_cmp(&a.frequency));
    let lines: Vec<Timeline> = variants.iter().map(|of| Timeline::of(of, expected)).collect();
    let weight: f64 = variants.iter().map(|of| of.frequency).sum();
    let sum: f64 = variants.iter().zip(&lines).map(|(of, line)| of.frequency * line.total_s).sum();
    let cycle_s = sum / weight.max(f64::MIN_POSITIVE);
    let machine = |(signal, mut plan): (String, Plan)| {
        let starter = starter(&lines, &signal, &mut plan);
        let lag_s = starter.as_ref().map_or(0.0, |(_, lag_s)| *lag_s);
        let law = plan.law(lag_s, cycle_s);
        let clocked = matches!(law, Law::Takt { .. } | Law::Queue { .. } | Law::Answer { .. });
        let sometimes = !clocked && plan.draws.chance(SOMETIMES_THERE);
        let machine = Machine {
            law,
            starter: starter.map(|(event, _)| event),
            stays: if sometimes { plan.draws.between(0.05, 0.4) } else { 0.0 },
            falls_s: plan.draws.between(0.05, 0.4),
        };
        (signal, machine)
    };
    (plans.into_iter().map(machine).collect(), cycle_s)
}

/// What starts a machine, and how long before the robot comes \[s\]. A plan whose machine nothing can
/// start becomes an answer.
fn starter(lines: &[Timeline], signal: &str, plan: &mut Plan) -> Option<(Event, f64)> {
    if matches!(plan.kind, Kind::Answer | Kind::Takt | Kind::Queue | Kind::Shared) {
        return None;
    }
    let line = lines.iter().find_map(|line| Some((line, line.wait(signal)?)));
    let found = line.map(|(line, wait)| line.starters(wait)).unwrap_or_default();
    let (outputs, departures): (Vec<_>, Vec<_>) =
        found.into_iter().partition(|(event, _)| matches!(event, Event::Output { .. }));
    // A person sees the robot leave; a machine hears of it by an output, if there is one.
    let hears = plan.kind != Kind::Operator && plan.draws.chance(0.6);
    let from =
        if (hears && !outputs.is_empty()) || departures.is_empty() { outputs } else { departures };
    // Most start when the robot has just left them: the departure after the wait is the earliest.
    let at = if plan.draws.chance(0.6) {
        from.len().saturating_sub(1)
    } else {
        plan.draws.below(from.len())
    };
    let chosen = from.into_iter().nth(at);
    if chosen.is_none() {
        plan.kind = Kind::Answer;
        plan.aim_s = plan.answer.expected_s();
    }
    chosen
}

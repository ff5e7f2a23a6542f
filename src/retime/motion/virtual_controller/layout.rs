//! Plans runs and places runs, waits and outputs on the time line.

use rayon::prelude::*;

use super::draft::{Draft, WaitDraft};
use super::load::effective_load;
use super::state::VirtualController;
use crate::rapid::ir::exec::WaitResult;
use crate::rapid::ir::movement::{Movement, Stop, Wait};
use crate::retime::motion::arrivals::{Anchor, Arrival, anchored, next_wait};
use crate::retime::motion::run_plan::{Planned, RunDraft, RunTask};
use crate::retime::motion::timeline::{Event, MoveRecord, Run, WaitBasis, WaitRecord, What};

/// Drafts that are planned together: enough for all processors, few enough that an endless program
/// does not run far beyond its time limit.
const BATCH: usize = 256;

/// Time constant of the servo error at a stop point, s. Assumed from position loops with a
/// bandwidth of about 20/s; no measurement of stop points with `inpos` is known.
const SERVO_S: f64 = 0.05;

impl VirtualController<'_> {
    /// Makes one run of the pending movements.
    pub(super) fn flush(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        self.pending_s = 0.0;
        let Some(first) = pending.first() else { return };
        let load = effective_load(&first.movement);
        let times = pending.iter().map(|p| self.timed(&p.movement)).collect();
        let (movements, legs) = pending.into_iter().map(|p| (p.movement, p.leg)).unzip();
        self.keep(Draft::Run(Box::new(RunDraft::new(movements, legs, times, load))));
    }

    pub(super) fn keep(&mut self, draft: Draft) {
        self.drafts.push(draft);
        if self.drafts.len() >= BATCH {
            self.lay_out();
        }
    }

    /// Plans the drafts (runs in parallel) and places them on the time line.
    pub(super) fn lay_out(&mut self) {
        let (model, known) = (self.model, self.options.plans.as_deref());
        let drafts = std::mem::take(&mut self.drafts);
        let plans: Vec<Option<Planned>> = drafts
            .par_iter()
            .map(|draft| match draft {
                Draft::Run(run) => Some(run.task.plan(model, known)),
                _ => None,
            })
            .collect();
        for (draft, plan) in drafts.into_iter().zip(plans) {
            if self.late {
                break;
            }
            match (draft, plan) {
                (Draft::Run(run), Some(plan)) => self.lay_run(*run, plan),
                (Draft::Wait(wait), _) => self.lay_wait(*wait),
                (Draft::Output(output, position), _) => {
                    self.push(0.0, What::Output(output, position));
                }
                (Draft::Left(left), _) => {
                    self.certain = false;
                    self.push(0.0, What::Left(left));
                }
                (Draft::Run(_), None) => unreachable!("every run is planned"),
            }
            self.late = self.late || self.time > self.max_time();
        }
    }

    fn lay_run(&mut self, run: RunDraft, plan: Planned) {
        let (run, plan) = self.up_to_time_limit(run, plan);
        let RunDraft { movements, task: RunTask { legs, load, .. } } = run;
        let Planned { motions, mut pieces, problem, settling_s, key } = plan;
        let stands = movements.last().map_or(0.0, |movement| self.stop_time(movement));
        if let Some((duration, _)) = pieces.last_mut() {
            *duration += stands;
        }
        // The program continues at the start of a movement with \Conc.
        let under_way = movements.iter().zip(&pieces).rev();
        let under_way = under_way.take_while(|(movement, _)| movement.concurrent);
        let ahead: f64 = under_way.map(|(_, (duration, _))| duration).sum();
        let all = movements.iter().all(|movement| movement.concurrent);
        self.ahead = if all { self.ahead + ahead } else { ahead };
        if let Some((leg, reason)) = &problem {
            self.note(movements[*leg].span, reason);
        }
        let mut records = Vec::with_capacity(movements.len());
        let mut t = 0.0;
        for (movement, (duration, pace)) in movements.into_iter().zip(pieces) {
            records.push(MoveRecord { movement, t_start: t, duration, pace });
            t += duration;
        }
        let run = Run {
            moves: records,
            load,
            start: legs[0].start,
            end: legs[legs.len() - 1].end,
            legs,
            motions,
            settling: stands,
            start_known: self.certain,
            problem: problem.map(|(_, reason)| reason),
            key,
        };
        // An output between fly-by movements precedes the event of their run.
        // The first movement ends at its target from any start.
        let first = !self.events.iter().any(|event| matches!(event.what, What::Run(_)));
        self.certain = run.problem.is_none() || (first && self.options.start.is_none());
        if t > 0.0 {
            self.settle();
        }
        self.settling = settling_s;
        self.push(t, What::Run(Box::new(run)));
    }

    /// Adds the rest at the stop point between two movements. A wait includes this time.
    fn settle(&mut self) {
        let settling = self.settling;
        let own = self.events.iter().rev().take_while(|event| event.is_within_next_run()).count();
        let at = self.events.len() - own;
        let (events, own) = self.events.split_at_mut(at);
        let Some(Event { duration, what: What::Run(before), .. }) = events.last_mut() else {
            return;
        };
        let Some(last) = before.moves.last_mut().filter(|_| *duration > 0.0) else { return };
        before.settling += settling;
        last.duration += settling;
        *duration += settling;
        for event in own {
            event.t_start += settling;
        }
        self.time += settling;
    }

    /// Time of the input of a wait, s from the start of the cycle, if the user states it.
    pub(super) fn input_at(&self, wait: &Wait) -> Option<f64> {
        self.arrival_at().or_else(|| self.stated_at(wait))
    }

    /// What is known of the next wait by its place in the cycle.
    fn arrival(&self) -> Option<&Arrival> {
        let arrivals = &self.options.arrivals;
        let number = if arrivals.is_empty() { 0 } else { next_wait(&self.events) };
        arrivals.iter().find(|arrival| arrival.wait == number)
    }

    /// The time of the input by the place of the wait.
    fn arrival_at(&self) -> Option<f64> {
        let arrival = self.arrival()?;
        let from = match arrival.after {
            Anchor::Cycle => {
                let first = self.repeats_from.and_then(|first| self.events.get(first));
                first.map_or(0.0, |event| event.t_start)
            }
            Anchor::Own => self.time - self.ahead,
            anchor => {
                let event = &self.events[anchored(&self.events, anchor)?];
                event.t_start + event.duration
            }
        };
        Some(from + arrival.delay_s)
    }

    /// The time of the input by its name.
    fn stated_at(&self, wait: &Wait) -> Option<f64> {
        let key = wait.signal.as_ref()?.to_lowercase();
        let delay = self.options.inputs.get(&key)?;
        Some(self.waited.get(&key).copied().unwrap_or(0.0) + delay)
    }

    /// Whether the next wait keeps its length when the robot comes later.
    fn keeps_length(&self) -> bool {
        self.arrival().is_some_and(|arrival| arrival.after == Anchor::Own)
    }

    /// Time at a stop point in addition to settling, s.
    fn stop_time(&mut self, movement: &Movement) -> f64 {
        match movement.stop {
            Stop::Fine => 0.0,
            Stop::Time(time) => time,
            Stop::InPosition { share, least, most } => {
                let text = format!(
                    "at stop points with inpos the error of the servos dies away over {SERVO_S} s"
                );
                if !self.assumed.contains(&text) {
                    self.assumed.push(text);
                }
                // The error that `fine` permits needs no wait; the exponential decay starts there.
                let longer = if share > 0.0 { -SERVO_S * share.ln() } else { f64::INFINITY };
                longer.max(0.0).clamp(least, most)
            }
        }
    }

    fn lay_wait(&mut self, WaitDraft { wait, q, load }: WaitDraft) {
        // Logic during a movement with \Conc takes no additional time.
        let begin = self.time - self.ahead;
        self.waited_last = WaitResult::Ended;
        let (length, basis) = match (wait.duration, self.input_at(&wait)) {
            (Some(duration), _) => (duration, WaitBasis::Stated),
            (None, Some(at)) => {
                let rest = (at - begin).max(0.0);
                match wait.max_time {
                    Some(most) if most < rest => {
                        self.waited_last = WaitResult::TimedOut;
                        (most, WaitBasis::Stated)
                    }
                    _ if self.keeps_length() => (rest, WaitBasis::Stated),
                    _ => (rest, WaitBasis::Input),
                }
            }
            (None, None) => {
                let what = match (&wait.signal, &wait.other) {
                    (Some(signal), _) => format!(
                        "{signal}, at a time that is not known: taken as 0 s \
                         (--input {signal}=SECONDS states it)"
                    ),
                    (None, Some(other)) => format!("{other}: taken as 0 s"),
                    (None, None) => {
                        "a condition, at a time that is not known: taken as 0 s".to_owned()
                    }
                };
                self.note(wait.span, &format!("waits for {what}"));
                (0.0, WaitBasis::Unknown)
            }
        };
        if let Some(signal) = wait.signal.as_ref().map(|signal| signal.to_lowercase()) {
            self.asked.insert(signal.clone());
            if self.waited_last == WaitResult::Ended {
                self.waited.insert(signal, begin + length);
            }
        }
        let duration = (length - self.ahead).max(0.0);
        self.ahead = (self.ahead - length).max(0.0);
        let record = WaitRecord { wait, basis, q, load, position_known: self.certain };
        self.push(duration, What::Wait(Box::new(record)));
    }
}

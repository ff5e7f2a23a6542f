//! The simulated cycle that a log is compared with.

use std::ops::Range;

use super::refusal::Refusal;
use crate::arm::dynamics::{Data, Load};
use crate::arm::robot::Model;
use crate::retime::energy::along::Instant;
use crate::retime::energy::power::{power_at, supply_w};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, What};

/// Longest step of the power table \[s\], and its largest number of entries.
const STEP: f64 = 0.004;
const MOST: f64 = 30_000.0;

/// One pass of the repeated part of the program.
pub(super) struct Cycle<'a> {
    /// Events with a duration above 0, in order.
    events: Vec<&'a Event>,
    start: f64,
    /// Duration \[s\].
    pub(super) duration: f64,
    /// Power of the model at equal steps \[W\].
    power: Vec<f64>,
    step: f64,
    /// Start and duration of each movement \[s\], from the start of the pass.
    pub(super) moves: Vec<(f64, f64)>,
}

impl<'a> Cycle<'a> {
    /// The cycle of a simulation; refuses one without duration or without end.
    pub(super) fn new(model: &Model, simulation: &'a Simulation) -> Result<Cycle<'a>, Refusal> {
        let first = simulation.repeats_from.unwrap_or(0);
        let events = simulation.events.get(first..).unwrap_or_default();
        let start = events.first().map_or(0.0, |event| event.t_start);
        let duration = simulation.cycle_s - start;
        if events.is_empty() || duration <= 0.0 || !duration.is_finite() {
            return Err(Refusal::Nothing);
        }
        let mut moves = Vec::new();
        for event in events {
            if let What::Run(run) = &event.what {
                let begin = event.t_start - start;
                moves.extend(run.moves.iter().map(|m| (begin + m.t_start, m.duration)));
            }
        }
        let events: Vec<&Event> = events.iter().filter(|event| event.duration > 0.0).collect();
        let steps = (duration / STEP).ceil().clamp(2.0, MOST);
        let step = duration / steps;
        let mut cycle = Cycle { events, start, duration, power: Vec::new(), step, moves };
        let mut data = Data::new();
        cycle.power = (0..=steps as usize)
            .map(|i| {
                let Instant { load, state } = cycle.at(step * i as f64);
                let state: [&[f64]; 3] = [&state[0], &state[1], &state[2]];
                let power = power_at(model, &mut data, &load, state);
                supply_w(model, &mut data, &load, state, &power)
            })
            .collect();
        Ok(cycle)
    }

    /// Load and state of the robot at time `t` \[s\] from the start of the pass.
    pub(super) fn at(&self, t: f64) -> Instant {
        let t = t + self.start;
        let after = self.events.partition_point(|event| event.t_start <= t);
        let event = self.events[after.saturating_sub(1)];
        match &event.what {
            What::Run(run) => {
                let state = run.at(t - event.t_start);
                Instant { load: run.load.clone(), state: [state.q, state.qd, state.qdd] }
            }
            What::Wait(wait) => Instant::rest(&wait.load, &wait.q),
            What::Output(..) | What::Left(_) => Instant::rest(&Load::none(), &[0.0; 6]),
        }
    }

    /// The model's power at `t` \[W\].
    pub(super) fn power(&self, t: f64) -> f64 {
        let place = (t / self.step).clamp(0.0, (self.power.len() - 1) as f64);
        let (i, rest) = (place.floor() as usize, place.fract());
        let next = self.power[(i + 1).min(self.power.len() - 1)];
        self.power[i] + rest * (next - self.power[i])
    }

    /// Start and duration \[s\] of the wait after a movement.
    pub(super) fn wait_behind(&self, movement: usize) -> Option<(f64, f64)> {
        let (begin, lasts) = self.moves.get(movement)?;
        let next = self.moves.get(movement + 1).map_or(self.duration, |(begin, _)| *begin);
        Some((begin + lasts, next - begin - lasts))
    }

    /// Start and end of each event \[s\], from the start of the pass.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Range<f64>> {
        self.events.iter().map(|event| {
            let begin = event.t_start - self.start;
            begin..begin + event.duration
        })
    }
}

//! Dwells: holding energy and break-even time of the brakes.

use super::reason::Reason;
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::energy::brakes::{break_even_s, spared_j};
use crate::retime::energy::power::holding_w;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{WaitBasis, What};
use crate::retime::path::joint_path::{DOF, Joints};

/// Consecutive waits at one place.
#[derive(Clone, Debug)]
pub struct Dwell {
    /// Indices of the events.
    pub events: Vec<usize>,
    /// Statement of the longest wait.
    pub span: Span,
    /// Known length, s.
    pub duration: f64,
    /// Joint angles, rad.
    pub q: Joints,
    /// Tool and payload that it holds.
    pub load: Load,
    /// Mean holding power per joint, W.
    pub holding_w: Joints,
    /// Break-even time, s; `None` if nothing is saved or the robot has no known brake.
    pub break_even_s: Option<f64>,
    /// Energy that closing the brakes would save, J; 0 below the break-even time.
    pub potential_j: f64,
    /// Why the program is not changed.
    pub reason: Reason,
}

impl Dwell {
    /// Includes a wait in the mean holding power.
    fn hold(&mut self, holding_w: &Joints, duration: f64) {
        let all = self.duration + duration;
        let share = if all > 0.0 { duration / all } else { 1.0 };
        for (mean, new) in self.holding_w.iter_mut().zip(holding_w) {
            *mean += share * (new - *mean);
        }
    }
}

/// The dwells of a cycle, in order.
pub fn dwells(model: &Model, simulation: &Simulation) -> Vec<Dwell> {
    let mut dwells: Vec<Dwell> = Vec::new();
    let mut open = false;
    for (index, event) in simulation.events.iter().enumerate() {
        match &event.what {
            What::Run(_) | What::Left(_) => open = false,
            What::Output(..) => {}
            What::Wait(wait) => {
                if !open {
                    dwells.push(Dwell {
                        events: Vec::new(),
                        span: wait.wait.span,
                        duration: 0.0,
                        q: wait.q,
                        load: wait.load.clone(),
                        holding_w: [0.0; DOF],
                        break_even_s: None,
                        potential_j: 0.0,
                        reason: Reason::UnknownDwell,
                    });
                    open = true;
                }
                if let Some(dwell) = dwells.last_mut() {
                    let longest = dwell
                        .events
                        .iter()
                        .map(|i| simulation.events[*i].duration)
                        .fold(-1.0, f64::max);
                    if event.duration > longest {
                        dwell.span = wait.wait.span;
                    }
                    let holding = holding_w(model, &wait.load, &wait.q);
                    dwell.hold(&holding, event.duration);
                    dwell.events.push(index);
                    dwell.duration += event.duration;
                    if wait.basis != WaitBasis::Unknown {
                        dwell.reason = Reason::ShortDwell(f64::INFINITY);
                    }
                }
            }
        }
    }
    for dwell in &mut dwells {
        classify(model, dwell);
    }
    dwells
}

fn classify(model: &Model, dwell: &mut Dwell) {
    let holding: f64 = dwell.holding_w.iter().sum();
    if matches!(dwell.reason, Reason::UnknownDwell) {
        return;
    }
    let Some(break_even) = break_even_s(model, holding) else { return };
    dwell.break_even_s = Some(break_even);
    dwell.reason = if dwell.duration > break_even {
        dwell.potential_j = spared_j(model, holding, dwell.duration);
        Reason::NeedsSetting(break_even)
    } else {
        Reason::ShortDwell(break_even)
    };
}

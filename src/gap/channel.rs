//! What torques go through on their way into a log.

use crate::effects::{Response, find};

use super::polish::Fitted;
use super::search::Search;

/// Delays that are tried at first \[s\].
const DELAYS: [f64; 12] =
    [-0.016, -0.01, -0.006, -0.003, -0.0015, 0.0015, 0.003, 0.006, 0.009, 0.012, 0.016, 0.02];
/// Lags that are tried at first \[s\].
const LAGS: [f64; 7] = [0.0015, 0.003, 0.006, 0.009, 0.013, 0.018, 0.025];
/// Rounds of finer steps.
const ROUNDS: usize = 7;
/// What a delay or a lag has to bring before all else is looked at.
const WORTH: f64 = 15.0;
/// What naming one costs, and one joint of it.
const COST: f64 = 6.0;
const JOINT: f64 = 2.0;

/// Which one it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Delay,
    Lag,
}

/// A delay or a lag that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Late {
    kind: Kind,
    /// Joint, from 0; `None` of all.
    pub joint: Option<usize>,
    value: f64,
    sd: f64,
    /// Logarithm of the odds that it brings.
    pub nats: f64,
}

impl Late {
    /// Its id.
    #[must_use]
    pub fn id(&self) -> &'static str {
        match self.kind {
            Kind::Delay => "time_delay",
            Kind::Lag => "filter_lag",
        }
    }

    /// As an effect.
    #[must_use]
    pub fn fitted(&self) -> Option<Fitted> {
        let of = self.joint.map_or(0.0, |joint| joint as f64 + 1.0);
        Some(Fitted {
            effect: find(self.id())?,
            joint: self.joint,
            coordinates: vec![self.value, of],
            parameters: vec![self.value, of],
            deviations: vec![self.sd, 0.0],
            significance: self.value.abs() / self.sd.max(1e-300),
        })
    }

    fn channels(&self, dof: usize) -> Vec<Response> {
        let channel = match self.kind {
            Kind::Delay => Response { delay: self.value, lag: 0.0 },
            Kind::Lag => Response { delay: 0.0, lag: self.value },
        };
        let of = |joint: usize| self.joint.is_none_or(|own| own == joint);
        (0..dof).map(|joint| if of(joint) { channel } else { Response::default() }).collect()
    }
}

impl Search<'_, '_> {
    /// The most probable error, behind the most probable delay or lag of all or of one joint, if
    /// there is one.
    pub fn choose_channel(&mut self, errors: &[f64], may: &dyn Fn(&str) -> bool) {
        let plain = self.choose_error(errors);
        let kinds: Vec<Kind> = [Kind::Delay, Kind::Lag]
            .into_iter()
            .filter(|kind| may(Late { kind: *kind, ..Late::none() }.id()))
            .collect();
        let dof = self.dof();
        let joints = std::iter::once(None).chain((0..dof).map(Some));
        let mut best: Option<Late> = None;
        let error = self.error;
        // With a large error of the model nothing would be late.
        self.error = errors.get(1).copied().unwrap_or(error);
        for joint in joints {
            for kind in &kinds {
                if let Some(joint) = joint
                    && !self.may_be_late(*kind, joint)
                {
                    continue;
                }
                let late = self.tuned(*kind, joint, &[]);
                let cost = if joint.is_some() { JOINT } else { 0.0 };
                if late.nats - cost > best.map_or(WORTH, |best| best.nats) {
                    best = Some(Late { nats: late.nats - cost, ..late });
                }
            }
        }
        let Some(late) = best else {
            self.error = error;
            self.set_channels(&vec![Response::default(); dof]);
            return;
        };
        self.set_channels(&late.channels(dof));
        let behind = self.choose_error(errors);
        if behind > plain + COST {
            self.late = Some(Late { nats: behind - plain - COST, ..late });
        } else {
            self.error = error;
            self.set_channels(&vec![Response::default(); dof]);
        }
    }

    /// Whether a joint by itself is more probable behind some delay or lag.
    fn may_be_late(&mut self, kind: Kind, joint: usize) -> bool {
        let dof = self.dof();
        let mut null = |value: f64| {
            let late = Late { kind, joint: Some(joint), value, ..Late::none() };
            self.table.of_joint(self.records, joint, &late.channels(dof), self.error).null
        };
        let none = null(0.0);
        let tried: &[f64] = match kind {
            Kind::Delay => &[0.0025, 0.007, 0.015],
            Kind::Lag => &[0.005, 0.015],
        };
        let late = tried.iter().any(|value| null(*value) > none + WORTH);
        null(0.0);
        late
    }

    /// The delay or lag that was found, tuned once more with some columns there.
    pub(super) fn tune(&mut self, columns: &[usize]) {
        let Some(late) = self.late else { return };
        let mut best: Option<Late> = None;
        for kind in [Kind::Delay, Kind::Lag] {
            let tuned = self.tuned(kind, late.joint, columns);
            if best.is_none_or(|best| tuned.nats > best.nats) {
                best = Some(tuned);
            }
        }
        if let Some(tuned) = best {
            let late = Late { nats: late.nats, ..tuned };
            self.late = Some(late);
            self.set_channels(&late.channels(self.dof()));
        }
    }

    /// The best value of a kind with some columns there; its gain is over none.
    fn tuned(&mut self, kind: Kind, joint: Option<usize>, columns: &[usize]) -> Late {
        let all: Vec<usize> = (0..columns.len()).collect();
        let dof = self.dof();
        let total = |search: &mut Search<'_, '_>, value: f64| {
            let late = Late { kind, joint, value, sd: 0.0, nats: 0.0 };
            search.table.through(search.records, &late.channels(dof), columns);
            let evidence = search.table.evidence_of(search.error, columns);
            evidence.null + evidence.gain(&all)
        };
        let none = total(self, 0.0);
        let tried: &[f64] = match kind {
            Kind::Delay => &DELAYS,
            Kind::Lag => &LAGS,
        };
        let (mut value, mut most) = (0.0, none);
        // One joint's changes are small: fewer are enough to see whether there are any.
        let every = if joint.is_some() && columns.is_empty() { 3 } else { 1 };
        for next in tried.iter().skip(every / 2).step_by(every) {
            let found = total(self, *next);
            if found > most {
                (value, most) = (*next, found);
            }
        }
        let mut sd = f64::INFINITY;
        if most > none + WORTH || !columns.is_empty() {
            let mut step = 0.4 * value.abs().max(1e-3);
            for _ in 0..ROUNDS {
                let [low, high] = [value - step, value + step].map(|next| {
                    let allowed = kind == Kind::Delay || next > 0.0;
                    if allowed { total(self, next) } else { f64::NEG_INFINITY }
                });
                let bend = 2.0 * most - low - high;
                if bend > 0.0 && bend.is_finite() {
                    sd = step / bend.sqrt();
                }
                if low > most {
                    (value, most) = (value - step, low);
                } else if high > most {
                    (value, most) = (value + step, high);
                } else {
                    step *= 0.5;
                }
            }
        }
        Late { kind, joint, value, sd, nats: most - none }
    }
}

impl Late {
    fn none() -> Late {
        Late { kind: Kind::Delay, joint: None, value: 0.0, sd: 0.0, nats: 0.0 }
    }
}

//! A delay or a lag of what is logged.

use crate::arm::effects::{Response, find};

use super::fitted::Fitted;

/// How far the value depends on the filter's form, of itself, and on the clock of a controller \[s\].
const FORMS: f64 = 0.1;
const TICKS: f64 = 1e-4;
/// How many steps it is late at least, in a log that does not tell its noise.
const STEPS: f64 = 1.0;

/// Which one it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Delay,
    Lag,
}

/// A delay or a lag that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Late {
    pub(super) kind: Kind,
    /// Joint, from 0; `None` of all.
    pub joint: Option<usize>,
    pub(super) value: f64,
    pub(super) sd: f64,
    /// Logarithm of the odds that it brings.
    pub nats: f64,
}

impl Late {
    pub(super) fn none() -> Late {
        Late { kind: Kind::Delay, joint: None, value: 0.0, sd: 0.0, nats: 0.0 }
    }

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
            deviations: vec![self.deviation(), 0.0],
            significance: self.value.abs() / self.sd.max(1e-300),
        })
    }

    pub(super) fn is_longer(&self, step: f64) -> bool {
        self.value.abs() > STEPS * step
    }

    /// A filter has other forms than one pole, a clock is no better than it ticks.
    fn deviation(&self) -> f64 {
        self.sd.hypot(FORMS * self.value).hypot(TICKS)
    }

    pub(super) fn channels(&self, dof: usize) -> Vec<Response> {
        let channel = match self.kind {
            Kind::Delay => Response { delay: self.value, lag: 0.0 },
            Kind::Lag => Response { delay: 0.0, lag: self.value },
        };
        let of = |joint: usize| self.joint.is_none_or(|own| own == joint);
        (0..dof).map(|joint| if of(joint) { channel } else { Response::default() }).collect()
    }
}

//! A delay or a lag of what is logged.

use crate::arm::effects::{Response, find};

use super::demoted::LESSER;
use super::diagnosis::{Said, Verdict};
use super::judged::{Judged, parameters};
use super::polish::Fitted;

/// How far the value depends on the filter's form, of itself, and on the clock of a controller \[s\].
const FORMS: f64 = 0.1;
const TICKS: f64 = 1e-4;
/// Ids of lateness.
const OF_CLOCKS: [&str; 2] = ["time_delay", "filter_lag"];
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

impl Said {
    /// Whether it is lateness of one joint.
    pub(super) fn is_late_joint(&self) -> bool {
        OF_CLOCKS.contains(&self.effect.id) && !self.joints.is_empty()
    }
}

impl Judged {
    /// A delay or a lag.
    pub(super) fn assert_late(&mut self, late: &Late) {
        let Some(fitted) = late.fitted() else { return };
        let said = Said {
            class: OF_CLOCKS.to_vec(),
            parameters: parameters(&[&fitted])[..1].to_vec(),
            ..Said::alone(fitted.effect, late.joint.into_iter().collect(), late.nats)
        };
        // Where more is found at its joint that cannot be named, lateness is a part of that; so is a
        // little of it beside what can be.
        let beside = |all: &[Said], nats: f64| -> Option<&'static str> {
            let joint = late.joint?;
            let there = |of: &&Said| of.joints.is_empty() || of.joints.contains(&joint);
            all.iter().filter(there).find(|of| of.nats > nats).map(|of| of.effect.id)
        };
        if let Some(other) = beside(&self.candidates, late.nats) {
            self.reasons.push(format!("{}: less than {other}, which is not clear", late.id()));
            self.candidates.push(said);
            self.verdict =
                if self.effects.is_empty() { Verdict::Unknown } else { Verdict::Partial };
            return;
        }
        if let Some(other) = beside(&self.effects, late.nats / LESSER) {
            self.reasons.push(format!("{}: little beside {other}", late.id()));
            self.candidates.push(said);
            return;
        }
        self.effects.push(said);
        self.found_more();
    }

    /// Takes back lateness of one joint with which a model misses no less.
    pub(super) fn doubt_late_joint(&mut self) {
        let (late, kept): (Vec<Said>, Vec<Said>) =
            self.effects.drain(..).partition(Said::is_late_joint);
        self.effects = kept;
        for said in late {
            self.reasons.push(format!("{}: the logs are missed no less with it", said.effect.id));
            self.candidates.push(said);
            self.verdict =
                if self.effects.is_empty() { Verdict::Unknown } else { Verdict::Partial };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names that are asserted beside lateness of 100 nats, of one joint or of all.
    fn asserted(
        effect: Option<Said>,
        candidate: Option<Said>,
        joint: Option<usize>,
    ) -> Vec<String> {
        let mut judged = Judged::of(effect.into_iter().collect(), candidate.into_iter().collect());
        let late = Late { kind: Kind::Delay, joint, value: 0.003, sd: 1e-4, nats: 100.0 };
        judged.assert_late(&late);
        judged.effects.iter().map(|said| said.effect.id.to_owned()).collect()
    }

    #[test]
    fn lateness_without_use_is_taken_back() {
        for (joint, kept) in [(Some(2), 0), (None, 1)] {
            let mut judged = Judged::of(Vec::new(), Vec::new());
            let late = Late { kind: Kind::Lag, joint, value: 0.003, sd: 1e-4, nats: 100.0 };
            judged.assert_late(&late);
            judged.doubt_late_joint();
            assert_eq!((judged.effects.len(), judged.candidates.len()), (kept, 1 - kept));
        }
    }

    #[test]
    fn lateness_of_one_joint_may_be_a_part_of_more() {
        let friction = |nats| Some(Said::alone(find("stribeck")?, vec![2], nats));
        assert_eq!(asserted(friction(300.0), None, Some(2)), ["stribeck", "time_delay"]);
        assert_eq!(asserted(friction(3e4), None, Some(2)), ["stribeck"]);
        assert_eq!(asserted(friction(3e4), None, Some(1)), ["stribeck", "time_delay"]);
        assert_eq!(asserted(friction(3e4), None, None), ["stribeck", "time_delay"]);
        assert!(asserted(None, friction(300.0), Some(2)).is_empty());
        assert_eq!(asserted(None, friction(30.0), Some(2)), ["time_delay"]);
    }
}

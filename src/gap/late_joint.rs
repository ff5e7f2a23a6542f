//! A delay or a lag among what is asserted.

use super::demoted::LESSER;
use super::effect_ids::OF_CLOCKS;
use super::findings::{Said, Verdict};
use super::judged::{Judged, parameters};
use super::late::Late;

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
    use crate::arm::effects::find;

    use super::super::late::Kind;
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

//! The model with what is asserted, and whether that takes off what is missed.

use crate::arm::effects::find;
use crate::arm::robot::Model;

use super::chosen::{Chosen, Found};
use super::effect_ids::GATED;
use super::findings::{Said, Verdict};
use super::fitted::Fitted;
use super::heldout::{JointGap, Shrink};
use super::improved::Improved;
use super::judged::Judged;
use super::search::Search;

/// Changes of parameters, which a model has whether they are asserted or not.
const OF_PARAMETERS: [&str; 4] = ["link_parameters", "friction_level", "rotor_inertia", "payload"];
/// A model's own error, of the torque, and the mean square beyond it at which more is missed for
/// sure.
const ERROR: f64 = 0.005;
const CLEARLY: f64 = 50.0;
/// The same for an effect that is less probable than this.
const LIKELY: f64 = 0.5;
const DOUBTED: f64 = 10.0;
/// What may be left of that with an effect which explains it.
const LEFT: f64 = 0.6;
/// How many times a joint's gap may grow by what acts on the whole robot.
const FAR_WORSE: f64 = 3.0;
/// The same with lateness of one joint, which takes a little off most joints' logs.
const OF_LATE: f64 = 0.8;
/// Mean square beyond which what is left is of something else.
const FAR_MORE: f64 = 500.0;
/// An effect that joints show without others of their own being any of its matter.
const LOAD: &str = "payload";
/// An effect that fades from repetition to repetition, so that means do not show it.
const FADING: &str = "warm_up";
/// Deviations by which the held-out gap has to grow for what was found to be wrong: 1 in 10 by chance.
const GROWS: f64 = 1.28;

impl Search<'_, '_> {
    /// The model with the asserted effects, if there are some; the torques of joints that are flipped
    /// had been turned round for the fit.
    pub(super) fn with_asserted(
        &mut self,
        model: &Model,
        found: &Found,
        judged: &Judged,
        flipped: &[usize],
    ) -> Option<Improved> {
        let kept = self.asserted(found, judged);
        self.match_spread(&kept);
        let mut polished = self.polish(&kept)?;
        let is_said = |id: &str| judged.effects.iter().any(|said| said.effect.id == id);
        let late = self.late.filter(|late| is_said(late.id()));
        polished.effects.extend(late.and_then(|late| late.fitted()));
        polished.effects.extend(flipped.iter().filter_map(|joint| turned_round(*joint)));
        let improved =
            || Improved::new(model, &self.table.mixing, &polished.parameters, &polished.effects);
        (!polished.effects.is_empty()).then(improved)
    }

    /// The model with the changes of parameters that were found and are not asserted, if there are some.
    pub(super) fn with_parameters(
        &mut self,
        model: &Model,
        found: &Found,
        judged: &Judged,
    ) -> Option<Improved> {
        let mut kept = self.asserted(found, judged);
        let is_said = |id: &str| judged.effects.iter().any(|said| said.effect.id == id);
        kept.retain(|of| !is_said(self.families[of.family].owner.id()));
        if kept.is_empty() {
            return None;
        }
        self.match_spread(&kept);
        let polished = self.polish(&kept)?;
        Some(Improved::new(model, &self.table.mixing, &polished.parameters, &polished.effects))
    }

    /// What is asserted of a set: what is not is not in the model, so that its parameters are those
    /// without it.
    fn asserted(&self, found: &Found, judged: &Judged) -> Vec<Chosen> {
        let mut kept = Vec::new();
        for of in &found.chosen {
            let id = self.families[of.family].owner.id();
            let said = judged.effects.iter().find(|said| said.effect.id == id);
            if said.is_none() && !OF_PARAMETERS.contains(&id) {
                continue;
            }
            let is_told = |piece: &usize| match (self.table.pieces[*piece].joint, said) {
                (Some(joint), Some(said)) => said.joints.contains(&joint),
                _ => true,
            };
            let pieces = of.pieces.iter().copied().filter(is_told).collect();
            kept.push(Chosen { family: of.family, pieces });
        }
        kept
    }
}

/// A current of the other sign.
fn turned_round(joint: usize) -> Option<Fitted> {
    Some(Fitted {
        effect: find("current_sign")?,
        joint: Some(joint),
        coordinates: vec![1.0],
        parameters: vec![1.0],
        deviations: vec![0.0],
        significance: f64::INFINITY,
    })
}

impl Said {
    /// Whether it is more probable than not.
    pub(super) fn is_likely(&self) -> bool {
        self.probability >= LIKELY
    }

    /// Whether it need not be there at another time.
    fn is_of_its_time(&self) -> bool {
        self.effect.id == FADING || GATED.contains(&self.effect.id)
    }
}

impl Judged {
    /// The same without what leaves most of what is clearly missed on data that took no part, if there
    /// is some.
    pub(super) fn without_idle(&self, graded: &Shrink) -> Option<Judged> {
        let is_idle = |said: &Said| {
            let [before, after] = said.missed(graded);
            let clearly = if said.is_likely() { CLEARLY } else { DOUBTED };
            if said.is_late_joint() {
                return after > OF_LATE * before;
            }
            let is_left = after > clearly && after > LEFT * before;
            said.effect.id != FADING && is_left && !(said.effect.id == LOAD && takes_off(graded))
        };
        let mut less = self.clone();
        let (idle, kept): (Vec<Said>, Vec<Said>) = less.effects.drain(..).partition(is_idle);
        if idle.is_empty() {
            return None;
        }
        less.verdict = if kept.is_empty() { Verdict::Unknown } else { Verdict::Partial };
        less.effects = kept;
        let why = "leaves most of what is missed on the held-out data";
        less.reasons.extend(idle.iter().map(|said| format!("{}: {why}", said.effect.id)));
        less.candidates.extend(idle);
        Some(less)
    }
}

impl Said {
    /// Mean squares that are missed at its joints without effects and with them, of what a right model
    /// may miss.
    fn missed(&self, graded: &Shrink) -> [f64; 2] {
        let at = |joint: usize| self.joints.is_empty() || self.joints.contains(&joint);
        let joints = graded.joints.iter().enumerate().filter(|(joint, _)| at(*joint));
        joints.fold([0.0; 2], |sum, (_, of)| {
            let [before, after] = beyond_error(of);
            [sum[0] + before, sum[1] + after]
        })
    }
}

impl Judged {
    /// Whether an effect leaves so much of what is missed on data that took no part that it can't be
    /// a matter of its form.
    pub(super) fn leaves_far_more(&self, graded: &Shrink) -> bool {
        let leaves = |said: &Said| {
            let [before, after] = said.missed(graded);
            !said.is_of_its_time() && after > FAR_MORE && after > LEFT * before
        };
        self.effects.iter().any(leaves)
    }

    /// Whether data that took no part is missed more with the effects than without them, by all joints,
    /// also by those of an effect, or clearly by one joint though all have it, and they would have to be
    /// there, too.
    pub(super) fn is_refuted(&self, graded: &Shrink) -> bool {
        let at_its_joints = |said: &Said| {
            let all: f64 = said.joints.iter().map(|joint| graded.joints[*joint].growth).sum();
            all > GROWS * said.joints.len() as f64
        };
        // What acts on the whole robot lets no joint be missed far more than by the model as it was.
        let worsens = |of: &JointGap| {
            let [_, after] = beyond_error(of);
            after > CLEARLY && of.refit_plus_effect > FAR_WORSE * of.model
        };
        let is_of_all = self.effects.iter().any(|said| said.joints.is_empty());
        let grows = graded.growth > GROWS
            || graded.growth > 0.0 && self.effects.iter().any(at_its_joints)
            || is_of_all && graded.joints.iter().any(worsens);
        grows && !self.effects.iter().any(Said::is_of_its_time)
    }
}

/// Whether effects take most of what is clearly missed off a joint.
fn takes_off(graded: &Shrink) -> bool {
    let is_less = |of: &JointGap| {
        let [before, after] = beyond_error(of);
        before > DOUBTED && after <= LEFT * before
    };
    graded.joints.iter().any(is_less)
}

/// Mean squares that are missed without effects and with them, of what a right model may miss.
fn beyond_error(of: &JointGap) -> [f64; 2] {
    let variance = of.noise.powi(2) + (ERROR * of.torque).powi(2);
    [of.refit, of.refit_plus_effect].map(|rms| rms * rms / variance.max(f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names that stay asserted of joints 1 and 2, of gaps with and without them.
    fn kept(gaps: [[f64; 2]; 2]) -> (Vec<&'static str>, Verdict) {
        let effects = ["stribeck", "cable"].into_iter().filter_map(find).enumerate();
        let effects = effects.map(|(joint, effect)| Said::alone(effect, vec![joint], 1.0));
        let judged = Judged::of(effects.collect(), Vec::new());
        let joints = gaps.map(|[refit, refit_plus_effect]| JointGap {
            noise: 0.1,
            torque: 20.0,
            model: refit,
            refit,
            refit_plus_effect,
            growth: 0.0,
        });
        let graded = Shrink { joints: joints.to_vec(), ..Shrink::default() };
        let judged = judged.without_idle(&graded).unwrap_or(judged);
        (judged.effects.iter().map(|said| said.effect.id).collect(), judged.verdict)
    }

    #[test]
    fn effects_that_take_off_nothing_are_withdrawn() {
        assert_eq!(kept([[3.0, 1.5], [4.0, 1.0]]), (vec!["stribeck", "cable"], Verdict::Effect));
        assert_eq!(kept([[3.0, 2.9], [4.0, 1.0]]), (vec!["cable"], Verdict::Partial));
        assert_eq!(kept([[3.0, 2.9], [4.0, 5.0]]), (vec![], Verdict::Unknown));
        // What any model misses need not be taken off.
        assert_eq!(kept([[0.3, 0.3], [4.0, 1.0]]), (vec!["stribeck", "cable"], Verdict::Effect));
    }

    #[test]
    fn a_load_is_there_where_it_takes_most_off_some_joint() {
        let kept = |id: &str, gaps: [[f64; 2]; 2]| {
            let said = find(id).map(|effect| Said::alone(effect, Vec::new(), 1.0));
            let judged = Judged::of(said.into_iter().collect(), Vec::new());
            let joints = gaps.map(|[refit, refit_plus_effect]| JointGap {
                noise: 0.1,
                refit,
                refit_plus_effect,
                ..JointGap::default()
            });
            let graded = Shrink { joints: joints.to_vec(), ..Shrink::default() };
            judged.without_idle(&graded).is_none()
        };
        let gaps = [[5.0, 4.9], [0.6, 0.1]];
        assert!(kept("payload", gaps) && !kept("base_tilt", gaps));
        assert!(!kept("payload", [[5.0, 4.9], [0.6, 0.6]]));
    }

    #[test]
    fn lateness_of_a_joint_takes_something_off_other_logs() {
        let kept = |joints: Vec<usize>, after: f64| {
            let said = find("filter_lag").map(|effect| Said::alone(effect, joints, 1.0));
            let judged = Judged::of(said.into_iter().collect(), Vec::new());
            let joint = JointGap {
                noise: 0.1,
                refit: 0.2,
                refit_plus_effect: after,
                ..JointGap::default()
            };
            let graded = Shrink { joints: vec![joint], ..Shrink::default() };
            judged.without_idle(&graded).is_none()
        };
        assert!(kept(vec![0], 0.1) && !kept(vec![0], 0.199) && kept(vec![], 0.199));
    }

    #[test]
    fn what_acts_on_all_joints_makes_none_far_worse() {
        let is_refuted = |id: &str, joints: Vec<usize>, after: f64| {
            let said = find(id).map(|effect| Said::alone(effect, joints, 1.0));
            let far = JointGap {
                noise: 0.1,
                model: 1.0,
                refit: 4.0,
                refit_plus_effect: after,
                ..JointGap::default()
            };
            let graded = Shrink { joints: vec![far], growth: -1.0, ..Shrink::default() };
            Judged::of(said.into_iter().collect(), Vec::new()).is_refuted(&graded)
        };
        assert!(is_refuted("base_tilt", vec![], 4.0) && !is_refuted("base_tilt", vec![], 2.0));
        assert!(!is_refuted("stribeck", vec![0], 4.0));
    }

    #[test]
    fn effects_with_which_more_is_missed_are_refuted() {
        let is_refuted = |id: &str, growth: f64, own: f64| {
            let said = find(id).map(|effect| Said::alone(effect, vec![1], 1.0));
            let joint = |growth| JointGap { growth, ..JointGap::default() };
            let joints = vec![joint(0.0), joint(own)];
            let graded = Shrink { joints, growth, ..Shrink::default() };
            Judged::of(said.into_iter().collect(), Vec::new()).is_refuted(&graded)
        };
        assert!(is_refuted("torque_offset", 1.5, 0.0) && !is_refuted("torque_offset", 1.0, 1.0));
        assert!(is_refuted("torque_offset", 1.0, 1.5) && !is_refuted("torque_offset", -0.1, 1.5));
        // What need not be there at another time.
        assert!(!is_refuted("contact", 3.0, 3.0) && !is_refuted("warm_up", 3.0, 3.0));
    }
}

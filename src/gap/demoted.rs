//! Effects that others account for.

use super::chosen::Found;
use super::effect_ids::GATED;
use super::findings::Said;
use super::judged::Judged;
use super::search::Search;

/// Effects at once, and what each has to bring of what the first one does where there are more.
const AT_ONCE: usize = 2;
const OF_FIRST: f64 = 0.05;
/// What each has to bring of what the first one does in a log that does not tell its noise.
const OF_FIRST_OPEN: f64 = 0.3;
/// What fading friction is, of its level, so that they make up for each other.
const OF_LEVEL: f64 = 0.5;
/// Share of what two effects at a joint bring that the lesser one needs.
pub(super) const LESSER: f64 = 0.15;

impl Judged {
    /// Of two effects at one joint the lesser one is the other's form where it brings little of
    /// what both do.
    pub(super) fn demote_lesser(&mut self, search: &Search<'_, '_>, found: &Found) {
        let family = |id: &str| {
            found.chosen.iter().position(|of| search.families[of.family].owner.id() == id)
        };
        // Without the family at a place; of another one, without what it is at some joints.
        let score_without = |gone: Option<usize>, less: Option<usize>, joints: &[usize]| {
            let at_joints = |piece: &usize| {
                let joint = search.table.pieces[*piece].joint;
                joint.is_some_and(|joint| joints.contains(&joint))
            };
            let mut kept = Vec::new();
            for (place, of) in found.chosen.iter().enumerate() {
                let mut of = of.clone();
                of.pieces.retain(|p| Some(place) != gone && !(Some(place) == less && at_joints(p)));
                if !of.pieces.is_empty() {
                    kept.push(of);
                }
            }
            search.score(&kept)
        };
        let mut lesser: Vec<&str> = Vec::new();
        for said in &self.effects {
            for other in self.effects.iter().filter(|other| other.effect.id != said.effect.id) {
                let both_there = said.joints.iter().all(|joint| other.joints.contains(joint));
                let (Some(a), Some(b)) = (family(said.effect.id), family(other.effect.id)) else {
                    continue;
                };
                if said.joints.is_empty() || !both_there {
                    continue;
                }
                let joints = &said.joints;
                let own = found.score - score_without(Some(a), None, joints);
                let both = found.score - score_without(Some(a), Some(b), joints);
                let other = found.score - score_without(None, Some(b), joints);
                if own < LESSER * both && own < other {
                    lesser.push(said.effect.id);
                }
            }
        }
        let (demoted, kept): (Vec<Said>, Vec<Said>) =
            self.effects.drain(..).partition(|said| lesser.contains(&said.effect.id));
        self.effects = kept;
        self.candidates.extend(demoted);
    }

    /// Of two effects with windows the lesser one explains what the other one's form leaves.
    pub(super) fn demote_second_window(&mut self) {
        let has_window = |said: &&Said| GATED.contains(&said.effect.id);
        let nats = self.effects.iter().filter(has_window).map(|said| said.nats);
        let most = nats.fold(0.0, f64::max);
        let is_second = |said: &Said| has_window(&said) && said.nats < most;
        let (second, kept): (Vec<Said>, Vec<Said>) = self.effects.drain(..).partition(is_second);
        self.effects = kept;
        self.candidates.extend(second);
    }

    /// More effects than can be at once are what none of them is; whether it is so.
    pub(super) fn demote_too_many(&mut self, search: &Search<'_, '_>) -> bool {
        self.effects.sort_by(|a, b| b.nats.total_cmp(&a.nats));
        let Some(strongest) = self.effects.first().map(|said| said.nats) else { return false };
        if search.is_open() {
            // Real robots have a little of everything.
            let strong =
                self.effects.iter().filter(|said| said.nats > OF_FIRST_OPEN * strongest).count();
            let lesser = self.effects.drain(strong.min(AT_ONCE)..);
            self.candidates.extend(lesser);
            return false;
        }
        if self.effects.len() <= AT_ONCE {
            return false;
        }
        let strong = self.effects.iter().filter(|said| said.nats > OF_FIRST * strongest).count();
        let clear = strong <= AT_ONCE;
        let from = if clear { strong } else { 0 };
        self.candidates.extend(self.effects.drain(from..));
        !clear
    }

    /// While friction fades, what it is at is a matter of when; a level that fading friction makes up
    /// for is none.
    pub(super) fn demote_levels_that_fade(&mut self) {
        let all = self.effects.iter().chain(&self.candidates);
        let fading: Vec<Said> = all.filter(|said| said.effect.id == "warm_up").cloned().collect();
        let fades = |level: &Said| {
            fading.iter().any(|said| {
                said.size > OF_LEVEL * level.size
                    && said.joints.iter().any(|joint| level.joints.contains(joint))
            })
        };
        let is_level = |said: &Said| said.effect.id == "friction_level" && fades(said);
        let (levels, kept): (Vec<Said>, Vec<Said>) = self.effects.drain(..).partition(is_level);
        self.effects = kept;
        let why = "friction_level: friction that fades makes up for it";
        self.reasons.extend(levels.iter().map(|_| why.to_owned()));
        self.candidates.extend(levels);
    }
}

#[cfg(test)]
mod tests {
    use crate::arm::effects::find;

    use super::*;

    /// Effects that stay beside fading friction of joint 1 that is half of the torque.
    fn kept(id: &str, joint: usize, size: f64) -> usize {
        let said = |id: &str, joint, size| {
            let said = find(id).map(|effect| Said::alone(effect, vec![joint], 50.0));
            said.map(|said| Said { size, ..said }).into_iter().collect()
        };
        let mut judged = Judged::of(said(id, joint, size), said("warm_up", 0, 0.5));
        judged.demote_levels_that_fade();
        judged.effects.len()
    }

    #[test]
    fn levels_that_fading_friction_makes_up_for_are_none() {
        assert_eq!(kept("friction_level", 0, 0.6), 0);
        assert_eq!(kept("friction_level", 1, 0.6), 1);
        assert_eq!(kept("friction_level", 0, 1.2), 1);
        assert_eq!(kept("stribeck", 0, 0.6), 1);
    }

    #[test]
    fn of_two_windows_the_one_of_more_evidence_stays() {
        let said = |id: &str, nats| find(id).map(|effect| Said::alone(effect, vec![0], nats));
        let all = [("brake_drag", 40.0), ("contact", 90.0), ("stribeck", 20.0)];
        let mut judged =
            Judged::of(all.iter().filter_map(|(id, nats)| said(id, *nats)).collect(), Vec::new());
        judged.demote_second_window();
        let ids: Vec<&str> = judged.effects.iter().map(|said| said.effect.id).collect();
        assert_eq!(ids, ["contact", "stribeck"]);
    }
}

//! Laws in the place of smooth functions: what rubs, gives way or saturates does so in forms that
//! no library has all of, and a function that follows the form exactly wins against the law.

use super::chosen::{Chosen, Found};
use super::column::Owner;
use super::effect_ids::LOAD;
use super::load::OF_BODIES;
use super::search::Search;

/// Share of what functions at a joint explain that a law has to explain by itself.
const FORM: f64 = 0.65;
/// The same where the functions are of what the law is of: friction that depends on the position
/// alone is friction over the position, in whatever form.
const OWN_FORM: f64 = 0.3;
/// Laws of what functions are of.
const OWN: [(&str, &[&str]); 4] = [
    ("time_and_sense", &["brake_drag"]),
    ("speed", &["stribeck", "nonlinear_viscous", "viscous_asymmetry"]),
    ("position_and_sense", &["position_friction"]),
    ("load_and_sense", &["load_friction", "gear_efficiency"]),
];
/// Share of what the best law explains with which another one cannot be told from it.
const RIVAL: f64 = 0.85;
/// Laws that are brought to their best shape.
const TRIED: usize = 3;
/// Changes of parameters are no laws.
const NO_LAWS: [&str; 2] = ["link_parameters", "apparent_torque"];

/// Whether a function is of what a law is of.
fn is_own(function: Option<&str>, law: Option<&str>) -> bool {
    let (Some(function), Some(law)) = (function, law) else { return false };
    OWN.iter().any(|(of, laws)| *of == function && laws.contains(&law))
}

impl Search<'_, '_> {
    /// Whether a family is of functions.
    fn is_generic(&self, family: usize) -> bool {
        self.families[family].is_generic()
    }

    /// Joints of the functions in a set.
    pub(super) fn joints_of_functions(&self, set: &[Chosen]) -> Vec<usize> {
        let pieces = set.iter().filter(|of| self.is_generic(of.family)).flat_map(|of| &of.pieces);
        let mut joints: Vec<usize> = pieces.filter_map(|p| self.table.pieces[*p].joint).collect();
        joints.sort_unstable();
        joints.dedup();
        joints
    }

    /// A set without the functions at a joint.
    pub(super) fn without_functions(&self, set: &[Chosen], joint: usize) -> Vec<Chosen> {
        let kept = |of: &Chosen| Chosen {
            family: of.family,
            pieces: of
                .pieces
                .iter()
                .copied()
                .filter(|piece| {
                    !self.is_generic(of.family) || self.table.pieces[*piece].joint != Some(joint)
                })
                .collect(),
        };
        set.iter().map(kept).filter(|of| !of.pieces.is_empty()).collect()
    }

    /// Puts laws in the place of functions, joint by joint, where they explain most of what these
    /// do; what is left is looked for again.
    pub fn name_functions(&mut self, mut found: Found) -> Found {
        for joint in self.joints_of_functions(&found.chosen) {
            let rest = self.without_functions(&found.chosen, joint);
            let base = self.score(&rest);
            let full = found.score - base;
            if full <= 0.0 {
                continue;
            }
            let given = self.given(&rest);
            let mut laws: Vec<Found> = (0..self.families.len())
                .filter(|family| !self.is_generic(*family))
                .filter(|family| rest.iter().all(|of| of.family != *family))
                .filter(|family| {
                    let id = self.families[*family].owner.id();
                    !self.banned.contains(&id) && !NO_LAWS.contains(&id)
                })
                .filter_map(|family| self.with(&given, &rest, family))
                .collect();
            laws.sort_by(|a, b| b.score.total_cmp(&a.score));
            let strongest = self.strongest_function(&found, joint);
            let added = |law: &Found| law.chosen.last().map(|of| of.family);
            let (own, others): (Vec<Found>, Vec<Found>) = laws.into_iter().partition(|law| {
                is_own(strongest, added(law).map(|family| self.families[family].owner.id()))
            });
            for (laws, needed) in [(others, FORM), (own, OWN_FORM)] {
                let mut best: Option<Found> = None;
                for mut law in laws.into_iter().take(TRIED) {
                    self.refine(&mut law, rest.len());
                    if best.as_ref().is_none_or(|best| law.score > best.score) {
                        best = Some(law);
                    }
                }
                if let Some(best) = best.filter(|best| best.score - base > needed * full) {
                    self.kept.extend(added(&best));
                    found = self.run_from(best);
                    break;
                }
            }
        }
        found
    }

    /// The function that brings most at a joint.
    fn strongest_function(&self, found: &Found, joint: usize) -> Option<&'static str> {
        (0..found.chosen.len())
            .filter(|k| self.is_generic(found.chosen[*k].family))
            .filter(|k| {
                let own = |piece: &usize| self.table.pieces[*piece].joint == Some(joint);
                found.chosen[*k].pieces.iter().any(own)
            })
            .map(|k| {
                let mut less = found.chosen.clone();
                let of = less.remove(k);
                (found.score - self.score(&less), self.families[of.family].owner.id())
            })
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, id)| id)
    }

    /// Share of a member's functions beyond which the law is none of it.
    pub(super) fn largest_form(&self, found: &Found, place: usize) -> f64 {
        let chosen = &found.chosen[place];
        let id = self.families[chosen.family].owner.id();
        let joints = chosen.pieces.iter().filter_map(|p| self.table.pieces[*p].joint);
        let strongest: Vec<&str> =
            joints.filter_map(|joint| self.strongest_function(found, joint)).collect();
        // What is of the robot has no form of its own at a joint.
        let is_own = !strongest.is_empty() && strongest.iter().all(|of| is_own(Some(of), Some(id)));
        1.0 - if is_own { OWN_FORM } else { FORM }
    }

    /// What the functions at the joints of a member of the set bring beside it, as a share of
    /// what all of these do together; and what the member brings by itself.
    pub(super) fn share_of_form(&self, found: &Found, place: usize) -> (f64, f64) {
        let chosen = &found.chosen[place];
        let is_robots = chosen.pieces.iter().any(|p| self.table.pieces[*p].joint.is_none());
        let mut less = found.chosen.clone();
        for joint in self.joints_of_functions(&found.chosen) {
            let own = |piece: &usize| self.table.pieces[*piece].joint == Some(joint);
            if is_robots || chosen.pieces.iter().any(own) {
                less = self.without_functions(&less, joint);
            }
        }
        let neither: Vec<Chosen> =
            less.iter().filter(|of| of.family != chosen.family).cloned().collect();
        let all = found.score - self.score(&neither);
        let beside = found.score - self.score(&less);
        let form = (beside / all.max(1e-9)).clamp(0.0, 1.0);
        if !is_robots || !self.open {
            return (form, (1.0 - form) * all);
        }
        // A real robot has functions of single joints beside what is of the robot: its form is what
        // they could do in its place.
        let without: Vec<Chosen> =
            found.chosen.iter().filter(|of| of.family != chosen.family).cloned().collect();
        let instead = self.score(&without) - self.score(&neither);
        let shared = (1.0 - beside / instead.max(1e-9)).clamp(0.0, 1.0);
        (shared * form, (1.0 - form) * all)
    }

    /// A set without the functions that are the form of one of its laws.
    pub(super) fn without_forms(&self, found: &Found) -> Vec<Chosen> {
        let mut set = found.chosen.clone();
        for (place, chosen) in found.chosen.iter().enumerate() {
            if self.is_generic(chosen.family)
                || self.share_of_form(found, place).0 > self.largest_form(found, place)
            {
                continue;
            }
            for piece in &chosen.pieces {
                if let Some(joint) = self.table.pieces[*piece].joint {
                    set = self.without_functions(&set, joint);
                }
            }
        }
        set
    }

    /// Laws that explain nearly as much as the one at a place, functions at its joints being no
    /// part of either.
    pub(super) fn rival_forms(&self, found: &Found, place: usize) -> Vec<&'static str> {
        let chosen = &found.chosen[place];
        let mut less = found.chosen.clone();
        for piece in &chosen.pieces {
            if let Some(joint) = self.table.pieces[*piece].joint {
                less = self.without_functions(&less, joint);
            }
        }
        let rest: Vec<Chosen> =
            less.iter().filter(|of| of.family != chosen.family).cloned().collect();
        let base = self.score(&rest);
        let own = self.score(&less) - base;
        let given = self.given(&rest);
        // Without the load they would go by other bodies.
        let is_loaded = self.families[chosen.family].owner.id() == LOAD
            && self.records.iter().any(|record| record.motion.has_other_bodies());
        let mut class = Vec::new();
        for (number, family) in self.families.iter().enumerate() {
            let Owner::Effect(effect) = family.owner else { continue };
            if number == chosen.family
                || NO_LAWS.contains(&effect.id)
                || is_loaded && OF_BODIES.contains(&effect.id)
                || rest.iter().any(|of| of.family == number)
            {
                continue;
            }
            if let Some(other) = self.with(&given, &rest, number)
                && other.score - base > RIVAL * own
            {
                class.push(effect.id);
            }
        }
        class
    }
}

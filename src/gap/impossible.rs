//! Effects whose parameters came out as they cannot be.

use crate::arm::effects::Parameter;

use super::chosen::{Chosen, Found};
use super::column::Owner;
use super::effect_ids::STRIBECK;
use super::fitted::{Fitted, Polished};
use super::search::Search;

/// Friction by a power of the speed.
const POWER_LAW: &str = "nonlinear_viscous";
/// Deviations beyond the bounds of a parameter that cannot be.
const IMPOSSIBLE: f64 = 2.0;

impl Search<'_, '_> {
    /// A set without what came out as it cannot be: a law that has to be turned round to help is
    /// there in the place of another one.
    pub(super) fn without_impossible(&mut self, mut found: Found) -> Found {
        let bounded = |piece: &usize| match self.table.pieces[*piece].owner {
            Owner::Effect(effect) => {
                [STRIBECK, POWER_LAW].contains(&effect.id)
                    || effect.parameters.iter().any(Parameter::is_bounded)
            }
            Owner::Generic(_) => false,
        };
        if !found.chosen.iter().flat_map(|of| &of.pieces).any(bounded) {
            return found;
        }
        let Some(polished) = self.polish(&found.chosen) else { return found };
        let kept = self.kept.clone();
        self.strike(&mut found, &polished, &kept);
        found
    }

    /// Takes what came out as it cannot be out of a set, but for families to keep, settles what stays,
    /// and looks for it no more; whether there was some.
    pub(super) fn strike(
        &mut self,
        found: &mut Found,
        polished: &Polished,
        keep: &[usize],
    ) -> bool {
        let before = self.impossible.len();
        let cannot_be = |of: &&Fitted| self.cannot_be(polished, of, IMPOSSIBLE);
        let impossible: Vec<&Fitted> = polished.effects.iter().filter(cannot_be).collect();
        for fitted in impossible {
            let of_effect = |of: &&Chosen| {
                let id = self.families[of.family].owner.id();
                id == fitted.effect.id && !keep.contains(&of.family)
            };
            let Some(chosen) = found.chosen.iter().find(of_effect) else { continue };
            self.impossible.push((chosen.family, fitted.joint));
        }
        // In a log that tells no noise, nor do laws that leave a joint less friction than none.
        for joint in polished.bounded.iter().filter(|_| self.open) {
            for of in &found.chosen {
                let Owner::Effect(effect) = self.families[of.family].owner else { continue };
                let own = |piece: &usize| self.table.pieces[*piece].joint == Some(*joint);
                if effect.brings.contains(&"friction_level") && of.pieces.iter().any(own) {
                    self.impossible.push((of.family, Some(*joint)));
                }
            }
        }
        if self.impossible.len() == before {
            return false;
        }
        for of in &mut found.chosen {
            let may = |piece: &usize| {
                !self.impossible.contains(&(of.family, self.table.pieces[*piece].joint))
            };
            of.pieces.retain(may);
        }
        found.chosen.retain(|of| !of.pieces.is_empty());
        self.weigh_changed();
        self.settle(found);
        true
    }

    /// Whether a parameter is so many deviations beyond what can be.
    pub(super) fn cannot_be(&self, polished: &Polished, of: &Fitted, deviations: f64) -> bool {
        if of.is_impossible(deviations) {
            return true;
        }
        if let (POWER_LAW, [coefficient, exponent]) = (of.effect.id, of.parameters.as_slice()) {
            // What falls fastest from rest is the friction of starting.
            return *exponent < 1.0 && *coefficient < -deviations * of.deviations[0];
        }
        let (STRIBECK, Some(joint)) = (of.effect.id, of.joint) else { return false };
        // Some greases rub less at rest than at speed, down to nothing. Where the noise is known
        // that is another law in the place of this one: what builds up after a reversal.
        let least = if self.open { -self.coulomb(polished, joint) } else { 0.0 };
        of.parameters[0] < least - deviations * of.deviations[0]
    }

    /// Coulomb friction of a joint as it was found \[Nm\].
    pub(super) fn coulomb(&self, polished: &Polished, joint: usize) -> f64 {
        let nominal = self.records.first().map(|of| of.motion.model.friction.coulomb[joint]);
        let name = format!("joint {} coulomb", joint + 1);
        let at = self.table.parameters.iter().position(|of| *of == name);
        let refit = at.map_or(0.0, |at| polished.parameters[at] * self.table.deviations[at]);
        let is_level = |of: &&Fitted| of.effect.id == "friction_level" && of.joint == Some(joint);
        let level = polished.effects.iter().find(is_level).map_or(0.0, |of| of.parameters[0]);
        nominal.unwrap_or(0.0) + refit + level
    }
}

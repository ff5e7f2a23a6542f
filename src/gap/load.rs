//! What hangs on the flange is a body, and other laws go by it.

use crate::arm::robot::Model;

use super::chosen::{Chosen, Found};
use super::effect_ids::LOAD;
use super::fitted::Polished;
use super::improved::Improved;
use super::search::Search;

/// What a load has to bring for other laws to go by it.
const HEAVY: f64 = 1000.0;
/// Laws that go by the bodies that are there.
pub(super) const OF_BODIES: [&str; 7] = [
    "backlash",
    "base_tilt",
    "elasticity",
    "encoder_offset",
    "gear_efficiency",
    "load_friction",
    "torque_constant",
];

impl Search<'_, '_> {
    /// The model with the load of a set, where that is heavy and not all that the set has.
    pub(super) fn loaded(&mut self, found: &Found, believed: &Model) -> Option<Model> {
        let is_load = |of: &&Chosen| self.families[of.family].owner.id() == LOAD;
        let rest: Vec<Chosen> = found.chosen.iter().filter(|of| !is_load(of)).cloned().collect();
        let has_both = !rest.is_empty() && rest.len() < found.chosen.len();
        if !has_both || found.score - self.score(&rest) < HEAVY {
            return None;
        }
        let Polished { mut effects, parameters, .. } = self.polish(&found.chosen)?;
        effects.retain(|of| of.effect.id == LOAD);
        Some(Improved::new(believed, &self.table.mixing, &parameters, &effects).applied)
    }
}

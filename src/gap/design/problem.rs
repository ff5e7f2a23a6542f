//! The rows of all joints, and what the logs have in common.

use rayon::prelude::*;

use super::joint::JointDesign;
use super::parameters::Parameters;
use super::set::Set;
use crate::gap::data::Record;
use crate::gap::trust::Trust;
use crate::gap::tunables::Tunables;

/// Standard deviations of what any robot has within which a parameter is no finding.
const EVERYDAY: f64 = 3.0;
/// The same of a change since the baseline, which has them, too.
const CHANGED: f64 = 0.5;

/// The rows of all joints, and what the logs have in common.
pub struct Design {
    /// By joint.
    pub joints: Vec<JointDesign>,
    /// Parameters of the model: the first columns of each joint.
    pub parameters: Parameters,
    /// The chosen numbers.
    pub tunables: Tunables,
}

impl Design {
    /// The rows of all records, those of the baseline among them.
    #[must_use]
    pub fn new(records: &[Record<'_>], trust: Trust, tunables: &Tunables) -> Design {
        let dof = records.first().map_or(0, |record| record.motion.model.dof);
        let parameters = Parameters::new(records, trust, tunables);
        let joints = (0..dof)
            .into_par_iter()
            .map(|joint| JointDesign::new(records, joint, &parameters, tunables))
            .collect();
        Design { joints, parameters, tunables: tunables.clone() }
    }

    /// Least size of what any robot has a little of, in deviations of that.
    #[must_use]
    pub(in crate::gap) fn least_everyday(&self) -> f64 {
        if self.has_baseline() { CHANGED } else { EVERYDAY }
    }

    fn has_baseline(&self) -> bool {
        let mut cells = self.joints.iter().flat_map(|joint| &joint.cells);
        cells.any(|cell| cell.set == Set::Baseline)
    }

    /// Least share of an effect in a joint's torque, of a change since the baseline where there is one.
    #[must_use]
    pub(in crate::gap) fn least_share(&self) -> f64 {
        let tunables = &self.tunables;
        if self.has_baseline() { tunables.least_change } else { tunables.least_share }
    }
}

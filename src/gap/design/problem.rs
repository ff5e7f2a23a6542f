//! The rows of all joints, and what the logs have in common.

use rayon::prelude::*;

use super::joint::JointDesign;
use super::parameters::Parameters;
use crate::gap::data::Record;
use crate::gap::trust::Trust;
use crate::gap::tunables::Tunables;

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
}

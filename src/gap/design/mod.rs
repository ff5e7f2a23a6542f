//! The rows of spectra that are compared, and everything that may explain them.
//!
//! A design has the rows of each joint: the difference between measured and predicted torque, and
//! the torques of one standard deviation of each nuisance. Rows are grouped into cells: one log, one
//! band of frequencies, one variance.

mod basis;
mod everyday;
mod joint;
mod form;
mod parameters;
mod piece;

pub use basis::Coordinate;
pub use everyday::Group;
pub use form::form_of;
pub use joint::{Cell, JointDesign, Set};
pub use parameters::Parameters;
pub use piece::{Clock, PieceRows, Pieces, Whole, link_pieces, piece_rows};

use rayon::prelude::*;

use super::nuisance::Trust;
use super::record::Record;
use super::tunables::Tunables;

/// The rows of all joints, and what the logs have in common.
pub struct Design {
    /// By joint.
    pub joints: Vec<JointDesign>,
    /// Parameters of the model: the first columns of each joint.
    pub parameters: Parameters,
    /// The chosen numbers.
    pub tunables: Tunables,
}

/// Root of the mean square of the entries of rows.
#[must_use]
pub fn rms_of(rows: &nalgebra::DMatrix<f64>) -> f64 {
    basis::rms(rows.iter())
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

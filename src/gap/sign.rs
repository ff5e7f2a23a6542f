//! Torques that are logged with the other sign.

use nalgebra::DVector;

use super::data::{Record, RecordKind};
use super::decision::{Finding, Found, Search};
use super::model::{Fitted, Improved};

/// Correlation of measured and modelled torques below which the sign may be the other one.
const OPPOSITE: f64 = -0.5;

/// An effect without a size, at the joints that have it.
pub(super) struct Turned {
    fitted: Vec<Fitted>,
    nats: f64,
}

/// Whether some joint's torque is rather the opposite of the model's.
pub(super) fn is_opposite(records: &[Record<'_>]) -> bool {
    let dof = records.first().map_or(0, |record| record.motion.model.dof);
    (0..dof).any(|joint| {
        let (mut product, mut squares) = (0.0, [0.0; 2]);
        for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
            for (x, y) in record.measured[joint].iter().zip(&record.modelled[joint]) {
                product += x * y;
                squares = [squares[0] + x * x, squares[1] + y * y];
            }
        }
        product < OPPOSITE * f64::sqrt(squares[0] * squares[1])
    })
}

impl Turned {
    /// The most probable set's effects that are there or not.
    pub(super) fn of(search: &Search<'_>, none: Found) -> Option<Turned> {
        let found = search.best(none).best;
        let all = Fitted::of_fit(&found.fit);
        let fitted: Vec<Fitted> =
            all.into_iter().filter(|of| of.effect.coordinates.is_empty()).collect();
        (!fitted.is_empty()).then_some(Turned { fitted, nats: found.score })
    }

    /// Turns the torques back, so that all else can be compared.
    pub(super) fn turn_back(&self, records: &mut [Record<'_>]) {
        for record in records.iter_mut().filter(|record| record.kind != RecordKind::Before) {
            for joint in self.fitted.iter().filter_map(|of| of.joint) {
                record.measured[joint].iter_mut().for_each(|x| *x = -*x);
            }
        }
    }

    /// A model that has it, too.
    pub(super) fn added_to(&self, model: &Improved) -> Improved {
        Improved::new(&model.written, [&DVector::zeros(0), &DVector::zeros(0)], [&[], &self.fitted])
    }

    /// What is said of it.
    pub(super) fn finding(&self) -> Option<Finding> {
        let joints = self.fitted.iter().filter_map(|of| of.joint).collect();
        let of = |first: &Fitted| Finding::alone(first.effect, joints, self.nats);
        self.fitted.first().map(of)
    }
}

//! Other forms of the laws of effects.

use nalgebra::DMatrix;

use super::basis::{Functions, fades, functions, rms};
use super::piece::PieceRows;
use super::problem::Design;
use crate::arm::effects::{Form, Motion, Role};
use crate::gap::data::{Record, RecordKind};

/// Root mean square of functions of unit size that are seen at all.
const SEEN: f64 = 1e-6;
/// Harmonics of waves.
const HARMONICS: [f64; 2] = [2.0, 3.0];

impl PieceRows {
    /// Functions by which the form of its law may differ, of unit size: by joint, with their rows.
    #[must_use]
    pub fn forms(&self, design: &Design, records: &[Record<'_>]) -> Vec<(usize, DMatrix<f64>)> {
        self.forms_of(design, records, &|motions, joint| {
            if let Some(order) = self.order() {
                return self.harmonics(order, motions, joint);
            }
            let Some(variable) = self.effect.variable else { return Vec::new() };
            let mut all = functions(variable, motions, joint, &design.tunables);
            all.extend(self.after_reversals(design, motions, joint));
            all
        })
    }

    /// The place of the coordinate that is the order of waves over the position.
    fn order(&self) -> Option<usize> {
        let is_order = |role: &Role| matches!(role, Role::Waves { .. });
        self.effect.coordinates.iter().position(|of| is_order(&of.role))
    }

    /// Waves of unit size at the harmonics of an order.
    fn harmonics(&self, order: usize, motions: &[&Motion<'_>], joint: usize) -> Functions {
        let of = |harmonic: f64, linear: usize| -> Vec<Vec<f64>> {
            let mut shape = vec![0.0; self.shape.len()];
            shape[order] = harmonic * self.shape[order];
            shape[linear] = 1.0;
            motions.iter().map(|m| self.law(m, joint, &shape)).collect()
        };
        let is_linear = |k: &usize| matches!(self.effect.coordinates[*k].role, Role::Linear);
        let linear: Vec<usize> = (0..self.shape.len()).filter(is_linear).collect();
        HARMONICS.iter().flat_map(|h| linear.iter().map(|k| of(*h, *k))).collect()
    }

    /// What it adds to the torque of a joint in a motion.
    fn law(&self, m: &Motion<'_>, joint: usize, shape: &[f64]) -> Vec<f64> {
        let added = self.effect.added(m, self.joint.unwrap_or(joint), shape);
        let own = added.into_iter().find(|(of, _)| *of == joint);
        own.map_or_else(|| vec![0.0; m.rows()], |(_, series)| series)
    }

    /// Those of them that are there after reversals alone.
    #[must_use]
    pub fn forms_after_reversals(
        &self,
        design: &Design,
        records: &[Record<'_>],
    ) -> Vec<(usize, DMatrix<f64>)> {
        self.forms_of(design, records, &|motions, joint| {
            self.after_reversals(design, motions, joint)
        })
    }

    /// Rows of functions of the motions at each of its joints, in the logs as they are now.
    fn forms_of(
        &self,
        design: &Design,
        records: &[Record<'_>],
        functions: &dyn Fn(&[&Motion<'_>], usize) -> Functions,
    ) -> Vec<(usize, DMatrix<f64>)> {
        let motions: Vec<&Motion<'_>> = records.iter().map(|record| &record.motion).collect();
        let of_joint = |joint: usize| {
            let all = functions(&motions, joint);
            let of = &design.joints[joint];
            let mut rows = DMatrix::zeros(of.y.len(), all.len());
            for (k, series) in all.iter().enumerate() {
                let now = |(series, record): (&Vec<f64>, &Record<'_>)| -> Vec<f64> {
                    if record.kind == RecordKind::Mean { series.clone() } else { Vec::new() }
                };
                let series: Vec<Vec<f64>> = series.iter().zip(records).map(now).collect();
                let series: Vec<&[f64]> = series.iter().map(Vec::as_slice).collect();
                of.rows_of(records, &series, rows.column_mut(k).as_mut_slice());
            }
            (joint, rows)
        };
        let own = |joint: &usize| self.joint.is_none_or(|own| own == *joint);
        let joints = self.rows.iter().map(|(joint, _)| *joint).filter(own).map(of_joint);
        let is_there = |rows: &DMatrix<f64>| {
            rows.norm() > SEEN * f64::sqrt((rows.nrows() * rows.ncols()) as f64)
        };
        joints.filter(|(_, rows)| is_there(rows)).collect()
    }

    /// A law of friction after each reversal, from which on it builds up: of the size that is usual of
    /// dry friction, over that of a form.
    fn after_reversals(&self, design: &Design, motions: &[&Motion<'_>], joint: usize) -> Functions {
        if !matches!(self.effect.form, Form::Law { dissipates: true, .. }) {
            return Vec::new();
        }
        let law: Vec<Vec<f64>> = motions.iter().map(|m| self.law(m, joint, &self.shape)).collect();
        let tunables = &design.tunables;
        let size =
            tunables.reversal / tunables.form / rms(law.iter().flatten()).max(f64::MIN_POSITIVE);
        let mut all = fades(motions, joint, tunables);
        for series in all.iter_mut().flat_map(|fade| fade.iter_mut().zip(&law)) {
            series.0.iter_mut().zip(series.1).for_each(|(x, law)| *x *= size * law);
        }
        all
    }
}

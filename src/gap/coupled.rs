//! How much a wrist is coupled.
//!
//! Where motor 6 turns back its friction jumps, so that the evidence is as rugged in the coupling
//! as there are rows at which it may do so: low frequencies, which see no single row, lead to the
//! coupling that the high ones tell exactly.
//!
//! `learn::identify` finds a coupling with all parameters free; here it is a change against a known
//! model, beside other effects.

use super::chosen::{Chosen, Found};
use super::column::Owner;
use super::effect_ids::{COUPLING, OF_TURNS, OF_WRIST};
use super::search::Search;

/// Frequencies that are looked at first; twice as many each time.
const LOWEST: usize = 20;
/// The largest coupling that is looked for, and how far those are apart that are looked at first.
const LARGEST: f64 = 1.5;
const APART: f64 = 0.05;
/// Steps to both sides in a finer round, and how much finer it is.
const STEPS: i32 = 6;
const FINER: f64 = 0.3;
/// The finest step.
const FINEST: f64 = 2e-4;

impl Search<'_, '_> {
    /// Whether a piece is of an effect whose shape is a coupling.
    pub(super) fn is_coupling(&self, piece: usize) -> bool {
        matches!(self.table.pieces[piece].owner, Owner::Effect(effect) if effect.id == COUPLING)
    }

    /// The coupling of a set that leaves functions or laws of slow motion of the wrist, if it has one:
    /// friction that does not jump where the motor turns back.
    pub(super) fn rounded_coupling(&self, found: &Found) -> Option<f64> {
        let mut pieces = found.chosen.iter().flat_map(|of| of.pieces.iter().copied());
        let of = pieces.find(|piece| self.is_coupling(*piece))?;
        // What is strongest at another joint, the first one of a family, is no matter of the wrist.
        let is_left = |of: &&Chosen| {
            let joint = of.pieces.first().and_then(|piece| self.table.pieces[*piece].joint);
            joint.is_some_and(|joint| OF_WRIST.contains(&joint))
                && match self.families[of.family].owner {
                    Owner::Generic(_) => true,
                    // A log that does not repeat knows no row so well that turns rule the fit.
                    Owner::Effect(effect) => !self.is_open() && OF_TURNS.contains(&effect.id),
                }
        };
        found.chosen.iter().any(|of| is_left(&of)).then(|| self.table.pieces[of].shape[0])
    }

    /// Brings the coupling of a piece of a set to its best value.
    pub(super) fn couple(&mut self, set: &[Chosen], piece: usize) {
        let columns = self.columns(set);
        let all: Vec<usize> = (0..columns.len()).collect();
        let own = self.table.pieces[piece].columns.clone();
        let own: Vec<usize> = all.iter().copied().filter(|k| own.contains(&columns[*k])).collect();
        let shape = self.table.pieces[piece].shape.clone();
        let with = |coupling: f64| {
            let mut shape = shape.clone();
            shape[0] = coupling;
            shape
        };
        let (mut centre, mut step, mut count, mut highest) = if self.sharp.contains(&piece) {
            (shape[0], FINEST, STEPS, usize::MAX)
        } else {
            (0.0, APART, (LARGEST / APART) as i32, LOWEST)
        };
        loop {
            self.table.limit(highest);
            let mut evidence = self.table.evidence_of(self.error, &columns);
            let mut best: Option<(f64, f64)> = None;
            // Without a change there is nothing to change.
            let tried = (-count..=count).map(|k| centre + step * f64::from(k));
            for coupling in tried.filter(|coupling| coupling.abs() > 0.5 * FINEST) {
                self.reshape(&[(piece, with(coupling))]);
                evidence.replace(&self.table.products_of(self.error, &columns, own.clone()));
                let gain = evidence.gain(&all);
                if best.is_none_or(|(most, _)| gain > most) {
                    best = Some((gain, coupling));
                }
            }
            centre = best.map_or(centre, |(_, coupling)| coupling);
            if step <= FINEST {
                break;
            }
            count = STEPS;
            step = (FINER * step).max(FINEST);
            highest = if step <= FINEST { usize::MAX } else { highest.saturating_mul(2) };
        }
        self.table.limit(usize::MAX);
        self.reshape(&[(piece, with(centre))]);
        self.sharp.insert(piece);
    }
}

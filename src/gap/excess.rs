//! What no noise and no share of the model's torque accounts for: in a log that does not repeat
//! nothing tells its noise, and real robots miss more than simulated ones.
//!
//! The variance of each frequency is the one with which the measurement is most probable, the
//! parameters and the factors of columns being integrated out: expectation–maximisation
//! (A. Dempster, N. Laird, D. Rubin, J. R. Statist. Soc. B 39, 1977) in the mixed linear model.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::chosen::Chosen;
use super::rows::{Posterior, Rows};
use super::search::Search;
use super::table::Table;

/// Rounds of expectation and maximisation at most, and the change at which they end.
const ROUNDS: usize = 12;
const SETTLED: f64 = 0.02;
/// Share of the band, to each side, over which what is missed counts as equal. What a model misses
/// has no spectrum of its own as noise has: where some frequencies happen to be hit, nothing more is
/// known there.
const REACH: f64 = 0.4;
/// By how many times more than believed parameters may be off.
const SPREADS: [f64; 3] = [1.0, 3.0, 10.0];

impl Table {
    /// Sets the variance beyond noise and error so that the measurement is most probable with
    /// some columns there.
    pub(super) fn match_excess(&mut self, error: f64, columns: &[usize]) {
        // From above: what is known too well at first pulls all else along.
        self.each_rows(|rows| rows.take_difference(error));
        for _ in 0..ROUNDS {
            let Some(posterior) = self.posterior(error, columns) else { return };
            let changes = self.each_rows(|rows| rows.match_excess(error, &posterior));
            if changes.into_iter().fold(0.0, f64::max) < SETTLED {
                return;
            }
        }
    }

    /// Parameters and factors with their covariance.
    fn posterior(&self, error: f64, columns: &[usize]) -> Option<Posterior> {
        let parameters = self.parameters.len();
        let (gram, _) = self.gram_of(error, columns);
        let all = parameters + columns.len();
        let mut scales = self.scales(error);
        // Deviations from what is expected, in prior deviations: those of 0 stay.
        let mut sds = vec![1.0; parameters];
        let mut means = vec![0.0; parameters];
        for column in columns {
            sds.push(self.sds[*column]);
            means.push(self.means[*column]);
        }
        let means = DVector::from_vec(means);
        let products = gram.view((1, 1), (all, all));
        let left = gram.view((1, 0), (all, 1)) - products * &means;
        let scaled = DMatrix::from_fn(all, all, |i, k| {
            sds[i] * sds[k] * products[(i, k)] + if i == k { 1.0 } else { 0.0 }
        });
        let right = DVector::from_fn(all, |k, _| sds[k] * left[k]);
        let factor = Cholesky::new(scaled)?;
        let moved = factor.solve(&right);
        let inverse = factor.inverse();
        scales.resize(all, 1.0);
        Some(Posterior {
            places: self.places_of(columns),
            mean: DVector::from_fn(all, |k, _| scales[k] * (means[k] + sds[k] * moved[k])),
            covariance: DMatrix::from_fn(all, all, |i, k| {
                scales[i] * scales[k] * sds[i] * sds[k] * inverse[(i, k)]
            }),
        })
    }
}

impl Rows {
    /// Sets the excess over noise and error to what is missed; the largest relative change.
    fn match_excess(&mut self, error: f64, posterior: &Posterior) -> f64 {
        let missed = self.missed(posterior);
        self.take(error, &missed)
    }

    /// The same of the whole difference.
    fn take_difference(&mut self, error: f64) -> f64 {
        let missed: Vec<f64> = self.values.column(0).iter().map(|x| x * x).collect();
        self.take(error, &missed)
    }

    /// Variance of what is missed at an instant, all frequencies together \[N²m²\].
    pub(super) fn variance(&self, error: f64) -> f64 {
        let length: usize = self.spectra.iter().map(|spectrum| spectrum.length).sum();
        let all = self.noise.iter().zip(&self.power).zip(&self.excess);
        all.map(|((noise, power), excess)| noise + error * error * power + excess).sum::<f64>()
            / length.max(1) as f64
    }

    fn take(&mut self, error: f64, missed: &[f64]) -> f64 {
        let mut change = 0.0_f64;
        let mut first = 0;
        for spectrum in self.spectra.clone() {
            let rows = spectrum.rows();
            let roots: Vec<f64> = missed[first..first + rows].iter().map(|x| x.sqrt()).collect();
            let reach = (REACH * spectrum.bins as f64) as usize;
            let power = spectrum.smoothed(&roots, reach);
            for row in 0..rows {
                let at = first + row;
                let known = self.noise[at] + error * error * self.power[at];
                let before = known + self.excess[at];
                let after = power[super::spectrum::Spectrum::bin(row)].max(known);
                self.excess[at] = after - known;
                change = change.max((after / before.max(1e-300) - 1.0).abs());
            }
            first += rows;
        }
        change
    }
}

impl Search<'_, '_> {
    /// Whether a log does not tell its noise.
    pub(super) fn is_open(&self) -> bool {
        self.open
    }

    /// Rms torque of a joint that is missed with what was found last \[Nm\].
    pub(super) fn missed(&self, joint: usize) -> f64 {
        self.table.variance(joint, self.error).sqrt()
    }

    /// In logs that do not tell their noise, lets the parameters be off as far as is most probable
    /// with a set: those of a real robot were identified without its effects.
    pub(super) fn match_spread(&mut self, set: &[Chosen]) {
        let mut best = (f64::NEG_INFINITY, SPREADS[0]);
        for spread in if self.is_open() { &SPREADS[..] } else { &[] } {
            self.table.set_spread(*spread);
            self.match_excess(set);
            let total = self.evidence.null + self.score(set);
            if total > best.0 {
                best = (total, *spread);
            }
        }
        self.table.set_spread(best.1);
        self.match_excess(set);
    }

    /// In logs that do not tell their noise, takes what a set leaves for it.
    pub(super) fn match_excess(&mut self, set: &[Chosen]) {
        if !self.is_open() {
            return;
        }
        let columns = self.columns(set);
        self.table.match_excess(self.error, &columns);
        self.weigh();
    }
}

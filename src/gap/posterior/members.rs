//! What single members of a fit are worth: ratios of densities at 0.

use nalgebra::DVector;

use super::fit::Fit;

impl Fit {
    /// Logarithm of how much more probable the logs are with a member, what it brings along being there,
    /// at the sizes that there are. `None` for what acts by itself.
    #[must_use]
    pub(in crate::gap) fn evidence_of(&self, number: usize) -> Option<f64> {
        self.evidence_of_columns(number, self.hypothesis.members[number].piece.own)
    }

    /// Share of the evidence of all members that the columns have by themselves that they bring along: it
    /// is none of their own. At these sizes no member would be missed more than at its own ones, so that a
    /// share counts, and no nats.
    #[must_use]
    pub(in crate::gap) fn share_brought(&self) -> f64 {
        let (mut all, mut brought) = (0.0, 0.0);
        for (number, member) in self.hypothesis.members.iter().enumerate() {
            let piece = &member.piece;
            let of = |count: usize| self.evidence_of_columns(number, count);
            if let (Some(with), Some(own)) = (of(piece.prior.len()), of(piece.own)) {
                all += with.max(0.0);
                brought += (with - own).max(0.0);
            }
        }
        if all > 0.0 { f64::min(brought / all, 1.0) } else { 0.0 }
    }

    /// Factors of the columns of a member.
    #[must_use]
    pub(in crate::gap) fn factors_of(&self, number: usize) -> DVector<f64> {
        let from = self.mean.len() - self.hypothesis.columns() + self.first_of(number);
        let count = self.hypothesis.members[number].piece.prior.len();
        self.mean.rows(from, count).into_owned()
    }

    /// The first column of a member among those of all.
    fn first_of(&self, number: usize) -> usize {
        self.hypothesis.members[..number].iter().map(|member| member.piece.prior.len()).sum()
    }

    /// The ratio of the densities of a member's first factors at 0, before and after (J. Dickey, Annals
    /// of Mathematical Statistics 42, 1971).
    fn evidence_of_columns(&self, number: usize, count: usize) -> Option<f64> {
        let members = &self.hypothesis.members;
        if members[number].piece.is_fixed() {
            return None;
        }
        let effects = self.first_of(number);
        let from = self.mean.len() - self.hypothesis.columns() + effects;
        let (_, sds) = self.prior();
        let known = self.covariance.view((from, from), (count, count)).into_owned().cholesky()?;
        let factors = self.mean.rows(from, count);
        let shrunk: f64 =
            (0..count).map(|k| (known.l_dirty()[(k, k)] / sds[effects + k]).ln()).sum();
        Some(0.5 * factors.dot(&known.solve(&factors)) + shrunk)
    }
}

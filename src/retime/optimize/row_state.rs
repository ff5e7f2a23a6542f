//! Slack, violation and multipliers of a row in an interior point method.
//!
//! A hard row has its slack w ≥ 0 with the multiplier λ; a soft one also its violation s ≥ 0 at a price, with
//! the multiplier price − λ. At the optimum, λ w = 0 and (price − λ) s = 0.

/// Slack w, violation s and multiplier λ of a row.
#[derive(Clone, Copy)]
pub(super) struct RowState {
    pub(super) w: f64,
    pub(super) s: f64,
    pub(super) lambda: f64,
    /// Price of a violation by one; infinite for a hard row.
    price: f64,
}

/// A change of a state.
#[derive(Clone, Copy)]
pub(super) struct RowChange {
    pub(super) w: f64,
    pub(super) s: f64,
    pub(super) lambda: f64,
}

/// What a step lowers λ w and (price − λ) s by.
pub(super) type Reduction = (f64, f64);

/// Smallest initial slack, violation and multiplier.
pub(super) const BEGIN: f64 = 1e-2;
/// Length of a step as a share of the step to the boundary.
pub(super) const TO_BOUNDARY: f64 = 0.995;

impl RowState {
    /// The first state of a row that exceeds its bound by `excess`.
    pub(super) fn first(price: f64, excess: f64) -> RowState {
        let s = if price.is_finite() { excess.max(0.0) + BEGIN } else { 0.0 };
        let w = (s - excess).max(BEGIN);
        RowState { w, s, lambda: (BEGIN / w).min(0.5 * price), price }
    }

    /// The state of a hard row.
    pub(super) fn hard(w: f64, lambda: f64) -> RowState {
        RowState { w, s: 0.0, lambda, price: f64::INFINITY }
    }

    /// Whether it may be violated at a price.
    pub(super) fn is_soft(&self) -> bool {
        self.price.is_finite()
    }

    /// The cost of its violation.
    pub(super) fn cost(&self) -> f64 {
        if self.is_soft() { self.price * self.s } else { 0.0 }
    }

    /// The products that vanish at the optimum.
    pub(super) fn products(&self) -> Reduction {
        let violation = if self.is_soft() { self.mu() * self.s } else { 0.0 };
        (self.lambda * self.w, violation)
    }

    /// The sum of these products.
    pub(super) fn complement(&self) -> f64 {
        let (slack, violation) = self.products();
        slack + violation
    }

    /// Change of the value of the row per change of its multiplier.
    pub(super) fn compliance(&self) -> f64 {
        let soft = if self.is_soft() { self.s / self.mu() } else { 0.0 };
        soft + self.w / self.lambda
    }

    /// Change of the multiplier while the value stays, for the residual of the row.
    pub(super) fn shift(&self, primal: f64, (c_w, c_s): Reduction) -> f64 {
        let soft = if self.is_soft() { c_s / self.mu() } else { 0.0 };
        (primal + soft - c_w / self.lambda) / self.compliance()
    }

    /// The change of the state that goes with a change of the multiplier.
    pub(super) fn change(&self, lambda: f64, (c_w, c_s): Reduction) -> RowChange {
        let w = (-c_w - self.w * lambda) / self.lambda;
        let s = if self.is_soft() { (self.s * lambda - c_s) / self.mu() } else { 0.0 };
        RowChange { w, s, lambda }
    }

    /// The largest step up to `reach` that keeps slack, violation and multipliers positive.
    pub(super) fn reach(&self, change: &RowChange, reach: f64) -> f64 {
        let hard = bounded(self.w, change.w, bounded(self.lambda, change.lambda, reach));
        if self.is_soft() {
            bounded(self.s, change.s, bounded(self.mu(), -change.lambda, hard))
        } else {
            hard
        }
    }

    pub(super) fn moved(&self, change: &RowChange, step: f64) -> RowState {
        RowState {
            w: self.w + step * change.w,
            s: self.s + step * change.s,
            lambda: self.lambda + step * change.lambda,
            price: self.price,
        }
    }

    /// The multiplier of s.
    fn mu(&self) -> f64 {
        self.price - self.lambda
    }
}

impl RowChange {
    /// Mehrotra's correction of a reduction: the second-order terms of this predictor, and the centring.
    pub(super) fn corrected(&self, (c_w, c_s): Reduction, centre: f64) -> Reduction {
        (c_w + self.w * self.lambda - centre, c_s - self.s * self.lambda - centre)
    }
}

/// The largest step up to `reach` that keeps a value positive.
pub(super) fn bounded(value: f64, change: f64, reach: f64) -> f64 {
    if change < 0.0 { reach.min(-value / change) } else { reach }
}

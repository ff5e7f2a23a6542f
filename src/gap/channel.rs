//! What all torques go through on their way into a log.

use crate::effects::Effect;

/// A delay and the lag of a filter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel {
    /// \[s\].
    pub delay: f64,
    /// Time constant \[s\].
    pub lag: f64,
}

impl Channel {
    /// The part that an effect is, if it is one.
    pub(super) fn of(&mut self, effect: &Effect) -> Option<&mut f64> {
        match effect.id {
            "time_delay" => Some(&mut self.delay),
            "filter_lag" => Some(&mut self.lag),
            _ => None,
        }
    }

    /// Real and imaginary part of the response at a frequency \[Hz\].
    pub(super) fn response(&self, frequency: f64) -> [f64; 2] {
        let w = std::f64::consts::TAU * frequency;
        let (sin, cos) = (w * self.delay).sin_cos();
        let x = w * self.lag;
        let scale = 1.0 / (1.0 + x * x);
        // e^(−iwd) / (1 + iwl)
        [scale * (cos - sin * x), scale * (-sin - cos * x)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lag_takes_what_a_delay_leaves() {
        let [re, im] = Channel { delay: 0.25, lag: 0.0 }.response(1.0);
        assert!(re.abs() < 1e-12 && (im + 1.0).abs() < 1e-12);
        let [re, im] = Channel { delay: 0.0, lag: 1.0 / std::f64::consts::TAU }.response(1.0);
        assert!((re - 0.5).abs() < 1e-12 && (im + 0.5).abs() < 1e-12);
    }
}

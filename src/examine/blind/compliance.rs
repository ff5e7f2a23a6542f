//! Compliance between motor and link: elasticity and backlash.
//!
//! The encoder is at the motor. With δ the lag of the link, linearised about the motor's motion,
//! and a spring f and a damper d in the gear:
//!
//! ```text
//! M_jj δ̈ + d δ̇ + f(δ) = τ_L
//! ```

/// Largest product of eigenfrequency and integration step.
const FINEST: f64 = 0.15;
/// Largest number of integration steps in a simulation step.
const MOST_STEPS: usize = 400;
/// Number of samples to each side in the smoothing of a quasi-static deflection.
const REACH: usize = 5;

/// The gear's spring.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spring {
    Linear,
    /// Twice the stiffness above this torque \[Nm\].
    Hardening(f64),
    /// Zero torque within half the gap \[rad\] to both sides, then linear.
    Gap(f64),
    /// A gap with a cubic transition.
    SoftGap(f64),
}

/// Elasticity of one gear.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compliance {
    pub(super) joint: usize,
    /// Stiffness \[Nm/rad\].
    pub(super) stiffness: f64,
    pub(super) spring: Spring,
    /// Damping ratio; `None` for a quasi-static deflection.
    pub(super) damping: Option<f64>,
}

impl Compliance {
    /// The spring's torque at a deflection.
    fn torque(&self, delta: f64) -> f64 {
        let k = self.stiffness;
        match self.spring {
            Spring::Linear => k * delta,
            Spring::Hardening(knee) => {
                let at = knee / k;
                let soft = k * delta.clamp(-at, at);
                soft + 2.0 * k * (delta - delta.clamp(-at, at))
            }
            Spring::Gap(gap) => k * (delta - delta.clamp(-0.5 * gap, 0.5 * gap)),
            Spring::SoftGap(gap) => {
                let x = delta / gap.max(1e-12);
                k * delta * x * x / (1.0 + x * x)
            }
        }
    }

    /// The deflection under a constant torque.
    fn at_rest(&self, torque: f64) -> f64 {
        let (mut low, mut high) = (-1.0_f64, 1.0_f64);
        for _ in 0..50 {
            let middle = f64::midpoint(low, high);
            if self.torque(middle) < torque { low = middle } else { high = middle }
        }
        f64::midpoint(low, high)
    }

    /// Deflections \[rad\] over a period with the torque `load` \[Nm\] of the rigid link and its
    /// inertias `inertia` \[kg m²\].
    pub(super) fn deflections(&self, load: &[f64], inertia: &[f64], step_s: f64) -> Vec<f64> {
        let count = load.len();
        let mut delta: Vec<f64> = load.iter().map(|tau| self.at_rest(*tau)).collect();
        if let Some(damping) = self.damping {
            let lightest = inertia.iter().copied().fold(f64::INFINITY, f64::min).max(1e-6);
            let fastest = (2.0 * self.stiffness / lightest).sqrt();
            let steps = ((fastest * step_s / FINEST).ceil() as usize).clamp(1, MOST_STEPS);
            // The mass is increased where the finest step does not resolve the eigenfrequency.
            let heaviest_needed = 2.0 * self.stiffness * (step_s / (steps as f64 * 0.5)).powi(2);
            let h = step_s / steps as f64;
            let (mut x, mut v) = (delta.first().copied().unwrap_or(0.0), 0.0);
            // The transient has decayed in the second period.
            for i in 0..2 * count {
                let (now, next) = (i % count, (i + 1) % count);
                delta[now] = x;
                let mass = inertia[now].max(heaviest_needed);
                let d = 2.0 * damping * (self.stiffness * mass).sqrt();
                for k in 0..steps {
                    let share = k as f64 / steps as f64;
                    let pull = load[now] + (load[next] - load[now]) * share;
                    // Implicit damping, because it may be stiff.
                    v = (v + h * (pull - self.torque(x)) / mass) / (1.0 + h * d / mass);
                    x += h * v;
                }
            }
        }
        if self.damping.is_none() {
            for _ in 0..2 {
                delta = smoothed(&delta);
            }
        }
        delta
    }
}

/// The moving average over neighbouring samples: a link crosses its gap in a finite time.
fn smoothed(values: &[f64]) -> Vec<f64> {
    let count = values.len();
    let mean = |i: usize| {
        let around = (0..=2 * REACH).map(|k| values[(i + k + count * REACH - REACH) % count]);
        around.sum::<f64>() / (2 * REACH + 1) as f64
    };
    (0..count).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const STEP_S: f64 = 0.002;
    const STIFFNESS: f64 = 2e4;
    const INERTIA: f64 = 5.0;

    fn deflections(spring: Spring, damping: Option<f64>, frequency: f64) -> Vec<f64> {
        let count = (1.0 / frequency / STEP_S).round() as usize;
        let load: Vec<f64> =
            (0..count).map(|i| 100.0 * (TAU * i as f64 / count as f64).sin()).collect();
        let compliance = Compliance { joint: 0, stiffness: STIFFNESS, spring, damping };
        compliance.deflections(&load, &vec![INERTIA; count], STEP_S)
    }

    fn largest(values: &[f64]) -> f64 {
        values.iter().fold(0.0, |most, x| x.abs().max(most))
    }

    /// At low frequency an oscillator is a spring; near its resonance the amplitude is that of the
    /// steady state of a damped oscillator.
    #[test]
    fn oscillators_have_their_resonance() {
        let still = largest(&deflections(Spring::Linear, None, 0.1));
        let slow = largest(&deflections(Spring::Linear, Some(0.7), 0.1));
        assert!((slow / still - 1.0).abs() < 0.01, "{slow} {still}");

        let own = (STIFFNESS / INERTIA).sqrt() / TAU;
        let (damping, x) = (0.2, 0.5);
        let found = largest(&deflections(Spring::Linear, Some(damping), x * own));
        let amplified = 1.0 / ((1.0 - x * x).powi(2) + (2.0 * damping * x).powi(2)).sqrt();
        let expected = amplified * 100.0 / STIFFNESS;
        assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
    }

    /// A gap adds half of its width to each side.
    #[test]
    fn gaps_are_crossed() {
        let gap = 4e-3;
        let with = deflections(Spring::Gap(gap), Some(0.5), 0.5);
        let without = deflections(Spring::Linear, Some(0.5), 0.5);
        let more = largest(&with) - largest(&without);
        assert!((more - 0.5 * gap).abs() < 0.1 * gap, "{more}");
    }
}

//! What the laws of faults share: the state that they see, their memory, their parameters.

use crate::spatial::Axes;

/// What a law remembers between steps.
pub type Memory = [f64; 4];

/// A parameter of a law: name, value in SI units, whether it means the same in the library's law.
pub type Parameter = (&'static str, f64, bool);

/// The state of the drives at one step; rates, accelerations and loads in motor coordinates, but
/// behind the gear (divided by, or times, the ratio).
#[derive(Clone, Copy, Debug, Default)]
pub struct Now {
    /// Time since the log's start \[s\].
    pub time: f64,
    /// Time since the period's start \[s\].
    pub phase: f64,
    /// Step \[s\].
    pub dt: f64,
    /// Joint angles \[rad\].
    pub q: Axes,
    /// Rates \[rad/s\].
    pub v: Axes,
    /// Accelerations \[rad/s²\].
    pub a: Axes,
    /// Torques of the links through the gears \[Nm\].
    pub load: Axes,
}

/// Rate \[rad/s\] at which a sign is rounded off.
const SIGN_SPEED: f64 = 0.004;

/// The sign of a rate, rounded off.
#[must_use]
pub fn sign(rate: f64) -> f64 {
    (rate / SIGN_SPEED).tanh()
}

/// A logistic step from 0 to 1.
#[must_use]
pub fn step(x: f64) -> f64 {
    0.5 + 0.5 * (0.5 * x).tanh()
}

/// ln(1 + eˣ), without overflow.
#[must_use]
pub fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

/// A reproducible random number in [−1, 1) for a time slot.
#[must_use]
pub fn noise(seed: u64, slot: i64) -> f64 {
    let mut z = seed ^ (slot as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// One step of a stop: the state follows `change` and stays within ±1.
#[must_use]
pub fn stop(state: f64, change: f64) -> f64 {
    (state + change).clamp(-1.0, 1.0)
}

//! What the laws of faults share: the state that they see, their memory, their parameters.

use crate::examine::worlds::model::Row;

/// What a law remembers between steps.
pub(super) type Memory = [f64; 4];

/// A parameter of a law: name, value in SI units, whether it means the same in the library's law.
pub(super) type Parameter = (&'static str, f64, bool);

/// The state of the drives at one step; rates, accelerations and loads in motor coordinates, but
/// behind the gear (divided by, or times, the ratio).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Now {
    /// Time since the log's start \[s\].
    pub(super) time: f64,
    /// Time since the period's start \[s\].
    pub(super) phase: f64,
    /// Step \[s\].
    pub(super) dt: f64,
    /// Joint angles \[rad\].
    pub(super) q: Row,
    /// Rates \[rad/s\].
    pub(super) v: Row,
    /// Accelerations \[rad/s²\].
    pub(super) a: Row,
    /// Torques of the links through the gears \[Nm\].
    pub(super) load: Row,
}

/// Rate \[rad/s\] at which a sign is rounded off.
const SIGN_SPEED: f64 = 0.004;

/// The sign of a rate, rounded off.
pub(super) fn sign(rate: f64) -> f64 {
    (rate / SIGN_SPEED).tanh()
}

/// A logistic step from 0 to 1.
pub(super) fn step(x: f64) -> f64 {
    0.5 + 0.5 * (0.5 * x).tanh()
}

/// ln(1 + eˣ), without overflow.
pub(super) fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

/// One step of a stop: the state follows `change` and stays within ±1.
pub(super) fn stop(state: f64, change: f64) -> f64 {
    (state + change).clamp(-1.0, 1.0)
}

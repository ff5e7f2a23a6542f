//! What the laws of faults share: the state that they see, their memory, their parameters.

use crate::examine::worlds::model::Row;
use std::rc::Rc;

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

/// One motor at one step: rate, acceleration, angle, load, the rate's rounded sign, and the torque that
/// a law of the reported values changes.
pub(super) struct Seen<'a> {
    pub(super) w: f64,
    pub(super) a: f64,
    pub(super) q: f64,
    pub(super) load: f64,
    pub(super) sign: f64,
    pub(super) torque: f64,
    pub(super) now: &'a Now,
}

/// A torque of what is seen, of the sizes and of a memory.
type Law = dyn Fn(&Seen, [f64; 2], &mut Memory) -> f64;

/// A law of one motor with up to two sizes, which grow with the fault. Of friction: the torque \[Nm\]
/// that the motor needs more; of reported values: the reported torque.
#[derive(Clone)]
pub(super) struct MotorLaw {
    pub(super) sizes: [f64; 2],
    told: Rc<dyn Fn([f64; 2]) -> Vec<Parameter>>,
    law: Rc<Law>,
}

impl MotorLaw {
    /// A law; `told` gives its parameters by the library's names.
    pub(super) fn new(
        sizes: [f64; 2],
        told: impl Fn([f64; 2]) -> Vec<Parameter> + 'static,
        law: impl Fn(&Seen, [f64; 2], &mut Memory) -> f64 + 'static,
    ) -> Self {
        Self { sizes, told: Rc::new(told), law: Rc::new(law) }
    }

    /// Its torque \[Nm\] of motor `i`.
    pub(super) fn at(&self, i: usize, now: &Now, torque: f64, memory: &mut Memory) -> f64 {
        let (w, a, q, load) = (now.v[i], now.a[i], now.q[i], now.load[i]);
        let seen = Seen { w, a, q, load, sign: sign(w), torque, now };
        (self.law)(&seen, self.sizes, memory)
    }

    /// Its parameters by the library's names.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        (self.told)(self.sizes)
    }
}

/// Rate \[rad/s\] at which a sign is rounded off.
const SIGN_SPEED: f64 = 0.004;

/// The sign of a rate, rounded off.
fn sign(rate: f64) -> f64 {
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

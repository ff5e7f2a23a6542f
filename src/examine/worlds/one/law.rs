//! What a joint does beyond rigid bodies: laws with states, integrated along the prescribed motion
//! by the classical Runge-Kutta method of order four, and readers, which distort the reported torque.

/// Most states of one law.
pub(super) const SLOTS: usize = 6;
/// States of a law.
pub(super) type States = [f64; SLOTS];

/// What a law sees of one joint at one time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct View {
    /// Time of the log \[s\].
    pub(super) t: f64,
    /// Time within the period \[s\].
    pub(super) phase: f64,
    /// Angle \[rad\].
    pub(super) q: f64,
    /// Speed \[rad/s\].
    pub(super) v: f64,
    /// Acceleration \[rad/s²\].
    pub(super) a: f64,
    /// Torque through the gear \[Nm\].
    pub(super) load: f64,
    /// What the fault's own field gives here \[Nm\].
    pub(super) field: f64,
    /// Direction of friction, −1 to 1, from the Maxwell elements.
    pub(super) sign: f64,
    /// Angle of the other joint \[rad\].
    pub(super) other_q: f64,
    /// Speed of the other joint \[rad/s\].
    pub(super) other_v: f64,
    /// Acceleration of the other joint \[rad/s²\].
    pub(super) other_a: f64,
    /// Torque through the gear of the other joint \[Nm\].
    pub(super) other_load: f64,
}

impl View {
    /// Half way between two views of a period.
    pub(super) fn middle(&self, after: &Self) -> Self {
        let half = f64::midpoint;
        Self {
            t: half(self.t, after.t),
            phase: self.phase,
            q: half(self.q, after.q),
            v: half(self.v, after.v),
            a: half(self.a, after.a),
            load: half(self.load, after.load),
            field: half(self.field, after.field),
            sign: half(self.sign, after.sign),
            other_q: half(self.other_q, after.other_q),
            other_v: half(self.other_v, after.other_v),
            other_a: half(self.other_a, after.other_a),
            other_load: half(self.other_load, after.other_load),
        }
    }
}

/// States of which the first are given.
pub(super) fn states<const N: usize>(first: [f64; N]) -> States {
    std::array::from_fn(|i| first.get(i).copied().unwrap_or(0.0))
}

/// A law of a joint.
pub(super) trait Law {
    /// States at the start of a log.
    fn start(&self, _view: &View) -> States {
        [0.0; SLOTS]
    }
    /// Whether it has states to integrate.
    fn moves(&self) -> bool {
        true
    }
    /// Rates of the states, per second.
    fn rates(&self, _view: &View, _states: &States) -> States {
        [0.0; SLOTS]
    }
    /// Changes of mode after a step.
    fn settle(&self, _view: &View, _states: &mut States) {}
    /// Torque of the motor \[Nm\].
    fn torque(&self, _view: &View, _states: &States) -> f64 {
        0.0
    }
    /// Angle of the encoder less that of the link \[rad\].
    fn bend(&self, _view: &View, _states: &States) -> f64 {
        0.0
    }
}

/// One step of the Runge-Kutta method.
pub(super) fn advance(law: &dyn Law, before: &View, after: &View, states: &mut States, dt: f64) {
    if law.moves() {
        let middle = before.middle(after);
        let along = |k: &States, h: f64| {
            let mut out = *states;
            for i in 0..SLOTS {
                out[i] += h * k[i];
            }
            out
        };
        let k1 = law.rates(before, states);
        let k2 = law.rates(&middle, &along(&k1, 0.5 * dt));
        let k3 = law.rates(&middle, &along(&k2, 0.5 * dt));
        let k4 = law.rates(after, &along(&k3, dt));
        for i in 0..SLOTS {
            states[i] += dt * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
        }
    }
    law.settle(after, states);
}

/// A torque without states.
pub(super) struct Static<F>(pub F);

impl<F: Fn(&View) -> f64> Law for Static<F> {
    fn moves(&self) -> bool {
        false
    }
    fn torque(&self, view: &View, _: &States) -> f64 {
        (self.0)(view)
    }
}

/// A torque behind an oscillator: `ẍ + 2ζω ẋ + ω² x = ω² u`.
pub(super) struct Oscillator<F> {
    /// Natural frequency \[rad/s\].
    omega: f64,
    zeta: f64,
    /// What drives it \[Nm\].
    drive: F,
}

impl<F: Fn(&View) -> f64> Oscillator<F> {
    pub(super) fn new(omega: f64, zeta: f64, drive: F) -> Self {
        Self { omega, zeta, drive }
    }
}

impl<F: Fn(&View) -> f64> Law for Oscillator<F> {
    fn start(&self, view: &View) -> States {
        states([(self.drive)(view)])
    }
    fn rates(&self, view: &View, s: &States) -> States {
        let pull = self.omega * self.omega * ((self.drive)(view) - s[0]);
        states([s[1], pull - 2.0 * self.zeta * self.omega * s[1]])
    }
    fn torque(&self, _: &View, s: &States) -> f64 {
        s[0]
    }
}

/// A torque of the view and of a quantity that follows with a lag: `T ẋ + x = u`.
pub(super) struct Memory<U, F> {
    /// Time constant \[s\].
    lag: f64,
    input: U,
    /// Torque \[Nm\] from the view and the follower.
    output: F,
}

impl<U: Fn(&View) -> f64, F: Fn(&View, f64) -> f64> Memory<U, F> {
    pub(super) fn new(lag: f64, input: U, output: F) -> Self {
        Self { lag, input, output }
    }
}

impl<U: Fn(&View) -> f64, F: Fn(&View, f64) -> f64> Law for Memory<U, F> {
    fn start(&self, view: &View) -> States {
        states([(self.input)(view)])
    }
    fn rates(&self, view: &View, s: &States) -> States {
        states([((self.input)(view) - s[0]) / self.lag])
    }
    fn torque(&self, view: &View, s: &States) -> f64 {
        (self.output)(view, s[0])
    }
}

/// Hysteresis of R. Bouc and Y. Wen with exponent 1: `dz/dq = (1 − s z)/distance`, followed in time
/// with both halves of the loop; the torque is a function of the view and z.
pub(super) struct Bouc<F> {
    /// Angle in which 1/e is left \[rad\].
    distance: f64,
    /// Shape of the loop: 0.5 is symmetric.
    shape: f64,
    /// Torque \[Nm\].
    output: F,
}

impl<F: Fn(&View, f64) -> f64> Bouc<F> {
    pub(super) fn new(distance: f64, shape: f64, output: F) -> Self {
        Self { distance, shape, output }
    }
}

impl<F: Fn(&View, f64) -> f64> Law for Bouc<F> {
    fn rates(&self, view: &View, s: &States) -> States {
        let z = s[0];
        let loss = self.shape * view.v.abs() * z + (1.0 - self.shape) * view.v * z.abs();
        states([(view.v - loss) / self.distance])
    }
    fn settle(&self, _: &View, s: &mut States) {
        // Loops that are much faster than a step stay within the bound of the hysteresis.
        s[0] = s[0].clamp(-1.0, 1.0);
    }
    fn torque(&self, view: &View, s: &States) -> f64 {
        (self.output)(view, s[0])
    }
}

/// What distorts the torque between motor and log.
pub(super) trait Reader {
    /// The distorted torque \[Nm\]; `memory` is its own, empty at the start of a log.
    fn read(&self, view: &View, memory: &mut Vec<f64>, tau: f64, dt: f64) -> f64;
}

/// A reader without memory.
pub(super) struct Plain<F>(pub F);

impl<F: Fn(&View, f64) -> f64> Reader for Plain<F> {
    fn read(&self, view: &View, _: &mut Vec<f64>, tau: f64, _: f64) -> f64 {
        (self.0)(view, tau)
    }
}

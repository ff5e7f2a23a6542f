//! What a joint does beyond rigid bodies: laws with states, integrated along the prescribed motion
//! by the classical Runge-Kutta method of order four, and readers, which distort the reported torque.

/// Most states of one law.
pub const SLOTS: usize = 6;
/// States of a law.
pub type States = [f64; SLOTS];

/// What a law sees of one joint at one time.
#[derive(Clone, Copy, Debug, Default)]
pub struct View {
    /// Time of the log \[s\].
    pub t: f64,
    /// Time within the period \[s\].
    pub phase: f64,
    /// Angle \[rad\].
    pub q: f64,
    /// Speed \[rad/s\].
    pub v: f64,
    /// Acceleration \[rad/s²\].
    pub a: f64,
    /// Torque through the gear \[Nm\].
    pub load: f64,
    /// What the fault's own field gives here \[Nm\].
    pub field: f64,
    /// Direction of friction, −1 to 1, from the Maxwell elements.
    pub sign: f64,
    /// Angle of the other joint \[rad\].
    pub other_q: f64,
    /// Speed of the other joint \[rad/s\].
    pub other_v: f64,
    /// Acceleration of the other joint \[rad/s²\].
    pub other_a: f64,
    /// Torque through the gear of the other joint \[Nm\].
    pub other_load: f64,
}

impl View {
    /// Half way between two views.
    pub const fn middle(&self, after: &Self) -> Self {
        const fn half(a: f64, b: f64) -> f64 {
            0.5 * (a + b)
        }
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

/// A law of a joint.
pub trait Law {
    /// States at the start of a log.
    fn start(&self, _view: &View) -> States {
        [0.0; SLOTS]
    }
    /// Whether it has states to integrate.
    fn moves(&self) -> bool {
        false
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
pub fn advance(law: &dyn Law, before: &View, after: &View, states: &mut States, dt: f64) {
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
pub struct Static<F>(pub F);

impl<F: Fn(&View) -> f64> Law for Static<F> {
    fn torque(&self, view: &View, _: &States) -> f64 {
        (self.0)(view)
    }
}

/// A torque behind an oscillator: `ẍ + 2ζω ẋ + ω² x = ω² u`.
pub struct Oscillator<F> {
    /// Natural frequency \[rad/s\].
    pub omega: f64,
    /// Damping.
    pub zeta: f64,
    /// What drives it \[Nm\].
    pub drive: F,
}

impl<F: Fn(&View) -> f64> Law for Oscillator<F> {
    fn start(&self, view: &View) -> States {
        let mut states = [0.0; SLOTS];
        states[0] = (self.drive)(view);
        states
    }
    fn moves(&self) -> bool {
        true
    }
    fn rates(&self, view: &View, s: &States) -> States {
        let pull = self.omega * self.omega * ((self.drive)(view) - s[0]);
        [s[1], pull - 2.0 * self.zeta * self.omega * s[1], 0.0, 0.0, 0.0, 0.0]
    }
    fn torque(&self, _: &View, s: &States) -> f64 {
        s[0]
    }
}

/// A torque of the view and of a quantity that follows with a lag: `T ẋ + x = u`.
pub struct Memory<U, F> {
    /// Time constant \[s\].
    pub lag: f64,
    /// What is followed.
    pub input: U,
    /// Torque \[Nm\] from the view and the follower.
    pub output: F,
}

impl<U: Fn(&View) -> f64, F: Fn(&View, f64) -> f64> Law for Memory<U, F> {
    fn start(&self, view: &View) -> States {
        let mut states = [0.0; SLOTS];
        states[0] = (self.input)(view);
        states
    }
    fn moves(&self) -> bool {
        true
    }
    fn rates(&self, view: &View, s: &States) -> States {
        [((self.input)(view) - s[0]) / self.lag, 0.0, 0.0, 0.0, 0.0, 0.0]
    }
    fn torque(&self, view: &View, s: &States) -> f64 {
        (self.output)(view, s[0])
    }
}

/// Hysteresis of R. Bouc and Y. Wen with exponent 1: `dz/dq = (1 − s z)/distance`, followed in time
/// with both halves of the loop; the torque is a function of the view and z.
pub struct Bouc<F> {
    /// Angle in which 1/e is left \[rad\].
    pub distance: f64,
    /// Shape of the loop: 0.5 is symmetric.
    pub shape: f64,
    /// Torque \[Nm\].
    pub output: F,
}

impl<F: Fn(&View, f64) -> f64> Law for Bouc<F> {
    fn moves(&self) -> bool {
        true
    }
    fn rates(&self, view: &View, s: &States) -> States {
        let z = s[0];
        let loss = self.shape * view.v.abs() * z + (1.0 - self.shape) * view.v * z.abs();
        [(view.v - loss) / self.distance, 0.0, 0.0, 0.0, 0.0, 0.0]
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
pub trait Reader {
    /// The distorted torque \[Nm\]; `memory` is its own, empty at the start of a log.
    fn read(&self, view: &View, memory: &mut Vec<f64>, tau: f64, dt: f64) -> f64;
}

/// A reader without memory.
pub struct Plain<F>(pub F);

impl<F: Fn(&View, f64) -> f64> Reader for Plain<F> {
    fn read(&self, view: &View, _: &mut Vec<f64>, tau: f64, _: f64) -> f64 {
        (self.0)(view, tau)
    }
}

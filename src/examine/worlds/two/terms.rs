//! Laws of faults that add a torque at one joint: `τ = level·s + smooth`.
//!
//! `s` is the bristle state of the joint, between −1 and 1: a sign that takes some angle to turn.

use crate::examine::worlds::model::Row;
use std::rc::Rc;

/// What laws may depend on, at one instant: by joint, angles \[rad\], rates and accelerations of the
/// motors (these smoothed), torques through the gears \[Nm\], and bristle states.
#[derive(Clone, Debug)]
pub(super) struct Now {
    /// Time of the log and within the period, and the step \[s\].
    pub(super) t: f64,
    pub(super) phase: f64,
    pub(super) dt: f64,
    pub(super) q: Row,
    pub(super) v: Row,
    pub(super) a: Row,
    pub(super) load: Row,
    pub(super) s: Row,
    /// Everyday factors of Coulomb and viscous friction.
    pub(super) dry: Row,
    pub(super) wet: Row,
    /// Uniform random numbers of the 4 ms tick.
    pub(super) chance: Row,
}

/// Step of the tick on which random switches are drawn \[s\].
pub(super) const TICK: f64 = 0.004;
/// Flank of windows whose law has none of its own \[s\].
pub(super) const FLANK: f64 = 0.03;

/// States of a law, 0 at the start of a log.
pub(super) type States = [f64; 2];
/// Level of friction and smooth torque \[Nm\]; steps the states.
type Law = dyn Fn(&Seen, &mut States) -> (f64, f64);

/// What a law sees of its joint.
pub(super) struct Seen<'a> {
    pub(super) now: &'a Now,
    pub(super) q: f64,
    pub(super) v: f64,
    pub(super) a: f64,
    pub(super) load: f64,
    pub(super) s: f64,
    pub(super) dry: f64,
    pub(super) wet: f64,
    pub(super) chance: f64,
}

impl Now {
    /// What a law of joint `i` sees.
    pub(super) fn seen(&self, i: usize) -> Seen<'_> {
        Seen {
            now: self,
            q: self.q[i],
            v: self.v[i],
            a: self.a[i],
            load: self.load[i],
            s: self.s[i],
            dry: self.dry[i],
            wet: self.wet[i],
            chance: self.chance[i],
        }
    }
}

/// A law at a joint.
#[derive(Clone)]
pub(super) struct Term {
    pub(super) joint: usize,
    law: Rc<Law>,
    states: States,
}

impl Term {
    /// A law with level and smooth torque.
    pub(super) fn new(
        joint: usize,
        law: impl Fn(&Seen, &mut States) -> (f64, f64) + 'static,
    ) -> Self {
        Self { joint, law: Rc::new(law), states: [0.0; 2] }
    }

    /// A law of the level alone.
    pub(super) fn level(joint: usize, law: impl Fn(&Seen) -> f64 + 'static) -> Self {
        Self::new(joint, move |x, _| (law(x), 0.0))
    }

    /// A law of the smooth torque alone.
    pub(super) fn smooth(joint: usize, law: impl Fn(&Seen) -> f64 + 'static) -> Self {
        Self::new(joint, move |x, _| (0.0, law(x)))
    }

    /// `(level, smooth)` \[Nm\]; steps the states.
    pub(super) fn at(&mut self, now: &Now) -> (f64, f64) {
        (self.law)(&now.seen(self.joint), &mut self.states)
    }
}

/// Share of a window with soft flanks \[s\].
pub(super) fn window(now: &Now, from: f64, to: f64, flank: f64) -> f64 {
    let up = ((now.phase - from) / flank).clamp(0.0, 1.0);
    let down = ((to - now.phase) / flank).clamp(0.0, 1.0);
    up.min(down)
}

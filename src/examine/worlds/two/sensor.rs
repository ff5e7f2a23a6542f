//! The way of the torque from the motor to the log: the drive's filter, and faults of it.

use super::terms::{Now, Seen};
use crate::examine::worlds::model::{MAX, Row};
use std::rc::Rc;

/// A ring of the last values.
#[derive(Clone, Debug)]
pub(super) struct Ring<T> {
    values: Vec<T>,
    head: usize,
}

impl<T: Copy> Ring<T> {
    fn new(length: usize, x: T) -> Self {
        Self { values: vec![x; length.max(1)], head: 0 }
    }

    fn push(&mut self, x: T) {
        self.head = (self.head + 1) % self.values.len();
        self.values[self.head] = x;
    }

    /// The value so many steps ago.
    pub(super) fn ago(&self, steps: usize) -> T {
        let count = self.values.len();
        self.values[(self.head + count - steps.min(count - 1)) % count]
    }
}

/// The healthy path: poles, then a moving average, then a delay.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// Time constants of up to two poles; 0: none \[s\].
    pub(super) poles: [f64; 2],
    state: [Row; 2],
    sum: Row,
    ring: Ring<Row>,
    steps: (usize, usize),
}

impl Path {
    /// A path for a step \[s\].
    pub(super) fn new(poles: [f64; 2], mean: f64, delay: f64, dt: f64) -> Self {
        let steps = ((mean / dt).round().max(1.0) as usize, (delay / dt).round() as usize);
        let ring = Ring::new(steps.0 + steps.1 + 1, [0.0; MAX]);
        Self { poles, state: [[0.0; MAX]; 2], sum: [0.0; MAX], ring, steps }
    }

    /// Starts in the steady state.
    pub(super) fn fill(&mut self, x: Row) {
        self.state = [x; 2];
        self.ring.values.fill(x);
        self.sum = x.map(|value| value * self.steps.0 as f64);
    }

    pub(super) fn step(&mut self, x: &Row, dt: f64) -> Row {
        let mut now = *x;
        for (state, pole) in self.state.iter_mut().zip(self.poles) {
            if pole > 0.0 {
                for (s, value) in state.iter_mut().zip(&now) {
                    *s += dt * (value - *s) / (pole + dt);
                }
                now = *state;
            }
        }
        let (width, delay) = self.steps;
        self.ring.push(now);
        let (newest, oldest) = (self.ring.ago(delay), self.ring.ago(delay + width));
        let mut out = [0.0; MAX];
        for i in 0..MAX {
            self.sum[i] += newest[i] - oldest[i];
            out[i] = self.sum[i] / width as f64;
        }
        out
    }
}

/// Longest delay of a fault \[s\].
const LONGEST: f64 = 0.12;

/// What a law of the path remembers.
#[derive(Clone)]
pub(super) struct Memory {
    /// Torque \[Nm\] of the steady state at the start, and 0.
    pub(super) x: [f64; 2],
    /// Time \[s\].
    pub(super) clock: f64,
    /// Torques \[Nm\] of the last 0.12 s.
    pub(super) past: Ring<f64>,
}

impl Memory {
    fn new(tau: f64, steps: usize) -> Self {
        Self { x: [tau, 0.0], clock: 0.0, past: Ring::new(steps, tau) }
    }

    /// One step of a low pass with a pole \[s\], a share of the step being implicit.
    pub(super) fn low_pass(&mut self, tau: f64, pole: f64, implicit: f64, dt: f64) -> f64 {
        self.x[0] += dt * (tau - self.x[0]) / (pole + implicit * dt);
        self.x[0]
    }
}

/// The reported torque \[Nm\] for a torque.
type Law = dyn Fn(f64, &Seen, &mut Memory) -> f64;

/// A fault of the path at a joint, from 0.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) joint: usize,
    law: Rc<Law>,
    memory: Memory,
}

impl Part {
    pub(super) fn new(
        joint: usize,
        law: impl Fn(f64, &Seen, &mut Memory) -> f64 + 'static,
    ) -> Self {
        Self { joint, law: Rc::new(law), memory: Memory::new(0.0, 1) }
    }
}

/// A fault of the path.
#[derive(Clone, Default)]
pub(super) struct Sensor {
    pub(super) parts: Vec<Part>,
}

impl Sensor {
    /// Starts in the steady state.
    pub(super) fn fill(&mut self, x: Row, dt: f64) {
        for part in &mut self.parts {
            part.memory = Memory::new(x[part.joint], (LONGEST / dt) as usize);
        }
    }

    /// Changes the torques \[Nm\].
    pub(super) fn step(&mut self, tau: &mut Row, now: &Now) {
        for Part { joint, law, memory } in &mut self.parts {
            memory.past.push(tau[*joint]);
            tau[*joint] = law(tau[*joint], &now.seen(*joint), memory);
        }
    }
}

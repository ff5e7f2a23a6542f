//! The equations of motion at the instants of a log, row by row.
//!
//! τ = Y(q, q̇, q̈) π for each joint, in the free base parameters; the torque of the known
//! parameters moves to the left side. For filtered motion, torque and regressor pass the same
//! filter (M. Gautier, "Dynamic identification of robots with power model", ICRA 1997: parallel
//! filtering) and are decimated to the remaining bandwidth.

use std::ops::Range;

use crate::arm::dynamics::{
    BaseParameters, Data, JOINT, Load, RIGID, Regressor, motor_rates, regressor, rnea, torque,
};
use crate::arm::robot::{MAX_DOF, Model};
use crate::learn::log::LowPass;

use super::clipped::is_clipped;
use super::samples::{Block, Samples, Source};

/// Instants that are kept per period of the filter's cut-off frequency.
const KEPT_PER_PERIOD: f64 = 2.5;

/// The columns of each joint's equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// For each joint, the base parameters whose coefficient is not always 0, ascending.
    pub columns: Vec<Vec<usize>>,
}

impl Layout {
    /// Number of coefficients in the equations of all joints.
    #[must_use]
    pub fn width(&self) -> usize {
        self.columns.iter().map(Vec::len).sum()
    }

    /// For each joint, its number, its columns, and the place of its coefficients among those of
    /// all joints.
    pub fn joints(&self) -> impl Iterator<Item = (usize, &[usize], Range<usize>)> {
        let mut from = 0;
        self.columns.iter().enumerate().map(move |(joint, columns)| {
            let place = from..from + columns.len();
            from = place.end;
            (joint, columns.as_slice(), place)
        })
    }
}

/// The equations of all joints at one instant.
pub struct Instant<'a> {
    /// Index of the block, from 0.
    pub block: usize,
    /// Index of the instant in its block, from 0.
    pub index: usize,
    /// Time \[s\].
    pub t: f64,
    /// Rates of the joints \[rad/s\].
    pub qd: [f64; MAX_DOF],
    /// Coefficients, joint after joint in the order of the layout.
    pub x: &'a [f64],
    /// Torques less those of the known parameters \[Nm\].
    pub y: &'a [f64],
    /// Torques \[Nm\].
    pub tau: &'a [f64],
    /// Whether the equation of each joint is usable: the joint moves and its torque is not clipped.
    pub usable: [bool; MAX_DOF],
}

impl Instant<'_> {
    /// The torque of the parameters `beta` in the equation of a joint with these columns \[Nm\].
    #[must_use]
    pub fn predicted(&self, columns: &[usize], place: Range<usize>, beta: &[f64]) -> f64 {
        self.x[place].iter().zip(columns).map(|(x, column)| x * beta[*column]).sum()
    }
}

/// The equations of motion of a robot, linear in its base parameters.
pub struct Equations<'a> {
    /// The robot; only its geometry, the wrist coupling and the known parameters are used.
    pub model: &'a Model,
    /// The free parameters.
    pub base: &'a BaseParameters,
    /// The parameters that are not free.
    pub known: Known,
}

/// The parameters that keep the values of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Nothing.
    Nothing,
    /// Rigid bodies and rotors.
    Rigid,
    /// Rigid bodies, rotors and friction.
    All,
}

impl Equations<'_> {
    /// The columns of each joint.
    #[must_use]
    pub fn layout(&self) -> Layout {
        let n = self.model.dof;
        let rates = |kind: usize| -> Vec<f64> {
            (0..n).map(|j| 0.3 + ((kind * MAX_DOF + j + 2) as f64).sqrt().fract()).collect()
        };
        let mut rows = Rows::new(self);
        rows.write(&rates(0), &rates(1), &rates(2));
        let columns = (0..n)
            .map(|joint| {
                let reached = |index: &usize| rows.coefficient(joint, *index) != 0.0;
                let all = self.base.independent.iter().enumerate();
                all.filter(|(_, index)| reached(index)).map(|(k, _)| k).collect()
            })
            .collect();
        Layout { columns }
    }

    /// Calls `visit` for each instant of `samples`, in order of time.
    pub fn each(&self, samples: &Samples, layout: &Layout, visit: &mut dyn FnMut(&Instant<'_>)) {
        let n = self.model.dof;
        let mut rows = Rows::new(self);
        let width = layout.width();
        let mut row = vec![0.0; width + 2 * n];
        for (block, of) in samples.blocks.iter().enumerate() {
            if let Source::Filtered { cutoff } = samples.source {
                self.filtered(samples, layout, block, cutoff, visit);
                continue;
            }
            for index in 0..of.instants() {
                self.instant(&mut rows, of, layout, index, &mut row);
                let qd = Block::at(&of.qd, index);
                visit(&Instant {
                    block,
                    index,
                    t: of.t[index],
                    qd,
                    x: &row[..width],
                    y: &row[width..width + n],
                    tau: &row[width + n..],
                    usable: self.usable(samples, &qd, of, of.t[index], 0.5 * samples.step),
                });
            }
        }
    }

    fn filtered(
        &self,
        samples: &Samples,
        layout: &Layout,
        block: usize,
        cutoff: f64,
        visit: &mut dyn FnMut(&Instant<'_>),
    ) {
        let n = self.model.dof;
        let of = &samples.blocks[block];
        let filter = LowPass::new(cutoff, samples.step);
        let width = filter.width();
        let every = thinning(samples.step, cutoff);
        let span = layout.width() + 2 * n;
        let mut rows = Rows::new(self);
        // Ring buffer of the last `width` instants.
        let mut ring = vec![0.0; width * span];
        let mut sum = vec![0.0; span];
        let weights = filter.weights(0);
        let mut kept = 0;
        let reach = filter.half as f64 * samples.step;
        for index in 0..of.instants() {
            let place = index % width;
            let row = &mut ring[place * span..(place + 1) * span];
            self.instant(&mut rows, of, layout, index, row);
            if index + 1 < width || !(index + 1 - width).is_multiple_of(every) {
                continue;
            }
            sum.fill(0.0);
            for (k, weight) in weights.iter().enumerate() {
                let from = (place + 1 + k) % width;
                let row = &ring[from * span..(from + 1) * span];
                for (sum, value) in sum.iter_mut().zip(row) {
                    *sum += weight * value;
                }
            }
            let centre = index - filter.half;
            let qd = Block::at(&of.qd, centre);
            let (x, y) = sum.split_at(layout.width());
            visit(&Instant {
                block,
                index: kept,
                t: of.t[centre],
                qd,
                x,
                y: &y[..n],
                tau: &y[n..],
                usable: self.usable(samples, &qd, of, of.t[centre], reach),
            });
            kept += 1;
        }
    }

    /// Writes coefficients, torques without the known ones, and torques into `row`.
    fn instant(
        &self,
        rows: &mut Rows<'_>,
        block: &Block,
        layout: &Layout,
        index: usize,
        row: &mut [f64],
    ) {
        let n = self.model.dof;
        let (x, y) = row.split_at_mut(layout.width());
        let [q, qd, qdd] = [&block.q, &block.qd, &block.qdd].map(|series| Block::at(series, index));
        rows.write(&q[..n], &qd[..n], &qdd[..n]);
        let known = self.known_torque(&mut rows.data, &q[..n], &qd[..n], &qdd[..n]);
        let mut to = x.iter_mut();
        for (joint, columns) in layout.columns.iter().enumerate() {
            for (column, value) in columns.iter().zip(to.by_ref()) {
                *value = rows.coefficient(joint, self.base.independent[*column]);
            }
            let tau = block.tau[joint][index];
            y[joint] = tau - known[joint];
            y[n + joint] = tau;
        }
    }

    fn known_torque(&self, data: &mut Data, q: &[f64], qd: &[f64], qdd: &[f64]) -> [f64; MAX_DOF] {
        let none = Load::none();
        match self.known {
            Known::Nothing => [0.0; MAX_DOF],
            Known::Rigid => rnea(self.model, data, &none, q, qd, qdd),
            Known::All => {
                let mut sum = [0.0; MAX_DOF];
                let torque = torque(self.model, data, &none, q, qd, qdd);
                for (sum, parts) in sum.iter_mut().zip(torque.rigid.iter().zip(torque.friction)) {
                    *sum = parts.0 + parts.1;
                }
                sum
            }
        }
    }

    /// Whether each joint's equation is usable. A joint at rest may have any friction up to the
    /// static one; with a coupled wrist the motor of axis 6 has to turn, too. A torque clipped
    /// within `reach` \[s\] of the instant makes its equation unusable.
    fn usable(
        &self,
        samples: &Samples,
        qd: &[f64; MAX_DOF],
        block: &Block,
        t: f64,
        reach: f64,
    ) -> [bool; MAX_DOF] {
        let n = self.model.dof;
        let turning = |joint: usize, rate: f64| rate.abs() > samples.rest[joint];
        let mut usable = [false; MAX_DOF];
        for (joint, usable) in usable.iter_mut().enumerate().take(n) {
            *usable = turning(joint, qd[joint]);
        }
        if self.model.wrist.coupling != 0.0 {
            let sixth = turning(5, motor_rates(self.model, &qd[..n])[5]);
            usable[4] &= sixth;
            usable[5] = sixth;
        }
        for (usable, spans) in usable.iter_mut().zip(&block.clipped) {
            *usable &= !is_clipped(spans, t, reach);
        }
        usable
    }
}

/// One of this many filtered samples is kept.
#[must_use]
pub(super) fn thinning(step: f64, cutoff: f64) -> usize {
    (1.0 / (KEPT_PER_PERIOD * cutoff * step)).floor().max(1.0) as usize
}

/// The regressor at one state, by joint and parameter.
struct Rows<'a> {
    model: &'a Model,
    regressor: Regressor,
    data: Data,
    /// Coefficients of each motor's parameters.
    motors: [[f64; JOINT]; MAX_DOF],
    /// Share of each motor's torque in that of a joint: `shares[joint][motor]`.
    shares: [[f64; MAX_DOF]; MAX_DOF],
}

impl Rows<'_> {
    fn new<'a>(equations: &Equations<'a>) -> Rows<'a> {
        let model = equations.model;
        let mut shares = [[0.0; MAX_DOF]; MAX_DOF];
        for (joint, share) in shares.iter_mut().enumerate().take(model.dof) {
            let mut unit = [0.0; MAX_DOF];
            unit[joint] = 1.0;
            *share = motor_rates(model, &unit[..model.dof]);
        }
        Rows {
            model,
            regressor: Regressor::new(),
            data: Data::new(),
            motors: [[0.0; JOINT]; MAX_DOF],
            shares,
        }
    }

    fn write(&mut self, q: &[f64], qd: &[f64], qdd: &[f64]) {
        regressor(self.model, &mut self.regressor, q, qd, qdd);
        let (rates, accelerations) = (motor_rates(self.model, qd), motor_rates(self.model, qdd));
        for (motor, row) in self.motors.iter_mut().enumerate() {
            let rate = rates[motor];
            let sign = if rate == 0.0 { 0.0 } else { rate.signum() };
            *row = [accelerations[motor], rate, sign, 1.0];
        }
    }

    fn coefficient(&self, joint: usize, parameter: usize) -> f64 {
        let rigid = RIGID * self.model.dof;
        if parameter < rigid {
            self.regressor.rows[joint][parameter / RIGID][parameter % RIGID]
        } else {
            let motor = (parameter - rigid) / JOINT;
            self.shares[joint][motor] * self.motors[motor][(parameter - rigid) % JOINT]
        }
    }
}

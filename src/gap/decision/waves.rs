//! Effects that are waves over the position of a joint.
//!
//! What each order would gain comes from one transform: its product with what is left is the sum of
//! `x(t)·exp(−i·order·q(t))`, x the weighted remainder. It is a transform over the position.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::shape::resolution;
use super::starts::starts;
use crate::arm::effects::{Effect, Role};
use crate::gap::data::{Record, RecordKind};
use crate::gap::design::{Design, PieceRows, piece_at};
use crate::gap::posterior::Gains;

/// Parts of the shortest wave.
const PARTS: f64 = 8.0;
/// Information on an order below which nothing is seen of it, of the largest one.
const SEEN: f64 = 1e-2;
/// Waves that have to be seen within the range of the joint.
const WAVES: f64 = 2.0;
/// Classes of speeds.
const SPEEDS: usize = 64;

/// An effect that is waves over the position of a joint.
pub(super) struct Waves {
    effect: &'static Effect,
    joint: usize,
    /// Usual values of its coordinates.
    usual: Vec<f64>,
    /// The place of its order.
    coordinate: usize,
    /// The lowest and the highest order.
    orders: [f64; 2],
    /// Orders that are told apart.
    resolution: f64,
}

impl Waves {
    /// The waves of an effect at a joint; `None` where it has none that can be resolved.
    pub(super) fn new(
        records: &[Record<'_>],
        effect: &'static Effect,
        joint: usize,
    ) -> Option<Waves> {
        let scale = records.first()?.motion.scale(joint);
        let of_role = |(k, role)| match role {
            Role::Waves { least, most } => Some((k, [least, most(&scale)])),
            _ => None,
        };
        let mut roles = effect.coordinates.iter().map(|of| of.role).enumerate();
        let (coordinate, orders) = roles.find_map(of_role)?;
        let resolution = resolution(records, joint);
        // Slower ones are smooth functions of the position, which any robot has.
        let orders = [orders[0].max(2.0 * WAVES * resolution), orders[1]];
        let usual = effect.coordinates.iter().map(|of| (of.usual)(&scale)).collect();
        (orders[1] > orders[0] + resolution).then_some(Waves {
            effect,
            joint,
            usual,
            coordinate,
            orders,
            resolution,
        })
    }

    /// The best orders beside a fit.
    pub(super) fn best(
        &self,
        records: &[Record<'_>],
        design: &Design,
        gains: &Gains<'_>,
    ) -> Vec<PieceRows> {
        let choices = ((self.orders[1] - self.orders[0]) / self.resolution).ceil() as usize;
        let are_apart = |a: f64, b: f64| (a - b).abs() > 2.0 * self.resolution;
        let starts = starts(self.gains(records, design, gains), choices, are_apart);
        let piece = |order: f64| {
            let mut shape = self.usual.clone();
            shape[self.coordinate] = order;
            let empty = PieceRows::of_shape(self.effect, self.joint, shape, choices);
            piece_at(design, records, &empty)
        };
        starts.into_iter().map(piece).collect()
    }

    /// What waves would gain, were they apart from all that is marginalised \[nats\], with their orders.
    fn gains(&self, records: &[Record<'_>], design: &Design, gains: &Gains<'_>) -> Vec<(f64, f64)> {
        let of = &design.joints[self.joint];
        let (weights, left) = gains.left(self.joint);
        let weighted = of.by_record(records, &weights.component_mul(left));
        let weights = of.by_record(records, weights);
        let width = std::f64::consts::PI / (PARTS / 2.0 * self.orders[1]);
        let positions = || records.iter().flat_map(|of| &of.motion.q[self.joint]).copied();
        let low = positions().fold(f64::INFINITY, f64::min);
        let high = positions().fold(f64::NEG_INFINITY, f64::max);
        let count = (2.0 * (high - low) / width).ceil().max(2.0) as usize;
        let count = count.next_power_of_two();
        let mut sums = vec![Complex::new(0.0, 0.0); count];
        let mut speeds: Vec<Speeds> = Vec::new();
        let parts = records.iter().zip(&weighted).zip(weights);
        for ((record, x), weights) in parts.filter(|of| of.0.0.kind == RecordKind::Mean) {
            let x = record.back(self.joint, x);
            for (q, x) in record.motion.q[self.joint].iter().zip(x) {
                sums[((q - low) / width) as usize].re += x;
            }
            speeds.push(Speeds::new(record, self.joint, weights));
        }
        FftPlanner::new().plan_fft_forward(count).process(&mut sums);
        let step = std::f64::consts::TAU / (width * count as f64);
        let [first, last] = self.orders.map(|order| (order / step) as usize);
        let numbers = first + 1..last.min(count / 2);
        let information =
            |k: usize| -> f64 { speeds.iter().map(|of| of.information(step * k as f64)).sum() };
        let known: Vec<f64> = numbers.clone().map(information).collect();
        let least = SEEN * known.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let gain = |(k, known): (usize, f64)| (0.5 * sums[k].norm_sqr() / known, step * k as f64);
        numbers.zip(known).filter(|(_, known)| *known > least).map(gain).collect()
    }
}

/// How often a joint has which speed in a record, and what its rows weigh.
struct Speeds {
    /// Highest speed of each class \[rad/s\], and the rows in it.
    classes: Vec<(f64, f64)>,
    weights: Vec<f64>,
    /// Distance of frequencies \[Hz\].
    bin: f64,
}

impl Speeds {
    fn new(record: &Record<'_>, joint: usize, weights: Vec<f64>) -> Speeds {
        let rates = &record.motion.qd[joint];
        let most = rates.iter().map(|x| x.abs()).fold(1e-9, f64::max);
        let width = most / SPEEDS as f64;
        let mut classes: Vec<(f64, f64)> =
            (0..=SPEEDS).map(|k| (width * (k as f64 + 0.5), 0.0)).collect();
        for (row, rate) in rates.iter().enumerate() {
            if record.moves(joint, row) {
                classes[(rate.abs() / width) as usize].1 += 1.0;
            }
        }
        Speeds { classes, weights, bin: 1.0 / record.duration() }
    }

    /// Information on the amplitude of a wave \[1/(N²m²)\].
    fn information(&self, order: f64) -> f64 {
        let weight = |speed: f64| {
            let bin = (order * speed / std::f64::consts::TAU / self.bin) as usize;
            self.weights.get((2 * bin).saturating_sub(1)).copied().unwrap_or(0.0)
        };
        self.classes.iter().map(|(speed, rows)| 0.5 * rows * weight(*speed)).sum()
    }
}

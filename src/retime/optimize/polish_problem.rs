//! The merit function of stream polishing and its quadratic model.

use std::collections::BTreeMap;

use super::banded::Banded;
use super::banded_program::Row;
use super::path_energy::{EnergyModel, Sharing};
use super::plant::{
    EDGE_PLACES, PathDerivatives, PathShares, Plant, ROOM, Realised, STRETCHES, direction, realise,
    stretch,
};
use super::stream_points::Points;
use super::stream_reference::Reference;
use crate::retime::motion::stream::{DOF, Joints, Piece, Stream, StreamError};

/// Cost of the distance of a stream from the path of its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPenalty {
    /// Distance with a noticeable cost, m; infinite for a free path.
    pub tolerance: f64,
    /// Weight of each joint in the distance, m/rad.
    pub lever: Joints,
}

/// Cost of a mean distance equal to the tolerance, as a share of the energy.
const DEVIATION_PRICE: f64 = 0.02;
/// Price of an excess of 1, in units of the initial energy.
pub(super) const VIOLATION_PRICE: f64 = 5.0;
/// Share of its limit from which a row is in a program.
const NEAR: f64 = 0.9;
/// Unit of the variables, rad.
pub(super) const UNIT: f64 = 0.01;
/// Smallest tolerance, m.
const TIGHTEST: f64 = 1e-7;
/// Iterations of the search for the nearest point of the path.
const NEAREST_STEPS: usize = 6;
/// Weighted speed below which a path has no direction, m/s.
const SLOWEST: f64 = 1e-6;
/// Smoothing of the braking loss, as a share of the peak power.
const ROUND_POWER: f64 = 0.02;
/// Smoothing of Coulomb friction, as a share of the peak speed.
const ROUND_SPEED: f64 = 0.02;
/// Smallest peak power for the smoothing, W.
const LEAST_POWER: f64 = 1.0;
/// Steps of Simpson's rule on a piece.
const SIMPSON: usize = 2;

/// The data of the merit function of one stream.
pub(super) struct PolishProblem<'a, P> {
    reference: &'a Reference,
    plant: &'a P,
    model: &'a EnergyModel,
    penalty: &'a PathPenalty,
    pub(super) points: Points,
    /// Initial energy of the stream, J: the unit of the merit.
    unit: f64,
    /// Smoothing of the braking loss, W.
    round_power: f64,
    /// Smoothing of Coulomb friction, rad/s.
    round_speed: f64,
    /// Coulomb friction, Nm.
    dry: Joints,
}

/// The row of the largest share of each limit on each stretch of a piece of a stream.
type WorstRows = BTreeMap<(usize, usize), Row>;

/// Torque, shares of the path limits and their derivatives at one place. `torque_by[kind][i]` is
/// the derivative by q, q̇ or q̈ of joint i.
struct Linearised {
    torque: Joints,
    path: PathShares,
    torque_by: [[Joints; DOF]; 3],
    /// Derivative of each share by q and q̇; zero if all shares are far from 1.
    path_by: PathDerivatives,
}

impl<'a, P: Plant> PolishProblem<'a, P> {
    /// The problem of a stream.
    pub(super) fn new(
        stream: &Stream,
        reference: &'a Reference,
        plant: &'a P,
        model: &'a EnergyModel,
        penalty: &'a PathPenalty,
    ) -> Result<PolishProblem<'a, P>, StreamError> {
        let energy = realise(stream, plant, model).energy.total();
        Ok(PolishProblem {
            reference,
            plant,
            model,
            penalty,
            points: Points::new(reference, stream.intervals().to_vec())?,
            unit: energy.abs().max(f64::MIN_POSITIVE),
            round_power: ROUND_POWER * peak_power(stream, plant).max(LEAST_POWER),
            round_speed: (ROUND_SPEED * peak_speed(stream)).max(f64::MIN_POSITIVE),
            dry: plant.dry_friction(),
        })
    }

    /// The realised motion of a stream and its merit: energy, priced excess of limits and priced
    /// distance from the path, in units of the initial energy.
    pub(super) fn merit(&self, stream: &Stream) -> (Realised, f64) {
        let realised = realise(stream, self.plant, self.model);
        let price = self.deviation_price();
        let places = places(stream, |_| SIMPSON);
        let distance: f64 =
            places.iter().map(|p| p.seconds * norm(&self.offset(p).0).powi(2)).sum();
        let merit = realised.energy.total() / self.unit
            + VIOLATION_PRICE * realised.excess
            + price * distance;
        (realised, merit)
    }

    /// Largest distance of the realised motion from the path of the reference, in lever units.
    pub(super) fn deviation(&self, stream: &Stream) -> f64 {
        let places = places(stream, |_| SIMPSON);
        places.iter().map(|p| norm(&self.offset(p).0)).fold(0.0, f64::max)
    }

    /// Price of ∫ distance² dt, in units of the initial energy.
    fn deviation_price(&self) -> f64 {
        DEVIATION_PRICE
            / (self.penalty.tolerance.max(TIGHTEST).powi(2) * self.points.knots.duration())
    }

    /// The vector from the nearest point of the reference path to the place, scaled by the levers,
    /// and the unit direction of the path there, zero at rest.
    fn offset(&self, place: &Place) -> (Joints, Joints) {
        let lever = &self.penalty.lever;
        let stretch = self.reference.duration() / self.points.knots.duration();
        let mut t = place.t * stretch;
        let (mut offset, mut along) = (Joints::default(), Joints::default());
        for _ in 0..NEAREST_STEPS {
            let (q, qd) = self.reference.at(t);
            offset = std::array::from_fn(|j| lever[j] * (place.q[j] - q[j]));
            along = std::array::from_fn(|j| lever[j] * qd[j]);
            let speed = norm(&along);
            if speed < SLOWEST {
                return (offset, Joints::default());
            }
            let ahead: f64 = offset.iter().zip(&along).map(|(o, a)| o * a).sum();
            t = (t + ahead / (speed * speed)).clamp(0.0, self.reference.duration());
            along = along.map(|a| a / speed);
        }
        (offset, along)
    }

    /// Torque and shares at a place; `near` as for [`Plant`].
    fn shares(&self, place: &Place, near: &mut usize) -> Linearised {
        Linearised {
            torque: self.plant.full_torque(&place.q, &place.qd, &place.qdd),
            path: self.plant.path_shares(&place.q, &place.qd, near),
            torque_by: Default::default(),
            path_by: Default::default(),
        }
    }

    /// Computes the derivatives.
    fn linearise(&self, place: &Place, near: usize, beyond: f64, lin: &mut Linearised) {
        lin.torque_by = self.plant.torque_derivatives(&place.q, &place.qd, &place.qdd);
        if lin.path.iter().all(|share| *share <= beyond) {
            return;
        }
        lin.path_by = self.plant.path_derivatives(&place.q, &place.qd, near);
    }

    /// The quadratic model of merit and limits around a stream with this excess.
    pub(super) fn quadratic(&self, stream: &Stream, excess: f64) -> Quadratic {
        let size = self.points.size();
        // A jerk depends on four points.
        let width = (3 * self.points.joints.len()).min(size);
        let mut model = Quadratic {
            matrix: Banded::zeros(size, width),
            gradient: vec![0.0; size],
            shares: Vec::new(),
            broken: VIOLATION_PRICE * excess,
        };
        let mut worst = WorstRows::default();
        for (place, lin) in self.linearised(stream, NEAR, true) {
            let columns = self.columns(&place, &lin);
            self.add_costs(&place, &lin, &columns, &mut model);
            self.add_limits(&place, &lin, &columns, NEAR, &mut worst);
        }
        model.shares = worst.into_values().collect();
        self.add_polygon(stream, NEAR, &mut model.shares);
        model
    }

    /// The limits that a stream exceeds, as rows in the change of the variables from it.
    pub(super) fn exceeded(&self, stream: &Stream) -> Vec<Row> {
        let mut worst = WorstRows::default();
        for (place, lin) in self.linearised(stream, 1.0 - ROOM, false) {
            self.add_limits(&place, &lin, &self.columns(&place, &lin), 1.0 - ROOM, &mut worst);
        }
        let mut rows = worst.into_values().collect();
        self.add_polygon(stream, 1.0 - ROOM, &mut rows);
        rows
    }

    /// The samples of a stream at which a limit is used beyond the share `beyond`, and with `costs`
    /// those of the integrals.
    fn linearised(&self, stream: &Stream, beyond: f64, costs: bool) -> Vec<(Place, Linearised)> {
        let mut near = 0;
        let limit = self.plant.torque_limit();
        let mut samples = Vec::new();
        for place in places(stream, |piece| self.plant.steps(piece)) {
            let mut lin = self.shares(&place, &mut near);
            let loaded = (0..DOF).any(|j| lin.torque[j].abs() > beyond * limit[j]);
            let limited = loaded || lin.path.iter().any(|share| *share > beyond);
            if limited || (costs && place.seconds > 0.0) {
                self.linearise(&place, near, beyond, &mut lin);
                samples.push((place, lin));
            }
        }
        samples
    }

    /// Adds the limits of the polygon of the points.
    fn add_polygon(&self, stream: &Stream, beyond: f64, rows: &mut Vec<Row>) {
        let mut near = 0;
        for (i, edge) in stream.polygon().enumerate() {
            for tau in EDGE_PLACES {
                let (q, _, _) = edge.at(tau);
                let share = self.plant.polygon_share(&q, &mut near);
                if share <= beyond {
                    continue;
                }
                let slopes = self.plant.polygon_derivatives(&q, near);
                let mut weights = Vec::new();
                for (m, joint) in self.points.joints.iter().enumerate() {
                    let slope = UNIT * slopes[*joint];
                    for (point, weight) in [(i, 1.0 - tau), (i + 1, tau)] {
                        let index = self.points.variable(point, m);
                        weights.extend(index.map(|index| (index, weight * slope)));
                    }
                }
                rows.push(share_row(share, weights.into_iter()));
            }
        }
    }

    /// The derivatives of the quantities at a place by the variables.
    fn columns(&self, place: &Place, lin: &Linearised) -> Vec<Column> {
        let weights = self.points.knots.weights(place.piece, place.tau);
        let mut columns = Vec::new();
        for (k, i) in weights.support.clone().enumerate() {
            for (m, joint) in self.points.joints.iter().enumerate() {
                if let Some(index) = self.points.variable(i, m) {
                    let [w, w1, w2] =
                        [weights.position[k], weights.velocity[k], weights.acceleration[k]]
                            .map(|w| UNIT * w);
                    let torque = std::array::from_fn(|j| {
                        w * lin.torque_by[0][*joint][j]
                            + w1 * lin.torque_by[1][*joint][j]
                            + w2 * lin.torque_by[2][*joint][j]
                    });
                    let path = lin.path_by.map(|by| w * by[0][*joint] + w1 * by[1][*joint]);
                    columns.push(Column { index, joint: *joint, w, w1, torque, path });
                }
            }
        }
        columns
    }

    /// Adds the costs at a place to the model.
    fn add_costs(
        &self,
        place: &Place,
        lin: &Linearised,
        columns: &[Column],
        model: &mut Quadratic,
    ) {
        if place.seconds <= 0.0 {
            return;
        }
        let per = place.seconds / self.unit;
        let (offset, along) = self.offset(place);
        let price = self.deviation_price() * place.seconds;
        let lever = &self.penalty.lever;
        let power = self.shared(std::array::from_fn(|j| lin.torque[j] * place.qd[j]));
        let brakes = power.map(|power| self.braking_loss(power, per));
        let mut squares: Vec<[f64; 2 * DOF]> = Vec::with_capacity(columns.len());
        for (n, a) in columns.iter().enumerate() {
            let mut slope = 2.0 * price * a.w * lever[a.joint] * offset[a.joint];
            for j in 0..DOF {
                let work = self.model.work * place.qd[j];
                slope += per * a.torque[j] * (2.0 * self.model.loss[j] * lin.torque[j] + work);
            }
            let speed = 2.0 * self.model.speed * place.qd[a.joint];
            let (dry, dry_slope) = self.rounded_friction(a.joint, place.qd[a.joint]);
            let torque = lin.torque[a.joint] + dry;
            slope += per * a.w1 * (self.model.work * torque + speed);
            let mut power: Joints = std::array::from_fn(|j| a.torque[j] * place.qd[j]);
            power[a.joint] += a.w1 * lin.torque[a.joint];
            let power = self.shared(power);
            slope += power.iter().zip(brakes).map(|(power, (slope, _))| power * slope).sum::<f64>();
            model.gradient[a.index] += slope;

            let copper = |j: usize| (2.0 * per * self.model.loss[j]).sqrt() * a.torque[j];
            let braked = |j: usize| brakes[j].1.sqrt() * power[j];
            squares
                .push(std::array::from_fn(|k| if k < DOF { copper(k) } else { braked(k - DOF) }));
            for (b, square) in columns.iter().zip(&squares) {
                let mut curve: f64 = squares[n].iter().zip(square).map(|(a, b)| a * b).sum();
                let mut normal = -along[a.joint] * along[b.joint];
                if a.joint == b.joint {
                    normal += 1.0;
                    let viscous = lin.torque_by[1][a.joint][a.joint].max(0.0);
                    let friction = self.model.work * (viscous + 0.5 * dry_slope);
                    curve += 2.0 * per * (friction + self.model.speed) * a.w1 * b.w1;
                }
                curve += 2.0 * price * a.w * b.w * lever[a.joint] * lever[b.joint] * normal;
                model.matrix.add(a.index, b.index, curve);
            }
        }
    }

    /// The powers that brake separately: those of the joints, or their sum on a common bus.
    fn shared(&self, powers: Joints) -> Joints {
        match self.model.sharing {
            Sharing::PerJoint => powers,
            Sharing::Bus => {
                let mut bus = [0.0; DOF];
                bus[0] = powers.iter().sum();
                bus
            }
        }
    }

    /// Slope and curvature of the braking loss (√(p² + ε²) − p) / 2 at the power p (W), times `per`.
    fn braking_loss(&self, power: f64, per: f64) -> (f64, f64) {
        let lost = 0.5 * per * (1.0 - self.model.regeneration);
        let root = power.hypot(self.round_power);
        (lost * (power / root - 1.0), lost * (self.round_power / root).powi(2) / root)
    }

    /// Adds rows for the limits that are used beyond a share at a place, if no place of the same
    /// stretch uses more.
    fn add_limits(
        &self,
        place: &Place,
        lin: &Linearised,
        columns: &[Column],
        beyond: f64,
        worst: &mut WorstRows,
    ) {
        let limit = self.plant.torque_limit();
        let torques = (0..DOF).map(|j| lin.torque[j] / limit[j]);
        for (n, share) in torques.chain(lin.path).enumerate() {
            let bound = 1.0 - ROOM - share.abs();
            let known = worst.get(&(place.stretch, n));
            if share.abs() <= beyond || known.is_some_and(|row| row.bound <= bound) {
                continue;
            }
            let weight = |c: &Column| match n.checked_sub(DOF) {
                Some(path) => c.path[path],
                None => share.signum() * c.torque[n] / limit[n],
            };
            let row = share_row(share.abs(), columns.iter().map(|c| (c.index, weight(c))));
            worst.insert((place.stretch, n), row);
        }
    }

    /// Smoothed minus exact Coulomb friction of a joint at a velocity, Nm, and the slope of the
    /// smoothed one, Nms/rad. Without smoothing no step would cross the kink of the work at rest.
    fn rounded_friction(&self, joint: usize, velocity: f64) -> (f64, f64) {
        let root = velocity.hypot(self.round_speed);
        let dry = self.dry[joint];
        (
            dry * (velocity / root - direction(velocity)),
            dry * (self.round_speed / root).powi(2) / root,
        )
    }
}

/// A sample of the realised motion.
struct Place {
    piece: usize,
    stretch: usize,
    /// Time in the piece, s; then the weight in the integral, s.
    tau: f64,
    seconds: f64,
    t: f64,
    q: Joints,
    qd: Joints,
    qdd: Joints,
}

/// Samples of a stream, an even number of steps on each piece, with the weights of Simpson's rule
/// at the ends and in the middle of pieces.
fn places(stream: &Stream, steps: impl Fn(&Piece) -> usize) -> Vec<Place> {
    let of = |(index, piece): (usize, Piece)| {
        let steps = steps(&piece);
        (0..=steps)
            .map(|i| {
                let tau = piece.length * i as f64 / steps as f64;
                let (q, qd, qdd) = piece.at(tau);
                let weight = match 2 * i {
                    n if n == steps => 4.0 / 6.0,
                    n if n == 0 || n == 2 * steps => 1.0 / 6.0,
                    _ => 0.0,
                };
                let seconds = weight * piece.length;
                Place {
                    piece: index,
                    stretch: STRETCHES * index + stretch(i, steps),
                    tau,
                    seconds,
                    t: piece.start + tau,
                    q,
                    qd,
                    qdd,
                }
            })
            .collect::<Vec<Place>>()
    };
    stream.pieces().enumerate().flat_map(of).collect()
}

/// Derivatives of the quantities at a place by one variable.
struct Column {
    index: usize,
    joint: usize,
    /// Derivatives of the joint angle and velocity.
    w: f64,
    w1: f64,
    torque: Joints,
    path: PathShares,
}

/// The model of the merit around a stream: ½ xᵀ H x + gᵀ x plus the price of exceeded limits.
pub(super) struct Quadratic {
    pub(super) matrix: Banded,
    pub(super) gradient: Vec<f64>,
    /// Rows of the path and torque limits with their price.
    pub(super) shares: Vec<Row>,
    /// Price of the exceeded limits at x = 0.
    pub(super) broken: f64,
}

/// A share of a limit with its derivatives by the variables, as a priced row.
fn share_row(share: f64, weights: impl Iterator<Item = (usize, f64)>) -> Row {
    Row { terms: weights.collect(), bound: 1.0 - ROOM - share, price: VIOLATION_PRICE }
}

/// The largest power of a joint, W.
fn peak_power(stream: &Stream, plant: &impl Plant) -> f64 {
    let power = |place: &Place| {
        let torque = plant.full_torque(&place.q, &place.qd, &place.qdd);
        (0..DOF).map(|j| (torque[j] * place.qd[j]).abs()).fold(0.0, f64::max)
    };
    places(stream, |_| SIMPSON).iter().map(power).fold(0.0, f64::max)
}

/// The largest speed of a joint, rad/s.
fn peak_speed(stream: &Stream) -> f64 {
    stream.max_velocity().into_iter().fold(0.0, f64::max)
}

fn norm(vector: &Joints) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

//! Costs and variables of the cone programs per interval.

use nalgebra::SMatrix;

use super::cone::Affine;
use super::path_energy::{EnergyModel, Sharing};
use crate::retime::motion::stream::DOF;
use crate::retime::motion::timing::grid::PathGrid;

/// Approximation of √b in concave terms.
#[derive(Clone, Copy)]
pub(super) enum Root<'a> {
    /// The convex lower bound.
    Relaxed,
    /// The tangent at this b, an upper bound.
    Tangent(&'a [f64]),
}

/// ∫ √b ds over an interval that starts or ends at rest, per Δs √b at its moving end.
const MEAN_ROOT_FROM_REST: f64 = 2.0 / 3.0;

/// x b₀ + y b₁ + z at the scaled ends of an interval, as \[x, y, z\].
pub(super) type OfEnds = [f64; 3];

/// Costs of one interval in the units of the objective and of the scaled variables.
pub(super) struct IntervalCost {
    /// Vector v with copper loss ‖v‖² / (c₀ + c₁).
    pub(super) copper: Vec<OfEnds>,
    /// The part of the copper loss that is linear in (u, b).
    pub(super) cross: OfEnds,
    /// Factor w of the mean √b.
    pub(super) viscous: f64,
    /// Works of which the negative part is a cost, each with the factor of the mean √b.
    pub(super) brakes: Vec<(OfEnds, f64)>,
    /// Time per d, relative to the given duration.
    pub(super) time: f64,
    /// Base energy per d.
    pub(super) base: f64,
}

/// Units of the scaled variables.
pub(super) struct Scale {
    pub(super) speed: f64,
    pub(super) unit: f64,
    pub(super) duration: f64,
}

impl IntervalCost {
    /// The costs of interval k by the midpoint rule in s.
    pub(super) fn new(
        grid: &PathGrid,
        model: &EnergyModel,
        k: usize,
        scale: &Scale,
    ) -> IntervalCost {
        let [begin, end] = &grid.ends()[k];
        let middle = begin.toward(end, 0.5);
        let delta = grid.delta(k);
        let square = scale.speed * scale.speed;
        // ℓ, Nm, linear in b at both nodes: the two factors and the constant.
        let factors = |j: usize| {
            let (u, b) = (middle.m[j] * 0.5 / delta, 0.5 * middle.c[j]);
            [(b - u) * square, (b + u) * square, middle.g[j] + middle.coulomb[j]]
        };
        let (mut cross, mut viscous) = (OfEnds::default(), 0.0);
        let mut losses = SMatrix::<f64, DOF, 3>::zeros();
        for j in 0..DOF {
            let friction = middle.viscous[j];
            viscous += friction * (model.work * middle.q1[j] + model.loss[j] * friction)
                + model.speed * middle.q1[j] * middle.q1[j];
            if model.loss[j] > 0.0 {
                let per_unit = 2.0 * delta * model.loss[j] / (scale.unit * scale.speed);
                losses.row_mut(j).copy_from_slice(&factors(j).map(|x| x * per_unit.sqrt()));
                let factor = 2.0 * delta * model.loss[j] * friction / scale.unit;
                cross = sum(cross, factors(j).map(|x| x * factor));
            }
        }
        // The losses of all joints depend on two variables: QR reduces them to three terms.
        let copper = if losses.iter().any(|x| *x != 0.0) {
            losses.qr().r().row_iter().map(|row| [row[0], row[1], row[2]]).collect()
        } else {
            Vec::new()
        };
        let lost = (1.0 - model.regeneration) * delta / scale.unit;
        let joint_work = |j: usize| {
            let factor = middle.viscous[j] * middle.q1[j] * scale.speed;
            (factors(j).map(|x| x * lost * middle.q1[j]), lost * factor)
        };
        let mut brakes: Vec<(OfEnds, f64)> = Vec::new();
        if lost > 0.0 {
            let moving = (0..DOF).filter(|j| middle.q1[*j] != 0.0).map(joint_work);
            match model.sharing {
                Sharing::PerJoint => brakes.extend(moving),
                Sharing::Bus => brakes.extend(moving.reduce(|x, y| (sum(x.0, y.0), x.1 + y.1))),
            }
        }
        let seconds = 2.0 * delta / scale.speed;
        IntervalCost {
            copper,
            cross,
            viscous: viscous * delta * scale.speed / scale.unit,
            brakes,
            time: seconds / scale.duration,
            base: model.base_w * seconds / scale.unit,
        }
    }
}

fn sum(x: OfEnds, y: OfEnds) -> OfEnds {
    std::array::from_fn(|i| x[i] + y[i])
}

/// Weights of √b at the nodes of interval k in the mean of √b.
pub(super) fn mean_root(k: usize, n: usize) -> [(usize, f64); 2] {
    let share = if k == 0 || k + 1 == n { MEAN_ROOT_FROM_REST } else { 0.5 };
    [(k, share), (k + 1, share)]
}

/// Indices of the variables: b and c of the inner nodes, then the variables of each interval.
pub(super) struct Layout {
    intervals: usize,
    /// Index of the first variable of each interval; last, the number of variables.
    first: Vec<usize>,
    copper: Vec<bool>,
    root: Vec<bool>,
}

impl Layout {
    pub(super) fn new(costs: &[IntervalCost], root: Root<'_>) -> Layout {
        let relaxed = matches!(root, Root::Relaxed);
        let intervals = costs.len();
        let mut layout = Layout {
            intervals,
            first: vec![2 * (intervals - 1)],
            copper: costs.iter().map(|cost| !cost.copper.is_empty()).collect(),
            root: costs.iter().map(|cost| relaxed && cost.viscous > 0.0).collect(),
        };
        for (k, cost) in costs.iter().enumerate() {
            let own = usize::from(layout.copper[k]) + usize::from(layout.root[k]);
            layout.first.push(layout.first[k] + 1 + own + cost.brakes.len());
        }
        layout
    }

    pub(super) fn variables(&self) -> usize {
        self.first[self.intervals]
    }

    /// b of an inner node.
    pub(super) fn b(&self, node: usize) -> Option<usize> {
        (node > 0 && node < self.intervals).then(|| 2 * (node - 1))
    }

    /// A function of the ends of interval k.
    pub(super) fn affine(&self, k: usize, [x, y, rest]: OfEnds) -> Affine {
        Affine::constant(rest).plus(self.b(k), x).plus(self.b(k + 1), y)
    }

    pub(super) fn c(&self, node: usize) -> Option<usize> {
        self.b(node).map(|b| b + 1)
    }

    pub(super) fn d(&self, k: usize) -> usize {
        self.first[k]
    }

    pub(super) fn copper(&self, k: usize) -> Option<usize> {
        self.copper[k].then(|| self.first[k] + 1)
    }

    pub(super) fn root(&self, k: usize) -> Option<usize> {
        self.root[k].then(|| self.first[k] + 1 + usize::from(self.copper[k]))
    }

    pub(super) fn brake(&self, k: usize, index: usize) -> usize {
        self.first[k] + 1 + usize::from(self.copper[k]) + usize::from(self.root[k]) + index
    }
}

//! Cone programs for the speed profile of least energy on a fixed path.
//!
//! Variables at the nodes: b = ṡ² and c ≤ √b (c² ≤ b); on the intervals: d ≥ 1/(c₀ + c₁), which
//! is the time over 2 Δs, and epigraphs. With τ = ℓ + δ √b, ℓ linear in (u, b) and δ the viscous
//! part, the copper loss on an interval is
//!
//! ∫ k τ² dt = ∫ k ℓ²/√b ds + ∫ 2 k δ ℓ ds + ∫ k δ² √b ds:
//!
//! a rotated cone, a linear term and a concave one. Viscous work is ∫ Σ δ q' √b ds, also concave.
//! All other terms are convex or constant (potential energy, Coulomb work): Verscheure,
//! Demeulenaere, Swevers, De Schutter, Diehl, "Time-optimal path tracking for robots: a convex
//! optimization approach" (2009). The concave terms w √b are treated in two ways:
//!
//! - √b ≤ its tangent at the previous profile: an inner approximation that is exact there.
//! - w √b ≥ w g with g d ≥ 1: viscous work is convex in the time per length. This relaxation is
//!   exact where time is worth more than the friction that it saves. Elsewhere √b ≥ its secant over
//!   the speeds that the time permits.
//!
//! Path length and start duration are scaled to one. Limits are rows at both interval ends, in the
//! relaxation in its middle (second-order accurate for a motion between the nodes). A program
//! contains only rows near their bound and is solved again if others are violated. The variables at
//! the resting ends are eliminated, since the cones have no interior there.

use super::cone::{Affine, ConeProgram, ConeSolution, ConeStatus};
use super::energy_costs::{IntervalCost, Layout, Root, Scale, mean_root};
use super::energy_interior::{EndRow, EnergyProgram};
use super::path_energy::{EnergyModel, evaluate};
use crate::retime::motion::timing::grid::PathGrid;
use crate::retime::motion::timing::limits::{PathLimits, rows};
use crate::retime::motion::timing::profile::Profile;
use crate::retime::motion::timing::row::Row;

/// The solution of a program. The energies leave out the constants of the path.
pub(super) struct Step {
    /// ṡ² at the nodes.
    pub(super) b: Vec<f64>,
    /// The objective, J.
    pub(super) energy: f64,
    /// Dual bound of the program, J.
    pub(super) bound: f64,
    /// Overestimation of the energy of this profile by the tangents, J.
    pub(super) excess: f64,
    /// Energy saving per additional time, W.
    pub(super) marginal: f64,
}

/// Relative margin of the programs to time and limits, so that the residuals of the solver do not
/// violate them.
const MARGIN: f64 = 1e-5;
/// Share of its limit from which a row is in the first program.
const NEAR_AT_FIRST: f64 = 0.6;
/// Share of its limit from which a row is added after a violation of another one.
const NEAR: f64 = 0.85;
/// Largest number of solves with added rows.
const MAX_ROUNDS: usize = 8;
/// Smallest scaled speed of a tangent.
const SLOWEST: f64 = 1e-6;
/// sign · row ≤ 1 at the position `at` (0…1) of an interval.
struct Limit {
    interval: usize,
    at: f64,
    sign: f64,
    row: Row,
    active: bool,
}

/// The programs of one problem with their active rows.
pub(super) struct Programs<'a> {
    grid: &'a PathGrid,
    duration: f64,
    /// ṡ per scaled speed.
    speed: f64,
    /// J per unit of the objective.
    unit: f64,
    costs: Vec<IntervalCost>,
    /// Rows at the ends of the intervals; rows in their middles for the relaxation.
    limits: [Vec<Limit>; 2],
    /// Largest scaled b at each node and whether this bound is active.
    b_max: Vec<(f64, bool)>,
    convex: bool,
    /// Scaled bounds on √b at the nodes, for the relaxation.
    roots: Vec<[f64; 2]>,
}

impl<'a> Programs<'a> {
    /// The programs for profiles of at most `duration` (s); `start` sets the scales and the first
    /// active rows.
    pub(super) fn new(
        grid: &'a PathGrid,
        limits: &PathLimits,
        model: &EnergyModel,
        start: &Profile,
        duration: f64,
    ) -> Programs<'a> {
        let n = grid.intervals();
        let parts = evaluate(grid, start, model);
        let unit = parts.friction.abs() + parts.copper + parts.drive + parts.base + parts.speed;
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let speed = grid.length() / start.duration();
        let scale = Scale { speed, unit, duration };
        let costs: Vec<IntervalCost> =
            (0..n).map(|k| IntervalCost::new(grid, model, k, &scale)).collect();
        let all = [limits_at(grid, limits, &[0.0, 1.0]), limits_at(grid, limits, &[0.5])];
        let concave = costs.iter().any(|cost| cost.viscous > 0.0)
            || all[0].iter().any(|limit| limit.row.root != 0.0);
        let b_max = (0..=n).map(|k| (grid.b_max(k) / (speed * speed), false)).collect();
        let mut programs = Programs {
            grid,
            duration,
            speed,
            unit,
            costs,
            limits: all,
            b_max,
            convex: !concave,
            roots: Vec::new(),
        };
        programs.activate(start.b(), NEAR_AT_FIRST);
        programs
    }

    /// Adds bounds on ṡ² at the nodes that hold for every profile of the duration.
    pub(super) fn within(mut self, range: &[(f64, f64)]) -> Programs<'a> {
        let scaled = |b: f64| b.max(0.0).sqrt() / self.speed;
        self.roots = range.iter().map(|(lo, hi)| [scaled(*lo), scaled(*hi)]).collect();
        self
    }

    /// The secant of √b at a node between its bounds, a lower bound of √b.
    fn secant(&self, layout: &Layout, node: usize) -> Affine {
        match self.roots.get(node) {
            Some([lo, hi]) if lo + hi > 0.0 => {
                let slope = 1.0 / (lo + hi);
                Affine::constant(lo * hi * slope).plus(layout.b(node), slope)
            }
            _ => Affine::constant(0.0),
        }
    }

    /// Whether no term is concave, so that one program with tangents is exact.
    pub(super) fn is_convex(&self) -> bool {
        self.convex
    }

    /// Solves the program and adds rows until none is violated. None if the solver fails.
    pub(super) fn solve(&mut self, root: Root<'_>) -> Option<Step> {
        for _ in 0..MAX_ROUNDS {
            let layout = Layout::new(&self.costs, root);
            let (program, time_row) = self.build(&layout, root);
            let solution = program.solve();
            if matches!(solution.status, ConeStatus::Infeasible | ConeStatus::Failed) {
                return None;
            }
            let step = self.read(&layout, &solution, time_row, root);
            if !self.broken(&step.b, root) {
                return Some(step);
            }
            self.activate(&step.b, NEAR);
        }
        None
    }

    /// Solves the program with the exact √b from the profile `start`, and adds rows until none is violated.
    /// None if the method does not converge.
    pub(super) fn interior(&mut self, start: &[f64]) -> Option<Step> {
        let square = self.speed * self.speed;
        let start: Vec<f64> = start.iter().map(|b| b / square).collect();
        for _ in 0..MAX_ROUNDS {
            let rows = self.end_rows();
            let program = EnergyProgram { costs: &self.costs, rows, most: 1.0 - MARGIN };
            let solution = program.solve(&start)?;
            let b: Vec<f64> = solution.b.iter().map(|b| b * square).collect();
            let tangent = Root::Tangent(&[]);
            if !self.broken(&b, tangent) {
                let energy = solution.cost * self.unit;
                let marginal = solution.time * self.unit / self.duration;
                return Some(Step { b, energy, bound: energy, excess: 0.0, marginal });
            }
            self.activate(&b, NEAR);
        }
        None
    }

    /// The active rows, and the lost braking works as soft rows.
    fn end_rows(&self) -> Vec<EndRow> {
        let n = self.grid.intervals();
        let square = self.speed * self.speed;
        let hard = f64::INFINITY;
        let mut rows = Vec::new();
        for (k, (max, active)) in self.b_max.iter().enumerate().take(n).skip(1) {
            if *active {
                let (linear, constant) = ([1.0 / max, 0.0], -(1.0 - MARGIN));
                rows.push(EndRow { interval: k, linear, root: [0.0; 2], constant, price: hard });
            }
        }
        for limit in self.limits[0].iter().filter(|limit| limit.active) {
            let (k, Row { u, b, root, constant }) = (limit.interval, limit.row);
            let per_u = limit.sign * u * square * 0.5 / self.grid.delta(k);
            let shares = [1.0 - limit.at, limit.at];
            let own = shares.map(|share| share * limit.sign * b * square);
            rows.push(EndRow {
                interval: k,
                linear: [own[0] - per_u, own[1] + per_u],
                root: shares.map(|share| share * limit.sign * root * self.speed),
                constant: limit.sign * constant - (1.0 - MARGIN),
                price: hard,
            });
        }
        for (interval, cost) in self.costs.iter().enumerate() {
            let shares = mean_root(interval, n).map(|(_, share)| share);
            rows.extend(cost.brakes.iter().map(|([x, y, rest], factor)| EndRow {
                interval,
                linear: [-x, -y],
                root: shares.map(|share| -factor * share),
                constant: -rest,
                price: 1.0,
            }));
        }
        rows
    }

    fn read(
        &self,
        layout: &Layout,
        solution: &ConeSolution,
        time_row: usize,
        root: Root<'_>,
    ) -> Step {
        let scaled = |k: usize| layout.b(k).map_or(0.0, |i| solution.x[i].max(0.0));
        let n = self.grid.intervals();
        let b: Vec<f64> = (0..=n).map(|k| scaled(k) * self.speed * self.speed).collect();
        let excess = match root {
            Root::Relaxed => 0.0,
            Root::Tangent(at) => self.excess(&b, at),
        };
        Step {
            b,
            energy: solution.objective * self.unit,
            bound: solution.bound * self.unit,
            excess: excess * self.unit,
            marginal: solution.multipliers[time_row] * self.unit / self.duration,
        }
    }

    /// Σ w (tangent of √b at `at` − √b).
    fn excess(&self, b: &[f64], at: &[f64]) -> f64 {
        let n = self.grid.intervals();
        let above = |node: usize| {
            let (root, tangent) = (b[node].sqrt(), at[node].sqrt());
            if tangent > 0.0 { 0.5 * (root - tangent).powi(2) / tangent / self.speed } else { 0.0 }
        };
        let of = |(k, cost): (usize, &IntervalCost)| {
            mean_root(k, n).map(|(node, share)| cost.viscous * share * above(node))
        };
        self.costs.iter().enumerate().flat_map(of).sum()
    }

    /// Whether the profile b violates an inactive row.
    fn broken(&self, b: &[f64], root: Root<'_>) -> bool {
        let limit = |l: &Limit| !l.active && self.value(l, b) > 1.0;
        let speed = |(k, (max, active)): (usize, &(f64, bool))| {
            !active && b[k] > max * self.speed * self.speed
        };
        self.limits[kind(root)].iter().any(limit) || self.b_max.iter().enumerate().any(speed)
    }

    /// Activates all rows above the share `near` of their limit.
    fn activate(&mut self, b: &[f64], near: f64) {
        for kind in 0..self.limits.len() {
            for i in 0..self.limits[kind].len() {
                let value = self.value(&self.limits[kind][i], b);
                self.limits[kind][i].active |= value > near;
            }
        }
        let square = self.speed * self.speed;
        for ((max, active), b) in self.b_max.iter_mut().zip(b) {
            *active |= *b > near * *max * square;
        }
    }

    fn value(&self, limit: &Limit, b: &[f64]) -> f64 {
        let k = limit.interval;
        let u = (b[k + 1] - b[k]) / (2.0 * self.grid.delta(k));
        limit.sign * limit.row.value(u, b[k] + limit.at * (b[k + 1] - b[k]))
    }

    /// The program and the index of its duration row.
    fn build(&self, layout: &Layout, root: Root<'_>) -> (ConeProgram, usize) {
        let n = self.grid.intervals();
        let mut program = ConeProgram::new(layout.variables());
        let mut time = Affine::constant(-(1.0 - MARGIN));
        for k in 1..n {
            let (b, c) = (Affine::default().plus(layout.b(k), 1.0), layout.c(k));
            let one = Affine::constant(1.0);
            program.rotated_cone(&b, &one, vec![Affine::default().plus(c, 1.0)]);
            let (max, active) = self.b_max[k];
            if active {
                program
                    .at_most_zero(Affine::constant(-(1.0 - MARGIN)).plus(layout.b(k), 1.0 / max));
            }
        }
        for (k, cost) in self.costs.iter().enumerate() {
            let speeds = Affine::default().plus(layout.c(k), 1.0).plus(layout.c(k + 1), 1.0);
            let d = Affine::default().plus(Some(layout.d(k)), 1.0);
            program.rotated_cone(&d, &speeds, vec![Affine::constant(1.0)]);
            time.add(Some(layout.d(k)), cost.time);
            program.minimize(&d.clone().times(cost.base));
            program.minimize(&layout.affine(k, cost.cross));
            if let Some(e) = layout.copper(k) {
                let e = Affine::default().plus(Some(e), 1.0);
                program.minimize(&e);
                let copper = cost.copper.iter().map(|v| layout.affine(k, *v)).collect();
                program.rotated_cone(&e, &speeds, copper);
            }
            if cost.viscous > 0.0 {
                program.minimize(&self.viscous(layout, root, k));
            }
            if let Some(g) = layout.root(k) {
                let g = Affine::default().plus(Some(g), 1.0);
                program.rotated_cone(&g, &d, vec![Affine::constant(1.0)]);
                if !self.roots.is_empty() {
                    let ends = self.secant(layout, k).sum(&self.secant(layout, k + 1));
                    program.at_most_zero(ends.sum(&g.times(-1.0)));
                }
            }
            for (i, (work, factor)) in cost.brakes.iter().enumerate() {
                let lost = Some(layout.brake(k, i));
                program.minimize(&Affine::default().plus(lost, 1.0));
                program.at_most_zero(Affine::default().plus(lost, -1.0));
                let mut row = layout.affine(k, *work).times(-1.0).plus(lost, -1.0);
                for (node, share) in mean_root(k, n) {
                    row.add(layout.c(node), -factor * share);
                }
                program.at_most_zero(row);
            }
        }
        for limit in self.limits[kind(root)].iter().filter(|limit| limit.active) {
            program.at_most_zero(self.limit_row(layout, root, limit));
        }
        let time_row = program.at_most_zero(time);
        (program, time_row)
    }

    /// The cost w · mean √b of interval k.
    fn viscous(&self, layout: &Layout, root: Root<'_>, k: usize) -> Affine {
        let (weight, n) = (self.costs[k].viscous, self.grid.intervals());
        match root {
            Root::Relaxed => {
                // g ≥ c₀ + c₁; both nodes have the same share.
                let [(_, share), _] = mean_root(k, n);
                Affine::default().plus(layout.root(k), weight * share)
            }
            Root::Tangent(at) => {
                let mut cost = Affine::default();
                for (node, share) in mean_root(k, n) {
                    if let Some(index) = layout.b(node) {
                        let b = Affine::default().plus(Some(index), 1.0);
                        cost = cost.sum(&self.tangent(&b, at[node]).times(weight * share));
                    }
                }
                cost
            }
        }
    }

    /// The tangent of √b at b = `at`.
    fn tangent(&self, b: &Affine, at: f64) -> Affine {
        let speed = at.sqrt().max(SLOWEST * self.speed) / self.speed;
        b.clone().times(0.5 / speed).shift(0.5 * speed)
    }

    /// The row of an active limit. Friction that adds to the load takes the upper approximation of
    /// √b, friction that reduces it takes c.
    fn limit_row(&self, layout: &Layout, root: Root<'_>, limit: &Limit) -> Affine {
        let (k, Row { u, b, root: viscous, constant }) = (limit.interval, limit.row);
        let square = self.speed * self.speed;
        let per_u = limit.sign * u * square * 0.5 / self.grid.delta(k);
        let ends = |before: Option<usize>, after: Option<usize>| {
            Affine::default().plus(before, 1.0 - limit.at).plus(after, limit.at)
        };
        let here = ends(layout.b(k), layout.b(k + 1));
        let row = Affine::constant(limit.sign * constant - (1.0 - MARGIN))
            .plus(layout.b(k), -per_u)
            .plus(layout.b(k + 1), per_u)
            .sum(&here.clone().times(limit.sign * b * square));
        let viscous = limit.sign * viscous * self.speed;
        let speed = match root {
            Root::Tangent(at) if viscous > 0.0 && !here.is_constant() => {
                self.tangent(&here, at[k] + limit.at * (at[k + 1] - at[k]))
            }
            _ => ends(layout.c(k), layout.c(k + 1)),
        };
        row.sum(&speed.times(viscous))
    }
}

/// All limits at the given shares of each interval.
fn limits_at(grid: &PathGrid, limits: &PathLimits, shares: &[f64]) -> Vec<Limit> {
    let mut all = Vec::new();
    for (interval, [begin, end]) in grid.ends().iter().enumerate() {
        for at in shares {
            for row in rows(&begin.toward(end, *at), limits) {
                for sign in [1.0, -1.0] {
                    all.push(Limit { interval, at: *at, sign, row, active: false });
                }
            }
        }
    }
    all
}

/// Index in [`Programs::limits`] of the rows for this approximation.
fn kind(root: Root<'_>) -> usize {
    match root {
        Root::Tangent(_) => 0,
        Root::Relaxed => 1,
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::path_energy::Sharing;
    use super::*;
    use crate::retime::motion::stream::{DOF, Joints};
    use crate::retime::motion::timing::grid::PathPoint;
    use crate::retime::motion::timing::reachability::time_optimal;

    const INTERVALS: usize = 120;
    const TANGENTS: usize = 30;
    /// Largest difference of the energies, relative.
    const SAME: f64 = 2e-5;

    fn joints(first: f64, second: f64) -> Joints {
        let mut joints = [0.0; DOF];
        (joints[0], joints[1]) = (first, second);
        joints
    }

    /// Two coupled joints under gravity: q₁ = s, q₂ = 0.8 sin 2s.
    fn grid() -> PathGrid {
        let at = |k: usize| 1.8 * k as f64 / INTERVALS as f64;
        let node = |s: f64| {
            let (q1, q2) =
                (joints(1.0, 1.6 * (2.0 * s).cos()), joints(0.0, -3.2 * (2.0 * s).sin()));
            PathPoint {
                m: joints(14.0 + 2.0 * q1[1], 2.0 + 3.0 * q1[1]),
                c: joints(2.0 * q2[1], 3.0 * q2[1] + 1.5),
                g: joints(70.0 * s.cos(), 12.0 * (3.0 * s).sin()),
                coulomb: joints(9.0, 3.0 * q1[1].signum()),
                viscous: joints(11.0, 4.0 * q1[1]),
                ..PathPoint::kinematic(joints(s, 0.8 * (2.0 * s).sin()), q1, q2, 2.5)
            }
        };
        let s: Vec<f64> = (0..=INTERVALS).map(at).collect();
        let nodes: Vec<PathPoint> = s.iter().map(|s| node(*s)).collect();
        PathGrid::from_nodes(s, &nodes).unwrap()
    }

    /// The energy by cone programs with tangents that converge, J.
    fn by_cones(programs: &mut Programs<'_>, start: &Profile) -> f64 {
        let mut tangent = start.b().to_vec();
        let mut energy = f64::INFINITY;
        for _ in 0..TANGENTS {
            let step = programs.solve(Root::Tangent(&tangent)).unwrap();
            energy = step.energy - step.excess;
            tangent = step.b;
        }
        energy
    }

    #[test]
    fn the_interior_point_method_agrees_with_cone_programs() {
        let grid = grid();
        let limits = PathLimits::new([9.0; DOF], joints(180.0, 60.0).map(|t| t.max(1.0))).unwrap();
        let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
        let models = [
            (Sharing::PerJoint, 0.0, 0.0, 1.0),
            (Sharing::Bus, 0.3, 150.0, 1.0),
            (Sharing::Bus, 1.0, 0.0, 0.0),
        ];
        for (sharing, regeneration, base_w, work) in models {
            let loss = joints(2e-3, 1e-2);
            let model = EnergyModel { work, speed: 0.0, loss, base_w, sharing, regeneration };
            for factor in [1.001, 1.1, 1.6] {
                let time = factor * fastest.duration();
                let start = fastest.scaled_to(time).unwrap();
                let new = || Programs::new(&grid, &limits, &model, &start, time);
                let interior = new().interior(start.b()).unwrap();
                let cones = by_cones(&mut new(), &start);
                let ratio = interior.energy / cones;
                assert!((ratio - 1.0).abs() < SAME, "{model:?} {factor}: {ratio}");
            }
        }
    }
}

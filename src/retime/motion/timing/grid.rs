//! A path and its dynamics as numbers on a grid.
//!
//! On a path q(s) with ṡ² = b and s̈ = u, joint j has q̇ = q' √b, q̈ = q' u + q'' b and the torque
//!
//! τ = m u + c b + g + fᶜ sgn(q') + fᵛ q' √b,
//!
//! m = M q', c = RNEA(q, q', q'') − g: Bobrow, Dubowsky, Gibson (1985); Verscheure et al. (2009).

use super::row::Row;
use crate::retime::motion::stream::Joints;

/// Fewest intervals of a path from rest to rest: on one interval the speed stays 0.
pub const MIN_INTERVALS: usize = 2;

/// Largest number of TCP acceleration rows of a point.
pub const TCP_ROWS: usize = 5;

/// Error in the values of a path grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// The numbers of nodes and intervals do not match, or are too small.
    #[error(
        "a path grid with {nodes} nodes has {intervals} intervals; give at least {MIN_INTERVALS} \
         and one node more"
    )]
    Lengths {
        /// Number of nodes.
        nodes: usize,
        /// Number of intervals.
        intervals: usize,
    },
    /// The path coordinate does not rise.
    #[error("the path coordinate does not rise at node {node}; merge nodes that coincide")]
    NotRising {
        /// Index of the node.
        node: usize,
    },
    /// A coefficient that is not finite, or a speed bound that is not positive and finite.
    #[error(
        "interval {interval} of a path grid has a value that is not finite or a speed bound that \
         is not positive"
    )]
    Value {
        /// Index of the interval.
        interval: usize,
    },
}

/// The path and the dynamics at one point, on one side of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathPoint {
    /// Joint positions, rad.
    pub q: Joints,
    /// dq/ds, rad per unit of s.
    pub q1: Joints,
    /// d²q/ds², rad per unit of s squared.
    pub q2: Joints,
    /// Torque per s̈, Nm.
    pub m: Joints,
    /// Torque per ṡ², Nm.
    pub c: Joints,
    /// Gravity torque, Nm.
    pub g: Joints,
    /// Coulomb friction `f_C` sgn(q'), Nm, with the sign of this side.
    pub coulomb: Joints,
    /// Viscous friction per ṡ, `f_v` q', Nm.
    pub viscous: Joints,
    /// Acceleration capability of each joint at this pose, in units of its limit.
    pub capability: Joints,
    /// Share of the acceleration limit that gravity takes at rest.
    pub bias: Joints,
    /// Limits on the TCP acceleration; unused rows are zero.
    pub tcp_rows: [Row; TCP_ROWS],
    /// Bound on ṡ from joint and TCP speeds; positive and finite.
    pub v_max: f64,
    /// Source of that bound.
    pub v_bound: SpeedBound,
}

/// Source of a speed bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum SpeedBound {
    /// None.
    #[default]
    None,
    /// The programmed speed of the TCP.
    Programmed,
    /// The programmed speed of reorientation.
    Reorientation,
    /// The largest speed of a joint.
    Joint,
    /// The TCP speed limit of the robot.
    Robot,
    /// A zone that takes at least one step of the interpolator.
    Zone,
}

impl PathPoint {
    /// A point without dynamics: zero torques and uniform acceleration limits.
    pub fn kinematic(q: Joints, q1: Joints, q2: Joints, v_max: f64) -> PathPoint {
        PathPoint { q, q1, q2, v_max, capability: [1.0; 6], ..PathPoint::default() }
    }

    /// m u + c b + g: the torque without friction, Nm.
    pub fn rigid_torque(&self, u: f64, b: f64) -> Joints {
        std::array::from_fn(|j| self.m[j] * u + self.c[j] * b + self.g[j])
    }

    /// The torque of friction at the path speed `v`, Nm.
    pub fn friction_torque(&self, v: f64) -> Joints {
        std::array::from_fn(|j| self.coulomb[j] + self.viscous[j] * v)
    }

    /// Linear interpolation to `other` at the share `x`.
    pub(crate) fn toward(&self, other: &PathPoint, x: f64) -> PathPoint {
        let mix = |from: &Joints, to: &Joints| -> Joints {
            std::array::from_fn(|j| from[j] + x * (to[j] - from[j]))
        };
        PathPoint {
            q: mix(&self.q, &other.q),
            q1: mix(&self.q1, &other.q1),
            q2: mix(&self.q2, &other.q2),
            m: mix(&self.m, &other.m),
            c: mix(&self.c, &other.c),
            g: mix(&self.g, &other.g),
            coulomb: mix(&self.coulomb, &other.coulomb),
            viscous: mix(&self.viscous, &other.viscous),
            capability: mix(&self.capability, &other.capability),
            bias: mix(&self.bias, &other.bias),
            tcp_rows: std::array::from_fn(|i| self.tcp_rows[i].toward(&other.tcp_rows[i], x)),
            v_max: self.v_max + x * (other.v_max - self.v_max),
            v_bound: self.v_bound,
        }
    }

    fn is_valid(&self) -> bool {
        let PathPoint { q, q1, q2, m, c, g, coulomb, viscous, capability, bias, v_max, .. } = self;
        let lists = [q, q1, q2, m, c, g, coulomb, viscous, capability, bias];
        *v_max > 0.0 && lists.into_iter().flatten().chain([v_max]).all(|x| x.is_finite())
    }
}

/// A path from rest to rest on nodes s₀ < … < sₙ. Each interval has its own values at both ends,
/// since q'' jumps between segments and sgn(q') at a reversal.
#[derive(Clone, Debug, PartialEq)]
pub struct PathGrid {
    s: Vec<f64>,
    ends: Vec<[PathPoint; 2]>,
}

impl PathGrid {
    /// The grid with the nodes `s` (N + 1, any unit) and the values at both ends of N intervals.
    ///
    /// # Errors
    /// Lengths that do not match, s that does not rise, values that are not finite.
    pub fn new(s: Vec<f64>, ends: Vec<[PathPoint; 2]>) -> Result<PathGrid, GridError> {
        if ends.len() < MIN_INTERVALS || s.len() != ends.len() + 1 {
            return Err(GridError::Lengths { nodes: s.len(), intervals: ends.len() });
        }
        if let Some(k) = s.windows(2).position(|w| !(w[1] - w[0] > 0.0 && w[1].is_finite())) {
            return Err(GridError::NotRising { node: k + 1 });
        }
        let valid = |pair: &[PathPoint; 2]| pair.iter().all(PathPoint::is_valid);
        if let Some(interval) = ends.iter().position(|pair| !valid(pair)) {
            return Err(GridError::Value { interval });
        }
        Ok(PathGrid { s, ends })
    }

    /// The grid of a path without jumps: one value per node.
    ///
    /// # Errors
    /// As [`PathGrid::new`].
    pub fn from_nodes(s: Vec<f64>, nodes: &[PathPoint]) -> Result<PathGrid, GridError> {
        if s.len() != nodes.len() {
            let intervals = nodes.len().saturating_sub(1);
            return Err(GridError::Lengths { nodes: s.len(), intervals });
        }
        PathGrid::new(s, nodes.windows(2).map(|w| [w[0], w[1]]).collect())
    }

    /// The same path with each bound on ṡ extended to both sides by `distance` plus the distance
    /// of `time` (s) at that bound, so that a profile smoothed over time keeps the bounds.
    pub(crate) fn holding(&self, time: f64, distance: f64) -> PathGrid {
        let bounds: Vec<(f64, f64, f64)> = self
            .ends
            .iter()
            .zip(self.s.windows(2))
            .flat_map(|(pair, s)| [(s[0], pair[0].v_max), (s[1], pair[1].v_max)])
            .map(|(s, v)| (s, v, if v.is_finite() { v * time + distance } else { 0.0 }))
            .collect();
        let mut held = self.clone();
        for (k, pair) in held.ends.iter_mut().enumerate() {
            for (end, s) in pair.iter_mut().zip(&self.s[k..k + 2]) {
                // Slightly more: with round numbers a node may lie exactly at the reach.
                let near = bounds.iter().filter(|(at, _, reach)| (at - s).abs() <= reach * 1.001);
                end.v_max = near.map(|(_, v, _)| *v).fold(end.v_max, f64::min);
            }
        }
        held
    }

    /// The same path with other Coulomb friction: `change` takes the index of an interval and its
    /// ends and returns the friction at both ends.
    pub(crate) fn with_dry_friction(
        mut self,
        mut change: impl FnMut(usize, &[PathPoint; 2]) -> [Joints; 2],
    ) -> PathGrid {
        for (k, pair) in self.ends.iter_mut().enumerate() {
            let [begin, end] = change(k, pair);
            (pair[0].coulomb, pair[1].coulomb) = (begin, end);
        }
        self
    }

    /// The same path with the path speed on each interval capped at a positive number.
    #[must_use]
    pub fn capped(&self, v_max: impl Fn(usize) -> f64) -> PathGrid {
        let mut capped = self.clone();
        for (k, pair) in capped.ends.iter_mut().enumerate() {
            for point in pair {
                point.v_max = point.v_max.min(v_max(k));
            }
        }
        capped
    }

    /// The nodes s₀ … `s_N`.
    pub fn s(&self) -> &[f64] {
        &self.s
    }

    /// The values at both ends of each interval.
    pub fn ends(&self) -> &[[PathPoint; 2]] {
        &self.ends
    }

    /// Number N of intervals.
    pub fn intervals(&self) -> usize {
        self.ends.len()
    }

    /// `s_N` − s₀.
    pub fn length(&self) -> f64 {
        self.s[self.s.len() - 1] - self.s[0]
    }

    /// Length of interval k.
    pub fn delta(&self, k: usize) -> f64 {
        self.s[k + 1] - self.s[k]
    }

    /// Largest ṡ² at a node under the bounds of both sides.
    pub fn b_max(&self, node: usize) -> f64 {
        let after = self.ends.get(node).map_or(f64::INFINITY, |pair| pair[0].v_max);
        let before = if node == 0 { f64::INFINITY } else { self.ends[node - 1][1].v_max };
        after.min(before).powi(2)
    }
}

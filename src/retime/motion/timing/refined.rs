//! The fastest profile with its limits kept between the nodes of the grid, too.
//!
//! Rows at both ends of an interval say nothing of what lies between: near a singularity or where
//! a path bends, the coefficients are not linear in s. Intervals in which a profile breaks a limit
//! are halved until none does; so are those in which a finer grid would be faster.

use super::grid::{GridError, PathGrid};
use super::limits::{PathLimits, rows};
use super::profile::Profile;
use super::reachability::{Reachability, time_optimal};

/// A profile, its grid, and what it does between the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// The grid after refinement.
    pub grid: PathGrid,
    /// The limits that the profile was made for: those given, or a little less.
    pub limits: PathLimits,
    /// The fastest profile on it.
    pub profile: Profile,
    /// The largest share of a limit that it uses between nodes.
    pub between: f64,
}

/// How the search ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Refinement {
    /// No limit is exceeded by more than [`BETWEEN`] anywhere.
    Held(Box<Refined>),
    /// The best found; some limit is exceeded between nodes.
    Exceeded(Box<Refined>),
    /// No profile keeps the limits; about where on the path the way back from the end broke off.
    Infeasible {
        /// The path coordinate.
        s: f64,
    },
}

impl Refinement {
    /// The profile, if the limits hold everywhere.
    pub fn held(self) -> Option<Refined> {
        match self {
            Refinement::Held(refined) => Some(*refined),
            Refinement::Exceeded(_) | Refinement::Infeasible { .. } => None,
        }
    }
}

/// Accepted excess over a limit between nodes, share of it.
pub const BETWEEN: f64 = 1e-3;
/// Excess that is looked for at a few places, so that none between those exceeds [`BETWEEN`].
const LOOKED_FOR: f64 = 0.4 * BETWEEN;
/// Share of the time that halving all intervals may still gain. The error falls at least with the
/// length of the intervals, so that no grid gains more than twice this.
const GAIN: f64 = 1e-3;
/// Where in an interval the limits are looked at.
const PROBES: [f64; 6] = [0.06, 0.25, 0.42, 0.58, 0.75, 0.94];
/// Times that intervals are halved.
const HALVINGS: usize = 9;
/// Times that all limits are lowered where halving did not help.
const LOWERINGS: usize = 4;
/// Most intervals, times those at first.
const GROWTH: usize = 12;

/// The fastest profile from rest to rest on a path that `grid_at` samples at any nodes, which
/// begins with `nodes` and halves the intervals in which a limit is exceeded or time is lost.
///
/// # Errors
/// What `grid_at` refuses.
pub fn time_optimal_between(
    mut nodes: Vec<f64>,
    limits: &PathLimits,
    mut grid_at: impl FnMut(&[f64]) -> Result<PathGrid, GridError>,
) -> Result<Refinement, GridError> {
    let most = GROWTH * nodes.len();
    let mut used = *limits;
    let mut lowerings = 0;
    let mut halvings = 0;
    loop {
        let grid = grid_at(&nodes)?;
        let profile = match time_optimal(&grid, &used) {
            Reachability::Optimal(profile) => profile,
            Reachability::Infeasible { interval } => {
                return Ok(Refinement::Infeasible { s: nodes[interval] });
            }
        };
        let shares = shares_between(&grid, limits, &profile, &mut grid_at)?;
        let between = shares.iter().copied().fold(0.0, f64::max);
        let held = between <= 1.0 + LOOKED_FOR;
        let more = halvings < HALVINGS && nodes.len() < most;
        halvings += 1;
        if !held && more {
            nodes = halved(&nodes, |k| shares[k] > 1.0 + LOOKED_FOR);
            continue;
        }
        if held && more {
            let gains = gains(&profile, &used, &mut grid_at)?;
            let total: f64 = gains.iter().sum();
            if total > GAIN * profile.duration() {
                let share = 0.5 * total / gains.len() as f64;
                nodes = halved(&nodes, |k| gains[k] > share);
                continue;
            }
        }
        let refined = Refined { grid, limits: used, profile, between };
        if held {
            return Ok(Refinement::Held(Box::new(refined)));
        }
        if lowerings < LOWERINGS {
            lowerings += 1;
            used = used.scaled(1.0 / between);
        } else if between <= 1.0 + BETWEEN {
            return Ok(Refinement::Held(Box::new(refined)));
        } else {
            return Ok(Refinement::Exceeded(Box::new(refined)));
        }
    }
}

/// The largest share of a limit that the profile uses inside each interval.
fn shares_between(
    grid: &PathGrid,
    limits: &PathLimits,
    profile: &Profile,
    grid_at: &mut impl FnMut(&[f64]) -> Result<PathGrid, GridError>,
) -> Result<Vec<f64>, GridError> {
    let s = grid.s();
    let mut probes = Vec::with_capacity(s.len() * (PROBES.len() + 1));
    for (k, begin) in s[..grid.intervals()].iter().enumerate() {
        probes.push(*begin);
        probes.extend(PROBES.map(|share| begin + share * grid.delta(k)));
    }
    probes.push(s[s.len() - 1]);
    let fine = grid_at(&probes)?;
    let stride = PROBES.len() + 1;
    let share = |k: usize| {
        let b = [profile.b()[k], profile.b()[k + 1]];
        let u = (b[1] - b[0]) / (2.0 * grid.delta(k));
        let mut worst = 0.0_f64;
        for (i, share) in PROBES.iter().enumerate() {
            let b = b[0] + share * (b[1] - b[0]);
            // The interval before this probe ends here.
            let point = &fine.ends()[k * stride + i][1];
            worst = worst.max(b.sqrt() / point.v_max);
            for row in rows(point, limits) {
                worst = worst.max(row.value(u, b).abs());
            }
        }
        worst
    };
    Ok((0..grid.intervals()).map(share).collect())
}

/// The time that each interval would gain on a grid of halved intervals, s; 0 where that has no
/// profile.
fn gains(
    profile: &Profile,
    limits: &PathLimits,
    grid_at: &mut impl FnMut(&[f64]) -> Result<PathGrid, GridError>,
) -> Result<Vec<f64>, GridError> {
    let fine = grid_at(&halved(profile.s(), |_| true))?;
    let finer = time_optimal(&fine, limits).into_profile();
    let took = |times: &[f64], from: usize, to: usize| times[to] - times[from];
    let gain = |k: usize| {
        let now = took(profile.times(), k, k + 1);
        finer.as_ref().map_or(0.0, |finer| now - took(finer.times(), 2 * k, 2 * k + 2))
    };
    Ok((0..profile.s().len() - 1).map(gain).collect())
}

/// The nodes with the middles of some intervals and of their neighbours.
fn halved(nodes: &[f64], chosen: impl Fn(usize) -> bool) -> Vec<f64> {
    let intervals = nodes.len().saturating_sub(1);
    let mut out = Vec::with_capacity(2 * nodes.len());
    for (k, pair) in nodes.windows(2).enumerate() {
        out.push(pair[0]);
        let near = k.saturating_sub(1)..(k + 2).min(intervals);
        if near.into_iter().any(&chosen) {
            out.push(0.5 * (pair[0] + pair[1]));
        }
    }
    out.extend(nodes.last());
    out
}

//! Standing still: what a pose costs, and where nearby it costs least.
//!
//! Paes et al. 2014, table 3 and figure 7. The search looks at every combination
//! of a few positions of each joint, then descends by a compass search; holding
//! power is cheap to evaluate and has several minima.

use super::idle::break_even_s;
use crate::dynamics::Load;
use crate::energy::power::holding_w;
use crate::kinematics::limits_ok;
use crate::path::joint_path::{DOF, Joints};
use crate::robot::Model;

/// Positions of each joint at which the search starts, as shares of the distance;
/// staying comes first, so that it wins among equals.
const SHARES: [f64; 3] = [0.0, -1.0, 1.0];
/// The search ends at steps below this share of the distance.
const FINEST: f64 = 1e-4;
/// A pose is better by at least this much \[W\].
const BETTER: f64 = 1e-6;

/// A robot at rest.
#[derive(Clone, Debug)]
pub struct Standing {
    /// Where, rad.
    pub q: Joints,
    /// Holding power by joint, W.
    pub per_joint_w: Joints,
    /// From which length of a dwell on closing the brakes pays, s; `None` where
    /// nothing is to be held or no brake is known.
    pub break_even_s: Option<f64>,
    /// The pose of least holding power nearby, rad.
    pub best: Joints,
    /// Its holding power, W.
    pub best_w: f64,
}

impl Standing {
    /// Holding power, W.
    pub fn holding_w(&self) -> f64 {
        self.per_joint_w.iter().sum()
    }
}

/// A loaded robot at rest at `q`, and the best pose inside the position limits that
/// no joint is more than `distance` \[rad\] away from.
pub fn standing(model: &Model, load: &Load, q: &Joints, distance: f64) -> Standing {
    let per_joint_w = holding_w(model, load, q);
    let best = best_nearby(model, load, q, distance);
    Standing {
        q: *q,
        per_joint_w,
        break_even_s: break_even_s(model, per_joint_w.iter().sum()),
        best,
        best_w: total(model, load, &best),
    }
}

fn total(model: &Model, load: &Load, q: &Joints) -> f64 {
    holding_w(model, load, q).iter().sum()
}

fn best_nearby(model: &Model, load: &Load, q: &Joints, distance: f64) -> Joints {
    let mut best = (*q, total(model, load, q));
    let consider = |at: Joints, best: &mut (Joints, f64)| {
        let power = total(model, load, &at);
        let better = power < best.1 - BETTER && limits_ok(model, &at).is_ok();
        if better {
            *best = (at, power);
        }
        better
    };
    for combination in 1..SHARES.len().pow(DOF as u32) {
        let mut rest = combination;
        let at = q.map(|angle| {
            let share = SHARES[rest % SHARES.len()];
            rest /= SHARES.len();
            angle + share * distance
        });
        consider(at, &mut best);
    }
    let mut step = 0.5 * distance;
    while step > FINEST * distance {
        let mut moved = false;
        for joint in 0..DOF {
            for sense in [-step, step] {
                let mut at = best.0;
                at[joint] = (at[joint] + sense).clamp(q[joint] - distance, q[joint] + distance);
                moved |= consider(at, &mut best);
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    // Joints that need not have moved go back.
    for joint in 0..DOF {
        let mut at = best.0;
        at[joint] = q[joint];
        if total(model, load, &at) <= best.1 + BETTER && limits_ok(model, &at).is_ok() {
            best.0 = at;
        }
    }
    best.0
}

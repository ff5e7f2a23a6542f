//! Holding power of a pose and the nearby pose of least holding power.
//!
//! Paes et al. 2014, table 3 and figure 7. Holding power has several minima: the search samples
//! the whole box and its corners and descends from the best samples (R. Hooke, T. A. Jeeves,
//! "Direct search solution of numerical and statistical problems", J. ACM 8, 1961).

use crate::arm::dynamics::Load;
use crate::arm::effects::drawn;
use crate::arm::kinematics::{limits_ok, radical_inverse};
use crate::arm::robot::Model;
use crate::retime::energy::brakes::break_even_s;
use crate::retime::energy::plausible::{Contribution, Interval, Robots};
use crate::retime::energy::power::holding_w;
use crate::retime::path::joint_path::{DOF, Joints};

/// Start positions of each joint, as shares of the distance; 0 comes first, so that it is chosen
/// among equals.
const SHARES: [f64; 3] = [0.0, -1.0, 1.0];
/// Further start poses, spread evenly over the box.
const SPREAD: u32 = 1024;
/// Bases of the quasi-random spread, one per joint.
const BASES: [u32; DOF] = [2, 3, 5, 7, 11, 13];
/// Number of descents.
const STARTS: usize = 32;
/// Smallest step, as a share of the distance.
const FINEST: f64 = 1e-4;
/// Smallest improvement, W.
const BETTER: f64 = 1e-6;

/// A robot at rest.
#[derive(Clone, Debug)]
pub struct Standing {
    /// Joint angles, rad.
    pub q: Joints,
    /// Holding power per joint, W.
    pub per_joint_w: Joints,
    /// Break-even time of the brakes, s; `None` if nothing is saved or no brake is known.
    pub break_even_s: Option<f64>,
    /// The nearby pose of least holding power, rad.
    pub best: Joints,
    /// Its holding power, W.
    pub best_w: f64,
    /// Intervals over plausible robots.
    pub plausible: Option<Range>,
}

/// Intervals of a standing robot over plausible robots.
#[derive(Clone, Debug)]
pub struct Range {
    /// Holding power \[W\].
    pub holding_w: Interval,
    /// Break-even time \[s\]; `None` if brakes save nothing for some robot.
    pub break_even_s: Option<Interval>,
    /// Contributions to the variance of that time, or of the holding power if there is none.
    pub contributions: Vec<Contribution>,
}

/// Draws of plausible robots for a model.
pub struct Plausible {
    robots: Robots,
    models: Vec<Model>,
}

impl Plausible {
    /// The draws; `None` if all parameters are known or an effect makes a draw invalid.
    pub fn new(model: &Model) -> Option<Plausible> {
        let robots = Robots::new(model)?;
        let models: Result<Vec<Model>, _> =
            robots.drawn_robots().iter().map(|robot| drawn(model, robot)).collect();
        Some(Plausible { robots, models: models.ok()? })
    }

    fn range(&self, load: &Load, q: &Joints) -> Range {
        let holding: Vec<f64> = self.models.iter().map(|robot| total(robot, load, q)).collect();
        let times = self.models.iter().zip(&holding).map(|(robot, w)| break_even_s(robot, *w));
        let times: Option<Vec<f64>> = times.collect();
        Range {
            holding_w: Interval::from_values(&holding),
            contributions: self.robots.contributions(times.as_ref().unwrap_or(&holding)),
            break_even_s: times.map(|times| Interval::from_values(&times)),
        }
    }
}

impl Standing {
    /// Holding power, W.
    pub fn holding_w(&self) -> f64 {
        self.per_joint_w.iter().sum()
    }
}

/// A loaded robot at rest at `q`, and the best pose within the position limits and within
/// `distance` \[rad\] in each joint; with intervals over plausible robots if given.
pub fn standing(
    model: &Model,
    plausible: Option<&Plausible>,
    load: &Load,
    q: &Joints,
    distance: f64,
) -> Standing {
    let per_joint_w = holding_w(model, load, q);
    let best = best_nearby(model, load, q, distance);
    Standing {
        q: *q,
        per_joint_w,
        break_even_s: break_even_s(model, per_joint_w.iter().sum()),
        best,
        best_w: total(model, load, &best),
        plausible: plausible.map(|plausible| plausible.range(load, q)),
    }
}

fn total(model: &Model, load: &Load, q: &Joints) -> f64 {
    holding_w(model, load, q).iter().sum()
}

/// The search box: each joint within `distance` \[rad\] of `from` and within its range.
struct Search<'a> {
    model: &'a Model,
    load: &'a Load,
    from: &'a Joints,
    distance: f64,
}

impl Search<'_> {
    fn power(&self, at: &Joints) -> f64 {
        total(self.model, self.load, at)
    }

    /// The pose with each joint, from the base on, clamped into the box.
    fn inside(&self, mut at: Joints) -> Joints {
        for joint in 0..DOF {
            let [low, high] = self.model.limits.position_at(&at, joint);
            let [least, most] = [-1.0, 1.0].map(|sign| self.from[joint] + sign * self.distance);
            at[joint] = at[joint].max(low.max(least)).min(high.min(most));
        }
        at
    }

    /// Poses over the whole box, sorted by power, without equal powers.
    fn starts(&self) -> Vec<(Joints, f64)> {
        let grid = (0..SHARES.len().pow(DOF as u32)).map(|combination| {
            let mut rest = combination;
            self.from.map(|angle| {
                let share = SHARES[rest % SHARES.len()];
                rest /= SHARES.len();
                angle + share * self.distance
            })
        });
        let spread = (1..=SPREAD).map(|n| {
            std::array::from_fn(|joint| {
                let share = 2.0 * radical_inverse(n, BASES[joint]) - 1.0;
                self.from[joint] + share * self.distance
            })
        });
        let mut starts: Vec<(Joints, f64)> = grid
            .chain(spread)
            .map(|at| self.inside(at))
            .filter(|at| limits_ok(self.model, at).is_ok())
            .map(|at| (at, self.power(&at)))
            .collect();
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        // Poses of equal power differ only in unloaded axes.
        starts.dedup_by(|later, kept| later.1 - kept.1 < BETTER);
        starts.truncate(STARTS);
        starts
    }

    /// Exploratory moves: each joint by a step to either side, if that lowers the power.
    fn explored(&self, from: (Joints, f64), step: f64) -> (Joints, f64) {
        let mut best = from;
        for joint in 0..DOF {
            for change in [-step, step] {
                let mut at = best.0;
                at[joint] += change;
                self.consider(at, &mut best);
            }
        }
        best
    }

    fn consider(&self, at: Joints, best: &mut (Joints, f64)) {
        let at = self.inside(at);
        let power = self.power(&at);
        if power < best.1 - BETTER && limits_ok(self.model, &at).is_ok() {
            *best = (at, power);
        }
    }

    /// The local minimum reached from a start.
    fn descended(&self, start: (Joints, f64)) -> (Joints, f64) {
        let mut best = start;
        let mut step = 0.25 * self.distance;
        while step > FINEST * self.distance {
            let found = self.explored(best, step);
            if found.1 >= best.1 {
                step *= 0.5;
                continue;
            }
            // Pattern moves while they lower the power.
            let (mut before, mut here) = (best, found);
            while here.1 < before.1 {
                let ahead = std::array::from_fn(|j| 2.0 * here.0[j] - before.0[j]);
                let mut next = here;
                self.consider(ahead, &mut next);
                (before, here) = (here, next);
            }
            best = here;
        }
        best
    }
}

fn best_nearby(model: &Model, load: &Load, q: &Joints, distance: f64) -> Joints {
    let search = Search { model, load, from: q, distance };
    let mut best = (*q, search.power(q));
    if distance <= 0.0 {
        return best.0;
    }
    for start in search.starts() {
        let found = search.descended(start);
        if found.1 < best.1 - BETTER {
            best = found;
        }
    }
    // Joints without an effect on the power return to their start.
    for joint in 0..DOF {
        let mut at = best.0;
        at[joint] = q[joint];
        if search.power(&at) <= best.1 + BETTER && limits_ok(model, &at).is_ok() {
            best.0 = at;
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;
    use crate::arm::robot::find;

    /// Largest improvement that further descents may find \[W\].
    const MISSED_W: f64 = 0.01;

    #[test]
    fn descents_from_many_other_poses_find_nothing_better() {
        let model = find("IRB1600-10/1.45").unwrap();
        let load = Load { mass: 8.0, com: [0.05, 0.03, 0.2].into(), ..Load::none() };
        let spread = |n: u32, low: &Joints, high: &Joints| -> Joints {
            std::array::from_fn(|j| low[j] + radical_inverse(n, BASES[j]) * (high[j] - low[j]))
        };
        let range = |end: usize| std::array::from_fn(|j| model.limits.position[j][end]);
        for n in 1..=12 {
            let q = spread(n, &range(0), &range(1));
            let distance = 60.0_f64.to_radians();
            let best = standing(&model, None, &load, &q, distance).best_w;
            let search = Search { model: &model, load: &load, from: &q, distance };
            let [low, high] = [-distance, distance].map(|by| q.map(|angle| angle + by));
            for other in SPREAD + 1..=SPREAD + 200 {
                let at = search.inside(spread(other, &low, &high));
                let found = search.descended((at, search.power(&at))).1;
                assert!(best < found + MISSED_W, "pose {n}: {best} {found}");
            }
        }
    }
}

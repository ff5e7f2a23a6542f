//! Searches among the offers of a lever.

use super::lever::{Offer, Shift, Visits};
use crate::tool::retrofit::Simulated;

/// How often the step of a shift is halved.
const HALVINGS: usize = 2;
/// Most steps of one size.
const STEPS: usize = 6;

/// An offer with its cycle.
pub(super) type Tried = (Offer, Simulated);

/// The best shift of a point by a pattern search along its axes (R. Hooke, T. Jeeves, J. ACM 8, 1961).
/// `least`: energy without a shift, J; `after`: an offer with its cycle, if that is possible.
pub(super) fn shifted(
    shift: &Shift,
    mut least: f64,
    after: &dyn Fn(Offer) -> Option<Tried>,
) -> Option<Tried> {
    let mut at = vec![0.0; shift.values.len()];
    let mut best = None;
    let mut step = shift.step;
    for _ in 0..=HALVINGS {
        for _ in 0..STEPS {
            let start = least;
            for axis in 0..at.len() {
                for by in [step, -step] {
                    let mut next = at.clone();
                    next[axis] += by;
                    if next[axis].abs() > shift.most {
                        continue;
                    }
                    let Some((offer, cycle)) = after(shift.offer(&next)) else { continue };
                    let energy = cycle.account.total.energy_j();
                    if energy < least {
                        (least, at, best) = (energy, next, Some((offer, cycle)));
                        break;
                    }
                }
            }
            if least >= start {
                break;
            }
        }
        step *= 0.5;
    }
    best
}

/// The best order of visits: from today's order on, the best reversal of a part or move of a visit, until
/// none is better (2-opt and or-opt: S. Lin, Bell System Technical Journal 44, 1965).
/// `least`: energy of today's order, J.
pub(super) fn ordered(
    visits: &Visits,
    mut least: f64,
    after: &dyn Fn(Offer) -> Option<Tried>,
) -> Option<Tried> {
    let count = visits.spans.len();
    let mut order: Vec<usize> = (0..count).collect();
    let mut best = None;
    for _ in 0..count {
        let mut next: Option<(Vec<usize>, Tried)> = None;
        for changed in neighbours(&order) {
            let Some(tried) = after(visits.offer(&changed)) else { continue };
            let energy = tried.1.account.total.energy_j();
            if energy < least {
                (least, next) = (energy, Some((changed, tried)));
            }
        }
        let Some((changed, tried)) = next else { break };
        (order, best) = (changed, Some(tried));
    }
    best
}

/// The orders that one step makes, each once.
fn neighbours(order: &[usize]) -> Vec<Vec<usize>> {
    let mut all = Vec::new();
    for from in 0..order.len() {
        for to in 0..order.len() {
            let mut moved = order.to_vec();
            let visit = moved.remove(from);
            moved.insert(to, visit);
            all.push(moved);
            if from < to {
                let mut reversed = order.to_vec();
                reversed[from..=to].reverse();
                all.push(reversed);
            }
        }
    }
    all.sort_unstable();
    all.dedup();
    all.retain(|other| other != order);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_step_moves_a_visit_or_reverses_a_part() {
        let of_three = neighbours(&[0, 1, 2]);
        assert_eq!(of_three.len(), 5, "all other orders: {of_three:?}");
        let of_five = neighbours(&[0, 1, 2, 3, 4]);
        assert!(of_five.contains(&vec![0, 3, 2, 1, 4]) && of_five.contains(&vec![1, 2, 3, 4, 0]));
        assert!(!of_five.contains(&vec![0, 1, 2, 3, 4]));
    }
}

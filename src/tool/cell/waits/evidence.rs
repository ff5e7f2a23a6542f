//! How well a hypothesis predicts when what a wait is for comes.
//!
//! With A the time at which the robot came, E that at which the wait ended and S a reference before A,
//! every hypothesis is one number b: r = (E − S) − b (A − S) does not depend on A. The machine that counts
//! from S has b = 0; one that answers the robot has b = 1, where r = E − A for every S; between them arriving
//! later delays the machine in part. Each visit's r is predicted from the visits of the cycles around it that
//! took the same way: what drifts over a shift, or differs by way, tells nothing.

use std::collections::BTreeSet;

use super::density::{Known, log_density, trend, width};
use super::samples::{Candidate, Samples};
use super::shift::Shift;
use super::spread::median;
use crate::tool::cell::events::Cycle;

/// Cycles of the same way to each side from which a visit is predicted.
const REACH: usize = 24;
/// Most visits from which one is predicted, and most visits that are predicted.
const MAX_OTHERS: usize = 64;
const MAX_VISITS: usize = 1500;
/// Fewest cycles of a way that tell something.
const MIN_OF_WAY: usize = 6;
/// Cycles at the start of a session that may differ from the others.
const FIRST: usize = 1;

/// ln of a density for each visit, NaN where it has none.
pub(super) type LogDensities = Vec<f64>;

/// What predicts the visits of a wait.
pub(super) struct Evidence<'a> {
    samples: &'a Samples,
    /// For each visit, those from which it is predicted, and by how many cycles they are later; empty
    /// where it is not predicted.
    others: Vec<Vec<(usize, f64)>>,
    /// Visits in order of way and cycle, to see how much successive ones differ.
    by_way: Vec<usize>,
    /// Median time of a cycle, s.
    cycle_s: f64,
    /// Step of the clock, s.
    step_s: f64,
    /// Number of cycles with predicted visits.
    pub(super) cycles: usize,
}

impl<'a> Evidence<'a> {
    pub(super) fn new(shift: &Shift, samples: &'a Samples) -> Evidence<'a> {
        let visits = &samples.samples;
        // Position of each cycle among those of its way.
        let mut counts = vec![0; shift.frequencies().len()];
        let mut first_of = vec![0; shift.offsets.len()];
        let mut positions = Vec::new();
        for (index, cycle) in shift.cycles.iter().enumerate() {
            first_of[cycle.session] += 1;
            let is_first = first_of[cycle.session] <= FIRST;
            let way = shift.ways[index];
            positions.push((!is_first).then_some((way, counts[way])));
            counts[way] += usize::from(!is_first);
        }
        let mut by_way: Vec<usize> =
            (0..visits.len()).filter(|i| positions[visits[*i].cycle].is_some()).collect();
        by_way.sort_by_key(|i| (positions[visits[*i].cycle], visits[*i].occurrence));
        let step = by_way.len().div_ceil(MAX_VISITS).max(1);
        let mut others = vec![Vec::new(); visits.len()];
        let mut cycles = BTreeSet::new();
        for (at, index) in by_way.iter().enumerate() {
            let Some((way, position)) = positions[visits[*index].cycle] else { continue };
            if position % step != 0 || counts[way] < MIN_OF_WAY {
                continue;
            }
            let near = |other: &&usize| {
                let of = positions[visits[**other].cycle];
                of.is_some_and(|(w, p)| w == way && p.abs_diff(position) <= REACH)
            };
            let back = by_way[..at].iter().rev().take_while(near).count();
            let ahead = by_way[at..].iter().take_while(near).count();
            let near: Vec<(usize, f64)> = by_way[at - back..at + ahead]
                .iter()
                .filter(|other| visits[**other].cycle != visits[*index].cycle)
                .map(|other| {
                    let of = positions[visits[*other].cycle].map_or(position, |(_, of)| of);
                    (*other, of as f64 - position as f64)
                })
                .collect();
            let stride = near.len().div_ceil(MAX_OTHERS).max(1);
            others[*index] = near.into_iter().step_by(stride).collect();
            cycles.insert(visits[*index].cycle);
        }
        let cycle_s = median(shift.cycles.iter().map(Cycle::duration));
        Evidence { samples, others, by_way, cycle_s, step_s: shift.step_s, cycles: cycles.len() }
    }

    /// The machine answers the robot.
    pub(super) fn answers(&self) -> LogDensities {
        let came: Vec<Option<f64>> =
            self.samples.samples.iter().map(|sample| Some(sample.came)).collect();
        self.log_densities(&came, 1.0)
    }

    /// The machine counts from a reference, and arriving later delays it by the share `b`.
    pub(super) fn counts_from(&self, candidate: &Candidate, b: f64) -> LogDensities {
        self.log_densities(&candidate.times, b)
    }

    fn log_densities(&self, from: &[Option<f64>], b: f64) -> LogDensities {
        let visits = &self.samples.samples;
        // What is known of r, and what is known of it if signals are not recorded: hypotheses are
        // compared by the latter.
        let known: Vec<Option<[Known; 2]>> = visits
            .iter()
            .zip(from)
            .map(|(visit, from)| {
                let from = (*from)?;
                let travel = visit.came - from;
                let r = |end: f64| Known::Exact(end - from - b * travel);
                let ended = r(visit.came + visit.length);
                let Known::Exact(at_most) = ended else { return None };
                if !visit.at_once() {
                    return Some([ended; 2]);
                }
                let at_most = Known::AtMost(at_most);
                let heard = visit.heard.filter(|heard| *heard > from && b < 1.0);
                Some([heard.map_or(at_most, r), at_most])
            })
            .collect();
        let exact = self.by_way.iter().filter_map(|index| match known[*index]?[0] {
            Known::Exact(r) => Some(r),
            Known::AtMost(_) => None,
        });
        let width = width(exact, 2 * REACH, self.step_s);
        let mut near = Vec::new();
        (0..visits.len())
            .map(|index| {
                let Some([_, r]) = known[index] else { return f64::NAN };
                let others = self.others[index].iter();
                let times: Vec<(f64, Known)> = others
                    .filter_map(|(other, position)| Some((*position, known[*other]?[0])))
                    .collect();
                if times.len() < MIN_OF_WAY - 1 {
                    return f64::NAN;
                }
                let trend = trend(&times);
                near.clear();
                near.extend(times.iter().map(|(position, r)| r.later(-trend * position)));
                log_density(r, &mut near, width, self.cycle_s)
            })
            .collect()
    }

    /// ln of how much better one hypothesis predicts than another, over the visits that both predict;
    /// no cycle counts more than `most`.
    pub(super) fn advantage(&self, of: &[f64], over: &[f64], most: f64) -> f64 {
        let mut sum = 0.0;
        let mut of_cycle = 0.0;
        let mut current = usize::MAX;
        for ((a, b), visit) in of.iter().zip(over).zip(&self.samples.samples) {
            if visit.cycle != current {
                sum += f64::clamp(of_cycle, -most, most);
                of_cycle = 0.0;
                current = visit.cycle;
            }
            let difference = a - b;
            if difference.is_finite() {
                of_cycle += difference;
            }
        }
        sum + f64::clamp(of_cycle, -most, most)
    }
}

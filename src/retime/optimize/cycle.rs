//! Distribution of the cycle time among the runs for least total energy.
//!
//! Each run has a convex trade-off of energy over time; at the optimum the slopes of all runs are
//! equal. Where a signal comes at a known time, a slower run before it replaces the wait. With
//! piecewise linear trade-offs the whole is one linear program for each way to spend the rest of the
//! takt; the cheapest of their solutions is the optimum.

use super::cone::{Affine, ConeProgram, ConeStatus};
use super::convex_curve::EnergyCurve;
use super::resting::{Resting, cheapest};

/// A part of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// A run, by the index of its trade-off.
    Run(usize),
    /// A fixed time, s.
    Fixed(f64),
    /// A wait for a signal.
    Arrival {
        /// The delay starts at the end of this part; `None`: at the start of the cycle.
        since: Option<usize>,
        /// s.
        delay: f64,
        /// Smallest duration of the wait, s: a reserve for late runs.
        least: f64,
        /// Power at standstill, W.
        holding_w: f64,
    },
}

/// Energy unit of the linear program, J.
const UNIT: f64 = 10.0;
/// Rounding tolerance as a share of the takt.
const ROUNDING: f64 = 1e-9;

/// A cycle of runs, fixed times and waits.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// The parts in order.
    pub parts: Vec<Part>,
    /// Longest duration of the cycle, s.
    pub takt: f64,
    /// The ways to spend the rest of the takt; standing, which has no shortest time, is the first.
    pub resting: Vec<Resting>,
}

impl Cycle {
    /// The duration of each run (s) for least total energy. `None` if the takt is too short.
    pub fn share(&self, curves: &[EnergyCurve]) -> Option<Vec<f64>> {
        let plans = self.resting.iter().filter_map(|way| self.share_before(way, curves));
        plans.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(times, _)| times)
    }

    /// The duration of each run (s) for least total energy if the rest of the takt is spent in this
    /// way, and that energy in units. `None` if no time is left for it.
    fn share_before(&self, way: &Resting, curves: &[EnergyCurve]) -> Option<(Vec<f64>, f64)> {
        let arrivals =
            self.parts.iter().filter(|part| matches!(part, Part::Arrival { .. })).count();
        let runs = curves.len();
        let (time, energy) = (|run: usize| Some(run), |run: usize| Some(runs + run));
        let wait = |index: usize| Some(2 * runs + index);
        let mut program = ConeProgram::new(2 * runs + arrivals);

        // The time at the end of each part.
        let mut ends: Vec<Affine> = Vec::with_capacity(self.parts.len());
        let mut now = Affine::constant(0.0);
        let mut arrival = 0;
        for part in &self.parts {
            match part {
                Part::Run(run) => {
                    now.add(time(*run), 1.0);
                    program.minimize(&Affine::constant(0.0).plus(energy(*run), 1.0));
                }
                Part::Fixed(seconds) => now = now.shift(*seconds),
                Part::Arrival { since, delay, least, holding_w } => {
                    let from = since.map_or(Affine::constant(0.0), |part| ends[part].clone());
                    let late = from.shift(*delay).sum(&now.clone().times(-1.0));
                    // wait ≥ rest of the delay, wait ≥ least
                    program.at_most_zero(late.plus(wait(arrival), -1.0));
                    program.at_most_zero(Affine::constant(*least).plus(wait(arrival), -1.0));
                    let holding = Affine::constant(0.0).plus(wait(arrival), holding_w / UNIT);
                    program.minimize(&holding);
                    now.add(wait(arrival), 1.0);
                    arrival += 1;
                }
            }
            ends.push(now.clone());
        }
        let spare = now.clone().times(-1.0).shift(self.takt - way.least_s);
        program.minimize(&spare.times(way.power_w / UNIT).shift(way.energy_j / UNIT));
        program.at_most_zero(now.shift(way.least_s - self.takt * (1.0 + ROUNDING)));
        for (run, curve) in curves.iter().enumerate() {
            let (shortest, longest) = curve.range();
            program.at_most_zero(Affine::constant(shortest).plus(time(run), -1.0));
            program.at_most_zero(Affine::constant(-longest).plus(time(run), 1.0));
            for (slope, offset) in curve.lines() {
                let line = Affine::constant(offset / UNIT).plus(time(run), slope / UNIT);
                program.at_most_zero(line.plus(energy(run), -1.0));
            }
        }
        let solution = program.solve();
        match solution.status {
            ConeStatus::Solved | ConeStatus::AlmostSolved => {
                let within = |(t, curve): (&f64, &EnergyCurve)| {
                    let (shortest, longest) = curve.range();
                    t.clamp(shortest, longest)
                };
                let times = solution.x.iter().zip(curves).map(within).collect();
                Some((times, solution.objective))
            }
            ConeStatus::Infeasible | ConeStatus::Failed => None,
        }
    }

    /// The end of each part, s, if the runs take `times` (s).
    fn ends(&self, times: &[f64]) -> Vec<f64> {
        let mut ends: Vec<f64> = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            ends.push(ends.last().copied().unwrap_or(0.0) + part_time(part, times, &ends));
        }
        ends
    }

    /// Duration of the cycle without the rest of the takt, s, if its runs take `times` (s).
    pub fn time(&self, times: &[f64]) -> f64 {
        self.ends(times).last().copied().unwrap_or(0.0)
    }

    /// Energy of the runs and of all standstills up to the takt, J, if the runs take `times` (s)
    /// and `energies` (J).
    pub fn energy(&self, times: &[f64], energies: &[f64]) -> f64 {
        let ends = self.ends(times);
        let energy = self.parts.iter().enumerate().fold(0.0, |energy, (i, part)| {
            energy
                + match part {
                    Part::Run(run) => energies[*run],
                    Part::Fixed(_) => 0.0,
                    Part::Arrival { holding_w, .. } => {
                        holding_w * part_time(part, times, &ends[..i])
                    }
                }
        });
        energy + cheapest(&self.resting, self.takt - self.time(times)).1
    }
}

/// Duration of a part, s, if the parts before it end at `ends` (s).
fn part_time(part: &Part, times: &[f64], ends: &[f64]) -> f64 {
    match part {
        Part::Run(run) => times[*run],
        Part::Fixed(seconds) => *seconds,
        Part::Arrival { since, delay, least, .. } => {
            let now = ends.last().copied().unwrap_or(0.0);
            (since.map_or(0.0, |part| ends[part]) + delay - now).max(*least)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::retime::optimize::resting::{IdleState, ways};

    const TOLERANCE: f64 = 1e-3;

    /// Spacing of the points of the parabola, s, with a reserve.
    const BOWL: f64 = 0.11;

    fn cycle(parts: &[Part], takt: f64) -> Cycle {
        Cycle { parts: parts.to_vec(), takt, resting: ways(0.0, &[], 0.0) }
    }

    /// a / t: short durations cost more.
    fn curve(a: f64) -> EnergyCurve {
        let times = (0..=400).map(|i| 1.0 + 0.01 * f64::from(i));
        EnergyCurve::new(times.map(|t| (t, a / t)).collect()).expect("points")
    }

    #[test]
    fn one_more_second_saves_the_same_everywhere() {
        let curves = [curve(100.0), curve(400.0)];
        let cycle = cycle(&[Part::Run(0), Part::Fixed(2.0), Part::Run(1)], 8.0);
        let times = cycle.share(&curves).expect("possible");
        // a / t² is equal for both, so t is proportional to √a.
        assert!((times[0] - 2.0).abs() < 0.02 && (times[1] - 4.0).abs() < 0.02, "{times:?}");
        assert!((cycle.time(&times) - 8.0).abs() < TOLERANCE);
    }

    #[test]
    fn a_known_wait_is_used_up() {
        let curves = [curve(100.0), curve(100.0)];
        let wait = Part::Arrival { since: None, delay: 3.0, least: 0.0, holding_w: 1.0 };
        let waiting = cycle(&[Part::Run(0), wait, Part::Run(1)], 4.5);
        let times = waiting.share(&curves).expect("possible");
        assert!(
            (times[0] - 3.0).abs() < TOLERANCE && (times[1] - 1.5).abs() < TOLERANCE,
            "{times:?}"
        );
        assert!((waiting.time(&times) - 4.5).abs() < TOLERANCE);
        // Faster runs wait for the signal: two seconds at 1 W.
        let energy = waiting.energy(&[1.0, 1.0], &[7.0, 5.0]);
        assert!((energy - (7.0 + 5.0 + 2.0)).abs() < TOLERANCE, "{energy}");
        // The second signal is timed from the first one, so only the second run must wait for it.
        let again = Part::Arrival { since: Some(1), delay: 2.5, least: 0.0, holding_w: 1.0 };
        let twice = cycle(&[Part::Run(0), wait, Part::Run(1), again], 5.5);
        let times = twice.share(&curves).expect("possible");
        assert!(
            (times[0] - 3.0).abs() < TOLERANCE && (times[1] - 2.5).abs() < TOLERANCE,
            "{times:?}"
        );
    }

    #[test]
    fn a_reserve_of_a_wait_is_left() {
        let wait = Part::Arrival { since: None, delay: 3.0, least: 0.4, holding_w: 1.0 };
        let waiting = cycle(&[Part::Run(0), wait], 3.0);
        let times = waiting.share(&[curve(100.0)]).expect("possible");
        assert!((times[0] - 2.6).abs() < TOLERANCE, "{times:?}");
        assert!((waiting.time(&times) - 3.0).abs() < TOLERANCE);
    }

    #[test]
    fn the_rest_of_the_takt_is_paid_for() {
        let parts = [Part::Run(0)];
        let free = cycle(&parts, 4.0);
        // Beyond 2 s a slower run needs more energy.
        let bowl = EnergyCurve::new(
            (10..=50).map(f64::from).map(|t| (t / 10.0, (t / 10.0 - 2.0).powi(2))).collect(),
        );
        let bowl = [bowl.expect("points")];
        let times = free.share(&bowl).expect("possible");
        assert!((times[0] - 2.0).abs() < BOWL, "{times:?}");
        // Standstill takes 2 W, so the run is slowed to the time at which its slope is 2 W.
        let paid = Cycle { resting: ways(2.0, &[], 0.0), ..free };
        let times = paid.share(&bowl).expect("possible");
        assert!((times[0] - 3.0).abs() < BOWL, "{times:?}");
        assert!((paid.energy(&[3.0], &[1.0]) - 3.0).abs() < TOLERANCE);
    }

    #[test]
    fn a_takt_below_the_possible_has_no_answer() {
        assert_eq!(cycle(&[Part::Run(0), Part::Fixed(1.0)], 1.9).share(&[curve(1.0)]), None);
    }

    /// All times on a grid, with the energy of the rest written out.
    #[test]
    fn idle_states_are_used_where_a_search_over_all_times_uses_them() {
        let state =
            |power_w, wake_s, wake_j| IdleState { name: String::new(), power_w, wake_s, wake_j };
        let curves = [curve(100.0), curve(400.0)];
        let wait = Part::Arrival { since: None, delay: 2.5, least: 0.0, holding_w: 30.0 };
        let parts = [Part::Run(0), wait, Part::Run(1), Part::Fixed(0.5)];
        let standing_w = 60.0;
        let mut used = Vec::new();
        for states in [
            vec![],
            vec![state(5.0, 3.0, 10.0)],
            vec![state(30.0, 0.5, 0.0), state(2.0, 3.0, 60.0)],
            vec![state(0.0, 50.0, 0.0)],
        ] {
            for takt in [5.0, 7.0, 9.5, 13.0, 20.0] {
                let resting = ways(standing_w, &states, 0.0);
                let cycle = Cycle { parts: parts.to_vec(), takt, resting };
                let whole = |a: f64, b: f64| {
                    let waited = (2.5 - a).max(0.0);
                    let rest = takt - (a + waited + b + 0.5);
                    if rest < 0.0 {
                        return f64::INFINITY;
                    }
                    let of_state = |s: &IdleState| {
                        let asleep = s.power_w * (rest - s.wake_s);
                        let energy = asleep + standing_w * s.wake_s + s.wake_j;
                        if rest < s.wake_s { f64::INFINITY } else { energy }
                    };
                    let idle = states.iter().map(of_state).fold(standing_w * rest, f64::min);
                    100.0 / a + 400.0 / b + 30.0 * waited + idle
                };
                let grid = || (0..=200).map(|i| 1.0 + 0.02 * f64::from(i));
                let all = grid().flat_map(|a| grid().map(move |b| (a, b)));
                let least = all.map(|(a, b)| whole(a, b)).fold(f64::INFINITY, f64::min);
                let times = cycle.share(&curves).expect("possible");
                let found = whole(times[0].min(5.0), times[1] - 1e-6);
                assert!((found - least).abs() < 0.1, "{takt} s: {found} J, {least} J, {times:?}");
                let energies = [100.0 / times[0], 400.0 / times[1]];
                assert!((cycle.energy(&times, &energies) - found).abs() < 0.1);
                used.push(cheapest(&cycle.resting, takt - cycle.time(&times)).0);
            }
        }
        // Slower travel is worth more than a short sleep, and one state takes too long to wake up.
        assert_eq!(used[..5], [0; 5]);
        assert_eq!(used[5..10], [0, 0, 0, 0, 1]);
        assert!(used[10..15].contains(&1) && used[10..15].contains(&2), "{used:?}");
        assert_eq!(used[15..], [0; 5]);
    }
}

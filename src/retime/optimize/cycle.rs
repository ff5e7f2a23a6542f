//! Distribution of the cycle time among the runs for least total energy.
//!
//! Each run has a convex trade-off of energy over time; at the optimum the slopes of all runs are
//! equal. Where a signal comes at a known time, a slower run before it replaces the wait. With
//! piecewise linear trade-offs the whole is one linear program.

use super::cone::{Affine, ConeProgram, ConeStatus};

/// Energy of a run over its duration: points (s, J) with rising time on a convex curve.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyCurve {
    points: Vec<(f64, f64)>,
}

/// Energy of a run at one duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// s.
    pub time: f64,
    /// J.
    pub energy: f64,
    /// dE/dt, W.
    pub slope: f64,
}

impl Known {
    /// Energy at another time (s), J, if the slope falls with a power of the time.
    fn law(&self, power: i32, time: f64) -> f64 {
        let fall = 1.0 - (self.time / time).powi(power - 1);
        self.energy + self.slope * self.time / f64::from(power - 1) * fall
    }
}

/// Curve points per interval between known times.
const REFINEMENT: usize = 12;
/// Exponent with which the slope falls over time. Measured on the runs of `fixtures/pick_place`:
/// 3.6 to 4.6 for longer times than the original, 4 to 7.6 for shorter ones.
const LONGER: i32 = 4;
const SHORTER: i32 = 6;

impl EnergyCurve {
    /// The curve from the shortest to the longest time (s) through known points of rising time.
    /// `None` without a finite point.
    pub fn through(known: &[Known], (shortest, longest): (f64, f64)) -> Option<EnergyCurve> {
        let (first, last) = (*known.first()?, *known.last()?);
        let between = |from: f64, to: f64, energy: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
            let time = |i: usize| from + (to - from) * i as f64 / REFINEMENT as f64;
            (0..=REFINEMENT).map(|i| (time(i), energy(time(i)))).collect()
        };
        let quicker = between(shortest.min(first.time), first.time, &|t| first.law(SHORTER, t));
        let slower = between(last.time, longest.max(last.time), &|t| last.law(LONGER, t));
        let inside = known.windows(2).flat_map(|pair| {
            between(pair[0].time, pair[1].time, &|t| hermite(pair[0], pair[1], t))
        });
        EnergyCurve::new(quicker.into_iter().chain(inside).chain(slower).collect())
    }

    /// The lower convex hull of points (s, J); `None` without a finite point.
    pub fn new(mut points: Vec<(f64, f64)>) -> Option<EnergyCurve> {
        points.retain(|(t, e)| t.is_finite() && e.is_finite());
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        points.dedup_by(|later, earlier| later.0 == earlier.0);
        let mut hull: Vec<(f64, f64)> = Vec::with_capacity(points.len());
        for point in points {
            while let [.., a, b] = hull.as_slice()
                && slope(*a, *b) >= slope(*b, point)
            {
                hull.pop();
            }
            hull.push(point);
        }
        (!hull.is_empty()).then_some(EnergyCurve { points: hull })
    }

    /// Shortest and longest time, s.
    pub fn range(&self) -> (f64, f64) {
        (self.points[0].0, self.points[self.points.len() - 1].0)
    }

    /// The curve as a maximum of lines: slope (W) and energy at time 0 (J) of each.
    fn lines(&self) -> Vec<(f64, f64)> {
        match self.points.as_slice() {
            [(_, energy)] => vec![(0.0, *energy)],
            points => points
                .windows(2)
                .map(|pair| (slope(pair[0], pair[1]), pair))
                .map(|(slope, pair)| (slope, pair[0].1 - slope * pair[0].0))
                .collect(),
        }
    }
}

/// Cubic Hermite interpolation between two known points, J.
fn hermite(a: Known, b: Known, time: f64) -> f64 {
    let h = b.time - a.time;
    let x = (time - a.time) / h;
    let (v0, v1) = (h * a.slope, h * b.slope);
    let step = b.energy - a.energy;
    let cubic = v0 + v1 - 2.0 * step;
    a.energy + x * (v0 + x * (step - v0 - cubic + x * cubic))
}

fn slope(a: (f64, f64), b: (f64, f64)) -> f64 {
    (b.1 - a.1) / (b.0 - a.0)
}

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
    /// Power at standstill for the rest of the takt, W.
    pub resting_w: f64,
}

impl Cycle {
    /// The duration of each run (s) for least total energy. `None` if the takt is too short.
    pub fn share(&self, curves: &[EnergyCurve]) -> Option<Vec<f64>> {
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
        program.minimize(&now.clone().times(-self.resting_w / UNIT));
        program.at_most_zero(now.shift(-self.takt * (1.0 + ROUNDING)));
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
                Some(solution.x.iter().zip(curves).map(within).collect())
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
        energy + self.resting_w * (self.takt - self.time(times)).max(0.0)
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

    const TOLERANCE: f64 = 1e-3;

    /// Spacing of the points of the parabola, s, with a reserve.
    const BOWL: f64 = 0.11;

    fn cycle(parts: &[Part], takt: f64) -> Cycle {
        Cycle { parts: parts.to_vec(), takt, resting_w: 0.0 }
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
    fn a_few_known_times_make_a_close_curve() {
        // The slope falls with the fourth power of the time.
        let energy = |t: f64| 90.0 / t.powi(3);
        let known = |t: f64| Known { time: t, energy: energy(t), slope: -270.0 / t.powi(4) };
        let worst = |times: &[f64]| {
            let known: Vec<Known> = times.iter().map(|t| known(*t)).collect();
            let curve = EnergyCurve::through(&known, (0.9, 2.0)).expect("points");
            assert_eq!(curve.range(), (0.9, 2.0));
            let errors = curve.points.iter().map(|(t, e)| (e - energy(*t)).abs() / energy(*t));
            errors.fold(0.0, f64::max)
        };
        // Before the first point the assumed exponent is larger than this one.
        assert!(worst(&[1.0, 1.4, 2.0]) < 0.05, "{}", worst(&[1.0, 1.4, 2.0]));
        assert!(worst(&[0.9, 1.0, 1.2, 1.4, 1.7, 2.0]) < 2e-3);
        // One point is enough if the exponent is right.
        assert!(worst(&[0.9]) < 1e-9);
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
        let free = Cycle { resting_w: 0.0, ..cycle(&parts, 4.0) };
        // Beyond 2 s a slower run needs more energy.
        let bowl = EnergyCurve::new(
            (10..=50).map(f64::from).map(|t| (t / 10.0, (t / 10.0 - 2.0).powi(2))).collect(),
        );
        let bowl = [bowl.expect("points")];
        let times = free.share(&bowl).expect("possible");
        assert!((times[0] - 2.0).abs() < BOWL, "{times:?}");
        // Standstill takes 2 W, so the run is slowed to the time at which its slope is 2 W.
        let paid = Cycle { resting_w: 2.0, ..free };
        let times = paid.share(&bowl).expect("possible");
        assert!((times[0] - 3.0).abs() < BOWL, "{times:?}");
        assert!((paid.energy(&[3.0], &[1.0]) - 3.0).abs() < TOLERANCE);
    }

    #[test]
    fn a_takt_below_the_possible_has_no_answer() {
        assert_eq!(cycle(&[Part::Run(0), Part::Fixed(1.0)], 1.9).share(&[curve(1.0)]), None);
    }

    #[test]
    fn only_the_convex_hull_counts() {
        let curve = EnergyCurve::new(vec![(1.0, 4.0), (2.0, 5.0), (3.0, 0.0), (2.5, 3.0)]);
        assert_eq!(curve, Some(EnergyCurve { points: vec![(1.0, 4.0), (3.0, 0.0)] }));
        assert_eq!(EnergyCurve::new(vec![(f64::NAN, 1.0)]), None);
    }
}

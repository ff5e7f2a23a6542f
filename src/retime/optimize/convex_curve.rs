//! Energy of a run over its duration as a convex, piecewise linear curve.

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

    /// Energy in a time (s), J; beyond the range as at its end.
    pub fn energy(&self, time: f64) -> f64 {
        let (shortest, longest) = self.range();
        let time = time.clamp(shortest, longest);
        let lines = self.lines().into_iter().map(|(slope, offset)| offset + slope * time);
        lines.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The curve without times below `shortest` (s), but for the longest.
    #[must_use]
    pub fn not_faster(&self, shortest: f64) -> EnergyCurve {
        let shortest = shortest.min(self.range().1);
        if shortest <= self.range().0 {
            return self.clone();
        }
        let later = self.points.iter().copied().filter(|(t, _)| *t > shortest);
        let points = std::iter::once((shortest, self.energy(shortest))).chain(later).collect();
        EnergyCurve { points }
    }

    /// The largest convex curve below every convex function through points of rising time, up to
    /// `longest` (s): between two points such a function is above the lines through the points on
    /// either side. `None` without a finite point.
    pub fn below(points: &[(f64, f64)], longest: f64) -> Option<EnergyCurve> {
        let line = |i: usize| {
            let pair = points.get(i..i + 2)?;
            let slope = slope(pair[0], pair[1]);
            Some((slope, pair[0].1 - slope * pair[0].0))
        };
        let at = |line: Option<(f64, f64)>, t: f64| {
            line.map_or(f64::NEG_INFINITY, |(slope, offset)| offset + slope * t)
        };
        let mut low: Vec<(f64, f64)> = Vec::new();
        for (i, pair) in points.windows(2).enumerate() {
            let lines = [i.checked_sub(1).and_then(line), line(i + 1)];
            let crossing = lines[0].zip(lines[1]).map(|(a, b)| (b.1 - a.1) / (a.0 - b.0));
            let inside = crossing.filter(|t| (pair[0].0..=pair[1].0).contains(t));
            for t in [Some(pair[0].0), inside, Some(pair[1].0)].into_iter().flatten() {
                let energy = at(lines[0], t).max(at(lines[1], t));
                low.push((t, energy.min(at(line(i), t))));
            }
        }
        let last = points.len().checked_sub(2).and_then(line);
        low.extend(points.last());
        low.push((longest, at(last, longest)));
        EnergyCurve::new(low)
    }

    /// The curve as a maximum of lines: slope (W) and energy at time 0 (J) of each.
    pub(super) fn lines(&self) -> Vec<(f64, f64)> {
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn only_the_convex_hull_counts() {
        let curve = EnergyCurve::new(vec![(1.0, 4.0), (2.0, 5.0), (3.0, 0.0), (2.5, 3.0)]);
        assert_eq!(curve, Some(EnergyCurve { points: vec![(1.0, 4.0), (3.0, 0.0)] }));
        assert_eq!(EnergyCurve::new(vec![(f64::NAN, 1.0)]), None);
    }

    #[test]
    fn a_curve_below_convex_functions_has_no_point_above_them() {
        let exact = |t: f64| 90.0 / t.powi(3) + 2.0 * t;
        let points: Vec<(f64, f64)> = [1.0, 1.03, 1.1, 1.2, 1.32, 1.46, 1.62, 1.8, 2.0, 2.3, 2.6]
            .map(|t| (t, exact(t)))
            .to_vec();
        let below = EnergyCurve::below(&points, 4.0).expect("points");
        assert_eq!(below.range(), (1.0, 4.0));
        let mut widest: f64 = 0.0;
        for i in 0..=300 {
            let t = 1.0 + 0.01 * f64::from(i);
            let gap = exact(t) - below.energy(t);
            assert!(gap > -1e-9, "{gap} J at {t} s");
            if t < 2.0 {
                widest = widest.max(gap / exact(t));
            }
        }
        assert!(widest < 0.05, "{widest}");
        let slower = below.not_faster(1.33);
        assert_eq!(slower.range(), (1.33, 4.0));
        for t in [1.33, 1.5, 3.0] {
            assert!((slower.energy(t) - below.energy(t)).abs() < 1e-9);
        }
    }
}

//! The power at rest: the level of the windows in which the power stays the same. It is what waiting
//! costs, and it shows whether the meter has changed between the sides.

use std::ops::Range;

use super::series::Series;

/// Length of a window, s, and its least number of rows.
const WINDOW_S: f64 = 0.4;
const ROWS: usize = 4;
/// A window is quiet if it varies at most this much more than the quietest ones do.
const QUIET: f64 = 2.0;
const QUIETEST: f64 = 0.15;
/// What windows at rest are allowed, in their usual deviations.
const NOISE: f64 = 3.0;
/// Half width of the level, as a share.
pub(super) const BAND: f64 = 0.05;
/// Least share of all windows that are at the level.
const SEEN: f64 = 0.03;
/// Least time at the level, in windows.
const WINDOWS: usize = 5;
/// The floor of the power is this quantile of the quiet windows. A meter with another gain changes it as much
/// as the power at rest; this share of that at least, because both are noisy.
const FLOOR: f64 = 0.05;
const CONFIRMED: f64 = 0.5;
/// Least number of still windows of a cycle.
const STILL: usize = 8;

/// The power of a window; one begins at each row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// First row.
    row: usize,
    /// Number of rows.
    rows: usize,
    /// W.
    mean: f64,
    /// W.
    sd: f64,
}

/// The windows of a log.
pub(super) fn windows(series: &Series) -> Vec<Window> {
    let (t, power) = (&series.t, &series.power);
    let rows = ((WINDOW_S / series.step).round() as usize).max(ROWS);
    let longest = 1.5 * rows as f64 * series.step;
    let part = |(row, part): (usize, &[f64])| {
        let mean = part.iter().sum::<f64>() / rows as f64;
        let squares: f64 = part.iter().map(|x| (x - mean).powi(2)).sum();
        Window { row, rows, mean, sd: (squares / rows as f64).sqrt() }
    };
    let whole = |window: &Window| t[window.row + rows - 1] - t[window.row] < longest;
    power.windows(rows).enumerate().map(part).filter(whole).collect()
}

/// A level with the windows that belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// W.
    pub(super) power_w: f64,
    /// Largest deviation within a window, W.
    sd: f64,
    /// Largest distance of a window's mean, W.
    band: f64,
    /// Lowest power that lasts on this side, W.
    pub(super) floor_w: f64,
}

impl Level {
    /// The level at rest; `None` if the robot never rests, or not to be seen.
    pub(super) fn of(windows: &[Window]) -> Option<Level> {
        let rows = windows.first()?.rows;
        let mean = windows.iter().map(|w| w.mean).sum::<f64>() / windows.len() as f64;
        let mut deviations: Vec<f64> = windows.iter().map(|w| w.sd).collect();
        let least = quantile(&mut deviations, QUIETEST)?;
        let quiet = QUIET * least + 1e-3 * mean.abs();
        // Motion at constant speed is quiet, too, but takes more than the mean.
        let is_quiet = |w: &&Window| w.sd <= quiet && w.mean < mean && w.mean > 0.0;
        let mut means: Vec<f64> = windows.iter().filter(is_quiet).map(|w| w.mean).collect();
        let floor_w = quantile(&mut means, FLOOR)?;
        let mode = mode(&means)?;
        means.retain(|mean| (mean - mode).abs() <= BAND * mode);
        let power_w = quantile(&mut means, 0.5)?;
        // How much windows vary at rest: the quietest of all depend on how long the robot rests.
        let at_rest = |w: &&Window| is_quiet(w) && (w.mean - power_w).abs() <= BAND * power_w;
        let mut deviations: Vec<f64> = windows.iter().filter(at_rest).map(|w| w.sd).collect();
        let noise = NOISE * quantile(&mut deviations, 0.5)?;
        let band = BAND * power_w + noise / (rows as f64).sqrt();
        let level = Level { power_w, sd: noise + 1e-3 * mean.abs(), band, floor_w };
        let count = windows.iter().filter(|w| level.has(w)).count();
        (count >= WINDOWS * rows && count as f64 >= SEEN * windows.len() as f64).then_some(level)
    }

    /// The levels by which time at rest is counted: one for both sides if theirs are nearly the same, each its
    /// own if the floor of the power says that the meter has changed, else the lower one for both: what the
    /// other side has is slow motion.
    pub(super) fn common(levels: [Level; 2]) -> [Level; 2] {
        let [a, b] = levels;
        if (a.power_w - b.power_w).abs() <= 0.25 * BAND * (a.power_w + b.power_w) {
            let power_w = 0.5 * (a.power_w + b.power_w);
            let (sd, band) = (a.sd.max(b.sd), a.band.max(b.band));
            return levels.map(|own| Level { power_w, sd, band, ..own });
        }
        if is_gain(b.power_w / a.power_w, levels) {
            return levels;
        }
        let lower = if a.power_w < b.power_w { a } else { b };
        levels.map(|own| Level { floor_w: own.floor_w, ..lower })
    }

    /// Whether the robot rests in a window.
    fn has(&self, window: &Window) -> bool {
        window.sd <= self.sd && (window.mean - self.power_w).abs() <= self.band
    }

    /// The lowest power that lasts between two times, W: a quantile of the still windows.
    pub(super) fn floor_within(&self, windows: &[Window], rows: Range<usize>) -> Option<f64> {
        let begin = windows.partition_point(|w| w.row < rows.start);
        let inside = windows[begin..].iter().take_while(|w| w.row + w.rows <= rows.end);
        let still = inside.filter(|w| w.sd <= self.sd && w.mean > 0.0);
        let mut means: Vec<f64> = still.map(|w| w.mean).collect();
        if means.len() < STILL { None } else { quantile(&mut means, FLOOR) }
    }

    /// Time at rest between two times \[s\], and the mean power there \[W\]: all rows of windows at rest.
    pub(super) fn within(
        &self,
        series: &Series,
        windows: &[Window],
        from: f64,
        to: f64,
    ) -> (f64, Option<f64>) {
        let t = &series.t;
        let [mut next, end] = [from, to].map(|at| t.partition_point(|t| *t < at));
        let begin = windows.partition_point(|w| w.row < next);
        let inside = windows[begin..].iter().take_while(|w| w.row + w.rows <= end);
        let (mut time, mut energy) = (0.0, 0.0);
        for window in inside.filter(|w| self.has(w)) {
            for row in next.max(window.row)..window.row + window.rows {
                let until = t.get(row + 1).map_or(to, |t| t.min(to));
                time += until - t[row];
                energy += series.power[row] * (until - t[row]);
            }
            next = window.row + window.rows;
        }
        (time, (time > 0.0).then(|| energy / time))
    }
}

/// Whether the floor of the power confirms that the power at rest has changed by the meter.
pub(super) fn is_gain(ratio: f64, levels: [Level; 2]) -> bool {
    let [before, after] = levels.map(|level| level.floor_w);
    let (rest, floor) = (ratio.ln(), (after / before).ln());
    rest * floor > 0.0 && floor.abs() >= CONFIRMED * rest.abs()
}

/// The value at this share of the values; sorts them.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get((share * values.len() as f64) as usize).copied()
}

/// The half-sample mode of sorted values (D. R. Bickel, R. Frühwirth, Computational Statistics & Data
/// Analysis 50 (2006) 3500).
fn mode(sorted: &[f64]) -> Option<f64> {
    let mut part = sorted;
    while part.len() > 3 {
        let half = part.len().div_ceil(2);
        let narrowest = (0..=part.len() - half)
            .min_by(|a, b| {
                let width = |i: &usize| part[i + half - 1] - part[*i];
                width(a).total_cmp(&width(b))
            })
            .unwrap_or(0);
        part = &part[narrowest..narrowest + half];
    }
    (!part.is_empty()).then(|| part.iter().sum::<f64>() / part.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_level_at_rest_is_found() {
        let mut random = fastrand::Rng::with_seed(5);
        let t: Vec<f64> = (0..6000).map(|i| 0.05 * f64::from(i)).collect();
        let power = t.iter().map(|t| {
            let phase = t % 10.0;
            let work = match phase {
                p if p < 5.0 => 500.0 + 400.0 * (3.0 * p).sin(),
                // Constant speed, and braking that takes nothing.
                p if p < 7.0 => 600.0,
                p if p < 7.5 => -250.0,
                _ => 0.0,
            };
            300.0 + work + 6.0 * (random.f64() - 0.5)
        });
        let series = Series::new(t.clone(), power.collect(), false);
        let windows = windows(&series);
        let level = Level::of(&windows).expect("a level");
        assert!((level.power_w - 300.0).abs() < 2.0, "{level:?}");
        let (time, mean) = level.within(&series, &windows, 0.0, 100.0);
        assert!((time / 10.0 - 2.5).abs() < 0.1, "{time}");
        assert!((mean.expect("rest") - 300.0).abs() < 1.0);
    }
}

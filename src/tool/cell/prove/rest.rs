//! The power at rest: the level of the windows in which the power stays the same. It is what waiting
//! costs, and it shows whether the meter has changed between the sides.

use super::series::Series;

/// Length of a window, s, and its least number of rows.
const WINDOW_S: f64 = 0.4;
const ROWS: f64 = 4.0;
/// A window is quiet if it varies at most this much more than the quietest ones do.
const QUIET: f64 = 2.0;
const QUIETEST: f64 = 0.15;
/// Half width of the level, as a share.
pub(super) const BAND: f64 = 0.05;
/// Least share of all windows that are at the level.
const SEEN: f64 = 0.03;
/// Least number of windows at the level.
const WINDOWS: usize = 5;

/// A window of a log.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub(super) begin: f64,
    pub(super) end: f64,
    /// W.
    mean: f64,
    /// W.
    sd: f64,
}

/// The windows of a log.
pub(super) fn windows(series: &Series) -> Vec<Window> {
    let length = WINDOW_S.max(ROWS * series.step);
    let (t, power) = (&series.t, &series.power);
    let mut windows = Vec::new();
    let mut row = 0;
    while row < t.len() {
        let end = row + t[row..].partition_point(|at| *at < t[row] + length);
        let part = &power[row..end];
        let n = part.len() as f64;
        if n >= ROWS && t[end - 1] - t[row] > 0.5 * length {
            let mean = part.iter().sum::<f64>() / n;
            let squares: f64 = part.iter().map(|x| (x - mean).powi(2)).sum();
            let last = t.get(end).copied().unwrap_or(t[end - 1]).min(t[row] + length);
            windows.push(Window { begin: t[row], end: last, mean, sd: (squares / n).sqrt() });
        }
        row = end.max(row + 1);
    }
    windows
}

/// A level with the windows that belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// W.
    pub(super) power_w: f64,
    /// Largest deviation within a window, W.
    sd: f64,
}

impl Level {
    /// The level at rest; `None` if the robot never rests, or not to be seen.
    pub(super) fn of(windows: &[Window]) -> Option<Level> {
        let mean = windows.iter().map(|w| w.mean).sum::<f64>() / windows.len().max(1) as f64;
        let mut deviations: Vec<f64> = windows.iter().map(|w| w.sd).collect();
        deviations.sort_by(f64::total_cmp);
        let place = (QUIETEST * deviations.len() as f64) as usize;
        let least = *deviations.get(place)?;
        let sd = QUIET * least + 1e-3 * mean.abs();
        // Motion at constant speed is quiet, too, but takes more than the mean.
        let quiet = windows.iter().filter(|w| w.sd <= sd && w.mean < mean && w.mean > 0.0);
        let mut means: Vec<f64> = quiet.map(|w| w.mean).collect();
        means.sort_by(f64::total_cmp);
        let power_w = mode(&means)?;
        let level = Level { power_w, sd };
        let count = windows.iter().filter(|w| level.has(w)).count();
        (count >= WINDOWS && count as f64 >= SEEN * windows.len() as f64).then_some(level)
    }

    /// One level for both sides if they have the same one nearly.
    pub(super) fn common(levels: [Level; 2]) -> [Level; 2] {
        let [a, b] = levels;
        let power_w = 0.5 * (a.power_w + b.power_w);
        if (a.power_w - b.power_w).abs() > 0.5 * BAND * power_w {
            return levels;
        }
        [Level { power_w, sd: a.sd.max(b.sd) }; 2]
    }

    /// Whether the robot rests in a window.
    pub(super) fn has(&self, window: &Window) -> bool {
        window.sd <= self.sd && (window.mean - self.power_w).abs() <= BAND * self.power_w
    }

    /// Time at rest between two times \[s\], and the mean power there \[W\].
    pub(super) fn within(&self, windows: &[Window], from: f64, to: f64) -> (f64, Option<f64>) {
        let begin = windows.partition_point(|w| w.begin < from);
        let inside = windows[begin..].iter().take_while(|w| w.end <= to).filter(|w| self.has(w));
        let (mut time, mut energy) = (0.0, 0.0);
        for window in inside {
            time += window.end - window.begin;
            energy += window.mean * (window.end - window.begin);
        }
        (time, (time > 0.0).then(|| energy / time))
    }
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
        let (time, mean) = level.within(&windows, 0.0, 100.0);
        assert!((time / 10.0 - 2.5).abs() < 0.5, "{time}");
        assert!((mean.expect("rest") - 300.0).abs() < 1.0);
    }
}

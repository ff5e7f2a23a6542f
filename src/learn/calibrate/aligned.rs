//! Location of the simulated cycles in a log.

use std::ops::Range;

use super::cycle::Cycle;
use super::refusal::Refusal;
use crate::learn::log::{Channel, Log, golden_section, interpolated, median_step, quantile};

/// Least correlation of a pass with the simulated cycle.
const LEAST: f64 = 0.6;
/// Largest relative deviation of a cycle's duration, and steps of its search.
const PACE: f64 = 0.05;
const PACES: usize = 10;
/// Largest ratio of the power of two cycles: above it, the unit changes within the log.
const UNLIKE: f64 = 3.0;
/// Largest number of cycles that the search covers.
const CYCLES: f64 = 200.0;
/// Points of a cycle in the search, and in the refinement.
const COARSE: f64 = 400.0;
const FINE: usize = 3000;
/// Steps of the golden section search.
const SECTIONS: usize = 24;

/// The passes of the simulated cycle in a log.
pub(super) struct Aligned {
    pub(super) passes: Vec<Pass>,
    /// Whether the power is in kW.
    pub(super) kilowatts: bool,
}

/// One pass of the cycle.
pub(super) type Pass = Vec<Segment>;

/// A part of a pass in which the clocks of log and simulation differ by a constant factor.
pub(super) struct Segment {
    /// Time in the log \[s\].
    pub(super) log: Range<f64>,
    /// Where it begins in the simulated cycle \[s\].
    pub(super) begin: f64,
    /// Duration in the log over the simulated duration.
    pub(super) pace: f64,
}

impl Aligned {
    /// Total duration of the passes over the simulated one.
    pub(super) fn pace(&self) -> f64 {
        let segments = self.passes.iter().flatten();
        let [log, simulated] = segments.fold([0.0, 0.0], |[log, simulated], segment| {
            let lasts = segment.log.end - segment.log.start;
            [log + lasts, simulated + lasts / segment.pace]
        });
        log / simulated
    }
}

/// Finds the passes from `cmd`, from `cycle`, or from the power alone; refuses a log without any.
pub(super) fn align(cycle: &Cycle<'_>, log: &Log) -> Result<Aligned, Refusal> {
    let power = log.column(Channel::Power).unwrap_or_default();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let expected: Vec<f64> =
        (0..COARSE as usize).map(|i| cycle.power(cycle.duration * i as f64 / COARSE)).collect();
    if mean(power) <= 0.0 {
        return Err(Refusal::Negative(mean(power)));
    }
    if power.iter().all(|w| *w == power[0]) {
        return Err(Refusal::Constant(power[0]));
    }
    let ratio = (mean(power) / mean(&expected).abs()).ln();
    let kilowatts = (ratio + 1000.0_f64.ln()).abs() < ratio.abs();
    let curve = Curve { cycle, t: log.time(), power };
    let passes = if let Some(commands) = log.column(Channel::Command) {
        by_command(cycle, curve.t, commands)?
    } else {
        let begins = match log.column(Channel::Cycle) {
            Some(numbers) => by_number(cycle, curve.t, numbers)?,
            None => curve.search()?,
        };
        let passes: Vec<(Segment, f64)> =
            begins.into_iter().map(|(begin, pace)| curve.refined(begin, pace)).collect();
        let best = passes.iter().map(|(_, fit)| *fit).fold(0.0, f64::max);
        if best < LEAST {
            return Err(Refusal::Shape { correlation: best, least: LEAST });
        }
        let fitting = passes.into_iter().filter(|(_, fit)| *fit >= LEAST);
        fitting.map(|(segment, _)| vec![segment]).collect()
    };
    Ok(Aligned { passes, kilowatts })
}

/// Refuses passes whose power, relative to the simulated power at the same places, differs by more
/// than [`UNLIKE`]. The ratio is used because a log may begin and end anywhere in a cycle.
pub(super) fn check_alike(cycle: &Cycle<'_>, log: &Log, passes: &[Pass]) -> Result<(), Refusal> {
    let (t, power) = (log.time(), log.column(Channel::Power).unwrap_or_default());
    let place = |at: f64| t.partition_point(|t| *t < at);
    let mut levels: Vec<(f64, f64)> = Vec::new();
    for pass in passes {
        let Some(begin_s) = pass.first().map(|segment| segment.log.start) else { continue };
        let (mut measured, mut expected) = (0.0, 0.0);
        for segment in pass {
            for i in place(segment.log.start)..place(segment.log.end) {
                measured += power[i];
                expected += cycle.power(segment.begin + (t[i] - segment.log.start) / segment.pace);
            }
        }
        if measured > 0.0 && expected > 0.0 {
            levels.push((measured / expected, begin_s));
        }
    }
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    match (levels.first(), levels.last()) {
        (Some((least, _)), Some((most, begin_s))) if *most > UNLIKE * least => {
            Err(Refusal::Unlike { begin_s: *begin_s, factor: most / least })
        }
        _ => Ok(()),
    }
}

/// Passes from the movement number in `cmd`: each movement and each wait is one segment.
fn by_command(cycle: &Cycle<'_>, t: &[f64], commands: &[f64]) -> Result<Vec<Pass>, Refusal> {
    // Runs of rows with the same number, and their start times.
    let mut stretches: Vec<(usize, f64)> = Vec::new();
    for (t, number) in t.iter().zip(commands) {
        let number = number.max(0.0) as usize;
        if stretches.last().is_none_or(|(last, _)| *last != number) {
            stretches.push((number, *t));
        }
    }
    let most = stretches.iter().map(|(number, _)| *number).max().unwrap_or(0);
    if most != cycle.moves.len() {
        return Err(Refusal::Commands { measured: most, simulated: cycle.moves.len() });
    }
    let mut passes: Vec<Pass> = Vec::new();
    let mut last = usize::MAX;
    for pair in stretches.windows(2) {
        let [(number, from), (_, to)] = [pair[0], pair[1]];
        // The first and the last movement of a log may be incomplete.
        let simulated = match number.checked_sub(1) {
            Some(index) => (last != usize::MAX).then(|| cycle.moves[index]),
            None => last.checked_sub(1).and_then(|before| cycle.wait_behind(before)),
        };
        if number > 0 {
            if passes.is_empty() || (last != usize::MAX && number <= last) {
                passes.push(Pass::new());
            }
            last = number;
        }
        let Some((begin, lasts)) = simulated.filter(|(_, lasts)| *lasts > 0.0) else { continue };
        let pace = (to - from) / lasts;
        let segment = if (pace - 1.0).abs() <= PACE {
            Segment { log: from..to, begin, pace }
        } else if number == 0 {
            // A wait may last longer or shorter: at rest the power is constant.
            Segment { log: from..to.min(from + lasts), begin, pace: 1.0 }
        } else {
            continue;
        };
        if let Some(pass) = passes.last_mut() {
            pass.push(segment);
        }
    }
    passes.retain(|pass| !pass.is_empty());
    if passes.is_empty() {
        let log_s = t.last().unwrap_or(&0.0) - t.first().unwrap_or(&0.0);
        return Err(Refusal::Short { log_s, cycle_s: cycle.duration });
    }
    Ok(passes)
}

/// Start and pace of whole cycles from the cycle number.
fn by_number(cycle: &Cycle<'_>, t: &[f64], numbers: &[f64]) -> Result<Vec<(f64, f64)>, Refusal> {
    let mut begins: Vec<(f64, f64)> = Vec::new();
    for (t, number) in t.iter().zip(numbers) {
        if begins.last().is_none_or(|(last, _)| last != number) {
            begins.push((*number, *t));
        }
    }
    let end = t.last().copied().unwrap_or(0.0) + median_step(t);
    let ends = begins.iter().skip(1).map(|(_, t)| *t).chain([end]);
    let lasting: Vec<(f64, f64)> =
        begins.iter().zip(ends).map(|((_, begin), end)| (*begin, end - begin)).collect();
    let whole = lasting
        .iter()
        .filter(|(_, lasts)| (lasts / cycle.duration - 1.0).abs() <= PACE)
        .map(|(begin, lasts)| (*begin, lasts / cycle.duration));
    let whole: Vec<(f64, f64)> = whole.collect();
    if whole.is_empty() {
        let measured_s = quantile(lasting.iter().map(|(_, lasts)| *lasts), 0.5);
        return Err(Refusal::Length { measured_s, cycle_s: cycle.duration });
    }
    Ok(whole)
}

/// The logged power and the simulated cycle.
struct Curve<'a> {
    cycle: &'a Cycle<'a>,
    t: &'a [f64],
    power: &'a [f64],
}

impl Curve<'_> {
    /// Start and pace of the passes with the best correlation with the simulated power.
    fn search(&self) -> Result<Vec<(f64, f64)>, Refusal> {
        let (first, last) = (self.t[0], self.t[self.t.len() - 1]);
        let step = self.cycle.duration / COARSE;
        let count = ((last - first) / step).min(CYCLES * COARSE) as usize + 1;
        let logged = self.means(first, step, count);
        let mut best: (f64, f64, Vec<f64>) = (f64::NEG_INFINITY, 1.0, Vec::new());
        for i in 0..=2 * PACES {
            let pace = 1.0 + PACE * (i as f64 / PACES as f64 - 1.0);
            let points = (COARSE * pace).round() as usize;
            let simulated: Vec<f64> =
                (0..points).map(|k| self.cycle.power(step * k as f64 / pace)).collect();
            let windows = logged.windows(points);
            let fits: Vec<f64> = windows.map(|part| correlation(part, &simulated)).collect();
            let most = fits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if most > best.0 {
                best = (most, pace, fits);
            }
        }
        let (most, pace, mut fits) = best;
        if fits.is_empty() {
            return Err(Refusal::Short { log_s: last - first, cycle_s: self.cycle.duration });
        }
        // The bound is lower here: the refinement raises the correlation.
        let least = (LEAST * 0.9).min(most);
        let points = (COARSE * pace).round() as usize;
        let mut passes = Vec::new();
        while let Some((at, fit)) =
            fits.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
            && fit >= least
        {
            passes.push((first + step * at as f64, pace));
            let from = at.saturating_sub(points * 9 / 10);
            let to = (at + points * 9 / 10 + 1).min(fits.len());
            fits[from..to].fill(f64::NEG_INFINITY);
        }
        passes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(passes)
    }

    /// Means of the log over steps from `first` on; interpolated values where a step has no row.
    fn means(&self, first: f64, step: f64, count: usize) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); count];
        for (t, w) in self.t.iter().zip(self.power) {
            let place = ((t - first) / step + 0.5) as usize;
            if let Some((sum, rows)) = sums.get_mut(place) {
                *sum += w;
                *rows += 1.0;
            }
        }
        let between = interpolated(self.t, self.power, first, step, count);
        let means = sums.into_iter().zip(between);
        means.map(|((sum, rows), x)| if rows > 0.0 { sum / rows } else { x }).collect()
    }

    /// The pass with the best start and pace near the given ones, and its correlation.
    fn refined(&self, begin: f64, pace: f64) -> (Segment, f64) {
        let duration = self.cycle.duration;
        let rows = self.rows(begin, pace);
        let thin = (rows.len() / FINE).max(1);
        let fit = |begin: f64, pace: f64| {
            let rows = self.rows(begin, pace).step_by(thin);
            let (logged, simulated): (Vec<f64>, Vec<f64>) =
                rows.map(|i| (self.power[i], self.cycle.power((self.t[i] - begin) / pace))).unzip();
            correlation(&logged, &simulated)
        };
        let step = (duration / COARSE).max(median_step(self.t));
        let (mut begin, mut pace) = (begin, pace);
        for round in 0..3 {
            let reach = if round == 0 { 1.5 * step } else { 0.5 * step };
            begin = golden_section([begin - reach, begin + reach], SECTIONS, |x| -fit(x, pace));
            let reach = PACE / PACES as f64;
            // Changing the pace about the middle of the pass keeps both nearly independent.
            let middle = begin + 0.5 * duration * pace;
            let from_middle = |x: f64| -fit(middle - 0.5 * duration * x, x);
            pace = golden_section([pace - reach, pace + reach], SECTIONS, from_middle);
            begin = middle - 0.5 * duration * pace;
        }
        let segment = Segment { log: begin..begin + duration * pace, begin: 0.0, pace };
        (segment, fit(begin, pace))
    }

    fn rows(&self, begin: f64, pace: f64) -> Range<usize> {
        let from = self.t.partition_point(|t| *t < begin);
        let to = self.t.partition_point(|t| *t < begin + self.cycle.duration * pace);
        from..to.max(from)
    }
}

/// Correlation of two series; 0 where one is constant.
pub(super) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len()) as f64;
    let (mut sa, mut sb, mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        sa += x;
        sb += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    let scale = (aa - sa * sa / n) * (bb - sb * sb / n);
    if scale > 0.0 { (ab - sa * sb / n) / scale.sqrt() } else { 0.0 }
}

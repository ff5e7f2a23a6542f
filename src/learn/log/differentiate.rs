//! First and second derivatives of sampled series.
//!
//! A polynomial is fitted by least squares to the samples around each sample and differentiated
//! there (A. Savitzky, M. J. E. Golay, "Smoothing and differentiation of data by simplified least
//! squares procedures", Anal. Chem. 36, 1964), at the logged times. The window is symmetric, so
//! that there is no delay. Its width is chosen for each series: the widest one whose leave-one-out
//! prediction error is close to the least. At the ends of a section the window is that of the last
//! sample with a symmetric one.
//!
//! No polynomial fits across a jump of the acceleration. There the window is moved and narrowed,
//! with fewer terms, until the residuals are within the noise; among these fits the one with the
//! least variance of the acceleration is used. Where rows are missing as well, the samples may not
//! tell on which side of the jump they are; then there is no derivative.

use std::ops::Range;

use nalgebra::{SMatrix, SVector};

use super::uniform::{between_gaps, median_step};

/// Number of coefficients of the polynomial: degree 5.
const TERMS: usize = 6;
/// Number of coefficients beside a jump.
const FEW_TERMS: usize = 4;
/// Largest deviation of a fit's mean square from noise, in standard deviations.
const UNFIT: f64 = 5.0;
/// Approximate number of window positions around a sample that are tried.
const PLACES: usize = 8;
/// The quantile of the changes within a window that counts as fast, and the share of it above which
/// a window counts as moving.
const FAST: f64 = 0.9;
const MOVING: f64 = 0.1;
/// Possible numbers of samples to each side.
const HALF_WIDTHS: [usize; 8] = [4, 6, 9, 13, 19, 28, 40, 56];
/// Accepted ratio of the squared prediction error to the least one: rates profit more from a wide
/// window than positions.
const NEXT_TO_LEAST: f64 = 1.05;
/// Approximate number of samples whose prediction is evaluated. Usual numbers of rows are no
/// multiples of it, so that a few rows more or less do not change the samples.
const TRIALS: usize = 743;
/// Share of the prediction errors that count; the largest ones are of windows across jumps.
const COUNTED: f64 = 0.9;
/// An interval longer than the median by this factor ends a section.
const GAP: f64 = 5.0;
/// An interval longer than the median by this factor lacks a row.
const LACKS: f64 = 1.75;
/// Largest ratio of the standard deviation of an acceleration beside a gap to those of others, and
/// the standard deviation of an acceleration that is exact for any robot \[rad/s²\].
const VAGUE: f64 = 4.0;
const EXACT: f64 = 1e-3;
/// Relative rounding errors of the normal equations.
const SOLVED: f64 = 1e-12;
/// Largest deviation of a step of a rounded series from a multiple of the smallest one, and the
/// least ratio of its fast steps to that one.
const WHOLE: f64 = 0.01;
const MULTIPLES: f64 = 10.0;
/// Largest ratio of the variances of two fits that are equally good, and their least difference in
/// standard deviations that is a contradiction.
const RIVAL: f64 = 3.0;
const APART: f64 = 20.0;
/// A rate below this number of standard deviations counts as 0.
const AT_REST: f64 = 3.0;

/// First and second derivative of `x`, per s and s², at the ascending times `t` \[s\]; `None` in a
/// section that is too short for a parabola, and where missing rows make the second derivative
/// vague. A first derivative within the noise is 0.
#[must_use]
pub fn derivatives(t: &[f64], x: &[f64]) -> Vec<Option<[f64; 2]>> {
    let sections = between_gaps(t, GAP);
    let trials = trials(t);
    let half = half_width(t, x, &sections, &trials);
    let mut found = vec![None; t.len()];
    let mut smooth = Smooth::new(t, x, &sections, &trials);
    smooth.variance = smooth.variance.max(rounding(x));
    // Variance of the noise, from prediction errors; jumps increase these.
    let noise = error_of(t, x, &sections, &trials, half).unwrap_or(0.0).min(smooth.variance);
    for section in &sections {
        for i in section.clone() {
            found[i] = smooth.fit(section, i, half).map(|fit| {
                let deviation = (noise * fit.rate_variance).sqrt();
                let rate = if fit.rate.abs() < AT_REST * deviation { 0.0 } else { fit.rate };
                [rate, fit.acceleration]
            });
        }
    }
    found
}

/// The samples whose prediction is evaluated: chosen by their time, so that the loss of some rows
/// does not change the others.
fn trials(t: &[f64]) -> Vec<bool> {
    let start = t.first().map_or(0.0, |first| first.floor());
    let step = median_step(t);
    let stride = (t.len() / TRIALS).max(1).next_power_of_two() as u64;
    t.iter().map(|t| (((t - start) / step).round() as u64).is_multiple_of(stride)).collect()
}

/// Variance of the rounding: to multiples of the smallest step if the series consists of these, else
/// of the numbers. The residuals of a motion by whole steps do not show it.
fn rounding(x: &[f64]) -> f64 {
    let steps = || x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
    let least = steps().fold(f64::INFINITY, f64::min);
    let multiples = || steps().map(|step| step / least);
    let off = multiples().map(|multiple| (multiple - multiple.round()).abs());
    let are_whole = quantile(off.collect(), FAST) < WHOLE;
    if are_whole && quantile(multiples().collect(), FAST) > MULTIPLES {
        return least * least / 12.0;
    }
    let largest = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    (SOLVED * largest).powi(2)
}

/// Half width of the window for a series.
fn half_width(t: &[f64], x: &[f64], sections: &[Range<usize>], trials: &[bool]) -> usize {
    let errors: Vec<(usize, f64)> = HALF_WIDTHS
        .iter()
        .filter_map(|half| Some((*half, error_of(t, x, sections, trials, *half)?)))
        .collect();
    let least = errors.iter().fold(f64::INFINITY, |least, (_, error)| least.min(*error));
    let wide = errors.iter().rev().find(|(_, error)| *error <= NEXT_TO_LEAST * least);
    wide.map_or(HALF_WIDTHS[0], |(half, _)| *half)
}

/// Mean square of the smaller leave-one-out prediction errors; `None` if no window of this width
/// fits.
fn error_of(
    t: &[f64],
    x: &[f64],
    sections: &[Range<usize>],
    trials: &[bool],
    half: usize,
) -> Option<f64> {
    let mut squares = Vec::new();
    for section in sections {
        for i in inner(section, half).filter(|i| trials[*i]) {
            let Some(fit) = fit(t, x, section, i, half) else { continue };
            // The leave-one-out error follows from the fit with the sample.
            let miss = (x[i] - fit.value) / (1.0 - fit.leverage).max(f64::EPSILON);
            squares.push(miss * miss);
        }
    }
    squares.sort_by(f64::total_cmp);
    squares.truncate((COUNTED * squares.len() as f64).ceil() as usize);
    (!squares.is_empty()).then(|| squares.iter().sum::<f64>() / squares.len() as f64)
}

/// The samples of a section with a whole window around them.
fn inner(section: &Range<usize>, half: usize) -> Range<usize> {
    section.start + half..section.end.saturating_sub(half)
}

/// A series, the rows before which others are missing, and the variance of the noise in the
/// narrowest windows.
struct Smooth<'a> {
    t: &'a [f64],
    x: &'a [f64],
    lacks: Vec<usize>,
    variance: f64,
}

impl<'a> Smooth<'a> {
    fn new(t: &'a [f64], x: &'a [f64], sections: &[Range<usize>], trials: &[bool]) -> Smooth<'a> {
        let half = HALF_WIDTHS[0];
        let looks: Vec<[f64; 2]> = sections
            .iter()
            .flat_map(|section| inner(section, half).filter(|i| trials[*i]))
            .filter_map(|i| {
                let fit = window_fit(t, x, i - half..i + half + 1, i, TERMS)?;
                Some([(x[i + half] - x[i - half]).abs(), fit.left])
            })
            .collect();
        // A resting series is rounded to a constant, which hides its noise.
        let fast = quantile(looks.iter().map(|of| of[0]).collect(), FAST);
        let moving = looks.iter().filter(|of| of[0] >= MOVING * fast);
        let long = LACKS * median_step(t);
        let lacks = (1..t.len()).filter(|i| t[*i] - t[i - 1] > long).collect();
        Smooth { t, x, lacks, variance: quantile(moving.map(|of| of[1]).collect(), 0.5) }
    }

    /// Whether the residuals of a fit are within the noise.
    fn fits(&self, fit: &Fit) -> bool {
        fit.left <= (1.0 + UNFIT * (2.0 / fit.freedom).sqrt()) * self.variance
    }

    /// The fit around sample `i` of a section, or an off-centre fit if the centred one fails.
    fn fit(&self, section: &Range<usize>, i: usize, half: usize) -> Option<Fit> {
        let centred = fit(self.t, self.x, section, i, half)?;
        if self.is_vague_beside_gap(section, i, half, &centred) {
            return None;
        }
        if self.variance == 0.0 || self.fits(&centred) {
            return Some(centred);
        }
        let (mut fits, mut least): (Vec<Fit>, Option<Fit>) = (Vec::new(), None);
        for window in windows(section, i, half) {
            for terms in [FEW_TERMS, TERMS] {
                let Some(fit) = window_fit(self.t, self.x, window.clone(), i, terms) else {
                    continue;
                };
                let error = |of: &Fit| of.left * of.acceleration_variance;
                if self.fits(&fit) {
                    fits.push(fit);
                } else if least.as_ref().is_none_or(|of| error(&fit) < error(of)) {
                    least = Some(fit);
                }
            }
        }
        let variance = |fit: &Fit| fit.acceleration_variance;
        let surest = fits.iter().min_by(|a, b| variance(a).total_cmp(&variance(b))).copied();
        if self.lacks_rows_near(i, 2 * HALF_WIDTHS[0])
            && surest.is_some_and(|surest| fits.iter().any(|fit| self.contradicts(fit, &surest)))
        {
            return None;
        }
        surest.or(least).or(Some(centred))
    }

    /// Whether a fit is much less certain than others because a gap ends its window.
    fn is_vague_beside_gap(
        &self,
        section: &Range<usize>,
        i: usize,
        half: usize,
        found: &Fit,
    ) -> bool {
        let after_gap = section.start > 0 && i < section.start + half;
        let before_gap = section.end < self.t.len() && i + half >= section.end;
        if !after_gap && !before_gap || self.variance * found.acceleration_variance < EXACT * EXACT
        {
            return false;
        }
        let middle = i.max(section.start + half).min(section.end.saturating_sub(half + 1));
        let inner =
            fit(self.t, self.x, section, middle.clamp(section.start, section.end - 1), half);
        inner.is_some_and(|inner| {
            found.acceleration_variance > VAGUE * VAGUE * inner.acceleration_variance
        })
    }

    /// Whether rows are missing within a number of rows around a sample.
    fn lacks_rows_near(&self, i: usize, reach: usize) -> bool {
        let next = self.lacks.partition_point(|row| row + reach <= i);
        self.lacks.get(next).is_some_and(|row| *row <= i + reach)
    }

    /// Whether a fit is as good as the surest one, but has another acceleration.
    fn contradicts(&self, fit: &Fit, surest: &Fit) -> bool {
        let [own, other] = [fit, surest].map(|fit| fit.acceleration_variance);
        let apart = (fit.acceleration - surest.acceleration).powi(2);
        own <= RIVAL * other && apart > APART * APART * self.variance * (own + other)
    }
}

/// The windows of a section around a sample, from the narrowest up.
fn windows(
    section: &Range<usize>,
    i: usize,
    half: usize,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let (start, end) = (section.start, section.end);
    HALF_WIDTHS.into_iter().filter(move |other| *other <= half).flat_map(move |half| {
        let width = 2 * half + 1;
        let low = (i + 1).saturating_sub(width).max(start);
        let high = i.min(end.saturating_sub(width));
        let places = (low..high).step_by((width / PLACES).max(1)).chain([high]);
        // A section shorter than the window has no position for it.
        places.filter(move |first| *first >= low).map(move |first| first..first + width)
    })
}

/// The quantile of values; 0 for an empty list.
fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    values.get((share * last) as usize).copied().unwrap_or(0.0)
}

#[derive(Clone, Copy)]
struct Fit {
    value: f64,
    rate: f64,
    acceleration: f64,
    /// Derivative of the fitted value with respect to the sample.
    leverage: f64,
    /// Variance of the rate over that of the samples \[1/s²\].
    rate_variance: f64,
    /// Variance of the acceleration over that of the samples \[1/s⁴\].
    acceleration_variance: f64,
    /// Mean square of the residuals, and its degrees of freedom.
    left: f64,
    freedom: f64,
}

/// The fit around sample `i` of a section.
fn fit(t: &[f64], x: &[f64], section: &Range<usize>, i: usize, half: usize) -> Option<Fit> {
    let width = (2 * half + 1).min(section.len());
    let first = i.saturating_sub(half).clamp(section.start, section.end - width);
    // A short section has a polynomial with fewer terms, down to a parabola.
    window_fit(t, x, first..first + width, i, TERMS.min(width))
}

/// The polynomial with `terms` coefficients in a window, at sample `i`.
fn window_fit(t: &[f64], x: &[f64], window: Range<usize>, i: usize, terms: usize) -> Option<Fit> {
    if terms < 3 {
        return None;
    }
    let width = window.len();
    let scale = (t[window.end - 1] - t[window.start]).max(f64::MIN_POSITIVE) / 2.0;
    let mut normal = SMatrix::<f64, TERMS, TERMS>::identity();
    normal.view_mut((0, 0), (terms, terms)).fill(0.0);
    let mut right = SVector::<f64, TERMS>::zeros();
    let powers = |k: usize| {
        let u = (t[k] - t[i]) / scale;
        let mut powers = SVector::<f64, TERMS>::zeros();
        let mut power = 1.0;
        for term in 0..terms {
            powers[term] = power;
            power *= u;
        }
        powers
    };
    for k in window.clone() {
        let powers = powers(k);
        normal += powers * powers.transpose();
        // Differences to the sample keep the accuracy for large positions.
        right += powers * (x[k] - x[i]);
    }
    let inverse = normal.cholesky()?.inverse();
    let c = inverse * right;
    let freedom = (width - terms).max(1) as f64;
    let left = window.map(|k| (x[k] - x[i] - powers(k).dot(&c)).powi(2)).sum::<f64>() / freedom;
    Some(Fit {
        value: x[i] + c[0],
        rate: c[1] / scale,
        acceleration: 2.0 * c[2] / (scale * scale),
        leverage: inverse[(0, 0)],
        rate_variance: inverse[(1, 1)] / (scale * scale),
        acceleration_variance: 4.0 * inverse[(2, 2)] / scale.powi(4),
        left,
        freedom,
    })
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;

    const STEP: f64 = 0.01;
    const HARD: f64 = 8.0;
    /// An error that occurs only near the ends of a ramp.
    const LARGE: f64 = 2.0;
    /// Number of jumps of the motion, and of rows that may be wrong at each.
    const JUMPS: usize = 12;
    const WRONG: usize = 2;

    /// Moves with trapezoidal speed, rounded to encoder steps.
    #[test]
    fn accelerations_that_jump_are_not_smeared() {
        let [mut t, mut x, mut exact] = [vec![], vec![], vec![]];
        let (mut position, mut rate) = (0.0, 0.0);
        for row in 0..300 {
            let acceleration = match row % 100 {
                0..25 => HARD,
                50..75 => -HARD,
                _ => 0.0,
            };
            t.push(STEP * f64::from(row));
            x.push(f64::round(1e5 * position) / 1e5);
            exact.push(acceleration);
            position += rate * STEP + 0.5 * acceleration * STEP * STEP;
            rate += acceleration * STEP;
        }
        let found = derivatives(&t, &x);
        let wrong = found
            .iter()
            .zip(&exact)
            .filter(|(found, exact)| (found.unwrap()[1] - **exact).abs() > LARGE);
        let wrong = wrong.count();
        assert!(wrong <= WRONG * JUMPS, "{wrong} rows");
    }
}

//! Rates and accelerations of what was sampled.
//!
//! A polynomial is fitted by least squares to the samples around each one, and
//! differentiated there (A. Savitzky, M. J. E. Golay, "Smoothing and differentiation of
//! data by simplified least squares procedures", Anal. Chem. 36, 1964), in the times as
//! they are. The window lies to both sides, so that nothing is late. Its width is chosen
//! for each series: the widest whose error in predicting a sample from its neighbours is
//! next to the least. At the ends of a section the window is that of the last sample which
//! has both sides.

use nalgebra::{SMatrix, SVector};

/// Degree of the polynomial.
const DEGREE: usize = 5;
/// Its coefficients.
const TERMS: usize = DEGREE + 1;
/// Samples to each side of one, by choice.
const HALF_WIDTHS: [usize; 8] = [4, 6, 9, 13, 19, 28, 40, 56];
/// How much the squared error of prediction may exceed the least: rates gain more from a
/// wide window than positions.
const NEXT_TO_LEAST: f64 = 1.05;
/// At most about this many samples are predicted for the choice.
const TRIALS: usize = 400;
/// An interval longer than the median by this factor ends a section.
const GAP: f64 = 5.0;
/// A rate below this many of its standard deviations can't be told from rest.
const AT_REST: f64 = 3.0;

/// First and second derivative of `x`, per s and s², at the times `t` \[s\], which ascend;
/// `None` at a sample of a section that is too short for a parabola. A first derivative that
/// the noise does not let be told from 0 is 0.
#[must_use]
pub fn derivatives(t: &[f64], x: &[f64]) -> Vec<Option<[f64; 2]>> {
    let sections = sections(t);
    let half = half_width(t, x, &sections);
    let mut found = vec![None; t.len()];
    // The noise of the samples, from how well they are predicted.
    let noise = error_of(t, x, &sections, half).unwrap_or(0.0);
    for [from, to] in &sections {
        for i in *from..*to {
            found[i] = fit(t, x, [*from, *to], i, half).map(|fit| {
                let deviation = (noise * fit.rate_variance).sqrt();
                let rate = if fit.rate.abs() < AT_REST * deviation { 0.0 } else { fit.rate };
                [rate, fit.acceleration]
            });
        }
    }
    found
}

/// First and last (exclusive) sample of each part without a gap.
fn sections(t: &[f64]) -> Vec<[usize; 2]> {
    let mut intervals: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    intervals.sort_by(f64::total_cmp);
    let longest = intervals.get(intervals.len() / 2).map_or(f64::INFINITY, |median| GAP * median);
    let mut sections = Vec::new();
    let mut begin = 0;
    for i in 1..=t.len() {
        if i == t.len() || t[i] - t[i - 1] > longest {
            sections.push([begin, i]);
            begin = i;
        }
    }
    sections
}

/// The half width of the window for a series.
fn half_width(t: &[f64], x: &[f64], sections: &[[usize; 2]]) -> usize {
    let errors: Vec<(usize, f64)> = HALF_WIDTHS
        .iter()
        .filter_map(|half| Some((*half, error_of(t, x, sections, *half)?)))
        .collect();
    let least = errors.iter().fold(f64::INFINITY, |least, (_, error)| least.min(*error));
    let wide = errors.iter().rev().find(|(_, error)| *error <= NEXT_TO_LEAST * least);
    wide.map_or(HALF_WIDTHS[0], |(half, _)| *half)
}

/// Mean squared error of a sample that is predicted from those around it; `None` where no
/// window of this width fits.
fn error_of(t: &[f64], x: &[f64], sections: &[[usize; 2]], half: usize) -> Option<f64> {
    let stride = t.len().div_ceil(TRIALS).max(1);
    let (mut sum, mut count) = (0.0, 0.0);
    for [from, to] in sections.iter().filter(|[from, to]| to - from > 2 * half) {
        for i in (from + half..to - half).step_by(stride) {
            let Some(fit) = fit(t, x, [*from, *to], i, half) else { continue };
            // The prediction without the sample itself, from the fit with it.
            let miss = (x[i] - fit.value) / (1.0 - fit.leverage).max(f64::EPSILON);
            sum += miss * miss;
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}

struct Fit {
    value: f64,
    rate: f64,
    acceleration: f64,
    /// Change of the value per change of the sample.
    leverage: f64,
    /// Variance of the rate per variance of the samples \[1/s²\].
    rate_variance: f64,
}

/// The fit around sample `i` of a section.
fn fit(t: &[f64], x: &[f64], [from, to]: [usize; 2], i: usize, half: usize) -> Option<Fit> {
    let width = (2 * half + 1).min(to - from);
    let first = i.saturating_sub(half).clamp(from, to - width);
    let window = first..first + width;
    // A short section gets a polynomial of fewer terms, down to a parabola.
    let terms = TERMS.min(width);
    if terms < 3 {
        return None;
    }
    let scale = (t[window.end - 1] - t[window.start]).max(f64::MIN_POSITIVE) / 2.0;
    let mut normal = SMatrix::<f64, TERMS, TERMS>::identity();
    normal.view_mut((0, 0), (terms, terms)).fill(0.0);
    let mut right = SVector::<f64, TERMS>::zeros();
    for k in window {
        let u = (t[k] - t[i]) / scale;
        let mut powers = SVector::<f64, TERMS>::zeros();
        let mut power = 1.0;
        for term in 0..terms {
            powers[term] = power;
            power *= u;
        }
        normal += powers * powers.transpose();
        // Differences to the sample keep their digits where positions are large.
        right += powers * (x[k] - x[i]);
    }
    let inverse = normal.cholesky()?.inverse();
    let c = inverse * right;
    Some(Fit {
        value: x[i] + c[0],
        rate: c[1] / scale,
        acceleration: 2.0 * c[2] / (scale * scale),
        leverage: inverse[(0, 0)],
        rate_variance: inverse[(1, 1)] / (scale * scale),
    })
}

//! Checks of a campaign that the scatter of its cycles does not show: the meter, a drift, a step, cycles on
//! the wrong side, another product. What one of them may have done to the saving widens the interval.

use super::blocks::{block_length, long_run_variance};
use super::estimate::Estimate;
use super::interval::NORMAL;
use super::outliers::deviation;
use super::periodic::correlation;

/// A reason to widen the interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// Its name.
    pub name: &'static str,
    /// By how much the lower and the upper end move, shares.
    pub widens: [f64; 2],
    /// Whether no verdict can be given.
    pub withholds: bool,
    /// What was seen and what to do.
    pub text: String,
}

/// Standard errors beyond which a step is taken as seen.
const STEP: f64 = 4.0;
/// The same for the meter: what is not seen makes a saving of nothing.
const METER: f64 = 2.0;
/// The same for a drift, which also harms where it is not seen.
const DRIFT: f64 = 2.5;
/// Least change of the power at rest, share: waiting at another pose changes it by as much.
const LEAST: f64 = 0.003;
/// A part of the course of the power, and how far a retrofit moves it, as shares of the cycle.
const PART: usize = 4;
/// How well the halves of a side have to resemble each other for a course to say something, and the share of
/// that below which the sides are of different work.
const STEADY: f64 = 0.85;
const OTHER: f64 = 0.8;
/// Change of the duration that no retrofit makes without being asked, share.
const LONGER: f64 = 0.15;

/// The mean of a series and its standard error; a trend is no noise of it.
fn mean_and_error(x: &[f64]) -> [f64; 2] {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let middle = 0.5 * (n - 1.0);
    let (mut squares, mut product) = (0.0, 0.0);
    for (i, x) in x.iter().enumerate() {
        squares += (i as f64 - middle).powi(2);
        product += (i as f64 - middle) * (x - mean);
    }
    let left: Vec<f64> = x
        .iter()
        .enumerate()
        .map(|(i, x)| x - mean - product / squares * (i as f64 - middle))
        .collect();
    [mean, (long_run_variance(&left, block_length(&left)) / n).sqrt()]
}

/// The power of the cycles of both sides while the robot stands, W: a meter with another gain shows another
/// one. The movements of a retrofit do not change it.
pub(super) fn meter(level: [&[f64]; 2], saving: f64) -> Option<Doubt> {
    if level.iter().any(|x| x.len() < 3) {
        return None;
    }
    let [[before, error_0], [after, error_1]] = level.map(mean_and_error);
    let change = after / before - 1.0;
    let error = error_0.hypot(error_1) / before;
    if change.abs() < LEAST || change.abs() < METER * error {
        return None;
    }
    // The true change of the energy lies between the measured one and that of a meter with this error, which is
    // known as well as the power is.
    let shift = (change + change.signum() * NORMAL * error) * (1.0 - saving);
    Some(Doubt {
        name: "meter",
        widens: [(-shift).max(0.0), shift.max(0.0)],
        withholds: false,
        text: format!(
            "while the robot stands, the power is {before:.1} W before and {after:.1} W after ({:+.2} %, standard error \
             {:.2} %): the meter may have changed by as much, and the interval covers that; if the retrofit \
             itself lowers the power at rest, show it by a measurement with brakes and pose as before",
            100.0 * change,
            100.0 * error
        ),
    })
}

/// A drift of the energy over the time of each side; `apart` is the time between their middles, s.
pub(super) fn drift(of: &Estimate, times: [&[f64]; 2], apart: f64) -> Option<Doubt> {
    let (mut squares, mut product) = (0.0, 0.0);
    let centred = times.map(|t| {
        let mean = t.iter().sum::<f64>() / t.len().max(1) as f64;
        t.iter().map(|t| t - mean).collect::<Vec<f64>>()
    });
    for (t, y) in centred.iter().zip(&of.residual) {
        squares += t.iter().map(|t| t * t).sum::<f64>();
        product += t.iter().zip(y).map(|(t, y)| t * y).sum::<f64>();
    }
    if squares <= 0.0 {
        return None;
    }
    let rate = product / squares;
    let (mut variance, mut count) = (0.0, 0.0);
    for (t, y) in centred.iter().zip(&of.residual) {
        let left: Vec<f64> = t.iter().zip(y).map(|(t, y)| y - rate * t).collect();
        variance += long_run_variance(&left, block_length(&left)) * left.len() as f64;
        count += left.len() as f64;
    }
    let error = (variance / count / squares).sqrt();
    if rate.abs() < DRIFT * error {
        return None;
    }
    let shift = rate * apart;
    Some(Doubt {
        name: "drift",
        widens: [(-shift).max(0.0), shift.max(0.0)],
        withholds: false,
        text: format!(
            "the energy of a cycle drifts by {:+.2} % an hour on both sides, {:+.2} % from one side to the \
             other: meter, warm-up or process; the interval covers it; alternate the programs by the hour, or \
             log a temperature (column temp1)",
            3.6e5 * rate,
            100.0 * shift
        ),
    })
}

/// A step of the energy within a side: either level may be that of the program.
pub(super) fn step(y: &[f64], side: usize, saving: f64) -> Option<Doubt> {
    let n = y.len();
    let least = 4.max(n / 10);
    if n < 2 * least {
        return None;
    }
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let strength = |at: usize| {
        let (a, b) = y.split_at(at);
        (mean(a) - mean(b)).abs() * (a.len() as f64 * b.len() as f64 / n as f64).sqrt()
    };
    let at = (least..=n - least).max_by(|a, b| strength(*a).total_cmp(&strength(*b)))?;
    let (a, b) = y.split_at(at);
    let [first, second] = [mean(a), mean(b)];
    let left: Vec<f64> = a.iter().map(|y| y - first).chain(b.iter().map(|y| y - second)).collect();
    let noise = long_run_variance(&left, block_length(&left)).sqrt();
    if strength(at) < STEP * noise || noise <= 0.0 {
        return None;
    }
    let whole = mean(y);
    // A higher level before is a larger saving, a higher one after a smaller one.
    let sign = if side == 0 { 1.0 - saving } else { -1.0 };
    let shifts = [first - whole, second - whole].map(|shift| sign * shift);
    let name = ["before", "after"][side.min(1)];
    Some(Doubt {
        name: "step",
        widens: [
            shifts.iter().fold(0.0, |m: f64, x| m.max(-x)),
            shifts.iter().fold(0.0, |m: f64, x| m.max(*x)),
        ],
        withholds: false,
        text: format!(
            "{name}: the energy of a cycle changes by {:+.2} % after {at} of {n} cycles: something else was \
             changed, or logs of both sides are mixed; the interval covers either level; leave out the logs of \
             the part that is not meant",
            100.0 * (second - first)
        ),
    })
}

/// How well the movements of two courses are found again in each other, in the same order: the mean, over parts
/// of both weighted by their variance, of the best correlation with a part of the other one nearby. A retrofit
/// shifts movements and changes a few of them; it leaves the others as they are.
fn alike(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len() / PART;
    let parts = |of: &[f64]| -> Vec<Vec<f64>> {
        (0..of.len()).map(|at| of.iter().cycle().skip(at).take(length).copied().collect()).collect()
    };
    let (mut sum, mut weight) = (0.0, 0.0);
    let both = [parts(a), parts(b)];
    for [of, other] in [[&both[0], &both[1]], [&both[1], &both[0]]] {
        for (at, part) in of.iter().enumerate() {
            let near = (at + of.len() - length..=at + of.len() + length).map(|to| to % of.len());
            let best = near.map(|to| correlation(part, &other[to])).fold(-1.0, f64::max);
            let variance = deviation(part).powi(2);
            sum += variance * best;
            weight += variance;
        }
    }
    if weight > 0.0 { sum / weight } else { 0.0 }
}

/// Where cycles begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turned {
    /// At the same place of the work on both sides.
    Alike,
    /// Wherever the power was distinctive.
    Anyhow,
}

/// The mean courses of the power over a cycle, and the mean durations without foreign waits: other work has
/// others. Each side has its cycles in the order of time; `turned`: a cycle may begin at another place on
/// each side.
pub(super) fn other_work(
    courses: [&[&[f64]]; 2],
    duration: [f64; 2],
    turned: Turned,
) -> Option<Doubt> {
    let longer = duration[1] / duration[0] - 1.0;
    let mean = |courses: &[&[f64]]| -> Vec<f64> {
        let points = courses.first().map_or(0, |course| course.len());
        let sum = |point: usize| courses.iter().map(|course| course[point]).sum::<f64>();
        (0..points).map(|point| sum(point) / courses.len().max(1) as f64).collect()
    };
    let within = courses.map(|courses| {
        let (a, b) = courses.split_at(courses.len() / 2);
        if a.is_empty() { 0.0 } else { alike(&mean(a), &mean(b)) }
    });
    let within = within[0].min(within[1]);
    let [before, mut after] = courses.map(mean);
    if turned == Turned::Anyhow {
        let turn = |by: &usize| correlation(&before, &[&after[*by..], &after[..*by]].concat());
        let best = (0..after.len()).max_by(|a, b| turn(a).total_cmp(&turn(b)));
        after.rotate_left(best.unwrap_or(0));
    }
    let across = alike(&before, &after);
    let text = if within > STEADY && across < OTHER * within {
        format!(
            "the course of the power over a cycle is another one (the sides correlate by {across:.2}, cycles of \
             one side by {within:.2}): another product or program? No verdict: give logs of the same work, with \
             columns part or payload"
        )
    } else if longer.abs() > LONGER {
        format!(
            "a cycle without its longer waits takes {:+.1} % of the time before: another product or process? No \
             verdict: give logs of the same work, with columns part or payload",
            100.0 * longer
        )
    } else {
        return None;
    };
    Some(Doubt { name: "other work", widens: [0.0; 2], withholds: true, text })
}

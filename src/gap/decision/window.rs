//! Effects that act for a part of each repetition, or of a log.
//!
//! What acts in a window is the sum of what acts in its parts: the products of the parts tell what each
//! window would gain. The best ones are moved until their ends fit.

use super::shape::{Move, climbed, lowest};
use super::starts::starts;
use crate::arm::effects::Effect;
use crate::gap::data::Record;
use crate::gap::design::{Design, PieceRows, Rise, Times, Whole};
use crate::gap::posterior::{Gains, WindowGains};

/// Parts of a repetition at which windows begin and end, and those of the longest window: what acts for
/// more than half of the time stops for a window.
const PARTS: usize = 96;
const LONGEST: usize = PARTS / 2;
/// Parts in which something can be seen to grow and fall.
const LEAST_GROWING: usize = 6;
/// Times that an interval is halved: to a millionth of a window.
const HALVED: usize = 20;

/// An effect that acts in windows, at a joint.
pub(super) struct Windows {
    whole: Whole,
    /// Duration of a part \[s\].
    part: f64,
    /// Duration of the shortest window \[s\]: a part, and what the frequencies of the logs resolve.
    shortest: f64,
    times: Times,
    /// What acts in each part.
    parts: PieceRows,
}

impl Windows {
    /// Windows of an effect.
    pub(super) fn new(
        design: &Design,
        records: &[Record<'_>],
        effect: &'static Effect,
        joint: usize,
    ) -> Option<Windows> {
        let first = records.first()?;
        let whole = Whole::new(records, effect, joint)?;
        let closed = first.motion.closed;
        let [begins, ends] = if closed { [0.0, first.duration()] } else { range(records) };
        let part = (ends - begins) / PARTS as f64;
        let period = if closed { ends } else { 0.0 };
        let times = Times { begins, period, choices: PARTS * LONGEST };
        let parts = whole.parts(design, records, (part, PARTS), &times);
        let resolved = first.duration() / first.bins().max(1) as f64;
        Some(Windows { whole, part, shortest: part.max(resolved), times, parts })
    }

    /// The best windows beside a fit.
    pub(super) fn best(
        &self,
        records: &[Record<'_>],
        design: &Design,
        gains: &Gains<'_>,
    ) -> Vec<PieceRows> {
        let within = |from: &PieceRows, shape: &[f64]| {
            let mut shape = shape.to_vec();
            let n = shape.len();
            if let Some(Rise { coordinate: k, most, share }) = self.whole.rise() {
                shape[k] = shape[k].clamp(0.0, most);
                // What grows more slowly lasts longer: half of it is there from and to the same times.
                let [before, now] =
                    [from.shape[k], shape[k]].map(|rise| half_of(|x| share(rise, x)));
                let longer = 0.5 * ((1.0 - 2.0 * before) / (1.0 - 2.0 * now) - 1.0);
                let more = longer * (shape[n - 2] - shape[n - 3]);
                shape[n - 3] -= more;
                shape[n - 2] += more;
            }
            shape[n - 2] = shape[n - 2].max(shape[n - 3] + self.shortest);
            self.whole.within(design, records, shape, &self.times)
        };
        let n = self.parts.effect.coordinates.len();
        let by = |coordinate, step| Move { coordinate, step, is_factor: false };
        let lowest = lowest(records);
        let at = |[start, end]: [f64; 2], rise: Option<(usize, f64)>| {
            let mut shape = self.whole.shape([start, end], &self.times);
            if let Some((k, value)) = rise {
                shape[k] = value;
            }
            self.whole.within(design, records, shape, &self.times)
        };
        let mut all = Vec::new();
        let of_parts = gains.of_windows(&self.parts, PARTS, lowest);
        for window in self.at_once(&of_parts) {
            let ends = [by(n - 3, 0.5 * self.part), by(n - 2, 0.5 * self.part)];
            all.push(climbed(gains, &at(window, None), &ends, 2.0 * lowest, &within));
        }
        if let Some(Rise { coordinate: k, most, share }) = self.whole.rise() {
            for window in self.growing(&of_parts, &|x| share(0.5 * most, x)) {
                // It has no sharp ends: they are looked for in larger steps.
                let step = 0.1 * (window[1] - window[0]);
                let moves = [by(k, 0.25 * most), by(n - 3, step), by(n - 2, step)];
                let start = at(window, Some((k, 0.5 * most)));
                all.push(climbed(gains, &start, &moves, 2.0 * lowest, &within));
            }
        }
        all
    }

    /// The best windows in which an effect is there at once \[s\].
    fn at_once(&self, gains: &WindowGains<'_>) -> Vec<[f64; 2]> {
        let all = (0..PARTS).flat_map(|from| {
            let gains = gains.at_once(from, LONGEST.min(self.last() - from));
            gains.into_iter().enumerate().map(move |(k, gain)| (gain, [from, from + k + 1]))
        });
        self.starts(all.collect())
    }

    /// The best windows in which an effect grows and falls: its share goes by the part of the window that
    /// is over \[s\].
    fn growing(&self, gains: &WindowGains<'_>, share: &dyn Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut all = Vec::new();
        for count in
            (LEAST_GROWING..=LONGEST).filter(|count| count % (1 + count / LEAST_GROWING) == 0)
        {
            let part = |k: usize| share((k as f64 + 0.5) / count as f64);
            let shares: Vec<f64> = (0..count).map(part).collect();
            let froms = (0..PARTS).filter(|from| from + count <= self.last());
            all.extend(froms.map(|from| (gains.of(from, &shares), [from, from + count])));
        }
        self.starts(all)
    }

    /// The windows that explain most, apart from each other \[s\].
    fn starts(&self, all: Vec<(f64, [usize; 2])>) -> Vec<[f64; 2]> {
        let time = |k: usize| self.times.begins + self.part * k as f64;
        let best = starts(all, self.times.choices, are_apart).into_iter();
        best.map(|window| window.map(time)).collect()
    }

    /// The last part at which a window may end: it may go on over the end of a period.
    fn last(&self) -> usize {
        if self.times.period > 0.0 { 2 * PARTS } else { PARTS }
    }
}

/// Whether two windows have less than half of the shorter one in common.
fn are_apart([a, b]: [usize; 2], [c, d]: [usize; 2]) -> bool {
    2 * b.min(d).saturating_sub(a.max(c)) <= (b - a).min(d - c)
}

/// The part of a window at which a share that grows from it to the middle is a half.
fn half_of(share: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..HALVED {
        let x = 0.5 * (low + high);
        if share(x) < 0.5 { low = x } else { high = x }
    }
    0.5 * (low + high)
}

/// The first and the last time of records \[s\].
fn range(records: &[Record<'_>]) -> [f64; 2] {
    let times = || records.iter().flat_map(|record| &record.motion.t).copied();
    [times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max)]
}

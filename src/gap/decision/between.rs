//! How much an effect differs from log to log.

use super::found::may_be_in_baseline;
use super::search::Search;
use crate::gap::data::RecordKind;
use crate::gap::posterior::{Fit, Gains};

/// Deviations by which member `number` of a fit differs between the logs of today and the baseline, or from
/// 0, where it differs as much from log to log as the logs show; `None` where one log shows nothing of that,
/// and for what acts at times.
pub(super) fn beyond_spread(
    search: &Search<'_>,
    (fit, gains): (&Fit, &Gains<'_>),
    number: usize,
) -> Option<f64> {
    let piece = &fit.hypothesis.members[number].piece;
    if !may_be_in_baseline(piece.effect) {
        return None;
    }
    let records = search.logs(true);
    let everywhere = piece.reshaped(search.design, records, &piece.shape, true);
    let factors = fit.factors_of(number);
    let of_kind = |kind: RecordKind| -> Vec<[f64; 2]> {
        let all = search.records.iter().enumerate().filter(|(_, record)| record.kind == kind);
        let of = |record| gains.factor(&everywhere.in_record(search.design, record, &factors));
        all.filter_map(|(record, _)| of(record)).filter(|[_, sd]| *sd < SHOWS).collect()
    };
    beyond(&of_kind(RecordKind::Mean), &of_kind(RecordKind::Before))
}

/// The same from the differences of single logs from what the fit says, over the size of the effect, with
/// their deviations.
fn beyond(now: &[[f64; 2]], before: &[[f64; 2]]) -> Option<f64> {
    // The effect is fitted to the mean of the logs of today; in the baseline it is 0.
    let known = now.len().saturating_sub(1) + before.len();
    if known == 0 {
        return None;
    }
    let mean = now.iter().map(|[off, _]| off).sum::<f64>() / now.len().max(1) as f64;
    let square = |off: f64, sd: f64| off * off - sd * sd;
    let of_now =
        now.iter().map(|[off, sd]| square(off - mean, if now.len() > 1 { *sd } else { 0.0 }));
    let all = of_now.chain(before.iter().map(|[off, sd]| square(*off, *sd)));
    let spread = all.sum::<f64>().max(0.0) / known as f64;
    let of_baseline = if before.is_empty() { 0.0 } else { 1.0 / before.len() as f64 };
    let share = 1.0 / now.len().max(1) as f64 + of_baseline;
    Some((spread * share).sqrt().recip().min(MOST))
}

/// Largest deviation of the size of an effect in a log that shows something of it, over the size.
const SHOWS: f64 = 0.5;
/// Deviations that are not told apart from more.
const MOST: f64 = 1e3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_that_differs_from_log_to_log_is_no_change() {
        let steady = [[0.05, 0.1], [-0.08, 0.1]];
        assert_eq!(beyond(&steady, &steady), Some(MOST));
        assert!(beyond(&[[0.6, 0.1], [-0.6, 0.1]], &steady).is_some_and(|x| x < 3.0));
        assert!(beyond(&steady, &[[0.9, 0.1]]).is_some_and(|x| x < 3.0));
        assert!(beyond(&[[0.0, 0.1]], &[]).is_none());
    }
}

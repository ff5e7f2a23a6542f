//! Rows whose time contradicts that of the other rows.

use super::uniform::median_step;

/// Share of rows with repeated times from which on the clock is taken as coarse.
const COARSE: f64 = 0.1;

/// For each row with a time \[s\] that can't be used, the reason; the times of the others ascend.
/// `same` tells whether two rows have the same values.
pub(super) fn disordered(t: &[f64], same: impl Fn(usize, usize) -> bool) -> Vec<Option<String>> {
    let mut why = vec![None; t.len()];
    repeated(t, same, &mut why);
    let rows: Vec<usize> = (0..t.len()).filter(|row| why[*row].is_none()).collect();
    backward(t, &rows, &mut why);
    why
}

/// Marks rows with the time of the row before. Nothing tells which of two rows with different values
/// has the right time, so that neither can be used. Of a coarse clock's rows the first one of each
/// time is used.
fn repeated(t: &[f64], same: impl Fn(usize, usize) -> bool, why: &mut [Option<String>]) {
    let rows: Vec<usize> = (0..t.len()).collect();
    let groups = || rows.chunk_by(|a, b| t[*a] == t[*b]).filter(|group| group.len() > 1);
    let differs = |group: &&[usize]| group[1..].iter().any(|row| !same(group[0], *row));
    let different: usize = groups().filter(differs).map(<[usize]>::len).sum();
    let is_coarse = different as f64 > COARSE * t.len() as f64;
    for group in groups() {
        let time = t[group[0]];
        if is_coarse || !differs(&group) {
            for row in &group[1..] {
                why[*row] = Some(format!("the time {time} s is there twice"));
            }
        } else {
            for row in group {
                let text = format!("the time {time} s is there twice, with different values");
                why[*row] = Some(text);
            }
        }
    }
}

/// Marks the fewest rows such that the times of the others ascend: those that leap ahead, or those
/// that go back.
fn backward(t: &[f64], rows: &[usize], why: &mut [Option<String>]) {
    let mut kept: Vec<usize> = Vec::with_capacity(rows.len());
    let times: Vec<f64> = rows.iter().map(|row| t[*row]).collect();
    let usual = median_step(&times);
    // Deviation of the intervals from multiples of the usual one.
    let uneven = |times: &[f64]| -> f64 {
        let off = |pair: &[f64]| ((pair[1] - pair[0]) / usual).abs();
        times.windows(2).map(off).map(|steps| (steps - steps.round()).abs()).sum()
    };
    let mut at = 0;
    while let Some(&row) = rows.get(at) {
        let Some(&last) = kept.last().filter(|last| t[**last] >= t[row]) else {
            kept.push(row);
            at += 1;
            continue;
        };
        let before = kept.partition_point(|other| t[*other] < t[row]);
        let ahead = kept.len() - before;
        let behind = rows[at..].iter().take(ahead + 1).take_while(|other| t[**other] <= t[last]);
        let behind = behind.count();
        let begin = before.checked_sub(1).map(|of| t[kept[of]]);
        let end = rows.get(at + behind).map(|next| t[*next]);
        let with = |middle: Vec<f64>| {
            uneven(&begin.into_iter().chain(middle).chain(end).collect::<Vec<f64>>())
        };
        let ahead_is_worse = || {
            let [leapt, returned] = [&kept[before..], &rows[at..at + behind]]
                .map(|part| with(part.iter().map(|row| t[*row]).collect()));
            leapt > returned + f64::EPSILON.sqrt()
        };
        if ahead < behind || (ahead == behind && ahead_is_worse()) {
            for leapt in kept.drain(before..) {
                let text =
                    format!("the time leaps to {} s, then goes back to {} s", t[leapt], t[row]);
                why[leapt] = Some(text);
            }
        } else {
            for returned in &rows[at..at + behind] {
                let text = format!("the time goes back from {} s to {} s", t[last], t[*returned]);
                why[*returned] = Some(text);
            }
            at += behind;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows that can't be used; all rows differ.
    fn unused(t: &[f64]) -> Vec<usize> {
        let why = disordered(t, |_, _| false);
        (0..t.len()).filter(|row| why[*row].is_some()).collect()
    }

    #[test]
    fn the_fewest_rows_are_left_out() {
        // A row goes back, or leaps ahead; the first one; two rows change places.
        assert_eq!(unused(&[0.0, 1.0, 2.0, 0.5, 4.0]), [3]);
        assert_eq!(unused(&[0.0, 1.0, 9.5, 3.0, 4.0, 5.0, 6.0]), [2]);
        assert_eq!(unused(&[99.0, 1.0, 2.0, 3.0, 4.0]), [0]);
        assert_eq!(unused(&[0.0, 1.0, 3.0, 2.0, 4.0, 5.0]), [3]);
        // A small leap: only even intervals tell which row is wrong.
        assert_eq!(unused(&[0.0, 1.0, 2.0, 4.5, 4.0, 5.0]), [3]);
        assert_eq!(unused(&[0.0, 1.0, 2.0, 3.0, 2.5, 5.0]), [4]);
        // A second recording.
        assert_eq!(unused(&[0.0, 1.0, 2.0, 0.0, 1.0, 2.0]), [3, 4, 5]);
    }

    #[test]
    fn rows_of_one_time_are_left_out_unless_they_are_the_same() {
        let mut t: Vec<f64> = (0..40).map(f64::from).collect();
        t[7] = 8.0;
        assert_eq!(unused(&t), [7, 8]);
        let why = disordered(&t, |_, _| true);
        assert_eq!(why.iter().position(Option::is_some), Some(8));
        // A clock with three rows to a tick.
        let coarse: Vec<f64> = (0..30).map(|row| f64::from(row / 3)).collect();
        assert_eq!(unused(&coarse).len(), 20);
    }
}

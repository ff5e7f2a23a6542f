//! Where searches for windows and orders begin.

/// Starts from which the best one is looked for.
const STARTS: usize = 2;
/// Least gain of a start, beside that of the best of so many of noise \[nats\].
const LEAST: f64 = 4.0;

/// Those of `choices` that gain most \[nats\], apart from each other.
pub(super) fn starts<T: Copy>(
    mut all: Vec<(f64, T)>,
    choices: usize,
    are_apart: impl Fn(T, T) -> bool,
) -> Vec<T> {
    all.retain(|(gain, _)| *gain > LEAST + (choices as f64).ln());
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best: Vec<T> = Vec::new();
    for (_, next) in all {
        if best.len() < STARTS && best.iter().all(|known| are_apart(*known, next)) {
            best.push(next);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_ones_apart_from_each_other_are_taken() {
        let all = vec![(20.0, 1.0), (30.0, 5.0), (29.0, 5.1), (25.0, 9.0), (4.1, 20.0)];
        let are_apart = |a: f64, b: f64| (a - b).abs() > 1.0;
        assert_eq!(starts(all.clone(), 1, are_apart), [5.0, 9.0]);
        // Of many choices the best one gains as much by noise.
        assert!(starts(all, usize::MAX, are_apart).is_empty());
    }
}

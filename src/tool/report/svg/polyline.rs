//! Reduces curves to the visible points.

use std::fmt::Write;

/// Maximum number of points of a curve.
pub const MAX_POINTS: usize = 400;
/// Invisible distance, px.
const INVISIBLE: f64 = 0.15;

/// At most [`MAX_POINTS`] points (px) of a curve, ends included. Every omitted point lies within a
/// fraction of a pixel of the drawn curve, or within more if the number requires it.
pub fn simplify(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut tolerance = INVISIBLE;
    loop {
        let kept = kept(points, tolerance);
        if kept.len() <= MAX_POINTS {
            return kept;
        }
        tolerance *= 1.5;
    }
}

/// The Ramer–Douglas–Peucker algorithm, iterative.
fn kept(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[last] = true;
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let mut worst = (tolerance, None);
        for i in from + 1..to {
            let d = distance(points[i], points[from], points[to]);
            if d > worst.0 {
                worst = (d, Some(i));
            }
        }
        if let (_, Some(i)) = worst {
            keep[i] = true;
            open.push((from, i));
            open.push((i, to));
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// Distance of `p` from the segment between `a` and `b`.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let (px, py) = (p[0] - a[0], p[1] - a[1]);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (px - share * dx).hypot(py - share * dy)
}

/// The value of the attribute `points`.
pub fn points(points: &[[f64; 2]]) -> String {
    let mut out = String::with_capacity(12 * points.len());
    for [x, y] in points {
        let space = if out.is_empty() { "" } else { " " };
        let _ = write!(out, "{space}{x:.1},{y:.1}");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of the distances in this test, px.
    const ROUNDING: f64 = 1e-9;

    fn wave(n: usize, amplitude: f64) -> Vec<[f64; 2]> {
        (0..n).map(|i| [i as f64 * 0.2, amplitude * (i as f64 * 0.02).sin()]).collect()
    }

    #[test]
    fn what_is_left_out_cannot_be_seen() {
        let all = wave(2000, 80.0);
        let few = simplify(&all);
        assert!(few.len() < 200, "{}", few.len());
        for p in &all {
            let nearest = few
                .windows(2)
                .map(|pair| distance(*p, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= INVISIBLE + ROUNDING, "{p:?} is {nearest} px away");
        }
        assert_eq!((few.first(), few.last()), (all.first(), all.last()));
    }

    #[test]
    fn noise_is_cut_to_the_largest_number() {
        let noise: Vec<[f64; 2]> =
            (0..5000).map(|i| [f64::from(i), f64::from((i * 7919) % 101)]).collect();
        assert!(simplify(&noise).len() <= MAX_POINTS);
    }

    #[test]
    fn short_curves_stay() {
        assert!(simplify(&[]).is_empty());
        assert_eq!(simplify(&[[1.0, 2.0]]), [[1.0, 2.0]]);
        assert_eq!(points(&[[1.0, 2.0], [3.26, 4.0]]), "1.0,2.0 3.3,4.0");
    }
}

//! A line segment with a radius.

use nalgebra::{Point3, Vector3};

/// All points within a radius of a line segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// One end of the segment \[m\].
    pub from: Point3<f64>,
    /// Other end of the segment \[m\].
    pub to: Point3<f64>,
    /// Radius \[m\].
    pub radius: f64,
}

impl Capsule {
    /// The point of the segment at a share of its length, 0 to 1.
    #[must_use]
    pub fn at(&self, share: f64) -> Point3<f64> {
        self.from + self.along() * share
    }

    /// Length of the segment \[m\].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.along().norm()
    }

    fn along(&self) -> Vector3<f64> {
        self.to - self.from
    }

    /// The nearest points of two segments. C. Ericson, "Real-time collision detection", 2005,
    /// section 5.1.9.
    #[must_use]
    pub fn nearest_points(&self, other: &Capsule) -> [Point3<f64>; 2] {
        let (d1, d2, r) = (self.along(), other.along(), self.from - other.from);
        let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r));
        let (b, c) = (d1.dot(&d2), d1.dot(&r));
        let share = |of: f64, length: f64| {
            if length > 0.0 { (of / length).clamp(0.0, 1.0) } else { 0.0 }
        };
        let s = share(b * f - c * e, a * e - b * b);
        let t = if e > 0.0 { (b * s + f) / e } else { 0.0 };
        let (s, t) = if t < 0.0 {
            (share(-c, a), 0.0)
        } else if t > 1.0 {
            (share(b - c, a), 1.0)
        } else {
            (s, t)
        };
        // If the other segment is a point, take the nearest point of this one.
        let s = if e > 0.0 { s } else { share(-c, a) };
        [self.at(s), other.at(t)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance of a distance from a grid of points on both segments \[m\].
    const GRID: f64 = 0.01;

    #[test]
    fn nearest_points_are_nearer_than_all_others() {
        let mut random = fastrand::Rng::with_seed(3);
        for case in 0..200 {
            let mut point = || Point3::new(random.f64(), random.f64(), random.f64());
            let one = Capsule { from: point(), to: point(), radius: 0.0 };
            let mut other = Capsule { from: point(), to: point(), radius: 0.0 };
            if case % 10 == 0 {
                other.to = other.from;
            }
            let least = (0..=200)
                .flat_map(|i| (0..=200).map(move |k| (i, k)))
                .map(|(i, k)| one.at(f64::from(i) / 200.0) - other.at(f64::from(k) / 200.0))
                .map(|apart| apart.norm())
                .fold(f64::INFINITY, f64::min);
            let [a, b] = one.nearest_points(&other);
            let found = (a - b).norm();
            assert!(found <= least + 1e-12 && least - found < GRID, "{found} {least}");
        }
    }
}

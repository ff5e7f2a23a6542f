//! What an arm has to keep clear of.

use nalgebra::{Isometry3, Point3, Vector3};

use super::capsule::Capsule;

/// Steps of the search along a line: the golden section leaves 10⁻¹⁰ of it.
const STEPS: usize = 48;

/// Share of a line at which the faces on either side of a point are told apart.
const BESIDE: f64 = 1e-6;

/// A half space that every point of arm and tool stays in: n · x ≥ d, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit vector into the half space.
    pub normal: Vector3<f64>,
    /// Distance of the plane from the base frame's origin along it \[m\].
    pub distance: f64,
}

/// A box that no point of arm and tool enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeepOut {
    /// Its middle and axes in the base frame.
    pub pose: Isometry3<f64>,
    /// Half its lengths \[m\].
    pub half: Vector3<f64>,
}

/// Either of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// What lies beyond a plane.
    Plane(Plane),
    /// A box.
    KeepOut(KeepOut),
}

/// A point of a capsule's line that is nearest to an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Witness {
    /// Distance from the obstacle, negative inside \[m\].
    pub(super) distance: f64,
    /// The point.
    pub(super) point: Point3<f64>,
    /// Change of the distance with the point.
    pub(super) away: Vector3<f64>,
}

impl KeepOut {
    /// A box along the axes of the base frame between two corners \[m\].
    #[must_use]
    pub fn between(one: Point3<f64>, other: Point3<f64>) -> KeepOut {
        let middle = nalgebra::center(&one, &other);
        KeepOut {
            pose: Isometry3::from_parts(middle.into(), nalgebra::UnitQuaternion::identity()),
            half: (other - one).abs() * 0.5,
        }
    }

    /// Distance of a point, negative inside, and the unit vector away from the box.
    fn of_point(&self, point: &Point3<f64>) -> (f64, Vector3<f64>) {
        let p = self.pose.inverse_transform_point(point).coords;
        let beyond = p.abs() - self.half;
        let outside = beyond.map(|x| x.max(0.0));
        let distance = outside.norm();
        let sign = p.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
        let (distance, away) = if distance > 0.0 {
            (distance, outside.component_mul(&sign) / distance)
        } else {
            let axis = beyond.imax();
            let mut away = Vector3::zeros();
            away[axis] = sign[axis];
            (beyond[axis], away)
        };
        (distance, self.pose.rotation * away)
    }
}

impl KeepOut {
    /// Where along a capsule's line the distance is least: that of a convex body is convex
    /// there, also inside.
    fn nearest_share(&self, capsule: &Capsule) -> f64 {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let of = |share: f64| self.of_point(&capsule.at(share)).0;
        let [mut low, mut high] = [0.0, 1.0];
        let mut inner = [1.0 - golden, golden];
        let mut values = inner.map(of);
        for _ in 0..STEPS {
            if values[0] < values[1] {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                values = [of(inner[0]), values[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                values = [values[1], of(inner[1])];
            }
        }
        let ends = [0.0, 0.5 * (low + high), 1.0].into_iter();
        ends.min_by(|a, b| of(*a).total_cmp(&of(*b))).unwrap_or(0.0)
    }
}

impl Obstacle {
    /// Distance of a capsule's surface, negative where they overlap \[m\].
    #[must_use]
    pub fn room(&self, capsule: &Capsule) -> f64 {
        self.witness(capsule).distance - capsule.radius
    }

    /// The point of a capsule's line that is nearest.
    pub(super) fn witness(&self, capsule: &Capsule) -> Witness {
        match self {
            Obstacle::Plane(plane) => {
                let height = |point: &Point3<f64>| plane.normal.dot(&point.coords) - plane.distance;
                let (from, to) = (height(&capsule.from), height(&capsule.to));
                let (distance, point) =
                    if from < to { (from, capsule.from) } else { (to, capsule.to) };
                Witness { distance, point, away: plane.normal }
            }
            Obstacle::KeepOut(keep_out) => {
                let share = keep_out.nearest_share(capsule);
                let point = capsule.at(share);
                let (distance, mut away) = keep_out.of_point(&point);
                // Deep inside two faces may be equally near, one on either side of the point:
                // the distance changes by the mean of both that is level along the line.
                let along = capsule.to - capsule.from;
                let beside = [share - BESIDE, share + BESIDE].map(|share| {
                    let (_, away) = keep_out.of_point(&capsule.at(share.clamp(0.0, 1.0)));
                    (away, away.dot(&along))
                });
                let [(before, falling), (after, rising)] = beside;
                if falling < 0.0 && rising > 0.0 {
                    away = (before * rising - after * falling) / (rising - falling);
                }
                Witness { distance, point, away }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Translation3, UnitQuaternion};

    use super::*;

    /// Of a distance \[m\], against points on the line.
    const GRID: f64 = 0.01;
    /// Of two ways to one number.
    const SAME: f64 = 1e-9;

    /// The nearest point of a box by clamping; inside, the way out through the nearest face.
    fn brute(keep_out: &KeepOut, point: &Point3<f64>) -> f64 {
        let p = keep_out.pose.inverse_transform_point(point);
        let h = keep_out.half;
        let inside = (0..3).all(|k| p[k].abs() < h[k]);
        if inside {
            return -(0..3).map(|k| h[k] - p[k].abs()).fold(f64::INFINITY, f64::min);
        }
        let nearest = Point3::from(p.coords.zip_map(&h, |x, h| x.clamp(-h, h)));
        (p - nearest).norm()
    }

    #[test]
    fn room_to_a_box_is_the_least_of_points_on_the_line() {
        let mut random = fastrand::Rng::with_seed(4);
        for _ in 0..300 {
            let mut number = || 2.0 * random.f64() - 1.0;
            let mut vector = || Vector3::new(number(), number(), number());
            let keep_out = KeepOut {
                pose: Isometry3::from_parts(
                    Translation3::from(vector()),
                    UnitQuaternion::from_scaled_axis(vector() * 3.0),
                ),
                half: vector().abs() * 0.5,
            };
            let capsule = Capsule { from: vector().into(), to: vector().into(), radius: 0.05 };
            let least = (0..=400)
                .map(|i| brute(&keep_out, &capsule.at(f64::from(i) / 400.0)))
                .fold(f64::INFINITY, f64::min);
            let found = Obstacle::KeepOut(keep_out).room(&capsule) + capsule.radius;
            assert!(found <= least + SAME && least - found < GRID, "{found} {least}");
            let at = Obstacle::KeepOut(keep_out).witness(&capsule);
            assert!((brute(&keep_out, &at.point) - at.distance).abs() < SAME);
        }
    }
}

//! Obstacles of an arm.

use nalgebra::{Isometry3, Point3, Vector3};

use super::capsule::Capsule;

/// Steps of the golden-section search, to 10⁻¹⁰ of the length.
const STEPS: usize = 48;

/// A half space that contains all points of arm and tool: n · x ≥ d, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit vector into the half space.
    pub normal: Vector3<f64>,
    /// Distance of the plane from the origin of the base frame along the normal \[m\].
    pub distance: f64,
}

/// A box that contains no point of arm and tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeepOut {
    /// Its centre and axes in the base frame.
    pub pose: Isometry3<f64>,
    /// Half of its lengths \[m\].
    pub half: Vector3<f64>,
}

/// A plane or a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// The space beyond a plane.
    Plane(Plane),
    /// A box.
    KeepOut(KeepOut),
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

    /// Distance of a point \[m\], negative inside.
    fn distance(&self, point: &Point3<f64>) -> f64 {
        let p = self.pose.inverse_transform_point(point).coords;
        let beyond = p.abs() - self.half;
        let outside = beyond.map(|x| x.max(0.0)).norm();
        if outside > 0.0 { outside } else { beyond.max() }
    }

    /// Least distance of a capsule's segment \[m\] by golden-section search: the signed distance
    /// from a convex body is convex along a line.
    fn line_distance(&self, capsule: &Capsule) -> f64 {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let at = |share: f64| self.distance(&capsule.at(share));
        let [mut low, mut high] = [0.0, 1.0];
        let mut inner = [1.0 - golden, golden];
        let mut values = inner.map(at);
        for _ in 0..STEPS {
            if values[0] < values[1] {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                values = [at(inner[0]), values[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                values = [values[1], at(inner[1])];
            }
        }
        [0.0, 0.5 * (low + high), 1.0].map(at).into_iter().fold(f64::INFINITY, f64::min)
    }
}

impl Obstacle {
    /// Distance of the surface of a capsule \[m\], negative if they overlap.
    #[must_use]
    pub fn room(&self, capsule: &Capsule) -> f64 {
        let distance = match self {
            Obstacle::Plane(plane) => {
                let height = |point: &Point3<f64>| plane.normal.dot(&point.coords) - plane.distance;
                height(&capsule.from).min(height(&capsule.to))
            }
            Obstacle::KeepOut(keep_out) => keep_out.line_distance(capsule),
        };
        distance - capsule.radius
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Translation3, UnitQuaternion};

    use super::*;

    /// Tolerance of a distance from a grid of points on the segment \[m\].
    const GRID: f64 = 0.01;
    /// Tolerance of two exact computations.
    const SAME: f64 = 1e-9;

    /// The nearest point of a box by clamping; inside the box, through the nearest face.
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
        }
    }
}

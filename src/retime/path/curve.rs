//! Curves of the TCP pose: lines, arcs, and rounded corners between lines.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::blend;

/// A pose along a curve with its first and second derivative by the parameter.
#[derive(Clone, Copy, Debug)]
pub struct CurvePoint {
    /// TCP pose, base frame, m.
    pub pose: Isometry3<f64>,
    /// dp/dx.
    pub linear: Vector3<f64>,
    /// Angular velocity per parameter, base frame.
    pub angular: Vector3<f64>,
    /// d²p/dx².
    pub linear_rate: Vector3<f64>,
    /// Derivative of `angular`.
    pub angular_rate: Vector3<f64>,
}

/// A curve of the TCP pose, parametrised over [0, length].
#[derive(Clone, Debug)]
pub enum Curve {
    /// Straight line with a uniform rotation.
    Line {
        /// Pose at 0.
        start: Isometry3<f64>,
        /// dp/dx.
        direction: Vector3<f64>,
        /// Rotation vector per parameter, base frame.
        turn: Vector3<f64>,
        /// Length in the parameter.
        length: f64,
    },
    /// Circular arc with a uniform rotation.
    Arc {
        /// Orientation at 0.
        start: UnitQuaternion<f64>,
        /// Centre, m.
        center: Vector3<f64>,
        /// Vector from the centre to the start, m.
        radius: Vector3<f64>,
        /// Unit vector of the arc axis.
        normal: Vector3<f64>,
        /// Angle of the arc per parameter, rad.
        rate: f64,
        /// Rotation vector of the tool per parameter, base frame.
        turn: Vector3<f64>,
        /// Length in the parameter.
        length: f64,
    },
    /// A rounded corner on −half … half, shifted to start at 0.
    Corner {
        /// Pose of the programmed point.
        corner: Isometry3<f64>,
        /// dp/dx before and after the corner.
        directions: [Vector3<f64>; 2],
        /// Rotation vector per parameter before and after, in the corner frame.
        turns: [Vector3<f64>; 2],
        /// Half of the zone length in the parameter.
        half: f64,
    },
}

/// Step for the derivative of an angular velocity.
const ANGULAR_STEP: f64 = 1e-5;

impl Curve {
    /// Length in the parameter.
    pub fn length(&self) -> f64 {
        match self {
            Curve::Line { length, .. } | Curve::Arc { length, .. } => *length,
            Curve::Corner { half, .. } => 2.0 * half,
        }
    }

    /// Pose and derivatives at x ∈ [0, length].
    pub fn eval(&self, x: f64) -> CurvePoint {
        match self {
            Curve::Line { start, direction, turn, .. } => {
                let rotation = UnitQuaternion::from_scaled_axis(turn * x) * start.rotation;
                let position = start.translation.vector + direction * x;
                CurvePoint {
                    pose: Isometry3::from_parts(Translation3::from(position), rotation),
                    linear: *direction,
                    angular: *turn,
                    linear_rate: Vector3::zeros(),
                    angular_rate: Vector3::zeros(),
                }
            }
            Curve::Arc { start, center, radius, normal, rate, turn, .. } => {
                let arm = UnitQuaternion::from_scaled_axis(normal * (rate * x)) * radius;
                let spin = normal * *rate;
                let rotation = UnitQuaternion::from_scaled_axis(turn * x) * start;
                CurvePoint {
                    pose: Isometry3::from_parts(Translation3::from(center + arm), rotation),
                    linear: spin.cross(&arm),
                    angular: *turn,
                    linear_rate: spin.cross(&spin.cross(&arm)),
                    angular_rate: Vector3::zeros(),
                }
            }
            Curve::Corner { corner, directions: [d1, d2], turns, half } => {
                let z = x / half - 1.0;
                let [integral, weight, slope] = blend::turn(z);
                let along = *half * z;
                let position =
                    corner.translation.vector + d1 * along + (d2 - d1) * (half * integral);
                let angular_rate = (corner_angular(turns, *half, z + ANGULAR_STEP)
                    - corner_angular(turns, *half, z - ANGULAR_STEP))
                    / (2.0 * ANGULAR_STEP * half);
                let turned = UnitQuaternion::from_scaled_axis(corner_vector(turns, *half, z));
                let rotation = corner.rotation * turned;
                CurvePoint {
                    pose: Isometry3::from_parts(Translation3::from(position), rotation),
                    linear: d1 + (d2 - d1) * weight,
                    angular: corner.rotation * corner_angular(turns, *half, z),
                    linear_rate: (d2 - d1) * (slope / half),
                    angular_rate: corner.rotation * angular_rate,
                }
            }
        }
    }
}

/// φ(z): the rotation vector relative to the corner, in the corner frame.
fn corner_vector(turns: &[Vector3<f64>; 2], half: f64, z: f64) -> Vector3<f64> {
    let [integral, _, _] = blend::turn(z);
    turns[0] * (half * z) + (turns[1] - turns[0]) * (half * integral)
}

/// Angular velocity per parameter in the corner frame: left Jacobian of SO(3) at φ times dφ/dx.
fn corner_angular(turns: &[Vector3<f64>; 2], half: f64, z: f64) -> Vector3<f64> {
    let phi = corner_vector(turns, half, z);
    let [_, weight, _] = blend::turn(z);
    let rate = turns[0] + (turns[1] - turns[0]) * weight;
    let angle2 = phi.norm_squared();
    // Series below 1e-4 rad², where the closed form is inaccurate.
    let (a, b) = if angle2 < 1e-4 {
        (0.5 - angle2 / 24.0, 1.0 / 6.0 - angle2 / 120.0)
    } else {
        let angle = angle2.sqrt();
        ((1.0 - angle.cos()) / angle2, (angle - angle.sin()) / (angle2 * angle))
    };
    let cross = phi.cross(&rate);
    rate + cross * a + phi.cross(&cross) * b
}

/// Smallest ratio of twice the triangle area to the squared side; below it the radius is undefined.
const FLAT: f64 = 1e-6;

/// The circle through three points: centre, unit normal and angle from the first to the last point
/// through the second. `None` if they lie on a line.
pub fn circle(
    start: &Vector3<f64>,
    via: &Vector3<f64>,
    end: &Vector3<f64>,
) -> Option<(Vector3<f64>, Vector3<f64>, f64)> {
    let a = via - start;
    let b = end - start;
    let normal = a.cross(&b);
    if normal.norm() < FLAT * a.norm().max(b.norm()).powi(2) || normal.norm() == 0.0 {
        return None;
    }
    let n2 = normal.norm_squared();
    let offset =
        (b.norm_squared() * normal.cross(&a) - a.norm_squared() * normal.cross(&b)) / (2.0 * n2);
    let center = start + offset;
    let unit = normal.normalize();
    let radius = start - center;
    let angle_to = |point: &Vector3<f64>| {
        let arm = point - center;
        let angle = unit.dot(&radius.cross(&arm)).atan2(radius.dot(&arm));
        if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
    };
    let (to_via, to_end) = (angle_to(via), angle_to(end));
    // About the normal of start→via × start→end the via point always comes first.
    if to_via <= to_end { Some((center, unit, to_end)) } else { None }
}

/// The rotation vector (base frame) of the shorter rotation between two orientations.
pub fn rotation_between(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> Vector3<f64> {
    // The logarithm uses the shorter of the two quaternions of a rotation.
    (to * from.inverse()).scaled_axis()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-6;
    const TOLERANCE: f64 = 1e-5;

    fn check(curve: &Curve) {
        let n = 17;
        for i in 1..n {
            let x = curve.length() * f64::from(i) / f64::from(n);
            let (a, b, at) = (curve.eval(x - STEP), curve.eval(x + STEP), curve.eval(x));
            let linear = (b.pose.translation.vector - a.pose.translation.vector) / (2.0 * STEP);
            assert!((linear - at.linear).norm() < TOLERANCE, "dp at {x}");
            let angular = rotation_between(&a.pose.rotation, &b.pose.rotation) / (2.0 * STEP);
            assert!((angular - at.angular).norm() < TOLERANCE, "ω at {x}");
            let rate = (b.linear - a.linear) / (2.0 * STEP);
            assert!((rate - at.linear_rate).norm() < 1e-3 * (1.0 + rate.norm()), "d²p at {x}");
            let rate = (b.angular - a.angular) / (2.0 * STEP);
            assert!((rate - at.angular_rate).norm() < 1e-3 * (1.0 + rate.norm()), "dω at {x}");
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let start = Isometry3::new(Vector3::new(0.6, 0.1, 0.4), Vector3::new(0.0, 3.0, 0.2));
        let turn = Vector3::new(0.4, -0.2, 0.9);
        check(&Curve::Line { start, direction: Vector3::x(), turn, length: 0.3 });
        check(&Curve::Arc {
            start: start.rotation,
            center: Vector3::new(0.5, 0.0, 0.4),
            radius: Vector3::new(0.1, 0.0, 0.0),
            normal: Vector3::z(),
            rate: 10.0,
            turn,
            length: 0.2,
        });
        check(&Curve::Corner {
            corner: start,
            directions: [Vector3::x(), Vector3::new(0.0, 0.6, 0.8)],
            turns: [turn, Vector3::new(-2.0, 1.0, 0.0)],
            half: 0.05,
        });
    }

    #[test]
    fn circle_passes_the_via_point_both_ways_round() {
        let at = |deg: f64| Vector3::new(deg.to_radians().cos(), deg.to_radians().sin(), 0.2);
        for (via, end, expected) in
            [(30.0, 90.0, 90.0), (200.0, 300.0, 300.0), (-30.0, -200.0, 200.0)]
        {
            let (center, normal, angle) = circle(&at(0.0), &at(via), &at(end)).expect("a circle");
            assert!((center - Vector3::new(0.0, 0.0, 0.2)).norm() < 1e-12);
            assert!((angle.to_degrees() - expected).abs() < 1e-9, "{via} {end} {angle}");
            let turned = UnitQuaternion::from_scaled_axis(normal * angle) * (at(0.0) - center);
            assert!((turned + center - at(end)).norm() < 1e-12);
        }
        assert!(circle(&at(0.0), &((at(0.0) + at(90.0)) / 2.0), &at(90.0)).is_none());
    }
}

//! The limits of a stream along its path without steps.
//!
//! At a corner the ceilings and tolerances of two movements meet. With a step there, a limit would
//! jump when a sample passes the corner, and no derivative predicts that. Each limit rises from the
//! smaller value at a bounded rate, so that a smoothed limit is never above the limit itself.

use nalgebra::SVector;

use crate::retime::path::joint_path::{DOF, Joints};

/// Displacement of two poses (m) over the difference of their orientations, as a distance (m).
pub(super) type Difference = SVector<f64, 7>;

/// Assumed TCP acceleration between two speed ceilings, m/s².
const EASING: f64 = 10.0;
/// Rise of a ceiling of a joint speed, rad/s per m.
const JOINT_RISE: f64 = 20.0;
/// Rise of a tolerance, m/m.
const WIDENING: f64 = 0.2;

/// Limits at the places of a corridor.
pub(super) struct Smoothed {
    tcp: Vec<f64>,
    joints: [Vec<f64>; DOF],
    tolerance: Vec<f64>,
    polygon: Vec<f64>,
}

/// A position between two places of a corridor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Located {
    /// The nearest place, and a neighbour.
    pub(super) place: usize,
    pub(super) next: usize,
    /// Position between them, 0 to 1.
    pub(super) share: f64,
    /// Distance from the path, m, and the vector from the path.
    pub(super) distance: f64,
    pub(super) offset: Difference,
    /// From the place to the neighbour.
    pub(super) along: Difference,
}

/// Derivatives of distance (m) and share of a [`Located`] by the joint angles, per rad.
#[derive(Clone, Debug, Default)]
pub(super) struct Slopes {
    pub(super) distance: Joints,
    pub(super) share: Joints,
}

impl Located {
    fn of(&self, values: &[f64]) -> f64 {
        values[self.place] + self.share * (values[self.next] - values[self.place])
    }

    /// The derivatives of `value` as a share of a limit from its own ones, `by` the joint angles and
    /// the joint speeds.
    fn share(&self, slopes: &Slopes, limits: &[f64], value: f64, by: [Joints; 2]) -> [Joints; 2] {
        let limit = self.of(limits);
        let rise = value / limit * (limits[self.next] - limits[self.place]);
        let [angle, speed] = by.map(|by| by.map(|slope| slope / limit));
        [std::array::from_fn(|j| angle[j] - rise * slopes.share[j] / limit), speed]
    }
}

impl Smoothed {
    /// The limits at the places with these distances `ways` (m) between them: speeds of the TCP
    /// (m/s) and the joints (rad/s), tolerances of the path and of the polygon (m).
    pub(super) fn new(
        ways: &[f64],
        tcp: Vec<f64>,
        joints: [Vec<f64>; DOF],
        tolerance: Vec<f64>,
        polygon: Vec<f64>,
    ) -> Smoothed {
        let widening = |from: f64, way: f64| from + WIDENING * way;
        Smoothed {
            tcp: risen(tcp, ways, |from, way| (from * from + 2.0 * EASING * way).sqrt()),
            joints: joints.map(|of| risen(of, ways, |from, way| from + JOINT_RISE * way)),
            tolerance: risen(tolerance, ways, widening),
            polygon: risen(polygon, ways, widening),
        }
    }

    /// Used shares of the TCP speed, of the joint speeds and of the distance from the path.
    pub(super) fn shares(&self, at: &Located, tcp: f64, qd: &Joints) -> [f64; 3] {
        let joint =
            |j: usize| if qd[j] == 0.0 { 0.0 } else { qd[j].abs() / at.of(&self.joints[j]) };
        let joints = (0..DOF).map(joint).fold(0.0, f64::max);
        [tcp / at.of(&self.tcp), joints, at.distance / at.of(&self.tolerance)]
    }

    /// The derivatives of [`shares`](Self::shares) by the joint angles and the joint speeds; `by`
    /// those of the TCP speed.
    pub(super) fn derivatives(
        &self,
        at: &Located,
        slopes: &Slopes,
        (tcp, by): (f64, [Joints; 2]),
        qd: &Joints,
    ) -> [[Joints; 2]; 3] {
        let used = |j: usize| qd[j].abs() / at.of(&self.joints[j]);
        let fastest = (0..DOF).fold(0, |a, b| if used(b) > used(a) { b } else { a });
        let mut by_speed = [0.0; DOF];
        by_speed[fastest] = qd[fastest].signum();
        let rest = [0.0; DOF];
        let speed = qd[fastest].abs();
        [
            at.share(slopes, &self.tcp, tcp, by),
            at.share(slopes, &self.joints[fastest], speed, [rest, by_speed]),
            at.share(slopes, &self.tolerance, at.distance, [slopes.distance, rest]),
        ]
    }

    /// Used share of the distance of the polygon from the path.
    pub(super) fn polygon_share(&self, at: &Located) -> f64 {
        at.distance / at.of(&self.polygon)
    }

    /// The derivatives of [`polygon_share`](Self::polygon_share) by the joint angles.
    pub(super) fn polygon_derivatives(&self, at: &Located, slopes: &Slopes) -> Joints {
        at.share(slopes, &self.polygon, at.distance, [slopes.distance, [0.0; DOF]])[0]
    }
}

/// The largest values below the given ones that rise no faster than `rise` says, which returns the
/// value after a way (m).
fn risen(mut values: Vec<f64>, ways: &[f64], rise: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    for (i, way) in ways.iter().enumerate() {
        values[i + 1] = values[i + 1].min(rise(values[i], *way));
    }
    for (i, way) in ways.iter().enumerate().rev() {
        values[i] = values[i].min(rise(values[i + 1], *way));
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUNDING: f64 = 1e-12;

    #[test]
    fn a_limit_rises_slowly_from_the_smaller_values_and_is_never_above() {
        let way = 0.002;
        let ways = [way; 9];
        let values = vec![5.0, 5.0, 5.0, 1.0, 1.0, 5.0, 5.0, 5.0, 1.004, 5.0];
        let smoothed = risen(values.clone(), &ways, |from, way| from + 1000.0 * way);
        for (smoothed, value) in smoothed.iter().zip(&values) {
            assert!(smoothed <= value);
        }
        for pair in smoothed.windows(2) {
            assert!((pair[1] - pair[0]).abs() <= 1000.0 * way + ROUNDING, "{smoothed:?}");
        }
        let least = [3, 4, 8];
        assert!(least.iter().all(|i| smoothed[*i] == values[*i]), "{smoothed:?}");
    }

    #[test]
    fn a_share_has_no_step_between_two_places() {
        let ways = [0.002; 2];
        let limits = Smoothed::new(
            &ways,
            vec![1.0, 1.0, 0.1],
            std::array::from_fn(|_| vec![2.0; 3]),
            vec![0.005, 0.005, 0.001],
            vec![0.005; 3],
        );
        // From the middle of the second stretch the nearest place is another one.
        let [offset, along] = [Difference::zeros(); 2];
        let at = |place, next, share| Located { place, next, share, distance: 5e-4, offset, along };
        let [before, after] =
            [at(1, 2, 0.5), at(2, 1, 0.5)].map(|at| limits.shares(&at, 0.05, &[0.1; DOF]));
        for (before, after) in before.iter().zip(after) {
            assert!((before - after).abs() < ROUNDING, "{before} {after}");
        }
        let slow = limits.shares(&at(2, 1, 0.0), 0.05, &[0.1; DOF]);
        assert!((slow[0] - 0.5).abs() < ROUNDING && (slow[2] - 0.5).abs() < ROUNDING, "{slow:?}");
    }
}

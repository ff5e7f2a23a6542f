//! Inverse kinematics of an arm whose axis 6 misses the intersection of axes 4 and 5, such as an
//! ABB CRB 15000.
//!
//! A given q6 determines the pose of link 5, hence the intersection, hence four arms in closed
//! form. Solutions are those with axis 4 at a right angle to axis 5: the zeros of a function of q6,
//! which are searched over a full turn.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Rotation3, UnitQuaternion, Vector3};

use crate::arm::robot::{Joint, Model, OffsetWrist};

use super::closed_form::{Arm, facings, forearm, to_joints};
use super::numeric::{add_if_new, refine};

/// Samples of q6 over a full turn.
const PLACES: u32 = 720;
/// Bisection steps to a zero or to an end of the reach.
const HALVINGS: u32 = 40;
/// Arms per wrist centre: two facings of axis 1 with two elbows each.
const ARMS: usize = 4;

/// The found solutions of the pose, each angle in (−π, π].
pub(super) fn solutions(
    model: &Model,
    wrist: &OffsetWrist,
    pose: &Isometry3<f64>,
) -> Vec<[f64; 6]> {
    let Some(search) = Search::new(model, wrist, pose) else { return Vec::new() };
    let places: Vec<Place> =
        (0..=PLACES + 1).map(|n| search.place(TAU * f64::from(n) / f64::from(PLACES))).collect();
    let mut found = Vec::new();
    let mut try_at = |q6: f64, which: usize| {
        let start = search.place(q6).arms[which].map(|(arm, _)| search.joints(&arm, q6));
        if let Some(q) = start.and_then(|start| refine(model, pose, &start)) {
            add_if_new(&mut found, &q);
        }
    };
    for which in 0..ARMS {
        let cos = |place: &Place| place.arms[which].map(|(_, cos)| cos);
        for pair in places.windows(2) {
            match (cos(&pair[0]), cos(&pair[1])) {
                (Some(a), Some(b)) if a * b <= 0.0 => {
                    try_at(search.zero(&pair[0], &pair[1], which), which);
                }
                (Some(_), None) => {
                    let end = search.last(&pair[0], &pair[1], which);
                    try_at(search.zero(&pair[0], &end, which), which);
                }
                (None, Some(_)) => {
                    let end = search.last(&pair[1], &pair[0], which);
                    try_at(search.zero(&pair[1], &end, which), which);
                }
                _ => {}
            }
        }
        // A double zero, or two zeros in one interval.
        for three in places.windows(3) {
            if let [Some(a), Some(b), Some(c)] = [cos(&three[0]), cos(&three[1]), cos(&three[2])]
                && a * b > 0.0
                && b * c > 0.0
                && b.abs() <= a.abs().min(c.abs())
            {
                // Beyond the minimum there are no zeros or two.
                let least = search.least(&three[0], &three[2], which, b.signum());
                try_at(search.zero(&three[0], &least, which), which);
                try_at(search.zero(&least, &three[2], which), which);
            }
        }
    }
    found
}

/// The reachable arms at one angle of axis 6.
struct Place {
    q6: f64,
    /// Each with the cosine between axes 4 and 5.
    arms: [Option<(Arm, f64)>; ARMS],
}

struct Search<'a> {
    model: &'a Model,
    wrist: &'a OffsetWrist,
    fifth: &'a Joint,
    sixth: &'a Joint,
    /// Pose of link 6.
    last: Isometry3<f64>,
}

impl<'a> Search<'a> {
    fn new(model: &'a Model, wrist: &'a OffsetWrist, pose: &Isometry3<f64>) -> Option<Self> {
        let [_, _, _, _, fifth, sixth] = model.kinematics.joints.as_slice() else { return None };
        let last = pose * model.kinematics.flange.inverse();
        Some(Search { model, wrist, fifth, sixth, last })
    }

    /// Pose of link 5.
    fn link_5(&self, q6: f64) -> Isometry3<f64> {
        let turn = Rotation3::from_matrix_unchecked(self.sixth.rotation_at(q6));
        let step = Isometry3::from_parts(
            self.sixth.translation.into(),
            UnitQuaternion::from_rotation_matrix(&turn),
        );
        self.last * step.inverse()
    }

    fn place(&self, q6: f64) -> Place {
        let link = self.link_5(q6);
        let axis = link.rotation * self.fifth.axis.into_inner();
        let centre = link * self.wrist.crossing;
        let mut arms = [None; ARMS];
        let facings = facings(&self.wrist.arm, &centre.translation.vector, 0.0);
        for (pair, facing) in arms.chunks_exact_mut(2).zip(facings) {
            for (to, arm) in pair.iter_mut().zip(facing.into_iter().flatten()) {
                *to = Some((arm, axis.dot(&(forearm(arm.theta) * Vector3::z()))));
            }
        }
        Place { q6, arms }
    }

    /// The joint angles of an arm with axes 4 and 5 nearly at a right angle.
    fn joints(&self, arm: &Arm, q6: f64) -> [f64; 6] {
        let opw = &self.wrist.arm;
        let link = self.link_5(q6);
        let into = forearm(arm.theta).inverse();
        let axis = into * (link.rotation * self.fifth.axis.into_inner()) * opw.signs[4];
        let theta4 = (-axis.x).atan2(axis.y);
        let about_axis_4 = Rotation3::from_axis_angle(&Vector3::z_axis(), theta4);
        let out = about_axis_4.inverse()
            * (into * (link.rotation * (self.wrist.crossing.rotation * Vector3::z())));
        let [theta1, theta2, theta3] = arm.theta;
        let theta = [theta1, theta2, theta3, theta4, out.x.atan2(out.z), 0.0];
        let mut q = to_joints(self.model, opw, theta);
        q[5] = q6;
        q
    }

    /// The zero of the cosine between two places, otherwise the better end.
    fn zero(&self, a: &Place, b: &Place, which: usize) -> f64 {
        let cos = |q6: f64| self.place(q6).arms[which].map_or(f64::NAN, |(_, cos)| cos);
        let (mut from, mut to) = (a.q6, b.q6);
        let (mut low, high) = (cos(from), cos(to));
        if low * high > 0.0 {
            return if low.abs() < high.abs() { from } else { to };
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            let value = cos(middle);
            if low * value <= 0.0 {
                to = middle;
            } else {
                (from, low) = (middle, value);
            }
        }
        0.5 * (from + to)
    }

    /// The last place towards `beyond` that an arm reaches.
    fn last(&self, inside: &Place, beyond: &Place, which: usize) -> Place {
        let (mut from, mut to) = (inside.q6, beyond.q6);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            if self.place(middle).arms[which].is_some() {
                from = middle;
            } else {
                to = middle;
            }
        }
        self.place(from)
    }

    /// The minimum of the cosine times `sign` between two places, by ternary search.
    fn least(&self, a: &Place, b: &Place, which: usize, sign: f64) -> Place {
        let size =
            |q6: f64| self.place(q6).arms[which].map_or(f64::INFINITY, |(_, cos)| sign * cos);
        let (mut from, mut to) = (a.q6, b.q6);
        for _ in 0..HALVINGS {
            let third = (to - from) / 3.0;
            if size(from + third) < size(to - third) {
                to -= third;
            } else {
                from += third;
            }
        }
        self.place(0.5 * (from + to))
    }
}

//! An external force.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::arm::dynamics::{Data, Load, rigid_bodies};
use crate::arm::robot::{GRAVITY, Link, Model};

use super::bodies::added as with_body;
use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Published, Role, Scope, Subject, bounded,
    free, linear, shaped,
};
use crate::arm::effects::motion::Motion;
use crate::arm::effects::scale::Scale;
use crate::arm::effects::window::{in_period, within};

pub(in crate::arm::effects) const CONTACT: Effect = Effect {
    id: "contact",
    channel: Channel::Torque,
    scope: Scope::Robot,
    subject: Subject::Body,
    nature: Nature::Law,
    acts: Acts::InWindow,
    variable: None,
    title: "A force from outside",
    law: "τ = −Jᵀ·force·min(1, sin πx/sin(π·rise)) on the flange, x from 0 to 1 from t_start_s to \
          t_end_s, repeated every period_s",
    source: "rigid bodies: docs/architecture.md",
    parameters: &[
        bounded("force", "N", "size of the force", [0.0, f64::INFINITY]),
        free("t_start_s", "s", "from"),
        free("t_end_s", "s", "to"),
        bounded("period_s", "s", "time after which it comes again; 0: never", [0.0, f64::INFINITY]),
        free("azimuth", "rad", "its direction about the vertical, from x"),
        free("elevation", "rad", "its direction above the horizontal"),
        bounded("rise", "1", "share of the window in which it grows; 0: at once", [0.0, 0.5]),
    ],
    coordinates: &[
        linear(usual),
        linear(usual),
        linear(usual),
        Coordinate { role: Role::Rise { most: 0.5, share: grown }, usual: |_| 0.0 },
        Coordinate { role: Role::Choice(|_| Vec::new()), usual: shaped },
        Coordinate { role: Role::Choice(|_| Vec::new()), usual: shaped },
        Coordinate { role: Role::Choice(|_| Vec::new()), usual: shaped },
    ],
    published: Some(SIZE_AND_DIRECTION),
    joints: |_| vec![0],
    brings: &[],
    confused: &["brake_drag"],
    inspect: "what the arm touches at these times",
    experiment: ["", "a dry run"],
    form: Form::Series(added),
};

fn usual(of: &Scale) -> f64 {
    GRAVITY * of.payload
}

/// Coordinates are the force components, the rise, then the window.
const SIZE_AND_DIRECTION: Published = Published {
    parameters: |x| {
        let flat = x[0].hypot(x[1]);
        vec![flat.hypot(x[2]), x[4], x[5], x[6], x[1].atan2(x[0]), x[2].atan2(flat), x[3]]
    },
    coordinates: |p| {
        let (sin, cos) = p[5].sin_cos();
        let (y, x) = p[4].sin_cos();
        vec![p[0] * cos * x, p[0] * cos * y, p[0] * sin, p[6], p[1], p[2], p[3]]
    },
};

fn added(motion: &Motion<'_>, _: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let n = motion.model.dof;
    let force = Vector3::new(values[0], values[1], values[2]);
    let mut series = vec![vec![0.0; motion.rows()]; n];
    let size = force.norm();
    if size > 0.0 {
        let pulled = pulled(motion.model, &force, size);
        let mut data = Data::new();
        let still = vec![0.0; n];
        for row in 0..motion.rows() {
            let share = share_of(motion.t[row], &values[3..]);
            if share == 0.0 {
                continue;
            }
            let [q, ..] = motion.state(row);
            let tau = rigid_bodies(&pulled, &mut data, &Load::none(), &q[..n], &still, &still);
            series.iter_mut().zip(tau).for_each(|(series, tau)| series[row] = share * tau);
        }
    }
    series.into_iter().enumerate().collect()
}

/// Acting share of the force at a time, with `window` = rise, start, end and period.
fn share_of(t: f64, window: &[f64]) -> f64 {
    let [rise, start, end, period] = window else { return 0.0 };
    if !within(t, *start, *end, *period) {
        return 0.0;
    }
    grown(*rise, (in_period(t, *period) - start) / (end - start))
}

/// Acting share of the force at a part of the window.
fn grown(rise: f64, x: f64) -> f64 {
    if rise > 0.0 { ((PI * x).sin() / (PI * rise).sin()).min(1.0) } else { 1.0 }
}

/// A massless arm with a mass at its flange, whose gravity is the force.
fn pulled(model: &Model, force: &Vector3<f64>, size: f64) -> Model {
    let mut pulled = model.clone();
    let nothing = Link { mass: 0.0, com: Vector3::zeros(), inertia: Matrix3::zeros() };
    pulled.links = vec![nothing; model.dof];
    let mut body = [0.0; 10];
    body[0] = size / GRAVITY;
    if let Some(last) = pulled.links.last_mut() {
        *last = with_body(last, &model.kinematics.flange, &body);
    }
    // Rotate gravity into the direction of the force.
    let down = -Vector3::z();
    let turn = Rotation3::rotation_between(&(force / size), &down)
        .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), PI));
    let base = &mut pulled.kinematics.base.rotation;
    *base = UnitQuaternion::from_rotation_matrix(&turn) * *base;
    pulled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_grow() {
        let at = |t: f64| share_of(t, &[0.25, 2.0, 4.0, 10.0]);
        assert_eq!([at(1.9), at(2.0), at(3.0), at(12.5), at(4.1)], [0.0, 0.0, 1.0, 1.0, 0.0]);
        assert!((at(12.2) - 0.1_f64.mul_add(PI, 0.0).sin() * 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(share_of(2.0, &[0.0, 2.0, 4.0, 0.0]), 1.0);
    }

    #[test]
    fn directions_are_kept() {
        let force = vec![1.0, -2.0, 0.5, 0.3, 1.0, 2.0, 10.0];
        let again = (SIZE_AND_DIRECTION.coordinates)(&(SIZE_AND_DIRECTION.parameters)(&force));
        for (a, b) in force.iter().zip(again) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}

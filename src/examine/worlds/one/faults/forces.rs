//! Forces from outside, and torques that only seem to be there.

use super::super::dynamics::{jacobian, pose};
use super::super::law::Memory;
use super::super::motion::STRIDE;
use super::friction::{SHARE, gate, window};
use super::{Context, Fault, Moment, Order};
use crate::examine::worlds::model::{MAX, V3};
use crate::examine::worlds::random::Rng;
use std::f64::consts::PI;

/// Share of the period in which a push acts.
const PUSH: (f64, f64) = (0.08, 0.3);
/// Share of the push in which it grows and falls.
const GROWTH: (f64, f64) = (0.1, 0.4);
/// Share of the path on which an arm touches a soft obstacle.
const TOUCH: (f64, f64) = (0.06, 0.18);
/// Exponent of Hertz's contact of two bodies.
const HERTZ: f64 = 1.5;
/// Lag of a feedforward or of differentiation in a drive \[s\].
const DRIVE_LAG: (f64, f64) = (0.002, 0.01);

/// Direction of a force and its angles.
fn towards(fault: &mut Fault, way: &V3, graded: bool) {
    fault.truth.tell("azimuth", None, way.y.atan2(way.x), graded);
    fault.truth.tell("elevation", None, way.z.clamp(-1.0, 1.0).asin(), graded);
}

/// Force \[N\] at size 1: it gives a share of the torque of the strongest joint.
fn force_of(ctx: &Context, order: &Order) -> f64 {
    let lever = ctx.arm.joints.iter().map(|j| j.origin.norm()).sum::<f64>().max(0.1);
    let level = ctx.level.torque.iter().fold(0.0_f64, |a, b| a.max(*b));
    3.0 * SHARE * order.size * level / lever
}

/// Contact: a push with a trapezoid and tremor, a soft obstacle (K. Hunt, F. Crossley, ASME J. Applied
/// Mechanics 42, 1975), and a drag against the motion.
pub(super) fn contact(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["trapezoid_push", "hunt_crossley", "dragging"];
    let mut fault = Fault::new("contact", names[order.form], &[]);
    let force = force_of(ctx, order);
    let way = rng.direction();
    let last = ctx.arm.count() - 1;
    let span = window(ctx, PUSH, rng);
    let growth = rng.uniform(GROWTH) * (span[1] - span[0]);
    let form = order.form;
    if form == 1 {
        touch(ctx, &mut fault, (force, way), rng);
        return fault;
    }
    let tremor = (rng.uniform((2.0, 6.0)), rng.angle());
    fault.field = Some(Box::new(move |m: &Moment| {
        let on = gate(m.phase, span, growth);
        let mut tau = [0.0; MAX];
        if on <= 0.0 {
            return tau;
        }
        // The files have no flange: a push acts at the origin of the last joint.
        let rows = jacobian(m.pose, last, &m.pose.origin[last]);
        let mut pull = way * (1.0 + 0.06 * (2.0 * PI * tremor.0 * m.phase + tremor.1).sin());
        if form == 2 {
            let mut speed = V3::zeros();
            for j in 0..=last {
                speed += rows[j] * m.v[j];
            }
            pull = -speed / (speed.norm() + 0.02) + way * 0.4;
        }
        for j in 0..=last {
            tau[j] = -rows[j].dot(&pull) * force * on;
        }
        tau
    }));
    fault.loads = true;
    fault.truth.tell("force", None, force, form == 0);
    if form == 0 {
        towards(&mut fault, &way, true);
    }
    fault.truth.tell("t_start_s", None, span[0], true);
    fault.truth.tell("t_end_s", None, span[1], true);
    fault.truth.window = Some(span);
    fault
}

/// A soft obstacle: the flange runs into a wall that lies at the end of its path.
fn touch(ctx: &Context, fault: &mut Fault, push: (f64, V3), rng: &mut Rng) {
    let (force, out) = push;
    let last = ctx.arm.count() - 1;
    let rows = (0..ctx.path.q.len()).step_by(STRIDE * 5);
    let depth: Vec<(usize, f64)> =
        rows.map(|i| (i, pose(ctx.arm, &ctx.path.q[i]).flange.dot(&out))).collect();
    let mut sorted: Vec<f64> = depth.iter().map(|d| d.1).collect();
    sorted.sort_by(f64::total_cmp);
    let share = rng.uniform(TOUCH);
    let at = ((1.0 - share) * sorted.len() as f64) as usize;
    let wall = sorted.get(at).copied().unwrap_or(0.0);
    let most = (sorted.last().copied().unwrap_or(1.0) - wall).max(1e-4);
    let damping = rng.uniform((0.2, 0.6));
    fault.field = Some(Box::new(move |m: &Moment| {
        let mut tau = [0.0; MAX];
        let x = (m.pose.flange.dot(&out) - wall) / most;
        if x > 0.0 {
            let rows = jacobian(m.pose, last, &m.pose.flange);
            let mut speed = 0.0;
            for j in 0..=last {
                speed += rows[j].dot(&out) * m.v[j];
            }
            let size = force * x.powf(HERTZ) * (1.0 + damping * speed / most).clamp(0.0, 2.0);
            for j in 0..=last {
                tau[j] = rows[j].dot(&out) * size;
            }
        }
        tau
    }));
    fault.loads = true;
    let inside = |d: &&(usize, f64)| d.1 > wall;
    let step = super::super::motion::STEP;
    let first = depth.iter().find(inside).map_or(0.0, |d| d.0 as f64 * step);
    let end = depth.iter().rev().find(inside).map_or(0.0, |d| d.0 as f64 * step);
    fault.truth.window = Some([first, end]);
    fault.truth.tell("t_start_s", None, first, false);
    fault.truth.tell("t_end_s", None, end, false);
    fault.truth.tell("force", None, force, false);
    towards(fault, &-out, false);
}

/// Apparent torque: a feedforward that leaks into the log with a lag, and eddy currents whose drag
/// bends.
pub(super) fn apparent(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["lagging_feedforward", "bent_drag"];
    let mut fault = Fault::new("apparent_torque", names[order.form], order.joints);
    for &j in order.joints {
        let level = SHARE * order.size * ctx.level.torque[j];
        let inertia = 2.5 * level * rng.uniform((0.5, 1.0)) * rng.sign()
            / ctx.level.acceleration[j].max(0.01);
        let viscous =
            1.5 * level * rng.uniform((0.3, 1.0)) * rng.sign() / ctx.level.speed[j].max(0.01);
        if order.form == 0 {
            fault.law(
                j,
                Memory::new(
                    rng.uniform(DRIVE_LAG),
                    move |x| inertia * x.a + viscous * x.v,
                    |_, u| u,
                ),
            );
        } else {
            let top = ctx.level.speed[j].max(0.01);
            fault.torque(j, move |x| {
                inertia * x.a + viscous * x.v * 1.1 / (1.0 + 0.3 * (x.v / top).powi(2))
            });
        }
        fault.truth.tell("inertia", Some(j), inertia, true);
        fault.truth.tell("viscous", Some(j), viscous, order.form == 0);
    }
    fault
}

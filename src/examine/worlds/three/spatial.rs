//! Spatial vectors and the recursive Newton-Euler algorithm.
//!
//! R. Featherstone, Rigid Body Dynamics Algorithms, 2008, table 5.1. All vectors are in the frame of
//! their body, whose origin lies on the joint's axis.

use crate::examine::worlds::model::{Body, Joint, M3, MAX, Row, V3};
use nalgebra::{Rotation3, Unit};

/// Standard gravity \[m/s²\], as robot libraries use it.
pub(super) const GRAVITY: f64 = 9.81;

/// Motion vector: angular part and linear part at the origin.
#[derive(Clone, Copy, Debug)]
struct Twist {
    angular: V3,
    linear: V3,
}

/// Force vector: moment about the origin and force.
#[derive(Clone, Copy, Debug)]
struct Wrench {
    moment: V3,
    force: V3,
}

impl Twist {
    /// Motion cross motion: `v ×`.
    fn cross(&self, other: &Self) -> Self {
        Self {
            angular: self.angular.cross(&other.angular),
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
        }
    }

    /// Motion cross force: `v ×*`.
    fn cross_force(&self, other: &Wrench) -> Wrench {
        Wrench {
            moment: self.angular.cross(&other.moment) + self.linear.cross(&other.force),
            force: self.angular.cross(&other.force),
        }
    }
}

/// Spatial inertia of a body times a motion vector.
fn times(body: &Body, motion: &Twist) -> Wrench {
    let force = body.mass * (motion.linear - body.com.cross(&motion.angular));
    Wrench { moment: body.inertia * motion.angular + body.com.cross(&force), force }
}

/// Second moments of mass about the centre \[kg m²\]: positive exactly for bodies that exist.
pub(super) fn second_moments(body: &Body) -> M3 {
    M3::identity() * (0.5 * body.inertia.trace()) - body.inertia
}

/// The inertia of second moments.
pub(super) fn inertia_of(second: &M3) -> M3 {
    M3::identity() * second.trace() - second
}

pub(super) fn joined(a: &Body, b: &Body) -> Body {
    let mass = a.mass + b.mass;
    let com = (a.com * a.mass + b.com * b.mass) / mass.max(f64::MIN_POSITIVE);
    let at = |body: &Body| {
        let arm = body.com - com;
        body.inertia + inertia_of(&(arm * arm.transpose() * body.mass))
    };
    Body { mass, com, inertia: at(a) + at(b) }
}

/// A joint from its origin, angles and axis.
pub(super) fn joint(origin: V3, rpy: V3, axis: V3) -> Joint {
    let rotation = Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z).into_inner();
    Joint { origin, rpy, rotation, axis }
}

/// Axes of a joint's frame at an angle, in the frame before.
fn turned(joint: &Joint, angle: f64) -> M3 {
    let (sin, cos) = angle.sin_cos();
    let a = &joint.axis;
    let turn = M3::identity() * cos + a.cross_matrix() * sin + a * a.transpose() * (1.0 - cos);
    joint.rotation * turn
}

/// State of the arm: angles \[rad\], rates \[rad/s\], accelerations \[rad/s²\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    pub(super) q: Row,
    pub(super) v: Row,
    pub(super) a: Row,
}

/// What acts on the arm beside its own bodies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extra {
    /// A further body on a link (from 0), in that joint's frame.
    pub(super) body: Option<(usize, Body)>,
    /// A force \[N\] on the flange's origin, base frame.
    pub(super) push: Option<V3>,
}

/// Torques \[Nm\] that move the arm: recursive Newton-Euler; `gravity` \[m/s²\] in the base frame.
pub(super) fn inverse(
    joints: &[Joint],
    bodies: &[Body],
    at: &Point,
    gravity: &V3,
    extra: &Extra,
) -> Row {
    let mut turns = [M3::identity(); MAX];
    let mut wrenches = [Wrench { moment: V3::zeros(), force: V3::zeros() }; MAX];
    let mut velocity = Twist { angular: V3::zeros(), linear: V3::zeros() };
    let mut acceleration = Twist { angular: V3::zeros(), linear: -gravity };
    let mut world = M3::identity();
    let last = joints.len().saturating_sub(1);
    for (i, (joint, body)) in joints.iter().zip(bodies).enumerate() {
        let turn = turned(joint, at.q[i]);
        let down = turn.transpose();
        let into = |m: &Twist| Twist {
            angular: down * m.angular,
            linear: down * (m.linear + m.angular.cross(&joint.origin)),
        };
        velocity = into(&velocity);
        let rate = Twist { angular: joint.axis * at.v[i], linear: V3::zeros() };
        velocity.angular += rate.angular;
        acceleration = into(&acceleration);
        let bias = velocity.cross(&rate);
        acceleration.angular += joint.axis * at.a[i] + bias.angular;
        acceleration.linear += bias.linear;
        let add = |body: &Body, wrench: &mut Wrench| {
            let inertial = times(body, &acceleration);
            let gyric = velocity.cross_force(&times(body, &velocity));
            wrench.moment += inertial.moment + gyric.moment;
            wrench.force += inertial.force + gyric.force;
        };
        add(body, &mut wrenches[i]);
        if let Some((link, further)) = &extra.body
            && *link == i
        {
            add(further, &mut wrenches[i]);
        }
        if let Some(push) = &extra.push {
            world *= turn;
            if i == last {
                wrenches[i].force -= world.transpose() * push;
            }
        }
        turns[i] = turn;
    }
    let mut torques = [0.0; MAX];
    for (i, joint) in joints.iter().enumerate().rev() {
        let Wrench { moment, force } = wrenches[i];
        torques[i] = joint.axis.dot(&moment);
        if i > 0 {
            let force = turns[i] * force;
            wrenches[i - 1].force += force;
            wrenches[i - 1].moment += turns[i] * moment + joint.origin.cross(&force);
        }
    }
    torques
}

/// Place \[m\] and axes of the last joint's frame in the base frame.
pub(super) fn flange(joints: &[Joint], q: &Row) -> (V3, M3) {
    let mut place = V3::zeros();
    let mut world = M3::identity();
    for (joint, angle) in joints.iter().zip(q) {
        place += world * joint.origin;
        world *= turned(joint, *angle);
    }
    (place, world)
}

/// Gravity \[m/s²\] in the frame of a base that is turned by `angle` about (−sin `direction`,
/// cos `direction`, 0): the base leans towards `direction`, and so does gravity in its frame.
pub(super) fn tilted(angle: f64, direction: f64) -> V3 {
    let axis = Unit::new_normalize(V3::new(-direction.sin(), direction.cos(), 0.0));
    Rotation3::from_axis_angle(&axis, -angle) * V3::new(0.0, 0.0, -GRAVITY)
}

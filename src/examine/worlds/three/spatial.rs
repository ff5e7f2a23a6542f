//! Spatial vectors and the recursive Newton-Euler algorithm.
//!
//! R. Featherstone, Rigid Body Dynamics Algorithms, 2008, table 5.1. All vectors are in the frame of
//! their body, whose origin lies on the joint's axis.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

/// Most joints of an arm.
pub const MAX: usize = 7;
/// A value for each joint; those past the arm's last joint are zero.
pub type Axes = [f64; MAX];
/// A vector in space.
pub type V3 = Vector3<f64>;
/// A matrix in space.
pub type M3 = Matrix3<f64>;

/// Standard gravity \[m/s²\], as robot libraries use it.
pub const GRAVITY: f64 = 9.81;

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

/// A rigid body.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\], frame of the joint.
    pub com: V3,
    /// Inertia about the centre of mass \[kg m²\], axes of the joint's frame.
    pub inertia: M3,
}

impl Body {
    /// Spatial inertia times a motion vector.
    fn times(&self, motion: &Twist) -> Wrench {
        let force = self.mass * (motion.linear - self.com.cross(&motion.angular));
        Wrench { moment: self.inertia * motion.angular + self.com.cross(&force), force }
    }

    /// Second moments of mass about the centre \[kg m²\]: positive exactly for bodies that exist.
    #[must_use]
    pub fn second_moments(&self) -> M3 {
        M3::identity() * (0.5 * self.inertia.trace()) - self.inertia
    }

    /// The inertia of second moments.
    #[must_use]
    pub fn inertia_of(second: &M3) -> M3 {
        M3::identity() * second.trace() - second
    }

    /// Both bodies as one.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let com = (self.com * self.mass + other.com * other.mass) / mass.max(f64::MIN_POSITIVE);
        let at = |body: &Self| {
            let arm = body.com - com;
            body.inertia + Self::inertia_of(&(arm * arm.transpose() * body.mass))
        };
        Self { mass, com, inertia: at(self) + at(other) }
    }
}

/// A revolute joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Origin \[m\] in the frame before.
    pub origin: V3,
    /// Roll, pitch, yaw \[rad\] of the frame at angle 0, as in a URDF.
    pub rpy: V3,
    /// Its matrix.
    pub rotation: M3,
    /// Axis in the joint's own frame.
    pub axis: V3,
}

impl Joint {
    /// A joint from its origin, angles and axis.
    #[must_use]
    pub fn new(origin: V3, rpy: V3, axis: V3) -> Self {
        let rotation = Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z).into_inner();
        Self { origin, rpy, rotation, axis }
    }

    /// Axes of the joint's frame at an angle, in the frame before.
    #[must_use]
    pub fn turned(&self, angle: f64) -> M3 {
        let (sin, cos) = angle.sin_cos();
        let a = &self.axis;
        let turn = M3::identity() * cos + a.cross_matrix() * sin + a * a.transpose() * (1.0 - cos);
        self.rotation * turn
    }
}

/// State of the arm: angles \[rad\], rates \[rad/s\], accelerations \[rad/s²\].
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// Angles.
    pub q: Axes,
    /// Rates.
    pub v: Axes,
    /// Accelerations.
    pub a: Axes,
}

/// What acts on the arm beside its own bodies.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extra {
    /// A further body on a link (from 0), in that joint's frame.
    pub body: Option<(usize, Body)>,
    /// A force \[N\] on the flange's origin, base frame.
    pub push: Option<V3>,
}

/// Torques \[Nm\] that move the arm: recursive Newton-Euler; `gravity` \[m/s²\] in the base frame.
#[must_use]
pub fn inverse(joints: &[Joint], bodies: &[Body], at: &Point, gravity: &V3, extra: &Extra) -> Axes {
    let mut turns = [M3::identity(); MAX];
    let mut wrenches = [Wrench { moment: V3::zeros(), force: V3::zeros() }; MAX];
    let mut velocity = Twist { angular: V3::zeros(), linear: V3::zeros() };
    let mut acceleration = Twist { angular: V3::zeros(), linear: -gravity };
    let mut world = M3::identity();
    let last = joints.len().saturating_sub(1);
    for (i, (joint, body)) in joints.iter().zip(bodies).enumerate() {
        let turn = joint.turned(at.q[i]);
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
            let inertial = body.times(&acceleration);
            let gyric = velocity.cross_force(&body.times(&velocity));
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
#[must_use]
pub fn flange(joints: &[Joint], q: &Axes) -> (V3, M3) {
    let mut place = V3::zeros();
    let mut world = M3::identity();
    for (joint, angle) in joints.iter().zip(q) {
        place += world * joint.origin;
        world *= joint.turned(*angle);
    }
    (place, world)
}

/// Gravity \[m/s²\] in the frame of a base that is turned by `angle` about (−sin `direction`,
/// cos `direction`, 0): the base leans towards `direction`, and so does gravity in its frame.
#[must_use]
pub fn tilted(angle: f64, direction: f64) -> V3 {
    let axis = Unit::new_normalize(V3::new(-direction.sin(), direction.cos(), 0.0));
    Rotation3::from_axis_angle(&axis, -angle) * V3::new(0.0, 0.0, -GRAVITY)
}

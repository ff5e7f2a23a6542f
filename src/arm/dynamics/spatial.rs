//! Spatial vectors, all in the base frame about its origin, so that they are additive over bodies.
//!
//! R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, chapter 2.

use std::ops::{Add, AddAssign, Mul};

use nalgebra::{Matrix3, Vector3};

/// Velocity or acceleration; the linear part is that of the body-fixed point at the origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    pub(super) angular: Vector3<f64>,
    pub(super) linear: Vector3<f64>,
}

/// Force, and moment about the origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Force {
    pub(super) moment: Vector3<f64>,
    pub(super) force: Vector3<f64>,
}

/// Inertia of one body or of several rigidly connected ones.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inertia {
    pub(super) mass: f64,
    /// Mass times centre of mass.
    pub(super) first: Vector3<f64>,
    /// Moments of inertia about the origin.
    pub(super) about_origin: Matrix3<f64>,
}

impl Motion {
    /// self × other.
    #[inline]
    pub(super) fn cross(&self, other: &Motion) -> Motion {
        Motion {
            angular: self.angular.cross(&other.angular),
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
        }
    }

    /// self ×* force.
    #[inline]
    pub(super) fn cross_force(&self, force: &Force) -> Force {
        Force {
            moment: self.angular.cross(&force.moment) + self.linear.cross(&force.force),
            force: self.angular.cross(&force.force),
        }
    }

    /// Power of the force.
    #[inline]
    pub(super) fn dot(&self, force: &Force) -> f64 {
        self.angular.dot(&force.moment) + self.linear.dot(&force.force)
    }
}

impl Add for Motion {
    type Output = Motion;

    #[inline]
    fn add(self, other: Motion) -> Motion {
        Motion { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }
}

impl Mul<f64> for Motion {
    type Output = Motion;

    #[inline]
    fn mul(self, factor: f64) -> Motion {
        Motion { angular: self.angular * factor, linear: self.linear * factor }
    }
}

impl Add for Force {
    type Output = Force;

    #[inline]
    fn add(self, other: Force) -> Force {
        Force { moment: self.moment + other.moment, force: self.force + other.force }
    }
}

impl AddAssign for Force {
    #[inline]
    fn add_assign(&mut self, other: Force) {
        *self = *self + other;
    }
}

impl Inertia {
    /// A body of inertia `about_com` (base frame axes) with its centre of mass at `com`.
    #[inline]
    pub(super) fn of_body(mass: f64, com: &Vector3<f64>, about_com: &Matrix3<f64>) -> Inertia {
        let first = com * mass;
        let outer = first * com.transpose();
        let trace = outer[(0, 0)] + outer[(1, 1)] + outer[(2, 2)];
        let mut about_origin = about_com - outer;
        for k in 0..3 {
            about_origin[(k, k)] += trace;
        }
        Inertia { mass, first, about_origin }
    }

    /// Momentum at a velocity, or force at an acceleration.
    #[inline]
    pub(super) fn times(&self, motion: &Motion) -> Force {
        Force {
            moment: self.about_origin * motion.angular + self.first.cross(&motion.linear),
            force: motion.linear * self.mass + motion.angular.cross(&self.first),
        }
    }
}

impl AddAssign for Inertia {
    #[inline]
    fn add_assign(&mut self, other: Inertia) {
        self.mass += other.mass;
        self.first += other.first;
        self.about_origin += other.about_origin;
    }
}

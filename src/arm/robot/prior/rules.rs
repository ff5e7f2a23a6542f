//! Relations of numbers of an arm to its size: total mass M (kg), reach R (m), payload p (kg).
//!
//! Torques: limits of 38 KUKA robots (`kroshu/kuka_robot_descriptions`@7766e92a), deviations by
//! leave-one-out. Friction of ABB robots: levels of eleven configurations and the friction
//! identified by Paes et al. 2014 and Obal & Gierlak 2025, relative to those torques; of others:
//! five arms of five makers (see docs/robots.md). Motors: ABB's 9C series (3AUA0000030840 REV C).
//! Standard deviations are of the logarithm.

/// Maker of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Maker {
    Abb,
    Other,
}

impl Maker {
    /// From the name of the robot: ABB names have IRB or CRB before the number.
    pub(super) fn from_name(name: &str) -> Maker {
        let name = name.to_uppercase();
        let is_number = |text: &str| {
            text.trim_start_matches([' ', '_', '-']).starts_with(|c: char| c.is_ascii_digit())
        };
        let has = |letters: &str| name.split(letters).skip(1).any(is_number);
        if has("IRB") || has("CRB") { Maker::Abb } else { Maker::Other }
    }
}

/// Size of an arm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    /// Total mass \[kg\].
    pub(super) mass: f64,
    /// Distance from axis 1 to the wrist centre of the stretched arm \[m\].
    pub(super) reach: f64,
    /// kg.
    pub(super) payload: f64,
}

/// A number with the standard deviation of its logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rough {
    pub(super) value: f64,
    pub(super) sd: f64,
}

impl Rough {
    /// Standard deviation of the number itself.
    pub(super) fn deviation(&self) -> f64 {
        self.value.abs() * self.sd
    }
}

/// Factor and exponent of (M R) for main axes or (p R) for wrist axes, and deviation.
const TORQUE: [(f64, f64, f64); 6] = [
    (11.8, 0.82, 0.22),
    (9.2, 0.85, 0.17),
    (2.83, 0.94, 0.34),
    (5.9, 0.94, 0.39),
    (5.1, 0.94, 0.42),
    (2.7, 0.96, 0.41),
];
/// Friction at half speed relative to the largest torque, and deviation, of ABB robots.
const FRICTION: [(f64, f64); 6] =
    [(0.042, 0.52), (0.060, 0.50), (0.068, 0.63), (0.089, 0.81), (0.133, 0.61), (0.108, 0.78)];
/// Share of that friction that is independent of speed, and its deviation.
pub(super) const COULOMB: f64 = 0.4;
pub(super) const COULOMB_SD: f64 = 0.3;
/// Ratio of the friction of other makers to it, and its deviation.
const OTHER_FRICTION: (f64, f64) = (3.5, 0.91);
/// Share of the friction variance common to all joints: ABB robots, others.
const COMMON_FRICTION: [f64; 2] = [0.35, 0.59];
/// Speed at a reach of 2 m and a payload of 20 kg \[degrees/s\], exponents of both, deviation: from
/// 52 robots of the catalogue. The mass has no further effect.
const SPEED: [(f64, f64, f64, f64); 6] = [
    (143.0, -0.32, -0.09, 0.27),
    (132.0, -0.25, -0.15, 0.27),
    (136.0, -0.40, -0.13, 0.29),
    (264.0, -0.01, -0.23, 0.29),
    (266.0, 0.11, -0.31, 0.26),
    (369.0, 0.16, -0.26, 0.33),
];
/// Motor speed at the axis speed limit \[rad/s\].
const MOTOR_SPEED: f64 = 420.0;
const RATIO_SD: f64 = 0.2;
const ROTOR_SD: f64 = 0.45;
const LOSS_SD: f64 = 0.6;
/// Share of the variance of copper losses and of rotors common to all joints.
pub(super) const COMMON_MOTORS: f64 = 0.5;

impl Size {
    /// Index of the rule for a joint: a robot of 7 joints has one more before its wrist.
    fn place(joint: usize, dof: usize) -> usize {
        if joint + 3 >= dof { 6 - (dof - joint).min(6) } else { joint.min(2) }
    }

    /// Largest torque of a joint \[Nm\].
    pub(super) fn torque(&self, joint: usize, dof: usize) -> Rough {
        let place = Size::place(joint, dof);
        let (factor, power, sd) = TORQUE[place];
        let load = if place < 3 { self.mass } else { self.payload };
        Rough { value: factor * (load * self.reach).powf(power), sd }
    }

    /// Friction of a joint at half speed \[Nm\].
    pub(super) fn friction(&self, maker: Maker, joint: usize, dof: usize) -> Rough {
        let (share, sd) = FRICTION[Size::place(joint, dof)];
        let (factor, sd) = if maker == Maker::Abb { (1.0, sd) } else { OTHER_FRICTION };
        Rough { value: factor * share * self.torque(joint, dof).value, sd }
    }

    /// Largest speed of a joint \[rad/s\].
    pub(super) fn speed(&self, joint: usize, dof: usize) -> Rough {
        let (speed, by_reach, by_payload, sd) = SPEED[Size::place(joint, dof)];
        let size = (self.reach / 2.0).powf(by_reach) * (self.payload / 20.0).powf(by_payload);
        Rough { value: speed.to_radians() * size, sd }
    }

    /// Share of the largest torque that accelerates a joint: from the foundation loads of five
    /// robots.
    pub(super) fn acceleration_share(&self) -> f64 {
        (1.17 * (self.mass * self.reach).powf(-0.17)).min(1.0)
    }

    /// Power of controller and drives without motion and brake coils \[W\]: from published values
    /// of an IRB120 (173 W with released brakes), an IRB1520ID (233 W) and an IRB140 (335 W), with
    /// a slope towards the 400 W of a large robot.
    pub(super) fn standby(&self) -> Rough {
        let open = 240.0 * (self.mass / 100.0).powf(0.15);
        Rough { value: open - self.coils().value, sd: 0.35 }
    }

    /// Power of the coils of released brakes \[W\].
    pub(super) fn coils(&self) -> Rough {
        Rough { value: 25.0 + 0.02 * self.mass, sd: 0.5 }
    }

    /// Energy of one brake release \[J\].
    pub(super) fn release(&self) -> Rough {
        Rough { value: 12.0 * (self.mass / 250.0).sqrt(), sd: 0.6 }
    }
}

/// Share of the friction variance common to all joints.
pub(super) fn common_friction(maker: Maker) -> f64 {
    COMMON_FRICTION[usize::from(maker == Maker::Other)]
}

/// Gear ratio of a joint with the speed limit `velocity` \[rad/s\].
pub(super) fn ratio(velocity: f64) -> Rough {
    Rough { value: MOTOR_SPEED / velocity, sd: RATIO_SD }
}

/// Rotor inertia \[kg m²\] of a motor with the peak torque `peak` \[Nm\].
pub(super) fn rotor(peak: f64) -> Rough {
    Rough { value: 5.7e-5 * (peak / 4.1).powf(1.51), sd: ROTOR_SD }
}

/// Copper loss of such a motor over its squared torque \[W/(Nm)²\].
pub(super) fn loss(peak: f64) -> Rough {
    Rough { value: 4.0 * (peak / 10.0).powf(-1.4), sd: LOSS_SD }
}

/// Default ratio of payload to robot mass, typical of ABB robots.
const PAYLOAD: f64 = 0.1;

/// Payload of an arm of this mass (kg) and reach (m) \[kg\].
pub(super) fn payload(mass: Option<f64>, reach: f64) -> f64 {
    // Default: 10 kg at 1.4 m.
    mass.map_or(5.0 * reach * reach, |mass| PAYLOAD * mass).clamp(0.5, 1000.0)
}

/// Mass of an arm of this reach (m) and payload (kg) \[kg\]: from ABB's industrial robots, with a
/// standard deviation of the logarithm of 0.39 over families. Other arms are lighter.
pub(super) fn mass(reach: f64, payload: f64) -> f64 {
    113.0 * reach.powf(1.79) * (payload / 10.0).powf(0.26)
}

/// Deviation of the logarithm of that mass for an unknown class of robot.
pub(super) const MASS_BY_SIZE: f64 = 0.55;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn makers_are_known_by_the_name() {
        for name in ["IRB1600-10/1.45 of line 4", "abb_irb_2400", "ABB IRB 120", "CRB15000-5/0.95"]
        {
            assert_eq!(Maker::from_name(name), Maker::Abb, "{name}");
        }
        for name in ["Kirby 3", "IRB", "an arm", ""] {
            assert_eq!(Maker::from_name(name), Maker::Other, "{name}");
        }
    }
}

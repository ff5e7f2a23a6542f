//! Faults of bodies, gears, encoders, bristles, the wrist, and forces from outside.

use super::rigid::{Arm, Pose, about, joined};
use super::terms::Now;
use crate::examine::worlds::model::{Body, MAX, Row, V3};

/// A change of the bodies, rotors or gravity of an arm.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// A body more at a link (payload at the last one).
    Add {
        link: usize,
        /// The body, in the frame of the link's joint.
        body: Body,
        /// Radius in which a liquid's centre follows gravity \[m\]; 0: rigid.
        slosh: f64,
        /// Where the centre is now, from the middle \[m\].
        now: V3,
    },
    /// A rail with a mass that slides between two stops.
    Slide {
        link: usize,
        /// The body in the middle of the rail.
        body: Body,
        /// Half of the rail \[m\].
        rail: V3,
        /// Place on the rail, −1 to 1.
        place: f64,
    },
    /// A body put in place of another.
    Replace { link: usize, body: Body },
    /// Gravity turned.
    Tilt {
        /// Angle from the vertical \[rad\].
        angle: f64,
        /// Towards which the base leans \[rad\].
        direction: f64,
        /// Share by which it leans more under the torque of joint 2.
        soft: f64,
        /// Scale of that torque \[Nm\].
        scale: f64,
        /// What it leans more now \[rad\].
        now: f64,
    },
    /// Rotor inertia more \[kg m²\].
    Rotor { inertia: Row },
}

/// Friction angle of the sliding mass: share of its weight along the rail.
const STICK: f64 = 0.35;
/// Time in which a liquid follows \[s\].
const FLOW: f64 = 0.15;
/// Time in which a base gives way \[s\].
const GIVE: f64 = 0.05;

impl Change {
    pub(super) fn apply(&self, arm: &mut Arm) {
        match self {
            Self::Add { link, body, now, .. } => add(arm, *link, body, now),
            Self::Slide { link, body, rail, place } => add(arm, *link, body, &(rail * *place)),
            Self::Replace { link, body } => {
                if let Some(own) = arm.bodies.get_mut(*link) {
                    *own = *body;
                }
            }
            Self::Tilt { angle, direction, now, .. } => {
                let axis = V3::new(-direction.sin(), direction.cos(), 0.0);
                // The base leans by +angle: gravity turns by −angle in its frame.
                arm.gravity = about(&axis, -(angle + now)) * arm.gravity;
            }
            Self::Rotor { inertia } => {
                for (own, more) in arm.rotor.iter_mut().zip(inertia) {
                    *own += more;
                }
            }
        }
    }

    /// Whether it changes with time.
    pub(super) fn moves(&self) -> bool {
        match self {
            Self::Add { slosh, .. } => *slosh > 0.0,
            Self::Tilt { soft, .. } => *soft != 0.0,
            Self::Slide { .. } => true,
            _ => false,
        }
    }

    /// Steps what moves, by `dt` seconds.
    pub(super) fn step(&mut self, arm: &Arm, pose: &Pose, load: &Row, dt: f64) {
        let down = pose.last.transpose() * arm.gravity.normalize();
        match self {
            Self::Add { slosh, now, .. } => *now += (down * *slosh - *now) * (dt / FLOW).min(1.0),
            Self::Slide { rail, place, .. } => {
                let pull = down.dot(&rail.normalize());
                if pull.abs() > STICK {
                    // Half a second from stop to stop under its whole weight.
                    *place = (*place + dt * 4.0 * pull).clamp(-1.0, 1.0);
                }
            }
            Self::Tilt { angle, soft, scale, now, .. } => {
                let more = *angle * *soft * (load[1] / *scale).clamp(-2.0, 2.0);
                *now += (more - *now) * (dt / GIVE).min(1.0);
            }
            _ => {}
        }
    }
}

fn add(arm: &mut Arm, link: usize, body: &Body, shift: &V3) {
    if let Some(own) = arm.bodies.get_mut(link) {
        let moved = Body { com: body.com + shift, ..*body };
        *own = joined(own, &moved);
    }
}

/// An arm with changes, but for one of them.
pub(super) fn composed<'a>(base: &Arm, changes: impl Iterator<Item = &'a Change>) -> Arm {
    let mut arm = base.clone();
    for change in changes {
        change.apply(&mut arm);
    }
    arm
}

/// An elastic gear, perhaps with a gap: the link has a state of its own.
#[derive(Clone, Debug)]
pub(super) struct Flex {
    pub(super) joint: usize,
    /// Stiffness \[Nm/rad\].
    pub(super) stiffness: f64,
    /// Hardening: torque k·δ·(1 + hard·(δ/δ₀)²).
    pub(super) hard: f64,
    /// δ₀ \[rad\].
    pub(super) reference: f64,
    /// Damping \[Nm s/rad\].
    pub(super) damping: f64,
    /// Gap \[rad\].
    pub(super) gap: f64,
}

impl Flex {
    /// Torque on the link for the twist (motor less link) and its rate, and the stiffness and damping there.
    pub(super) fn torque(&self, twist: f64, rate: f64) -> (f64, f64, f64) {
        let half = 0.5 * self.gap;
        let wound = if twist > half {
            twist - half
        } else if twist < -half {
            twist + half
        } else {
            return (0.0, 0.0, 0.0);
        };
        let ratio = (wound / self.reference).powi(2);
        let spring = self.stiffness * wound * (1.0 + self.hard * ratio);
        let mut damping = self.damping;
        if self.gap > 0.0 {
            // Contact damping grows with the depth (K. Hunt, F. Crossley 1975) and never pulls.
            damping *= (wound.abs() / (0.2 * self.gap)).min(1.0);
            let sum = spring + damping * rate;
            if sum * wound < 0.0 {
                return (0.0, 0.0, 0.0);
            }
        }
        (spring + damping * rate, self.stiffness * (1.0 + 3.0 * self.hard * ratio), damping)
    }
}

/// An encoder that shows a wrong angle: true = shown + offset + wave.
#[derive(Clone, Debug)]
pub(super) struct Encoder {
    pub(super) joint: usize,
    /// Offset \[rad\].
    pub(super) offset: f64,
    /// Eccentricity \[rad\] and its phase \[rad\].
    pub(super) wave: (f64, f64),
    /// Relative error of the ratio about an angle \[rad\].
    pub(super) slope: (f64, f64),
}

impl Encoder {
    /// True less shown angle, at the shown angle.
    pub(super) fn error(&self, q: f64) -> f64 {
        self.offset + self.wave.0 * (q - self.wave.1).cos() + self.slope.0 * (q - self.slope.1)
    }
}

/// Bristles that need a long way.
#[derive(Clone, Debug)]
pub(super) struct Bristle {
    pub(super) joint: usize,
    /// Distances of Maxwell-slip elements \[rad\]; a single one for the power law.
    pub(super) distances: Vec<f64>,
    /// Power of Bouc and Wen; 0 for Maxwell-slip elements.
    pub(super) power: f64,
    pub(super) state: Vec<f64>,
}

impl Bristle {
    /// The state after a way \[rad\].
    pub(super) fn step(&mut self, way: f64) -> f64 {
        let count = self.distances.len().max(1) as f64;
        let mut sum = 0.0;
        for (state, distance) in self.state.iter_mut().zip(&self.distances) {
            let rate = if self.power > 0.0 {
                1.0 - state.abs().powf(self.power) * (*state * way).signum()
            } else {
                1.0
            };
            *state = (*state + rate * way / distance).clamp(-1.0, 1.0);
            sum += *state / count;
        }
        sum
    }
}

/// Coupling of the last axis to the one before.
#[derive(Clone, Debug)]
pub(super) struct Wrist {
    /// Turns of the last motor per turn of the axis before.
    pub(super) coupling: f64,
    /// Share of the last motor's load that its friction takes more.
    pub(super) load: f64,
}

/// A force on the flange.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    pub(super) direction: V3,
    /// Largest force \[N\].
    pub(super) force: f64,
    /// From and to \[s\], within a period.
    pub(super) window: (f64, f64),
    /// Shape over the window: 0 haversine, 1 fast contact and slow release, 2 spring with chatter.
    pub(super) shape: u8,
    /// Coefficient of friction against the flange's speed.
    pub(super) mu: f64,
}

impl Contact {
    /// Torques that the motors need more \[Nm\].
    pub(super) fn torques(&self, pose: &Pose, v: &Row, now: &Now) -> Row {
        let (from, to) = self.window;
        let x = (now.phase - from) / (to - from);
        if !(0.0..=1.0).contains(&x) {
            return [0.0; MAX];
        }
        let wave = (std::f64::consts::PI * x).sin().max(0.0);
        let size = match self.shape {
            0 => wave * wave,
            1 => (1.0 - (-x / 0.06).exp()) * (1.0 - x.powi(6)),
            _ => wave.sqrt() * (1.0 - 0.1 * (40.0 * x).sin().powi(2)),
        };
        let speed = pose.flange_velocity(v);
        let slip = speed - self.direction * speed.dot(&self.direction);
        let rub = slip / slip.norm().hypot(0.02);
        let force = (self.direction - rub * self.mu) * (self.force * size);
        pose.of_force(&force).map(|x| -x)
    }
}

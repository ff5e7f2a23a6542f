//! Sizes of everyday errors, with their priors.

use crate::arm::effects::Variable;
use crate::gap::design::{Design, Group, JointDesign};
use crate::gap::tunables::Tunables;

/// A size with a log-normal prior.
#[derive(Clone, Copy, Debug)]
pub(in crate::gap) struct Size {
    /// Its value.
    pub value: f64,
    /// Median of the prior.
    pub median: f64,
    /// Standard deviation of the logarithm.
    pub spread: f64,
    /// Largest usual value; above it the prior falls as steeply as that of everyday errors.
    pub most: f64,
}

impl Size {
    fn new(median: f64, spread: f64) -> Size {
        Size { value: median, median, spread, most: f64::INFINITY }
    }

    /// A value beside its prior.
    pub(super) fn about(value: f64, median: f64, spread: f64) -> Size {
        Size { value, ..Size::new(median, spread) }
    }

    fn up_to(self, most: f64) -> Size {
        Size { most, ..self }
    }

    /// One that is known.
    fn fixed(value: f64) -> Size {
        Size { value, median: value, spread: NONE, most: f64::INFINITY }
    }

    /// Logarithm of the prior, up to a constant.
    #[must_use]
    pub(in crate::gap) fn log_prior(&self) -> f64 {
        let beyond = self.beyond() / TAIL;
        -0.5 * ((self.value / self.median).ln() / self.spread).powi(2) - 0.5 * beyond.powi(2)
    }

    /// Logarithm of its ratio to the largest usual value, 0 below that.
    fn beyond(&self) -> f64 {
        (self.value / self.most).ln().max(0.0)
    }

    /// A Newton step of the logarithm from the gradient and the expected curvature of the
    /// likelihood.
    pub(super) fn step(&mut self, gradient: f64, curvature: f64) {
        let tail = if self.beyond() > 0.0 { TAIL.powi(-2) } else { 0.0 };
        let precision = self.spread.powi(-2);
        let gradient =
            gradient - (self.value / self.median).ln() * precision - self.beyond() * tail;
        let step = gradient / (curvature + precision + tail);
        self.value *= step.clamp(-LONGEST, LONGEST).exp();
    }
}

/// Standard deviation of the logarithm of a size above the largest usual one.
pub(in crate::gap) const TAIL: f64 = 0.2;
/// Largest change of friction from log to log, of its median: EFFECTS.md has 1 to 3 % from day to day.
pub(in crate::gap) const MOST_OF_FRICTION: f64 = 3.0;
/// Number of the noise of logs that do not repeat, of the torque.
pub(super) const NOISE: usize = 6;
/// Number of what no form of a law explains, of the law.
pub(super) const LAWS: usize = 7;
/// Number of what a written model misses: of the torque, alike at all frequencies.
pub(super) const WRITTEN: usize = 8;
/// Longest step of a logarithm.
const LONGEST: f64 = 1.2;
/// Sizes of a joint.
#[derive(Clone, Debug)]
pub(in crate::gap) struct JointSizes {
    /// Groups of everyday errors.
    pub groups: Vec<(Group, Size)>,
    /// Share of the torque that no function explains, in logs now and in the baseline, by range of
    /// frequencies; then those that have names.
    pub error: [Size; 9],
}

/// Sizes of all joints.
pub(in crate::gap) type Sizes = Vec<JointSizes>;

impl JointSizes {
    /// The prior medians.
    #[must_use]
    pub(in crate::gap) fn usual(design: &JointDesign, tunables: &Tunables) -> JointSizes {
        let t = tunables;
        let mut groups: Vec<(Group, Size)> = Vec::new();
        for group in &design.groups {
            if groups.iter().any(|(known, _)| known == group) {
                continue;
            }
            let size = match group {
                Group::Fixed | Group::Form(_) => continue,
                Group::LogFriction => {
                    let usual = Size::new(t.log_friction, t.log_friction_spread);
                    usual.up_to(MOST_OF_FRICTION * t.log_friction)
                }
                Group::Smooth(Variable::Reversal) => Size::new(t.reversal, t.reversal_spread),
                Group::Day(Variable::Reversal) => Size::new(t.day_reversal, t.day_spread),
                Group::Day(_) => Size::new(t.day, t.day_spread),
                Group::Smooth(_) | Group::OtherPosition => Size::new(t.smooth, t.smooth_spread),
            };
            groups.push((*group, size));
        }
        let error = Size::new(t.error, t.error_spread);
        let mut all = [error; 9];
        all[NOISE] = Size::new(t.white, t.white_spread);
        all[LAWS] = Size::new(t.law_error, t.form_spread);
        all[WRITTEN] = Size::fixed(NONE);
        JointSizes { groups, error: all }
    }

    /// The size of a group; 1 for one without a size.
    #[must_use]
    pub(in crate::gap) fn of(&self, group: Group) -> f64 {
        self.groups.iter().find(|(of, _)| *of == group).map_or(1.0, |(_, size)| size.value)
    }

    /// Sets the prior of a law's form; `law` is the size of the law.
    pub(super) fn set_form(&mut self, number: usize, law: f64, tunables: &Tunables) {
        let median = (tunables.form * law).max(1e-12);
        match self.groups.iter_mut().find(|(of, _)| *of == Group::Form(number)) {
            Some((_, size)) => size.median = median,
            None => {
                self.groups.push((Group::Form(number), Size::new(median, tunables.form_spread)));
            }
        }
    }

    /// Logarithm of the prior.
    #[must_use]
    pub(in crate::gap) fn log_prior(&self) -> f64 {
        let groups = self.groups.iter().map(|(_, size)| size.log_prior()).sum::<f64>();
        groups + self.error.iter().map(Size::log_prior).sum::<f64>()
    }
}

/// Sizes of a model of the logs as they are now, without everyday errors: what it misses is error.
pub(super) fn without_everyday(design: &Design) -> Sizes {
    let mut all = usual(design);
    for joint in &mut all {
        joint.groups.push((Group::Fixed, Size::fixed(NONE)));
        // A model that jumps at a reversal is right elsewhere.
        let is_there = |group: &Group| *group == Group::Smooth(Variable::Reversal);
        for (_, size) in joint.groups.iter_mut().filter(|(group, _)| !is_there(group)) {
            *size = Size::fixed(NONE);
        }
        joint.error[3..6].fill(Size::fixed(1.0 / NONE));
        joint.error[..3].fill(Size::fixed(NONE));
        joint.error[LAWS] = Size::fixed(NONE);
        joint.error[WRITTEN] = Size::new(MISSED[0], MISSED[1]);
    }
    all
}

/// Median and spread \[ln\] of what a written model misses, of the torque.
const MISSED: [f64; 2] = [0.01, 1.0];
/// The size of a group that is not there; logs of the baseline have an error that is so much larger
/// than their torques.
const NONE: f64 = 1e-6;

/// Sizes halfway to the prior medians: neither do they explain all that an effect may explain, nor is
/// all that they explain an effect.
#[must_use]
pub(in crate::gap) fn halfway(sizes: &Sizes) -> Sizes {
    let mut all = sizes.clone();
    for joint in &mut all {
        joint.groups.retain(|(group, _)| !matches!(group, Group::Form(_)));
        let groups = joint.groups.iter_mut().map(|(_, size)| size);
        for size in groups.chain(&mut joint.error) {
            size.value = (size.value * size.median).sqrt();
        }
    }
    all
}

/// The prior medians of all joints.
#[must_use]
pub(in crate::gap) fn usual(design: &Design) -> Sizes {
    design.joints.iter().map(|joint| JointSizes::usual(joint, &design.tunables)).collect()
}

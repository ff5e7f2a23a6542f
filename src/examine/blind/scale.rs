//! Quantities that scale the sizes of disturbances.

use super::fault::Disturbance;
use super::mechanics::Joints;
use super::plant::Plant;
use super::random::Random;
use super::trust::Trust;
use super::workspace::Workspace;

/// Quantities that scale the sizes of disturbances.
pub(super) struct Scale<'a> {
    /// The nominal robot, and the true robot without faults.
    pub(super) nominal: &'a Plant,
    pub(super) plant: &'a Plant,
    pub(super) workspace: &'a Workspace,
    pub(super) trust: Trust,
    pub(super) period_s: f64,
    /// Gear ratios.
    pub(super) ratio: Joints,
    /// For each joint of the motion: rms and largest torque, largest rate, rms torque through the
    /// gear.
    pub(super) rms: Joints,
    pub(super) peak: Joints,
    pub(super) fastest: Joints,
    pub(super) load: Joints,
    /// Rms of the motion-dependent power \[W\].
    pub(super) power: f64,
}

impl Scale<'_> {
    pub(super) fn any_joint(&self, random: &mut Random) -> usize {
        random.below(self.plant.dof)
    }

    /// One of the given joints.
    pub(super) fn one_of(&self, joints: &[usize], random: &mut Random) -> usize {
        joints.get(random.below(joints.len())).copied().unwrap_or(0).min(self.plant.dof - 1)
    }
}

/// Draws a disturbance.
pub(super) type Draw = fn(&Scale<'_>, &mut Random) -> Disturbance;

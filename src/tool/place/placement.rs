//! Accepted placements, and why others are refused.

use super::limits::Room;
use crate::retime::energy::EnergyParts;

/// An accepted candidate, as simulated.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Its place in the unit cube of all axes.
    pub point: Vec<f64>,
    /// The shifts of the groups in the world, m and rad.
    pub shifts: Vec<[f64; 6]>,
    /// Duration of the cycle, s.
    pub cycle_s: f64,
    /// Energy of the cycle.
    pub energy: EnergyParts,
    /// How near it comes to what it must avoid.
    pub room: Room,
}

/// Why simulated candidates were refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct Refusals {
    /// A movement cannot be followed.
    pub reach: usize,
    /// A line comes too near to a singularity.
    pub singular: usize,
    /// Arm or tool enters a keep-out.
    pub keep_out: usize,
    /// The cycle takes longer than today.
    pub slower: usize,
}

impl Refusals {
    pub(super) fn add(&mut self, other: &Refusals) {
        self.reach += other.reach;
        self.singular += other.singular;
        self.keep_out += other.keep_out;
        self.slower += other.slower;
    }
}

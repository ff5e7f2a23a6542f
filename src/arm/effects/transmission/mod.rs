//! Play, elasticity, ripple and coupling of gears.

pub(super) mod backlash;
pub(super) mod elasticity;
pub(super) mod ripple;
pub(super) mod wrist_coupling;

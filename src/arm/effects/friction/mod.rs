//! Friction in joints and gears.

pub(super) mod brake_drag;
pub(super) mod friction_level;
pub(super) mod gear_efficiency;
pub(super) mod load_friction;
pub(super) mod nonlinear_viscous;
pub(super) mod position_friction;
pub(super) mod presliding;
pub(super) mod stribeck;
pub(super) mod viscous_asymmetry;
pub(super) mod warm_up;

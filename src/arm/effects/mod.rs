//! Effects beyond rigid bodies, Coulomb and viscous friction: one file per effect with its law,
//! prior and documentation.
//!
//! [`ALL`] is the register. An effect in it can be written in a robot file, is part of every
//! prediction and simulation, and can be found by a diagnosis.

mod acceleration_limit;
mod apparent_torque;
mod applied;
mod backlash;
mod base_load;
mod base_tilt;
mod bodies;
mod brake_drag;
mod brake_power;
mod cable;
mod contact;
mod copper_loss;
mod current_saturation;
mod current_sign;
mod effect;
mod elasticity;
mod encoder_offset;
mod filter_lag;
mod flux_weakening;
mod friction_level;
mod gear_efficiency;
mod gravity_spring;
mod inverter_loss;
mod iron_loss;
mod link_parameters;
mod load_friction;
mod motion;
mod no_regeneration;
mod nonlinear_viscous;
mod payload;
mod position_friction;
mod presliding;
mod program_wait;
mod register;
mod response;
mod ripple;
mod rotor_inertia;
mod scale;
mod speed_limit;
mod springs;
mod stribeck;
mod time_delay;
mod torque_constant;
mod torque_offset;
mod tracking_lag;
mod viscous_asymmetry;
mod warm_up;
mod waves;
mod wrist_coupling;
mod zone_blending;

pub use applied::{
    applied, drawn, from_toml, load, load_estimated, of_the_whole_motion, with_estimates,
};
pub use bodies::added as with_body;
pub use effect::{
    Channel, Coordinate, Effect, Form, OfMotion, Parameter, Published, Role, Scope, Values,
};
pub use motion::Motion;
pub use register::{ALL, find};
pub use response::Response;
pub use scale::Scale;

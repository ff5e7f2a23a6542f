//! The register of effects.

use super::effect::Effect;

/// All known effects.
pub static ALL: [Effect; 41] = [
    super::rigid_body::payload::PAYLOAD,
    super::rigid_body::link_parameters::LINK_PARAMETERS,
    super::rigid_body::rotor_inertia::ROTOR_INERTIA,
    super::rigid_body::gravity_spring::GRAVITY_SPRING,
    super::rigid_body::base_tilt::BASE_TILT,
    super::measurement::encoder_offset::ENCODER_OFFSET,
    super::rigid_body::cable::CABLE,
    super::friction::friction_level::FRICTION_LEVEL,
    super::measurement::torque_offset::TORQUE_OFFSET,
    super::friction::stribeck::STRIBECK,
    super::friction::nonlinear_viscous::NONLINEAR_VISCOUS,
    super::friction::viscous_asymmetry::VISCOUS_ASYMMETRY,
    super::friction::load_friction::LOAD_FRICTION,
    super::friction::gear_efficiency::GEAR_EFFICIENCY,
    super::friction::warm_up::WARM_UP,
    super::friction::position_friction::POSITION_FRICTION,
    super::friction::presliding::PRESLIDING,
    super::transmission::backlash::BACKLASH,
    super::transmission::elasticity::ELASTICITY,
    super::transmission::ripple::RIPPLE,
    super::transmission::wrist_coupling::WRIST_COUPLING,
    super::friction::brake_drag::BRAKE_DRAG,
    super::measurement::torque_constant::TORQUE_CONSTANT,
    super::measurement::current_saturation::CURRENT_SATURATION,
    super::measurement::flux_weakening::FLUX_WEAKENING,
    super::measurement::time_delay::TIME_DELAY,
    super::measurement::filter_lag::FILTER_LAG,
    super::measurement::current_sign::CURRENT_SIGN,
    super::rigid_body::contact::CONTACT,
    super::measurement::apparent_torque::APPARENT_TORQUE,
    super::controller::tracking_lag::TRACKING_LAG,
    super::controller::zone_blending::ZONE_BLENDING,
    super::controller::acceleration_limit::ACCELERATION_LIMIT,
    super::controller::program_wait::PROGRAM_WAIT,
    super::controller::speed_limit::SPEED_LIMIT,
    super::power::copper_loss::COPPER_LOSS,
    super::power::inverter_loss::INVERTER_LOSS,
    super::power::iron_loss::IRON_LOSS,
    super::power::no_regeneration::NO_REGENERATION,
    super::power::base_load::BASE_LOAD,
    super::power::brake_power::BRAKE_POWER,
];

/// The effect with this id.
#[must_use]
pub fn find(id: &str) -> Option<&'static Effect> {
    ALL.iter().find(|effect| effect.id == id)
}

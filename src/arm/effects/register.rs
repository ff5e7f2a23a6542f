//! The register of effects.

use super::effect::Effect;

/// All known effects.
pub static ALL: [Effect; 41] = [
    super::payload::PAYLOAD,
    super::link_parameters::LINK_PARAMETERS,
    super::rotor_inertia::ROTOR_INERTIA,
    super::gravity_spring::GRAVITY_SPRING,
    super::base_tilt::BASE_TILT,
    super::encoder_offset::ENCODER_OFFSET,
    super::cable::CABLE,
    super::friction_level::FRICTION_LEVEL,
    super::torque_offset::TORQUE_OFFSET,
    super::stribeck::STRIBECK,
    super::nonlinear_viscous::NONLINEAR_VISCOUS,
    super::viscous_asymmetry::VISCOUS_ASYMMETRY,
    super::load_friction::LOAD_FRICTION,
    super::gear_efficiency::GEAR_EFFICIENCY,
    super::warm_up::WARM_UP,
    super::position_friction::POSITION_FRICTION,
    super::presliding::PRESLIDING,
    super::backlash::BACKLASH,
    super::elasticity::ELASTICITY,
    super::ripple::RIPPLE,
    super::wrist_coupling::WRIST_COUPLING,
    super::brake_drag::BRAKE_DRAG,
    super::torque_constant::TORQUE_CONSTANT,
    super::current_saturation::CURRENT_SATURATION,
    super::flux_weakening::FLUX_WEAKENING,
    super::time_delay::TIME_DELAY,
    super::filter_lag::FILTER_LAG,
    super::current_sign::CURRENT_SIGN,
    super::contact::CONTACT,
    super::apparent_torque::APPARENT_TORQUE,
    super::tracking_lag::TRACKING_LAG,
    super::zone_blending::ZONE_BLENDING,
    super::acceleration_limit::ACCELERATION_LIMIT,
    super::program_wait::PROGRAM_WAIT,
    super::speed_limit::SPEED_LIMIT,
    super::copper_loss::COPPER_LOSS,
    super::inverter_loss::INVERTER_LOSS,
    super::iron_loss::IRON_LOSS,
    super::no_regeneration::NO_REGENERATION,
    super::base_load::BASE_LOAD,
    super::brake_power::BRAKE_POWER,
];

/// The effect with this id.
#[must_use]
pub fn find(id: &str) -> Option<&'static Effect> {
    ALL.iter().find(|effect| effect.id == id)
}

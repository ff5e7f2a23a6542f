//! Families of torque effects that are easily confused.

/// Family names with the ids of their effects.
const FAMILIES: [(&str, &[&str]); 4] = [
    (
        "friction",
        &[
            "friction_level",
            "torque_offset",
            "stribeck",
            "nonlinear_viscous",
            "viscous_asymmetry",
            "load_friction",
            "gear_efficiency",
            "warm_up",
            "position_friction",
            "presliding",
        ],
    ),
    (
        "transmission",
        &["backlash", "elasticity", "rotor_inertia", "ripple", "wrist_coupling", "brake_drag"],
    ),
    (
        "rigid body",
        &[
            "payload",
            "link_parameters",
            "gravity_spring",
            "base_tilt",
            "encoder_offset",
            "cable",
            "contact",
        ],
    ),
    (
        "electrical",
        &[
            "torque_constant",
            "current_saturation",
            "flux_weakening",
            "current_sign",
            "time_delay",
            "filter_lag",
            "apparent_torque",
        ],
    ),
];

/// All ids of an effect's family; empty for effects of motion and power.
pub(super) fn family(id: &str) -> &'static [&'static str] {
    let of = FAMILIES.iter().find(|(_, ids)| ids.contains(&id));
    of.map_or(&[], |(_, ids)| ids)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::effects::{ALL, Channel};

    #[test]
    fn each_effect_of_the_torque_is_in_one() {
        for effect in ALL.iter().filter(|effect| effect.channel == Channel::Torque) {
            let of = FAMILIES.iter().filter(|(_, ids)| ids.contains(&effect.id)).count();
            assert_eq!(of, 1, "{}", effect.id);
        }
        let known = |id: &&str| ALL.iter().any(|effect| effect.id == *id);
        assert!(FAMILIES.iter().flat_map(|(_, ids)| *ids).all(known));
    }
}

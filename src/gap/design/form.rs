//! The coordinate in which a law may have another form than the library's.

use super::basis::Coordinate;

/// The coordinate of an effect's form; `None` for one whose form is known.
#[must_use]
pub fn form_of(id: &str) -> Option<Coordinate> {
    Some(match id {
        "stribeck" | "nonlinear_viscous" | "viscous_asymmetry" => Coordinate::Speed,
        "position_friction" => Coordinate::PositionSense,
        "load_friction" | "gear_efficiency" => Coordinate::LoadSense,
        "gravity_spring" | "cable" => Coordinate::Position,
        "current_saturation" => Coordinate::Load,
        "flux_weakening" => Coordinate::LoadSpeed,
        "presliding" | "backlash" => Coordinate::Reversal,
        "time_delay" | "filter_lag" => Coordinate::Reversal,
        "warm_up" => Coordinate::TimeSense,
        _ => return None,
    })
}

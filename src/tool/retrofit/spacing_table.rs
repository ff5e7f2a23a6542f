//! What the spacing of the points of streams is worth: the retrofit with other spacings.

use super::figures::{Retrofit, SpacingSaving};
use super::settings::Settings;
use super::simulated::TIME_TOLERANCE;

/// Spacings of the table, s.
const SPACINGS_S: [f64; 5] = [0.03, 0.05, 0.075, 0.1, 0.15];

/// The savings with other spacings, and of `result` with its own, by spacing. `retrofitted` makes a retrofit
/// with other settings; a spacing with which there is none is left out.
pub(super) fn spacing_table(
    settings: &Settings,
    result: &Retrofit,
    retrofitted: &dyn Fn(&Settings) -> Option<Retrofit>,
) -> Vec<SpacingSaving> {
    let is_used = |spacing: f64| (spacing - settings.spacing_s).abs() < TIME_TOLERANCE;
    let other = |spacing_s: f64| {
        let with = Settings { spacing_s, closest_s: spacing_s, pareto: 0, ..settings.clone() };
        Some(row(spacing_s, &retrofitted(&with)?, false))
    };
    let others = SPACINGS_S.into_iter().filter(|spacing| !is_used(*spacing));
    let mut table: Vec<SpacingSaving> = others.filter_map(other).collect();
    table.push(row(settings.spacing_s, result, true));
    table.sort_by(|a, b| a.spacing_s.total_cmp(&b.spacing_s));
    table
}

fn row(spacing_s: f64, of: &Retrofit, is_used: bool) -> SpacingSaving {
    SpacingSaving {
        spacing_s,
        points: of.segments.iter().map(|segment| segment.points).sum(),
        saved_j: of.original.energy_j - of.optimized.energy_j,
        motion_saving_percent: of.motion_saving_percent(),
        is_used,
    }
}

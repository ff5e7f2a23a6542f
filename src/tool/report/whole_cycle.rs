//! The whole cycle with the rest of the takt, as JSON and text.

use serde_json::{Value, json};

use crate::tool::retrofit::{CyclePoint, Rest, TaktBasis, TaktEnergy, WholeCycle};

/// The takt and its basis.
pub(super) fn takt_json(whole: &WholeCycle) -> Value {
    json!({
        "value_s": whole.takt_s,
        "basis": match whole.basis {
            TaktBasis::Given => "given",
            TaktBasis::Waits => "waits",
            TaktBasis::AsBefore => "as before",
        },
    })
}

/// The energy of one takt before and after, by cause.
pub(super) fn energy_json(whole: &WholeCycle) -> Value {
    let side = |of: &TaktEnergy| {
        json!({
            "time_s": of.time_s,
            "energy_j": of.energy_j(),
            "motion_j": of.motion_j,
            "standing_j": of.standing_j,
            "brake_j": of.brake_j,
            "base_j": of.base_j,
            "rest_j": of.rest.energy_j,
            "rest_s": of.rest.time_s,
            "rest_state": of.rest.state,
        })
    };
    json!({ "original": side(&whole.original), "optimized": side(&whole.optimized) })
}

/// The curve of energy over time with the points of today and of the retrofit.
pub(super) fn curve_json(whole: &WholeCycle) -> Value {
    let point = |point: &CyclePoint| {
        json!({
            "time_s": point.time_s,
            "energy_j": point.energy_j,
            "lower_bound_j": point.lower_bound_j,
            "rest_state": point.state,
        })
    };
    let side = |of: &TaktEnergy| json!({ "time_s": of.time_s, "energy_j": of.energy_j() });
    json!({
        "points": whole.curve.iter().map(point).collect::<Vec<Value>>(),
        "today": side(&whole.original),
        "proposed": side(&whole.optimized),
    })
}

/// The takt and its energy in words.
pub(super) fn text(whole: &WholeCycle) -> String {
    let basis = match whole.basis {
        TaktBasis::Given => "as given",
        TaktBasis::Waits => "from the waits with stated times",
        TaktBasis::AsBefore => "the cycle of today",
    };
    let (before, after) = (&whole.original, &whole.optimized);
    let part = |name: &str, of: fn(&TaktEnergy) -> f64| {
        format!("{name} {:.1} -> {:.1} J", of(before), of(after))
    };
    let state = |rest: &Rest| rest.state.as_ref().map(|name| format!(" in '{name}'"));
    let rest = |rest: &Rest| {
        format!("{:.1} J ({:.3} s{})", rest.energy_j, rest.time_s, state(rest).unwrap_or_default())
    };
    format!(
        "takt {:.3} s, {basis}: {:.1} J -> {:.1} J in a whole takt ({}, {}, {}, {}, rest of the takt \
         {} -> {})",
        whole.takt_s,
        before.energy_j(),
        after.energy_j(),
        part("motion", |of| of.motion_j),
        part("standing", |of| of.standing_j),
        part("brakes", |of| of.brake_j),
        part("base", |of| of.base_j),
        rest(&before.rest),
        rest(&after.rest),
    )
}

//! The verification and the assumptions of the figures.

use serde_json::{Value, json};

use super::format::fixed;
use crate::arm::robot::Model;
use crate::retime::motion::Simulation;
use crate::tool::report::json::{file, signal};
use crate::tool::report::place::Places;
use crate::tool::retrofit::{Retrofit, SignalShift};

/// The verification for the template.
pub(super) fn verification(retrofit: &Retrofit) -> Value {
    let found = &retrofit.verification;
    let worst = &found.worst;
    let check = |(what, held): &(String, bool)| json!({ "what": what, "held": held });
    // The largest share of a limit over all streams, and the length of its bar, %.
    let share = |name: &str, share: f64| {
        json!({
            "name": name,
            "percent": fixed(100.0 * share, 1),
            "length": format!("{:.1}", (100.0 * share).clamp(0.0, 100.0)),
        })
    };
    let shifted = |shift: &SignalShift| {
        let mut value = signal(shift);
        // ms, with its sign.
        value["shift"] = format!("{:+.0}", 1e3 * shift.largest_shift_s).into();
        value
    };
    json!({
        "passed": found.passed,
        "checks": found.checks.iter().map(check).collect::<Vec<_>>(),
        "shares": [
            share("joint speed", worst.velocity),
            share("joint acceleration", worst.acceleration),
            share("joint jerk", worst.jerk),
            share("joint torque", worst.torque),
            share("TCP speed", worst.tcp_speed),
            share("allowed path deviation", worst.deviation),
            share("allowed deviation of the points' polygon", worst.polygon),
        ],
        "deviation_mm": fixed(1e3 * worst.deviation_m, 3),
        "endpoint_error_rad": tiny(worst.endpoint_error_rad),
        "intended_error_rad": tiny(found.intended_error_rad),
        "signals": retrofit.signals.iter().map(shifted).collect::<Vec<_>>(),
        "outputs": retrofit.outputs.iter().map(file).collect::<Vec<_>>(),
    })
}

fn tiny(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.1e}") }
}

/// Assumptions on robot and program, and unresolved movements, for the template.
pub(super) fn basis(retrofit: &Retrofit, model: &Model, places: Places<'_>) -> Value {
    let simulation = &retrofit.before.0;
    json!({
        "robot": model.assumed(),
        "program": simulation.assumed,
        "unresolved": unresolved(simulation, places),
    })
}

/// The unresolved movements of a simulation, for the template.
pub(super) fn unresolved(simulation: &Simulation, places: Places<'_>) -> Vec<Value> {
    let notes = simulation.unresolved.iter();
    notes
        .map(|note| json!({ "place": places.of(note.span).to_string(), "reason": note.reason }))
        .collect()
}

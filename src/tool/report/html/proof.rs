//! The verification and the assumptions of the figures.

use serde::Serialize;

use super::format::fixed;
use crate::arm::robot::Model;
use crate::tool::report::place::Places;
use crate::tool::retrofit::{OutputKind, Retrofit, SignalKind};

#[derive(Serialize)]
pub(super) struct Verification {
    passed: bool,
    checks: Vec<Held>,
    shares: Vec<Share>,
    deviation_mm: String,
    endpoint_error_rad: String,
    intended_error_rad: String,
    signals: Vec<Signal>,
    outputs: Vec<Output>,
}

#[derive(Serialize)]
struct Held {
    what: String,
    held: bool,
}

/// The largest share of a limit over all streams.
#[derive(Serialize)]
struct Share {
    name: &'static str,
    percent: String,
    /// Length of its bar, %.
    length: String,
}

/// A signal before and after.
#[derive(Serialize)]
struct Signal {
    name: String,
    kind: &'static str,
    times: usize,
    order_kept: bool,
    /// ms, with its sign.
    shift: String,
}

#[derive(Serialize)]
struct Output {
    path: String,
    kind: &'static str,
}

pub(super) fn verification(retrofit: &Retrofit) -> Verification {
    let seen = &retrofit.verification;
    let worst = &seen.worst;
    let share = |name, share: f64| Share {
        name,
        percent: fixed(100.0 * share, 1),
        length: format!("{:.1}", (100.0 * share).clamp(0.0, 100.0)),
    };
    Verification {
        passed: seen.passed,
        checks: seen
            .checks
            .iter()
            .map(|(what, held)| Held { what: what.clone(), held: *held })
            .collect(),
        shares: vec![
            share("joint speed", worst.velocity),
            share("joint acceleration", worst.acceleration),
            share("joint jerk", worst.jerk),
            share("joint torque", worst.torque),
            share("TCP speed", worst.tcp_speed),
            share("allowed path deviation", worst.deviation),
            share("allowed deviation of the points' polygon", worst.polygon),
        ],
        deviation_mm: fixed(1e3 * worst.deviation_m, 3),
        endpoint_error_rad: tiny(worst.endpoint_error_rad),
        intended_error_rad: tiny(seen.intended_error_rad),
        signals: retrofit
            .signals
            .iter()
            .map(|signal| Signal {
                name: signal.name.clone(),
                kind: match signal.kind {
                    SignalKind::Input => "input",
                    SignalKind::Output => "output",
                },
                times: signal.times,
                order_kept: signal.order_kept,
                shift: format!("{:+.0}", 1e3 * signal.largest_shift_s),
            })
            .collect(),
        outputs: retrofit
            .outputs
            .iter()
            .map(|output| Output {
                path: output.path.clone(),
                kind: match output.kind {
                    OutputKind::Unchanged => "unchanged",
                    OutputKind::Changed => "changed",
                    OutputKind::New => "new",
                },
            })
            .collect(),
    }
}

fn tiny(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.1e}") }
}

/// The assumptions of the figures.
#[derive(Serialize)]
pub(super) struct Basis {
    robot: Vec<String>,
    program: Vec<String>,
    unresolved: Vec<Unresolved>,
}

#[derive(Serialize)]
struct Unresolved {
    place: String,
    reason: String,
}

/// Assumptions on robot and program, and unresolved movements.
pub(super) fn basis(retrofit: &Retrofit, model: &Model, places: Places<'_>) -> Basis {
    let simulation = &retrofit.before.0;
    Basis {
        robot: model.assumed(),
        program: simulation.assumed.clone(),
        unresolved: simulation
            .unresolved
            .iter()
            .map(|note| Unresolved {
                place: places.of(note.span).to_string(),
                reason: note.reason.clone(),
            })
            .collect(),
    }
}

//! What the verifier saw, and what the figures rest on.

use serde::Serialize;

use super::format::fixed;
use crate::report::place::Places;
use crate::retrofit::{OutputKind, Retrofit};
use crate::robot::Model;

/// The verification.
#[derive(Serialize)]
pub(super) struct Verification {
    passed: bool,
    checks: Vec<Held>,
    shares: Vec<Share>,
    deviation_mm: String,
    endpoint_error_rad: String,
    outputs: Vec<Output>,
}

#[derive(Serialize)]
struct Held {
    what: String,
    held: bool,
}

/// The largest share of a limit that any stream uses.
#[derive(Serialize)]
struct Share {
    name: &'static str,
    percent: String,
    /// Length of its bar, %.
    length: String,
}

#[derive(Serialize)]
struct Output {
    path: String,
    kind: &'static str,
}

/// The verification of a retrofit.
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
        ],
        deviation_mm: fixed(1e3 * worst.deviation_m, 3),
        endpoint_error_rad: if worst.endpoint_error_rad == 0.0 {
            "0".to_owned()
        } else {
            format!("{:.1e}", worst.endpoint_error_rad)
        },
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

/// What the figures rest on.
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

/// Assumptions about robot and program, and what could not be simulated.
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

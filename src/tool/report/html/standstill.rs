//! Dwells with holding power and break-even time of the brakes, as table 3 of Paes et al. 2014.

use std::collections::BTreeMap;

use serde::Serialize;

use super::format::{fixed, joules, range};
use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::optimize::idle::{Dwell, dwells};
use crate::retime::optimize::reason::Reason;
use crate::retime::path::joint_path::DOF;
use crate::tool::report::place::Places;
use crate::tool::retrofit::Retrofit;

/// The dwells of one place.
#[derive(Serialize)]
pub(super) struct Row {
    place: String,
    executions: usize,
    /// s; `None` if unknown.
    duration: Option<String>,
    /// W, mean over the executions.
    joints: Vec<String>,
    /// W.
    holding: String,
    /// s; `None` if nothing is to be held or no brake is known.
    break_even: Option<String>,
    /// J; `None` if the brake does not pay.
    potential: Option<String>,
}

/// The dwells of the original program by place, in source order.
pub(super) fn standstill(retrofit: &Retrofit, model: &Model, places: Places<'_>) -> Vec<Row> {
    let dwells = dwells(model, &retrofit.before.0);
    let mut by_place: BTreeMap<Span, Vec<&Dwell>> = BTreeMap::new();
    for dwell in &dwells {
        by_place.entry(dwell.span).or_default().push(dwell);
    }
    by_place.into_iter().map(|(span, dwells)| row(places.of(span).to_string(), &dwells)).collect()
}

fn row(place: String, dwells: &[&Dwell]) -> Row {
    let known =
        dwells.iter().filter(|d| !matches!(d.reason, Reason::UnknownDwell)).map(|d| d.duration);
    let n = dwells.len() as f64;
    let potential: f64 = dwells.iter().map(|d| d.potential_j).sum();
    let break_even: Vec<f64> = dwells.iter().filter_map(|d| d.break_even_s).collect();
    Row {
        place,
        executions: dwells.len(),
        duration: (known.clone().count() > 0).then(|| range(known, 2)),
        joints: (0..DOF)
            .map(|j| fixed(dwells.iter().map(|d| d.holding_w[j]).sum::<f64>() / n, 1))
            .collect(),
        holding: range(dwells.iter().map(|d| d.holding_w.iter().sum()), 1),
        break_even: (!break_even.is_empty()).then(|| range(break_even, 2)),
        potential: (potential > 0.0).then(|| joules(potential)),
    }
}

//! Larger zones, and zones in place of stop points where nothing happens.

use super::cell::Places;
use super::lever::{Lever, Offer, Offers, word};
use crate::rapid::text::Edit;
use crate::tool::lint::context::Context;
use crate::tool::lint::site::Site;
use crate::tool::lint::trace::Action;

/// Predefined zones and their sizes, mm.
const ZONES: [(&str, f64); 12] = [
    ("z1", 1.0),
    ("z5", 5.0),
    ("z10", 10.0),
    ("z15", 15.0),
    ("z20", 20.0),
    ("z30", 30.0),
    ("z40", 40.0),
    ("z50", 50.0),
    ("z60", 60.0),
    ("z80", 80.0),
    ("z100", 100.0),
    ("z150", 150.0),
];

/// The movements of the cycle with a zone of fixed size.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    context.sites.iter().filter_map(|site| lever(context, site)).collect()
}

fn lever(context: &Context<'_>, site: &Site<'_>) -> Option<Lever> {
    let (zone, written) = (site.facts.zone?, site.zone?);
    if !site.is_plain() || site.executions.is_empty() {
        return None;
    }
    let moves_on = |step: &usize| {
        context.trace.get(step + 1).is_some_and(|next| matches!(next.what, Action::Move(_)))
    };
    if zone.fine && !site.executions.iter().all(moves_on) {
        return None;
    }
    let now = if zone.fine { 0.0 } else { zone.tcp * 1e3 };
    let was = word(context, written.span);
    let larger = ZONES.iter().filter(|(_, size)| *size > now + 1e-9);
    let offer = |(name, _): &(&str, f64)| Offer {
        title: format!("{name} in place of {was}"),
        edits: vec![Edit { span: written.span, text: name.as_bytes().to_vec() }],
    };
    Some(Lever {
        span: site.stmt.span,
        risk: "the tool cuts the corner",
        places: Places::Same,
        offers: Offers::List(larger.map(offer).collect()),
    })
}

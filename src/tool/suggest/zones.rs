//! Larger zones, and zones in place of stop points where nothing happens.

use super::lever::{Lever, Offer, Offers, written};
use crate::rapid::builtins::zones;
use crate::rapid::text::Edit;
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::lint::site::Site;
use crate::tool::lint::trace::Action;

/// The movements of the cycle with a zone of fixed size.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    context.sites.iter().filter_map(|site| lever(context, site)).collect()
}

fn lever(context: &Context<'_>, site: &Site<'_>) -> Option<Lever> {
    let (zone, place) = (site.facts.zone?, site.zone?.span);
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
    let was = written(context, place);
    let larger = zones().filter(|(_, size)| *size > now + 1e-9);
    let offer = |(name, _): (&str, f64)| Offer {
        title: format!("{name} in place of {was}"),
        edits: vec![Edit { span: place, text: name.as_bytes().to_vec() }],
    };
    Some(Lever {
        span: site.stmt.span,
        risk: "the tool cuts the corner",
        kept: Kept::Outputs,
        offers: Offers::List(larger.map(offer).collect()),
    })
}

//! Other programmed speeds: slower where the time is not needed, faster for joint movements where the
//! base load costs more than the haste.

use super::lever::{Lever, Offer, Offers, written};
use crate::rapid::builtins::speeds;
use crate::rapid::text::Edit;
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::lint::site::Site;

/// Least and largest speed over the programmed one.
const RANGE: [f64; 2] = [0.4, 3.0];

/// The movements of the cycle with a fixed speed.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    context.sites.iter().filter_map(|site| lever(context, site)).collect()
}

fn lever(context: &Context<'_>, site: &Site<'_>) -> Option<Lever> {
    let speed = site.facts.speed?;
    if !site.is_plain() || site.executions.is_empty() {
        return None;
    }
    let was = written(context, site.speed.span);
    let now = speed.tcp * 1e3;
    // A line has its speed from the process.
    let most = if site.is_linear() { 1.0 } else { RANGE[1] };
    let others = speeds().filter(|v| {
        let share = f64::from(*v) / now;
        share >= RANGE[0] && share <= most && (share - 1.0).abs() > 1e-9
    });
    let offer = |v: u32| Offer {
        title: format!("v{v} in place of {was}"),
        edits: vec![Edit { span: site.speed.span, text: format!("v{v}").into_bytes() }],
    };
    Some(Lever {
        span: site.stmt.span,
        risk: "another speed",
        kept: Kept::Outputs,
        offers: Offers::List(others.map(offer).collect()),
    })
}

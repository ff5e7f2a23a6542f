//! Joint movements in place of lines between fly-by points.

use super::lever::{Lever, Offer, Offers};
use crate::rapid::builtins::MoveForm;
use crate::rapid::text::Edit;
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::lint::site::Site;

/// The lines that do not end at a stop point.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    context.sites.iter().filter_map(lever).collect()
}

fn lever(site: &Site<'_>) -> Option<Lever> {
    let is_line =
        site.signature.form == MoveForm::Linear && site.name.eq_ignore_ascii_case("MoveL");
    if !is_line || !site.is_plain() || site.is_stop() || site.executions.is_empty() {
        return None;
    }
    let offer = Offer {
        title: format!("MoveJ in place of {}", site.name),
        edits: vec![Edit { span: site.name_span, text: b"MoveJ".to_vec() }],
    };
    Some(Lever {
        span: site.stmt.span,
        risk: "the tool leaves the line",
        kept: Kept::Outputs,
        offers: Offers::List(vec![offer]),
    })
}

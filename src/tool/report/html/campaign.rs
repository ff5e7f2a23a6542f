//! The report of a campaign: what is done, what was found, what comes next.

use tera::Context;

use super::page::{ReportError, render};
use crate::tool::report::campaign::Done;

/// The HTML report of `campaign`.
///
/// # Errors
/// A template does not fit its data.
pub fn campaign_report(
    program: &str,
    done: &[Done],
    next: &str,
    experiments: &[String],
    figures: &[String],
) -> Result<String, ReportError> {
    let mut context = Context::new();
    context.insert("program", program);
    context.insert("done", done);
    context.insert("next", next);
    context.insert("experiments", experiments);
    context.insert("figures", figures);
    render(include_str!("../../../../templates/campaign.html.tera"), context)
}

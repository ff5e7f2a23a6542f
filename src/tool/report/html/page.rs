//! Renders a page from its template and data.

use tera::{Context, Tera};

/// Errors of a report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A template failed.
    #[error("a template of the report failed: {0}")]
    Template(#[from] tera::Error),
}

/// Renders a template with the style sheet and the version of the program.
///
/// # Errors
/// A template does not fit its data.
pub(super) fn render(template: &str, mut context: Context) -> Result<String, ReportError> {
    context.insert("version", env!("CARGO_PKG_VERSION"));
    let mut tera = Tera::default();
    tera.add_raw_templates(vec![
        ("report.css", include_str!("../../../../templates/report.css")),
        ("reliability.html", include_str!("../../../../templates/reliability.html.tera")),
        ("page.html", template),
    ])?;
    Ok(tera.render("page.html", &context)?)
}

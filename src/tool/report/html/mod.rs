//! Results as one self-contained HTML page: style sheet and plots inline, no scripts, no external
//! resources.

mod campaign;
mod comparison;
mod cycle_curve;
mod diagnose;
mod energy_time;
mod figure;
mod format;
mod grades;
mod identify;
mod movements;
mod page;
mod placement;
mod proof;
mod prove;
mod reliability;
mod samples;
mod segments;
mod simulation;
mod source;
mod standstill;
mod summary;
mod waits;
mod ways;

pub use campaign::campaign_report;
pub use comparison::comparison_report;
pub use diagnose::{Excerpt, Line, Pictures, diagnose_report};
pub use grades::grades_report;
pub use identify::{Traces, identify_report};
pub use page::ReportError;
pub use placement::place_report;
pub use prove::prove_report;
pub use simulation::simulate_report;
pub use waits::waits_report;

use tera::Context;

use page::render;

use super::place::Places;
use super::plausible::saving;
use super::whole_cycle;
use crate::arm::robot::Model;
use crate::rapid::text::SourceFile;
use crate::tool::retrofit::{Retrofit, Source};

/// The HTML report of a retrofit: figures of the cycle, segments, plots, dwells, source with
/// energies, verification, assumptions. `files` are indexed by file id; `entry` is the routine that
/// starts the program.
///
/// # Errors
/// A template does not fit its data.
pub fn optimize_report(
    retrofit: &Retrofit,
    files: &[Source],
    model: &Model,
    entry: &str,
) -> Result<String, ReportError> {
    // Relative paths are short and do not depend on the location of the program.
    let originals: Vec<SourceFile> = files
        .iter()
        .map(|source| SourceFile { path: source.relative.clone(), ..source.file.clone() })
        .collect();
    let places = Places::new(&originals);
    let mut context = Context::new();
    context.insert("robot", &model.name);
    context.insert("entry", entry);
    context.insert("plausible", &saving(retrofit));
    context.insert("notes", &retrofit.notes);
    context.insert("summary", &summary::summary(retrofit));
    context.insert("spacings", &summary::spacings(retrofit));
    context.insert("segments", &segments::segments(retrofit, places));
    context.insert("energy_time", &energy_time::energy_time(retrofit, places));
    context.insert("cycle_curve", &cycle_curve::cycle_curve(&retrofit.whole_cycle));
    context.insert("whole_cycle", &whole_cycle::text(&retrofit.whole_cycle));
    context.insert("movements", &movements::movements(retrofit, model, places));
    context.insert("dwells", &standstill::standstill(retrofit, model, places));
    context.insert("joints", &(1..=model.dof).collect::<Vec<usize>>());
    context.insert("sources", &source::sources(retrofit, &originals));
    context.insert("verification", &proof::verification(retrofit));
    context.insert("basis", &proof::basis(retrofit, model, places));
    render(include_str!("../../../../templates/report.html.tera"), context)
}

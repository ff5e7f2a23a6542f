//! Fixes of findings.

use std::collections::HashMap;

use gen_lsp_types::{CodeAction, CodeActionKind, Range, TextEdit, Uri, WorkspaceEdit};

use super::diagnostics::of_finding;
use super::findings::Analysis;
use super::position::{Positions, Units};
use crate::rapid::text::Edit;
use crate::tool::lint::{Applicability, Finding};

/// The fixes of the findings that touch a range. Fixes that change other files are only available
/// on the command line.
pub(super) fn code_actions(
    analysis: &Analysis,
    units: Units,
    uri: &Uri,
    range: &Range,
) -> Vec<CodeAction> {
    let file = &analysis.file;
    let positions = Positions::new(file, units);
    let (start, end) = (positions.byte(range.start), positions.byte(range.end));
    let touched = analysis.own_findings().filter(|it| it.span.start <= end && start <= it.span.end);
    let action = |finding: &Finding| {
        let fix = finding.fix.as_ref()?;
        fix.edits.iter().all(|edit| edit.span.file == file.id).then_some(())?;
        let edit = |edit: &Edit| TextEdit {
            range: positions.range(edit.span),
            new_text: String::from_utf8_lossy(&edit.text).into_owned(),
        };
        let edits = fix.edits.iter().map(edit).collect();
        let doubt = match fix.applicability {
            Applicability::Safe => "",
            Applicability::Unsafe => " (unsafe)",
        };
        Some(CodeAction {
            title: format!("{}: {}{doubt}", finding.rule.code, finding.change),
            kind: Some(CodeActionKind::QuickFix),
            diagnostics: Some(vec![of_finding(finding, positions)]),
            is_preferred: Some(fix.applicability == Applicability::Safe),
            edit: Some(WorkspaceEdit {
                changes: Some(HashMap::from([(uri.clone(), edits)])),
                ..WorkspaceEdit::default()
            }),
            ..CodeAction::default()
        })
    };
    touched.filter_map(action).collect()
}

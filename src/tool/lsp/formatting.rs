//! Formatting of documents.

use gen_lsp_types::{Range, TextEdit};

use super::workspace::View;
use crate::rapid::format::{Style, format, format_range};
use crate::rapid::text::Edit;

/// The edits that format a document, or the statements that a range touches.
pub(super) fn formatting(view: View<'_>, style: &Style, range: Option<&Range>) -> Vec<TextEdit> {
    let file = &view.project.module(view.file).file;
    let edits = match range {
        None => format(file, style),
        Some(range) => {
            let span = view.positions().span(range);
            format_range(file, span.start..span.end, style)
        }
    };
    let edit = |edit: Edit| TextEdit {
        range: view.positions().range(edit.span),
        new_text: file.charset.decode(&edit.text).into_owned(),
    };
    edits.into_iter().map(edit).collect()
}

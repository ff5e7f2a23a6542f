//! Strings that name modules: `Load "HOME:/Part.mod"`.

use gen_lsp_types::DocumentLink;

use super::workspace::View;
use crate::rapid::syntax::TokenKind;
use crate::rapid::text::{FileId, Span};

/// The strings of a document that end with the name of a file of its project. Where several folders have such
/// a file, it is the one with the whole path; if none or several have that, there is no link.
pub(super) fn document_links(view: View<'_>) -> Vec<DocumentLink> {
    let tokens = view.project.module(view.file).parse().tree.tokens();
    let strings = (0..tokens.count()).filter(|one| tokens.kind(*one) == TokenKind::String);
    let link = |token| {
        let range = tokens.range(token);
        // Without the quotation marks.
        let span = Span { file: view.file, start: range.start + 1, end: range.end - 1 };
        let target = view.uri_of(file_named(view, &view.project.text(span))?);
        Some(DocumentLink {
            range: view.positions().range(span),
            target: Some(target.into()),
            tooltip: None,
            data: None,
        })
    };
    strings.filter_map(link).collect()
}

/// The file that a path of the controller names, if it is only one.
fn file_named(view: View<'_>, path: &str) -> Option<FileId> {
    let name = |path: &str| path.rsplit(['/', '\\', ':']).next().unwrap_or(path).to_lowercase();
    let wanted = name(path);
    let modules = view.project.modules.iter().map(|module| &module.file);
    let mut found: Vec<_> = modules.filter(|file| name(&file.path) == wanted).collect();
    if found.len() > 1 {
        // Behind the device, as in `HOME:/b/Part.mod`.
        let path = path.rsplit(':').next().unwrap_or(path).replace('\\', "/");
        let end = format!("/{}", path.trim_start_matches('/')).to_lowercase();
        found.retain(|file| file.path.to_lowercase().ends_with(&end));
    }
    if let [file] = found[..] { Some(file.id) } else { None }
}

//! The symbols of a document and of the workspace.

use gen_lsp_types::{
    BaseSymbolInformation, DocumentSymbol, Location, SymbolInformation, SymbolKind,
};

use super::outline::{Symbol, outline};
use super::workspace::View;
use crate::rapid::text::FileId;

/// Most symbols in one answer about the workspace.
const MOST: usize = 1_000;

/// The symbols of a document, one inside the other.
pub(super) fn nested(view: View<'_>) -> Vec<DocumentSymbol> {
    let symbols = outline(view.project.module(view.file));
    symbols.into_iter().map(|symbol| document_symbol(view, symbol)).collect()
}

#[expect(deprecated, reason = "the type has a field without a default that nobody reads")]
fn document_symbol(view: View<'_>, symbol: Symbol) -> DocumentSymbol {
    let children: Vec<_> =
        symbol.children.into_iter().map(|child| document_symbol(view, child)).collect();
    DocumentSymbol {
        name: symbol.name,
        detail: Some(symbol.detail),
        kind: symbol.kind,
        tags: None,
        deprecated: None,
        range: view.positions().range(symbol.whole),
        selection_range: view.positions().range(symbol.place),
        children: (!children.is_empty()).then_some(children),
    }
}

/// The symbols of a document in the order of the text.
pub(super) fn flat(view: View<'_>) -> Vec<SymbolInformation> {
    let mut found = Vec::new();
    for symbol in outline(view.project.module(view.file)) {
        add(view, symbol, None, &|_| true, &mut found);
    }
    found
}

/// The symbols of a workspace whose names contain the letters of `query` in this order. The data of
/// routines are left out.
pub(super) fn of_workspace(views: &[View<'_>], query: &str) -> Vec<SymbolInformation> {
    let query: Vec<char> = query.to_lowercase().chars().filter(|it| !it.is_whitespace()).collect();
    let matches = |symbol: &Symbol| {
        let name = symbol.name.to_lowercase();
        let mut letters = name.chars();
        query.iter().all(|wanted| letters.any(|letter| letter == *wanted))
    };
    let mut found = Vec::new();
    for view in views {
        for index in 0..view.project.modules.len() {
            let view = View { file: FileId(index as u32), ..*view };
            for symbol in outline(view.project.module(view.file)) {
                add(view, without_local_data(symbol), None, &matches, &mut found);
            }
            if found.len() >= MOST {
                found.truncate(MOST);
                return found;
            }
        }
    }
    found
}

fn without_local_data(mut symbol: Symbol) -> Symbol {
    for child in &mut symbol.children {
        if matches!(child.kind, SymbolKind::Function | SymbolKind::Event) {
            child.children.clear();
        }
    }
    symbol
}

#[expect(deprecated, reason = "the type has a field without a default that nobody reads")]
fn add(
    view: View<'_>,
    symbol: Symbol,
    container: Option<&str>,
    wanted: &dyn Fn(&Symbol) -> bool,
    found: &mut Vec<SymbolInformation>,
) {
    if wanted(&symbol) {
        let Location { uri, range } = view.location(symbol.place);
        found.push(SymbolInformation {
            deprecated: None,
            location: Location { uri, range },
            base_symbol_information: BaseSymbolInformation {
                name: symbol.name.clone(),
                kind: symbol.kind,
                tags: None,
                container_name: container.map(str::to_owned),
            },
        });
    }
    for child in symbol.children {
        add(view, child, Some(&symbol.name), wanted, found);
    }
}

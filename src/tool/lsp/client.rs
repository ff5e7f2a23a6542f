//! What the client can do.

use serde_json::Value;

use super::position::Units;

/// Abilities of the client.
#[derive(Clone, Debug, Default)]
pub(super) struct Client {
    /// What the columns of positions count.
    pub(super) units: Units,
    /// Whether it asks for diagnostics; otherwise they are sent.
    pub(super) pulls_diagnostics: bool,
    /// Whether it asks again for diagnostics when it is told to.
    pub(super) refreshes_diagnostics: bool,
    /// Whether diagnostics may have further places.
    pub(super) related_places: bool,
    /// Whether completions may have places to fill in.
    pub(super) snippets: bool,
    /// Whether the symbols of a document may contain others.
    pub(super) nested_symbols: bool,
    /// Whether it can be asked to tell about changed files.
    pub(super) watches_files: bool,
}

impl Client {
    /// Reads the parameters of `initialize`.
    pub(super) fn new(params: &Value) -> Client {
        let at = |path: &str| params.pointer(&format!("/capabilities/{path}"));
        let has = |path: &str| at(path).and_then(Value::as_bool).unwrap_or(false);
        let encodings = at("general/positionEncodings").and_then(Value::as_array);
        let utf8 = encodings.is_some_and(|all| all.iter().any(|one| one == "utf-8"));
        Client {
            units: if utf8 { Units::Utf8 } else { Units::Utf16 },
            pulls_diagnostics: at("textDocument/diagnostic").is_some_and(Value::is_object),
            refreshes_diagnostics: has("workspace/diagnostics/refreshSupport"),
            related_places: has("textDocument/publishDiagnostics/relatedInformation"),
            snippets: has("textDocument/completion/completionItem/snippetSupport"),
            nested_symbols: has("textDocument/documentSymbol/hierarchicalDocumentSymbolSupport"),
            watches_files: has("workspace/didChangeWatchedFiles/dynamicRegistration"),
        }
    }
}

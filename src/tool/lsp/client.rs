//! What the client can do.

use serde_json::Value;

use super::completion::Form;
use super::position::Units;

/// Abilities of the client.
#[derive(Clone, Debug, Default)]
pub(super) struct Client {
    /// What the columns of positions count.
    pub(super) units: Units,
    /// How it gets diagnostics.
    pub(super) delivery: Delivery,
    /// Whether diagnostics may have further places.
    pub(super) related_places: bool,
    /// What it does with actions that are worked out once they are chosen, and create files.
    pub(super) late_edits: LateEdits,
    /// Whether completions may have places to fill in.
    pub(super) form: Form,
    /// Whether the symbols of a document may contain others.
    pub(super) nested_symbols: bool,
    /// Whether it can be asked to tell about changed files.
    pub(super) watches_files: bool,
}

/// How diagnostics come to the client.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Delivery {
    /// They are sent.
    #[default]
    Sent,
    /// It asks for them.
    Asked,
    /// The same, and it asks again when it is told to.
    AskedAgain,
}

/// What the client does with actions that are worked out once they are chosen, and create files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum LateEdits {
    /// It does not know them.
    #[default]
    Unknown,
    /// It makes the changes.
    Made,
    /// It shows the changes before it makes them.
    Shown,
}

impl Client {
    /// Reads the parameters of `initialize`.
    pub(super) fn new(params: &Value) -> Client {
        let at = |path: &str| params.pointer(&format!("/capabilities/{path}"));
        let has = |path: &str| at(path).and_then(Value::as_bool).unwrap_or(false);
        let asks = at("textDocument/diagnostic").is_some_and(Value::is_object);
        let lists = |path: &str, item: &str| {
            let list = at(path).and_then(Value::as_array);
            list.is_some_and(|list| list.iter().any(|one| one == item))
        };
        let snippets = has("textDocument/completion/completionItem/snippetSupport");
        let edits_late = lists("textDocument/codeAction/resolveSupport/properties", "edit")
            && has("textDocument/codeAction/dataSupport")
            && has("workspace/workspaceEdit/documentChanges")
            && lists("workspace/workspaceEdit/resourceOperations", "create");
        Client {
            units: if lists("general/positionEncodings", "utf-8") {
                Units::Utf8
            } else {
                Units::Utf16
            },
            delivery: match (asks, has("workspace/diagnostics/refreshSupport")) {
                (false, _) => Delivery::Sent,
                (true, false) => Delivery::Asked,
                (true, true) => Delivery::AskedAgain,
            },
            related_places: has("textDocument/publishDiagnostics/relatedInformation"),
            late_edits: match (edits_late, at("workspace/workspaceEdit/changeAnnotationSupport")) {
                (false, _) => LateEdits::Unknown,
                (true, None) => LateEdits::Made,
                (true, Some(_)) => LateEdits::Shown,
            },
            form: if snippets { Form::Snippet } else { Form::Plain },
            nested_symbols: has("textDocument/documentSymbol/hierarchicalDocumentSymbolSupport"),
            watches_files: has("workspace/didChangeWatchedFiles/dynamicRegistration"),
        }
    }
}

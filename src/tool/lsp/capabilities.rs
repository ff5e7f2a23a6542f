//! What the server can do.

use gen_lsp_types::{
    CodeActionKind, CodeActionOptions, CodeLensOptions, CompletionOptions, DiagnosticOptions,
    DocumentLinkOptions, InitializeResult, RenameOptions, SemanticTokensOptions,
    ServerCapabilities, ServerInfo, SignatureHelpOptions, TextDocumentSyncKind,
    TextDocumentSyncOptions,
};
use serde_json::json;

use super::client::Client;
use super::semantic_tokens::legend;

/// The capabilities of the server, its name and version.
pub(super) fn initialize_result(client: &Client) -> InitializeResult {
    let strings = |signs: &[&str]| Some(signs.iter().map(|sign| (*sign).to_owned()).collect());
    InitializeResult {
        capabilities: ServerCapabilities {
            position_encoding: Some(client.units.kind()),
            text_document_sync: Some(
                TextDocumentSyncOptions {
                    open_close: Some(true),
                    change: Some(TextDocumentSyncKind::Incremental),
                    save: Some(true.into()),
                    ..TextDocumentSyncOptions::default()
                }
                .into(),
            ),
            hover_provider: Some(true.into()),
            code_action_provider: Some(
                CodeActionOptions {
                    code_action_kinds: Some(vec![
                        CodeActionKind::QuickFix,
                        CodeActionKind::RefactorRewrite,
                    ]),
                    resolve_provider: Some(true),
                    ..CodeActionOptions::default()
                }
                .into(),
            ),
            definition_provider: Some(true.into()),
            type_definition_provider: Some(true.into()),
            references_provider: Some(true.into()),
            document_highlight_provider: Some(true.into()),
            document_symbol_provider: Some(true.into()),
            workspace_symbol_provider: Some(true.into()),
            rename_provider: Some(
                RenameOptions { prepare_provider: Some(true), ..RenameOptions::default() }.into(),
            ),
            completion_provider: Some(CompletionOptions {
                trigger_characters: strings(&["\\", "."]),
                ..CompletionOptions::default()
            }),
            signature_help_provider: Some(SignatureHelpOptions {
                trigger_characters: strings(&["(", ",", "\\", " "]),
                ..SignatureHelpOptions::default()
            }),
            document_formatting_provider: Some(true.into()),
            document_range_formatting_provider: Some(true.into()),
            code_lens_provider: Some(CodeLensOptions::default()),
            inlay_hint_provider: Some(true.into()),
            document_link_provider: Some(DocumentLinkOptions::default()),
            folding_range_provider: Some(true.into()),
            call_hierarchy_provider: Some(true.into()),
            semantic_tokens_provider: Some(
                SemanticTokensOptions {
                    legend: legend(),
                    full: Some(true.into()),
                    ..SemanticTokensOptions::default()
                }
                .into(),
            ),
            diagnostic_provider: Some(
                DiagnosticOptions {
                    inter_file_dependencies: true,
                    workspace_diagnostics: false,
                    ..DiagnosticOptions::default()
                }
                .into(),
            ),
            workspace: serde_json::from_value(json!({
                "workspaceFolders": { "supported": true, "changeNotifications": true }
            }))
            .ok(),
            ..ServerCapabilities::default()
        },
        server_info: Some(ServerInfo {
            name: "joulepath".to_owned(),
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        }),
    }
}

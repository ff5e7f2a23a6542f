//! The language server: shows findings with energies while the user types.
//!
//! It uses the Language Server Protocol over standard input and output. A document is linted with
//! the files of its folder; the editor's text replaces the text on disk. After a change only the
//! programs that contain the document are linted again.

mod position;
mod workspace;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use gen_lsp_types::{
    Code, CodeAction, CodeActionKind, CodeActionOptions, CodeActionParams, Contents, Diagnostic,
    DiagnosticSeverity, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, Hover, HoverParams, InitializeResult,
    LspNotificationMethod, LspRequestMethod, MarkupContent, MarkupKind, Position,
    PositionEncodingKind, PublishDiagnosticsParams, Range, ServerCapabilities, ServerInfo,
    TextDocumentSyncKind, TextDocumentSyncOptions, TextEdit, Uri, WorkspaceEdit,
};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, Response};
use serde_json::{Value, from_value, json};

use position::{offset_of, range_of};
use workspace::{Analysis, Workspace};

use crate::rapid::diagnostics::Severity;
use crate::rapid::text::SourceFile;
use crate::tool::lint::{Applicability, Finding, Programs};

/// Options that an editor may send at the start of the server.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(default)]
pub struct Options {
    /// The robot, by name or file.
    pub robot: Option<String>,
    /// The routine that starts the program.
    pub entry: Option<String>,
    /// Times of inputs, such as `diPart=2.5`.
    pub inputs: Vec<String>,
}

/// Why a session ended early.
#[derive(Debug, thiserror::Error)]
pub enum LspError {
    /// The client does not speak the protocol.
    #[error(
        "the editor does not speak the language server protocol: {0}; start the server from one"
    )]
    Protocol(#[from] lsp_server::ProtocolError),
    /// The client has closed the connection.
    #[error("the editor has closed the connection")]
    Closed,
    /// Standard input or output failed.
    #[error("standard input or output failed: {0}")]
    Io(#[from] std::io::Error),
}

/// Runs until the editor ends the session. `read` reads the programs of a folder.
///
/// # Errors
/// The client does not speak the protocol, or has closed the connection.
pub fn serve(
    defaults: Options,
    read: impl Fn(&Options, &Path) -> Programs,
) -> Result<(), LspError> {
    let (connection, threads) = Connection::stdio();
    let (id, params) = connection.initialize_start()?;
    let sent = params.get("initializationOptions").cloned().unwrap_or_default();
    let sent: Options = from_value(sent).unwrap_or_default();
    let options = Options {
        robot: sent.robot.or(defaults.robot),
        entry: sent.entry.or(defaults.entry),
        inputs: if sent.inputs.is_empty() { defaults.inputs } else { sent.inputs },
    };
    connection.initialize_finish(id, json!(initialize_result()))?;
    let workspace = Workspace::new(|folder| read(&options, folder));
    let mut server = Server { workspace, analyses: BTreeMap::new() };
    for message in &connection.receiver {
        let answers = match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request)? {
                    break;
                }
                vec![Message::Response(server.answer_request(request))]
            }
            // A notification has no response, so a malformed one is ignored.
            Message::Notification(notification) => {
                server.handle_notification(notification).unwrap_or_default()
            }
            Message::Response(_) => Vec::new(),
        };
        for answer in answers {
            connection.sender.send(answer).map_err(|_| LspError::Closed)?;
        }
    }
    drop(connection);
    threads.join()?;
    Ok(())
}

/// The capabilities of the server, its name and version.
fn initialize_result() -> InitializeResult {
    InitializeResult {
        capabilities: ServerCapabilities {
            position_encoding: Some(PositionEncodingKind::UTF16),
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
                    code_action_kinds: Some(vec![CodeActionKind::QuickFix]),
                    ..CodeActionOptions::default()
                }
                .into(),
            ),
            ..ServerCapabilities::default()
        },
        server_info: Some(ServerInfo {
            name: "joulepath".to_owned(),
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        }),
    }
}

struct Server<R> {
    workspace: Workspace<R>,
    /// The last analysis of each open document, by URI.
    analyses: BTreeMap<String, Analysis>,
}

impl<R: Fn(&Path) -> Programs> Server<R> {
    /// Handles a notification; returns the changed diagnostics.
    fn handle_notification(
        &mut self,
        notification: Notification,
    ) -> serde_json::Result<Vec<Message>> {
        let Notification { method, params } = notification;
        let uri = match LspNotificationMethod::from(method.as_str()) {
            LspNotificationMethod::TextDocumentDidOpen => {
                let document = from_value::<DidOpenTextDocumentParams>(params)?.text_document;
                self.workspace.open(&document.uri.0, document.text);
                document.uri.0
            }
            LspNotificationMethod::TextDocumentDidChange => {
                let params: DidChangeTextDocumentParams = from_value(params)?;
                let uri = params.text_document.text_document_identifier.uri.0;
                for change in params.content_changes {
                    self.workspace.change(&uri, change);
                }
                uri
            }
            LspNotificationMethod::TextDocumentDidSave => {
                let params: DidSaveTextDocumentParams = from_value(params)?;
                self.workspace.forget(&params.text_document.uri.0);
                params.text_document.uri.0
            }
            LspNotificationMethod::TextDocumentDidClose => {
                let params: DidCloseTextDocumentParams = from_value(params)?;
                return Ok(self.close(params.text_document.uri.0));
            }
            _ => return Ok(Vec::new()),
        };
        Ok(self.lint(&uri, &mut BTreeSet::new()))
    }

    /// Closes a document, and lints its folder again with the file on disk.
    fn close(&mut self, uri: String) -> Vec<Message> {
        self.workspace.close(&uri);
        self.analyses.remove(&uri);
        let mut stale = self.workspace.open_beside(&uri);
        let mut messages = vec![publish(uri, Vec::new())];
        while let Some(other) = stale.pop_first() {
            messages.extend(self.lint(&other, &mut stale));
        }
        messages
    }

    /// The diagnostics of a document and of the open documents of its programs, which are removed
    /// from `stale`.
    fn lint(&mut self, uri: &str, stale: &mut BTreeSet<String>) -> Vec<Message> {
        let mut messages = Vec::new();
        for (uri, analysis) in self.workspace.analyse(uri) {
            stale.remove(&uri);
            let diagnostics = analysis
                .own_findings()
                .map(|finding| diagnostic(finding, &analysis.file))
                .collect();
            messages.push(publish(uri.clone(), diagnostics));
            self.analyses.insert(uri, analysis);
        }
        messages
    }

    fn answer_request(&self, Request { id, method, params }: Request) -> Response {
        let answer = match LspRequestMethod::from(method.as_str()) {
            LspRequestMethod::TextDocumentHover => self.hover(params),
            LspRequestMethod::TextDocumentCodeAction => self.code_actions(params),
            method => {
                let message = format!("{method} is not served");
                return Response::new_err(id, ErrorCode::MethodNotFound as i32, message);
            }
        };
        match answer {
            Ok(result) => Response::new_ok(id, result),
            Err(error) => Response::new_err(id, ErrorCode::InvalidParams as i32, error.to_string()),
        }
    }

    fn hover(&self, params: Value) -> serde_json::Result<Value> {
        let place = from_value::<HoverParams>(params)?.text_document_position_params;
        let analysis = self.analyses.get(&place.text_document.uri.0);
        Ok(json!(analysis.and_then(|analysis| hover(analysis, place.position))))
    }

    fn code_actions(&self, params: Value) -> serde_json::Result<Value> {
        let CodeActionParams { text_document, range, .. } = from_value(params)?;
        let analysis = self.analyses.get(&text_document.uri.0);
        let actions = analysis.map(|analysis| code_actions(analysis, &text_document.uri, range));
        Ok(json!(actions.unwrap_or_default()))
    }
}

fn publish(uri: String, diagnostics: Vec<Diagnostic>) -> Message {
    Message::Notification(Notification {
        method: LspNotificationMethod::TextDocumentPublishDiagnostics.to_string(),
        params: json!(PublishDiagnosticsParams { uri: Uri(uri), version: None, diagnostics }),
    })
}

fn diagnostic(finding: &Finding, file: &SourceFile) -> Diagnostic {
    Diagnostic {
        range: range_of(file, finding.span),
        severity: Some(match finding.severity {
            Severity::Error => DiagnosticSeverity::Error,
            Severity::Warning => DiagnosticSeverity::Warning,
            Severity::Info => DiagnosticSeverity::Information,
        }),
        code: Some(Code::String(finding.rule.code.to_owned())),
        source: Some("joulepath".to_owned()),
        message: finding.full_message().into(),
        data: Some(json!({ "saving_j": finding.saving.map(|saving| saving.energy_j) })),
        ..Diagnostic::default()
    }
}

/// Time and energy of the movement or wait at a position, summed over its executions in a cycle.
fn hover(analysis: &Analysis, position: Position) -> Option<Hover> {
    let costs = analysis.costs_at(offset_of(&analysis.file, position))?;
    let times = match costs.times {
        1 => String::new(),
        times => format!(", {times} times a cycle together"),
    };
    let joules = costs.energy_j.map_or_else(String::new, |joules| format!("{joules:.1} J, "));
    let value = format!("**{}**: {joules}{:.3} s{times}", costs.what, costs.time_s);
    Some(Hover {
        contents: Contents::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value }),
        range: Some(range_of(&analysis.file, costs.span)),
    })
}

/// The fixes of the findings that touch a range. Fixes that change other files are only available
/// on the command line.
fn code_actions(analysis: &Analysis, uri: &Uri, range: Range) -> Vec<CodeAction> {
    let file = &analysis.file;
    let (start, end) = (offset_of(file, range.start), offset_of(file, range.end));
    let touched = analysis.own_findings().filter(|it| it.span.start <= end && start <= it.span.end);
    let action = |finding: &Finding| {
        let fix = finding.fix.as_ref()?;
        fix.edits.iter().all(|edit| edit.span.file == file.id).then_some(())?;
        let edit = |edit: &crate::rapid::text::Edit| TextEdit {
            range: range_of(file, edit.span),
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
            diagnostics: Some(vec![diagnostic(finding, file)]),
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

//! Answers to requests.

use gen_lsp_types::{
    CodeAction, CodeActionParams, InlayHintParams, LspRequestMethod, Position, Range,
    TextDocumentIdentifier, Uri,
};
use lsp_server::{ErrorCode, Request, Response};
use serde_json::{Value, from_value, json};

use super::actions::code_actions;
use super::calls;
use super::client::LateEdits;
use super::completion;
use super::costs::of_statement;
use super::definition::{self, Declarations};
use super::findings::Analysis;
use super::folding::folding_ranges;
use super::formatting::formatting;
use super::host::Host;
use super::hover::hover;
use super::lens::{code_lenses, inlay_hints};
use super::links::document_links;
use super::one_run;
use super::rename::{self, Refusal};
use super::semantic_tokens::semantic_tokens;
use super::server::Server;
use super::signature_help::signature_help;
use super::symbols;
use super::uri::path_of;
use super::workspace::View;

/// Why a request has no answer.
enum Failure {
    /// Its parameters are wrong.
    Parameters(serde_json::Error),
    /// It cannot be done.
    Refused(String),
    /// The method is not served.
    Method(String),
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Failure {
        Failure::Parameters(error)
    }
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Failure {
        Failure::Refused(refusal.to_string())
    }
}

/// A document and a place in it.
#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase")]
struct At {
    text_document: TextDocumentIdentifier,
    position: Position,
}

/// A document.
#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase")]
struct Document {
    text_document: TextDocumentIdentifier,
}

/// An entry of a hierarchy of calls.
#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase")]
struct Caller {
    uri: Uri,
    selection_range: Range,
}

/// The answer to a request.
pub(super) fn answer<H: Host>(server: &mut Server<H>, request: Request) -> Response {
    let Request { id, method, params } = request;
    match result(server, &method, params) {
        Ok(result) => Response::new_ok(id, result),
        Err(Failure::Parameters(error)) => {
            Response::new_err(id, ErrorCode::InvalidParams as i32, error.to_string())
        }
        Err(Failure::Refused(reason)) => {
            Response::new_err(id, ErrorCode::RequestFailed as i32, reason)
        }
        Err(Failure::Method(reason)) => {
            Response::new_err(id, ErrorCode::MethodNotFound as i32, reason)
        }
    }
}

fn result<H: Host>(server: &mut Server<H>, method: &str, params: Value) -> Result<Value, Failure> {
    match LspRequestMethod::from(method) {
        LspRequestMethod::TextDocumentHover => hovered(server, params),
        LspRequestMethod::TextDocumentCodeAction => actions(server, params),
        LspRequestMethod::CodeActionResolve => resolve(server, params),
        LspRequestMethod::TextDocumentDefinition => {
            at(server, params, |view, byte| json!(definition::definition(view, byte)))
        }
        LspRequestMethod::TextDocumentTypeDefinition => {
            at(server, params, |view, byte| json!(definition::type_definition(view, byte)))
        }
        LspRequestMethod::TextDocumentReferences => {
            let with = match params.pointer("/context/includeDeclaration") {
                Some(Value::Bool(false)) => Declarations::LeftOut,
                _ => Declarations::Included,
            };
            at(server, params, |view, byte| json!(definition::references(view, byte, with)))
        }
        LspRequestMethod::TextDocumentDocumentHighlight => {
            at(server, params, |view, byte| json!(definition::highlights(view, byte)))
        }
        LspRequestMethod::TextDocumentSignatureHelp => {
            at(server, params, |view, byte| json!(signature_help(view, byte)))
        }
        LspRequestMethod::TextDocumentCompletion => {
            let form = server.client.form;
            at(server, params, |view, byte| json!(completion::completion(view, byte, form)))
        }
        LspRequestMethod::TextDocumentPrepareCallHierarchy => {
            at(server, params, |view, byte| json!(calls::prepare(view, byte)))
        }
        LspRequestMethod::CallHierarchyIncomingCalls => {
            caller(server, &params, |view, costs, byte| json!(calls::incoming(view, costs, byte)))
        }
        LspRequestMethod::CallHierarchyOutgoingCalls => {
            caller(server, &params, |view, costs, byte| json!(calls::outgoing(view, costs, byte)))
        }
        LspRequestMethod::TextDocumentPrepareRename => prepare_rename(server, params),
        LspRequestMethod::TextDocumentRename => rename(server, params),
        LspRequestMethod::TextDocumentDocumentSymbol => {
            let nested = server.client.nested_symbols;
            document(server, params, |view| {
                if nested { json!(symbols::nested(view)) } else { json!(symbols::flat(view)) }
            })
        }
        LspRequestMethod::WorkspaceSymbol => {
            let query = params.get("query").and_then(Value::as_str).unwrap_or_default();
            let views = server.workspace.projects(&server.host, &server.options);
            Ok(json!(symbols::of_workspace(&views, query)))
        }
        LspRequestMethod::TextDocumentCodeLens => {
            let uri = from_value::<Document>(params)?.text_document.uri.0;
            Ok(analysed(server, &uri, |view, costs| Some(json!(code_lenses(view, costs?)))))
        }
        LspRequestMethod::TextDocumentInlayHint => {
            let InlayHintParams { text_document, range, .. } = from_value(params)?;
            Ok(analysed(server, &text_document.uri.0, |view, costs| {
                Some(json!(inlay_hints(view.positions(), costs?, &range)))
            }))
        }
        LspRequestMethod::TextDocumentDocumentLink => {
            document(server, params, |view| json!(document_links(view)))
        }
        LspRequestMethod::TextDocumentFoldingRange => {
            document(server, params, |view| json!(folding_ranges(view)))
        }
        LspRequestMethod::TextDocumentSemanticTokensFull => {
            document(server, params, |view| json!(semantic_tokens(view)))
        }
        LspRequestMethod::TextDocumentFormatting => format(server, params, None),
        LspRequestMethod::TextDocumentRangeFormatting => {
            let range = params.get("range").cloned().unwrap_or_default();
            let range: Range = from_value(range)?;
            format(server, params, Some(&range))
        }
        LspRequestMethod::TextDocumentDiagnostic => {
            let uri = from_value::<Document>(params)?.text_document.uri.0;
            Ok(json!({ "kind": "full", "items": server.diagnostics(&uri) }))
        }
        method => Err(Failure::Method(format!("{method} is not served"))),
    }
}

/// Answers about a document; null if it is not known.
fn document<H: Host>(
    server: &mut Server<H>,
    params: Value,
    ask: impl FnOnce(View<'_>) -> Value,
) -> Result<Value, Failure> {
    let uri = from_value::<Document>(params)?.text_document.uri.0;
    Ok(server.view(&uri).map_or(Value::Null, ask))
}

/// Answers about a place; null if its document is not known.
fn at<H: Host>(
    server: &mut Server<H>,
    params: Value,
    ask: impl FnOnce(View<'_>, u32) -> Value,
) -> Result<Value, Failure> {
    let At { text_document, position } = from_value(params)?;
    let ask = |view: View<'_>| ask(view, view.positions().byte(position));
    Ok(server.view(&text_document.uri.0).map_or(Value::Null, ask))
}

/// Answers about an entry of a hierarchy of calls.
fn caller<H: Host>(
    server: &mut Server<H>,
    params: &Value,
    ask: impl FnOnce(View<'_>, Option<&Analysis>, u32) -> Value,
) -> Result<Value, Failure> {
    let item = params.get("item").cloned().unwrap_or_default();
    let Caller { uri, selection_range } = from_value(item)?;
    Ok(analysed(server, &uri.0, |view, costs| {
        Some(ask(view, costs, view.positions().byte(selection_range.start)))
    }))
}

/// Answers about a document with what its programs take; null if it is not known.
fn analysed<H: Host>(
    server: &mut Server<H>,
    uri: &str,
    ask: impl FnOnce(View<'_>, Option<&Analysis>) -> Option<Value>,
) -> Value {
    server.lint(uri);
    let Server { workspace, host, options, findings, .. } = server;
    let view = workspace.view(host, options, uri);
    view.and_then(|view| ask(view, findings.get(uri))).unwrap_or_default()
}

fn hovered<H: Host>(server: &mut Server<H>, params: Value) -> Result<Value, Failure> {
    let At { text_document, position } = from_value(params)?;
    let uri = &text_document.uri.0;
    // A pointer does not wait for the linter.
    let linted = server.is_linted(uri);
    let Server { workspace, host, options, findings, .. } = server;
    let Some(view) = workspace.view(host, options, uri) else { return Ok(Value::Null) };
    let byte = view.positions().byte(position);
    let analysis = findings.get(uri).filter(|_| linted);
    // The file has another number in the programs of the linter.
    let costs = analysis.and_then(|analysis| of_statement(analysis, byte));
    Ok(json!(hover(view, byte, costs.as_ref())))
}

fn actions<H: Host>(server: &mut Server<H>, params: Value) -> Result<Value, Failure> {
    let CodeActionParams { text_document, range, .. } = from_value(params)?;
    server.lint(&text_document.uri.0);
    let analysis = server.findings.get(&text_document.uri.0);
    let units = server.client.units;
    let actions = |analysis| {
        let mut all = code_actions(analysis, units, &text_document.uri, &range);
        if server.client.late_edits != LateEdits::Unknown {
            all.extend(one_run::offer(analysis, units, &text_document.uri, &range));
        }
        all
    };
    Ok(json!(analysis.map(actions).unwrap_or_default()))
}

fn resolve<H: Host>(server: &mut Server<H>, params: Value) -> Result<Value, Failure> {
    let mut action: CodeAction = from_value(params)?;
    let run = from_value(action.data.clone().unwrap_or_default())?;
    let Server { host, options, workspace, client, .. } = server;
    let edit = one_run::edit(host, options, &workspace.documents, client, &run);
    action.edit = Some(edit.map_err(Failure::Refused)?);
    Ok(json!(action))
}

fn prepare_rename<H: Host>(server: &mut Server<H>, params: Value) -> Result<Value, Failure> {
    let At { text_document, position } = from_value(params)?;
    let Some(view) = server.view(&text_document.uri.0) else { return Ok(Value::Null) };
    let (range, placeholder) = rename::prepare(view, view.positions().byte(position))?;
    Ok(json!({ "range": range, "placeholder": placeholder }))
}

fn rename<H: Host>(server: &mut Server<H>, params: Value) -> Result<Value, Failure> {
    let new: String = from_value(params.get("newName").cloned().unwrap_or_default())?;
    let At { text_document, position } = from_value(params)?;
    let Some(view) = server.view(&text_document.uri.0) else { return Ok(Value::Null) };
    Ok(json!(rename::rename(view, view.positions().byte(position), &new)?))
}

fn format<H: Host>(
    server: &mut Server<H>,
    params: Value,
    range: Option<&Range>,
) -> Result<Value, Failure> {
    let uri = from_value::<Document>(params)?.text_document.uri.0;
    let style = server.host.style(&path_of(&uri)).map_err(Failure::Refused)?;
    let Some(view) = server.view(&uri) else { return Ok(Value::Null) };
    Ok(json!(formatting(view, &style, range)))
}

//! The language server: findings with joules while one types.
//!
//! It speaks the Language Server Protocol over standard input and output. A document is linted
//! with the files of its folder; what the editor holds stands for what is on disk. A change is
//! followed by a look at the programs that hold the document, and at no other of the folder.

mod position;
mod workspace;

use std::collections::{BTreeMap, BTreeSet};

use lsp_server::{Connection, ErrorCode, Message, Notification, Request, Response};
use serde_json::{Value, json};

use position::{offset_of, range_of};
use workspace::{Analysis, Workspace};

use crate::rapid::diagnostics::Severity;
use crate::rapid::text::SourceFile;
use crate::tool::lint::{Applicability, Finding};

/// What an editor may tell when it starts the server.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(default)]
pub struct Options {
    /// The robot, by name or file.
    pub robot: Option<String>,
    /// The routine that starts the program.
    pub entry: Option<String>,
    /// When inputs come, such as `diPart=2.5`.
    pub inputs: Vec<String>,
}

/// Why a session ended early.
#[derive(Debug, thiserror::Error)]
pub enum LspError {
    /// The other side sends something else.
    #[error(
        "the editor does not speak the language server protocol: {0}; start the server from one"
    )]
    Protocol(#[from] lsp_server::ProtocolError),
    /// The other side is gone.
    #[error("the editor has closed the connection")]
    Closed,
    /// Standard input or output failed.
    #[error("standard input or output failed: {0}")]
    Io(#[from] std::io::Error),
}

/// Serves until the editor says that it is over.
///
/// # Errors
/// The other side does not speak the protocol, or is gone.
pub fn serve(defaults: Options) -> Result<(), LspError> {
    let (connection, threads) = Connection::stdio();
    let capabilities = json!({
        "positionEncoding": "utf-16",
        "textDocumentSync": { "openClose": true, "change": 2, "save": true },
        "hoverProvider": true,
        "codeActionProvider": { "codeActionKinds": ["quickfix"] },
    });
    let (id, params) = connection.initialize_start()?;
    let told = params.get("initializationOptions").cloned().unwrap_or_default();
    let told: Options = serde_json::from_value(told).unwrap_or_default();
    let options = Options {
        robot: told.robot.or(defaults.robot),
        entry: told.entry.or(defaults.entry),
        inputs: if told.inputs.is_empty() { defaults.inputs } else { told.inputs },
    };
    let about = json!({ "name": "joulepath", "version": env!("CARGO_PKG_VERSION") });
    connection
        .initialize_finish(id, json!({ "capabilities": capabilities, "serverInfo": about }))?;
    let mut server = Server { workspace: Workspace::new(options), told: BTreeMap::new() };
    for message in &connection.receiver {
        let answers = match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request)? {
                    break;
                }
                vec![Message::Response(server.answer(request))]
            }
            Message::Notification(notification) => server.notice(&notification),
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

struct Server {
    workspace: Workspace,
    /// What was found in each document, by its name.
    told: BTreeMap<String, Analysis>,
}

impl Server {
    fn notice(&mut self, notification: &Notification) -> Vec<Message> {
        let params = &notification.params;
        let document = &params["textDocument"];
        let Some(uri) = document["uri"].as_str().map(str::to_owned) else { return Vec::new() };
        match notification.method.as_str() {
            "textDocument/didOpen" => {
                let text = document["text"].as_str().unwrap_or_default();
                self.workspace.open(&uri, text.to_owned());
            }
            "textDocument/didChange" => {
                for change in params["contentChanges"].as_array().into_iter().flatten() {
                    self.workspace.change(&uri, change);
                }
            }
            "textDocument/didSave" => self.workspace.forget(&uri),
            "textDocument/didClose" => {
                self.workspace.close(&uri);
                self.told.remove(&uri);
                let mut messages = vec![publish(&uri, &[])];
                // What is on disk counts again for the documents beside it.
                let mut open = self.workspace.beside(&uri);
                while let Some(other) = open.pop_first() {
                    messages.extend(self.look(&other, &mut open));
                }
                return messages;
            }
            _ => return Vec::new(),
        }
        self.look(&uri, &mut BTreeSet::new())
    }

    /// What is found in a document and in those of its programs, which need no look of their own.
    fn look(&mut self, uri: &str, open: &mut BTreeSet<String>) -> Vec<Message> {
        let mut messages = Vec::new();
        for (uri, analysis) in self.workspace.analyse(uri) {
            open.remove(&uri);
            let shown: Vec<Value> =
                analysis.own().map(|finding| diagnostic(finding, analysis.file())).collect();
            messages.push(publish(&uri, &shown));
            self.told.insert(uri, analysis);
        }
        messages
    }

    fn answer(&self, request: Request) -> Response {
        let uri = request.params["textDocument"]["uri"].as_str().unwrap_or_default();
        let analysis = self.told.get(uri);
        match request.method.as_str() {
            "textDocument/hover" => {
                let hover = analysis.and_then(|it| hover(it, &request.params["position"]));
                Response::new_ok(request.id, hover)
            }
            "textDocument/codeAction" => {
                let actions = analysis.map(|it| actions(it, uri, &request.params["range"]));
                Response::new_ok(request.id, actions.unwrap_or_default())
            }
            method => {
                let message = format!("{method} is not served");
                Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message)
            }
        }
    }
}

fn publish(uri: &str, diagnostics: &[Value]) -> Message {
    Message::Notification(Notification {
        method: "textDocument/publishDiagnostics".to_owned(),
        params: json!({ "uri": uri, "diagnostics": diagnostics }),
    })
}

fn diagnostic(finding: &Finding, file: &SourceFile) -> Value {
    let severity = match finding.rule.severity {
        Severity::Error => 1,
        Severity::Warning => 2,
        Severity::Info => 3,
    };
    json!({
        "range": range_of(file, finding.span),
        "severity": severity,
        "code": finding.rule.code,
        "source": "joulepath",
        "message": finding.told(),
        "data": { "saving_j": finding.saving.map(|saving| saving.energy_j) },
    })
}

/// Time and energy of the movements or waits at a place.
fn hover(analysis: &Analysis, position: &Value) -> Option<Value> {
    let at = offset_of(analysis.file(), position)?;
    let costs = analysis.costs_at(at)?;
    let span = costs.span;
    let times = match costs.times {
        1 => String::new(),
        times => format!(", {times} times a cycle together"),
    };
    let joules = costs.energy_j.map_or_else(String::new, |joules| format!("{joules:.1} J, "));
    let text = format!("**{}**: {joules}{:.3} s{times}", costs.what, costs.time_s);
    let contents = json!({ "kind": "markdown", "value": text });
    Some(json!({ "contents": contents, "range": range_of(analysis.file(), span) }))
}

/// The fixes of what was found in a range.
fn actions(analysis: &Analysis, uri: &str, range: &Value) -> Vec<Value> {
    let file = analysis.file();
    let (Some(start), Some(end)) =
        (offset_of(file, &range["start"]), offset_of(file, &range["end"]))
    else {
        return Vec::new();
    };
    let here = analysis.own().filter(|it| it.span.start <= end && start <= it.span.end);
    let action = |finding: &Finding| {
        let fix = finding.fix.as_ref()?;
        // A change of another file is for the command line.
        let own = fix.edits.iter().all(|edit| edit.span.file == file.id);
        let edits: Vec<Value> = fix
            .edits
            .iter()
            .map(|edit| {
                let text = String::from_utf8_lossy(&edit.text);
                json!({ "range": range_of(file, edit.span), "newText": text })
            })
            .collect();
        let doubt = match fix.applicability {
            Applicability::Safe => "",
            Applicability::Unsafe => " (unsafe)",
        };
        let title = format!("{}: {}{doubt}", finding.rule.code, finding.change);
        own.then(|| {
            json!({
                "title": title,
                "kind": "quickfix",
                "isPreferred": fix.applicability == Applicability::Safe,
                "diagnostics": [diagnostic(finding, file)],
                "edit": { "changes": { uri: edits } },
            })
        })
    };
    here.filter_map(action).collect()
}

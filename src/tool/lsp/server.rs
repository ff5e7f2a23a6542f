//! The state of a session and its notifications.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use gen_lsp_types::{
    Diagnostic, DidChangeTextDocumentParams, DidChangeWorkspaceFoldersParams,
    DidCloseTextDocumentParams, DidOpenTextDocumentParams, DidSaveTextDocumentParams,
    LspNotificationMethod, LspRequestMethod, PublishDiagnosticsParams, Uri,
};
use lsp_server::{Message, Notification, Request};
use serde_json::{Value, from_value, json};

use super::client::{Client, Delivery};
use super::diagnostics::of_document;
use super::findings::Findings;
use super::host::Host;
use super::options::Options;
use super::uri::{folder_of, path_of};
use super::workspace::{View, Workspace};

/// A session.
pub(super) struct Server<H> {
    pub(super) host: H,
    pub(super) options: Options,
    pub(super) client: Client,
    pub(super) workspace: Workspace,
    pub(super) findings: Findings,
    /// Open documents whose findings are older than their text or that of a file beside them.
    stale: BTreeSet<String>,
    /// Open documents whose diagnostics may have changed.
    unpublished: BTreeSet<String>,
    /// The diagnostics that the client has of other documents than the changed one.
    published: BTreeMap<String, Vec<Diagnostic>>,
    /// Whether a client that asks for diagnostics does not know that they have changed.
    outdated: bool,
    requests: i32,
}

impl<H: Host> Server<H> {
    pub(super) fn new(
        host: H,
        options: Options,
        client: Client,
        folders: Vec<PathBuf>,
    ) -> Server<H> {
        let workspace = Workspace::new(client.units, folders);
        Server {
            host,
            options,
            client,
            workspace,
            findings: Findings::default(),
            stale: BTreeSet::new(),
            unpublished: BTreeSet::new(),
            published: BTreeMap::new(),
            outdated: false,
            requests: 0,
        }
    }

    /// What is asked of the client once it is ready: to tell about changed files.
    pub(super) fn start(&mut self) -> Vec<Message> {
        if !self.client.watches_files {
            return Vec::new();
        }
        let glob = "**/*.{mod,sys,prg,modx,sysx,pgf,MOD,SYS,PRG,MODX,SYSX,PGF,toml}";
        let watch = json!({
            "id": "files",
            "method": LspNotificationMethod::WorkspaceDidChangeWatchedFiles.to_string(),
            "registerOptions": { "watchers": [{ "globPattern": glob }] }
        });
        let params = json!({ "registrations": [watch] });
        vec![self.ask(&LspRequestMethod::ClientRegisterCapability, params)]
    }

    fn ask(&mut self, method: &LspRequestMethod<'_>, params: Value) -> Message {
        self.requests += 1;
        Message::Request(Request::new(self.requests.into(), method.to_string(), params))
    }

    /// Handles a notification; returns what the client is told at once. Diagnostics come later, from
    /// [`Server::publish`].
    pub(super) fn notify(
        &mut self,
        notification: Notification,
    ) -> serde_json::Result<Vec<Message>> {
        let Notification { method, params } = notification;
        match LspNotificationMethod::from(method.as_str()) {
            LspNotificationMethod::TextDocumentDidOpen => {
                let document = from_value::<DidOpenTextDocumentParams>(params)?.text_document;
                self.workspace.open(&document.uri.0, document.text);
                self.findings.forget(&document.uri.0);
                self.changed(&document.uri.0);
            }
            LspNotificationMethod::TextDocumentDidChange => {
                let params: DidChangeTextDocumentParams = from_value(params)?;
                let uri = params.text_document.text_document_identifier.uri.0;
                for change in params.content_changes {
                    self.workspace.change(&uri, change);
                }
                self.changed(&uri);
            }
            LspNotificationMethod::TextDocumentDidSave => {
                let uri = from_value::<DidSaveTextDocumentParams>(params)?.text_document.uri.0;
                self.workspace.read_again();
                self.findings.forget(&uri);
                self.changed(&uri);
            }
            LspNotificationMethod::TextDocumentDidClose => {
                let uri = from_value::<DidCloseTextDocumentParams>(params)?.text_document.uri.0;
                return Ok(self.close(&uri));
            }
            LspNotificationMethod::WorkspaceDidChangeWatchedFiles => {
                self.workspace.read_again();
                self.findings.forget_all();
                self.all_changed();
            }
            LspNotificationMethod::WorkspaceDidChangeWorkspaceFolders => {
                let event = from_value::<DidChangeWorkspaceFoldersParams>(params)?.event;
                let path = |uri: &Uri| path_of(&uri.0);
                let removed: Vec<PathBuf> = event.removed.iter().map(|it| path(&it.uri)).collect();
                let mut folders = self.workspace.folders().to_vec();
                folders.retain(|folder| !removed.contains(folder));
                folders.extend(event.added.iter().map(|it| path(&it.uri)));
                self.workspace.set_folders(folders);
                self.all_changed();
            }
            _ => {}
        }
        Ok(Vec::new())
    }

    /// Closes a document; the text on disk counts again.
    fn close(&mut self, uri: &str) -> Vec<Message> {
        self.workspace.close(uri);
        self.findings.close(uri);
        self.stale.remove(uri);
        self.unpublished.remove(uri);
        self.changed(uri);
        self.outdated = true;
        if self.client.delivery != Delivery::Sent {
            return Vec::new();
        }
        vec![publication(uri.to_owned(), Vec::new())]
    }

    /// Marks the open documents that a change of a file may concern.
    fn changed(&mut self, uri: &str) {
        let folder = folder_of(uri);
        let beside = |other: &&str| folder_of(other) == folder;
        let open: Vec<&str> = self.workspace.documents.iter().map(|(uri, _)| uri).collect();
        self.stale.extend(open.iter().copied().filter(beside).map(str::to_owned));
        self.unpublished.extend(open.into_iter().map(str::to_owned));
        self.published.remove(uri);
    }

    fn all_changed(&mut self) {
        let open = self.workspace.documents.iter().map(|(uri, _)| uri.to_owned());
        let open: BTreeSet<String> = open.collect();
        self.stale.clone_from(&open);
        self.unpublished = open;
        self.outdated = true;
    }

    /// Whether diagnostics wait to be published.
    pub(super) fn has_news(&self) -> bool {
        !self.unpublished.is_empty()
    }

    /// The diagnostics that have changed; for a client that asks for them, that they have.
    pub(super) fn publish(&mut self) -> Vec<Message> {
        let waiting = std::mem::take(&mut self.unpublished);
        if self.client.delivery != Delivery::Sent {
            let outdated = std::mem::take(&mut self.outdated) && !waiting.is_empty();
            if !outdated || self.client.delivery == Delivery::Asked {
                return Vec::new();
            }
            return vec![self.ask(&LspRequestMethod::WorkspaceDiagnosticRefresh, Value::Null)];
        }
        let mut messages = Vec::new();
        for uri in waiting {
            let diagnostics = self.diagnostics(&uri);
            if self.published.get(&uri) != Some(&diagnostics) {
                self.published.insert(uri.clone(), diagnostics.clone());
                messages.push(publication(uri, diagnostics));
            }
        }
        messages
    }

    /// The diagnostics of a document as it is now.
    pub(super) fn diagnostics(&mut self, uri: &str) -> Vec<Diagnostic> {
        self.lint(uri);
        let Some(view) = self.workspace.view(&self.host, &self.options, uri) else {
            return Vec::new();
        };
        of_document(view, &self.client, self.findings.get(uri))
    }

    /// Brings the findings of a document up to date.
    pub(super) fn lint(&mut self, uri: &str) {
        if self.stale.contains(uri) {
            let Server { host, options, workspace, findings, stale, .. } = self;
            for done in findings.analyse(host, options, &workspace.documents, uri) {
                stale.remove(&done);
            }
            stale.remove(uri);
        }
    }

    /// Whether the findings of a document belong to its text.
    pub(super) fn is_linted(&self, uri: &str) -> bool {
        !self.stale.contains(uri)
    }

    pub(super) fn view(&mut self, uri: &str) -> Option<View<'_>> {
        self.workspace.view(&self.host, &self.options, uri)
    }
}

fn publication(uri: String, diagnostics: Vec<Diagnostic>) -> Message {
    Message::Notification(Notification {
        method: LspNotificationMethod::TextDocumentPublishDiagnostics.to_string(),
        params: json!(PublishDiagnosticsParams { uri: Uri(uri), version: None, diagnostics }),
    })
}

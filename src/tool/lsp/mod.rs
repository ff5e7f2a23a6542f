//! The language server: names, completion, formatting, and findings with energies while the user types.
//!
//! It uses the Language Server Protocol. [`Host`] reads files and settings, so that the server itself is
//! a function of messages. `workspace` has the projects of the folders with the text of the editor,
//! `entity` the meaning of an identifier in all tasks, `findings` the linter; each other file answers one
//! kind of request. After a change only the changed file is parsed again; names and findings are found
//! again when they are needed.

mod actions;
mod call;
mod calls;
mod capabilities;
mod client;
mod comment;
mod completion;
mod costs;
mod cursor;
mod definition;
mod diagnostics;
mod documents;
mod entity;
mod error;
mod findings;
mod folding;
mod formatting;
mod host;
mod hover;
mod lens;
mod links;
mod module;
mod one_run;
mod options;
mod outline;
mod position;
mod project;
mod rename;
mod requests;
mod scope;
mod semantic_tokens;
mod server;
mod signature;
mod signature_help;
mod symbols;
mod task;
mod tokens;
mod uri;
mod workspace;
mod writes;

pub use error::LspError;
pub use host::{ChangedFile, Host, ProjectFiles, TaskFiles};
pub use lsp_server::{Connection, Message};
pub use options::Options;

use std::path::PathBuf;

use serde_json::{Value, json};

use client::Client;
use server::Server;

/// Serves an editor over standard input and output until it ends the session.
///
/// # Errors
/// The client does not speak the protocol, or has closed the connection.
pub fn serve(defaults: Options, host: impl Host) -> Result<(), LspError> {
    let (connection, threads) = Connection::stdio();
    serve_on(connection, defaults, host)?;
    threads.join()?;
    Ok(())
}

/// Serves a client over a connection until it ends the session.
///
/// # Errors
/// The client does not speak the protocol, or has closed the connection.
pub fn serve_on(
    connection: Connection,
    defaults: Options,
    host: impl Host,
) -> Result<(), LspError> {
    let (id, params) = connection.initialize_start()?;
    let (sent, warning) = options::sent(&params);
    let options = sent.or(defaults);
    let client = Client::new(&params);
    connection.initialize_finish(id, json!(capabilities::initialize_result(&client)))?;
    let mut server = Server::new(host, options, client, folders(&params));
    send(&connection, warning.into_iter().chain(server.start()).collect())?;
    loop {
        let next = if server.has_news() {
            server.host.until_pause(&connection)
        } else {
            connection.receiver.recv().map(Some).map_err(|_| LspError::Closed)
        };
        let message = match next {
            Ok(Some(message)) => message,
            Ok(None) => {
                send(&connection, server.publish())?;
                continue;
            }
            Err(_) => break,
        };
        match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request)? {
                    break;
                }
                let answer = requests::answer(&mut server, request);
                send(&connection, vec![Message::Response(answer)])?;
            }
            // A notification has no response, so a malformed one is ignored.
            Message::Notification(notification) => {
                send(&connection, server.notify(notification).unwrap_or_default())?;
            }
            Message::Response(_) => {}
        }
    }
    // The thread that writes ends with the connection.
    drop(connection);
    Ok(())
}

fn send(connection: &Connection, messages: Vec<Message>) -> Result<(), LspError> {
    for message in messages {
        connection.sender.send(message).map_err(|_| LspError::Closed)?;
    }
    Ok(())
}

/// The folders of the workspace that the client names.
fn folders(params: &Value) -> Vec<PathBuf> {
    let uri = |folder: &Value| folder.get("uri").and_then(Value::as_str).map(uri::path_of);
    let folders = params.get("workspaceFolders").and_then(Value::as_array);
    if let Some(folders) = folders {
        return folders.iter().filter_map(uri).collect();
    }
    let root = params.get("rootUri").and_then(Value::as_str);
    root.map(uri::path_of).into_iter().collect()
}

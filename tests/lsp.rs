//! The language server through its protocol, as a process.

#![cfg(feature = "lsp")]
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

struct Client {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    next: i64,
}

impl Client {
    fn start(options: &Value) -> Client {
        let mut process = Command::new(env!("CARGO_BIN_EXE_joulepath"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = process.stdin.take().unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        let mut client = Client { process, input, output, next: 1 };
        let about = client
            .ask("initialize", &json!({ "capabilities": {}, "initializationOptions": options }));
        assert_eq!(about["capabilities"]["hoverProvider"], true);
        assert_eq!(about["capabilities"]["textDocumentSync"]["change"], 2);
        client.tell("initialized", &json!({}));
        client
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.input.flush().unwrap();
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            self.output.read_line(&mut line).unwrap();
            if line.trim().is_empty() {
                break;
            }
            if let Some(value) = line.strip_prefix("Content-Length:") {
                length = value.trim().parse().unwrap();
            }
        }
        let mut bytes = vec![0; length];
        self.output.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    fn tell(&mut self, method: &str, params: &Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn ask(&mut self, method: &str, params: &Value) -> Value {
        let id = self.next;
        self.next += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.read();
            if message["id"] == id {
                assert!(message.get("error").is_none(), "{message}");
                return message["result"].clone();
            }
        }
    }

    /// The diagnostics that come next.
    fn told(&mut self) -> Vec<Value> {
        let message = self.read();
        assert_eq!(message["method"], "textDocument/publishDiagnostics", "{message}");
        message["params"]["diagnostics"].as_array().unwrap().clone()
    }

    fn stop(mut self) {
        self.ask("shutdown", &Value::Null);
        self.tell("exit", &Value::Null);
        assert!(self.process.wait().unwrap().success());
    }
}

#[test]
fn an_editor_is_served() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Cell 1.mod");
    let text = fs::read_to_string("fixtures/lint/EW102_stop_in_line.mod").unwrap();
    fs::write(&path, "MODULE Old\nENDMODULE\n").unwrap();
    let uri = format!("file://{}", path.display()).replace(' ', "%20");
    let document = json!({ "uri": uri });
    let mut client = Client::start(&json!({ "robot": "IRB1600-10/1.45" }));

    // What the editor holds counts, not what is on disk.
    let opened = json!({
        "textDocument": { "uri": uri, "languageId": "rapid", "version": 1, "text": text }
    });
    client.tell("textDocument/didOpen", &opened);
    let found = client.told();
    let in_line = found.iter().find(|it| it["code"] == "EW102").unwrap().clone();
    assert!(in_line["data"]["saving_j"].as_f64().unwrap() > 1.0, "{in_line}");
    assert!(in_line["message"].as_str().unwrap().contains(" J "), "{in_line}");

    let place = in_line["range"]["start"].clone();
    let hover =
        client.ask("textDocument/hover", &json!({ "textDocument": document, "position": place }));
    let value = hover["contents"]["value"].as_str().unwrap();
    assert!(value.contains("**MoveL**") && value.contains(" J, "), "{value}");

    let actions = client.ask(
        "textDocument/codeAction",
        &json!({ "textDocument": document, "range": in_line["range"], "context": {} }),
    );
    let action = &actions.as_array().unwrap()[0];
    assert_eq!(action["isPreferred"], true, "{action}");
    let edit = &action["edit"]["changes"][&uri][0];
    assert_eq!(edit["newText"], "z20");

    // The fix, as an incremental change: nothing of that kind is left.
    let change = json!({
        "textDocument": { "uri": uri, "version": 2 },
        "contentChanges": [{ "range": edit["range"], "text": edit["newText"] }]
    });
    client.tell("textDocument/didChange", &change);
    assert!(client.told().iter().all(|it| it["code"] != "EW102"));
    client.tell("textDocument/didClose", &json!({ "textDocument": document }));
    assert!(client.told().is_empty());
    assert_eq!(fs::read_to_string(&path).unwrap(), "MODULE Old\nENDMODULE\n");
    client.stop();
}

#[test]
fn a_robot_that_is_not_known_stops_nothing() {
    let mut client = Client::start(&json!({ "robot": "no such robot" }));
    let uri = format!("file://{}/gone/M.mod", Path::new("/").display());
    let opened = json!({
        "textDocument": { "uri": uri, "text": "MODULE M\nPROC main()\nMoveL" }
    });
    client.tell("textDocument/didOpen", &opened);
    client.told();
    client.stop();
}

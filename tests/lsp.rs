//! Tests the language server as a process through its protocol.

#![cfg(feature = "lsp")]
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use joulepath::rapid::text::decode;
use serde_json::{Value, json};

struct Client {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    next: i64,
}

impl Client {
    fn start(options: &Value) -> Client {
        Client::start_with(&json!({}), options)
    }

    fn start_with(capabilities: &Value, options: &Value) -> Client {
        let mut process = Command::new(env!("CARGO_BIN_EXE_joulepath"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = process.stdin.take().unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        let mut client = Client { process, input, output, next: 1 };
        let about = client.request(
            "initialize",
            &json!({ "capabilities": capabilities, "initializationOptions": options }),
        );
        assert_eq!(about["capabilities"]["hoverProvider"], true);
        assert_eq!(about["capabilities"]["textDocumentSync"]["change"], 2);
        client.notify("initialized", &json!({}));
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

    fn notify(&mut self, method: &str, params: &Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn request(&mut self, method: &str, params: &Value) -> Value {
        let answer = self.answer(method, params);
        assert!(answer.get("error").is_none(), "{answer}");
        answer["result"].clone()
    }

    /// The error in the answer to a request.
    fn request_error(&mut self, method: &str, params: &Value) -> Value {
        self.answer(method, params)["error"].clone()
    }

    fn answer(&mut self, method: &str, params: &Value) -> Value {
        let id = self.next;
        self.next += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.read();
            if message["id"] == id {
                return message;
            }
        }
    }

    /// The findings in the next diagnostics.
    fn next_findings(&mut self) -> Vec<Value> {
        self.next_diagnostics().1
    }

    /// The document of the next diagnostics, and these.
    fn next_diagnostics(&mut self) -> (String, Vec<Value>) {
        let message = self.read();
        assert_eq!(message["method"], "textDocument/publishDiagnostics", "{message}");
        let params = &message["params"];
        let name = params["uri"].as_str().unwrap().rsplit('/').next().unwrap().to_owned();
        (name, params["diagnostics"].as_array().unwrap().clone())
    }

    fn open(&mut self, path: &Path) -> String {
        let uri = format!("file://{}", path.display());
        self.open_text(&uri, &fs::read_to_string(path).unwrap());
        uri
    }

    fn open_text(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "rapid", "version": 1, "text": text });
        self.notify("textDocument/didOpen", &json!({ "textDocument": document }));
    }

    fn change(&mut self, uri: &str, change: &Value) {
        let document = json!({ "uri": uri, "version": 2 });
        let changes = json!({ "textDocument": document, "contentChanges": [change] });
        self.notify("textDocument/didChange", &changes);
    }

    fn stop(mut self) {
        self.request("shutdown", &Value::Null);
        self.notify("exit", &Value::Null);
        assert!(self.process.wait().unwrap().success());
    }
}

fn codes(findings: &[Value]) -> Vec<&str> {
    findings.iter().map(|finding| finding["code"].as_str().unwrap()).collect()
}

#[test]
fn an_open_document_gets_findings_hovers_and_fixes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Cell 1.mod");
    let text = fs::read_to_string("fixtures/lint/EW103_tiny_zone.mod").unwrap();
    fs::write(&path, "MODULE Old\nENDMODULE\n").unwrap();
    let uri = format!("file://{}", path.display()).replace(' ', "%20");
    let document = json!({ "uri": uri });
    let mut client = Client::start(&json!({ "robot": "IRB1600-10/1.45" }));

    // The text of the editor has priority over the file.
    client.open_text(&uri, &text);
    let found = client.next_findings();
    let tiny = found.iter().find(|it| it["code"] == "EW103").unwrap().clone();
    assert!(tiny["data"]["saving_j"].as_f64().unwrap() > 1.0, "{tiny}");
    assert!(tiny["message"].as_str().unwrap().contains(" J "), "{tiny}");

    let place = tiny["range"]["start"].clone();
    let hover = client
        .request("textDocument/hover", &json!({ "textDocument": document, "position": place }));
    let value = hover["contents"]["value"].as_str().unwrap();
    assert!(value.contains("**MoveJ**") && value.contains(" J, "), "{value}");

    let actions = client.request(
        "textDocument/codeAction",
        &json!({ "textDocument": document, "range": tiny["range"], "context": { "diagnostics": [] } }),
    );
    let action = &actions.as_array().unwrap()[0];
    assert_eq!(action["isPreferred"], false, "{action}");
    let edit = &action["edit"]["changes"][&uri][0];
    assert_eq!(edit["newText"], "z50");

    // The fix as an incremental change removes all findings of that kind.
    client.change(&uri, &json!({ "range": edit["range"], "text": edit["newText"] }));
    assert!(client.next_findings().iter().all(|it| it["code"] != "EW103"));
    client.notify("textDocument/didClose", &json!({ "textDocument": document }));
    assert!(client.next_findings().is_empty());
    assert_eq!(fs::read_to_string(&path).unwrap(), "MODULE Old\nENDMODULE\n");
    client.stop();
}

/// The run at the cursor becomes a stream, of files as on disk, with a preview; a run that stays has a
/// reason.
#[test]
fn one_run_is_optimised_as_an_action() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("encoding.mod");
    let bytes = fs::read("fixtures/hard/encoding.mod").unwrap();
    fs::write(&path, &bytes).unwrap();
    let text = decode(&bytes).text;
    let uri = format!("file://{}", path.display());
    let document = json!({ "uri": uri });
    let capabilities = json!({
        "textDocument": { "codeAction": {
            "dataSupport": true, "resolveSupport": { "properties": ["edit"] }
        } },
        "workspace": { "workspaceEdit": {
            "documentChanges": true, "resourceOperations": ["create"],
            "changeAnnotationSupport": {}
        } }
    });
    let mut client = Client::start_with(&capabilities, &json!({ "robot": "IRB1600-10/1.45" }));
    client.open_text(&uri, &text);
    client.next_findings();
    let lines: Vec<&str> = text.lines().collect();
    let line_of =
        |start: &str| lines.iter().position(|line| line.trim().starts_with(start)).unwrap();
    let action = |client: &mut Client, line: usize| {
        let place = json!({ "line": line, "character": 8 });
        let range = json!({ "start": place, "end": place });
        let asked =
            json!({ "textDocument": document, "range": range, "context": { "diagnostics": [] } });
        let actions = client.request("textDocument/codeAction", &asked);
        let mut actions = actions.as_array().unwrap().iter();
        actions.find(|it| it["kind"] == "refactor.rewrite").unwrap().clone()
    };

    let chosen = action(&mut client, line_of("MoveL pPrüfen,"));
    assert!(chosen.get("edit").is_none(), "{chosen}");
    let edit = client.request("codeAction/resolve", &chosen)["edit"].clone();
    assert_eq!(edit["changeAnnotations"]["run"]["needsConfirmation"], true, "{edit}");
    let changes = edit["documentChanges"].as_array().unwrap();
    let kinds: Vec<Option<&str>> = changes.iter().map(|it| it["kind"].as_str()).collect();
    assert_eq!(kinds, [Some("create"), None, None], "{edit}");
    assert!(changes[0]["uri"].as_str().unwrap().ends_with("/Joulepath.mod"), "{edit}");
    let module = changes[1]["edits"][0]["newText"].as_str().unwrap();
    assert!(module.contains("jpRun1") && !module.contains("jpRun2"), "{module}");
    let program = &changes[2]["edits"][0];
    assert_eq!(program["annotationId"], "run");
    // Only the lines of the run change, and they stay behind the guard.
    let [first, last] = ["start", "end"].map(|end| program["range"][end]["line"].as_u64().unwrap());
    let mut changed = program["newText"].as_str().unwrap().to_owned();
    assert!(last as usize <= line_of("WaitTime 0.3"), "{program}");
    assert!(changed.contains("IF jpFits1(") && changed.contains("jpRun1 "), "{changed}");
    for line in &lines[first as usize..last as usize] {
        let at = changed.find(line.trim()).unwrap();
        changed.replace_range(at..at + line.trim().len(), "");
    }
    assert_eq!(fs::read(&path).unwrap(), bytes);

    // The first movement stays, and says why.
    let chosen = action(&mut client, line_of("MoveAbsJ jHome"));
    let error = client.request_error("codeAction/resolve", &chosen);
    assert!(error["message"].as_str().unwrap().contains("first-movement"), "{error}");

    // What is not saved is not on disk.
    let chosen = action(&mut client, line_of("MoveL pPrüfen,"));
    let start = json!({ "line": 0, "character": 0 });
    client.change(&uri, &json!({ "range": { "start": start, "end": start }, "text": "! new\n" }));
    let error = client.request_error("codeAction/resolve", &chosen);
    assert!(error["message"].as_str().unwrap().contains("save "), "{error}");
    client.stop();
}

#[test]
fn options_of_a_wrong_form_are_reported() {
    let mut client = Client::start(&json!({ "inputs": "diPart=2.5" }));
    let message = client.read();
    assert_eq!(message["method"], "window/showMessage", "{message}");
    let text = message["params"]["message"].as_str().unwrap();
    assert!(text.contains("initializationOptions") && text.contains("inputs"), "{text}");
}

/// With an unknown robot and a missing folder the document is linted alone, without joules; a
/// malformed request receives an error.
#[test]
fn a_document_is_linted_without_a_robot_and_a_folder() {
    let mut client = Client::start(&json!({ "robot": "no such robot" }));
    let uri = "file:///gone/M.mod";
    let text = "MODULE M\nPROC main()\n! joulepath: ignore EW999 no such rule\nWaitTime 1;\nMoveL";
    client.open_text(uri, text);
    let (name, found) = client.next_diagnostics();
    assert_eq!(name, "M.mod");
    let comment = found.iter().find(|it| it["code"] == "EW001").unwrap();
    assert_eq!(comment["severity"], 2);
    assert!(codes(&found).contains(&"syntax"), "{found:?}");
    assert_eq!(comment["range"]["start"], json!({ "line": 2, "character": 0 }));
    assert_eq!(comment["data"], json!({ "saving_j": null }));

    let identifier = json!({ "uri": uri });
    let asked = json!({ "textDocument": identifier, "position": { "line": 3, "character": 2 } });
    // Without a robot nothing moves: the hover has the declaration and no costs.
    let hover = client.request("textDocument/hover", &asked);
    assert!(hover["contents"]["value"].as_str().unwrap().starts_with("```rapid"), "{hover}");
    let asked = json!({
        "textDocument": identifier, "range": comment["range"], "context": { "diagnostics": found }
    });
    let actions = client.request("textDocument/codeAction", &asked);
    assert_eq!(actions[0]["isPreferred"], true, "{actions}");
    assert_eq!(actions[0]["edit"]["changes"][uri][0]["newText"], "", "{actions}");

    let error = client.request_error("textDocument/hover", &json!({ "textDocument": identifier }));
    assert_eq!(error["code"], -32602, "{error}");
    let error = client.request_error("textDocument/linkedEditingRange", &json!({}));
    assert_eq!(error["code"], -32601, "{error}");
    client.stop();
}

/// After a change, diagnostics are updated for the open documents of the same program, and for no
/// other document of the folder.
#[test]
fn a_change_updates_the_open_documents_of_its_program() {
    let folder = tempfile::tempdir().unwrap();
    let work = "MODULE Work\nPROC rWork()\nMoveJ pOver,v1000,fine,tool0;\nENDPROC\n\
                PROC rStay()\nMoveJ pOver,v1000,fine,tool0;\nENDPROC\nENDMODULE\n";
    let cell = "MODULE Cell\nCONST robtarget pOver:=[[600,0,400],[0,0,1,0],[0,0,0,0],\
                [9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\nrWork;\nrStay;\nENDPROC\nENDMODULE\n";
    let other = "MODULE Other\nPROC main()\nWaitTime 1;\nENDPROC\nENDMODULE\n";
    let other_folder = folder.path().join("other");
    fs::create_dir(&other_folder).unwrap();
    let paths = [
        (folder.path().join("Work.mod"), work),
        (folder.path().join("Cell.mod"), cell),
        (other_folder.join("Other.mod"), other),
    ];
    for (path, text) in &paths {
        fs::write(path, text).unwrap();
    }
    let mut client = Client::start(&json!({}));
    client.open(&paths[0].0);
    assert_eq!(client.next_diagnostics().0, "Work.mod");
    client.open(&paths[2].0);
    assert_eq!(client.next_diagnostics().0, "Other.mod");
    // The text on disk is the same, so nothing has changed for the other document.
    let cell = client.open(&paths[1].0);
    assert_eq!(client.next_diagnostics().0, "Cell.mod");
    // Without its call the procedure is dead, which is reported in the other document.
    client.change(&cell, &json!({ "text": paths[1].1.replace("rWork;\n", "") }));
    let reported: std::collections::BTreeMap<String, Vec<Value>> =
        [client.next_diagnostics(), client.next_diagnostics()].into_iter().collect();
    assert_eq!(codes(&reported["Work.mod"]), ["EW702"]);
    assert!(reported["Cell.mod"].is_empty());
    client.stop();
}

/// The text of the editor replaces the file until the document is closed; then the diagnostics,
/// hovers and fixes of the program's other open documents are updated.
#[test]
fn closing_a_document_updates_the_other_documents() {
    let folder = tempfile::tempdir().unwrap();
    let data = fs::read_to_string("fixtures/lint/plants/Shared.mod").unwrap();
    let work = "MODULE Work\nPROC rWork()\n    MoveJ pAUp,v1500,fine,tGripper;\n    \
                MoveL pA,v300,fine,tGripper;\n    WaitTime 1;\nENDPROC\n\
                PROC rStay()\n    MoveJ pBUp,v1500,fine,tGripper;\n    WaitTime 1;\nENDPROC\n\
                ENDMODULE\n";
    let cell = "MODULE Cell\nPROC main()\n    MoveAbsJ jHome,v1000,fine,tGripper;\n    rWork;\n    \
                rStay;\n    MoveAbsJ jHome,v1000,fine,tGripper;\nENDPROC\nENDMODULE\n";
    let paths = ["Shared.mod", "Work.mod", "Cell.mod"].map(|name| folder.path().join(name));
    for (path, text) in paths.iter().zip([data.as_str(), work, cell]) {
        fs::write(path, text).unwrap();
    }
    let mut client = Client::start(&json!({ "robot": "IRB1600-10/1.45" }));
    let work = client.open(&paths[1]);
    assert_eq!(codes(&client.next_diagnostics().1), ["EW101"]);
    let cell = client.open(&paths[2]);
    client.next_diagnostics();
    let text = "MODULE Cell\nPROC main()\nrStay;\nENDPROC\nENDMODULE\n";
    client.change(&cell, &json!({ "text": text }));
    let reported = [client.next_diagnostics(), client.next_diagnostics()];
    let work_findings = reported.iter().find(|(name, _)| name == "Work.mod").unwrap();
    assert!(codes(&work_findings.1).contains(&"EW702"), "{reported:?}");
    client.notify("textDocument/didClose", &json!({ "textDocument": { "uri": cell } }));
    assert_eq!(client.next_diagnostics(), ("Cell.mod".to_owned(), Vec::new()));
    let (name, found) = client.next_diagnostics();
    assert_eq!((name.as_str(), codes(&found)), ("Work.mod", vec!["EW101"]));

    let document = json!({ "uri": work });
    let place = json!({ "line": 3, "character": 6 });
    let asked = json!({ "textDocument": document, "position": place });
    let hover = client.request("textDocument/hover", &asked);
    assert!(hover["contents"]["value"].as_str().unwrap().starts_with("**MoveL**"), "{hover}");
    assert_eq!(hover["range"]["start"], json!({ "line": 3, "character": 4 }));
    let asked = json!({ "textDocument": document, "range": found[0]["range"], "context": { "diagnostics": [] } });
    let actions = client.request("textDocument/codeAction", &asked);
    let edit = &actions[0]["edit"]["changes"][&work][0];
    assert_eq!(actions[0]["isPreferred"], false, "{actions}");
    assert!(edit["newText"].as_str().unwrap().starts_with('z'), "{actions}");
    client.stop();
}

/// Lenses, hints and calls have the costs of the simulated cycle.
#[test]
fn costs_stand_above_routines_behind_statements_and_at_calls() {
    let folder = tempfile::tempdir().unwrap();
    let home = "[[0,-12,14,20,105,-136],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let away = "[[40,-12,14,20,105,-136],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let main = format!(
        "MODULE Main\nPROC main()\n  MoveAbsJ {home},v1000,fine,tool0;\n  rVisit;\n  WaitTime 2;\n  rVisit;\n\
         ENDPROC\nPROC rNever()\n  MoveAbsJ {home},v1000,fine,tool0;\nENDPROC\nENDMODULE\n"
    );
    let visit = format!(
        "MODULE Visit\nPROC rVisit()\n  rGo;\n  MoveAbsJ {home},v1000,fine,tool0;\nENDPROC\n\
         PROC rGo()\n  MoveAbsJ {away},v1000,fine,tool0;\nENDPROC\nENDMODULE\n"
    );
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let (main, visit) = (write("Main.mod", &main), write("Visit.mod", &visit));
    let mut client = Client::start(&json!({ "robot": "IRB1600-10/1.45" }));
    let (main, visit) = (client.open(&main), client.open(&visit));

    // Joules and seconds of "12.3 J, 0.456 s a cycle".
    let costs = |text: &Value| -> [f64; 2] {
        let text = text.as_str().unwrap();
        let figures = text.rsplit_once(" J, ").unwrap();
        let joules = figures.0.rsplit(' ').next().unwrap().parse().unwrap();
        [joules, figures.1.split(' ').next().unwrap().parse().unwrap()]
    };
    let close = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 0.2 && (a[1] - b[1]).abs() < 0.002;
    let document = |uri: &str| json!({ "uri": uri });
    let mut lenses = |uri: &str| {
        let lenses =
            client.request("textDocument/codeLens", &json!({ "textDocument": document(uri) }));
        let lenses = lenses.as_array().unwrap().clone();
        lenses
            .iter()
            .map(|it| {
                (it["range"]["start"]["line"].as_u64().unwrap(), costs(&it["command"]["title"]))
            })
            .collect::<Vec<_>>()
    };
    // rNever is not executed.
    let [(1, whole)] = lenses(&main)[..] else { panic!("main only") };
    let [(1, visits), (5, goes)] = lenses(&visit)[..] else { panic!("two routines") };

    let all =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
    let mut hints = |uri: &str, range: &Value| {
        let asked = json!({ "textDocument": document(uri), "range": range });
        let hints = client.request("textDocument/inlayHint", &asked);
        let hints = hints.as_array().unwrap().clone();
        hints
            .iter()
            .map(|it| (it["position"]["line"].as_u64().unwrap(), costs(&it["label"])))
            .collect::<Vec<_>>()
    };
    let own = hints(&main, &all);
    assert_eq!(own.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [2, 4]);
    assert!((own[1].1[1] - 2.0).abs() < 1e-3, "{own:?}");
    let there = hints(&visit, &all);
    assert_eq!(there.len(), 2);
    assert_eq!(
        hints(
            &visit,
            &json!({ "start": { "line": 6, "character": 0 }, "end": { "line": 7, "character": 0 } })
        ),
        there[1..]
    );
    let sum = |parts: &[[f64; 2]]| parts.iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    assert!(close(goes, there[1].1));
    assert!(close(visits, sum(&[there[0].1, there[1].1])));
    assert!(close(whole, sum(&[own[0].1, own[1].1, visits])), "{whole:?} {own:?} {visits:?}");

    // Both calls of rVisit together take what the routine takes.
    let place =
        json!({ "textDocument": document(&visit), "position": { "line": 1, "character": 6 } });
    let items = client.request("textDocument/prepareCallHierarchy", &place);
    let incoming = client.request("callHierarchy/incomingCalls", &json!({ "item": items[0] }));
    assert_eq!(incoming[0]["fromRanges"].as_array().unwrap().len(), 2);
    assert!(close(costs(&incoming[0]["from"]["detail"]), visits), "{incoming}");
    let outgoing = client.request("callHierarchy/outgoingCalls", &json!({ "item": items[0] }));
    assert_eq!(outgoing[0]["to"]["name"], "rGo");
    assert!(close(costs(&outgoing[0]["to"]["detail"]), goes), "{outgoing}");
    client.stop();
}

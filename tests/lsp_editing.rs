//! Completion, signatures, hover, formatting and diagnostics in the editor.

#![cfg(feature = "lsp")]
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod lsp_client;

use joulepath::rapid::format::{Indent, Style};
use serde_json::{Value, json};

use lsp_client::{Client, Memory, Place, edited, uri};

/// A program around statements of a procedure, in which `|` is the cursor.
fn around(statements: &str) -> (String, usize) {
    let text = format!(
        "MODULE M\nRECORD part string label; num weight; ENDRECORD\nCONST robtarget pHome := [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         VAR part ptOne;\nVAR num nCount;\nVAR bool bDone;\nPERS tooldata tGripper := [TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nVAR intnum inStop;\n\
         ! Puts a part down.\n! Returns when it stands.\nPROC rPlace(robtarget pTo, num nHeight \\switch Fast | switch Slow \\num Force)\nENDPROC\n\
         FUNC robtarget pOver(robtarget pAt, num nUp) RETURN pAt; ENDFUNC\nTRAP tStop\nENDTRAP\n\
         PROC main()\nVAR num nLocal;\nlStart:\n{statements}\nENDPROC\nENDMODULE\n"
    );
    let at = text.rfind('|').unwrap();
    let mut text = text;
    text.remove(at);
    (text, at)
}

fn client(text: &str, snippets: bool) -> Client {
    let capabilities = json!({ "textDocument": { "completion": {
        "completionItem": { "snippetSupport": snippets }
    } } });
    let client = Client::start(Memory::default(), &capabilities);
    client.open("M.mod", text);
    client
}

/// The completions at the cursor, best first.
fn completions(statements: &str, snippets: bool) -> Vec<Value> {
    let (text, at) = around(statements);
    let mut client = client(&text, snippets);
    let list = client.at("completion", &Place::of("M.mod", &text, at));
    let mut items = list["items"].as_array().cloned().unwrap_or_default();
    items.sort_by_key(|item| item["sortText"].as_str().unwrap().to_owned());
    items
}

fn labels(items: &[Value]) -> Vec<&str> {
    items.iter().map(|item| item["label"].as_str().unwrap()).collect()
}

#[test]
fn values_of_the_needed_type_come_first() {
    for (statements, first) in [
        ("MoveJ |", &["pHome", "pOver"][..]),
        ("MoveJ pHome, v|", &["v10", "v100"]),
        ("MoveJ pHome, v100, |", &["fine", "z0"]),
        ("MoveJ pHome \\V:=|", &["nCount", "nLocal"]),
        ("MoveJ pHome, v100, fine, t|", &["tGripper", "tool0"]),
        ("rPlace pOver(pHome, |", &["nCount", "nLocal"]),
        ("nCount := |", &["nCount", "nLocal"]),
        ("ptOne.weight := |", &["nCount"]),
        ("IF |", &["bDone"]),
        ("IF bDone MoveJ |", &["pHome"]),
    ] {
        let items = completions(statements, false);
        let labels = labels(&items);
        assert_eq!(&labels[..first.len()], first, "{statements}: {labels:?}");
    }
}

#[test]
fn each_place_offers_what_can_stand_there() {
    for (statements, wanted, unwanted) in [
        ("|", &["rPlace", "MoveJ", "IF", "nLocal", "ENDPROC"][..], &["pOver", "PROC", "num"][..]),
        ("rPl|", &["rPlace"], &["MoveJ", "IF"]),
        ("IF bDone |", &["THEN", "AND", "rPlace"], &["nCount"]),
        ("IF bDone THEN |", &["rPlace", "ENDIF"], &["THEN"]),
        ("ptOne.|", &["label", "weight"], &["nCount", "MoveJ"]),
        ("nCount := pHome.trans.|", &["x", "y", "z"], &["trans"]),
        ("nCount := pOver(pHome,1).rot.|", &["q1"], &["x"]),
        ("rPlace pHome, 1 \\|", &["Fast", "Slow", "Force"], &["pTo", "nHeight"]),
        ("rPlace pHome, 1 \\Fast \\|", &["Force"], &["Fast", "pTo"]),
        ("GOTO |", &["lStart"], &["nCount"]),
        ("CONNECT inStop WITH |", &["tStop"], &["rPlace"]),
        ("VAR |", &["num", "part", "robtarget"], &["nCount", "ANYTYPE"]),
        ("VAR num |", &[], &["nCount"]),
        ("VAR num n := |", &["nCount"], &["VAR"]),
        ("! |", &[], &["nCount"]),
        ("TPWrite \"|", &[], &["nCount"]),
        ("ENDPROC\n|", &["PROC", "FUNC", "VAR"], &["MoveJ", "IF"]),
        ("ENDPROC\nPROC r(|", &["num", "INOUT", "part"], &["nCount"]),
        ("ENDPROC\nLOCAL |", &["PERS", "PROC"], &["num"]),
    ] {
        let items = completions(statements, false);
        let labels = labels(&items);
        for label in wanted {
            assert!(labels.contains(label), "{statements}: no {label} in {labels:?}");
        }
        for label in unwanted {
            assert!(!labels.contains(label), "{statements}: {label} is offered");
        }
    }
}

#[test]
fn arguments_are_snippets_where_the_client_can_fill_them_in() {
    let text = |statements: &str, label: &str, snippets: bool| {
        let items = completions(statements, snippets);
        let item = items.iter().find(|item| item["label"] == label).unwrap().clone();
        (item["textEdit"]["newText"].as_str().unwrap().to_owned(), item["insertTextFormat"].clone())
    };
    let snippet = json!(2);
    assert_eq!(
        text("Move|", "MoveL", true),
        ("MoveL ${1:ToPoint}, ${2:Speed}, ${3:Zone}, ${4:Tool};".to_owned(), snippet.clone())
    );
    assert_eq!(
        text("|", "rPlace", true),
        ("rPlace ${1:pTo}, ${2:nHeight};".to_owned(), snippet.clone())
    );
    assert_eq!(
        text("MoveJ p|", "pOver", true),
        ("pOver(${1:pAt}, ${2:nUp})".to_owned(), snippet.clone())
    );
    assert_eq!(text("rPlace pHome,1 \\F|", "Force", true).0, "Force:=${1}");
    assert_eq!(text("rPlace pHome,1 \\F|", "Fast", true).0, "Fast");
    assert_eq!(text("Move|", "MoveL", false), ("MoveL".to_owned(), Value::Null));
    // What follows on the line stays.
    assert_eq!(text("Move| pHome, v100;", "MoveL", true), ("MoveL".to_owned(), Value::Null));
}

#[test]
fn the_parameter_of_the_argument_is_marked() {
    for (statements, active) in [
        ("rPlace |", "robtarget pTo"),
        ("rPlace pHome|", "robtarget pTo"),
        ("rPlace pHome, |", "num nHeight"),
        ("rPlace pHome, 1 \\|", "\\switch Fast"),
        ("rPlace pHome, 1 \\Slow|", "switch Slow"),
        ("rPlace pHome, 1 \\Force:=|", "\\num Force"),
        ("rPlace nHeight:=|", "num nHeight"),
        ("rPlace pOver(pHome, |", "num nUp"),
        ("rPlace pOver(pHome, 1), |", "num nHeight"),
        ("rPlace [[1,2,3],|", "robtarget pTo"),
        ("MoveAbsJ \\Conc, |", "jointtarget ToJointPos"),
        ("MoveL pHome\\V:=1, v100, fine, |", "PERS tooldata Tool"),
        ("IF bDone rPlace pHome, |", "num nHeight"),
        ("nCount := Abs(|", "num Value"),
    ] {
        let (text, at) = around(statements);
        let mut client = client(&text, false);
        let help = client.at("signatureHelp", &Place::of("M.mod", &text, at));
        let signature = &help["signatures"][0];
        let label = signature["label"].as_str().unwrap();
        let number = help["activeParameter"].as_u64().unwrap() as usize;
        let range = &signature["parameters"][number]["label"];
        let [start, end] = [0, 1].map(|n| range[n].as_u64().unwrap() as usize);
        assert_eq!(&label[start..end], active, "{statements}: {label}");
    }
    let (text, at) = around("rPlace |");
    let help = client(&text, false).at("signatureHelp", &Place::of("M.mod", &text, at));
    assert_eq!(
        help["signatures"][0]["label"],
        "PROC rPlace(robtarget pTo, num nHeight, \\switch Fast | switch Slow, \\num Force)"
    );
    assert_eq!(
        help["signatures"][0]["documentation"],
        "Puts a part down.\nReturns when it stands."
    );
}

#[test]
fn hover_shows_the_declaration_and_its_comment() {
    let (text, _) =
        around("rPlace pHome, nCount; MoveJ pHome, v100, fine, tool0; ptOne.weight := 1;|");
    let mut client = client(&text, false);
    let mut hover = |word: &str| {
        let place = Place::of("M.mod", &text, text.rfind(word).unwrap());
        let answer = client.at("hover", &place);
        answer["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    let shown = hover("rPlace pHome");
    assert!(shown.starts_with("```rapid\nPROC rPlace(robtarget pTo"), "{shown}");
    assert!(shown.ends_with("Puts a part down.  \nReturns when it stands."), "{shown}");
    assert_eq!(hover("nCount; MoveJ"), "```rapid\nVAR num nCount;\n```");
    assert_eq!(hover("weight := 1"), "```rapid\nnum weight (RECORD part)\n```");
    assert_eq!(hover("v100"), "```rapid\nCONST speeddata v100\n```");
    assert!(hover("MoveJ pHome").contains("PROC MoveJ(\\switch Conc, robtarget ToPoint"));
    assert_eq!(hover("ENDMODULE"), "");
}

#[test]
fn documents_and_ranges_are_formatted_in_the_style_of_the_cell() {
    let text = "module M\nproc main()\nif TRUE then\nStop;\nendif\nStop ;\nendproc\nendmodule\n";
    let style = Style { indent: Indent::Spaces(3), ..Style::default() };
    let memory = Memory { style: Some(style), ..Memory::default() };
    let mut client = Client::start(memory, &json!({}));
    client.open("M.mod", text);
    let edits = client.about("formatting", "M.mod");
    let formatted = edited(text, edits.as_array().unwrap());
    let wanted = "MODULE M\n   PROC main()\n      IF TRUE THEN\n         Stop;\n      ENDIF\n      Stop;\n   ENDPROC\nENDMODULE\n";
    assert_eq!(formatted, wanted);
    let range = json!({
        "start": { "line": 5, "character": 0 }, "end": { "line": 5, "character": 3 }
    });
    let params = json!({ "textDocument": { "uri": uri("M.mod") }, "range": range });
    let edits = client.request("textDocument/rangeFormatting", params);
    let formatted = edited(text, edits.as_array().unwrap());
    assert!(formatted.contains("\n      Stop;\nendproc"), "{formatted}");
    assert!(formatted.contains("\nif TRUE then\nStop;"), "{formatted}");
}

/// A client that asks for diagnostics gets them on demand; others get them after a pause.
#[test]
fn faults_are_diagnostics() {
    let text = "MODULE M\nPROC main()\nrGone;\nnUnset := 1\nENDPROC\nENDMODULE\n";
    let codes = |diagnostics: &Value| {
        let items = diagnostics.as_array().unwrap().iter();
        items.map(|one| one["code"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let mut pushed = Client::start(Memory::default(), &json!({}));
    pushed.open("M.mod", text);
    pushed.wait();
    let published = codes(&pushed.published["M.mod"]);
    assert!(published.contains(&"syntax".to_owned()), "{published:?}");
    assert!(published.contains(&"unknown-name".to_owned()), "{published:?}");

    let capabilities = json!({
        "textDocument": { "diagnostic": {}, "publishDiagnostics": { "relatedInformation": true } },
        "workspace": { "diagnostics": { "refreshSupport": true } }
    });
    let twice = "MODULE M\nVAR num nA;\nVAR num nA;\nPROC main()\nENDPROC\nENDMODULE\n";
    let mut pulled = Client::start(Memory::default(), &capabilities);
    pulled.open("M.mod", twice);
    let report = pulled.about("diagnostic", "M.mod");
    assert_eq!(report["kind"], "full");
    assert!(codes(&report["items"]).contains(&"duplicate-name".to_owned()), "{report}");
    let first = report["items"].as_array().unwrap().iter();
    let first = first.clone().find(|one| one["code"] == "duplicate-name").unwrap().clone();
    assert_eq!(first["relatedInformation"][0]["location"]["range"]["start"]["line"], 1);
    assert!(pulled.published.is_empty());
    pulled.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
    pulled.wait();
    assert_eq!(pulled.asked, ["workspace/diagnostic/refresh"]);
}

#[test]
fn malformed_requests_have_errors_and_unknown_documents_no_answer() {
    let mut client = Client::start(Memory::default(), &json!({}));
    let place = Place { file: "Gone.mod".to_owned(), line: 0, character: 0 };
    assert_eq!(client.at("definition", &place), Value::Null);
    assert_eq!(client.at("completion", &place), Value::Null);
    assert_eq!(client.about("formatting", "Gone.mod"), Value::Null);
    assert!(client.refusal("textDocument/definition", json!({})).contains("textDocument"));
    assert!(client.refusal("textDocument/linkedEditingRange", json!({})).contains("not served"));
}

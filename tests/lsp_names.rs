//! Names in the editor: definitions, references, highlights, symbols, calls.

#![cfg(feature = "lsp")]
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod lsp_client;

use serde_json::{Value, json};

use lsp_client::{Client, Marked, Memory, Place, name, uri};

const CELL: &[(&str, &str)] = &[
    (
        "Main.mod",
        "MODULE Main\n\
         ! How often a part is tried.\n\
         CONST num <1>nTries := 3;\n\
         LOCAL VAR num <2>nCount;\n\
         PERS part <3>pt := [\"a\", 1];\n\
         PROC main()\n\
         <4>rPick <5>nTries \\Fast;\n\
         <6>nCount := <7>pt.<8>weight + <9>fTwice(2);\n\
         FOR <10>nCount FROM 1 TO 2 DO\n\
         <11>nCount := <12>ncount;\n\
         ENDFOR\n\
         GOTO <13>done;\n\
         <14>done:\n\
         ENDPROC\n\
         ENDMODULE\n",
    ),
    (
        "Lib.sys",
        "MODULE Lib(SYSMODULE)\n\
         RECORD <20>part string label; num <21>weight; ENDRECORD\n\
         LOCAL VAR num <22>nCount;\n\
         PROC <23>rPick(num <24>nTries \\switch <25>Fast)\n\
         IF Present(<26>Fast) <27>nCount := <28>NTRIES;\n\
         MoveJ <29>p10, v100, fine, tool0;\n\
         ENDPROC\n\
         FUNC num <30>fTwice(num x) RETURN 2 * x; ENDFUNC\n\
         CONST robtarget p10 := [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         ENDMODULE\n",
    ),
];

#[test]
fn definitions_respect_scopes() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let found = [
        (5, "1"),
        (6, "2"),
        (4, "23"),
        (8, "21"),
        (9, "30"),
        (11, "10"),
        (12, "10"),
        (13, "14"),
        (26, "25"),
        (27, "22"),
        (28, "24"),
    ];
    for (from, to) in found {
        let answer = client.at("definition", cell.place(from));
        assert_eq!(cell.named(&answer), [to], "from mark {from}");
    }
    let to_type = client.at("typeDefinition", cell.place(7));
    assert_eq!(cell.named(&to_type), ["20"]);
    // `tool0` is predefined, and behind the last word is none.
    let text = cell.text("Lib.sys");
    for at in [text.find("tool0").unwrap(), text.len()] {
        let answer = client.at("definition", &Place::of("Lib.sys", &text, at));
        assert_eq!(answer, json!([]));
    }
}

#[test]
fn references_are_found_in_all_files() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let mut references = |mark: u32, with: bool| {
        let mut params = cell.place(mark).params();
        params["context"] = json!({ "includeDeclaration": with });
        cell.named(&client.request("textDocument/references", params))
    };
    assert_eq!(references(1, true), ["1", "5"]);
    assert_eq!(references(24, true), ["24", "28"]);
    assert_eq!(references(6, true), ["2", "6"]);
    assert_eq!(references(22, true), ["22", "27"]);
    assert_eq!(references(10, true), ["10", "11", "12"]);
    assert_eq!(references(21, false), ["8"]);
    assert_eq!(references(23, false), ["4"]);
}

/// What the editor has open replaces the file; a change is seen at once.
#[test]
fn answers_follow_the_text_of_the_editor() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let text = cell.text("Lib.sys");
    client.open("Lib.sys", &text);
    let place = Place::of("Lib.sys", &text, text.find("rPick").unwrap());
    let end = json!({ "line": place.line, "character": place.character + 5 });
    let start = json!({ "line": place.line, "character": place.character });
    client
        .change("Lib.sys", &[json!({ "range": { "start": start, "end": end }, "text": "rGrip" })]);
    assert_eq!(client.at("definition", cell.place(4)), json!([]));
    client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri("Lib.sys") } }));
    assert_eq!(cell.named(&client.at("definition", cell.place(4))), ["23"]);
}

/// One persistent with the same name in the tasks of a controller is one datum; other data are not. A
/// file of two tasks may mean a declaration in each.
#[test]
fn tasks_share_global_persistents() {
    let mut cell = Marked::new(&[
        (
            "A.mod",
            "MODULE A\nPERS num <1>nShared := 1;\nLOCAL PERS num <2>nOwn := 1;\nTASK PERS num <3>nTask := 1;\nPROC main()\n<4>nShared := <5>nOwn;\nENDPROC\nENDMODULE\n",
        ),
        (
            "B.mod",
            "MODULE B\nPERS num <11>nShared := 1;\nLOCAL PERS num <12>nOwn := 1;\nTASK PERS num <13>nTask := 1;\nPROC main()\n<14>nshared := <15>nOwn;\nENDPROC\nENDMODULE\n",
        ),
        ("Both.mod", "MODULE Both\nPROC rBoth()\n<21>nShared := <22>nTask;\nENDPROC\nENDMODULE\n"),
    ]);
    cell.memory.tasks = vec![vec![0, 2], vec![1, 2]];
    let mut client = cell.start();
    let mut references = |mark: u32| {
        let answer = client.request("textDocument/references", cell.place(mark).params());
        cell.named(&answer)
    };
    assert_eq!(references(4), ["1", "4", "11", "14", "21"]);
    assert_eq!(references(15), ["12", "15"]);
    assert_eq!(references(3), ["3", "13", "22"]);
    assert_eq!(cell.named(&client.at("definition", cell.place(22))), ["3", "13"]);
}

#[test]
fn highlights_tell_reading_from_writing() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let answer = client.at("documentHighlight", cell.place(2));
    let kinds: Vec<&Value> = answer.as_array().unwrap().iter().map(|one| &one["kind"]).collect();
    assert_eq!(kinds, [3, 3]);
    let answer = client.at("documentHighlight", cell.place(12));
    let kinds: Vec<&Value> = answer.as_array().unwrap().iter().map(|one| &one["kind"]).collect();
    assert_eq!(kinds, [3, 3, 2]);
    let text = cell.text("Lib.sys");
    let tool = Place::of("Lib.sys", &text, text.find("tool0").unwrap());
    assert_eq!(client.at("documentHighlight", &tool).as_array().unwrap().len(), 1);
}

#[test]
fn symbols_are_nested_where_the_client_can_show_it() {
    let cell = Marked::new(CELL);
    let nested = json!({
        "textDocument": { "documentSymbol": { "hierarchicalDocumentSymbolSupport": true } }
    });
    let mut client = Client::start(cell.memory.clone(), &nested);
    let symbols = client.about("documentSymbol", "Lib.sys");
    let module = &symbols[0];
    let children: Vec<(&str, u64)> = module["children"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| (one["name"].as_str().unwrap(), one["kind"].as_u64().unwrap()))
        .collect();
    assert_eq!(module["name"], "Lib");
    assert_eq!(
        children,
        [("part", 23), ("nCount", 13), ("rPick", 12), ("fTwice", 12), ("p10", 14)]
    );
    assert_eq!(module["children"][1]["detail"], "LOCAL VAR num");
    let mut flat = cell.start();
    let symbols = flat.about("documentSymbol", "Lib.sys");
    assert_eq!(symbols[0]["name"], "Lib");
    assert_eq!(symbols[1]["containerName"], "Lib");
    let found = flat.request("workspace/symbol", json!({ "query": "ncnt" }));
    let names: Vec<&Value> = found.as_array().unwrap().iter().map(|one| &one["name"]).collect();
    assert_eq!(names, ["nCount", "nCount"]);
}

#[test]
fn calls_are_found_in_both_directions() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let items = client.at("prepareCallHierarchy", cell.place(4));
    assert_eq!((&items[0]["name"], &items[0]["detail"]), (&json!("rPick"), &json!("Lib")));
    let incoming = client.request("callHierarchy/incomingCalls", json!({ "item": items[0] }));
    assert_eq!(incoming[0]["from"]["name"], "main");
    assert_eq!(incoming[0]["fromRanges"].as_array().unwrap().len(), 1);
    let outgoing =
        client.request("callHierarchy/outgoingCalls", json!({ "item": incoming[0]["from"] }));
    let names: Vec<&Value> =
        outgoing.as_array().unwrap().iter().map(|one| &one["to"]["name"]).collect();
    assert_eq!(names, ["rPick", "fTwice"]);
    assert_eq!(client.at("prepareCallHierarchy", cell.place(2)), json!([]));
}

/// Columns are in UTF-16 units, or in bytes of UTF-8 if the client can do that, whatever the encoding
/// and the line ends of the file.
#[test]
fn positions_are_right_in_every_encoding() {
    let text = "MODULE M\r\n! Größe 🙂\r\nVAR num nGröße;\r\nPROC main()\r\nTPWrite \"ü🙂\"; nGröße := 1;\r\nENDPROC\r\nENDMODULE\r\n";
    let latin = text.replace('🙂', "");
    let latin_bytes: Vec<u8> = latin.chars().map(|sign| sign as u8).collect();
    for (text, bytes) in [(text, text.as_bytes().to_vec()), (latin.as_str(), latin_bytes)] {
        for utf8 in [true, false] {
            let memory =
                Memory { files: vec![("M.mod".to_owned(), bytes.clone())], ..Memory::default() };
            let encodings = if utf8 { json!(["utf-8", "utf-16"]) } else { json!(["utf-16"]) };
            let capabilities = json!({ "general": { "positionEncodings": encodings } });
            let mut client = Client::start(memory, &capabilities);
            let agreed = if utf8 { "utf-8" } else { "utf-16" };
            assert_eq!(client.capabilities["positionEncoding"], agreed);
            let line = text.lines().nth(4).unwrap();
            let start = line.find("nGröße").unwrap();
            let units = |text: &str| if utf8 { text.len() } else { text.encode_utf16().count() };
            let column = units(&line[..start]);
            let params = json!({
                "textDocument": { "uri": uri("M.mod") },
                // In the middle of the word, behind the letter beyond ASCII.
                "position": { "line": 4, "character": column + units("nGrö") },
                "context": { "includeDeclaration": true }
            });
            let found = client.request("textDocument/references", params);
            let second = &found[1]["range"];
            assert_eq!(second["start"], json!({ "line": 4, "character": column }));
            assert_eq!(second["end"], json!({ "line": 4, "character": column + units("nGröße") }));
            let tokens = client.about("semanticTokens/full", "M.mod");
            let data = tokens["data"].as_array().unwrap();
            assert_eq!(data.len() % 5, 0);
            let lengths: Vec<usize> =
                data.chunks(5).map(|token| token[2].as_u64().unwrap() as usize).collect();
            assert!(lengths.iter().filter(|it| **it == units("nGröße")).count() >= 2);
        }
    }
}

#[test]
fn semantic_tokens_have_kinds_by_meaning() {
    let cell = Marked::new(CELL);
    let mut client = cell.start();
    let legend = client.capabilities["semanticTokensProvider"]["legend"].clone();
    let tokens = client.about("semanticTokens/full", "Lib.sys");
    let text = cell.text("Lib.sys");
    let lines: Vec<&str> = text.lines().collect();
    let (mut line, mut column) = (0, 0);
    let mut found = Vec::new();
    for token in tokens["data"].as_array().unwrap().chunks(5) {
        let [down, right, length, kind, modifiers] =
            [0, 1, 2, 3, 4].map(|n| token[n].as_u64().unwrap() as usize);
        column = if down == 0 { column + right } else { right };
        line += down;
        let kind = legend["tokenTypes"][kind].as_str().unwrap();
        found.push((&lines[line][column..column + length], kind, modifiers));
    }
    for wanted in [
        ("Lib", "namespace", 1),
        ("part", "struct", 1),
        ("string", "type", 4),
        ("weight", "property", 1),
        ("rPick", "function", 1),
        ("Fast", "parameter", 0),
        ("NTRIES", "parameter", 0),
        ("Present", "function", 4),
        ("MoveJ", "function", 4),
        ("v100", "variable", 6),
        ("p10", "variable", 2),
        ("RETURN", "keyword", 0),
        ("9E9", "number", 0),
    ] {
        assert!(found.contains(&wanted), "{wanted:?} is not in {found:?}");
    }
}

#[test]
fn parts_of_several_lines_can_be_folded() {
    let text = "! One\n! two\nMODULE M\nPROC main()\nIF TRUE THEN\nStop;\nELSE\nExitCycle;\nStop;\nENDIF\nENDPROC\nENDMODULE\n";
    let mut client = Client::start(Memory::new(&[("M.mod", text)]), &json!({}));
    let found = client.about("foldingRange", "M.mod");
    let ranges: Vec<(u64, u64)> = found
        .as_array()
        .unwrap()
        .iter()
        .map(|one| (one["startLine"].as_u64().unwrap(), one["endLine"].as_u64().unwrap()))
        .collect();
    assert_eq!(ranges, [(0, 1), (2, 10), (3, 9), (4, 8), (6, 8)]);
    assert_eq!(found[0]["kind"], "comment");
}

#[test]
fn strings_that_name_a_module_are_links() {
    let main = "MODULE Main\nPROC main()\nLoad \\Dynamic,\"HOME:/parts/PART.mod\";\n\
                TPWrite \"Part\";\nLoad \\Dynamic,\"HOME:\"\\File:=\"Gone.mod\";\nENDPROC\nENDMODULE\n";
    let part = "MODULE Part\nENDMODULE\n";
    let files = [("Main.mod", main), ("parts/Part.mod", part)];
    let mut client = Client::start(Memory::new(&files), &json!({}));
    let links = client.about("documentLink", "Main.mod");
    let links = links.as_array().unwrap();
    assert_eq!(links.len(), 1, "{links:?}");
    assert_eq!(name(&links[0]["target"]), "parts/Part.mod");
    let (start, end) = (&links[0]["range"]["start"], &links[0]["range"]["end"]);
    assert_eq!(
        (start, end),
        (&json!({ "line": 2, "character": 15 }), &json!({ "line": 2, "character": 35 }))
    );

    // Of two files with the name, the path tells which is meant.
    let main = "MODULE Main\nPROC main()\nLoad \\Dynamic,\"HOME:/b/Part.mod\";\n\
                Load \\Dynamic,\"HOME:\"\\File:=\"Part.mod\";\nENDPROC\nENDMODULE\n";
    let files = [("Main.mod", main), ("a/Part.mod", part), ("b/Part.mod", part)];
    let mut client = Client::start(Memory::new(&files), &json!({}));
    let links = client.about("documentLink", "Main.mod");
    let found: Vec<_> = links.as_array().unwrap().iter().map(|it| name(&it["target"])).collect();
    assert_eq!(found, ["b/Part.mod"]);
}

#![cfg(feature = "lsp")]
mod lsp_client;
use lsp_client::{Client, Memory, Place};
use serde_json::json;
use std::fmt::Write as _;
use std::time::Instant;

#[test]
fn latency() {
    let mut files = Vec::new();
    for m in 0..20 {
        let mut text = format!("MODULE M{m}\nPERS num nShared{m} := 1;\n");
        for i in 0..170 {
            writeln!(text, "! The point {i}.\nCONST robtarget p{m}_{i} := [[{i},0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];").unwrap();
        }
        for r in 0..100 {
            writeln!(text, "! Does the work {r}.\nPROC rWork{m}_{r}(num nTimes \\switch Fast)\nVAR num nLocal;").unwrap();
            for i in 0..6 {
                writeln!(text, "  MoveL p{m}_{i}, v100, z10, tool0;\n  nLocal := nLocal + nTimes * nShared0;").unwrap();
            }
            writeln!(text, "  rWork{}_{r} nLocal \\Fast;\nENDPROC", (m + 1) % 20).unwrap();
        }
        if m == 0 { text.push_str("PROC main()\nrWork0_0 1;\nENDPROC\n"); }
        text.push_str("ENDMODULE\n");
        files.push((format!("M{m}.mod"), text.into_bytes()));
    }
    let size: usize = files.iter().map(|f| f.1.len()).sum();
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    let memory = Memory { files, ..Memory::default() };
    let mut client = Client::start(memory, &json!({"textDocument": {"diagnostic": {}}}));
    println!("{size} bytes");
    client.open("M0.mod", &text);
    let place = Place::of("M0.mod", &text, text.find("nShared0;").unwrap());
    let first = Instant::now();
    client.at("definition", &place);
    println!("first definition {:?}", first.elapsed());
    for method in ["definition", "references", "hover", "completion", "signatureHelp", "documentHighlight", "prepareCallHierarchy"] {
        for edit in [false, true] {
            let mut worst = std::time::Duration::ZERO;
            let mut size = 0;
            for _ in 0..5 {
                if edit { client.change("M0.mod", &[json!({"range": {"start": {"line": 1, "character": 0}, "end": {"line": 1, "character": 0}}, "text": " "})]); }
                let place = if edit { Place { character: place.character, ..place.clone() } } else { place.clone() };
                let t = Instant::now();
                let a = client.at(method, &place);
                size = a.to_string().len();
                worst = worst.max(t.elapsed());
            }
            println!("{method} edit={edit} worst {worst:?} ({size} bytes)");
        }
    }
    let t = Instant::now();
    let edits = client.rename(&place, "nCommon0");
    println!("rename {:?} in {} files", t.elapsed(), edits.len());
    for method in ["semanticTokens/full", "documentSymbol", "foldingRange", "formatting", "diagnostic"] {
        let t = Instant::now();
        client.about(method, "M0.mod");
        println!("{method} {:?}", t.elapsed());
    }
    let t = Instant::now();
    client.request("workspace/symbol", json!({"query": "rwork"}));
    println!("workspace/symbol {:?}", t.elapsed());
}

//! The syntax colours of the editor extension agree with the grammar.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;
use std::path::Path;

use joulepath::rapid::builtins::is_movement;
use serde_json::{Value, json};

const GRAMMAR: &str = "editors/vscode/syntaxes/rapid.tmLanguage.json";

/// The quoted words of a production.
fn words(text: &str, production: &str) -> Vec<String> {
    let body = text.split(&format!("\n{production} =")).nth(1).unwrap();
    let body = body.split(';').next().unwrap();
    body.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

fn any(words: &[String]) -> String {
    format!("(?i)\\b({})\\b", words.join("|"))
}

fn textmate() -> Value {
    let lexical = fs::read_to_string("grammar/lexical.ebnf").unwrap();
    let (operators, rest): (Vec<String>, Vec<String>) = words(&lexical, "keyword")
        .into_iter()
        .partition(|word| matches!(word.as_str(), "AND" | "DIV" | "MOD" | "NOT" | "OR" | "XOR"));
    let (constants, keywords): (Vec<String>, Vec<String>) =
        rest.into_iter().partition(|word| matches!(word.as_str(), "TRUE" | "FALSE"));
    let placeholders = words(&lexical, "placeholder");
    let placeholders: Vec<String> =
        placeholders.into_iter().filter(|word| word.chars().all(char::is_alphabetic)).collect();
    let moves: Vec<String> =
        ["MoveAbsJ", "MoveJ", "MoveL", "MoveC", "TriggJ", "TriggL", "TriggC", "SearchL", "SearchC"]
            .into_iter()
            .filter(|name| is_movement(name))
            .map(str::to_owned)
            .collect();
    json!({
        "name": "RAPID",
        "scopeName": "source.rapid",
        "patterns": [
            { "name": "comment.line.exclamation.rapid", "match": "!.*$" },
            {
                "name": "string.quoted.double.rapid",
                "begin": "\"",
                "end": "\"|$",
                "patterns": [
                    {
                        "name": "constant.character.escape.rapid",
                        "match": "\"\"|\\\\\\\\|\\\\[0-9A-Fa-f]{2}"
                    }
                ]
            },
            {
                "name": "invalid.illegal.placeholder.rapid",
                "match": format!("<({})>", placeholders.join("|"))
            },
            {
                "name": "constant.numeric.rapid",
                "match": "(?i)\\b(0x[0-9a-f]+|0b[01]+|0o[0-7]+|[0-9]+(\\.[0-9]*)?(e[+-]?[0-9]+)?)"
            },
            { "name": "keyword.operator.word.rapid", "match": any(&operators) },
            { "name": "constant.language.rapid", "match": any(&constants) },
            { "name": "keyword.control.rapid", "match": any(&keywords) },
            { "name": "support.function.movement.rapid", "match": any(&moves) }
        ]
    })
}

#[test]
fn the_editor_grammar_agrees_with_the_lexical_grammar() {
    let fresh = serde_json::to_string_pretty(&textmate()).unwrap() + "\n";
    let written = fs::read_to_string(GRAMMAR).unwrap_or_default();
    if fresh != written {
        let to = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rapid.tmLanguage.json");
        fs::write(&to, fresh).unwrap();
        panic!("{GRAMMAR} is not what grammar/lexical.ebnf says; copy {} there", to.display());
    }
}

#[test]
fn files_named_in_the_manifest_exist() {
    let folder = Path::new("editors/vscode");
    let text = fs::read_to_string(folder.join("package.json")).unwrap();
    let manifest: Value = serde_json::from_str(&text).unwrap();
    for path in [
        &manifest["contributes"]["languages"][0]["configuration"],
        &manifest["contributes"]["grammars"][0]["path"],
    ] {
        assert!(folder.join(path.as_str().unwrap()).is_file(), "{path}");
    }
    // The program of the extension is bundled from files that exist.
    let build = fs::read_to_string(folder.join("esbuild.mjs")).unwrap();
    let main = manifest["main"].as_str().unwrap().trim_start_matches("./");
    assert!(build.contains(&format!("outfile: \"{main}\"")), "{main}");
    let sources: Vec<&str> = build
        .split('"')
        .filter(|text| ["src/", "view/"].iter().any(|folder| text.starts_with(folder)))
        .collect();
    assert!(sources.len() > 1, "{sources:?}");
    for source in sources {
        assert!(folder.join(source).is_file(), "{source}");
    }
}

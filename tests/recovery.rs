//! Error recovery in ordinary programs: a missing or surplus token causes one error and affects at
//! most one statement.

#![expect(clippy::unwrap_used, reason = "a missing fixture fails the test")]

mod support;

use std::path::Path;

use joulepath::rapid::syntax::{self, Parse};
use support::token_ranges;

/// The shipped programs, without the fixtures of the parser.
fn programs() -> Vec<(String, Vec<u8>)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let mut programs: Vec<(String, Vec<u8>)> = ["hard", "paper", "pick_place"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "mod" || end == "sys"))
        .map(|path| (path.display().to_string(), std::fs::read(&path).unwrap()))
        .collect();
    programs.sort();
    programs
}

fn statements(parse: &Parse) -> usize {
    parse.tree.nodes().filter(|node| node.kind().is_statement()).count()
}

#[test]
fn a_missing_or_surplus_token_causes_one_error() {
    let mut mutations = 0;
    let mut wrong = Vec::new();
    for (path, source) in programs() {
        let whole = syntax::parse(&source);
        if !whole.errors.is_empty() {
            continue;
        }
        let tokens = token_ranges(&source);
        for token in tokens.iter().filter(|token| !source[token.start].is_ascii_whitespace()) {
            let text = &source[token.clone()];
            let mut without = source.clone();
            without.drain(token.clone());
            let mut twice = source.clone();
            twice.splice(token.end..token.end, [b" ", text].concat());
            for mutated in [without, twice] {
                let parse = syntax::parse(&mutated);
                mutations += 1;
                if parse.errors.len() > 1 || statements(&parse) + 1 < statements(&whole) {
                    let line = source[..token.start].split(|byte| *byte == b'\n').count();
                    let messages: Vec<&str> =
                        parse.errors.iter().map(|error| error.message.as_str()).collect();
                    let text = String::from_utf8_lossy(text);
                    wrong.push(format!("{path}:{line} {text}: {messages:?}"));
                }
            }
        }
    }
    assert!(mutations > 20_000, "{mutations} mutations");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

//! Error recovery in ordinary programs: a missing or surplus token causes one error and affects at
//! most one statement.

#![expect(clippy::unwrap_used, reason = "a missing fixture fails the test")]

mod support;

use joulepath::rapid::syntax::{self, Parse};
use support::{module_paths, token_ranges};

/// The shipped programs, without the fixtures of the parser.
fn programs() -> Vec<(String, Vec<u8>)> {
    let paths = ["hard", "paper", "pick_place"].into_iter().flat_map(module_paths);
    paths.map(|path| (path.display().to_string(), std::fs::read(&path).unwrap())).collect()
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

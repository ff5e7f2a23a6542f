//! Rules of the project that clippy does not check.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod rust_source;

use rust_source::files;
use rust_source::tokens::{Token, tokens};

/// Largest number of lines of a file.
const MAX_LINES: usize = 500;

/// Stands for the rest of an attribute without a reason.
const BARE: &str = "";

/// Marks of unfinished work and of disabled lints, as sequences of tokens.
const FORBIDDEN: [(&[&str], &str); 4] = [
    (
        &["[", "allow", "(", BARE],
        "use #[expect(…, reason = \"…\")], which says why and when it is over",
    ),
    (&["todo", "!"], "finish it, or return an error that says what is missing"),
    (&["unimplemented", "!"], "finish it, or return an error that says what is missing"),
    (&["[", "ignore"], "a test that does not run proves nothing"),
];

fn find(source: &[Token<'_>], sequence: &[&str]) -> Option<usize> {
    let starts_at = |i: usize| {
        sequence.iter().zip(i..).all(|(text, k)| match *text {
            BARE => is_bare(&source[k.min(source.len())..]),
            text => source.get(k).is_some_and(|token| token.text == text),
        })
    };
    (0..source.len()).find(|i| starts_at(*i)).map(|i| source[i].line)
}

/// Whether an attribute has no reason; the tokens start inside its parenthesis.
fn is_bare(attribute: &[Token<'_>]) -> bool {
    let mut inside = attribute.iter().take_while(|token| token.text != "]");
    !inside.any(|token| token.text == "reason")
}

#[test]
fn files_of_the_library_are_small() {
    let mut large = Vec::new();
    for file in files(&["src"]) {
        let lines = file.text.lines().count();
        if lines > MAX_LINES {
            large.push(format!("{}: {lines} lines, split it by purpose", file.path));
        }
    }
    assert!(large.is_empty(), "{}", large.join("\n"));
}

#[test]
fn nothing_is_silenced_or_unfinished() {
    let mut found = Vec::new();
    for file in files(&["src", "tests", "benches"]) {
        let source = tokens(&file.text);
        for (sequence, advice) in FORBIDDEN {
            if let Some(line) = find(&source, sequence) {
                found.push(format!("{}:{line}: {}: {advice}", file.path, sequence.concat()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn forbidden_sequences_are_found_in_code_only() {
    let bad = ["#[allow(dead_code)]", "#![allow(\n x)]", "todo!()", "#[test]\n#[ignore]"];
    for text in bad {
        let source = tokens(text);
        assert!(FORBIDDEN.iter().any(|(sequence, _)| find(&source, sequence).is_some()), "{text}");
    }
    let good = [
        "// #[allow(x)]",
        "\"todo!()\"",
        "#[expect(x)]",
        "#![allow(x, reason = \"shared\")]",
        "/* unimplemented!() */",
    ];
    for text in good {
        let source = tokens(text);
        assert!(FORBIDDEN.iter().all(|(sequence, _)| find(&source, sequence).is_none()), "{text}");
    }
}

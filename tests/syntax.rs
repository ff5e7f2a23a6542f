//! The fixtures of the parser: each input with its expected tree.

#![expect(clippy::unwrap_used, reason = "a fixture that cannot be read fails the test")]

mod support;

use joulepath::rapid::diagnostics::{Diagnostic, Label, Paint, full};
use joulepath::rapid::syntax::{self, Node, NodeKind, Parse};
use joulepath::rapid::text::{FileId, SourceFile, Span};
use support::{check_tree, fixture_folder, fixtures};

const ID: FileId = FileId(0);

/// A fixture and the tree that was read.
struct Fixture {
    name: String,
    source: SourceFile,
    parse: Parse,
}

fn read(folder: &str) -> Vec<Fixture> {
    let read = |(file, bytes): (String, Vec<u8>)| {
        let parse = syntax::parse(&bytes);
        let name = file.split('.').next().unwrap().to_owned();
        Fixture { name, source: SourceFile::new(ID, file, bytes), parse }
    };
    fixtures(folder).into_iter().map(read).collect()
}

fn snapshot(folder_name: &str, fixture: &Fixture, text: &str) {
    insta::with_settings!({
        snapshot_path => fixture_folder(folder_name),
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        insta::assert_snapshot!(fixture.name.as_str(), text);
    });
}

fn rendered(fixture: &Fixture) -> String {
    let error = |error: &syntax::SyntaxError| {
        let span = |start, end| Span { file: ID, start, end };
        let mut shown = Diagnostic::error(span(error.start, error.end), error.message.clone());
        shown.labels.extend(error.related.iter().map(|related| Label {
            span: span(related.start, related.end),
            message: related.message.clone(),
        }));
        full(&shown, &fixture.source, Paint::Plain) + "\n"
    };
    fixture.parse.errors.iter().map(error).collect()
}

#[test]
fn valid_fixtures_are_read_without_errors() {
    for fixture in read("ok") {
        assert_eq!(rendered(&fixture), "", "{} has errors", fixture.name);
        let tree = syntax::dump(&fixture.parse.tree, &fixture.source.bytes);
        let tolerances = fixture.parse.tolerances.iter().map(|used| {
            let position = fixture.source.position(used.start);
            format!(
                "tolerated {}:{} {}\n",
                position.line,
                position.column,
                used.tolerance.production()
            )
        });
        snapshot("ok", &fixture, &format!("{tree}{}", tolerances.collect::<String>()));
    }
}

#[test]
fn each_mistake_causes_one_error() {
    let mut cascades = Vec::new();
    for fixture in read("err") {
        let errors = rendered(&fixture);
        if fixture.parse.errors.len() != 1 {
            cascades.push(format!("{}:\n{errors}", fixture.name));
            continue;
        }
        snapshot("err", &fixture, &errors);
    }
    assert!(cascades.is_empty(), "not one error each:\n{}", cascades.join("\n"));
}

/// In the fixtures, the statements unrelated to the mistake call procedures with names that start
/// with `Keep`.
#[test]
fn recovery_keeps_the_statements_around_a_mistake() {
    let mut lost = Vec::new();
    for fixture in read("err") {
        let bytes = &fixture.source.bytes;
        let text = String::from_utf8_lossy(bytes);
        let wanted = text.lines().filter(|line| line.trim_start().starts_with("Keep")).count();
        let whole = |node: &Node<'_>| {
            node.callee().is_some_and(|name| name.text(bytes).starts_with(b"Keep"))
                && node.subtree().all(|inner| inner.kind() != NodeKind::Error)
        };
        let kept = fixture.parse.tree.nodes().filter(whole).count();
        if kept != wanted {
            let tree = syntax::dump(&fixture.parse.tree, bytes);
            lost.push(format!("{}: kept {kept} of {wanted}\n{tree}", fixture.name));
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

#[test]
fn every_fixture_is_lossless() {
    for fixture in read("ok").iter().chain(&read("err")) {
        check_tree(&fixture.parse, &fixture.source.bytes);
    }
}

//! The names in the documentation exist.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod rust_source;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use rust_source::tokens::tokens;

/// Least number of glossary terms.
const MIN_TERMS: usize = 40;

/// Pages for users and contributors.
const PAGES: [&str; 23] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/architecture.md",
    "docs/blind.md",
    "docs/cell.md",
    "docs/changes.md",
    "docs/check.md",
    "docs/controller.md",
    "docs/editors.md",
    "docs/effects.md",
    "docs/energy.md",
    "docs/format.md",
    "docs/gap.md",
    "docs/glossary.md",
    "docs/identification.md",
    "docs/lints.md",
    "docs/placement.md",
    "docs/reach.md",
    "docs/reasons.md",
    "docs/robots.md",
    "docs/trajectories.md",
    "editors/vscode/README.md",
    "fixtures/README.md",
];

fn page(path: &str) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Text between backticks or in the brackets of a link, outside code blocks.
fn named(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    let mut named = Vec::new();
    for part in prose {
        named.extend(part.split('`').skip(1).step_by(2));
        // A link may have an anchor.
        named.extend(part.split("](").skip(1).filter_map(|link| link.split([')', '#']).next()));
    }
    named
}

/// Whether text between backticks is a file or folder of the crate.
fn is_path(text: &str) -> bool {
    const FOLDERS: [&str; 10] = [
        "src",
        "tests",
        "docs",
        "fixtures",
        "templates",
        "grammar",
        "benches",
        "examples",
        "editors",
        ".ci",
    ];
    let first = text.split('/').next().unwrap_or_default();
    FOLDERS.contains(&first) && text.contains('/') && !text.contains(['…', '*', ' ', '<'])
}

fn is_page(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "md")
}

#[test]
fn files_named_in_the_documentation_exist() {
    let mut missing = Vec::new();
    for path in PAGES {
        let text = page(path);
        let folder = Path::new(path).parent().unwrap();
        for name in named(&text) {
            let is_link = !name.contains("://") && is_page(name) && !is_path(name);
            let target = if is_link { folder.join(name) } else { Path::new(name).to_path_buf() };
            if (is_link || is_path(name)) && !name.contains("NAME") && !target.exists() {
                missing.push(format!("{path}: {name}"));
            }
        }
    }
    assert!(missing.is_empty(), "named but not there:\n{}", missing.join("\n"));
}

#[test]
fn the_code_map_lists_every_source_folder() {
    let text = page("docs/architecture.md");
    let map = &text[text.find("## Code map").unwrap()..];
    for entry in fs::read_dir("src").unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_dir() {
            let name = format!("`src/{}`", entry.file_name().to_str().unwrap());
            assert!(map.contains(&name), "docs/architecture.md says nothing of {name}");
        }
    }
}

/// The third column of the glossary names existing items.
#[test]
fn code_names_in_the_glossary_exist() {
    let sources = rust_source::files(&["src"]);
    let names: BTreeSet<&str> =
        sources.iter().flat_map(|file| tokens(&file.text)).map(|token| token.text).collect();
    let text = page("docs/glossary.md");
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| ")).collect();
    let terms: Vec<&str> = rows.into_iter().filter(|row| !row.starts_with("| term")).collect();
    assert!(terms.len() >= MIN_TERMS, "{} terms", terms.len());
    for row in terms {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [_, meaning, code, source] = cells[..] else { panic!("not four cells: {row}") };
        assert!(!meaning.is_empty() && !source.is_empty(), "an empty cell: {row}");
        for name in code.split('`').skip(1).step_by(2) {
            assert!(names.contains(name), "no source has the name {name}: {row}");
        }
    }
}

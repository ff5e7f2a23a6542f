//! The doc comment of each rule is its manual, and the page consists of the manuals.

use std::fs;
use std::path::Path;

use joulepath::tool::lint::ALL;

use crate::page::page;

/// The headings of each manual, in order.
const HEADINGS: [&str; 7] = [
    "What it does",
    "Why it wastes energy",
    "How the saving is computed",
    "Example",
    "Use instead",
    "Safety",
    "Assumptions",
];

#[test]
fn manuals_have_all_headings_in_order() {
    for rule in ALL {
        let manual = rule.manual();
        let found: Vec<&str> = manual.lines().filter_map(|line| line.strip_prefix("## ")).collect();
        assert_eq!(found, HEADINGS, "{}", rule.code);
        for part in manual.split("\n## ").skip(1) {
            let body = part.split_once('\n').map_or("", |(_, body)| body);
            assert!(!body.trim().is_empty(), "{}: '{}' is empty", rule.code, part.trim());
        }
        assert!(rule.summary().ends_with('.'), "{}: {}", rule.code, rule.summary());
    }
}

#[test]
fn rules_are_sorted_and_have_a_file_each() {
    for pair in ALL.windows(2) {
        assert!(pair[0].code < pair[1].code, "{} before {}", pair[0].code, pair[1].code);
        assert!(pair[0].family <= pair[1].family, "{} before {}", pair[0].code, pair[1].code);
    }
    for rule in ALL {
        let file = format!("src/tool/lint/rules/{}.rs", rule.name.replace('-', "_"));
        assert!(Path::new(&file).is_file(), "{} is not in {file}", rule.code);
    }
    let files = fs::read_dir("src/tool/lint/rules").unwrap().count();
    assert_eq!(files, ALL.len() + 1, "each rule is one file, and registered");
}

#[test]
fn the_lint_page_agrees_with_the_manuals() {
    let fresh = page();
    let written = fs::read_to_string("docs/lints.md").unwrap_or_default();
    if fresh != written {
        let to = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lints.md");
        fs::write(&to, fresh).unwrap();
        panic!("docs/lints.md is not what the rules say; copy {} there", to.display());
    }
}

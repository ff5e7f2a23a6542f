//! `docs/reasons.md` explains exactly the existing reasons.

use std::collections::BTreeSet;

const SOURCE: &str = include_str!("../src/retime/optimize/reason.rs");
const PAGE: &str = include_str!("../docs/reasons.md");

/// The parts of each section, in order.
const PARTS: [&str; 3] = ["**Means.**", "**Example.**", "**What to do.**"];

/// The strings that the function `code` returns.
fn codes() -> Vec<&'static str> {
    let from = SOURCE.find("fn code(").expect("the function that names the codes");
    let body = &SOURCE[from..];
    let body = &body[..body.find("\n    }\n").expect("its end")];
    body.lines().filter_map(|line| line.split('"').nth(1)).collect()
}

fn sections() -> Vec<(&'static str, &'static str)> {
    let sections = PAGE.split("\n## ").skip(1);
    sections.map(|section| section.split_once('\n').unwrap_or((section, ""))).collect()
}

#[test]
fn page_and_codes_agree() {
    let codes = codes();
    let explained: Vec<&str> = sections().iter().map(|(code, _)| *code).collect();
    assert!(codes.len() > 10, "the codes were not found: {codes:?}");
    let unique: BTreeSet<&str> = codes.iter().copied().collect();
    assert_eq!(unique.len(), codes.len(), "a code twice");
    assert_eq!(
        unique,
        explained.iter().copied().collect(),
        "docs/reasons.md has a section for each code of src/retime/optimize/reason.rs and for no other"
    );
    assert_eq!(explained.len(), codes.len(), "a section twice");
}

#[test]
fn sections_have_all_parts() {
    for (code, text) in sections() {
        let mut from = 0;
        for part in PARTS {
            let at = text[from..].find(part);
            assert!(at.is_some(), "{code} lacks {part} or has it in another place");
            from += at.unwrap_or_default() + part.len();
        }
    }
}

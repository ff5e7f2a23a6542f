//! The walkthroughs of `CONTRIBUTING.md` agree with the sources: each has a diff in
//! `docs/contributing` that added its example. Every resulting hunk is in the sources, and the
//! walkthrough names every file.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;

/// Heading of each walkthrough, and its diff.
const WALKTHROUGHS: [(&str, &str); 5] = [
    ("## Add an effect", "docs/contributing/effect.diff"),
    ("## Add a lint", "docs/contributing/lint.diff"),
    ("## Add a robot", "docs/contributing/robot.diff"),
    ("## Add an instruction", "docs/contributing/instruction.diff"),
    ("## Add a section to the report", "docs/contributing/report_section.diff"),
];

/// The result of a diff at one place of a file.
struct Hunk {
    path: String,
    /// Lines of the file after the change.
    after: Vec<String>,
    /// Number of added lines.
    added: usize,
}

fn hunks(diff: &str) -> Vec<Hunk> {
    let mut found: Vec<Hunk> = Vec::new();
    let mut path = String::new();
    for line in diff.lines() {
        if let Some(name) = line.strip_prefix("+++ b/") {
            name.clone_into(&mut path);
        } else if line.starts_with("@@") {
            found.push(Hunk { path: path.clone(), after: Vec::new(), added: 0 });
        } else if let Some(hunk) = found.last_mut()
            && let Some((sign @ (" " | "+"), text)) = line.split_at_checked(1)
            && !line.starts_with("+++")
        {
            hunk.after.push(text.to_owned());
            hunk.added += usize::from(sign == "+");
        }
    }
    found
}

/// Whether a file contains these lines in succession.
fn has(text: &str, lines: &[String]) -> bool {
    let all: Vec<&str> = text.lines().collect();
    all.windows(lines.len()).any(|window| window == lines)
}

/// The part of a page under a heading.
fn section<'a>(page: &'a str, heading: &str) -> &'a str {
    let begin = page.find(&format!("{heading}\n")).unwrap_or_else(|| panic!("no '{heading}'"));
    let rest = &page[begin + heading.len()..];
    &rest[..rest.find("\n## ").unwrap_or(rest.len())]
}

#[test]
fn walkthrough_diffs_agree_with_the_sources() {
    let page = fs::read_to_string("CONTRIBUTING.md").unwrap();
    for (heading, path) in WALKTHROUGHS {
        let text = section(&page, heading);
        assert!(text.contains(path), "'{heading}' does not name {path}");
        let found = hunks(&fs::read_to_string(path).unwrap());
        assert!(found.iter().map(|hunk| hunk.added).sum::<usize>() > 1, "{path} adds nothing");
        for hunk in &found {
            let file = fs::read_to_string(&hunk.path).unwrap();
            assert!(
                has(&file, &hunk.after),
                "{path}: {} has no longer:\n{}",
                hunk.path,
                hunk.after.join("\n")
            );
            assert!(text.contains(&hunk.path), "'{heading}' does not name {}", hunk.path);
        }
    }
}

#[test]
fn hunks_contain_the_lines_after_the_change() {
    let diff = "--- a/x\n+++ b/x\n@@ -1,2 +1,2 @@\n first\n-old\n+new\n";
    let [hunk] = &hunks(diff)[..] else { panic!("one hunk") };
    assert_eq!((hunk.path.as_str(), hunk.added), ("x", 1));
    assert!(has("first\nnew\nlast", &hunk.after));
    assert!(!has("first\nold\nlast", &hunk.after));
    assert!(!has("first\n\nnew", &hunk.after));
}

//! The worked example of `docs/gap.md` is what the program says.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;
use std::path::Path;
use std::process::Command;

const PAGE: &str = "docs/gap.md";
/// What stands before and behind the answer on the page.
const BEGINS: &str = "<!-- answer -->\n```text\n";
const ENDS: &str = "```\n<!-- end -->";
/// Numbers may differ by this share between machines: sums are in another order.
const SHARE: f64 = 0.02;
/// A digit behind the decimal point of a small number.
const DIGIT: f64 = 2e-3;

#[test]
fn the_example_is_what_the_program_says() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gap_page");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    said(&folder, &["blind", "generate", "--out", "cases", "--seed", "7", "--count", "4"]);
    let case = folder.join("cases/case-0004");
    let answer = said(
        &case,
        &[
            "diagnose",
            "--robot",
            "nominal.toml",
            "--log",
            "log-1.csv",
            "log-2.csv",
            "--heldout",
            "heldout.csv",
            "--baseline",
            "baseline-1.csv",
            "--quiet",
        ],
    );
    let page = fs::read_to_string(PAGE).unwrap();
    let (before, rest) = page.split_once(BEGINS).unwrap();
    let (written, after) = rest.split_once(ENDS).unwrap();
    if !are_alike(written, &answer) {
        let fresh = folder.join("gap.md");
        fs::write(&fresh, format!("{before}{BEGINS}{answer}{ENDS}{after}")).unwrap();
        panic!(
            "the example in {PAGE} is not what the program says; copy {} there",
            fresh.display()
        );
    }
}

/// What the program prints in a folder.
fn said(folder: &Path, args: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_joulepath"))
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.code() != Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Whether two texts have the same words, and numbers that differ no more than between machines.
fn are_alike(a: &str, b: &str) -> bool {
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let is_alike = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= SHARE * a.abs().max(b.abs()) + DIGIT,
        _ => a == b,
    };
    let [a, b] = [a, b].map(words);
    a.len() == b.len() && a.iter().zip(&b).all(is_alike)
}

#[test]
fn another_answer_is_not_alike() {
    assert!(are_alike("joint 4  0.1630 Nm", "joint 4 0.1631 Nm"));
    assert!(!are_alike("joint 4 0.1630 Nm", "joint 4 0.1700 Nm"));
    assert!(!are_alike("joint 4 0.1630 Nm", "joint 5 0.1630 Nm"));
    assert!(!are_alike("found: ripple", "found: backlash"));
}

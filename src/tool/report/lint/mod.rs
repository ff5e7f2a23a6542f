//! Findings of the linter, one output format per file.

pub mod github;
pub mod gitlab;
pub mod json;
pub mod junit;
pub mod sarif;
pub mod text;
pub mod top;

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use crate::rapid::text::SourceFile;
use crate::tool::lint::Finding;

/// Identifiers of findings that stay when lines move: rule, file, statement, and a counter among
/// equal ones.
#[must_use]
pub fn fingerprints(findings: &[Finding], files: &[SourceFile]) -> Vec<String> {
    let mut seen = std::collections::BTreeMap::new();
    findings
        .iter()
        .map(|finding| {
            let file = &files[finding.span.file.0 as usize];
            let text = file.text(finding.span);
            let words: Vec<&str> = text.split_whitespace().collect();
            let name = file.path.rsplit('/').next().unwrap_or_default();
            let own = format!("{}\0{name}\0{}", finding.rule.code, words.join(" "));
            let number = seen.entry(own.clone()).and_modify(|n| *n += 1).or_insert(0_u32);
            let digest = Sha256::digest(format!("{own}\0{number}"));
            digest.iter().take(16).fold(String::new(), |mut out, byte| {
                let _ = write!(out, "{byte:02x}");
                out
            })
        })
        .collect()
}

//! Findings as a test report in the form of `JUnit`: a suite for each file.

use std::fmt::Write as _;

use crate::lint::{Finding, Report};
use crate::text::SourceFile;

/// The report; a file without findings is a test that passed.
#[must_use]
pub fn junit(report: &Report, files: &[SourceFile]) -> String {
    let mut suites = String::new();
    let (mut tests, mut failures) = (0, 0);
    for file in files {
        let own: Vec<&Finding> =
            report.findings.iter().filter(|finding| finding.span.file == file.id).collect();
        let count = own.len().max(1);
        let path = escaped(&file.path);
        let _ = writeln!(
            suites,
            "  <testsuite name=\"{path}\" tests=\"{count}\" failures=\"{}\" errors=\"0\">",
            own.len()
        );
        if own.is_empty() {
            let _ = writeln!(suites, "    <testcase name=\"{path}\" classname=\"joulepath\"/>");
        }
        for finding in &own {
            let at = file.position(finding.span.start);
            let _ = writeln!(
                suites,
                "    <testcase name=\"{code} {name} at line {line}\" classname=\"{path}\">\n      \
                 <failure message=\"{message}\" type=\"{code}\">line {line}, column {column}: \
                 {message}</failure>\n    </testcase>",
                code = finding.rule.code,
                name = finding.rule.name,
                line = at.line,
                column = at.column,
                message = escaped(&finding.told()),
            );
        }
        suites.push_str("  </testsuite>\n");
        tests += count;
        failures += own.len();
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"joulepath lint\" \
         tests=\"{tests}\" failures=\"{failures}\" errors=\"0\">\n{suites}</testsuites>\n"
    )
}

/// Text without what XML has a meaning for; characters that XML can't hold become U+FFFD.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

//! Findings as a `JUnit` test report: one suite per file.

use std::fmt::Write as _;

use crate::rapid::text::SourceFile;
use crate::tool::lint::{Finding, Report};
use crate::tool::report::svg::escape;

/// The report; a file without findings is a passed test.
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
                message = escaped(&finding.full_message()),
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

/// Escapes an attribute text in one line; characters that XML forbids become U+FFFD.
fn escaped(text: &str) -> String {
    let held = |c: char| match c {
        '\t' | '\n' | '\r' => ' ',
        c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => '\u{fffd}',
        c => c,
    };
    escape(&text.chars().map(held).collect::<String>())
}

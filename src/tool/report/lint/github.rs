//! Findings as commands of a GitHub workflow, shown next to the changed lines.

use crate::rapid::diagnostics::Severity;
use crate::rapid::text::SourceFile;
use crate::tool::lint::Report;

/// One command for each finding.
#[must_use]
pub fn github(report: &Report, files: &[SourceFile]) -> String {
    let shown = report.findings.iter().map(|finding| {
        let file = &files[finding.span.file.0 as usize];
        let (start, end) = (file.position(finding.span.start), file.position(finding.span.end));
        let level = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Info => "notice",
        };
        let rule = finding.rule;
        // Columns are only allowed within one line.
        let columns = if start.line == end.line {
            format!(",col={},endColumn={}", start.column, end.column)
        } else {
            String::new()
        };
        format!(
            "::{level} title={},file={},line={},endLine={}{columns}::{}\n",
            property(&format!("{} {}", rule.code, rule.name)),
            property(&file.path),
            start.line,
            end.line,
            data(&finding.full_message())
        )
    });
    shown.collect()
}

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    #[test]
    fn signs_of_the_format_are_escaped() {
        assert_eq!(super::property("a:b,c%"), "a%3Ab%2Cc%25");
        assert_eq!(super::data("a:b\n"), "a:b%0A");
    }
}

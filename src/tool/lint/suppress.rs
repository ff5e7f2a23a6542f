//! Comments that suppress findings: `! joulepath: ignore EW101 reason`.

use super::rule::Rule;
use crate::rapid::syntax::{Parse, TokenKind};
use crate::rapid::text::{SourceFile, Span};

/// The first words of such a comment after `!`.
const WORDS: [&str; 2] = ["joulepath:", "ignore"];

/// A comment that suppresses findings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suppression {
    /// The comment.
    pub span: Span,
    /// The codes that it names, as written.
    pub codes: Vec<String>,
    /// A line of the statement that it concerns, from 1.
    pub line: u32,
}

impl Suppression {
    /// The indices of its codes that match a rule.
    pub fn naming(&self, rule: &Rule) -> impl Iterator<Item = usize> {
        (0..self.codes.len()).filter(|index| rule.is_meant(&self.codes[*index]))
    }
}

/// The suppression comments of a file. At the end of a line, a comment concerns that line; on its
/// own line, the next line with a statement.
pub fn suppressions(file: &SourceFile, parse: &Parse) -> Vec<Suppression> {
    let tokens = parse.tree.tokens();
    let mut found = Vec::new();
    for index in 0..tokens.count() {
        if tokens.kind(index) != TokenKind::Comment {
            continue;
        }
        let range = tokens.range(index);
        let span = Span { file: file.id, start: range.start, end: range.end };
        let text = file.text(span);
        let Some(codes) = codes(&text) else { continue };
        let own = file.position(span.start).line;
        let solid = |index: &usize| !tokens.kind(*index).is_trivia();
        let line_of = |index: usize| file.position(tokens.range(index).start).line;
        let shares = (0..index).rev().find(solid).is_some_and(|before| {
            let end = tokens.range(before).end;
            file.position(end.saturating_sub(1)).line == own
        });
        let next = (index + 1..tokens.count()).find(solid).map(line_of);
        let line = if shares { own } else { next.unwrap_or(own) };
        found.push(Suppression { span, codes, line });
    }
    found
}

/// The codes of a suppression comment; `None` for other comments.
fn codes(comment: &str) -> Option<Vec<String>> {
    let mut rest = comment.trim_start().strip_prefix('!')?.trim_start();
    for word in WORDS {
        let head = rest.get(..word.len())?;
        if !head.eq_ignore_ascii_case(word) {
            return None;
        }
        rest = rest[word.len()..].trim_start();
    }
    // Codes are separated by commas, with or without spaces; the rest is the reason.
    let mut codes = Vec::new();
    loop {
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '-').unwrap_or(rest.len());
        if end == 0 {
            break;
        }
        codes.push(rest[..end].to_owned());
        match rest[end..].trim_start().strip_prefix(',') {
            Some(after) => rest = after.trim_start(),
            None => break,
        }
    }
    Some(codes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::syntax;
    use crate::rapid::text::FileId;

    #[test]
    fn comments_name_codes_and_lines() {
        let text = "MODULE m\nPROC p()\n! joulepath: ignore EW101, EW102 the gripper needs it\n\
                    x;\ny; !joulepath: IGNORE EW103\n! joulepath: free\n! ignore EW101\n\
                    ENDPROC\nENDMODULE";
        let file = SourceFile::new(FileId(0), "m.mod".into(), text.as_bytes().to_vec());
        let found = suppressions(&file, &syntax::parse(text.as_bytes()));
        let shown: Vec<(Vec<&str>, u32)> = found
            .iter()
            .map(|it| (it.codes.iter().map(String::as_str).collect(), it.line))
            .collect();
        assert_eq!(shown, [(vec!["EW101", "EW102"], 4), (vec!["EW103"], 5)]);
    }
}

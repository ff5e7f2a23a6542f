//! Names and punctuation without comments, strings and characters.

/// A name, `::` or another sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token<'a> {
    /// From 1.
    pub(crate) line: usize,
    /// The text.
    pub(crate) text: &'a str,
}

/// The tokens of a source.
pub(crate) fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut line = 1;
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let (length, is_token) = if let Some(length) = blank(rest, first) {
            (length, false)
        } else if first.is_alphanumeric() || first == '_' {
            (rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len()), true)
        } else if rest.starts_with("::") {
            (2, true)
        } else {
            (first.len_utf8(), true)
        };
        let (text, after) = rest.split_at(length);
        if is_token {
            tokens.push(Token { line, text });
        }
        line += text.matches('\n').count();
        rest = after;
    }
    tokens
}

/// Length of white space, a comment, a string or a character at the start of `rest`.
fn blank(rest: &str, first: char) -> Option<usize> {
    if first.is_whitespace() {
        return Some(first.len_utf8());
    }
    if rest.starts_with("//") {
        return Some(rest.find('\n').unwrap_or(rest.len()));
    }
    if rest.starts_with("/*") {
        return Some(block_comment(rest));
    }
    let unprefixed = rest.trim_start_matches(['b', 'c']);
    let raw = unprefixed.strip_prefix('r').unwrap_or("");
    let hashes = raw.len() - raw.trim_start_matches('#').len();
    if raw[hashes..].starts_with('"') {
        let begin = rest.len() - raw.len() + hashes + 1;
        let end = format!("\"{}", "#".repeat(hashes));
        return Some(rest[begin..].find(&end).map_or(rest.len(), |i| begin + i + end.len()));
    }
    if unprefixed.starts_with('"') {
        let begin = rest.len() - unprefixed.len() + 1;
        return Some(begin + quoted(&rest[begin..], '"'));
    }
    if first == '\'' || rest.starts_with("b'") {
        let begin = rest.find('\'').map_or(1, |i| i + 1);
        let mut inner = rest[begin..].chars();
        let is_character = inner.next() == Some('\\') || inner.next() == Some('\'');
        return is_character.then(|| begin + quoted(&rest[begin..], '\''));
    }
    None
}

/// Length including the closing quote.
fn quoted(inner: &str, quote: char) -> usize {
    let mut escaped = false;
    for (i, c) in inner.char_indices() {
        if c == quote && !escaped {
            return i + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    inner.len()
}

/// Length of a comment with nested comments.
fn block_comment(rest: &str) -> usize {
    let mut depth = 0;
    let mut i = 0;
    while i < rest.len() {
        let here = &rest.as_bytes()[i..];
        if here.starts_with(b"/*") {
            depth += 1;
            i += 2;
        } else if here.starts_with(b"*/") {
            depth -= 1;
            i += 2;
            if depth == 0 {
                break;
            }
        } else {
            i += 1;
        }
    }
    i
}

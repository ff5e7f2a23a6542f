//! What stands between two tokens of one line.

use crate::rapid::syntax::TokenKind;

/// A token with its text.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) kind: TokenKind,
    pub(super) text: &'a [u8],
}

/// Names of placeholders, which `<` and `>` around a name would become.
const PLACEHOLDERS: [&[u8]; 13] = [
    b"DDN", b"RDN", b"TDN", b"PAR", b"ALT", b"DIM", b"SMT", b"VAR", b"EIT", b"CSE", b"EXP", b"ARG",
    b"ID",
];

/// Whether a blank stands between two tokens of a statement. `there`: whether the user has put one.
pub(super) fn blank(before: Word<'_>, after: Word<'_>, there: bool) -> bool {
    use TokenKind::{
        Assign, Backslash, Bar, Colon, Comma, Dot, HeaderMark, LeftBrace, LeftBracket, LeftParen,
        Less, Number, Percent, Question, RightBrace, RightBracket, RightParen, Semicolon,
    };
    let (a, b) = (before.kind, after.kind);
    // Two tokens that would become one, or others.
    if is_word(a) && is_word(b) {
        return true;
    }
    if a == Less && PLACEHOLDERS.contains(&after.text) {
        return true;
    }
    match (a, b) {
        (Number, Dot) | (Dot, Number) | (Percent | HeaderMark, _) | (_, Percent | HeaderMark) => {
            return there;
        }
        (Less, TokenKind::Greater | TokenKind::Equal)
        | (TokenKind::Greater | Colon, TokenKind::Equal)
        | (TokenKind::Unknown, _)
        | (_, TokenKind::Unknown) => return there,
        _ => {}
    }
    if matches!(a, LeftParen | LeftBracket | LeftBrace | Dot | Backslash | Bar | Question | Colon) {
        return false;
    }
    if matches!(
        b,
        Semicolon
            | Comma
            | RightParen
            | RightBracket
            | RightBrace
            | Dot
            | Backslash
            | Bar
            | Question
            | Colon
            | Assign
            | LeftBrace
    ) {
        return false;
    }
    if is_reserved(a) || is_reserved(b) {
        return !matches!(a, Comma | Assign) && !is_operator(a);
    }
    if is_closing(a) && (is_word(b) || b == TokenKind::String) {
        return true;
    }
    false
}

/// Whether a token is made of letters, digits or quotation marks.
fn is_word(kind: TokenKind) -> bool {
    kind.is_keyword()
        || matches!(
            kind,
            TokenKind::Identifier
                | TokenKind::Number
                | TokenKind::String
                | TokenKind::UnclosedString
                | TokenKind::Placeholder
        )
}

/// A keyword other than a value.
fn is_reserved(kind: TokenKind) -> bool {
    kind.is_keyword() && !matches!(kind, TokenKind::True | TokenKind::False)
}

fn is_closing(kind: TokenKind) -> bool {
    matches!(kind, TokenKind::RightParen | TokenKind::RightBracket | TokenKind::RightBrace)
}

fn is_operator(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Plus
            | TokenKind::Minus
            | TokenKind::Star
            | TokenKind::Slash
            | TokenKind::Equal
            | TokenKind::NotEqual
            | TokenKind::Less
            | TokenKind::LessEqual
            | TokenKind::Greater
            | TokenKind::GreaterEqual
    )
}

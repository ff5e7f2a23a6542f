//! Bytes → tokens. Every byte lands in exactly one token.
//!
//! The lexer works on bytes, whatever their encoding: RAPID's own characters
//! are ASCII, and bytes from 0x80 are letters, except for the wide spaces that
//! editors leave in gaps. Only the width of a letter depends on the encoding.

use nom::branch::alt;
use nom::bytes::complete::{tag, take_till, take_while, take_while1};
use nom::character::complete::{digit0, digit1, one_of};
use nom::combinator::{opt, recognize};
use nom::{IResult, Parser};

use super::token::{TokenKind, Tokens};

/// Bytes per token in ordinary programs, for the first allocation.
const BYTES_PER_TOKEN: usize = 3;

/// What the bytes from 0x80 are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum High {
    /// Valid UTF-8.
    Utf8,
    /// Some one- or two-byte encoding.
    Legacy,
}

type Lexed<'a> = IResult<&'a [u8], &'a [u8], ()>;

/// Splits bytes into tokens; tokens beyond 4 GiB are left to the caller.
#[must_use]
pub fn tokenize(bytes: &[u8]) -> Tokens {
    let bytes = &bytes[..bytes.len().min(u32::MAX as usize)];
    let mut tokens = Tokens::with_capacity(bytes.len() / BYTES_PER_TOKEN);
    if crate::text::is_encoded_module(bytes) {
        tokens.push(TokenKind::Encoded, bytes.len() as u32);
        return tokens;
    }
    let high = if std::str::from_utf8(bytes).is_ok() { High::Utf8 } else { High::Legacy };
    let mut at = 0;
    while at < bytes.len() {
        let (kind, length) = token(&bytes[at..], high);
        debug_assert!(length > 0, "a token has at least one byte");
        at += length.max(1);
        tokens.push(kind, at as u32);
    }
    tokens
}

/// Kind and length of the first token of non-empty input.
fn token(input: &[u8], high: High) -> (TokenKind, usize) {
    let next = input.get(1).copied().unwrap_or(0);
    let one = |kind| (kind, 1);
    match input[0] {
        0..=b' ' | 0x7F => (TokenKind::Whitespace, gap(input, high)),
        0x80.. => match wide_space(input, high) {
            Some(_) => (TokenKind::Whitespace, gap(input, high)),
            None => (TokenKind::Identifier, word(input, high)),
        },
        b'a'..=b'z' | b'A'..=b'Z' => {
            let length = word(input, high);
            (TokenKind::keyword(&input[..length]).unwrap_or(TokenKind::Identifier), length)
        }
        b'_' => (TokenKind::Identifier, word(input, high)),
        b'0'..=b'9' => (TokenKind::Number, length(number, input)),
        b'.' if next.is_ascii_digit() => (TokenKind::Number, length(number, input)),
        b'!' => (TokenKind::Comment, length(comment, input)),
        b'"' => string(input),
        b'%' if input.starts_with(b"%%%") => (TokenKind::HeaderMark, 3),
        b'<' => match (next, length(placeholder, input)) {
            (b'>', _) => (TokenKind::NotEqual, 2),
            (b'=', _) => (TokenKind::LessEqual, 2),
            (_, 1) => one(TokenKind::Less),
            (_, length) => (TokenKind::Placeholder, length),
        },
        b'>' if next == b'=' => (TokenKind::GreaterEqual, 2),
        b':' if next == b'=' => (TokenKind::Assign, 2),
        b';' => one(TokenKind::Semicolon),
        b',' => one(TokenKind::Comma),
        b':' => one(TokenKind::Colon),
        b'.' => one(TokenKind::Dot),
        b'(' => one(TokenKind::LeftParen),
        b')' => one(TokenKind::RightParen),
        b'[' => one(TokenKind::LeftBracket),
        b']' => one(TokenKind::RightBracket),
        b'{' => one(TokenKind::LeftBrace),
        b'}' => one(TokenKind::RightBrace),
        b'\\' => one(TokenKind::Backslash),
        b'?' => one(TokenKind::Question),
        b'|' => one(TokenKind::Bar),
        b'%' => one(TokenKind::Percent),
        b'+' => one(TokenKind::Plus),
        b'-' => one(TokenKind::Minus),
        b'*' => one(TokenKind::Star),
        b'/' => one(TokenKind::Slash),
        b'=' => one(TokenKind::Equal),
        b'>' => one(TokenKind::Greater),
        b'#' | b'$' | b'&' | b'\'' | b'@' | b'^' | b'`' | b'~' => one(TokenKind::Unknown),
    }
}

/// Bytes that a recogniser takes from the front, at least one.
fn length<'a>(recogniser: impl Fn(&'a [u8]) -> Lexed<'a>, input: &'a [u8]) -> usize {
    recogniser(input).map_or(1, |(_, taken)| taken.len().max(1))
}

/// `0xFF`, `0b01`, `0o17`, `12`, `1.`, `.5`, `1.5E-3`.
fn number(input: &[u8]) -> Lexed<'_> {
    let based = alt((
        recognize((tag("0"), one_of("xX"), take_while1(|b: u8| b.is_ascii_hexdigit()))),
        recognize((tag("0"), one_of("bB"), take_while1(|b| matches!(b, b'0' | b'1')))),
        recognize((tag("0"), one_of("oO"), take_while1(|b| matches!(b, b'0'..=b'7')))),
    ));
    let mantissa =
        alt((recognize((digit1, opt((tag("."), digit0)))), recognize((tag("."), digit1))));
    let exponent = (one_of("eE"), opt(one_of("+-")), digit1);
    alt((based, recognize((mantissa, opt(exponent))))).parse(input)
}

/// `! …` up to the line end.
fn comment(input: &[u8]) -> Lexed<'_> {
    take_till(is_line_end).parse(input)
}

/// `<SMT>` and its like.
fn placeholder(input: &[u8]) -> Lexed<'_> {
    let name = alt((
        alt((tag("DDN"), tag("RDN"), tag("TDN"), tag("PAR"), tag("ALT"), tag("DIM"))),
        alt((tag("SMT"), tag("VAR"), tag("EIT"), tag("CSE"), tag("EXP"), tag("ARG"))),
        tag("ID"),
    ));
    recognize((tag("<"), name, tag(">"))).parse(input)
}

/// `"…"` with `""` for a quotation mark; a line end is not part of a string.
fn string(input: &[u8]) -> (TokenKind, usize) {
    let part = |input| -> Lexed<'_> { take_till(|b| b == b'"' || is_line_end(b)).parse(input) };
    let mut at = 1;
    loop {
        at += part(&input[at..]).map_or(0, |(_, taken)| taken.len());
        match (input.get(at), input.get(at + 1)) {
            (Some(b'"'), Some(b'"')) => at += 2,
            (Some(b'"'), _) => return (TokenKind::String, at + 1),
            _ => return (TokenKind::UnclosedString, at),
        }
    }
}

fn is_line_end(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// Bytes of white space at the front, wide spaces included.
fn gap(input: &[u8], high: High) -> usize {
    let narrow = |input| -> Lexed<'_> { take_while(|b| matches!(b, 0..=b' ' | 0x7F)).parse(input) };
    let mut at = 0;
    loop {
        at += narrow(&input[at..]).map_or(0, |(_, taken)| taken.len());
        match wide_space(&input[at..], high) {
            Some(length) => at += length,
            None => return at,
        }
    }
}

/// Bytes of an identifier at the front, at least one.
fn word(input: &[u8], high: High) -> usize {
    let narrow = |input| -> Lexed<'_> {
        take_while(|b: u8| b.is_ascii_alphanumeric() || b == b'_').parse(input)
    };
    let mut at = 0;
    loop {
        at += narrow(&input[at..]).map_or(0, |(_, taken)| taken.len());
        match input.get(at) {
            Some(0x80..) if wide_space(&input[at..], high).is_none() => {
                at += letter(&input[at..], high);
            }
            _ => return at.max(1),
        }
    }
}

/// Bytes of the letter at the front, which starts with a byte from 0x80.
fn letter(input: &[u8], high: High) -> usize {
    let width = match (high, input) {
        (High::Utf8, [0xC0..=0xDF, ..]) | (High::Legacy, [_, 0x80..=0xFF, ..]) => 2,
        (High::Utf8, [0xE0..=0xEF, ..]) => 3,
        (High::Utf8, [0xF0..=0xFF, ..]) => 4,
        _ => 1,
    };
    width.min(input.len())
}

/// Bytes of the space from 0x80 at the front, if one is there: byte order
/// mark, U+3000 (UTF-8, GBK), no-break space and the spaces of U+2000.
fn wide_space(input: &[u8], high: High) -> Option<usize> {
    match (high, input) {
        (_, [0xEF, 0xBB, 0xBF, ..] | [0xE3, 0x80, 0x80, ..])
        | (High::Utf8, [0xE2, 0x80, 0x80..=0x8B | 0xA8 | 0xA9 | 0xAF, ..]) => Some(3),
        (High::Utf8, [0xC2, 0x80..=0xA0, ..]) | (High::Legacy, [0xA1, 0xA1, ..]) => Some(2),
        (High::Legacy, [0xA0] | [0xA0, 0..=0x7F, ..]) => Some(1),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use TokenKind::{
        Assign, Backslash, Comment, Dot, EndIf, HeaderMark, Identifier, If, Less, LessEqual,
        Number, Percent, Placeholder, Semicolon, String, UnclosedString, Unknown, Whitespace,
    };

    fn kinds(bytes: &[u8]) -> Vec<TokenKind> {
        let tokens = tokenize(bytes);
        (0..tokens.len()).map(|i| tokens.kind(i)).collect()
    }

    fn texts(bytes: &[u8]) -> Vec<&[u8]> {
        let tokens = tokenize(bytes);
        (0..tokens.len())
            .map(|i| tokens.range(i))
            .map(|range| &bytes[range.start as usize..range.end as usize])
            .collect()
    }

    #[test]
    fn numbers_have_all_their_forms() {
        for number in ["1", "12.5", "1.", ".5", "1E5", "1.5e-3", "9E+09", "0x1F", "0b01", "0o17"] {
            assert_eq!(kinds(number.as_bytes()), [Number], "{number}");
        }
        assert_eq!(texts(b"1.e"), [&b"1."[..], b"e"]);
        assert_eq!(texts(b"0xg"), [&b"0"[..], b"xg"]);
        assert_eq!(kinds(b"a.b"), [Identifier, Dot, Identifier]);
    }

    #[test]
    fn strings_end_at_their_quotation_mark_or_line() {
        assert_eq!(texts(br#""a""b";"#), [&br#""a""b""#[..], b";"]);
        assert_eq!(texts(br#""C:\";"#), [&br#""C:\""#[..], b";"]);
        assert_eq!(kinds(b"\"abc\n;"), [UnclosedString, Whitespace, Semicolon]);
        assert_eq!(kinds(b"\"abc\"\""), [UnclosedString]);
        assert_eq!(kinds(b"\"\""), [String]);
    }

    #[test]
    fn comments_leave_the_line_end() {
        assert_eq!(texts(b"! a\r\nIF"), [&b"! a"[..], b"\r\n", b"IF"]);
        assert_eq!(kinds(b"!"), [Comment]);
    }

    #[test]
    fn words_hold_letters_of_any_encoding() {
        assert_eq!(kinds("año".as_bytes()), [Identifier]);
        assert_eq!(kinds(b"a\xF1o"), [Identifier]);
        assert_eq!(kinds("位置1".as_bytes()), [Identifier]);
        assert_eq!(kinds(b"IfX If endif"), [Identifier, Whitespace, If, Whitespace, EndIf]);
    }

    #[test]
    fn wide_spaces_are_gaps() {
        assert_eq!(kinds("a\u{3000}:=".as_bytes()), [Identifier, Whitespace, Assign]);
        assert_eq!(kinds(b"a\xA1\xA1:="), [Identifier, Whitespace, Assign]);
        assert_eq!(kinds(b"a\xA0:="), [Identifier, Whitespace, Assign]);
        assert_eq!(kinds("\u{feff}IF".as_bytes()), [Whitespace, If]);
        assert_eq!(kinds(b"a\0\0;"), [Identifier, Whitespace, Semicolon]);
        // A letter whose bytes hold the pair of a wide space.
        assert_eq!(kinds("a\u{3861}b".as_bytes()), [Identifier]);
    }

    #[test]
    fn marks_are_told_apart() {
        assert_eq!(kinds(b"%%%"), [HeaderMark]);
        assert_eq!(kinds(b"%a%"), [Percent, Identifier, Percent]);
        assert_eq!(kinds(b"<SMT>"), [Placeholder]);
        assert_eq!(kinds(b"<SMX"), [Less, Identifier]);
        assert_eq!(kinds(b"<=1"), [LessEqual, Number]);
        assert_eq!(kinds(b"\\T@"), [Backslash, Identifier, Unknown]);
    }
}

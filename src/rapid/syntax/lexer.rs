//! Splits bytes into tokens. Every byte belongs to exactly one token.
//!
//! The lexer works on bytes of any encoding: the characters of RAPID are ASCII; bytes from 0x80
//! are letters, except spaces and punctuation. Only the length of a letter depends on the encoding.

use memchr::{memchr2, memchr3};
use nom::branch::alt;
use nom::bytes::complete::{tag, take_while1};
use nom::character::complete::one_of;
use nom::combinator::recognize;
use nom::{IResult, Parser};

use super::token::{KEYWORDS, TokenKind, Tokens};

/// Bytes per token in typical programs, for the first allocation.
const BYTES_PER_TOKEN: usize = 3;

/// The encoding of the bytes from 0x80.
#[derive(Clone, Copy, PartialEq, Eq)]
enum High {
    /// Valid UTF-8.
    Utf8,
    /// An encoding with one or two bytes per character.
    Legacy,
}

type Lexed<'a> = IResult<&'a [u8], &'a [u8], ()>;

/// The kind of token that a byte begins.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    /// ASCII space or control character.
    Space,
    /// ASCII letter or `_`.
    Letter,
    Digit,
    /// A token of one byte, see `SINGLES`.
    Single,
    /// A byte from 0x80.
    High,
    /// The following bytes decide.
    Other,
}

/// The class of each byte.
const CLASSES: [Class; 256] = {
    let mut classes = [Class::High; 256];
    let mut byte = 0;
    while byte < 128 {
        classes[byte] = class(byte as u8);
        byte += 1;
    }
    classes
};

const fn class(byte: u8) -> Class {
    match byte {
        0..=b' ' | 0x7F => Class::Space,
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => Class::Letter,
        b'0'..=b'9' => Class::Digit,
        b'.' | b'!' | b'"' | b'%' | b'<' | b'>' | b':' => Class::Other,
        _ => Class::Single,
    }
}

/// The token kind of each byte of the class `Single`.
const SINGLES: [TokenKind; 256] = {
    let mut kinds = [TokenKind::Unknown; 256];
    let singles = [
        (b';', TokenKind::Semicolon),
        (b',', TokenKind::Comma),
        (b'(', TokenKind::LeftParen),
        (b')', TokenKind::RightParen),
        (b'[', TokenKind::LeftBracket),
        (b']', TokenKind::RightBracket),
        (b'{', TokenKind::LeftBrace),
        (b'}', TokenKind::RightBrace),
        (b'\\', TokenKind::Backslash),
        (b'?', TokenKind::Question),
        (b'|', TokenKind::Bar),
        (b'+', TokenKind::Plus),
        (b'-', TokenKind::Minus),
        (b'*', TokenKind::Star),
        (b'/', TokenKind::Slash),
        (b'=', TokenKind::Equal),
    ];
    let mut index = 0;
    while index < singles.len() {
        kinds[singles[index].0 as usize] = singles[index].1;
        index += 1;
    }
    kinds
};

/// Bytes that continue white space, a word or the digits of a number.
const SPACE: [bool; 256] = table(Class::Space, Class::Space);
const WORD: [bool; 256] = table(Class::Letter, Class::Digit);
const DIGIT: [bool; 256] = table(Class::Digit, Class::Digit);

const fn table(one: Class, other: Class) -> [bool; 256] {
    let mut table = [false; 256];
    let mut byte = 0;
    while byte < 128 {
        let class = CLASSES[byte] as u8;
        table[byte] = class == one as u8 || class == other as u8;
        byte += 1;
    }
    table
}

/// For each first byte, the lengths of the keywords that begin with it: one bit per length.
const KEYWORD_LENGTHS: [u16; 256] = {
    let mut lengths = [0; 256];
    let mut index = 0;
    while index < KEYWORDS.len() {
        let word = KEYWORDS[index].0.as_bytes();
        lengths[word[0] as usize] |= 1 << word.len();
        lengths[word[0].to_ascii_lowercase() as usize] |= 1 << word.len();
        index += 1;
    }
    lengths
};

/// Splits bytes into tokens; bytes beyond 4 GiB get no token.
#[must_use]
pub fn tokenize(bytes: &[u8]) -> Tokens {
    let bytes = &bytes[..bytes.len().min(u32::MAX as usize)];
    let mut tokens = Tokens::with_capacity(bytes.len() / BYTES_PER_TOKEN);
    if crate::rapid::text::is_encoded_module(bytes) {
        tokens.push(TokenKind::Encoded, bytes.len() as u32);
        return tokens;
    }
    let high = if std::str::from_utf8(bytes).is_ok() { High::Utf8 } else { High::Legacy };
    let mut at = 0;
    while let Some(&first) = bytes.get(at) {
        let (kind, end) = match CLASSES[first as usize] {
            Class::Single => (SINGLES[first as usize], at + 1),
            Class::Digit => (TokenKind::Number, number_end(bytes, at)),
            Class::Letter => {
                let end = word_end(bytes, at, high);
                (word_kind(&bytes[at..end]), end)
            }
            Class::Space => (TokenKind::Whitespace, gap_end(bytes, at, high)),
            Class::High => beyond_ascii(bytes, at, high),
            Class::Other => {
                let (kind, length) = other(&bytes[at..]);
                (kind, at + length)
            }
        };
        debug_assert!(end > at, "a token has at least one byte");
        at = end.max(at + 1);
        tokens.push(kind, at as u32);
    }
    tokens
}

/// First position from `at` on whose byte is not in the table.
#[inline]
fn skip(bytes: &[u8], mut at: usize, table: &[bool; 256]) -> usize {
    while let Some(&byte) = bytes.get(at) {
        if !table[byte as usize] {
            break;
        }
        at += 1;
    }
    at
}

/// Keyword or identifier. The test of the length excludes most identifiers quickly.
fn word_kind(word: &[u8]) -> TokenKind {
    let lengths = word.first().map_or(0, |first| KEYWORD_LENGTHS[*first as usize]);
    if word.len() < 16 && lengths & (1 << word.len()) != 0 {
        TokenKind::keyword(word).unwrap_or(TokenKind::Identifier)
    } else {
        TokenKind::Identifier
    }
}

/// Kind and length of a token whose first byte does not determine its kind.
fn other(input: &[u8]) -> (TokenKind, usize) {
    let next = input.get(1).copied().unwrap_or(0);
    match input[0] {
        b'.' if next.is_ascii_digit() => (TokenKind::Number, number_end(input, 0)),
        b'.' => (TokenKind::Dot, 1),
        b'!' => (TokenKind::Comment, line_end(input)),
        b'"' => string(input),
        b'%' if input.starts_with(b"%%%") => (TokenKind::HeaderMark, 3),
        b'%' => (TokenKind::Percent, 1),
        b'<' if next == b'>' => (TokenKind::NotEqual, 2),
        b'<' if next == b'=' => (TokenKind::LessEqual, 2),
        b'<' => match placeholder(input) {
            Ok((_, taken)) => (TokenKind::Placeholder, taken.len()),
            Err(_) => (TokenKind::Less, 1),
        },
        b'>' if next == b'=' => (TokenKind::GreaterEqual, 2),
        b'>' => (TokenKind::Greater, 1),
        b':' if next == b'=' => (TokenKind::Assign, 2),
        b':' => (TokenKind::Colon, 1),
        _ => (TokenKind::Unknown, 1),
    }
}

/// Kind and end of the token at `at`, which starts with a byte from 0x80.
fn beyond_ascii(bytes: &[u8], at: usize, high: High) -> (TokenKind, usize) {
    let input = &bytes[at..];
    if wide_space(input, high).is_some() {
        (TokenKind::Whitespace, gap_end(bytes, at, high))
    } else if is_punctuation(input, high) {
        (TokenKind::Unknown, at + letter(input, high))
    } else {
        (TokenKind::Identifier, word_end(bytes, at, high))
    }
}

/// End of the number at `at`: `12`, `1.`, `.5`, `1.5E-3`, or one with a base prefix.
fn number_end(bytes: &[u8], at: usize) -> usize {
    let mut end = skip(bytes, at, &DIGIT);
    if bytes.get(end) == Some(&b'.') {
        end = skip(bytes, end + 1, &DIGIT);
    }
    match bytes.get(end..).unwrap_or_default() {
        [b'E' | b'e', b'0'..=b'9', ..] => skip(bytes, end + 2, &DIGIT),
        [b'E' | b'e', b'+' | b'-', b'0'..=b'9', ..] => skip(bytes, end + 3, &DIGIT),
        [byte, ..] if byte.is_ascii_alphabetic() => {
            based_number(&bytes[at..]).map_or(end, |(_, taken)| at + taken.len())
        }
        _ => end,
    }
}

/// `0xFF`, `0b01`, `0o17`.
fn based_number(input: &[u8]) -> Lexed<'_> {
    alt((
        recognize((tag("0"), one_of("xX"), take_while1(|b: u8| b.is_ascii_hexdigit()))),
        recognize((tag("0"), one_of("bB"), take_while1(|b| matches!(b, b'0' | b'1')))),
        recognize((tag("0"), one_of("oO"), take_while1(|b| matches!(b, b'0'..=b'7')))),
    ))
    .parse(input)
}

/// A placeholder such as `<SMT>`.
fn placeholder(input: &[u8]) -> Lexed<'_> {
    let name = alt((
        alt((tag("DDN"), tag("RDN"), tag("TDN"), tag("PAR"), tag("ALT"), tag("DIM"))),
        alt((tag("SMT"), tag("VAR"), tag("EIT"), tag("CSE"), tag("EXP"), tag("ARG"))),
        tag("ID"),
    ));
    recognize((tag("<"), name, tag(">"))).parse(input)
}

/// Number of bytes before the first line end.
fn line_end(input: &[u8]) -> usize {
    memchr2(b'\n', b'\r', input).unwrap_or(input.len())
}

/// `"…"` with `""` for a quotation mark; a line end is not part of a string.
fn string(input: &[u8]) -> (TokenKind, usize) {
    let mut at = 1;
    loop {
        let rest = input.get(at..).unwrap_or_default();
        at += memchr3(b'"', b'\n', b'\r', rest).unwrap_or(rest.len());
        match (input.get(at), input.get(at + 1)) {
            (Some(b'"'), Some(b'"')) => at += 2,
            (Some(b'"'), _) => return (TokenKind::String, at + 1),
            _ => return (TokenKind::UnclosedString, at),
        }
    }
}

/// End of the white space at `at`, wide spaces included.
fn gap_end(bytes: &[u8], mut at: usize, high: High) -> usize {
    loop {
        at = skip(bytes, at, &SPACE);
        match bytes.get(at) {
            Some(0x80..) => match wide_space(&bytes[at..], high) {
                Some(length) => at += length,
                None => return at,
            },
            _ => return at,
        }
    }
}

/// End of the word at `at`.
fn word_end(bytes: &[u8], mut at: usize, high: High) -> usize {
    loop {
        at = skip(bytes, at, &WORD);
        match bytes.get(at..) {
            Some(rest @ [0x80..=0xFF, ..])
                if wide_space(rest, high).is_none() && !is_punctuation(rest, high) =>
            {
                at += letter(rest, high);
            }
            _ => return at,
        }
    }
}

/// Number of bytes of the first letter, which starts with a byte from 0x80.
fn letter(input: &[u8], high: High) -> usize {
    let width = match (high, input) {
        (High::Utf8, [0xC0..=0xDF, ..]) | (High::Legacy, [_, 0x80..=0xFF, ..]) => 2,
        (High::Utf8, [0xE0..=0xEF, ..]) => 3,
        (High::Utf8, [0xF0..=0xFF, ..]) => 4,
        _ => 1,
    };
    width.min(input.len())
}

/// Whether the bytes start with a character that resembles a character of RAPID: a dash or
/// typographic quotation mark (U+2010 to U+2027), which text processors insert, or full-width
/// punctuation (U+FF01 to U+FF20, U+3001, U+3002) from Chinese and Japanese keyboards. For GBK
/// only those whose bytes are not letters in other encodings.
fn is_punctuation(input: &[u8], high: High) -> bool {
    match high {
        High::Utf8 => matches!(
            input,
            [0xE2, 0x80, 0x90..=0xA7, ..]
                | [0xEF, 0xBC, 0x81..=0x8F | 0x9A..=0xA0, ..]
                | [0xE3, 0x80, 0x81 | 0x82, ..]
        ),
        High::Legacy => matches!(input, [0xA3, 0xA8 | 0xA9 | 0xAC | 0xBA | 0xBB | 0xBD, ..]),
    }
}

/// Number of bytes of a non-ASCII space at the start, if any: byte order mark, U+3000 (UTF-8,
/// GBK), no-break space and the spaces from U+2000.
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
        (0..tokens.count()).map(|i| tokens.kind(i)).collect()
    }

    fn texts(bytes: &[u8]) -> Vec<&[u8]> {
        let tokens = tokenize(bytes);
        (0..tokens.count())
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
        assert_eq!(kinds("a，".as_bytes()), [Identifier, Unknown]);
        assert_eq!(kinds(b"a\xA3\xAC"), [Identifier, Unknown]);
        assert_eq!(kinds(b"IfX If endif"), [Identifier, Whitespace, If, Whitespace, EndIf]);
    }

    #[test]
    fn wide_spaces_are_white_space() {
        assert_eq!(kinds("a\u{3000}:=".as_bytes()), [Identifier, Whitespace, Assign]);
        assert_eq!(kinds(b"a\xA1\xA1:="), [Identifier, Whitespace, Assign]);
        assert_eq!(kinds(b"a\xA0:="), [Identifier, Whitespace, Assign]);
        assert_eq!(kinds("\u{feff}IF".as_bytes()), [Whitespace, If]);
        assert_eq!(kinds(b"a\0\0;"), [Identifier, Whitespace, Semicolon]);
        // A letter whose bytes contain the two bytes of a wide space.
        assert_eq!(kinds("a\u{3861}b".as_bytes()), [Identifier]);
    }

    #[test]
    fn similar_tokens_are_distinguished() {
        assert_eq!(kinds(b"%%%"), [HeaderMark]);
        assert_eq!(kinds(b"%a%"), [Percent, Identifier, Percent]);
        assert_eq!(kinds(b"<SMT>"), [Placeholder]);
        assert_eq!(kinds(b"<SMX"), [Less, Identifier]);
        assert_eq!(kinds(b"<=1"), [LessEqual, Number]);
        assert_eq!(kinds(b"\\T@"), [Backslash, Identifier, Unknown]);
    }
}

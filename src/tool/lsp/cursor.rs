//! The statement before the cursor, from its words alone, because it is not finished.

use super::module::Module;
use super::tokens::token_at;
use crate::rapid::syntax::{TokenKind, Tokens};
use crate::rapid::text::Span;

/// Where a statement stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Outside a module.
    Outside,
    /// Between the declarations of a module.
    Module,
    /// Between the components of a record.
    Record,
    /// In the first line of a declaration.
    Header,
    /// Between the statements of a routine.
    Routine,
}

/// The words before the cursor.
pub(super) struct Cursor<'m> {
    pub(super) module: &'m Module,
    /// The cursor.
    pub(super) byte: u32,
    /// The start of the word that is being typed; the cursor, if there is none.
    pub(super) start: u32,
    /// The words of the statement before that word.
    pub(super) words: Vec<usize>,
    pub(super) place: Place,
    /// Whether the cursor is in a comment, a string or a number.
    pub(super) in_text: bool,
}

impl<'m> Cursor<'m> {
    pub(super) fn new(module: &'m Module, byte: u32) -> Cursor<'m> {
        let tokens = module.parse().tree.tokens();
        let at = token_at(tokens, byte.saturating_sub(1));
        let (kind, range) = (tokens.kind(at), tokens.range(at));
        let touches = range.start < byte && byte <= range.end;
        let is_word = kind == TokenKind::Identifier || kind.is_keyword();
        let in_text = touches
            && match kind {
                TokenKind::Comment | TokenKind::UnclosedString | TokenKind::Number => true,
                TokenKind::String => byte < range.end,
                _ => false,
            };
        let (start, before) = if touches && (is_word || in_text) {
            (range.start, at)
        } else {
            (byte, if touches { at + 1 } else { at })
        };
        let (words, place) = statement(tokens, before);
        Cursor { module, byte, start, words, place, in_text }
    }

    pub(super) fn kind(&self, word: usize) -> TokenKind {
        self.module.parse().tree.tokens().kind(word)
    }

    pub(super) fn last(&self) -> Option<TokenKind> {
        self.words.last().map(|word| self.kind(*word))
    }

    /// A word in lower case.
    pub(super) fn text(&self, word: usize) -> String {
        let range = self.module.parse().tree.tokens().range(word);
        let span = Span { file: self.module.file.id, start: range.start, end: range.end };
        self.module.file.text(span).to_lowercase()
    }

    /// What was typed of the word at the cursor, in lower case.
    pub(super) fn typed(&self) -> String {
        let span = Span { file: self.module.file.id, start: self.start, end: self.byte };
        self.module.file.text(span).to_lowercase()
    }

    /// Whether nothing follows on the line.
    pub(super) fn is_at_line_end(&self) -> bool {
        let rest = self.module.file.bytes.get(self.byte as usize..).unwrap_or_default();
        let sign = rest.iter().find(|byte| !matches!(byte, b' ' | b'\t'));
        sign.is_none_or(|sign| matches!(sign, b'\r' | b'\n' | b'!'))
    }
}

/// The words of the last statement before a token, and where it stands.
fn statement(tokens: &Tokens, before: usize) -> (Vec<usize>, Place) {
    let mut words = Vec::new();
    let mut depth = 0_i32;
    let mut boundary = None;
    for word in (0..before).rev() {
        let kind = tokens.kind(word);
        if kind.is_trivia() {
            continue;
        }
        match kind {
            TokenKind::RightParen | TokenKind::RightBracket | TokenKind::RightBrace => depth += 1,
            TokenKind::LeftParen | TokenKind::LeftBracket | TokenKind::LeftBrace => depth -= 1,
            _ => {}
        }
        if kind == TokenKind::Semicolon || depth <= 0 && ends_before(kind) {
            boundary = Some(kind);
            break;
        }
        words.push(word);
        if depth <= 0 && begins(kind) {
            break;
        }
    }
    words.reverse();
    if boundary == Some(TokenKind::Error) {
        words = behind_group(tokens, &words).unwrap_or(words);
    }
    if let Some(rest) = behind_condition(tokens, &words) {
        words = rest;
    }
    let place = place(tokens, before);
    match header(tokens, &words) {
        Header::None => (words, place),
        Header::Unfinished => (words, Place::Header),
        Header::Before(rest) => (rest, place),
    }
}

/// Whether a statement begins behind a word.
fn ends_before(kind: TokenKind) -> bool {
    let opens = matches!(
        kind,
        TokenKind::Then
            | TokenKind::Else
            | TokenKind::Do
            | TokenKind::Colon
            | TokenKind::Error
            | TokenKind::Undo
            | TokenKind::Backward
            | TokenKind::HeaderMark
    );
    opens || kind.closes_block()
}

/// Whether a word is the first of a statement.
fn begins(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::If
            | TokenKind::ElseIf
            | TokenKind::For
            | TokenKind::While
            | TokenKind::Test
            | TokenKind::Case
            | TokenKind::Goto
            | TokenKind::Return
            | TokenKind::Raise
            | TokenKind::Connect
            | TokenKind::Module
    )
}

/// Where the statements before a token stand.
fn place(tokens: &Tokens, before: usize) -> Place {
    for word in (0..before).rev() {
        match tokens.kind(word) {
            TokenKind::Proc | TokenKind::Func | TokenKind::Trap => return Place::Routine,
            TokenKind::Record => return Place::Record,
            TokenKind::EndProc
            | TokenKind::EndFunc
            | TokenKind::EndTrap
            | TokenKind::EndRecord
            | TokenKind::Module => return Place::Module,
            TokenKind::EndModule => return Place::Outside,
            _ => {}
        }
    }
    Place::Outside
}

/// The first line of a declaration at the start of some words.
enum Header {
    None,
    Unfinished,
    /// These words are behind it.
    Before(Vec<usize>),
}

fn header(tokens: &Tokens, words: &[usize]) -> Header {
    let scope = |word: &&usize| matches!(tokens.kind(**word), TokenKind::Local | TokenKind::Task);
    let rest = &words[words.iter().take_while(scope).count()..];
    let named = || rest.get(2..).map(<[usize]>::to_vec);
    let behind = match rest.first().map(|word| tokens.kind(*word)) {
        Some(TokenKind::Proc | TokenKind::Func) => behind_group(tokens, rest),
        Some(TokenKind::Trap | TokenKind::Record) => named(),
        Some(TokenKind::Module) => match rest.get(2).map(|word| tokens.kind(*word)) {
            Some(TokenKind::LeftParen) => behind_group(tokens, rest),
            _ => named(),
        },
        _ => return Header::None,
    };
    behind.map_or(Header::Unfinished, Header::Before)
}

/// The words behind the first group in parentheses.
fn behind_group(tokens: &Tokens, words: &[usize]) -> Option<Vec<usize>> {
    let mut depth = 0;
    for (index, word) in words.iter().enumerate() {
        match tokens.kind(*word) {
            TokenKind::LeftParen => depth += 1,
            TokenKind::RightParen if depth == 1 => return Some(words[index + 1..].to_vec()),
            TokenKind::RightParen => depth -= 1,
            _ => {}
        }
    }
    None
}

/// The words of the statement behind the condition of an IF without THEN.
fn behind_condition(tokens: &Tokens, words: &[usize]) -> Option<Vec<usize>> {
    if tokens.kind(*words.first()?) != TokenKind::If {
        return None;
    }
    let mut depth = 0;
    for index in 2..words.len() {
        let (before, kind) = (tokens.kind(words[index - 1]), tokens.kind(words[index]));
        match before {
            TokenKind::LeftParen | TokenKind::LeftBracket | TokenKind::LeftBrace => depth += 1,
            TokenKind::RightParen | TokenKind::RightBracket | TokenKind::RightBrace => depth -= 1,
            _ => {}
        }
        if depth == 0 && ends_value(before) && kind == TokenKind::Identifier {
            return Some(words[index..].to_vec());
        }
    }
    None
}

/// Whether a value may end with a word.
pub(super) fn ends_value(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Identifier
            | TokenKind::Number
            | TokenKind::String
            | TokenKind::True
            | TokenKind::False
            | TokenKind::RightParen
            | TokenKind::RightBracket
            | TokenKind::RightBrace
            | TokenKind::Placeholder
    )
}

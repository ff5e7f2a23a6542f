//! From tokens to the tree: a recursive descent parser that accepts any input.
//!
//! An error is reported once: after it the parser is *quiet* until the next statement or
//! declaration. Recovery skips to the end of the statement, to a keyword that starts or ends a
//! construct, or to a line that looks like a new statement, whichever comes first.

mod arguments;
mod blocks;
mod data;
mod expressions;
mod foreign;
mod modules;
mod recovery;
mod routines;
mod statements;

use super::error::{Related, SyntaxError};
use super::lexer;
use super::node::NodeKind;
use super::parsed::{MAX_DEPTH, Parse};
use super::token::{TokenKind, Tokens};
use super::tolerance::{Tolerance, Tolerated};
use super::tree::{Builder, Mark};

/// Nodes per eight tokens in typical programs, for the first allocation.
const NODES_FOR_EIGHT: usize = 5;
/// Longest excerpt of the source in a message, in characters.
const EXCERPT: usize = 24;

/// Parses a file. The joined tokens of the tree are the bytes of the file, for any bytes.
///
/// Offsets are `u32`: bytes beyond 4 GiB are not parsed, which an error reports.
#[must_use]
pub fn parse(bytes: &[u8]) -> Parse {
    let tokens = lexer::tokenize(bytes);
    let mut parser = Parser {
        bytes,
        tokens: &tokens,
        position: 0,
        end: 0,
        builder: Builder::with_capacity(tokens.count() / 8 * NODES_FOR_EIGHT),
        errors: Vec::new(),
        tolerances: Vec::new(),
        quiet: false,
        depth: 0,
        depth_reported: false,
        cut_off_reported: false,
        split_if: None,
        parentheses: Parentheses::default(),
        line: Line::default(),
        open: Vec::new(),
        braces: 0,
        steps: 0,
    };
    parser.skip_trivia();
    parser.file();
    if u32::try_from(bytes.len()).is_err() {
        parser.errors.push(SyntaxError {
            start: u32::MAX,
            end: u32::MAX,
            message: "the file is larger than 4 GiB; what follows here is not read".to_owned(),
            related: None,
        });
    }
    let Parser { builder, mut errors, mut tolerances, steps, .. } = parser;
    errors.sort_by_key(|error| error.start);
    tolerances.sort_by_key(|tolerated| tolerated.start);
    Parse { tree: builder.finish_tree(tokens), errors, tolerances, steps }
}

struct Parser<'a> {
    bytes: &'a [u8],
    tokens: &'a Tokens,
    /// The next token; never trivia.
    position: usize,
    /// One past the last token that was read, trivia excluded.
    end: usize,
    builder: Builder,
    errors: Vec<SyntaxError>,
    tolerances: Vec<Tolerated>,
    /// True after an error in the current statement or declaration: no further message.
    quiet: bool,
    depth: u32,
    /// Whether the excessive nesting of this routine was already reported.
    depth_reported: bool,
    /// Whether an unexpected end of the file was already reported.
    cut_off_reported: bool,
    /// The last compact IF over two lines: its `THEN` may be missing.
    split_if: Option<SplitIf>,
    /// The brackets of the last scan ahead.
    parentheses: Parentheses,
    /// The last result of `first_of_line`.
    line: Line,
    /// Open block statements and routines, outermost first.
    open: Vec<Open>,
    /// Number of open blocks that began with `{` instead of a keyword.
    braces: u32,
    steps: u64,
}

/// A compact IF over two lines.
#[derive(Clone, Copy)]
struct SplitIf {
    /// The token of its `IF`.
    opener: usize,
    /// The first token of its statement.
    statement: usize,
}

/// The brackets of a statement, found by a scan ahead.
#[derive(Default)]
struct Parentheses {
    /// The token of each opening bracket, and whether the bracket contains a list.
    found: Vec<(usize, bool)>,
    /// The token at which the scan ended.
    end: usize,
}

/// A token and the first token of its line.
#[derive(Clone, Copy, Default)]
struct Line {
    token: usize,
    first: usize,
}

/// A block that is not closed yet.
#[derive(Clone, Copy)]
struct Open {
    closer: TokenKind,
    /// The token of its opening keyword.
    opener: usize,
}

impl<'a> Parser<'a> {
    // --- looking ---

    fn at(&self, kind: TokenKind) -> bool {
        self.current() == kind
    }

    fn current(&self) -> TokenKind {
        self.tokens.kind(self.position)
    }

    /// The next token after `index`, trivia skipped.
    fn after(&mut self, index: usize) -> usize {
        let mut next = index + 1;
        while self.tokens.kind(next).is_trivia() {
            next += 1;
        }
        self.steps += (next - index) as u64;
        next
    }

    fn next(&mut self) -> TokenKind {
        let next = self.after(self.position);
        self.tokens.kind(next)
    }

    fn text(&self, index: usize) -> &'a [u8] {
        let range = self.tokens.range(index);
        self.bytes.get(range.start as usize..range.end as usize).unwrap_or_default()
    }

    // --- moving ---

    fn skip_trivia(&mut self) {
        while self.tokens.kind(self.position).is_trivia() {
            self.position += 1;
        }
    }

    fn bump(&mut self) {
        if self.position < self.tokens.count() {
            let before = self.position;
            self.position += 1;
            self.end = self.position;
            self.skip_trivia();
            self.steps += (self.position - before) as u64;
        }
    }

    fn eat(&mut self, kind: TokenKind) -> bool {
        let there = self.at(kind);
        if there {
            self.bump();
        }
        there
    }

    /// Reads a required token, or reports that it is missing.
    fn expect(&mut self, kind: TokenKind) -> bool {
        let there = self.eat(kind);
        if !there {
            self.error_expected(kind.describe());
        }
        there
    }

    /// Reads the bracket that closes a list, or reports that `expected` is missing.
    fn close_bracket(&mut self, closer: TokenKind, expected: &str) {
        if !self.eat(closer) {
            self.error_expected(expected);
            self.missing();
        }
    }

    // --- building ---

    fn mark(&self) -> Mark {
        self.builder.mark(self.position)
    }

    fn finish(&mut self, mark: Mark, kind: NodeKind) {
        self.builder.finish(mark, kind, self.end);
    }

    /// Adds an error node for the tokens since `start`; false if there are none.
    fn finish_skipped(&mut self, mark: Mark, start: usize) -> bool {
        let skipped = self.position > start;
        if skipped {
            self.finish(mark, NodeKind::Error);
        }
        skipped
    }

    /// At the end of a round of a loop: the round must have read something.
    fn ensure_progress(&mut self, before: usize) {
        debug_assert!(self.position > before, "every round reads something");
        if self.position == before {
            self.leaf(NodeKind::Error);
        }
    }

    /// Adds a node for the current token.
    fn leaf(&mut self, kind: NodeKind) {
        let mark = self.mark();
        self.bump();
        self.finish(mark, kind);
    }

    /// Adds an empty node for a missing element.
    fn missing(&mut self) {
        let mark = self.builder.mark(self.end);
        self.finish(mark, NodeKind::Error);
    }

    /// A name in a declaration, or another name that is not a value.
    fn name(&mut self) {
        match self.current() {
            TokenKind::Identifier => self.leaf(NodeKind::Name),
            TokenKind::Placeholder => self.leaf(NodeKind::Placeholder),
            kind if kind.is_keyword() && !self.quiet && !self.first_on_line(self.position) => {
                let message =
                    format!("{} is a reserved word; choose another name", kind.describe());
                self.error_at(self.position, message);
                self.leaf(NodeKind::Error);
            }
            _ => {
                self.error_expected("a name");
                self.missing();
            }
        }
    }

    // --- reporting ---

    fn tolerate(&mut self, tolerance: Tolerance, token: usize) {
        let range = self.tokens.range(token);
        self.tolerances.push(Tolerated { tolerance, start: range.start, end: range.end });
    }

    fn push_error(&mut self, start: u32, end: u32, message: String, related: Option<Related>) {
        // A file that ends too early is one error, even if several blocks are open.
        let cut_off = self.at(TokenKind::EndOfFile);
        let told = self.quiet || cut_off && self.cut_off_reported;
        if !told {
            self.cut_off_reported |= cut_off;
            self.errors.push(SyntaxError { start, end, message, related });
        }
        self.quiet = true;
    }

    fn error_at(&mut self, token: usize, message: String) {
        let range = self.tokens.range(token);
        self.push_error(range.start, range.end, message, None);
    }

    /// Reports that something else is expected at the current token. If that is the first of its
    /// line, the error is placed at the end of the token before.
    fn error_expected(&mut self, expected: &str) {
        if self.quiet {
            return;
        }
        let message = format!("expected {expected}, found {}", self.found());
        if self.at(TokenKind::EndOfFile) || self.first_on_line(self.position) {
            self.error_before(message);
        } else {
            self.error_at(self.position, message);
        }
    }

    /// The same, but always placed at the current token.
    fn error_unexpected(&mut self, expected: &str) {
        if !self.quiet {
            let message = format!("expected {expected}, found {}", self.found());
            self.error_at(self.position, message);
        }
    }

    /// The end of the token before `token`, trivia skipped.
    fn end_before(&self, token: usize) -> u32 {
        let before = (0..token).rev().find(|&before| !self.tokens.kind(before).is_trivia());
        before.map_or(0, |before| self.tokens.range(before).end)
    }

    /// Reports an element that is missing after the last token.
    fn error_before(&mut self, message: String) {
        let place = match self.end {
            0 => 0,
            end => self.tokens.range(end - 1).end,
        };
        self.push_error(place, place, message, None);
    }

    fn related(&self, token: usize, message: String) -> Related {
        let range = self.tokens.range(token);
        Related { start: range.start, end: range.end, message }
    }

    /// The current token, for a message.
    fn found(&self) -> String {
        let kind = self.current();
        let text = self.text(self.position);
        match kind {
            TokenKind::EndOfFile | TokenKind::UnclosedString | TokenKind::Encoded => {
                kind.describe().to_owned()
            }
            _ if kind.is_keyword() => kind.describe().to_owned(),
            _ => format!("'{}'", excerpt(text)),
        }
    }

    // --- depth ---

    /// Runs `parse` one level deeper; at the limit it reads nothing, reports and returns `None`.
    fn deeper<T>(&mut self, parse: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.depth >= MAX_DEPTH {
            if self.depth_reported {
                self.quiet = true;
            } else {
                let message = format!("nested deeper than {MAX_DEPTH} levels; this is not read");
                self.error_at(self.position, message);
                self.depth_reported = true;
            }
            return None;
        }
        self.depth += 1;
        let result = parse(self);
        self.depth -= 1;
        Some(result)
    }
}

/// The start of some bytes as text; bytes that are not UTF-8 are read as ISO 8859-1, the most
/// frequent legacy encoding of RAPID files.
fn excerpt(bytes: &[u8]) -> String {
    let latin = || bytes.iter().map(|&byte| char::from(byte)).collect();
    let text: String = std::str::from_utf8(bytes).map_or_else(|_| latin(), str::to_owned);
    let mut excerpt: String = text.chars().take(EXCERPT).collect();
    if excerpt.len() < text.len() {
        excerpt.push('…');
    }
    excerpt
}

//! Tokens → tree: recursive descent that never fails.
//!
//! A mistake is reported once: after an error the parser is *quiet* until the
//! next statement or declaration starts. Recovery skips to the end of the
//! statement, to a keyword that starts or ends something, or to a line that
//! looks like a new statement, whichever comes first.

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

/// Nodes for eight tokens in ordinary programs, for the first allocation.
const NODES_FOR_EIGHT: usize = 5;
/// Longest excerpt of the source in a message, in characters.
const EXCERPT: usize = 24;

/// Parses a file. Any bytes give a tree whose tokens joined are those bytes.
///
/// Offsets are `u32`: of a file of 4 GiB or more the tail is one token that no
/// production claims, and an error says so.
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
    /// The token to be read next; never trivia.
    position: usize,
    /// One past the last token read that is no trivia.
    end: usize,
    builder: Builder,
    errors: Vec<SyntaxError>,
    tolerances: Vec<Tolerated>,
    /// After an error in the current statement or declaration.
    quiet: bool,
    depth: u32,
    /// Whether this routine was already said to be nested too deeply.
    depth_reported: bool,
    /// Whether the end of the file was already reported as too early.
    cut_off_reported: bool,
    /// The last compact IF whose statement is on a line of its own: its `THEN`
    /// may be missing.
    split_if: Option<SplitIf>,
    /// Brackets that were looked at ahead.
    parentheses: Parentheses,
    /// The last answer to where a line starts.
    line: Line,
    /// Block statements and routines that are not closed yet, outermost first.
    open: Vec<Open>,
    /// Blocks that began with `{` in the place of a keyword and are not closed.
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

/// Brackets of a statement, looked at ahead.
#[derive(Default)]
struct Parentheses {
    /// The token of each opening bracket, and whether it holds a list.
    found: Vec<(usize, bool)>,
    /// The token at which the look ahead ended.
    end: usize,
}

/// A token and the first token of its line.
#[derive(Clone, Copy, Default)]
struct Line {
    token: usize,
    first: usize,
}

/// Something that waits for its closing keyword.
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

    /// The token after the one at `index`, trivia left out.
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

    /// Reads a token that has to be there, or reports it missing.
    fn expect(&mut self, kind: TokenKind) -> bool {
        let there = self.eat(kind);
        if !there {
            self.error_expected(kind.describe());
        }
        there
    }

    /// Reads the bracket that closes a list, or reports that `expected` should
    /// stand here.
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

    /// A node of the current token.
    fn leaf(&mut self, kind: NodeKind) {
        let mark = self.mark();
        self.bump();
        self.finish(mark, kind);
    }

    /// An empty node for something that is missing.
    fn missing(&mut self) {
        let mark = self.builder.mark(self.end);
        self.finish(mark, NodeKind::Error);
    }

    /// A name that is declared or that is no value.
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
        // A file that is cut off is one mistake, whatever it leaves open.
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

    /// Reports that something else was expected at the current token. What is
    /// missing at the end of a line is reported there, not on the next line.
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

    /// Reports that something else was expected than the current token.
    fn error_unexpected(&mut self, expected: &str) {
        if !self.quiet {
            let message = format!("expected {expected}, found {}", self.found());
            self.error_at(self.position, message);
        }
    }

    /// The end of the token before one, trivia left out.
    fn end_before(&self, token: usize) -> u32 {
        let before = (0..token).rev().find(|&before| !self.tokens.kind(before).is_trivia());
        before.map_or(0, |before| self.tokens.range(before).end)
    }

    /// Reports something that is missing behind the last token.
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

    /// Runs `parse` one level deeper; at the limit it reports and returns
    /// `None`, having read nothing.
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

/// The start of some bytes as text; bytes that are not UTF-8 are read as ISO
/// 8859-1, which is right for most of RAPID's legacy files.
fn excerpt(bytes: &[u8]) -> String {
    let latin = || bytes.iter().map(|&byte| char::from(byte)).collect();
    let text: String = std::str::from_utf8(bytes).map_or_else(|_| latin(), str::to_owned);
    let mut excerpt: String = text.chars().take(EXCERPT).collect();
    if excerpt.len() < text.len() {
        excerpt.push('…');
    }
    excerpt
}

//! Files and modules: `grammar/modules.ebnf`.

use super::Parser;
use super::blocks::is_near;
use super::recovery::{closes_routine, ends_block, opens_routine, starts_data, starts_statement};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;
use crate::rapid::syntax::tolerance::Tolerance;

/// Module attributes in their fixed order.
const ATTRIBUTES: [&str; 5] = ["SYSMODULE", "NOVIEW", "NOSTEPIN", "VIEWONLY", "READONLY"];

/// The parts of a module in the order of the grammar.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Types,
    Data,
    Routines,
}

/// The progress in the declarations of a module.
struct Progress {
    part: Part,
    /// Whether statements outside a routine were reported, whose `ENDPROC` may follow.
    orphaned: bool,
}

/// The contents of a skipped line.
struct Skipped {
    /// Whether it ended with `;`.
    ended: bool,
    /// Whether it contained a `:=`.
    value: bool,
}

const START: Progress = Progress { part: Part::Types, orphaned: false };

impl Parser<'_> {
    pub(super) fn file(&mut self) {
        let mark = self.builder.mark(0);
        let mut has_rapid = false;
        while !self.at(TokenKind::EndOfFile) {
            let before = self.position;
            self.quiet = false;
            match self.current() {
                TokenKind::Encoded => self.leaf(NodeKind::EncodedModule),
                TokenKind::HeaderMark => self.header(),
                TokenKind::Module => {
                    self.module();
                    has_rapid = true;
                }
                TokenKind::EndModule => {
                    self.error_at(before, "ENDMODULE without MODULE before it".to_owned());
                    self.leaf(NodeKind::Error);
                    has_rapid = true;
                }
                _ if self.at_declaration() => {
                    self.bare_declarations();
                    has_rapid = true;
                }
                _ if self.at_misspelt_module() => {
                    self.error_unexpected("MODULE");
                    self.module();
                    has_rapid = true;
                }
                _ => self.outside_text(has_rapid),
            }
            self.ensure_progress(before);
        }
        self.builder.finish(mark, NodeKind::File, self.tokens.count());
    }

    /// `%%% VERSION:1 LANGUAGE:ENGLISH %%%`
    fn header(&mut self) {
        let mark = self.mark();
        let start = self.position;
        self.bump();
        while !matches!(
            self.current(),
            TokenKind::HeaderMark | TokenKind::Module | TokenKind::EndOfFile
        ) && !self.at_declaration()
        {
            self.bump();
        }
        if !self.is_plain_header(start) {
            self.tolerate(Tolerance::HeaderContents, start);
        }
        self.expect(TokenKind::HeaderMark);
        self.finish(mark, NodeKind::Header);
    }

    /// Whether the tokens since the `%%%` at `start` are version and language.
    fn is_plain_header(&mut self, start: usize) -> bool {
        let words: [(TokenKind, &[u8]); 6] = [
            (TokenKind::Identifier, b"VERSION"),
            (TokenKind::Colon, b":"),
            (TokenKind::Number, b""),
            (TokenKind::Identifier, b"LANGUAGE"),
            (TokenKind::Colon, b":"),
            (TokenKind::Identifier, b""),
        ];
        let mut token = start;
        words.iter().all(|&(kind, word)| {
            token = self.after(token);
            self.tokens.kind(token) == kind
                && (word.is_empty() || self.text(token).eq_ignore_ascii_case(word))
        }) && self.after(token) == self.position
    }

    /// Whether a module starts here: keyword and name at the start of a line.
    fn at_module(&mut self) -> bool {
        self.at(TokenKind::Module)
            && self.first_on_line(self.position)
            && (self.next() == TokenKind::Identifier)
    }

    /// Whether a misspelt `MODULE` is here: alone on its line with a name and attributes.
    fn at_misspelt_module(&mut self) -> bool {
        if !self.at(TokenKind::Identifier)
            || !self.first_on_line(self.position)
            || !is_near(self.text(self.position), b"MODULE")
        {
            return false;
        }
        let name = self.after(self.position);
        let behind = self.after(name);
        self.tokens.kind(name) == TokenKind::Identifier
            && (self.tokens.kind(behind) == TokenKind::LeftParen || self.first_on_line(behind))
    }

    /// Whether a declaration starts here; the tokens after it distinguish it from prose.
    fn at_declaration(&mut self) -> bool {
        let opens =
            |kind| opens_routine(kind) || matches!(kind, TokenKind::Record | TokenKind::Alias);
        match self.current() {
            TokenKind::Var | TokenKind::Pers | TokenKind::Const => self.two_names_follow(),
            TokenKind::Local | TokenKind::Task => {
                let next = self.next();
                starts_data(next) || opens(next)
            }
            kind => {
                opens(kind)
                    && self.next() == TokenKind::Identifier
                    && self.first_on_line(self.position)
            }
        }
    }

    /// Whether two names follow the current token: type and name of data.
    pub(super) fn two_names_follow(&mut self) -> bool {
        let first = self.after(self.position);
        let second = self.after(first);
        self.tokens.kind(first) == TokenKind::Identifier
            && self.tokens.kind(second) == TokenKind::Identifier
    }

    /// Declarations without a module around them.
    fn bare_declarations(&mut self) {
        self.tolerate(Tolerance::DeclarationOutsideModule, self.position);
        let mut progress = START;
        while self.at_declaration() {
            let before = self.position;
            self.quiet = false;
            self.item(&mut progress);
            if self.position == before {
                break;
            }
        }
    }

    /// Text outside modules, tolerated in a file that contains RAPID.
    fn outside_text(&mut self, has_rapid: bool) {
        let mark = self.mark();
        let start = self.position;
        loop {
            self.bump();
            match self.current() {
                TokenKind::EndOfFile | TokenKind::HeaderMark | TokenKind::EndModule => break,
                _ if self.at_module() || self.at_misspelt_module() || self.at_declaration() => {
                    break;
                }
                _ => {}
            }
        }
        let alone = !has_rapid && self.at(TokenKind::EndOfFile);
        self.finish(mark, NodeKind::OutsideText);
        if alone {
            let message = "expected MODULE; nothing in this file is RAPID".to_owned();
            self.error_at(start, message);
        } else {
            self.tolerate(Tolerance::TextOutsideModule, start);
        }
    }

    /// `MODULE name (attributes) … ENDMODULE`
    fn module(&mut self) {
        let mark = self.mark();
        self.open(TokenKind::EndModule, self.position);
        self.bump();
        self.name();
        if self.at(TokenKind::LeftParen) {
            self.module_attributes();
        }
        if self.quiet {
            self.rest_of_header();
        }
        let mut progress = START;
        loop {
            let before = self.position;
            self.quiet = false;
            match self.current() {
                TokenKind::EndModule | TokenKind::EndOfFile => break,
                TokenKind::Module if self.at_module() => break,
                TokenKind::Identifier if self.misspelt_closer() > 0 => break,
                _ => self.item(&mut progress),
            }
            self.ensure_progress(before);
        }
        self.close();
        self.finish(mark, NodeKind::Module);
    }

    /// `(SYSMODULE, NOSTEPIN)`
    fn module_attributes(&mut self) {
        let mark = self.mark();
        self.bump();
        let mut last = None;
        loop {
            let word = self.text(self.position).to_ascii_uppercase();
            let order = ATTRIBUTES.iter().position(|known| known.as_bytes() == word);
            if order.is_none() {
                self.error_expected("SYSMODULE, NOVIEW, NOSTEPIN, VIEWONLY or READONLY");
                break;
            }
            if order <= last {
                self.tolerate(Tolerance::AttributeOrder, self.position);
            }
            last = order.max(last);
            self.bump();
            if !self.eat(TokenKind::Comma) {
                break;
            }
        }
        if !self.eat(TokenKind::RightParen) {
            self.error_expected("',' or ')'");
            while !self.first_on_line(self.position) && !self.at(TokenKind::EndOfFile) {
                let closed = self.at(TokenKind::RightParen);
                self.bump();
                if closed {
                    break;
                }
            }
        }
        self.finish(mark, NodeKind::ModuleAttributes);
    }

    /// A declaration of a module, or other text in its place.
    fn item(&mut self, progress: &mut Progress) {
        let start = self.position;
        self.depth_reported = false;
        let scope = self.current();
        if matches!(scope, TokenKind::Local | TokenKind::Task) && self.next() == scope {
            self.error_at(start, format!("{} is doubled", scope.describe()));
            self.leaf(NodeKind::Error);
        }
        let scoped = matches!(self.current(), TokenKind::Local | TokenKind::Task);
        let kind = if scoped { self.next() } else { self.current() };
        match kind {
            _ if opens_routine(kind) => {
                progress.orphaned = false;
                self.in_order(progress, Part::Routines, start);
                self.routine(kind);
            }
            TokenKind::Record | TokenKind::Alias => {
                self.in_order(progress, Part::Types, start);
                if kind == TokenKind::Record { self.record() } else { self.alias() }
            }
            TokenKind::Semicolon if !scoped => {
                self.tolerate(Tolerance::EmptyStatement, start);
                self.leaf(NodeKind::EmptyStatement);
            }
            TokenKind::Placeholder if !scoped => self.leaf(NodeKind::Placeholder),
            _ if scoped && self.lacks_routine_keyword() => self.orphans(progress),
            _ if scoped || starts_data(kind) => {
                self.in_order(progress, Part::Data, start);
                self.data_declaration();
            }
            _ => self.orphans(progress),
        }
    }

    /// Whether `LOCAL name (` or `LOCAL type name (` is here: a routine header without keyword.
    fn lacks_routine_keyword(&mut self) -> bool {
        let mut token = self.after(self.position);
        for _ in 0..2 {
            if self.tokens.kind(token) == TokenKind::Identifier {
                token = self.after(token);
            }
        }
        self.tokens.kind(token) == TokenKind::LeftParen
    }

    fn in_order(&mut self, progress: &mut Progress, part: Part, token: usize) {
        if part < progress.part {
            self.tolerate(Tolerance::DeclarationOrder, token);
        }
        progress.part = progress.part.max(part);
    }

    /// Statements and superfluous keywords at module level, with one error for all of them.
    fn orphans(&mut self, progress: &mut Progress) {
        let mark = self.mark();
        let kind = self.current();
        if progress.orphaned && (starts_statement(kind) || ends_block(kind)) {
            // Already reported: this is the rest of a routine without its header.
            self.quiet = true;
        }
        if ends_block(kind) {
            let message = format!("{} without its beginning", kind.describe());
            self.error_at(self.position, message);
            self.bump();
            if kind == TokenKind::Error && self.at(TokenKind::LeftParen) {
                self.rest_of_header();
            }
            self.finish(mark, NodeKind::Error);
            progress.orphaned &= !closes_routine(kind) && kind != TokenKind::EndRecord;
            return;
        }
        self.error_unexpected("a data declaration, PROC, FUNC, TRAP or ENDMODULE");
        if progress.orphaned {
            self.orphan_block();
        } else {
            // Unlike a misspelt routine header, a misspelt declaration has `:=` or `;` on its line.
            let line = self.recover_line();
            if !line.ended {
                if line.value {
                    self.recover();
                } else {
                    self.rest_of_parameters();
                }
            }
            progress.orphaned = !line.ended && !line.value;
            if starts_statement(self.current()) && !starts_data(self.current()) {
                self.orphan_block();
            }
        }
        if closes_routine(self.current()) || self.at(TokenKind::EndRecord) {
            self.bump();
            progress.orphaned = false;
        }
        self.finish(mark, NodeKind::Error);
    }

    /// Statements of a routine or components of a record with an unrecognised header.
    fn orphan_block(&mut self) {
        if starts_statement(self.current()) {
            self.open(TokenKind::EndRecord, self.position);
            self.block();
            for _ in 0..self.misspelt_closer() {
                self.bump();
            }
            self.open.pop();
        } else {
            self.bump();
            self.recover();
        }
    }

    /// Skips to the end of the line.
    fn recover_line(&mut self) -> Skipped {
        let mark = self.mark();
        let start = self.position;
        let mut skipped = Skipped { ended: false, value: false };
        while !self.at(TokenKind::EndOfFile)
            && (self.position == start || !self.first_on_line(self.position))
        {
            let kind = self.current();
            if self.position > start && ends_block(kind) {
                break;
            }
            skipped.ended = kind == TokenKind::Semicolon;
            skipped.value |= kind == TokenKind::Assign;
            self.bump();
        }
        self.finish_skipped(mark, start);
        skipped
    }
}

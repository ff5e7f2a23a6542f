//! What begins a line, and how far it is indented.

use crate::rapid::syntax::{Node, NodeKind, Tokens, Tree};

/// Where a token stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// Behind the token before it, or where the user has put it.
    Inside,
    /// On a line of its own.
    Line,
    /// At the start of a line if it is there, else behind the token before it.
    Free,
}

/// The places of all tokens.
pub(super) struct Layout {
    /// By token.
    pub(super) starts: Vec<Start>,
    /// Steps of indentation: of the token if it begins a line, else of the statement that it is in.
    pub(super) steps: Vec<u16>,
    /// Whether the token is the name of a called procedure, which a blank separates from its arguments.
    pub(super) callees: Vec<bool>,
    /// Whether the token begins the statement of a compact IF.
    pub(super) compact: Vec<bool>,
    /// The next token from this one on that is neither white space nor a comment.
    next: Vec<usize>,
}

impl Layout {
    pub(super) fn new(tree: &Tree) -> Layout {
        let count = tree.tokens().count();
        let mut layout = Layout {
            starts: vec![Start::Inside; count],
            steps: vec![0; count],
            callees: vec![false; count],
            compact: vec![false; count],
            next: vec![count; count],
        };
        for index in (0..count).rev() {
            layout.next[index] = if tree.tokens().kind(index).is_trivia() {
                layout.next.get(index + 1).copied().unwrap_or(count)
            } else {
                index
            };
        }
        let mut walk = Walk { tokens: tree.tokens(), layout: &mut layout, last: 0 };
        walk.children(tree.root(), 0);
        layout
    }

    /// The token that a comment stands before, comments skipped.
    pub(super) fn behind(&self, comment: usize) -> Option<usize> {
        self.next.get(comment).copied().filter(|next| *next < self.next.len())
    }
}

struct Walk<'w> {
    tokens: &'w Tokens,
    layout: &'w mut Layout,
    /// The last token that was looked up: the next one is near.
    last: usize,
}

impl Walk<'_> {
    /// The token that starts at a byte.
    fn token(&mut self, start: u32) -> usize {
        let is_before = |index: usize| self.tokens.range(index).start < start;
        // From the last token in steps that double, then between the last two steps.
        let (mut low, mut high) = (self.last, self.last);
        let mut step = 1;
        while low > 0 && !is_before(low) {
            (low, high) = (low.saturating_sub(step), low);
            step *= 2;
        }
        while high < self.tokens.count() && is_before(high) {
            (low, high) = (high, (high + step).min(self.tokens.count()));
            step *= 2;
        }
        while low < high {
            let middle = low.midpoint(high);
            if is_before(middle) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        self.last = low;
        low
    }

    fn begin(&mut self, at: u32, steps: usize, start: Start) {
        let token = self.token(at);
        if let Some(place) = self.layout.starts.get_mut(token) {
            *place = start;
            self.layout.steps[token] = steps as u16;
        }
    }

    /// Sets the indentation of all tokens of a node.
    fn fill(&mut self, node: Node<'_>, steps: usize) {
        let range = node.range();
        if range.is_empty() {
            return;
        }
        let (first, last) = (self.token(range.start), self.token(range.end));
        self.layout.steps[first..last].fill(steps as u16);
    }

    /// The own keywords of a block that close it or begin a part of it.
    fn closers(&mut self, node: Node<'_>, steps: usize) {
        for token in node.own_tokens() {
            if token.kind().closes_block() {
                self.begin(token.range().start, steps, Start::Line);
            }
        }
    }

    fn children(&mut self, node: Node<'_>, steps: usize) {
        for child in node.children() {
            self.item(child, steps);
        }
    }

    // The depth of a tree is limited by the parser.
    fn item(&mut self, node: Node<'_>, steps: usize) {
        match node.kind() {
            NodeKind::Block => self.children(node, steps),
            NodeKind::EmptyStatement => {
                self.fill(node, steps);
                self.begin(node.range().start, steps, Start::Free);
            }
            kind if begins_line(kind) => {
                self.fill(node, steps);
                self.inside(node, steps);
                self.begin(node.range().start, steps, Start::Line);
            }
            _ => {}
        }
    }

    fn inside(&mut self, node: Node<'_>, steps: usize) {
        match node.kind() {
            NodeKind::Module | NodeKind::RecordDeclaration => self.children(node, steps + 1),
            NodeKind::ProcDeclaration | NodeKind::FuncDeclaration | NodeKind::TrapDeclaration => {
                for child in node.children() {
                    let is_handler = matches!(
                        child.kind(),
                        NodeKind::BackwardHandler | NodeKind::ErrorHandler | NodeKind::UndoHandler
                    );
                    self.item(child, if is_handler { steps } else { steps + 1 });
                }
            }
            NodeKind::CompactIf => self.compact(node, steps),
            NodeKind::TestStatement => self.children(node, steps),
            NodeKind::CallStatement => {
                if let Some(name) = node.callee() {
                    let token = self.token(name.range().start);
                    self.layout.callees[token] = true;
                }
            }
            _ => {
                for child in node.children() {
                    match child.kind() {
                        NodeKind::Block => self.children(child, steps + 1),
                        NodeKind::ElseIfBranch | NodeKind::ElseBranch => self.item(child, steps),
                        _ => {}
                    }
                }
            }
        }
        self.closers(node, steps);
    }

    /// `IF condition statement`: the statement follows on the same line.
    fn compact(&mut self, node: Node<'_>, steps: usize) {
        let Some(statement) = node.children().nth(1) else { return };
        // What continues the inner statement is indented further than it is on a line of its own.
        self.fill(statement, steps + 1);
        self.inside(statement, steps);
        self.begin(statement.range().start, steps, Start::Inside);
        let token = self.token(statement.range().start);
        if let Some(compact) = self.layout.compact.get_mut(token) {
            *compact = true;
        }
    }
}

fn begins_line(kind: NodeKind) -> bool {
    kind.is_statement()
        || kind.is_routine()
        || matches!(
            kind,
            NodeKind::Module
                | NodeKind::DataDeclaration
                | NodeKind::RecordDeclaration
                | NodeKind::RecordComponent
                | NodeKind::AliasDeclaration
                | NodeKind::BackwardHandler
                | NodeKind::ErrorHandler
                | NodeKind::UndoHandler
                | NodeKind::ElseIfBranch
                | NodeKind::ElseBranch
                | NodeKind::CaseBranch
                | NodeKind::DefaultBranch
                | NodeKind::Placeholder
        )
}

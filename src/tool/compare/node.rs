//! The statements of a routine as a tree whose nodes are compared.
//!
//! A block statement is a node, its statements are the children. `ELSEIF`, `ELSE`, `CASE` and
//! `DEFAULT` are nodes among the children, and a handler is a node beside the statements of the body.
//! Deleting the node of an `IF` leaves its statements where they are.

use std::collections::BTreeMap;

use super::canonical::Writer;
use super::parts::{Part, parts};
use crate::rapid::ir::hir::{Block, Expr, Routine, Stmt, StmtKind};
use crate::rapid::text::Span;

/// A node of the tree.
pub(super) struct Node<'a> {
    pub(super) label: Label<'a>,
    pub(super) span: Span,
    /// Number of the node in preorder.
    pub(super) id: usize,
    /// Number of the canonical text of the node alone.
    pub(super) own: u32,
    /// Number of the canonical text of the node with all below.
    pub(super) whole: u32,
    /// The arguments with the numbers of their canonical texts.
    pub(super) parts: Vec<(Part<'a>, u32)>,
    pub(super) children: Vec<Node<'a>>,
}

/// What a node stands for.
#[derive(Clone, Copy)]
pub(super) enum Label<'a> {
    /// A statement; of a block only the header.
    Statement(&'a Stmt),
    /// With the start of its first statement.
    ElseIf(&'a Expr, Option<u32>),
    Else,
    Case(&'a [Expr]),
    Default,
    Backward,
    Error(&'a [Expr]),
    Undo,
}

/// Numbers for canonical texts, common to both sides.
#[derive(Default)]
pub(super) struct Interner {
    texts: BTreeMap<String, u32>,
    trees: BTreeMap<(u32, Vec<u32>), u32>,
}

impl Interner {
    fn text(&mut self, text: String) -> u32 {
        let next = (self.texts.len() + self.trees.len()) as u32;
        *self.texts.entry(text).or_insert(next)
    }

    fn tree(&mut self, own: u32, children: &[Node<'_>]) -> u32 {
        let next = (self.texts.len() + self.trees.len()) as u32;
        let below = children.iter().map(|child| child.whole).collect();
        *self.trees.entry((own, below)).or_insert(next)
    }
}

/// Builds the nodes of one side.
pub(super) struct Builder<'b> {
    pub(super) writer: Writer<'b>,
    pub(super) interner: &'b mut Interner,
    next: usize,
}

impl<'b> Builder<'b> {
    pub(super) fn new(writer: Writer<'b>, interner: &'b mut Interner) -> Builder<'b> {
        Builder { writer, interner, next: 0 }
    }

    /// The body and the handlers of a routine.
    pub(super) fn routine<'a>(&mut self, routine: &'a Routine) -> Vec<Node<'a>> {
        let mut nodes = self.block(&routine.body);
        let around = |block: &Block, otherwise: Span| match (block.first(), block.last()) {
            (Some(first), Some(last)) => first.span.to(last.span),
            _ => otherwise,
        };
        let end = Span { start: routine.span.end, ..routine.span };
        if let Some(block) = &routine.backward {
            nodes.push(self.node(Label::Backward, around(block, end), &[block], &[]));
        }
        for (numbers, block) in &routine.error {
            let span = numbers.first().map_or_else(|| around(block, end), |number| number.span);
            nodes.push(self.node(Label::Error(numbers), span, &[block], &[]));
        }
        if let Some(block) = &routine.undo {
            nodes.push(self.node(Label::Undo, around(block, end), &[block], &[]));
        }
        nodes
    }

    // The depth of statements is limited by the parser.
    fn block<'a>(&mut self, block: &'a Block) -> Vec<Node<'a>> {
        let is_code =
            |stmt: &&Stmt| !matches!(stmt.kind, StmtKind::Data(_) | StmtKind::Placeholder);
        block.iter().filter(is_code).map(|stmt| self.statement(stmt)).collect()
    }

    fn statement<'a>(&mut self, stmt: &'a Stmt) -> Node<'a> {
        let label = Label::Statement(stmt);
        match &stmt.kind {
            StmtKind::If { branches, otherwise } => {
                let first: Vec<&Block> =
                    branches.first().map(|(_, block)| block).into_iter().collect();
                let mut branches: Vec<Branch<'a>> = branches
                    .iter()
                    .skip(1)
                    .map(|(condition, block)| {
                        let first = block.first().map(|stmt| stmt.span.start);
                        (Label::ElseIf(condition, first), condition.span, block)
                    })
                    .collect();
                branches
                    .extend(otherwise.as_ref().map(|block| (Label::Else, end(stmt, block), block)));
                self.node(label, stmt.span, &first, &branches)
            }
            StmtKind::For { body, .. } | StmtKind::While { body, .. } => {
                self.node(label, stmt.span, &[body], &[])
            }
            StmtKind::Test { cases, default, .. } => {
                let mut branches: Vec<Branch<'a>> = cases
                    .iter()
                    .map(|(values, block)| {
                        let span =
                            values.first().map_or_else(|| end(stmt, block), |value| value.span);
                        (Label::Case(values), span, block)
                    })
                    .collect();
                branches.extend(
                    default.as_ref().map(|block| (Label::Default, end(stmt, block), block)),
                );
                self.node(label, stmt.span, &[], &branches)
            }
            _ => self.node(label, stmt.span, &[], &[]),
        }
    }

    fn node<'a>(
        &mut self,
        label: Label<'a>,
        span: Span,
        blocks: &[&'a Block],
        branches: &[Branch<'a>],
    ) -> Node<'a> {
        let id = self.next;
        self.next += 1;
        let mut children: Vec<Node<'a>> = Vec::new();
        for block in blocks {
            children.extend(self.block(block));
        }
        for (label, span, block) in branches {
            children.push(self.node(*label, *span, &[block], &[]));
        }
        let text = label.text(&self.writer);
        let own = self.interner.text(text);
        let whole = if children.is_empty() { own } else { self.interner.tree(own, &children) };
        let parts = match label {
            Label::Statement(stmt) => parts(stmt),
            _ => Vec::new(),
        };
        let numbered = |part: Part<'a>| {
            let text = part.value.map_or_else(String::new, |value| self.writer.expr(value));
            (part, self.interner.text(text))
        };
        let parts = parts.into_iter().map(numbered).collect();
        Node { label, span, id, own, whole, parts, children }
    }
}

type Branch<'a> = (Label<'a>, Span, &'a Block);

/// A place for a branch without a value: its first statement, else the end of the statement.
fn end(stmt: &Stmt, block: &Block) -> Span {
    let end = Span { start: stmt.span.end.saturating_sub(1), ..stmt.span };
    block.first().map_or(end, |first| first.span)
}

impl Label<'_> {
    /// The canonical text.
    pub(super) fn text(&self, writer: &Writer<'_>) -> String {
        let list = |values: &[Expr]| {
            values.iter().map(|value| writer.expr(value)).collect::<Vec<_>>().join(",")
        };
        match self {
            Label::Statement(stmt) => writer.statement(stmt),
            Label::ElseIf(condition, first) => {
                format!("ELSEIF {} THEN", writer.header(*first, condition))
            }
            Label::Else => "ELSE".to_owned(),
            Label::Case(values) => format!("CASE {}:", list(values)),
            Label::Default => "DEFAULT:".to_owned(),
            Label::Backward => "BACKWARD".to_owned(),
            Label::Error([]) => "ERROR".to_owned(),
            Label::Error(numbers) => format!("ERROR ({})", list(numbers)),
            Label::Undo => "UNDO".to_owned(),
        }
    }

    /// The word with which it begins, for messages.
    pub(super) fn word(&self) -> &'static str {
        match self {
            Label::Statement(stmt) => match &stmt.kind {
                StmtKind::If { .. } => "IF",
                StmtKind::For { .. } => "FOR",
                StmtKind::While { .. } => "WHILE",
                StmtKind::Test { .. } => "TEST",
                _ => "",
            },
            Label::ElseIf(..) => "ELSEIF",
            Label::Else => "ELSE",
            Label::Case(_) => "CASE",
            Label::Default => "DEFAULT",
            Label::Backward => "BACKWARD",
            Label::Error(_) => "ERROR",
            Label::Undo => "UNDO",
        }
    }

    /// Whether it has statements of its own.
    pub(super) fn is_block(&self) -> bool {
        !self.word().is_empty()
    }
}

impl<'a> Node<'a> {
    /// The node and all below, in preorder.
    pub(super) fn subtree(&self) -> Vec<&Node<'a>> {
        let mut open = vec![self];
        let mut all = Vec::new();
        while let Some(node) = open.pop() {
            all.push(node);
            open.extend(node.children.iter().rev());
        }
        all
    }
}

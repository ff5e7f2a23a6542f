//! Parts of a document that can be folded.

use gen_lsp_types::{FoldingRange, FoldingRangeKind};

use super::workspace::View;
use crate::rapid::syntax::{Node, NodeKind, TokenKind};

/// The parts of several lines: modules, routines, blocks, long data, comments.
pub(super) fn folding_ranges(view: View<'_>) -> Vec<FoldingRange> {
    let tree = &view.project.module(view.file).parse().tree;
    let lines = &view.project.module(view.file).file.lines;
    let line = |byte: u32| lines.position(byte).line - 1;
    let mut found = Vec::new();
    let mut add = |start: u32, end: u32, kind: Option<FoldingRangeKind>| {
        if start < end {
            found.push(FoldingRange {
                start_line: start,
                start_character: None,
                end_line: end,
                end_character: None,
                kind,
                collapsed_text: None,
            });
        }
    };
    for node in tree.nodes() {
        let range = node.range();
        match kind(node) {
            Fold::No => {}
            // The line of the end stays visible.
            Fold::Closed => add(line(range.start), line(range.end).saturating_sub(1), None),
            Fold::Open => add(line(range.start), line(range.end), None),
        }
    }
    let tokens = tree.tokens();
    let mut comment: Option<(u32, u32)> = None;
    let mut is_first = true;
    for index in 0..tokens.count() {
        let range = tokens.range(index);
        match tokens.kind(index) {
            TokenKind::Whitespace => {
                is_first |= line(range.end) > line(range.start);
                continue;
            }
            TokenKind::Comment if is_first => {
                let own = line(range.start);
                comment = match comment {
                    Some((start, end)) if end + 1 == own => Some((start, own)),
                    other => {
                        if let Some((start, end)) = other {
                            add(start, end, Some(FoldingRangeKind::Comment));
                        }
                        Some((own, own))
                    }
                };
            }
            _ => {
                if let Some((start, end)) = comment.take() {
                    add(start, end, Some(FoldingRangeKind::Comment));
                }
            }
        }
        is_first = false;
    }
    if let Some((start, end)) = comment {
        add(start, end, Some(FoldingRangeKind::Comment));
    }
    found.sort_by_key(|one| (one.start_line, std::cmp::Reverse(one.end_line)));
    found
}

/// How a node is folded.
enum Fold {
    No,
    /// Up to a last line that is a word of its own.
    Closed,
    /// Up to its end.
    Open,
}

fn kind(node: Node<'_>) -> Fold {
    match node.kind() {
        NodeKind::Module
        | NodeKind::RecordDeclaration
        | NodeKind::ProcDeclaration
        | NodeKind::FuncDeclaration
        | NodeKind::TrapDeclaration
        | NodeKind::IfStatement
        | NodeKind::ForStatement
        | NodeKind::WhileStatement
        | NodeKind::TestStatement => Fold::Closed,
        NodeKind::DataDeclaration
        | NodeKind::CallStatement
        | NodeKind::Assignment
        | NodeKind::ElseIfBranch
        | NodeKind::ElseBranch
        | NodeKind::CaseBranch
        | NodeKind::DefaultBranch
        | NodeKind::ErrorHandler
        | NodeKind::BackwardHandler
        | NodeKind::UndoHandler => Fold::Open,
        _ => Fold::No,
    }
}

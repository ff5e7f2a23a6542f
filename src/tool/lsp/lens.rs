//! Time and energy beside the text: above routines and behind movements and waits.

use gen_lsp_types::{CodeLens, Command, InlayHint, Range, SymbolKind};

use super::costs::{Costs, StatementCosts, of_parts, of_statements};
use super::findings::Analysis;
use super::outline::{Symbol, outline};
use super::position::Positions;
use super::workspace::View;
use crate::rapid::text::Span;

/// What each routine takes in a cycle, with the routines that it calls.
pub(super) fn code_lenses(view: View<'_>, analysis: &Analysis) -> Vec<CodeLens> {
    let mut routines = Vec::new();
    for symbol in outline(view.project.module(view.file)) {
        add_routines(symbol, &mut routines);
    }
    // The file has another number in the programs of the linter.
    let file = analysis.file.id;
    let parts: Vec<Span> = routines.iter().map(|it| Span { file, ..it.whole }).collect();
    let lens = |(routine, costs): (&Symbol, Option<Costs>)| {
        let title = format!("{} a cycle", costs?);
        // A command without a name is text.
        let command = Some(Command { title, ..Command::default() });
        Some(CodeLens { range: view.positions().range(routine.place), command, data: None })
    };
    routines.iter().zip(of_parts(analysis, &parts)).filter_map(lens).collect()
}

fn add_routines(symbol: Symbol, to: &mut Vec<Symbol>) {
    match symbol.kind {
        SymbolKind::Function | SymbolKind::Event => to.push(symbol),
        _ => symbol.children.into_iter().for_each(|child| add_routines(child, to)),
    }
}

/// What the movements and waits in a range take in a cycle.
pub(super) fn inlay_hints(
    positions: Positions<'_>,
    analysis: &Analysis,
    range: &Range,
) -> Vec<InlayHint> {
    let (start, end) = (positions.byte(range.start), positions.byte(range.end));
    let statements = of_statements(analysis).into_iter();
    let shown = statements.filter(|one| start <= one.span.end && one.span.end <= end);
    let hint = |one: StatementCosts| InlayHint {
        position: positions.range(one.span).end,
        label: one.costs.to_string().into(),
        kind: None,
        text_edits: None,
        tooltip: None,
        padding_left: Some(true),
        padding_right: None,
        data: None,
    };
    shown.map(hint).collect()
}

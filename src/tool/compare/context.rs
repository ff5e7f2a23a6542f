//! Both sides of what is compared: source texts, values, places.

use std::collections::BTreeSet;

use super::canonical::Writer;
use super::exact::same_expr;
use super::names::Names;
use super::side::Half;
use super::values::{Difference, DifferenceKind, differences};
use crate::rapid::ir::exec::evaluate;
use crate::rapid::ir::hir::{Expr, ExprKind};
use crate::rapid::ir::value::{Datum, Value};
use crate::rapid::text::{SourceFile, Span};

/// Longest text of the source in a message, in characters.
const LONGEST: usize = 60;

/// A module, and possibly a routine in it, on both sides.
pub(super) struct Context<'a> {
    pub(super) old: &'a Half<'a>,
    pub(super) new: &'a Half<'a>,
    /// Indices of the modules.
    pub(super) modules: [usize; 2],
    /// The old names.
    pub(super) names: &'a Names<'a>,
    /// Names that a value at module level cannot have: those of the routines, old and new.
    pub(super) locals: [BTreeSet<&'a str>; 2],
}

/// How two expressions differ.
pub(super) struct Reworded {
    /// Both texts, or only what differs between long ones.
    pub(super) message: String,
    pub(super) differences: Vec<Difference>,
}

impl Context<'_> {
    /// Writes canonical text of the old side, with the new names.
    pub(super) fn old_writer(&self) -> Writer<'_> {
        Writer { files: self.old.files, names: self.names }
    }

    /// How two expressions differ; `None` if they mean the same. `type_key`: their type, if known.
    pub(super) fn reworded(&self, type_key: &str, old: &Expr, new: &Expr) -> Option<Reworded> {
        let identity = Names::default();
        let new_writer = Writer { files: self.new.files, names: &identity };
        let is_same_text = self.old_writer().expr(old) == new_writer.expr(new);
        if is_same_text && same_expr(old, new) {
            return None;
        }
        let values = self.values(type_key, old, new);
        let found = values.map(|(ty, old, new)| differences(&self.new.program, &ty, &old, &new));
        let literal = |expr: &Expr| read_names(expr).is_empty();
        if found.as_ref().is_some_and(Vec::is_empty) && literal(old) && literal(new) {
            return None;
        }
        let (before, after) = (source(self.old.files, old.span), source(self.new.files, new.span));
        let found = found.unwrap_or_default();
        let is_plain = matches!(
            found.as_slice(),
            [Difference { path, kind: DifferenceKind::Value(_) }] if path.is_empty()
        );
        let words = words(&found);
        let is_list = |expr: &Expr| matches!(expr.kind, ExprKind::Aggregate(_));
        let message = if is_list(old) && is_list(new) && !words.is_empty() {
            words
        } else if words.is_empty() || is_plain && literal(old) && literal(new) {
            format!("{before} → {after}")
        } else {
            format!("{before} → {after} ({words})")
        };
        Some(Reworded { message, differences: found })
    }

    /// The values of two expressions with their type, if both are known.
    fn values(&self, type_key: &str, old: &Expr, new: &Expr) -> Option<(String, Datum, Datum)> {
        let value = |half: &Half<'_>, side: usize, expr: &Expr| -> Option<Value> {
            let is_local = |name: &str| self.locals[side].contains(name);
            if read_names(expr).into_iter().any(is_local) {
                return None;
            }
            let value = evaluate(&half.program, self.modules[side], expr);
            value.datum.first_unknown().is_none().then_some(value)
        };
        let (old, new) = (value(self.old, 0, old)?, value(self.new, 1, new)?);
        let of_value = if new.type_key.is_empty() { &old.type_key } else { &new.type_key };
        let ty = if type_key.is_empty() { of_value.to_string() } else { type_key.to_owned() };
        Some((ty, old.datum, new.datum))
    }
}

/// Several differences in one line.
pub(super) fn words(differences: &[Difference]) -> String {
    let one = |difference: &Difference| {
        let words = difference.kind.words();
        if difference.path.is_empty() || is_obvious(&difference.path, &difference.kind) {
            words
        } else {
            format!("{} {words}", difference.path)
        }
    };
    differences.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// Whether the words tell which component of a target differs.
fn is_obvious(path: &str, kind: &DifferenceKind) -> bool {
    match kind {
        DifferenceKind::Value(_) => false,
        _ => matches!(path, "trans" | "rot" | "robconf" | "extax" | "robax"),
    }
}

/// The names of data, functions and signals in an expression, in lower case.
pub(super) fn read_names(expr: &Expr) -> BTreeSet<&str> {
    let mut names = BTreeSet::new();
    let mut open = vec![expr];
    while let Some(expr) = open.pop() {
        match &expr.kind {
            ExprKind::Ref(name) | ExprKind::Call(name, _) => {
                names.insert(name.key.as_str());
            }
            _ => {}
        }
        open.extend(expr.parts());
    }
    names
}

/// The source of a span in one line, shortened.
pub(super) fn source(files: &[SourceFile], span: Span) -> String {
    let Some(file) = files.get(span.file.0 as usize) else { return String::new() };
    // Enough for the characters that are shown, whatever the size of the span.
    let end = span.end.min(span.start.saturating_add(16 * LONGEST as u32));
    let text = file.text(Span { end, ..span });
    let line = without_comments(&text);
    let mut short: String = line.chars().take(LONGEST).collect();
    if short.len() < line.len() || end < span.end {
        short.push('…');
    }
    short.trim_end_matches(';').to_owned()
}

/// Words with single blanks, and no comments.
fn without_comments(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let mut quoted = false;
        let end = line.char_indices().find(|(_, c)| {
            quoted ^= *c == '"';
            *c == '!' && !quoted
        });
        &line[..end.map_or(line.len(), |(at, _)| at)]
    });
    let joined = lines.collect::<Vec<_>>().join(" ");
    joined.split_whitespace().collect::<Vec<_>>().join(" ")
}

//! Components and elements that a routine has by reference.
//!
//! The parameter has a cell of its own while the routine runs, and the data that it is a part of are
//! unknown meanwhile. What is written to a part by one name is unknown by every other name.

use super::eval::store;
use super::executor::{CellId, Executor, LentPart};
use crate::rapid::ir::hir::{Expr, ExprKind, Param, ParamMode};
use crate::rapid::ir::value::{Datum, Origin};

impl Executor<'_> {
    /// A part that is passed by reference, bound to its parameter. Its indices are evaluated once.
    pub(super) fn part_by_reference(&mut self, param: &Param, expr: &Expr) -> Option<LentPart> {
        if param.mode == ParamMode::In || matches!(expr.kind, ExprKind::Ref(_)) {
            return None;
        }
        let whole = self.cell_of(expr.base()?).filter(|whole| !self.cells[*whole].read_only)?;
        self.seen_input = None;
        let mut origin = Origin::default();
        let expr = self.with_fixed_indices(expr, &mut origin);
        let by_index = self.seen_input.take();
        let type_key = self.cells[whole].value.type_key.clone();
        let indices = self.place(&expr, &type_key).map(|(indices, _)| indices);
        let parameter = self.bind(param, &expr);
        let cell = &mut self.cells[parameter];
        cell.input = cell.input.take().or(by_index);
        cell.value.origin.join(&origin);
        let span = expr.span;
        Some(LentPart { parameter, whole, indices, span, is_written: false, is_stale: false })
    }

    /// The expression with its indices as numbers; an unknown one has no place. Adds the origin of the
    /// indices.
    fn with_fixed_indices(&mut self, expr: &Expr, origin: &mut Origin) -> Expr {
        let kind = match &expr.kind {
            ExprKind::Field(base, name) => {
                ExprKind::Field(Box::new(self.with_fixed_indices(base, origin)), name.clone())
            }
            ExprKind::Index(base, indices) => {
                let base = Box::new(self.with_fixed_indices(base, origin));
                let fixed = indices.iter().map(|index| {
                    let value = self.eval(index);
                    origin.join(&value.origin);
                    let kind = value.datum.num().map_or(ExprKind::Placeholder, ExprKind::Num);
                    Expr { kind, span: index.span }
                });
                ExprKind::Index(base, fixed.collect())
            }
            other => other.clone(),
        };
        Expr { kind, span: expr.span }
    }

    /// Makes the data unknown that a routine has parts of. Returns them with their values.
    pub(super) fn lend(&mut self, parts: Vec<LentPart>) -> Vec<(CellId, Datum)> {
        let mut wholes: Vec<(CellId, Datum)> = Vec::new();
        for part in &parts {
            if wholes.iter().all(|(whole, _)| *whole != part.whole) {
                let slot = &mut self.cells[part.whole].value.datum;
                wholes.push((part.whole, std::mem::replace(slot, part.unknown())));
            }
        }
        self.lent.extend(parts);
        wholes
    }

    /// Ends the loan of the parts behind the first `kept`: stores what the routine wrote to them.
    pub(super) fn take_back(&mut self, kept: usize, wholes: Vec<(CellId, Datum)>) {
        let ended = self.lent.split_off(kept);
        for (whole, datum) in wholes {
            let parts: Vec<&LentPart> = ended.iter().filter(|part| part.whole == whole).collect();
            let is_written = parts.iter().any(|part| part.is_written);
            let is_unknown = parts.iter().enumerate().any(|(n, part)| {
                part.is_stale
                    || is_written
                        && (part.indices.is_none() || parts[..n].iter().any(|o| o.overlaps(part)))
            });
            self.cells[whole].value.datum = if is_unknown { parts[0].unknown() } else { datum };
            for part in parts.into_iter().filter(|part| part.is_written) {
                let from = &self.cells[part.parameter];
                let (datum, history, input) =
                    (from.value.datum.clone(), from.history.clone(), from.input.clone());
                let to = &mut self.cells[whole];
                to.history.join(&history);
                to.input = input.or(to.input.take());
                if let (false, Some(indices)) = (is_unknown, &part.indices) {
                    store(&mut to.value.datum, indices, datum);
                }
            }
            if is_written || is_unknown {
                self.mark_other_names(whole);
                self.record_change(Some(whole));
            }
        }
    }

    /// A cell was written: whatever may be the same data by another name is unknown.
    pub(super) fn mark_other_names(&mut self, cell: CellId) {
        self.mark_parts_stale(cell);
        let mut written = cell;
        // What is written to a part is written to what it is a part of.
        while let Some(own) = self.lent.iter().position(|part| part.parameter == written) {
            self.lent[own].is_written = true;
            for other in 0..self.lent.len() {
                if other != own && self.lent[other].overlaps(&self.lent[own]) {
                    let unknown = self.lent[other].unknown();
                    let parameter = self.lent[other].parameter;
                    self.cells[parameter].value.datum = unknown;
                    self.mark_parts_stale(parameter);
                }
            }
            written = self.lent[own].whole;
        }
    }

    /// The lent parts of a cell, and their parts, are unknown, and so is the cell.
    fn mark_parts_stale(&mut self, cell: CellId) {
        for k in 0..self.lent.len() {
            if self.lent[k].whole == cell {
                self.lent[k].is_stale = true;
                let (unknown, parameter) = (self.lent[k].unknown(), self.lent[k].parameter);
                self.cells[cell].value.datum = unknown.clone();
                self.cells[parameter].value.datum = unknown;
                self.mark_parts_stale(parameter);
            }
        }
    }
}

//! A place of the text that may be changed, and how.

use crate::rapid::ir::number::number;
use crate::rapid::text::{Edit, Span};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;

/// Decimals of a shifted number, mm or degrees.
const DECIMALS: usize = 2;

/// A place that may be changed.
pub(super) struct Lever {
    /// The place.
    pub(super) span: Span,
    /// What may go wrong.
    pub(super) risk: &'static str,
    /// Where the robot still has to be at the same places.
    pub(super) kept: Kept,
    /// The alternatives.
    pub(super) offers: Offers,
}

/// The alternatives at a place.
pub(super) enum Offers {
    /// These.
    List(Vec<Offer>),
    /// Any shift of a point.
    Shift(Shift),
    /// Any order of visits.
    Order(Visits),
}

/// One change.
#[derive(Clone)]
pub(super) struct Offer {
    /// In words, such as "z50 in place of z20".
    pub(super) title: String,
    pub(super) edits: Vec<Edit>,
}

/// The numbers of a place, and how far they may be shifted.
pub(super) struct Shift {
    pub(super) span: Span,
    /// Their values, mm or degrees.
    pub(super) values: Vec<f64>,
    /// Name of the point.
    pub(super) name: String,
    pub(super) unit: &'static str,
    /// First step.
    pub(super) step: f64,
    /// Largest shift.
    pub(super) most: f64,
}

impl Shift {
    /// The offer of a shift.
    pub(super) fn offer(&self, shift: &[f64]) -> Offer {
        let moved = self.values.iter().zip(shift).map(|(x, by)| number(x + by, DECIMALS));
        let by: Vec<String> = shift.iter().map(|by| format!("{by:+.0}")).collect();
        Offer {
            title: format!("{} shifted by {} {}", self.name, by.join(", "), self.unit),
            edits: vec![Edit {
                span: self.span,
                text: format!("[{}]", moved.collect::<Vec<_>>().join(",")).into_bytes(),
            }],
        }
    }
}

/// Statements whose order is free.
pub(super) struct Visits {
    pub(super) spans: Vec<Span>,
    pub(super) texts: Vec<String>,
}

/// Longest part of a statement in a title.
const SHOWN: usize = 30;

impl Visits {
    /// The offer of an order: the statement with the number `order[i]` in the place of number i.
    pub(super) fn offer(&self, order: &[usize]) -> Offer {
        let shown = |of: &usize| self.texts[*of].chars().take(SHOWN).collect::<String>();
        let edit = |(span, of): (&Span, &usize)| Edit {
            span: *span,
            text: self.texts[*of].clone().into_bytes(),
        };
        Offer {
            title: format!("order {}", order.iter().map(shown).collect::<Vec<_>>().join(" ")),
            edits: self.spans.iter().zip(order).map(edit).collect(),
        }
    }
}

/// The text of a span.
pub(super) fn written(context: &Context<'_>, span: Span) -> String {
    context.files[span.file.0 as usize].text(span).trim().to_owned()
}

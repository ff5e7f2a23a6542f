//! Types in messages.

use super::context::Context;
use super::types::{Type, is_basic};
use crate::rapid::names::Basic;

/// A type for messages: `num`, `num{*}`.
pub(super) fn describe(context: &Context<'_>, ty: Type) -> String {
    match ty {
        Type::Unknown => "of unknown type".to_owned(),
        Type::Number => "a number".to_owned(),
        Type::Aggregate => "a list in brackets".to_owned(),
        Type::Of(id, 0) if is_basic(&context.names, id, &[Basic::Number]) => {
            "num or dnum".to_owned()
        }
        Type::Of(id, 0) => context.shown(id),
        Type::Of(id, dimensions) => {
            let stars = vec!["*"; usize::from(dimensions)].join(",");
            format!("{}{{{stars}}}", context.shown(id))
        }
    }
}

//! Whether a value fits where it is put.

use super::context::{Context, Place};
use super::describe::describe;
use super::expressions::type_of;
use super::fault::error;
use super::types::{Type, as_value, is_basic, scalar, stated};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Basic, Kind};
use crate::rapid::syntax::NodeKind;

/// Deepest nesting of lists that is compared.
const MAX_DEPTH: u32 = 16;

/// Whether a value of one type can be given where another is needed. Lists are looked at elsewhere.
pub(super) fn fits(context: &Context<'_>, wanted: Type, given: Type) -> bool {
    let basics = &context.basics;
    let [num, dnum] = [basics.num, basics.dnum].map(scalar);
    if let Type::Of(id, 0) = wanted {
        if is_basic(&context.names, id, &[Basic::SemiValue]) {
            return given == wanted || given == Type::Unknown;
        }
        if is_basic(&context.names, id, &[Basic::Number]) {
            let given = as_value(&context.names, given);
            return [num, dnum, Type::Number, Type::Unknown].contains(&given);
        }
    }
    match (wanted, as_value(&context.names, given)) {
        (Type::Unknown, _) | (_, Type::Unknown | Type::Aggregate) => true,
        (_, Type::Number) => wanted == num || wanted == dnum,
        (_, given) => wanted == given,
    }
}

/// Compares a value with the type that its place needs; `what` begins the message.
pub(super) fn compare(
    context: &Context<'_>,
    what: &str,
    wanted: Type,
    value: Place<'_>,
    out: &mut Vec<Diagnostic>,
) {
    if value.is_broken() {
        return;
    }
    let given = type_of(context, value);
    if given == Type::Aggregate {
        list(context, wanted, unwrapped(value), MAX_DEPTH, out);
    } else if !fits(context, wanted, given) {
        let [num, dnum] = [context.basics.num, context.basics.dnum].map(scalar);
        let help = match (wanted, given) {
            _ if (wanted, given) == (num, dnum) => "convert it with DnumToNum".to_owned(),
            _ if (wanted, given) == (dnum, num) => "convert it with NumToDnum".to_owned(),
            _ if wanted == scalar(context.basics.string) => {
                "convert it with NumToStr or ValToStr".to_owned()
            }
            (Type::Of(_, 0), Type::Of(_, 1..)) => "choose an element with {…}".to_owned(),
            _ => format!("give a value of type {}", describe(context, wanted)),
        };
        let (needed, found) = (describe(context, wanted), describe(context, given));
        let message = format!("{what} needs {needed}, this is {found}");
        out.push(error("type", value.span(), message, help));
    }
}

fn unwrapped(place: Place<'_>) -> Place<'_> {
    let mut at = place;
    while at.kind() == NodeKind::Parenthesized
        && let Some(inner) = at.children().next()
    {
        at = inner;
    }
    at
}

/// Compares a list with the record or array that its place needs.
fn list(
    context: &Context<'_>,
    wanted: Type,
    place: Place<'_>,
    depth: u32,
    out: &mut Vec<Diagnostic>,
) {
    let Type::Of(id, dimensions) = wanted else { return };
    if depth == 0 {
        return;
    }
    let names = &context.names;
    if dimensions > 0 {
        for part in place.children() {
            element(context, Type::Of(id, dimensions - 1), part, depth, out);
        }
        return;
    }
    if names.declaration(id).kind != Kind::Record {
        let message = format!("a list in brackets is not of type {}", context.shown(id));
        let help = format!("give one value of type {}", context.shown(id));
        out.push(error("type", place.span(), message, help));
        return;
    }
    let components: Vec<_> = names.inside(id).collect();
    let count = place.children().count();
    if count != components.len() {
        let name = context.shown(id);
        let parts: Vec<String> = components.iter().map(|part| context.shown(*part)).collect();
        let message = format!("{name} has {} components, this list has {count}", components.len());
        out.push(error(
            "components",
            place.span(),
            message,
            format!("give [{}]", parts.join(", ")),
        ));
        return;
    }
    for (part, component) in place.children().zip(components) {
        element(context, stated(names, names.declaration(component).value), part, depth, out);
    }
}

fn element(
    context: &Context<'_>,
    wanted: Type,
    part: Place<'_>,
    depth: u32,
    out: &mut Vec<Diagnostic>,
) {
    let value = unwrapped(part);
    if value.kind() == NodeKind::Aggregate {
        list(context, wanted, value, depth - 1, out);
    } else {
        compare(context, "this component", wanted, part, out);
    }
}

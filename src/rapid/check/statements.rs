//! Types in statements and declarations: assignments, conditions, first values, indices.

use super::context::{Context, Place};
use super::describe::describe;
use super::expressions::{operators, type_of};
use super::fault::{error, with_place};
use super::types::{Type, is_basic, scalar, stated};
use super::values::{compare, fits};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Basic, DeclarationId, Kind, Meaning, Storage};
use crate::rapid::syntax::NodeKind;

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    let num = scalar(context.basics.num);
    let bool = scalar(context.basics.bool);
    for place in context.nodes() {
        let mut children = place.children();
        match place.kind() {
            NodeKind::Assignment => assignment(context, place, out),
            NodeKind::DataDeclaration => declaration(context, place, out),
            NodeKind::IfStatement
            | NodeKind::ElseIfBranch
            | NodeKind::CompactIf
            | NodeKind::WhileStatement => {
                if let Some(condition) = children.next().filter(|one| one.kind().is_value()) {
                    compare(context, "this condition", bool, condition, out);
                }
            }
            NodeKind::ForStatement => {
                for bound in children.filter(|child| child.kind().is_value()) {
                    compare(context, "a bound of FOR", num, bound, out);
                }
            }
            NodeKind::ForStep => {
                if let Some(step) = children.next() {
                    compare(context, "the step of FOR", num, step, out);
                }
            }
            NodeKind::TestStatement => cases(context, place, out),
            NodeKind::IndexAccess => index(context, place, out),
            NodeKind::UnaryExpression | NodeKind::BinaryExpression if !place.is_broken() => {
                operators(context, place, out);
            }
            _ => {}
        }
    }
}

/// The data whose part a variable is.
fn root(place: Place<'_>) -> Option<Place<'_>> {
    let mut at = place;
    while matches!(at.kind(), NodeKind::FieldAccess | NodeKind::IndexAccess) {
        at = at.children().next()?;
    }
    (at.kind() == NodeKind::Reference).then_some(at)
}

fn assignment(context: &Context<'_>, place: Place<'_>, out: &mut Vec<Diagnostic>) {
    let mut sides = place.children();
    let (Some(variable), Some(value)) = (sides.next(), sides.next()) else { return };
    if place.is_broken() {
        return;
    }
    if let Some(data) = root(variable)
        && let Some(finding) = read_only(context, data)
    {
        out.push(finding);
        return;
    }
    let wanted = type_of(context, variable);
    if let Type::Of(id, _) = wanted
        && is_basic(&context.names, id, &[Basic::SemiValue, Basic::NonValue])
    {
        let name = context.shown(id);
        let help = if is_basic(&context.names, id, &[Basic::SemiValue]) {
            "set an output with SetDO, SetGO or SetAO"
        } else {
            "pass it to the routines that take it"
        };
        let message = format!("nothing can be assigned to data of type {name}");
        out.push(error("assignment", variable.span(), message, help.to_owned()));
        return;
    }
    compare(context, "this variable", wanted, value, out);
}

fn read_only(context: &Context<'_>, data: Place<'_>) -> Option<Diagnostic> {
    let name = data.text();
    match context.use_at(data)?.meaning {
        Meaning::Predefined(_) => Some(error(
            "assignment",
            data.span(),
            format!("{name} is a predefined constant and cannot be assigned to"),
            "declare data of your own with another name".to_owned(),
        )),
        Meaning::Declared(id) => {
            let declaration = context.names.declaration(id);
            match declaration.kind {
                Kind::Data(Storage::Const) => Some(declared_here(
                    context,
                    id,
                    error(
                        "assignment",
                        data.span(),
                        format!("{name} is a CONST and cannot be assigned to"),
                        "declare it as VAR or PERS".to_owned(),
                    ),
                )),
                Kind::Counter => Some(error(
                    "assignment",
                    data.span(),
                    format!("{name} is the counter of a FOR and cannot be assigned to"),
                    "use a WHILE, or a variable of its own".to_owned(),
                )),
                _ => None,
            }
        }
        _ => None,
    }
}

fn declared_here(context: &Context<'_>, id: DeclarationId, finding: Diagnostic) -> Diagnostic {
    if context.names.is_predefined(id) {
        return finding;
    }
    with_place(finding, context.names.declaration(id).name, "declared here")
}

/// The first value of data, and the sizes of an array.
fn declaration(context: &Context<'_>, place: Place<'_>, out: &mut Vec<Diagnostic>) {
    let Some(id) = place.child(NodeKind::Name).and_then(|name| context.declared(name)) else {
        return;
    };
    let Some(value) = place.children().last().filter(|child| child.kind().is_value()) else {
        return;
    };
    if place.is_broken() {
        return;
    }
    let wanted = stated(&context.names, context.names.declaration(id).value);
    if let Type::Of(_, 1..) = wanted
        && let Some(dimensions) = place.child(NodeKind::Dimensions)
    {
        let sizes: Vec<Option<usize>> =
            dimensions.children().map(|size| size.text().trim().parse().ok()).collect();
        if let Some(finding) = lengths(value, &sizes) {
            out.push(finding);
            return;
        }
    }
    compare(context, "this first value", wanted, value, out);
}

/// The first list that has not as many elements as the array.
fn lengths(value: Place<'_>, sizes: &[Option<usize>]) -> Option<Diagnostic> {
    let (size, inner) = sizes.split_first()?;
    if value.kind() != NodeKind::Aggregate {
        return None;
    }
    let count = value.children().count();
    if let Some(size) = size
        && *size != count
    {
        return Some(error(
            "components",
            value.span(),
            format!("this dimension of the array has {size} elements, the list has {count}"),
            format!("give {size} elements, or declare {count}"),
        ));
    }
    value.children().find_map(|element| lengths(element, inner))
}

fn cases(context: &Context<'_>, place: Place<'_>, out: &mut Vec<Diagnostic>) {
    let mut children = place.children();
    let Some(tested) = children.next().filter(|one| one.kind().is_value()) else { return };
    if tested.is_broken() {
        return;
    }
    let wanted = super::types::as_value(&context.names, type_of(context, tested));
    let wanted = if wanted == Type::Number { scalar(context.basics.num) } else { wanted };
    for branch in children.filter(|child| child.kind() == NodeKind::CaseBranch) {
        for value in branch.children().filter(|child| child.kind().is_value()) {
            compare(context, "this CASE", wanted, value, out);
        }
    }
}

fn index(context: &Context<'_>, place: Place<'_>, out: &mut Vec<Diagnostic>) {
    if place.is_broken() {
        return;
    }
    let mut children = place.children();
    let Some(array) = children.next() else { return };
    let indices: Vec<Place<'_>> = children.collect();
    if let Type::Of(_, dimensions) = type_of(context, array)
        && usize::from(dimensions) != indices.len()
    {
        let name = array.text();
        let (message, help) = if dimensions == 0 {
            (format!("{name} is no array"), "remove the index, or declare an array".to_owned())
        } else {
            let plural = if dimensions == 1 { "" } else { "s" };
            let message = format!(
                "{name} has {dimensions} dimension{plural}, this access gives {}",
                indices.len()
            );
            (message, format!("give {dimensions} index{}", if dimensions == 1 { "" } else { "es" }))
        };
        out.push(error("dimensions", place.span(), message, help));
    }
    let num = scalar(context.basics.num);
    let dnum = scalar(context.basics.dnum);
    for one in indices {
        let given = type_of(context, one);
        if !fits(context, num, given) && given != dnum {
            let message = format!("an index needs num, this is {}", describe(context, given));
            out.push(error("type", one.span(), message, "give a number".to_owned()));
        }
    }
}

//! Types of expressions, and what is wrong inside them.

use super::context::{Context, Place};
use super::describe::describe;
use super::fault::error;
use super::types::{Type, as_value, scalar, stated};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Kind, Meaning};
use crate::rapid::syntax::{NodeKind, Token, TokenKind};

/// The type of an expression.
pub(super) fn type_of(context: &Context<'_>, place: Place<'_>) -> Type {
    let basics = &context.basics;
    let names = &context.names;
    match place.kind() {
        NodeKind::NumberLiteral => Type::Number,
        NodeKind::StringLiteral => scalar(basics.string),
        NodeKind::BoolLiteral => scalar(basics.bool),
        NodeKind::Aggregate => Type::Aggregate,
        NodeKind::Parenthesized => {
            place.children().next().map_or(Type::Unknown, |inner| type_of(context, inner))
        }
        NodeKind::Reference => named(context, place),
        NodeKind::FunctionCall => {
            place.children().next().map_or(Type::Unknown, |name| named(context, name))
        }
        NodeKind::FieldAccess => {
            place.child(NodeKind::Name).map_or(Type::Unknown, |name| named(context, name))
        }
        NodeKind::IndexAccess => match place.children().next().map(|array| type_of(context, array))
        {
            Some(Type::Of(id, _)) => Type::Of(id, 0),
            _ => Type::Unknown,
        },
        NodeKind::UnaryExpression if place.node.own_token(TokenKind::Not).is_some() => {
            scalar(basics.bool)
        }
        NodeKind::UnaryExpression => place
            .children()
            .next()
            .map_or(Type::Unknown, |inner| as_value(names, type_of(context, inner))),
        NodeKind::BinaryExpression => binary(context, place),
        _ => Type::Unknown,
    }
}

fn named(context: &Context<'_>, name: Place<'_>) -> Type {
    let names = &context.names;
    match context.use_at(name).map(|one| one.meaning) {
        Some(Meaning::Declared(id)) => match names.declaration(id).kind {
            Kind::Routine(_)
            | Kind::Data(_)
            | Kind::Parameter(_)
            | Kind::Counter
            | Kind::Component => stated(names, names.declaration(id).value),
            _ => Type::Unknown,
        },
        Some(Meaning::Predefined(value)) => stated(names, value),
        _ => Type::Unknown,
    }
}

/// The operator of a binary expression.
fn operator(place: Place<'_>) -> Option<TokenKind> {
    place.node.own_tokens().next().map(Token::kind)
}

fn operands(context: &Context<'_>, place: Place<'_>) -> Option<(Type, Type)> {
    let mut sides = place.children();
    let (left, right) = (sides.next()?, sides.next()?);
    let value = |side| as_value(&context.names, type_of(context, side));
    Some((value(left), value(right)))
}

fn binary(context: &Context<'_>, place: Place<'_>) -> Type {
    let (Some(operator), Some((left, right))) = (operator(place), operands(context, place)) else {
        return Type::Unknown;
    };
    if !is_arithmetic(operator) {
        return scalar(context.basics.bool);
    }
    arithmetic(context, operator, left, right).unwrap_or(Type::Unknown)
}

fn is_arithmetic(operator: TokenKind) -> bool {
    matches!(
        operator,
        TokenKind::Plus
            | TokenKind::Minus
            | TokenKind::Star
            | TokenKind::Slash
            | TokenKind::Div
            | TokenKind::Mod
    )
}

/// The type of the result; `None` if the operator does not take these operands.
fn arithmetic(context: &Context<'_>, operator: TokenKind, left: Type, right: Type) -> Option<Type> {
    let basics = &context.basics;
    let [num, dnum, string, pos, orient] =
        [basics.num, basics.dnum, basics.string, basics.pos, basics.orient].map(scalar);
    if left == Type::Unknown || right == Type::Unknown {
        return Some(Type::Unknown);
    }
    let is_num = |ty| ty == num || ty == Type::Number;
    let is_dnum = |ty| ty == dnum || ty == Type::Number;
    if left == Type::Number && right == Type::Number {
        return Some(Type::Number);
    }
    if is_num(left) && is_num(right) {
        return Some(num);
    }
    if is_dnum(left) && is_dnum(right) {
        return Some(dnum);
    }
    match operator {
        // A list of numbers can be a position or an orientation.
        _ if left == Type::Aggregate || right == Type::Aggregate => Some(Type::Unknown),
        TokenKind::Plus if left == string && right == string => Some(string),
        TokenKind::Plus | TokenKind::Minus | TokenKind::Star if left == pos && right == pos => {
            Some(pos)
        }
        TokenKind::Star if left == pos && is_num(right) || is_num(left) && right == pos => {
            Some(pos)
        }
        TokenKind::Slash if left == pos && is_num(right) => Some(pos),
        TokenKind::Star if left == orient && right == orient => Some(orient),
        _ => None,
    }
}

/// What is wrong with the operators of an expression.
pub(super) fn operators(context: &Context<'_>, place: Place<'_>, out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let bool = scalar(context.basics.bool);
    let wrong = |message: String, help: &str| error("type", place.span(), message, help.to_owned());
    if place.kind() == NodeKind::UnaryExpression {
        let Some(inner) = place.children().next() else { return };
        let ty = as_value(names, type_of(context, inner));
        if place.node.own_token(TokenKind::Not).is_some() && !is(ty, bool) {
            out.push(wrong(
                format!("NOT needs a bool, this is {}", describe(context, ty)),
                "compare it, such as x = 0",
            ));
        }
        return;
    }
    let (Some(operator), Some((left, right))) = (operator(place), operands(context, place)) else {
        return;
    };
    let shown = || format!("{} and {}", describe(context, left), describe(context, right));
    let word = operator.describe();
    if matches!(operator, TokenKind::And | TokenKind::Or | TokenKind::Xor) {
        if !is(left, bool) || !is(right, bool) {
            out.push(wrong(
                format!("{word} needs two bools, these are {}", shown()),
                "compare each side, such as x = 1",
            ));
        }
    } else if is_arithmetic(operator) {
        if arithmetic(context, operator, left, right).is_none() {
            out.push(wrong(
                format!("{word} does not take {}", shown()),
                "convert one side, with NumToStr, ValToStr, NumToDnum or DnumToNum",
            ));
        }
    } else if !comparable(context, left, right) {
        out.push(wrong(
            format!("{word} compares values of one type, these are {}", shown()),
            "compare with a value of the same type",
        ));
    }
}

fn is(ty: Type, wanted: Type) -> bool {
    ty == wanted || matches!(ty, Type::Unknown) || wanted == Type::Unknown
}

fn comparable(context: &Context<'_>, left: Type, right: Type) -> bool {
    let number = |ty| {
        ty == Type::Number || ty == scalar(context.basics.num) || ty == scalar(context.basics.dnum)
    };
    match (left, right) {
        (Type::Unknown, _) | (_, Type::Unknown) => true,
        (Type::Aggregate, other) | (other, Type::Aggregate) => {
            !number(other) || matches!(other, Type::Of(_, 1..))
        }
        (Type::Number, other) | (other, Type::Number) => number(other),
        (Type::Of(..), Type::Of(..)) => left == right,
    }
}

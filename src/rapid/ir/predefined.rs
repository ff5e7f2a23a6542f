//! Values of predefined data.

use super::value::{Datum, Value};
use crate::rapid::builtins::{Literal, predefined};

/// The value of a predefined name; `key` in lower case.
pub fn lookup(key: &str) -> Option<Value> {
    let data = predefined(key)?;
    Some(Value::constant(datum(data.value), data.type_name))
}

fn datum(literal: Literal) -> Datum {
    match literal {
        Literal::Num(x) => Datum::Num(x),
        Literal::Bool(b) => Datum::Bool(b),
        Literal::Text(text) => Datum::Text(text.into()),
        Literal::List(items) => Datum::List(items.into_iter().map(datum).collect()),
    }
}

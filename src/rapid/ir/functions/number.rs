//! Functions of numbers and vectors that return a number.

use super::arguments::{EvaluatedArguments, Function, TypedDatum, num};
use crate::rapid::ir::value::Datum;

/// The function of a name in lower case; a function of `dnum` equals that of `num`.
pub(super) fn lookup(name: &str) -> Option<Function> {
    let function: Function = match name.strip_suffix("dnum").unwrap_or(name) {
        "abs" => |g| num(g.num(0)?.abs()),
        "sin" => |g| num(g.num(0)?.to_radians().sin()),
        "cos" => |g| num(g.num(0)?.to_radians().cos()),
        "tan" => |g| num(g.num(0)?.to_radians().tan()),
        "asin" => |g| num(g.num(0)?.asin().to_degrees()),
        "acos" => |g| num(g.num(0)?.acos().to_degrees()),
        "atan" => |g| num(g.num(0)?.atan().to_degrees()),
        "atan2" => |g| num(g.num(0)?.atan2(g.num(1)?).to_degrees()),
        "sqrt" => |g| num(g.num(0)?.sqrt()),
        "pow" => |g| num(g.num(0)?.powf(g.num(1)?)),
        "exp" => |g| num(g.num(0)?.exp()),
        "round" => |g| decimals(g, f64::round),
        "trunc" => |g| decimals(g, f64::trunc),
        // `NumToDnum` without its suffix, and `DnumToNum`
        "numto" | "dnumtonum" => |g| num(g.num(0)?),
        "dim" => dimension,
        "distance" => |g| num((g.vector(0)? - g.vector(1)?).norm()),
        "vectmagn" => |g| num(g.vector(0)?.norm()),
        "dotprod" => |g| num(g.vector(0)?.dot(&g.vector(1)?)),
        _ => return None,
    };
    Some(function)
}

/// `Round` and `Trunc` with `\Dec`.
fn decimals(arguments: &EvaluatedArguments<'_>, step: fn(f64) -> f64) -> Option<TypedDatum> {
    let scale = 10_f64.powf(arguments.option("dec", 0.0)?);
    num(step(arguments.num(0)? * scale) / scale)
}

/// `Dim(array, n)`: size of the n-th dimension.
fn dimension(arguments: &EvaluatedArguments<'_>) -> Option<TypedDatum> {
    let mut datum = *arguments.args.first()?;
    for _ in 1..arguments.num(1)? as usize {
        let Datum::List(items) = datum else { return None };
        datum = items.first()?;
    }
    let Datum::List(items) = datum else { return None };
    num(items.len() as f64)
}

//! Bit functions: 8 bits for `byte`, 52 for `dnum`.

use super::arguments::{EvaluatedArguments, Function, TypedDatum, boolean};
use crate::rapid::ir::value::Datum;

/// The function of a name in lower case.
pub(super) fn lookup(name: &str) -> Option<Function> {
    let function: Function = match name {
        "bitand" | "bitanddnum" => |g| two(g, |a, b| a & b),
        "bitor" | "bitordnum" => |g| two(g, |a, b| a | b),
        "bitxor" | "bitxordnum" => |g| two(g, |a, b| a ^ b),
        "bitneg" => |g| Some(number(!bits(g, 0)? & mask(8), 8)),
        "bitnegdnum" => |g| Some(number(!bits(g, 0)? & mask(52), 52)),
        "bitlsh" => |g| Some(number(shifted_left(g)? & mask(8), 8)),
        "bitlshdnum" => |g| Some(number(shifted_left(g)? & mask(52), 52)),
        "bitrsh" | "bitrshdnum" => |g| {
            let shifted = bits(g, 0)?.checked_shr(bits(g, 1)? as u32)?;
            Some(number(shifted, 52))
        },
        // The lowest bit is number 1.
        "bitcheck" | "bitcheckdnum" => |g| {
            let place = bits(g, 1)?.checked_sub(1)?;
            Some(boolean(bits(g, 0)?.checked_shr(place as u32)? & 1 == 1))
        },
        _ => return None,
    };
    Some(function)
}

const fn mask(width: u32) -> u64 {
    (1 << width) - 1
}

fn bits(arguments: &EvaluatedArguments<'_>, index: usize) -> Option<u64> {
    let x = arguments.num(index)?;
    (x >= 0.0 && x <= mask(52) as f64 && x.fract() == 0.0).then_some(x as u64)
}

fn shifted_left(arguments: &EvaluatedArguments<'_>) -> Option<u64> {
    bits(arguments, 0)?.checked_shl(bits(arguments, 1)? as u32)
}

fn two(arguments: &EvaluatedArguments<'_>, f: fn(u64, u64) -> u64) -> Option<TypedDatum> {
    Some(number(f(bits(arguments, 0)?, bits(arguments, 1)?), 52))
}

fn number(bits: u64, width: u32) -> TypedDatum {
    let type_key = if width == 8 { "byte" } else { "num" };
    (Datum::Num(bits as f64), type_key)
}

//! Functions of strings. Positions count from 1.

use super::arguments::{EvaluatedArguments, Function, TypedDatum, boolean, num};
use crate::rapid::ir::value::Datum;

/// Significant digits of a `num` as text.
const NUM_DIGITS: i32 = 6;

/// The function of a name in lower case.
pub(super) fn lookup(name: &str) -> Option<Function> {
    let function: Function = match name {
        "strlen" => |g| num(g.text(0)?.chars().count() as f64),
        "strpart" => |g| {
            let from = start(g)?;
            let length = g.num(2).filter(|length| *length >= 0.0)? as usize;
            let part: Vec<char> = g.text(0)?.chars().skip(from).take(length).collect();
            // A part beyond the end of the string is an error on the controller.
            (part.len() == length).then(|| string(part.into_iter().collect()))
        },
        "strfind" => |g| {
            let inside = !g.has("notinset");
            let set = g.text(2)?;
            let found = |c: char| set.contains(c) == inside;
            position(g, |rest| rest.first().copied().is_some_and(found))
        },
        "strmatch" => |g| {
            let pattern: Vec<char> = g.text(2)?.chars().collect();
            position(g, |rest| rest.starts_with(&pattern))
        },
        "strmemb" => |g| {
            let set = g.text(2)?;
            Some(boolean(set.contains(g.text(0)?.chars().nth(start(g)?)?)))
        },
        "strmap" => |g| {
            let to: Vec<char> = g.text(2)?.chars().collect();
            let from: Vec<char> = g.text(1)?.chars().collect();
            let map = |c| from.iter().position(|f| *f == c).and_then(|i| to.get(i)).copied();
            Some(string(g.text(0)?.chars().map(|c| map(c).unwrap_or(c)).collect()))
        },
        "numtostr" | "dnumtostr" => |g| {
            let decimals = g.num(1)?.clamp(0.0, 15.0) as usize;
            let x = g.num(0)?;
            Some(string(if g.has("exp") {
                exponential(x, decimals)
            } else {
                format!("{x:.decimals$}")
            }))
        },
        "valtostr" => |g| Some(string(written(g.args.first()?)?)),
        "bytetostr" => byte_to_string,
        "strtobyte" => string_to_byte,
        _ => return None,
    };
    Some(function)
}

fn string(text: String) -> TypedDatum {
    (Datum::Text(text.into()), "string")
}

/// The second argument, a position in the string, converted to count from 0.
fn start(arguments: &EvaluatedArguments<'_>) -> Option<usize> {
    arguments.num(1).filter(|at| *at >= 1.0).map(|at| at as usize - 1)
}

/// The first position that fits, from the second argument on; else the one after the string.
fn position(
    arguments: &EvaluatedArguments<'_>,
    fits: impl Fn(&[char]) -> bool,
) -> Option<TypedDatum> {
    let text: Vec<char> = arguments.text(0)?.chars().collect();
    let from = start(arguments)?;
    let at = (from..text.len()).find(|at| fits(&text[*at..])).unwrap_or(text.len());
    num(at as f64 + 1.0)
}

/// `1.43E+05`
fn exponential(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$E}");
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, exponent) = exponent.strip_prefix('-').map_or(('+', exponent), |e| ('-', e));
    format!("{digits}E{sign}{exponent:0>2}")
}

/// A value as RAPID writes it.
fn written(datum: &Datum) -> Option<String> {
    Some(match datum {
        Datum::Num(x) => significant(*x),
        Datum::Bool(true) => "TRUE".to_owned(),
        Datum::Bool(false) => "FALSE".to_owned(),
        Datum::Text(text) => format!("\"{text}\""),
        Datum::List(items) => {
            let items: Option<Vec<String>> = items.iter().map(written).collect();
            format!("[{}]", items?.join(","))
        }
        Datum::Signal(_) | Datum::Unknown(_) => return None,
    })
}

/// A number with the significant digits of a `num`, without trailing zeros.
fn significant(x: f64) -> String {
    let exponent = if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    if (-5..NUM_DIGITS).contains(&exponent) {
        let decimals = (NUM_DIGITS - 1 - exponent) as usize;
        let text = format!("{x:.decimals$}");
        if text.contains('.') {
            return text.trim_end_matches('0').trim_end_matches('.').to_owned();
        }
        return text;
    }
    let text = exponential(x, NUM_DIGITS as usize - 1);
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "+00"));
    format!("{}E{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
}

/// `ByteToStr(122 \Hex)`
fn byte_to_string(arguments: &EvaluatedArguments<'_>) -> Option<TypedDatum> {
    let byte = arguments.num(0).filter(|x| (0.0..256.0).contains(x))? as u8;
    Some(string(match arguments.options.first().map(|(name, _)| *name) {
        None => format!("{byte}"),
        Some("hex") => format!("{byte:02X}"),
        Some("okt") => format!("{byte:03o}"),
        Some("bin") => format!("{byte:08b}"),
        Some("char") => char::from(byte).to_string(),
        Some(_) => return None,
    }))
}

/// `StrToByte("7A" \Hex)`
fn string_to_byte(arguments: &EvaluatedArguments<'_>) -> Option<TypedDatum> {
    let text = arguments.text(0)?;
    let radix = match arguments.options.first().map(|(name, _)| *name) {
        None => 10,
        Some("hex") => 16,
        Some("okt") => 8,
        Some("bin") => 2,
        Some("char") => return num(f64::from(u8::try_from(text.chars().next()?).ok()?)),
        Some(_) => return None,
    };
    let value = f64::from(u8::from_str_radix(text, radix).ok()?);
    Some((Datum::Num(value), "byte"))
}

//! Values as RAPID text.

use crate::rapid::ir::value::Datum;

/// Values from here on represent RAPID's 9E9: no axis.
pub(super) const NO_AXIS: f64 = 9e8;

/// RAPID text that reads back as the same value; `None` if there is no text.
pub(super) fn literal(datum: &Datum) -> Option<String> {
    match datum {
        Datum::Num(x) if x.is_finite() => Some(num(*x)),
        Datum::Bool(b) => Some(if *b { "TRUE" } else { "FALSE" }.to_owned()),
        Datum::Text(text) => {
            Some(format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\"\"")))
        }
        Datum::List(items) => {
            let parts: Option<Vec<String>> = items.iter().map(literal).collect();
            Some(format!("[{}]", parts?.join(",")))
        }
        _ => None,
    }
}

/// A number with the fewest digits that identify the `num`.
fn num(x: f64) -> String {
    if x >= NO_AXIS { "9E9".to_owned() } else { (x as f32).to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_read_as_the_same_nums() {
        for x in [0.1, 1.0 / 3.0, -1_234.567_89, 1e-7, 0.000_526_794] {
            let text = num(x);
            assert_eq!(text.parse::<f64>().map(|y| y as f32), Ok(x as f32), "{text}");
            assert!(!text.contains('e'), "{text}");
        }
        let quoted = literal(&Datum::Text("a\"b\\c".into()));
        assert_eq!(quoted.as_deref(), Some("\"a\"\"b\\\\c\""));
        assert_eq!(num(9e9), "9E9");
    }
}

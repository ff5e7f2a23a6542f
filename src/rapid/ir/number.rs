//! Numbers as RAPID text.

/// Decimals of an axis position in degrees. More than the six or seven digits of a `num`: a
/// simulation of the emitted text stays close to the original simulation.
pub const JOINT_DECIMALS: usize = 6;
/// Decimals of a time in seconds.
pub const TIME_DECIMALS: usize = 4;

/// A number with at most this many decimals, without trailing zeros.
pub fn number(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text.as_str()
    };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Axis positions in degrees, from rad.
pub fn joints(q: &[f64]) -> String {
    let parts: Vec<String> = q.iter().map(|x| number(x.to_degrees(), JOINT_DECIMALS)).collect();
    parts.join(",")
}

/// An axis position after writing it as text and reading it back, rad.
pub fn joint_as_emitted(x: f64) -> f64 {
    let scale = f64::from(10_u32.pow(JOINT_DECIMALS as u32));
    ((x.to_degrees() * scale).round() / scale).to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_plain() {
        assert_eq!(number(12.5, 5), "12.5");
        assert_eq!(number(-0.000_001, 4), "0");
        assert_eq!(number(100.0, 0), "100");
        assert_eq!(number(1.0 / 3.0, 4), "0.3333");
    }
}

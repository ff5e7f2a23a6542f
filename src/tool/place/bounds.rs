//! How far frames may move: the option `--move`.

use super::error::PlaceError;

/// The axes of a shift in the world frame: translations, then rotations about the axes.
pub const AXES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
/// Largest translation, mm.
const FARTHEST_MM: f64 = 10_000.0;
/// Largest rotation, degrees.
const WIDEST_DEG: f64 = 180.0;

/// Frames that move together, and how far.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Their names.
    pub names: Vec<String>,
    /// Bounds by axis, m and rad; none for an axis along which they do not move.
    pub axes: [Option<[f64; 2]>; 6],
}

impl Bounds {
    /// Reads `NAME+NAME:x=-200..200,rz=-30..30` (mm, degrees).
    ///
    /// # Errors
    /// A text of another form, unknown or repeated axes, empty or too wide ranges.
    pub fn parse(text: &str) -> Result<Bounds, PlaceError> {
        let wrong = |reason: String| PlaceError::Option { text: text.to_owned(), reason };
        let (names, ranges) =
            text.split_once(':').ok_or_else(|| wrong("it has no ':' after the name".into()))?;
        let names: Vec<String> = names.split('+').map(|name| name.trim().to_owned()).collect();
        if names.iter().any(String::is_empty) {
            return Err(wrong("a name is missing".into()));
        }
        let mut axes = [None; 6];
        for part in ranges.split(',') {
            let part = part.trim();
            let (name, range) = part
                .split_once('=')
                .ok_or_else(|| wrong(format!("'{part}' is no AXIS=LOW..HIGH")))?;
            let axis = AXES.iter().position(|axis| axis.eq_ignore_ascii_case(name.trim()));
            let axis = axis.ok_or_else(|| wrong(format!("'{}' is no axis", name.trim())))?;
            let ends = range.split_once("..");
            let ends = ends.and_then(|(low, high)| {
                Some([low.trim().parse::<f64>().ok()?, high.trim().parse::<f64>().ok()?])
            });
            let [low, high] = ends.ok_or_else(|| wrong(format!("'{range}' is no LOW..HIGH")))?;
            let (most, unit) = if axis < 3 { (FARTHEST_MM, "mm") } else { (WIDEST_DEG, "degrees") };
            if !(low < high && low.abs() <= most && high.abs() <= most) {
                return Err(wrong(format!(
                    "'{range}' has to increase and to stay within {most} {unit}"
                )));
            }
            let scale = if axis < 3 { 1e-3 } else { 1_f64.to_radians() };
            if axes[axis].replace([low * scale, high * scale]).is_some() {
                return Err(wrong(format!("{} is stated twice", AXES[axis])));
            }
        }
        Ok(Bounds { names, axes })
    }

    /// Number of axes along which they move.
    #[must_use]
    pub fn freedom(&self) -> usize {
        self.axes.iter().flatten().count()
    }

    /// The shift at a point of the unit cube, m and rad.
    #[must_use]
    pub fn shift(&self, point: &[f64]) -> [f64; 6] {
        let mut point = point.iter();
        self.axes.map(|axis| match axis {
            Some([low, high]) => low + (high - low) * point.next().copied().unwrap_or(0.5),
            None => 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the arithmetic of a shift may lose, m.
    const ROUNDING_M: f64 = 1e-12;

    #[test]
    fn bounds_are_read_in_mm_and_degrees() {
        let bounds = Bounds::parse("wobjA + wobjB: x=-200..100, rz=-90..90").expect("valid");
        assert_eq!(bounds.names, ["wobjA", "wobjB"]);
        assert_eq!(bounds.axes[0], Some([-0.2, 0.1]));
        assert_eq!(bounds.freedom(), 2);
        let shift = bounds.shift(&[1.0, 0.5]);
        assert!((shift[0] - 0.1).abs() < ROUNDING_M, "{shift:?}");
        assert_eq!(shift[1..], [0.0; 5]);
    }

    #[test]
    fn wrong_bounds_are_named() {
        for (text, part) in [
            ("wobjA", "no ':'"),
            ("wobjA:", "AXIS=LOW..HIGH"),
            ("wobjA:q=1..2", "'q' is no axis"),
            ("wobjA:x=1", "'1' is no LOW..HIGH"),
            ("wobjA:x=2..1", "increase"),
            ("wobjA:x=-nan..1", "increase"),
            ("wobjA:x=0..1e9", "within 10000 mm"),
            ("wobjA:rz=-200..0", "within 180 degrees"),
            ("wobjA:x=0..1,x=0..2", "twice"),
            ("+wobjA:x=0..1", "name is missing"),
        ] {
            let error = Bounds::parse(text).expect_err(text).to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}

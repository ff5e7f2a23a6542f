//! Values in TOML notation, numbers with an exponent: `toml_edit` writes 1e-34 without one, in 36
//! characters.

use std::fmt::Write;

use nalgebra::Isometry3;

/// Cosine of the pitch below which it is ±π/2 and only the sum of roll and yaw is defined.
const UPRIGHT: f64 = 1e-9;

/// The shortest text of a number that reads back exactly.
pub(super) fn number(value: f64) -> String {
    // Adding 0 removes the sign of −0.
    format!("{:?}", value + 0.0)
}

/// A list of numbers in that form.
pub(super) fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| number(*value)).collect();
    format!("[{}]", values.join(", "))
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// The entries `origin` \[m\] and `rpy` \[rad\] of a pose.
pub(super) fn pose_entries(pose: &Isometry3<f64>) -> [(&'static str, String); 2] {
    let r = pose.rotation.to_rotation_matrix();
    let level = r[(0, 0)].hypot(r[(1, 0)]);
    let pitch = (-r[(2, 0)]).atan2(level);
    let (roll, yaw) = if level < UPRIGHT {
        ((-r[(1, 2)]).atan2(r[(1, 1)]), 0.0)
    } else {
        (r[(2, 1)].atan2(r[(2, 2)]), r[(1, 0)].atan2(r[(0, 0)]))
    };
    [("origin", list(pose.translation.vector.as_slice())), ("rpy", list(&[roll, pitch, yaw]))]
}

/// The lines of these entries.
pub(super) fn pose(pose: &Isometry3<f64>) -> String {
    pose_entries(pose).map(|(key, value)| format!("{key} = {value}\n")).concat()
}

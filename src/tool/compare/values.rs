//! What differs between two values of a RAPID type, in RAPID's units: mm, degrees, kg, s.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::number::same;
use crate::rapid::ir::program::Program;
use crate::rapid::ir::value::Datum;

/// An external axis that does not exist.
const NO_AXIS: f64 = 9e9;
/// Deepest nesting of records and arrays that is looked into.
const MAX_DEPTH: usize = 16;

/// A difference between two values.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The component, such as `tframe.trans` or `{3}`; empty for the value itself.
    pub path: String,
    /// What differs.
    pub kind: DifferenceKind,
}

/// The kinds of differences.
#[derive(Clone, Debug, PartialEq)]
pub enum DifferenceKind {
    /// A position: how far, and along x, y, z, mm.
    Position([f64; 3]),
    /// An orientation: the angle between both, degrees.
    Orientation(f64),
    /// The configuration, old and new.
    Configuration([[f64; 4]; 2]),
    /// Robot axes, degrees each: new minus old.
    Axes([f64; 6]),
    /// An external axis (from 0), old and new in mm or degrees; `None` if it does not exist.
    External(usize, [Option<f64>; 2]),
    /// Any other value, old and new as text.
    Value([String; 2]),
}

/// The differences between two values of a type; empty if both mean the same.
pub(super) fn differences(
    program: &Program,
    type_key: &str,
    old: &Datum,
    new: &Datum,
) -> Vec<Difference> {
    let mut found = Vec::new();
    let at = At { program, depth: 0 };
    at.compare(type_key, String::new(), old, new, &mut found);
    found
}

#[derive(Clone, Copy)]
struct At<'a> {
    program: &'a Program,
    depth: usize,
}

impl At<'_> {
    fn compare(
        self,
        type_key: &str,
        path: String,
        old: &Datum,
        new: &Datum,
        found: &mut Vec<Difference>,
    ) {
        let mut add = |kind| found.push(Difference { path: path.clone(), kind });
        let numbers = (numbers(old), numbers(new));
        match (type_key, &numbers) {
            ("pos", (Some(a), Some(b))) => {
                if let (Ok(a), Ok(b)) = (triple(a), triple(b)) {
                    if a.iter().zip(&b).any(|(a, b)| !same(*a, *b)) {
                        let by = |i: usize| if same(a[i], b[i]) { 0.0 } else { b[i] - a[i] };
                        add(DifferenceKind::Position([0, 1, 2].map(by)));
                    }
                    return;
                }
            }
            ("orient", (Some(a), Some(b))) => {
                if let Some(angle) = turned(a, b) {
                    if angle > 0.0 {
                        add(DifferenceKind::Orientation(angle));
                    }
                    return;
                }
            }
            ("confdata", (Some(a), Some(b))) => {
                if let (Ok(a), Ok(b)) =
                    (<[f64; 4]>::try_from(a.as_slice()), <[f64; 4]>::try_from(b.as_slice()))
                {
                    if a != b {
                        add(DifferenceKind::Configuration([a, b]));
                    }
                    return;
                }
            }
            ("robjoint", (Some(a), Some(b))) => {
                if let (Ok(a), Ok(b)) =
                    (<[f64; 6]>::try_from(a.as_slice()), <[f64; 6]>::try_from(b.as_slice()))
                {
                    if a.iter().zip(&b).any(|(a, b)| !same(*a, *b)) {
                        let moved = |i: usize| if same(a[i], b[i]) { 0.0 } else { b[i] - a[i] };
                        add(DifferenceKind::Axes(std::array::from_fn(moved)));
                    }
                    return;
                }
            }
            ("extjoint", (Some(a), Some(b))) if a.len() == b.len() => {
                let axis = |x: f64| (x < 0.99 * NO_AXIS).then_some(x);
                for (index, (a, b)) in a.iter().zip(b).enumerate() {
                    if !same(*a, *b) && (axis(*a).is_some() || axis(*b).is_some()) {
                        add(DifferenceKind::External(index, [axis(*a), axis(*b)]));
                    }
                }
                return;
            }
            _ => {}
        }
        self.other(type_key, path, old, new, found);
    }

    fn other(
        self,
        type_key: &str,
        path: String,
        old: &Datum,
        new: &Datum,
        found: &mut Vec<Difference>,
    ) {
        if let (Datum::List(a), Datum::List(b)) = (old, new)
            && a.len() == b.len()
            && self.depth < MAX_DEPTH
        {
            let components = self.program.components(type_key);
            // A list that is not a record of this type is an array of it.
            let components = components.filter(|_| self.fits(type_key, old));
            let below = At { depth: self.depth + 1, ..self };
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                let (path, ty) = match &components {
                    Some(parts) => {
                        let (name, ty) = &parts[index];
                        let dot = if path.is_empty() { "" } else { "." };
                        (format!("{path}{dot}{name}"), ty.as_str())
                    }
                    None => (format!("{path}{{{}}}", index + 1), type_key),
                };
                below.compare(ty, path, a, b, found);
            }
            return;
        }
        let equal = match (old, new) {
            (Datum::Num(a), Datum::Num(b)) => same(*a, *b),
            (Datum::Bool(a), Datum::Bool(b)) => a == b,
            (Datum::Text(a), Datum::Text(b)) => a == b,
            (Datum::Signal(a), Datum::Signal(b)) => a.to_lowercase() == b.to_lowercase(),
            // Unknown values are compared as text by the callers.
            (Datum::Unknown(_), Datum::Unknown(_)) => true,
            _ => false,
        };
        if !equal {
            let kind = DifferenceKind::Value([text(old), text(new)]);
            found.push(Difference { path, kind });
        }
    }

    /// Whether a value has the components of a type.
    fn fits(self, type_key: &str, value: &Datum) -> bool {
        let below = At { depth: self.depth + 1, ..self };
        match (value, self.program.components(type_key)) {
            _ if self.depth >= MAX_DEPTH => false,
            (Datum::List(items), Some(parts)) => {
                items.len() == parts.len()
                    && items.iter().zip(&parts).all(|(item, (_, ty))| below.fits(ty, item))
            }
            (Datum::List(_), None) => false,
            (Datum::Unknown(_), _) => true,
            (_, components) => components.is_none(),
        }
    }
}

fn numbers(datum: &Datum) -> Option<Vec<f64>> {
    match datum {
        Datum::List(items) => items.iter().map(Datum::num).collect(),
        _ => None,
    }
}

fn triple(list: &[f64]) -> Result<[f64; 3], std::array::TryFromSliceError> {
    list.try_into()
}

/// The angle between two orientations, degrees; `q` and `−q` are the same one.
fn turned(old: &[f64], new: &[f64]) -> Option<f64> {
    let (Ok(a), Ok(b)) = (<[f64; 4]>::try_from(old), <[f64; 4]>::try_from(new)) else {
        return None;
    };
    let alike = |sign: f64| a.iter().zip(&b).all(|(a, b)| same(*a, sign * b));
    if alike(1.0) || alike(-1.0) {
        return Some(0.0);
    }
    let unit = |[w, x, y, z]: [f64; 4]| {
        let quaternion = Quaternion::new(w, x, y, z);
        (quaternion.norm() > 0.0).then(|| UnitQuaternion::from_quaternion(quaternion))
    };
    Some(unit(a)?.angle_to(&unit(b)?).to_degrees())
}

/// A value as RAPID writes it.
pub(super) fn text(datum: &Datum) -> String {
    match datum {
        Datum::Num(x) => format!("{}", x + 0.0),
        Datum::Bool(true) => "TRUE".to_owned(),
        Datum::Bool(false) => "FALSE".to_owned(),
        Datum::Text(text) => format!("\"{text}\""),
        Datum::List(items) => {
            format!("[{}]", items.iter().map(text).collect::<Vec<_>>().join(","))
        }
        Datum::Signal(name) => name.to_string(),
        Datum::Unknown(_) => "?".to_owned(),
    }
}

impl DifferenceKind {
    /// In words: `moved by 12.5 mm (x +12.5)`.
    pub fn words(&self) -> String {
        match self {
            DifferenceKind::Position(by) => {
                let axes = ["x", "y", "z"].iter().zip(by).filter(|(_, by)| **by != 0.0);
                let axes: Vec<String> =
                    axes.map(|(axis, by)| format!("{axis} {}", signed(*by, 3))).collect();
                let far = Vector3::from(*by).norm();
                format!("moved by {} mm ({})", rounded(far, 3), axes.join(", "))
            }
            DifferenceKind::Orientation(angle) => format!("turned by {}°", rounded(*angle, 3)),
            DifferenceKind::Configuration([old, new]) => {
                let list = |conf: &[f64; 4]| conf.map(|x| format!("{x}")).join(",");
                format!("configuration [{}] → [{}]", list(old), list(new))
            }
            DifferenceKind::Axes(by) => {
                let axes = by.iter().enumerate().filter(|(_, by)| **by != 0.0);
                let axes: Vec<String> = axes
                    .map(|(axis, by)| format!("axis {} by {}°", axis + 1, signed(*by, 3)))
                    .collect();
                axes.join(", ")
            }
            DifferenceKind::External(axis, values) => {
                let [old, new] = values.map(|x| x.map_or("none".to_owned(), |x| format!("{x}")));
                let letter = char::from(b'a' + (*axis).min(5) as u8);
                format!("external axis {letter} {old} → {new}")
            }
            DifferenceKind::Value([old, new]) => format!("{old} → {new}"),
        }
    }
}

/// At most this many decimals, more for small numbers.
fn rounded(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    let is_zero = text.bytes().all(|byte| matches!(byte, b'0' | b'.' | b'-'));
    if is_zero && x != 0.0 {
        return format!("{x:.1e}");
    }
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

fn signed(x: f64, decimals: usize) -> String {
    let text = rounded(x.abs(), decimals);
    if x < 0.0 { format!("\u{2212}{text}") } else { format!("+{text}") }
}

//! Changes that rules propose: edits of the text, and the same in the simulated steps.

use super::context::Context;
use super::site::Site;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::{Movement, Settings, Speed, Zone};
use crate::rapid::text::{Edit, Span};
use crate::retime::motion::Step;

/// Predefined zones: name, path and orientation size, mm.
const ZONES: [(&str, f64, f64); 6] = [
    ("z1", 1.0, 1.0),
    ("z5", 5.0, 8.0),
    ("z10", 10.0, 15.0),
    ("z20", 20.0, 30.0),
    ("z50", 50.0, 75.0),
    ("z100", 100.0, 150.0),
];
/// Predefined speeds, mm/s.
const SPEEDS: [u32; 20] = [
    50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000,
    6000, 7000,
];

/// Turning speed of the predefined speeds, rad/s: 500 °/s.
pub(super) const PREDEFINED_TURN: f64 = 8.726_646;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NamedZone {
    /// `z10` …
    pub(super) name: &'static str,
    /// Its sizes.
    pub(super) zone: Zone,
}

/// The largest predefined zone whose size is at most `most`, m.
pub(super) fn zone_within(most: f64) -> Option<NamedZone> {
    let fits = |(_, _, orientation): &&(&str, f64, f64)| *orientation * 1e-3 <= most + 1e-9;
    let (name, tcp, orientation) = ZONES.iter().rev().find(fits)?;
    let zone = Zone {
        fine: false,
        tcp: tcp * 1e-3,
        orientation: orientation * 1e-3,
        // The angle of predefined zones in degrees is a tenth of their size in mm.
        angle: (orientation * 0.1_f64).to_radians(),
    };
    Some(NamedZone { name, zone })
}

/// Predefined speeds below `than`, the fastest first, m/s.
pub(super) fn slower(than: f64) -> impl Iterator<Item = (String, f64)> {
    let below = SPEEDS.iter().rev().map(|speed| (*speed, f64::from(*speed) * 1e-3));
    below.filter(move |(_, speed)| *speed < than - 1e-9).map(|(v, speed)| (format!("v{v}"), speed))
}

/// Predefined speeds above `than`, the slowest first, m/s.
pub(super) fn faster(than: f64) -> impl Iterator<Item = (String, f64)> {
    let above = SPEEDS.iter().map(|speed| (*speed, f64::from(*speed) * 1e-3));
    above.filter(move |(_, speed)| *speed > than + 1e-9).map(|(v, speed)| (format!("v{v}"), speed))
}

pub(super) fn replace(span: Span, text: &str) -> Edit {
    Edit { span, text: text.as_bytes().to_vec() }
}

/// A step whose movement is changed; other steps stay.
pub(super) fn change_movement(step: &Step, change: impl FnOnce(&mut Movement)) -> Vec<Step> {
    let mut step = step.clone();
    if let Step::Move(movement) = &mut step {
        change(movement);
    }
    vec![step]
}

/// A step with another zone.
pub(super) fn with_zone(step: &Step, zone: Zone) -> Vec<Step> {
    change_movement(step, |movement| movement.zone = zone)
}

/// A step with a limited speed, m/s.
pub(super) fn with_speed(step: &Step, limit: f64) -> Vec<Step> {
    change_movement(step, |movement| movement.speed.tcp = movement.speed.tcp.min(limit))
}

/// A step with the speed of predefined data, m/s.
pub(super) fn with_predefined_speed(step: &Step, speed: f64) -> Vec<Step> {
    let speed = Speed { tcp: speed, orientation: PREDEFINED_TURN };
    change_movement(step, |movement| movement.speed = speed)
}

/// A step with another acceleration and, if it is given, another ramp (1 = 100 %).
pub(super) fn with_acceleration(step: &Step, share: f64, ramp: Option<f64>) -> Vec<Step> {
    change_movement(step, |movement| {
        let settings = Settings::clone(&movement.settings);
        let ramp = ramp.unwrap_or(settings.ramp);
        movement.settings = Settings { acceleration: share, ramp, ..settings }.into();
    })
}

/// A step with a joint movement in place of a line.
pub(super) fn as_joint(step: &Step) -> Vec<Step> {
    change_movement(step, |movement| {
        movement.form = MoveForm::Joint;
        movement.instruction = "MoveJ".into();
    })
}

/// Removes a statement, with its line if nothing else is on it. `None` for the only statement of a
/// compact `IF`.
pub(super) fn remove(context: &Context<'_>, site: &Site<'_>) -> Option<Edit> {
    if site.compact {
        return None;
    }
    Some(Edit { span: with_line(context, site.stmt.span), text: Vec::new() })
}

/// A span, extended to its whole line if only white space surrounds it.
pub(super) fn with_line(context: &Context<'_>, span: Span) -> Span {
    let bytes = &context.files[span.file.0 as usize].bytes;
    let blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let before = &bytes[..span.start as usize];
    let start = before.len() - before.iter().rev().take_while(|byte| blank(byte)).count();
    let after = &bytes[span.end as usize..];
    let end = after.iter().take_while(|byte| blank(byte)).count();
    let starts_line = start == 0 || matches!(bytes[start - 1], b'\n' | b'\r');
    let line_end = match &after[end..] {
        [b'\r', b'\n', ..] => 2,
        [b'\r' | b'\n', ..] => 1,
        _ => 0,
    };
    if starts_line && line_end > 0 {
        let end = span.end + (end + line_end) as u32;
        Span { start: start as u32, end, ..span }
    } else {
        span
    }
}

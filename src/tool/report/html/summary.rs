//! The head of the report: time, energy and the six energy parts before and after.

use std::fmt::Write;

use serde_json::{Value, json};

use super::format::{fixed, joules, saved_percent, seconds};
use crate::retime::energy::EnergyParts;
use crate::tool::report::svg::Scale;
use crate::tool::retrofit::{Retrofit, SegmentKind, SpacingSaving};

/// Style class, name, explanation and value of a part.
type PartOf = (&'static str, &'static str, &'static str, fn(&EnergyParts) -> f64);

const PARTS: [PartOf; 6] = [
    ("mechanical", "mechanical", "change of kinetic and potential energy", |p| p.mechanical_j),
    ("friction", "friction", "work against friction", |p| p.friction_j),
    ("copper", "copper", "loss in the windings while moving", |p| p.copper_j),
    ("drive", "drive", "converter loss, braking energy that is not recovered", |p| p.drive_j),
    ("idle", "idle", "base power, holding power at rest", |p| p.idle_j),
    ("brake", "brake", "keeping brakes open, and opening them", |p| p.brake_j),
];

/// The head for the template.
pub(super) fn summary(retrofit: &Retrofit) -> Value {
    let (before, after) = (&retrofit.original, &retrofit.optimized);
    let energy = |name: &str, before, after| {
        json!({
            "name": name,
            "unit": "J",
            "before": joules(before),
            "after": joules(after),
            "change": change(before, after, "saved", "more"),
        })
    };
    let mut padded = retrofit.before.1.total;
    if let Some(padding) = &retrofit.padding {
        padded += padding.energy;
    }
    let sides = [&padded, &retrofit.after.1.total];
    let part = |(class, name, what, value): &PartOf| {
        let [before, after] = sides.map(value);
        json!({
            "name": name,
            "what": what,
            "class": class,
            "before": joules(before),
            "after": joules(after),
            "saved": joules(before - after),
        })
    };
    let eligible =
        retrofit.segments.iter().filter(|s| s.kind != SegmentKind::Idle && s.executions > 0);
    json!({
        "cards": [
            {
                "name": "Cycle time",
                "unit": "s",
                "before": seconds(before.cycle_s),
                "after": seconds(after.cycle_s),
                "change": change(before.cycle_s, after.cycle_s, "shorter", "longer"),
            },
            energy("Energy", before.energy_j, after.energy_j),
            energy("Motion energy", before.motion_energy_j, after.motion_energy_j),
        ],
        "parts": PARTS.iter().map(part).collect::<Vec<_>>(),
        "bars": bars(sides),
        // Further saving by brakes.
        "potential": (retrofit.potential_j > 0.0).then(|| joules(retrofit.potential_j)),
        "rewritten": eligible.clone().filter(|s| s.rewritten).count(),
        "movements": eligible.count(),
    })
}

/// The savings over the spacing of points for the template.
pub(super) fn spacings(retrofit: &Retrofit) -> Vec<Value> {
    let row = |of: &SpacingSaving| {
        json!({
            "spacing": fixed(1e3 * of.spacing_s, 0),
            "points": of.points,
            "saved": joules(of.saved_j),
            "motion_percent": fixed(of.motion_saving_percent, 1),
            "is_used": of.is_used,
        })
    };
    retrofit.spacings.iter().map(row).collect()
}

fn change(before: f64, after: f64, less: &str, more: &str) -> String {
    let percent = saved_percent(before, after);
    let text = fixed(percent.abs(), 1);
    let word = if text == "0.0" {
        return "unchanged".to_owned();
    } else if percent > 0.0 {
        less
    } else {
        more
    };
    format!("{text} % {word}")
}

/// Width and height of a bar, and width of its label, px.
const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 26.0;
const GAP: f64 = 10.0;
const NAME: f64 = 56.0;
const VALUE: f64 = 80.0;

/// The parts before and after as stacked bars, negative ones to the left of zero.
fn bars(sides: [&EnergyParts; 2]) -> String {
    let values = |parts: &EnergyParts| PARTS.map(|(.., value)| value(parts));
    let sums = sides.map(|parts| {
        let values = values(parts);
        let sum = |sign: f64| values.iter().map(|x| (x * sign).max(0.0)).sum::<f64>() * sign;
        (sum(-1.0), sum(1.0))
    });
    let low = sums.iter().map(|s| s.0).fold(0.0, f64::min);
    let high = sums.iter().map(|s| s.1).fold(0.0, f64::max);
    let scale = Scale::exact(low, high, 1);
    let at = |x: f64| NAME + scale.share(x) * (WIDTH - NAME - VALUE);
    let height = 2.0 * HEIGHT + GAP;
    let mut out = format!(
        "<svg class=\"bars\" viewBox=\"0 0 {WIDTH:.0} {height:.0}\" role=\"img\" \
         aria-label=\"parts of the energy before and after\">"
    );
    for (i, (parts, name)) in sides.into_iter().zip(["before", "after"]).enumerate() {
        let y = (HEIGHT + GAP) * i as f64;
        let (mut left, mut right) = (0.0, 0.0);
        let _ = write!(
            out,
            "<text class=\"title\" x=\"0\" y=\"{:.1}\">{name}</text>",
            y + 0.68 * HEIGHT
        );
        for ((class, name, ..), value) in PARTS.iter().zip(values(parts)) {
            let (from, to) = if value < 0.0 {
                left += value;
                (left, left - value)
            } else {
                right += value;
                (right - value, right)
            };
            let (from, to) = (at(from), at(to));
            let _ = write!(
                out,
                "<rect class=\"part {class}\" x=\"{from:.1}\" y=\"{y:.1}\" width=\"{:.1}\" \
                 height=\"{HEIGHT:.0}\"><title>{name}: {} J</title></rect>",
                to - from,
                joules(value),
            );
        }
        let _ = write!(
            out,
            "<text class=\"value\" x=\"{:.1}\" y=\"{:.1}\">{} J</text>",
            at(right) + 6.0,
            y + 0.68 * HEIGHT,
            joules(parts.energy_j()),
        );
    }
    out.push_str("</svg>");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widths(svg: &str) -> Vec<f64> {
        svg.split("width=\"").skip(1).filter_map(|s| s.split('"').next()?.parse().ok()).collect()
    }

    #[test]
    fn bars_are_as_long_as_their_parts() {
        let before = EnergyParts {
            mechanical_j: -10.0,
            friction_j: 60.0,
            idle_j: 30.0,
            ..EnergyParts::default()
        };
        let after = EnergyParts { friction_j: 45.0, idle_j: 30.0, ..EnergyParts::default() };
        let widths = widths(&bars([&before, &after]));
        let per_joule = (WIDTH - NAME - VALUE) / 100.0;
        let expected = [10.0, 60.0, 0.0, 0.0, 30.0, 0.0, 0.0, 45.0, 0.0, 0.0, 30.0, 0.0];
        assert_eq!(widths.len(), expected.len());
        for (width, joules) in widths.iter().zip(expected) {
            assert!((width - joules * per_joule).abs() < 0.06, "{width} for {joules} J");
        }
    }

    #[test]
    fn changes_are_in_words() {
        assert_eq!(change(200.0, 150.0, "saved", "more"), "25.0 % saved");
        assert_eq!(change(100.0, 102.0, "saved", "more"), "2.0 % more");
        assert_eq!(change(100.0, 99.999, "saved", "more"), "unchanged");
    }
}

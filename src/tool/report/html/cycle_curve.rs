//! Energy over time of the whole cycle: least energy, lower bound, today and retrofit.

use std::fmt::Write;

use super::energy_time::scale;
use super::format::{joules, seconds};
use crate::tool::report::svg::{Frame, Size, points};
use crate::tool::retrofit::{CyclePoint, TaktEnergy, WholeCycle};

const SIZE: Size = Size { width: 1260.0, height: 380.0 };

/// The figure; `None` without a curve.
pub(super) fn cycle_curve(whole: &WholeCycle) -> Option<String> {
    let WholeCycle { curve, original, optimized, .. } = whole;
    if curve.is_empty() {
        return None;
    }
    let sides = [original, optimized];
    let times = curve.iter().map(|p| p.time_s).chain(sides.map(|of| of.time_s));
    let lines = curve.iter().flat_map(|p| [p.energy_j, p.lower_bound_j]);
    let energies = lines.chain(sides.map(TaktEnergy::energy_j));
    let frame = Frame::new(SIZE, scale(times, 10), scale(energies, 8));
    let line = |of: fn(&CyclePoint) -> f64| {
        let at: Vec<[f64; 2]> = curve.iter().map(|p| frame.at(p.time_s, of(p))).collect();
        points(&at)
    };
    let mut content = format!(
        "<polyline class=\"curve\" points=\"{}\"/><polyline class=\"bound\" points=\"{}\"/>",
        line(|p| p.energy_j),
        line(|p| p.lower_bound_j),
    );
    mark(&mut content, &frame, original, "kept", "from", "today");
    mark(&mut content, &frame, optimized, "rewritten", "head", "retrofit");
    Some(frame.svg(
        "least energy of the whole cycle over its time, and its lower bound",
        "time of the whole cycle (s)",
        "energy of the whole cycle (J)",
        &content,
    ))
}

/// A point with its name.
fn mark(out: &mut String, frame: &Frame, of: &TaktEnergy, group: &str, class: &str, name: &str) {
    let [x, y] = frame.at(of.time_s, of.energy_j());
    let _ = write!(
        out,
        "<g class=\"{group}\"><title>{name}: {} s, {} J</title><circle class=\"{class}\" \
         cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/><text class=\"label\" x=\"{:.1}\" y=\"{:.1}\">{name}\
         </text></g>",
        seconds(of.time_s),
        joules(of.energy_j()),
        x + 8.0,
        if class == "from" { y - 6.0 } else { y + 14.0 },
    );
}

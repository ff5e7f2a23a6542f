//! The table of segments. With the rest it adds up to the cycle.

use serde_json::{Value, json};

use super::format::{fixed, joules, saved_percent, seconds};
use crate::retime::optimize::reason::Reason;
use crate::tool::report::place::Places;
use crate::tool::retrofit::{Retrofit, Segment, SegmentKind};

/// Time (s) and energy (J) before and after.
#[derive(Clone, Copy, Default)]
struct Sums {
    time: [f64; 2],
    energy: [f64; 2],
}

impl Sums {
    fn of(segment: &Segment) -> Sums {
        Sums {
            time: [segment.time_before_s, segment.time_after_s],
            energy: [segment.energy_before_j, segment.energy_after_j],
        }
    }

    fn with(self, other: Sums, sign: f64) -> Sums {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + sign * b[0], a[1] + sign * b[1]];
        Sums { time: sum(self.time, other.time), energy: sum(self.energy, other.energy) }
    }

    fn text(&self) -> Value {
        let [before, after] = self.energy;
        json!({
            "time_before": seconds(self.time[0]),
            "time_after": seconds(self.time[1]),
            "energy_before": joules(before),
            "energy_after": joules(after),
            "saved": joules(before - after),
            "saved_percent": fixed(saved_percent(before, after), 1),
        })
    }
}

/// The table for the template.
pub(super) fn segments(retrofit: &Retrofit, places: Places<'_>) -> Value {
    let total = Sums {
        time: [retrofit.original.cycle_s, retrofit.optimized.cycle_s],
        energy: [retrofit.original.energy_j, retrofit.optimized.energy_j],
    };
    let padding = retrofit.padding.as_ref().map(|padding| Sums {
        time: [padding.duration_s, 0.0],
        energy: [padding.energy.energy_j(), 0.0],
    });
    let listed = retrofit.segments.iter().map(Sums::of).chain(padding);
    let listed = listed.fold(Sums::default(), |sum, costs| sum.with(costs, 1.0));
    let rows = numbered(retrofit).map(|(number, segment)| row(number, segment, places));
    let not_reached = retrofit.segments.iter().filter(|segment| segment.executions == 0);
    let not_reached = not_reached.map(|segment| places.of_pieces(&segment.pieces));
    json!({
        "rows": rows.collect::<Vec<_>>(),
        // The wait that the padding adds to the original.
        "padding": padding.map(|sums| sums.text()),
        // Events outside all segments: short waits.
        "rest": total.with(listed, -1.0).text(),
        "total": total.text(),
        "not_reached": not_reached.collect::<Vec<_>>(),
    })
}

/// The executed segments with their numbers in the report.
pub(super) fn numbered(retrofit: &Retrofit) -> impl Iterator<Item = (usize, &Segment)> {
    retrofit
        .segments
        .iter()
        .filter(|segment| segment.executions > 0)
        .enumerate()
        .map(|(i, segment)| (i + 1, segment))
}

fn row(number: usize, segment: &Segment, places: Places<'_>) -> Value {
    json!({
        "number": number,
        "place": places.of_pieces(&segment.pieces),
        "kind": match segment.kind {
            SegmentKind::Timing => "movement",
            SegmentKind::Path => "free movement",
            SegmentKind::Idle => "dwell",
        },
        "rewritten": segment.rewritten,
        "executions": segment.executions,
        "rewritten_executions": segment.rewritten_executions,
        "costs": Sums::of(segment).text(),
        "bound": segment.lower_bound_j.map(joules),
        "points": segment.rewritten.then_some(segment.points),
        "reason": segment.reason.as_ref().map(reason),
        "potential": (segment.potential_j > 0.0).then(|| joules(segment.potential_j)),
    })
}

fn reason(reason: &Reason) -> Value {
    let code = reason.code();
    let text = reason.to_string();
    let words = text.strip_prefix(code).map_or(&*text, |rest| rest.trim_start_matches(": "));
    json!({ "code": code, "words": words })
}

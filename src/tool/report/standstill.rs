//! The result of `standstill`. The JSON field names are a stable interface.

use serde_json::{Value, json};

use super::json::{estimated, interval};
use super::place::Place;
use super::plausible::contributions;
use super::table::{Align, table};
use crate::arm::robot::Model;
use crate::retime::energy::plausible::Interval;
use crate::retime::optimize::standstill::Standing;
use crate::retime::path::joint_path::Joints;

/// A pose, with the place and length of its dwell if it comes from a program.
#[derive(Clone, Debug)]
pub struct Pose {
    /// Its costs.
    pub standing: Standing,
    /// Place and length (s) of the dwell.
    pub dwell: Option<(Place, f64)>,
}

/// The result as JSON; `assumed` lists the assumptions of the figures.
pub fn json(model: &Model, poses: &[Pose], assumed: &[String]) -> Value {
    let poses: Vec<Value> = poses
        .iter()
        .map(|pose| {
            let standing = &pose.standing;
            let mut value = json!({
                "q_deg": degrees(&standing.q),
                "per_joint_w": standing.per_joint_w,
                "holding_w": standing.holding_w(),
                "break_even_s": standing.break_even_s,
                "best_nearby": { "q_deg": degrees(&standing.best), "holding_w": standing.best_w },
            });
            if let Some(range) = &standing.plausible {
                value["holding_interval_w"] = json!(interval(range.holding_w));
                value["holding_median_w"] = json!(range.holding_w.median);
                value["break_even_median_s"] = json!(range.break_even_s.map(|range| range.median));
                value["estimated"] = json!(estimated(&range.contributions));
                value["break_even_interval_s"] = json!(range.break_even_s.map(interval));
            }
            if let Some((place, duration)) = &pose.dwell {
                value["file"] = json!(place.file);
                value["line"] = json!(place.first);
                value["duration_s"] = json!(duration);
            }
            value
        })
        .collect();
    let brake = model.brakes.as_ref().map(|brakes| {
        json!({
            "energy_per_release_j": brakes.energy_per_release_j,
            "power_released_w": brakes.power_released_w,
            "release_s": brakes.release_s,
            "engage_s": brakes.engage_s,
        })
    });
    json!({ "robot": model.name, "poses": poses, "brake": brake, "assumed": assumed })
}

/// The result as text.
pub fn text(poses: &[Pose]) -> String {
    let names = ["pose (deg)", "joints 1-6 (W)", "holding", "brake pays from", "best nearby (deg)"];
    let mut header = vec![("dwell", Align::Left)];
    header.extend(names.map(|name| (name, Align::Right)));
    header.push(("holding", Align::Right));
    let list = |values: &[f64]| {
        values.iter().map(|x| format!("{:.1}", x + 0.0)).collect::<Vec<_>>().join(" ")
    };
    let rows: Vec<Vec<String>> = poses
        .iter()
        .map(|pose| {
            let standing = &pose.standing;
            let range = standing.plausible.as_ref();
            let dwell = pose.dwell.as_ref().map_or_else(String::new, |(place, duration)| {
                format!("{}:{} {duration:.2} s", place.file, place.first)
            });
            vec![
                dwell,
                list(&degrees(&standing.q)),
                list(&standing.per_joint_w),
                format!("{:.1} W{}", standing.holding_w(), within(range.map(|r| &r.holding_w), 1)),
                standing.break_even_s.map_or_else(
                    || "-".into(),
                    |s| {
                        let range = range.and_then(|range| range.break_even_s.as_ref());
                        format!("{s:.2} s{}", within(range, 2))
                    },
                ),
                list(&degrees(&standing.best)),
                format!("{:.1} W", standing.best_w),
            ]
        })
        .collect();
    let mut ranges = poses.iter().filter_map(|pose| pose.standing.plausible.as_ref());
    let said = ranges.find_map(|range| contributions(&range.contributions));
    table(&header, &rows) + &said.map_or_else(String::new, |said| format!("at the first, {said}\n"))
}

/// An interval in brackets.
fn within(interval: Option<&Interval>, digits: usize) -> String {
    let text = |x: &Interval| format!(" ({:.digits$} to {:.digits$})", x.low, x.high);
    interval.map_or_else(String::new, text)
}

/// In degrees, without the rounding errors of the conversion.
fn degrees(q: &Joints) -> Joints {
    q.map(|angle| (angle.to_degrees() * 1e9).round() / 1e9)
}

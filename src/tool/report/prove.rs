//! The result of `prove`. The JSON field names are a stable interface.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::table::{Align, table};
use crate::tool::cell::prove::{
    Adjustment, Doubt, LeftOut, Measure, Period, Plan, Proof, Stratum, Verdict,
};

/// A difference of cycle times that does not count, share.
const SAME_TIME: f64 = 2e-3;

/// The result as JSON; `command` is the next step where measurement and promise differ.
pub fn json(proof: &Proof, command: &str) -> Value {
    let percent = |share: f64| 100.0 * share;
    let ends = |interval: Option<[f64; 2]>| interval.map(|ends| ends.map(percent));
    let interval = ends(proof.saving.interval);
    let [before_s, after_s] = proof.cycle.means_s;
    let strata: Vec<Value> = proof.strata.iter().map(stratum).collect();
    let adjustments: Vec<Value> = proof.adjustments.iter().map(adjustment).collect();
    let doubts: Vec<Value> = proof.doubts.iter().map(doubt).collect();
    json!({
        "verdict": proof.verdict.name(),
        "saving_percent": {
            "value": percent(proof.saving.value),
            "low": interval.map(|ends| ends[0]),
            "high": interval.map(|ends| ends[1]),
        },
        "cycle_s": {
            "before": before_s, "after": after_s,
            "difference_high": proof.cycle.difference_high_s,
            "foreign": proof.cycle.foreign_s,
        },
        "cycles": {
            "before": proof.cycles[0], "after": proof.cycles[1], "needed": proof.needed,
        },
        "sentence": sentence(proof),
        "energy_j": { "before": proof.energy_j[0], "after": proof.energy_j[1] },
        "standard_error_percent": proof.standard_error.map(percent),
        "saving_by_scatter_percent": ends(proof.statistical),
        "saving_unadjusted_percent": percent(proof.raw_saving),
        "saving_with_faults_percent": proof.saving_with_faults.map(percent),
        "measured": proof.measure.name(),
        "rest_w": proof.rest_w,
        "adjustments": adjustments,
        "doubts": doubts,
        "strata": strata,
        "left_out": proof.left_out.iter().map(left_out).collect::<Vec<Value>>(),
        "block_cycles": proof.blocks,
        "power_analysis": power_analysis(&proof.plan),
        "terms": terms(proof).iter().map(|(term, text)| json!({ "term": term, "here": text })).collect::<Vec<Value>>(),
        "promised": promised(proof, command),
        "programs": proof.programs,
        "notes": proof.notes,
    })
}

/// The power analysis of one side as JSON.
pub fn plan_json(plan: &Plan) -> Value {
    json!({
        "verdict": null,
        "cycles": { "before": plan.cycles, "after": 0, "needed": plan.needed },
        "cycle_s": { "before": plan.duration_s },
        "energy_j": { "before": plan.energy_j },
        "effect_percent": 100.0 * plan.settings.effect,
        "deviation_percent": 100.0 * plan.deviation,
        "measured": plan.measure.name(),
        "power_analysis": power_analysis(&plan.plan),
        "left_out": plan.left_out.iter().map(left_out).collect::<Vec<Value>>(),
        "sentence": plan_sentence(plan),
        "notes": plan.notes,
    })
}

fn stratum(of: &Stratum) -> Value {
    json!({
        "name": of.name,
        "cycles": { "before": of.cycles[0], "after": of.cycles[1] },
        "energy_j": { "before": of.energy_j[0], "after": of.energy_j[1] },
        "weight": of.weight,
    })
}

fn adjustment(of: &Adjustment) -> Value {
    json!({
        "name": of.name, "change": of.change, "unit": of.unit,
        "slope_j": of.slope, "slope_sd_j": of.slope_sd, "energy_j": of.energy_j,
    })
}

fn doubt(of: &Doubt) -> Value {
    json!({
        "name": of.name,
        "widens_percent": of.widens.map(|share| 100.0 * share),
        "withholds": of.withholds,
        "text": of.text,
    })
}

fn left_out(of: &LeftOut) -> Value {
    json!({ "side": side(of.period), "cycles": of.count, "why": of.why })
}

fn power_analysis(plan: &[(f64, usize)]) -> Vec<Value> {
    let row = |(effect, cycles): &(f64, usize)| json!({ "effect_percent": 100.0 * effect, "cycles_each_side": cycles });
    plan.iter().map(row).collect()
}

fn side(period: Period) -> &'static str {
    match period {
        Period::Before => "before",
        Period::After => "after",
    }
}

/// How measurement and promise differ.
fn promised(proof: &Proof, command: &str) -> Option<Value> {
    let promised = proof.settings.promised?;
    Some(json!({
        "percent": 100.0 * promised,
        "difference_percent": 100.0 * (proof.saving.value - promised),
        "agrees": agrees(proof, promised),
        "next": command,
    }))
}

fn agrees(proof: &Proof, promised: f64) -> bool {
    proof.saving.interval.is_none_or(|[low, high]| (low..=high).contains(&promised))
}

/// The command that finds out why measurement and model differ.
pub fn diagnose_command(before: &[String], after: &[String]) -> String {
    let quoted = |paths: &[String]| {
        let quoted = paths.iter().map(|path| {
            let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+".contains(c);
            if path.chars().all(is_plain) { path.clone() } else { format!("'{path}'") }
        });
        quoted.collect::<Vec<_>>().join(" ")
    };
    format!(
        "joulepath diagnose --robot ROBOT --log {} --baseline {} --out better.toml",
        quoted(after),
        quoted(before)
    )
}

/// The verdict as one sentence.
pub fn sentence(proof: &Proof) -> String {
    let value = 100.0 * proof.saving.value;
    let Some([low, high]) = proof.saving.interval.map(|ends| ends.map(|x| 100.0 * x)) else {
        return format!(
            "too few cycles: {} before and {} after, at least {} of each are needed",
            proof.cycles[0], proof.cycles[1], proof.needed
        );
    };
    let what = match proof.verdict {
        Verdict::Saves => format!("saves {value:.1} % ({low:.1} to {high:.1}) per part"),
        Verdict::Costs => {
            format!("costs {:.1} % more ({:.1} to {:.1}) per part", -value, -high, -low)
        }
        Verdict::NoDifference => {
            format!("no difference is shown: {value:.1} % ({low:.1} to {high:.1}) per part")
        }
        Verdict::TooFewCycles => format!(
            "too few cycles: {value:.1} % ({low:.1} to {high:.1}) per part; {} cycles of each side will show {:.1} %",
            proof.needed,
            100.0 * proof.settings.effect.max(proof.saving.value.abs())
        ),
    };
    format!("{what}; {}", of_time(proof))
}

fn of_time(proof: &Proof) -> String {
    let cycle = &proof.cycle;
    let [before, after] = cycle.means_s;
    let bound = cycle.difference_high_s.unwrap_or(0.0);
    if !cycle.is_longer {
        let is_same = bound <= SAME_TIME * before;
        let verb = if is_same { "takes no longer" } else { "is not shown to take longer" };
        return format!("{verb}: 95 % bound {bound:+.2} s");
    }
    let own = after - before - cycle.foreign_s;
    format!(
        "takes {:.2} s longer (95 % bound {bound:+.2} s), of which the motion {own:.2} s, which is not credited",
        after - before
    )
}

fn plan_sentence(plan: &Plan) -> String {
    format!("{} cycles each side will show {:.1} %", plan.needed, 100.0 * plan.settings.effect)
}

/// The terms of IPMVP option B and ISO 50015 with what stands for them here.
pub fn terms(proof: &Proof) -> Vec<(&'static str, String)> {
    let boundary = match proof.measure {
        Measure::Cabinet => {
            "the supply of the robot's cabinet (retrofit isolation, all parameters measured: option B)"
        }
        Measure::Joints => {
            "the joints: positive mechanical work, without drives and base load (option B)"
        }
    };
    let program = |side: usize| {
        proof.programs[side].as_ref().map_or_else(String::new, |hash| format!(", program {hash}"))
    };
    let routine: Vec<String> = proof
        .adjustments
        .iter()
        .map(|of| {
            format!(
                "{}: {:+.3} {} at {:.1} J/{} = {:+.1} J",
                of.name, of.change, of.unit, of.slope, of.unit, of.energy_j
            )
        })
        .collect();
    let doubts: Vec<&str> = proof.doubts.iter().map(|doubt| doubt.name).collect();
    let listed =
        |items: Vec<String>| if items.is_empty() { "none".to_owned() } else { items.join("; ") };
    vec![
        ("measurement boundary", boundary.to_owned()),
        ("baseline period", format!("{} cycles{}", proof.cycles[0], program(0))),
        ("reporting period", format!("{} cycles{}", proof.cycles[1], program(1))),
        ("baseline energy", format!("{:.1} J per part", proof.energy_j[0])),
        ("reporting-period energy, adjusted", format!("{:.1} J per part", proof.energy_j[1])),
        ("routine adjustments", listed(routine)),
        ("non-routine adjustments", {
            let items =
                doubts.into_iter().map(|name| format!("{name}: the interval is wider")).collect();
            listed(items)
        }),
        ("static factors", listed(proof.strata.iter().map(|of| of.name.clone()).collect())),
        (
            "uncertainty",
            format!(
                "95 % interval, block bootstrap of {} and {} cycles a block; a constant error of the meter's gain \
                 cancels, its change between the periods is checked by the power at rest",
                proof.blocks[0], proof.blocks[1]
            ),
        ),
    ]
}

/// The result as text.
pub fn text(proof: &Proof, command: &str) -> String {
    let mut out = format!("{}\n\n", sentence(proof));
    for (term, here) in terms(proof) {
        let _ = writeln!(out, "{term}: {here}");
    }
    if proof.strata.len() > 1 {
        out.push('\n');
        let header = [
            ("what was made", Align::Left),
            ("before", Align::Right),
            ("J", Align::Right),
            ("after", Align::Right),
            ("J", Align::Right),
            ("weight %", Align::Right),
        ];
        let rows: Vec<Vec<String>> = proof.strata.iter().map(stratum_row).collect();
        out.push_str(&table(&header, &rows));
    }
    for line in remarks(proof, command) {
        let _ = writeln!(out, "\n{line}");
    }
    out
}

/// The row of a stratum.
pub(super) fn stratum_row(of: &Stratum) -> Vec<String> {
    vec![
        of.name.clone(),
        of.cycles[0].to_string(),
        format!("{:.1}", of.energy_j[0]),
        of.cycles[1].to_string(),
        format!("{:.1}", of.energy_j[1]),
        format!("{:.1}", 100.0 * of.weight),
    ]
}

/// What was left out, what is doubtful, and what comes next.
pub(super) fn remarks(proof: &Proof, command: &str) -> Vec<String> {
    let mut remarks: Vec<String> = proof.doubts.iter().map(|doubt| doubt.text.clone()).collect();
    for left in &proof.left_out {
        let cycles = if left.count == 1 { "cycle" } else { "cycles" };
        remarks.push(format!(
            "{}: {} {cycles} left out: {}",
            side(left.period),
            left.count,
            left.why
        ));
    }
    if let Some(saving) = proof.saving_with_faults {
        remarks.push(format!(
            "with the faulty cycles the saving would be {:.1} % instead of {:.1} %",
            100.0 * saving,
            100.0 * proof.saving.value
        ));
    }
    if proof.cycle.is_longer {
        remarks.push(format!(
            "without adjustment for the cycle time the saving is {:.1} %",
            100.0 * proof.raw_saving
        ));
    }
    remarks.extend(proof.settings.promised.map(|promised| {
        let difference = 100.0 * (proof.saving.value - promised);
        let promised_percent = 100.0 * promised;
        if agrees(proof, promised) {
            format!("the promised {promised_percent:.1} % are within the interval ({difference:+.1} points)")
        } else {
            format!(
                "the measurement is {difference:+.1} points from the promised {promised_percent:.1} %; with logs of \
                 the joints (q1…, tau1…) this finds out why: {command}"
            )
        }
    }));
    remarks
}

/// The power analysis of one side as text.
pub fn plan_text(plan: &Plan) -> String {
    let mut out = format!("{}\n\n", plan_sentence(plan));
    let _ = writeln!(
        out,
        "{} cycles of {:.2} s and {:.1} J; they vary by {:.1} % after adjustment ({})",
        plan.cycles,
        plan.duration_s,
        plan.energy_j,
        100.0 * plan.deviation,
        plan.measure.name()
    );
    for left in &plan.left_out {
        let _ = writeln!(out, "{} left out: {}", left.count, left.why);
    }
    out.push('\n');
    let header = [("saving %", Align::Right), ("cycles each side", Align::Right)];
    let rows: Vec<Vec<String>> = plan
        .plan
        .iter()
        .map(|(effect, cycles)| vec![format!("{:.0}", 100.0 * effect), cycles.to_string()])
        .collect();
    out.push_str(&table(&header, &rows));
    out
}

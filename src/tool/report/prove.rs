//! The result of `prove`. The JSON field names are a stable interface.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::diagnose::quoted;
use super::prove_words::{agrees, plan_sentence, remarks, sentence, side, terms};
use super::table::{Align, table};
use crate::tool::cell::prove::{Adjustment, Doubt, LeftOut, Plan, Proof, Stratum};

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

/// The command that finds out why measurement and model differ.
pub fn diagnose_command(before: &[String], after: &[String]) -> String {
    let words =
        |paths: &[String]| paths.iter().map(|path| quoted(path)).collect::<Vec<_>>().join(" ");
    format!(
        "joulepath diagnose --robot ROBOT --log {} --baseline {} --out better.toml",
        words(after),
        words(before)
    )
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

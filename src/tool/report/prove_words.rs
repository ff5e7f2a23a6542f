//! What `prove` says in words: the verdict, the terms of measurement and verification, remarks.

use crate::tool::cell::prove::{Measure, Period, Plan, Proof, Verdict};

/// A difference of cycle times that does not count, share.
const SAME_TIME: f64 = 2e-3;

/// The verdict as one sentence.
pub(super) fn sentence(proof: &Proof) -> String {
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
        _ if proof.doubts.iter().any(|doubt| doubt.withholds) => {
            format!(
                "no verdict, as other work may have been done: {value:.1} % ({low:.1} to {high:.1}) per part"
            )
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

/// The power analysis as one sentence.
pub(super) fn plan_sentence(plan: &Plan) -> String {
    format!("{} cycles each side will show {:.1} %", plan.needed, 100.0 * plan.settings.effect)
}

/// The terms of IPMVP option B and ISO 50015 with what stands for them here.
pub(super) fn terms(proof: &Proof) -> Vec<(&'static str, String)> {
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

/// Whether the interval holds what was promised.
pub(super) fn agrees(proof: &Proof, promised: f64) -> bool {
    proof.saving.interval.is_none_or(|[low, high]| (low..=high).contains(&promised))
}

/// The name of a side.
pub(super) fn side(period: Period) -> &'static str {
    match period {
        Period::Before => "before",
        Period::After => "after",
    }
}

//! What a finding says it saves is what two simulations of the whole program say.

use joulepath::lint::engine::cycles;
use joulepath::lint::{Applicability, Finding};
use joulepath::text::{Edit, SourceFile, apply};

use crate::{Fixture, fixtures};

/// Largest difference: a share of the saving, or J.
const SHARE: f64 = 0.05;
const JOULES: f64 = 1.0;
/// Largest difference of times, s.
const SECONDS: f64 = 1e-3;

/// Energy (J) and time (s) of a cycle.
fn cycle(fixture: &Fixture) -> (f64, f64) {
    let cycles = cycles(&fixture.job());
    let cycle = cycles[0].as_ref().unwrap();
    (cycle.account.total.energy_j(), cycle.simulation.cycle_s)
}

fn with(fixture: &Fixture, finding: &Finding) -> Fixture {
    let edits: Vec<Edit> = finding.fix.as_ref().unwrap().edits.clone();
    let file = &fixture.files[0];
    let bytes = apply(&file.bytes, &edits).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let changed = SourceFile::new(file.id, file.path.clone(), text.clone().into_bytes());
    Fixture { files: vec![changed], ..Fixture::new(fixture.path.clone(), &text) }
}

#[test]
fn savings_are_those_of_two_simulations() {
    let mut compared = std::collections::BTreeSet::new();
    for fixture in fixtures().into_iter().filter(|fixture| fixture.model.is_some()) {
        let (energy, time) = cycle(&fixture);
        for finding in fixture.report().findings {
            let Some(saving) = finding.saving else { continue };
            if finding.fix.is_none() {
                continue;
            }
            let (energy_after, time_after) = cycle(&with(&fixture, &finding));
            let spared = energy - energy_after;
            let off = (spared - saving.energy_j).abs();
            let told = finding.told();
            assert!(off <= JOULES.max(SHARE * spared.abs()), "{spared} J: {told}");
            let late = (time - time_after - saving.time_s).abs();
            assert!(late <= SECONDS, "{} s, told {} s: {told}", time - time_after, saving.time_s);
            assert!(saving.low_j <= saving.energy_j && saving.energy_j <= saving.high_j);
            compared.insert(finding.rule.code);
        }
    }
    // Every rule with a fix and joules was compared at least once.
    for code in ["EW101", "EW102", "EW103", "EW201", "EW202", "EW203", "EW205", "EW304", "EW402"] {
        assert!(compared.contains(code), "{code} was not compared");
    }
    for code in ["EW405", "EW406", "EW602", "EW603"] {
        assert!(compared.contains(code), "{code} was not compared");
    }
}

#[test]
fn a_stop_in_a_line_is_fixed_safely() {
    let all = fixtures();
    let findings = all.iter().flat_map(|fixture| fixture.report().findings);
    for finding in findings {
        let safe = finding.fix.as_ref().is_some_and(|f| f.applicability == Applicability::Safe);
        assert_eq!(safe, matches!(finding.rule.code, "EW001" | "EW102"), "{}", finding.told());
    }
}

//! The saving in a finding agrees with two simulations of the whole program.

use joulepath::rapid::text::{Edit, FileId, Span, apply};
use joulepath::tool::lint::engine::cycles;
use joulepath::tool::lint::evaluate::difference;
use joulepath::tool::lint::known::Known;
use joulepath::tool::lint::{Applicability, Finding};

use crate::planted::planted_faults;
use crate::{Fixture, fixtures};

/// Largest difference: as a share of the saving, or in J.
const SHARE: f64 = 0.05;
const JOULES: f64 = 1.0;
/// Largest difference of times, s.
const SECONDS: f64 = 1e-3;

/// Energy (J) and time (s) of a cycle.
fn cycle(fixture: &Fixture) -> (f64, f64) {
    let cycles = cycles(&fixture.job(), fixture.model.as_ref().map(Known::new).as_ref());
    let cycle = cycles[0].as_ref().unwrap();
    (cycle.account.total.energy_j(), cycle.simulation.cycle_s)
}

fn with_change(fixture: &Fixture, finding: &Finding) -> Fixture {
    let edits = finding.fix.as_ref().map(|fix| fix.edits.clone());
    let edits = edits.unwrap_or_else(|| manual_change(fixture, finding));
    let file = &fixture.files[0];
    let bytes = apply(&file.bytes, &edits).unwrap();
    fixture.with_text(String::from_utf8(bytes).unwrap())
}

/// The change that the message proposes, as a reader would make it.
fn manual_change(fixture: &Fixture, finding: &Finding) -> Vec<Edit> {
    let file = &fixture.files[0];
    let span = finding.span;
    let statement = file.text(span).into_owned();
    let change = finding.change.as_str();
    let edit = |span: Span, text: String| Edit { span, text: text.into_bytes() };
    let line_of = |number: &str| {
        let text = String::from_utf8(file.bytes.clone()).unwrap();
        let before = text.split_inclusive('\n').take(number.parse::<usize>().unwrap() - 1);
        let start: usize = before.map(str::len).sum();
        let length = text[start..].find(';').unwrap() + 1;
        Span { start: start as u32, end: (start + length) as u32, ..span }
    };
    if let Some((setting, lines)) = change.split_once(" for line ") {
        let full = match setting.split_once(" in place of ") {
            Some((new, old)) => statement.replacen(old, new, 1),
            None => format!("{setting};"),
        };
        let lines = lines.strip_suffix(" alone").unwrap().split(", ").map(line_of);
        let around = |line: Span| edit(line, format!("{full}{}{statement}", file.text(line)));
        return lines.map(around).collect();
    }
    if let Some(change) = change.strip_suffix(" in the target") {
        let (new, _) = change.split_once(" in place of ").unwrap();
        let (_, number) = new.split_once(' ').unwrap();
        return vec![edit(finding.related[0].0, number.to_owned())];
    }
    if let Some((change, count)) = change.split_once(" in all ") {
        let (new, old) = change.split_once(" in place of ").unwrap();
        let places: Vec<Span> =
            finding.related.iter().map(|(span, _)| *span).chain([span]).collect();
        assert_eq!(places.len().to_string(), count, "all places are related");
        return places
            .into_iter()
            .map(|it| edit(it, file.text(it).replacen(old, new, 1)))
            .collect();
    }
    if let Some((new, rest)) = change.split_once(" in place of ") {
        let old = rest.split(',').next().unwrap();
        assert!(statement.contains(old), "{statement} has no {old}");
        return vec![edit(span, statement.replacen(old, new, 1))];
    }
    if let Some((there, rest)) = change.split_once(" before the wait, ") {
        let (shorter, rest) = rest.split_once(" s less of it, and ").unwrap();
        let back = rest.strip_suffix(" behind it").unwrap();
        let length: f64 =
            statement.trim_start_matches("WaitTime").trim_end_matches(';').trim().parse().unwrap();
        let length = length - shorter.parse::<f64>().unwrap();
        return vec![edit(span, format!("{there},tGripper;WaitTime {length};{back},tGripper;"))];
    }
    if change.starts_with("waiting before ") {
        let start = finding.related[0].0.start;
        return vec![
            edit(Span { start, end: start, ..span }, statement),
            edit(span, String::new()),
        ];
    }
    let movements_before = |count: usize| {
        let text = String::from_utf8(file.bytes[..span.start as usize].to_vec()).unwrap();
        text.rmatch_indices("Move").nth(count - 1).unwrap().0 as u32
    };
    if change == "leaving out this movement and the one before" {
        return vec![edit(Span { start: movements_before(1), ..span }, String::new())];
    }
    if change == "leaving out this movement and the next one" {
        let behind = String::from_utf8(file.bytes[span.end as usize..].to_vec()).unwrap();
        let next = behind.find("Move").unwrap();
        let length = next + behind[next..].find(';').unwrap() + 1;
        return vec![edit(Span { end: span.end + length as u32, ..span }, String::new())];
    }
    if let Some(rest) = change.strip_prefix("leaving out the ") {
        let count: usize = rest.split(' ').next().unwrap().parse().unwrap();
        let whole = Span { start: movements_before(count), end: span.start, ..span };
        return vec![edit(whole, String::new())];
    }
    assert_eq!(change, "leaving it out");
    vec![edit(span, String::new())]
}

#[test]
fn savings_agree_with_two_simulations() {
    let mut compared = std::collections::BTreeSet::new();
    let planted = planted_faults().into_iter().map(|planted| planted.fixture);
    let weighed = fixtures().into_iter().filter(|fixture| fixture.model.is_some());
    for fixture in weighed.chain(planted) {
        let (energy, time) = cycle(&fixture);
        for finding in fixture.report().findings {
            let Some(saving) = finding.saving else { continue };
            let (energy_after, time_after) = cycle(&with_change(&fixture, &finding));
            let spared = energy - energy_after;
            let off = (spared - saving.energy_j).abs();
            let reported = finding.full_message();
            assert!(off <= JOULES.max(SHARE * spared.abs()), "{spared} J: {reported}");
            let late = (time - time_after - saving.time_s).abs();
            assert!(
                late <= SECONDS,
                "{} s, reported {} s: {reported}",
                time - time_after,
                saving.time_s
            );
            assert!(saving.low_j <= saving.energy_j && saving.energy_j <= saving.high_j);
            compared.insert(finding.rule.code);
        }
    }
    // At least one comparison for every rule with joules.
    for code in ["EW101", "EW102", "EW103", "EW201", "EW202", "EW203", "EW205", "EW304", "EW402"] {
        assert!(compared.contains(code), "{code} was not compared");
    }
    for code in ["EW104", "EW204", "EW206", "EW301", "EW403", "EW404"] {
        assert!(compared.contains(code), "{code} was not compared");
    }
    for code in ["EW405", "EW406", "EW602", "EW603"] {
        assert!(compared.contains(code), "{code} was not compared");
    }
}

/// Only changes of comments are safe without review.
#[test]
fn only_fixes_of_comments_are_safe() {
    let all = fixtures();
    let findings = all.iter().flat_map(|fixture| fixture.report().findings);
    for finding in findings {
        let safe = finding.fix.as_ref().is_some_and(|f| f.applicability == Applicability::Safe);
        assert_eq!(safe, finding.rule.code == "EW001", "{}", finding.full_message());
    }
}

/// The lift after a grip looks like a trip home, and a drilled hole like a line with a stop.
#[test]
fn findings_that_may_be_process_steps_have_no_fix() {
    let planted = planted_faults().into_iter().map(|planted| planted.fixture);
    let mut found = std::collections::BTreeSet::new();
    for fixture in fixtures().into_iter().chain(planted) {
        for finding in fixture.report().findings {
            if matches!(finding.rule.code, "EW102" | "EW402" | "EW403" | "EW406") {
                assert!(finding.fix.is_none(), "{}", finding.full_message());
                assert!(finding.rule.manual().contains("Without a fix"), "{}", finding.rule.code);
                found.insert(finding.rule.code);
            }
        }
    }
    assert_eq!(found.len(), 4, "{found:?}");
}

/// The load during a wait is that of the movement before, even if that movement is outside the
/// recomputed part of the cycle.
#[test]
fn leaving_out_a_movement_keeps_the_load_of_the_next_wait() {
    let text = "MODULE M
        ! robot: IRB1600-10/1.45
        PERS tooldata tHeavy:=[TRUE,[[0,0,100],[1,0,0,0]],[9,[0,0,80],[1,0,0,0],0.1,0.1,0.1]];
        CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST jointtarget jOut:=[[40,40,10,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        PROC main()
            MoveAbsJ jHome,v1000,fine,tHeavy;
            MoveAbsJ jOut,v1000,fine,tHeavy;
            SetDO do1,1;
            MoveAbsJ jOut,v1000,fine,tHeavy;
            WaitTime 10;
            MoveAbsJ jHome,v1000,fine,tHeavy;
        ENDPROC
    ENDMODULE";
    let fixture = Fixture::new("M.mod".into(), text);
    let cycles = cycles(&fixture.job(), fixture.model.as_ref().map(Known::new).as_ref());
    let start = text.rfind("MoveAbsJ jOut").unwrap();
    let length = text[start..].find(';').unwrap() + 1;
    let span = Span { file: FileId(0), start: start as u32, end: (start + length) as u32 };
    let model = fixture.model.as_ref().unwrap();
    let without = difference(model, cycles[0].as_ref().unwrap(), &[span], &|_| Vec::new());
    let saved = without.unwrap().saved.energy_j();
    assert!(saved.abs() < 1e-6, "{saved} J");
}

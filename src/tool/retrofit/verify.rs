//! The verifier: reads the emitted text, simulates it, and compares it with the original.

use std::collections::{BTreeMap, BTreeSet};

use super::candidate::Candidate;
use super::error::RetrofitError;
use super::figures::Verification;
use super::files::{OutputFile, OutputKind, Source, read_again};
use super::job::Original;
use super::order::same_order;
use super::read::read_program;
use super::relocated_waits::{Fault, RelocatedWait, with_waits_folded};
use super::settings::{Budget, Settings};
use super::simulated::{Simulated, TIME_TOLERANCE};
use super::speed_slots::Slot;
use super::verify_speeds::compare_speeds;
use super::verify_streams::{all_failed, compare_streams, reordering, slowing};
use crate::arm::robot::Model;
use crate::rapid::syntax;
use crate::retime::motion::{Options, Simulation, simulate};
use crate::retime::optimize::reason::Reason;

/// How an emitted program differs from the original.
#[derive(Clone, Copy)]
pub(super) enum Rewrite<'a> {
    /// Streams replace movements, and waits move to other poses. Text is only inserted.
    Streams { candidates: &'a [Candidate], waits: &'a [RelocatedWait] },
    /// Movements have other speeds: one factor for each slot.
    Speeds { slots: &'a [Slot], factors: &'a [f64] },
}

/// The result of the verification.
pub(super) struct Attempt {
    /// The cycle of the emitted program, with the waits at their original places.
    pub(super) simulated: Simulated,
    pub(super) verification: Verification,
    /// Candidates that failed, with the reason.
    pub(super) failed: Vec<(usize, Reason)>,
    /// Faults of relocated waits, by index.
    pub(super) wait_faults: BTreeMap<usize, Fault>,
}

/// Whether new and changed files have no syntax errors beyond those of the original.
pub(in crate::tool) fn parses(files: &[Source], outputs: &[OutputFile]) -> bool {
    outputs.iter().all(|output| match output.kind {
        OutputKind::New => {
            let parse = syntax::parse(&output.bytes);
            parse.errors.is_empty() && parse.tolerances.is_empty()
        }
        OutputKind::Changed => {
            let errors = |bytes: &[u8]| syntax::parse(bytes).errors.len();
            let before = output.input.map_or(0, |i| errors(&files[i].file.bytes));
            errors(&output.bytes) <= before
        }
        OutputKind::Unchanged => true,
    })
}

/// Reads an emitted program and simulates it.
///
/// # Errors
/// The program cannot be read.
pub(in crate::tool) fn run_again(
    outputs: &[OutputFile],
    entry: &str,
    model: &Model,
    options: &Options,
) -> Result<Simulation, RetrofitError> {
    let (program, entry) = read_program(&read_again(outputs), entry)?;
    Ok(simulate(&program, entry, model, options))
}

/// Verifies an emitted program and lists the candidates that fail; all candidates with streams if
/// the cause is unclear.
pub(super) fn verify(
    original: &Original<'_>,
    outputs: &[OutputFile],
    model: &Model,
    settings: &Settings,
    rewrite: Rewrite<'_>,
) -> Attempt {
    let mut verification = Verification::none();
    let is_readable = parses(original.files, outputs);
    verification.note("the emitted text parses", is_readable);
    let mut text_holds = is_readable;
    if let Rewrite::Streams { .. } = rewrite {
        let bytes_kept = outputs.iter().all(|output| keeps_bytes(original.files, output));
        verification.note("every byte of the original is kept", bytes_kept);
        text_holds &= bytes_kept;
    }
    let simulation = run_again(outputs, &settings.entry, model, &settings.options);
    let simulation = simulation.unwrap_or_else(|_| {
        verification.note("the emitted program has its entry", false);
        text_holds = false;
        empty_simulation()
    });
    let mut simulated = Simulated::with_energy(model, simulation);
    let mut wait_faults = BTreeMap::new();
    if let (Rewrite::Streams { waits, .. }, true) = (rewrite, text_holds) {
        (simulated, wait_faults) = with_waits_folded(model, settings, simulated, waits);
        verification.note("waits that are spent elsewhere take their time", wait_faults.is_empty());
    }
    let before = &original.cycle.simulation;
    let order_kept = same_order(before, &simulated.simulation);
    verification.note("movements, waits and outputs come in the same order", order_kept);
    let cycle_kept = keeps_cycle(settings.budget, before.cycle_s, simulated.simulation.cycle_s);
    verification.note("the cycle takes no longer than allowed", cycle_kept);

    let mut attempt = Attempt { simulated, verification, failed: Vec::new(), wait_faults };
    match rewrite {
        Rewrite::Streams { candidates, waits } => {
            let emitted = &attempt.simulated.simulation;
            attempt.failed = if !text_holds {
                all_failed(candidates, "the emitted text could not be read again")
            } else if !order_kept && waits.is_empty() {
                reordering(original, emitted, candidates)
            } else if order_kept && !cycle_kept {
                slowing(original, emitted, candidates)
            } else {
                Vec::new()
            };
            if !order_kept {
                // The order is checked again without relocated waits before a stream is refused.
                for index in 0..waits.len() {
                    attempt.wait_faults.entry(index).or_insert(Fault::Other);
                }
            } else if attempt.failed.is_empty() {
                let verification = &mut attempt.verification;
                attempt.failed =
                    compare_streams(original, emitted, model, settings, candidates, verification);
            }
        }
        Rewrite::Speeds { slots, factors } if order_kept => {
            let emitted = &attempt.simulated.simulation;
            let (speeds, verification) = ((slots, factors), &mut attempt.verification);
            compare_speeds(original, emitted, model, settings, speeds, verification);
        }
        Rewrite::Speeds { .. } => {}
    }
    attempt.verification.passed &= attempt.failed.is_empty();
    attempt
}

/// The simulation of a program that cannot be read.
fn empty_simulation() -> Simulation {
    Simulation {
        events: Vec::new(),
        cycle_s: 0.0,
        repeats_from: None,
        unresolved: Vec::new(),
        assumed: Vec::new(),
        inputs_asked: BTreeSet::new(),
    }
}

/// Whether the output contains all bytes of the original in order.
fn keeps_bytes(files: &[Source], output: &OutputFile) -> bool {
    match (output.kind, output.input) {
        (OutputKind::Changed, Some(i)) => is_subsequence(&files[i].file.bytes, &output.bytes),
        (OutputKind::Unchanged, Some(i)) => files[i].file.bytes == output.bytes,
        _ => true,
    }
}

/// Whether `whole` contains all bytes of `part` in order.
fn is_subsequence(part: &[u8], whole: &[u8]) -> bool {
    let mut rest = whole.iter();
    part.iter().all(|byte| rest.any(|other| other == byte))
}

/// Whether a cycle keeps its time limit; times in s.
fn keeps_cycle(budget: Budget, before_s: f64, after_s: f64) -> bool {
    match budget {
        Budget::AsBefore => after_s <= before_s + TIME_TOLERANCE,
        Budget::Takt(takt) => after_s <= takt.max(before_s) + TIME_TOLERANCE,
        Budget::Factor(_) => true,
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::super::files::unchanged;
    use super::*;
    use crate::arm::robot::find;
    use crate::rapid::text::{FileId, SourceFile};

    const PROGRAM: &str = "MODULE m\n\
        CONST robtarget pC:=[[850,300,1000],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
        PROC main()\n\
        MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n\
        MoveJ pC,v500,fine,tool0;\n\
        SetDO doA,1;\nWaitTime 0.5;\nSetDO doB,1;\n\
        ENDPROC\nENDMODULE\n";

    /// Whether verification passes after a text replacement.
    fn holds(from: &str, to: &str, rewrite: Rewrite<'_>) -> bool {
        let file = SourceFile::new(FileId(0), "m.mod".into(), PROGRAM.into());
        let files = [Source { file, relative: "m.mod".into() }];
        let (model, settings) = (find("IRB1600-10/1.45").unwrap(), Settings::default());
        let (program, entry) = read_program(&files, "main").unwrap();
        let cycle = Simulated::new(&program, entry, &model, &settings.options);
        assert_eq!((cycle.simulation.events.len(), cycle.simulation.unresolved.len()), (5, 0));
        let (sites, lowered) = (Vec::new(), Vec::new());
        let original = Original { files: &files, program: &program, entry, cycle, sites, lowered };
        let mut outputs = unchanged(&files);
        let text = PROGRAM.replace(from, to);
        outputs[0] = OutputFile::changed(0, &files[0], text.into_bytes());
        let attempt = verify(&original, &outputs, &model, &settings, rewrite);
        let order = "movements, waits and outputs come in the same order";
        let checks = &attempt.verification.checks;
        let held = checks.iter().find(|(what, _)| what == order).unwrap().1;
        assert_eq!(held, attempt.verification.passed, "{checks:?}");
        held
    }

    #[test]
    fn another_order_in_the_emitted_text_fails() {
        let rewrites = [
            Rewrite::Speeds { slots: &[], factors: &[] },
            Rewrite::Streams { candidates: &[], waits: &[] },
        ];
        for rewrite in rewrites {
            assert!(holds("", "", rewrite));
            assert!(!holds("WaitTime 0.5;", "SetDO doA,0;WaitTime 0.5;", rewrite));
        }
        let speeds = rewrites[0];
        assert!(!holds(
            "SetDO doA,1;\nWaitTime 0.5;\nSetDO doB,1;",
            "SetDO doB,1;\nWaitTime 0.5;\nSetDO doA,1;",
            speeds
        ));
        assert!(!holds("SetDO doA,1;\nWaitTime 0.5;", "WaitTime 0.5;\nSetDO doA,1;", speeds));
        assert!(!holds("MoveJ pC", "MoveL pC", speeds));
    }
}

//! Which slack of recorded waits may be used up, and from where on.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

#[path = "support/mod.rs"]
mod support;

use std::fmt::Write as _;

use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::arrivals::{Anchor, Arrival};
use joulepath::retime::motion::{Options, simulate};
use joulepath::tool::cell::events;
use joulepath::tool::cell::slack::{Planned, plan};
use joulepath::tool::cell::waits::file::{EventEntry, WaitsFile};
use joulepath::tool::cell::waits::{Log, find, record};
use joulepath::tool::retrofit::read_program;
use support::{irb1600, sources};

const CYCLES: usize = 60;
const RISK: f64 = 0.05;

/// A robot between a press (line 4, which `doPress` starts in line 6) and a belt (line 8).
const PROGRAM: &str = "MODULE M\nPROC main()\n\
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n\
    WaitDI diPress,1;\n\
    MoveAbsJ [[40,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n\
    SetDO doPress,1;\n\
    MoveAbsJ [[80,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n\
    WaitDI diBelt,1;\nENDPROC\nENDMODULE\n";

/// A wait that is slack, of 2 s in each cycle.
fn wait(line: u32, signal: &str, after: &str) -> String {
    format!(
        "[[wait]]\nfile = \"M.mod\"\nline = {line}\nsignal = \"{signal}\"\nkind = \"slack\"\nreason = \"counts-from\"\n\
         n = {CYCLES}\ncompared = {CYCLES}\nlog_odds = 99.0\n[wait.after]\n{after}\n"
    )
}

fn waits(entries: &[String], lines: &[u32]) -> WaitsFile {
    let list = |value: f64| vec![value.to_string(); CYCLES].join(",");
    let mut text = format!("format = 1\ncycles = {CYCLES}\n{}", entries.concat());
    write!(text, "[[way]]\nshare = 1.0\ncycle_s = [{}]\n", list(9.5)).unwrap();
    for line in lines {
        write!(
            text,
            "[[way.record]]\nfile = \"M.mod\"\nline = {line}\noccurrence = 0\ncame_s = [{}]\nsignal_s = [{}]\n",
            list(3.5),
            list(5.5)
        )
        .unwrap();
    }
    WaitsFile::parse(&text).unwrap()
}

fn planned(waits: &WaitsFile) -> Planned {
    let files = sources(vec![SourceFile::new(FileId(0), "M.mod".into(), PROGRAM.into())]);
    let model = irb1600();
    let (program, entry) = read_program(&files, "main").unwrap();
    let simulated = |options: &Options| simulate(&program, entry, &model, options);
    plan(waits, (&files, ""), RISK, &Options::default(), &simulated).unwrap()
}

fn anchors(planned: &Planned) -> Vec<Anchor> {
    planned.arrivals.iter().map(|Arrival { after, .. }| *after).collect()
}

#[test]
fn slack_does_not_delay_what_starts_another_machine() {
    let press = "event = \"output\"\nbefore = true\nfile = \"M.mod\"\nline = 6\nsignal = \"doPress\"\nlevel = 1.0";
    let belt = "event = \"cycle\"\nbefore = false";
    let both = planned(&waits(&[wait(4, "diPress", press), wait(8, "diBelt", belt)], &[4, 8]));
    // Before the output the robot may use the slack of the press, behind it that of the belt.
    assert_eq!(anchors(&both), [Anchor::Cycle, Anchor::Output(0)]);
    assert_eq!(both.uses.len(), 2);
    assert!(
        both.notes
            .iter()
            .any(|note| note.contains("M.mod:8") && note.contains("a part of the way")),
        "{both:?}"
    );
    // A press with a clock of its own is not delayed.
    let clocks = planned(&waits(&[wait(4, "diPress", belt), wait(8, "diBelt", belt)], &[4, 8]));
    assert_eq!(anchors(&clocks), [Anchor::Cycle, Anchor::Cycle]);
    assert!(clocks.notes.is_empty(), "{clocks:?}");
}

/// A belt gives a part every 10 s. The robot begins its cycle up to 1.5 s after the end of the last one; in each
/// tenth cycle it comes 3.5 s late.
fn belt() -> String {
    let mut text =
        "# joulepath recorder 1\n# program 3f2a9c0d11e8a4b7\n# session 2026-11-29 06:00:00\n\
                    t,cycle,cmd,file,line,event,value,signal\n"
            .to_owned();
    let mut t = 0.0;
    for i in 0..200 {
        let begin = t + 1.5 * (f64::from(i) * 0.754_877).fract();
        let late = if i % 10 == 5 { 3.5 } else { 0.6 * (f64::from(i) * 0.618_034).fract() };
        let (cycle, came) = (i + 1, begin + 7.0 + late);
        let ended = f64::max(came + 0.002, 10.0 * f64::from(i + 1));
        for (t, rest) in [
            (begin, "0,,,cycle,,"),
            (begin + 0.001, "1,M.mod,7,start,,"),
            (came, "1,M.mod,7,arrive,,"),
            (came + 0.001, "1,M.mod,8,wait,,diBelt"),
            (ended, "1,M.mod,8,end,0,diBelt"),
        ] {
            writeln!(text, "{t:.3},{cycle},{rest}").unwrap();
        }
        t = ended + 0.01;
    }
    text
}

#[test]
fn cycles_without_the_event_that_slack_counts_from_are_not_left_out() {
    let recording = events::read(belt().as_bytes()).unwrap();
    let found = find(&[Log { name: "belt".to_owned(), recording }], None).unwrap();
    let file = record(&found);
    let after = file.wait[0].after.as_ref().unwrap();
    // A wait that is over at once has no end that a machine could count from.
    assert!(after.event == EventEntry::End && after.before, "{after:?}");
    let [way] = file.way.as_slice() else { panic!("{file:?}") };
    // The first cycle has none before it, and the log cuts the last one.
    assert_eq!(way.cycle_s.len(), 198);
}

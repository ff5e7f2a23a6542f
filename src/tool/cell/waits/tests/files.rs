//! `waits.toml` is read as it was written, and what is wrong with one is said by name.

use super::recorder::{Chance, Recorder};
use crate::tool::cell::waits::file::{EventEntry, KindEntry, WaitsFile};
use crate::tool::cell::waits::{Log, WaitsError, find, record};

/// A robot between an operator and a machine; every fourth cycle it sets a part aside.
fn recording(seed: u64, program: &str) -> Log {
    let mut chance = Chance::new(seed);
    let mut log = Recorder::new(0.001);
    let mut started = 0.0;
    for i in 0..120 {
        log.cycle();
        log.travel(5, 4.0 + chance.normal(0.01));
        let at = log.t + 2.0 + chance.normal(4.0).abs();
        log.wait(10, "diPart", at);
        if i % 4 == 3 {
            log.travel(12, 2.0);
        }
        log.travel(25, 9.0 + chance.normal(0.01));
        log.wait(30, "diDoor", started + 35.0 + chance.normal(0.4));
        started = log.output(45, "doStart");
        log.travel(50, 4.0);
    }
    let mut log = log.log(&format!("{seed}.csv"));
    log.recording.program = Some(program.to_owned());
    log
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let found = find(&[recording(1, "aa"), recording(2, "aa")], Some("aa")).expect("waits");
    let file = record(&found);
    let text = file.text().expect("a text");
    assert_eq!(WaitsFile::parse(&text).expect("a file"), file, "{text}");
    let door = file.wait.iter().find(|wait| wait.line == 30).expect("the door");
    assert_eq!(door.kind, KindEntry::Slack);
    let after = door.after.as_ref().expect("a reference");
    assert_eq!((after.event, after.before, after.line), (EventEntry::Output, true, Some(45)));
    let [often, seldom] = &file.way[..] else { panic!("two ways") };
    assert!((often.share - 0.75).abs() < 0.02 && (seldom.share - 0.25).abs() < 0.02);
    // The first cycle of a recording has no start of the machine before it.
    let complete = often.cycle_s.len() + seldom.cycle_s.len();
    assert_eq!(complete, found.shift.cycles.len() - 2);
    let record = often.record.iter().find(|record| record.line == 30).expect("the door");
    for (came, signal) in record.came_s.iter().zip(&record.signal_s) {
        assert!((signal - 35.0).abs() < 3.0 && *came < 35.0, "{came} {signal}");
    }
}

fn fault(text: &str) -> String {
    WaitsFile::parse(text).expect_err(text).to_string()
}

#[test]
fn faults_of_a_file_are_named() {
    let file = record(&find(&[recording(1, "aa")], None).expect("waits"));
    let text = file.text().expect("a text");
    let unknown = text.replace("share =", "part =");
    assert!(fault(&unknown).contains("unknown field `part`"), "{}", fault(&unknown));
    assert!(fault(&unknown).starts_with("line "), "{}", fault(&unknown));
    let later = text.replace("format = 1", "format = 9");
    assert!(fault(&later).contains("this version reads format 1"));
    let mut short = file.clone();
    short.way[0].record[0].came_s.pop();
    assert!(fault(&short.text().expect("a text")).contains("came_s has"));
    let mut nowhere = file.clone();
    nowhere.wait[1].after = None;
    assert!(fault(&nowhere.text().expect("a text")).contains("has no `after`"));
    let mut endless = file.clone();
    endless.way[0].cycle_s[0] = f64::INFINITY;
    assert!(fault(&endless.text().expect("a text")).contains("not finite"));
    let mut other = file;
    other.wait.remove(0);
    assert!(fault(&other.text().expect("a text")).contains("no [[wait]]"));
    assert!(fault("waits?").contains("line 1"));
}

#[test]
fn logs_that_do_not_belong_together_are_refused() {
    let (one, two) = (recording(1, "aa"), recording(2, "bb"));
    let error = find(&[one.clone(), two], None).expect_err("two programs").to_string();
    assert!(error.contains("2.csv is of the program bb, 1.csv of the program aa"), "{error}");
    let error = find(std::slice::from_ref(&one), Some("cc")).expect_err("another").to_string();
    assert!(error.contains("program aa") && error.contains("cc"), "{error}");
    let error = find(&[one.clone(), one], None).expect_err("one twice");
    assert!(matches!(error, WaitsError::SameSession { .. }), "{error}");
}

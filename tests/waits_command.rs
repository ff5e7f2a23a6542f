//! `waits` on the command line: what it writes, and what it says of logs that cannot be used.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use command::{joulepath, json, refused, run, stderr, stdout};
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::tool::cell::program_hash;
use joulepath::tool::retrofit::Source;
use tempfile::TempDir;

/// The hash in the logs.
const HASH: &str = "3f2a9c0d11e8a4b7";
const HEAD: &str = "# joulepath recorder 1\n# program 3f2a9c0d11e8a4b7\n# session 2026-11-29 06:00:00\n\
                    t,cycle,cmd,file,line,event,value,signal\n";

/// A log of a robot that feeds a machine: the operator (line 12) takes different times, the machine
/// (line 16) 40 s from its start at line 18 of the cycle before, the gripper (line 14) 0.3 s.
fn log(cycles: usize) -> String {
    let mut text = HEAD.to_owned();
    // Numbers that repeat in no short time.
    let noise =
        |i: usize, k: usize| (((i * 7919 + k * 104_729) as f64 * 0.618_034).fract() - 0.5) * 2.0;
    let (mut t, mut started) = (0.0, 0.0);
    let mut row = |t: f64, rest: &str| writeln!(text, "{t:.3},{rest}").unwrap();
    for i in 0..cycles {
        let cycle = i + 1;
        row(t, &format!("{cycle},0,,,cycle,,"));
        row(t, &format!("{cycle},1,Cell.mod,11,start,,"));
        t += 5.0;
        row(t, &format!("{cycle},1,Cell.mod,11,arrive,,"));
        row(t + 0.001, &format!("{cycle},1,Cell.mod,12,wait,,diPart"));
        t += 5.0 + 4.0 * noise(i, 1);
        row(t, &format!("{cycle},1,Cell.mod,12,end,0,diPart"));
        row(t + 0.001, &format!("{cycle},2,Cell.mod,13,start,,"));
        t += 3.0;
        row(t, &format!("{cycle},2,Cell.mod,13,arrive,,"));
        row(t + 0.001, &format!("{cycle},2,Cell.mod,13,output,1,doGrip"));
        row(t + 0.002, &format!("{cycle},2,Cell.mod,14,wait,,diGripped"));
        t += 0.3 + 0.03 * noise(i, 2);
        row(t, &format!("{cycle},2,Cell.mod,14,end,0,diGripped"));
        row(t + 0.001, &format!("{cycle},3,Cell.mod,15,start,,"));
        t += 8.0;
        row(t, &format!("{cycle},3,Cell.mod,15,arrive,,"));
        row(t + 0.001, &format!("{cycle},3,Cell.mod,16,wait,,diDone"));
        t = f64::max(t + 0.002, started + 40.0 + 0.5 * noise(i, 3));
        row(t, &format!("{cycle},3,Cell.mod,16,end,0,diDone"));
        row(t + 0.001, &format!("{cycle},4,Cell.mod,17,start,,"));
        t += 4.0;
        row(t, &format!("{cycle},4,Cell.mod,17,arrive,,"));
        row(t + 0.001, &format!("{cycle},4,Cell.mod,18,output,1,doStart"));
        started = t + 0.001;
        t += 0.01;
    }
    text
}

const PROGRAM: &str = "MODULE Cell\n\n\n\n\n\n\n\n\nPROC main()\nMoveJ a,v500,fine,tool0;\nWaitDI diPart,1;\n\
MoveJ b,v500,fine,tool0;\nWaitDI diGripped,1;\nMoveJ c,v500,fine,tool0;\nWaitDI diDone,1;\n\
MoveJ d,v500,fine,tool0;\nSetDO doStart,1;\nENDPROC\nENDMODULE\n";

fn at(folder: &TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// The log with the hash of the program.
fn of_program(log: &str) -> String {
    let file = SourceFile::new(FileId(0), "Cell.mod".into(), PROGRAM.into());
    let hash = program_hash(&[Source { file, relative: "Cell.mod".into() }]);
    log.replace(HASH, &hash)
}

fn path(folder: &TempDir, name: &str) -> String {
    Path::join(folder.path(), name).display().to_string()
}

#[test]
fn slack_and_process_are_told_apart() {
    let folder = TempDir::new().unwrap();
    let shift = at(&folder, "shift.csv", &of_program(&log(160)));
    let program = at(&folder, "Cell.mod", PROGRAM);
    let (out, page) = (path(&folder, "waits.toml"), path(&folder, "waits.html"));
    let args = ["waits", &shift, "--program", &program, "--out", &out, "--report", &page];
    let found = json(&[&args[..], &["--format", "json", "--quiet"]].concat());
    let kind = |line: u64| {
        let waits = found["waits"].as_array().unwrap();
        let wait = waits.iter().find(|wait| wait["line"] == line).unwrap();
        assert_eq!(wait["quantiles_s"].as_array().unwrap().len(), 5);
        wait["kind"].as_str().unwrap().to_owned()
    };
    assert_eq!([kind(14), kind(16)], ["process", "slack"], "{found:#}");
    let written = fs::read_to_string(&out).unwrap();
    let hash = of_program(HASH);
    assert!(written.contains(&format!("program = \"{hash}\"")), "{written}");
    assert!(written.contains("signal = \"doStart\"") && written.contains("came_s"), "{written}");
    let page = fs::read_to_string(&page).unwrap();
    assert!(page.contains("WaitDI diDone,1;") && page.contains("robot moves"), "{page}");
    assert!(!page.contains("NaN"), "{page}");
    let text = stdout(&run(&["waits", &shift, "--program", &program, "--out", &out]));
    assert!(text.contains("after output doStart = 1 in the cycle before at Cell.mod:18"), "{text}");
    // The same input gives the same bytes.
    assert_eq!(fs::read_to_string(&out).unwrap(), written);
}

#[test]
fn where_the_log_does_not_tell_an_experiment_is_proposed() {
    let folder = TempDir::new().unwrap();
    let (shift, out) = (at(&folder, "shift.csv", &log(9)), path(&folder, "waits.toml"));
    let found = json(&["waits", &shift, "--out", &out, "--format", "json", "--quiet"]);
    for wait in found["waits"].as_array().unwrap() {
        assert_eq!(wait["kind"], "unknown", "{found:#}");
        let command = wait["experiment"]["command"].as_str().unwrap();
        assert!(
            command.contains("instrument PROGRAM --robot ROBOT --out DIR --late Cell.mod:"),
            "{command}"
        );
    }
    let text = stdout(&run(&["waits", &shift, "--out", &out, "--quiet"]));
    assert!(text.contains("to tell what Cell.mod:16 is, record"), "{text}");
}

#[test]
fn unusable_logs_are_said_by_name() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "waits.toml");
    let whole = log(40);
    let refuse = |name: &str, text: &str, way_out: &str| {
        let log = at(&folder, name, text);
        let message = refused(&["waits", &log, "--out", &out], way_out);
        assert!(message.contains(name), "{message}");
        assert!(!Path::new(&out).exists(), "{name}: a file was written");
    };
    refuse("empty.csv", "", "no log of events");
    refuse("power.csv", "t,power\n0,1\n", "no log of events");
    refuse("none.csv", &log(1), "no complete cycle");
    let (first, rest) = whole.split_at(whole.len() / 2);
    let cut = first.rfind('\n').unwrap() + 1;
    let tail = &rest[rest.find('\n').unwrap() + 1..];
    refuse(
        "versions.csv",
        &format!("{}# program 0000000000000000\n{tail}", &first[..cut]),
        "the program changes",
    );
    let back = |by: f64| -> String {
        let rows = tail.lines().map(|row| {
            let (t, rest) = row.split_once(',').unwrap();
            format!("{:.3},{rest}\n", t.parse::<f64>().unwrap() + by)
        });
        first[..cut].to_owned() + &rows.collect::<String>()
    };
    refuse("midnight.csv", &back(-86_400.0), "midnight");
    refuse("autumn.csv", &back(-3600.0), "summer time");
    let robots: String = first[..cut]
        .lines()
        .flat_map(|row| {
            let other =
                row.split_once(',').filter(|_| row.starts_with(|c: char| c.is_ascii_digit()));
            let other = other.and_then(|(t, rest)| {
                let (cycle, rest) = rest.split_once(',')?;
                Some(format!("{t},{},{rest}\n", cycle.parse::<u64>().ok()? + 500))
            });
            [Some(format!("{row}\n")), other]
        })
        .flatten()
        .collect();
    refuse("robots.csv", &robots, "two robots");
    let (one, other) = (at(&folder, "one.csv", &whole), whole.replace("3f2a9c0d", "ffffffff"));
    let other = at(&folder, "other.csv", &other);
    let message = refused(&["waits", &one, &other, "--out", &out], "ffffffff11e8a4b7");
    assert!(message.contains("3f2a9c0d11e8a4b7") && message.contains("other.csv"), "{message}");
    refused(&["waits", &one, &one, "--out", &out], "give each recording once");
    refused(&["waits", &one, "--out", &one], "this file is read");
    refused(&["waits", &path(&folder, "missing.csv"), "--out", &out], "cannot read");
}

#[test]
fn a_log_that_breaks_off_is_used_as_far_as_it_goes() {
    let folder = TempDir::new().unwrap();
    let whole = log(60);
    let (shift, out) =
        (at(&folder, "shift.csv", &whole[..whole.len() - 500]), path(&folder, "w.toml"));
    let output = joulepath(&["waits", &shift, "--out", &out]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("the file ends within the row"), "{}", stderr(&output));
    let program = at(&folder, "Cell.mod", "MODULE Cell\nPROC main()\nENDPROC\nENDMODULE\n");
    refused(
        &["waits", &shift, "--program", &program, "--out", &out],
        "it has changed since the recording",
    );
}

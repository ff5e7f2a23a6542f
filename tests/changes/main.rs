//! A retrofit remains correct when the cell changes: under the same changes, original and retrofit
//! reach the same stops, with the same order of waits and outputs, and the retrofit is not faster.
//! Random changes affect data, tools, work objects, loads, speeds, inputs, settings, other tasks,
//! the start, the robot and the number of passes. `CHANGES=N` draws N of them.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod cell;
mod compare;
#[path = "../support/mod.rs"]
mod support;

use std::collections::BTreeSet;
use std::path::PathBuf;

use joulepath::arm::robot::Model;
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::{Options, Simulation, simulate};
use joulepath::tool::retrofit::{
    Budget, OutputKind, Retrofit, Settings, Source, prefix, read_program, retrofit, without_streams,
};
use rayon::prelude::*;

use cell::{Cell, Change, Changed, Counts, apply, is_within, kind, marked};
use support::{Random, irb1600, module_paths, sources};

/// Default number of changes.
const CHANGES: usize = 10_000;
/// Largest number of simultaneous changes.
const TOGETHER: usize = 3;
/// A program with streams for joint movements and lines.
const MIXED: &str = "pick_place";
/// Programs of `fixtures/cells` with runs that go on in another routine, the shorter ones.
const JOINED: [&str; 10] = [
    "asm_bearing_search.mod",
    "asm_oring.mod",
    "engrave_serial.mod",
    "glue_menu_potting.mod",
    "pal_bags_pinwheel.mod",
    "pal_bottle_rows.mod",
    "pal_tray_array.mod",
    "tend_furnace_hot.mod",
    "tend_saw_bars.mod",
    "weld_stitch_rail.mod",
];
/// Largest relative duration of a run in the tests that request streams everywhere.
const SLOWER: f64 = 1.2;

/// A program, the emitted program, and the possible changes.
struct Case {
    name: String,
    original: Vec<String>,
    emitted: Vec<String>,
    cell: Cell,
    /// Whether it may take longer than the original.
    slower: bool,
}

fn programs() -> Vec<(String, Vec<String>)> {
    let read = |path: &PathBuf| {
        String::from_utf8_lossy(&std::fs::read(path).unwrap()).replace("\r\n", "\n")
    };
    let is_joined = |path: &PathBuf| JOINED.iter().any(|name| path.ends_with(name));
    let cells = module_paths("cells").into_iter().filter(is_joined);
    let small = ["changes", "hard", "lint"].into_iter().flat_map(module_paths);
    let single = small.chain(cells).map(|path| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        (name, vec![read(&path)])
    });
    let several =
        ["pick_place", "paper", "backup/RAPID/TASK2/PROGMOD", "backup/RAPID/TASK2/SYSMOD"]
            .map(|folder| (folder.to_owned(), module_paths(folder).iter().map(read).collect()));
    single.chain(several).collect()
}

fn unchanged(texts: &[String]) -> Vec<Source> {
    sources(apply(texts, &irb1600(), &[]).files)
}

/// Signals of a program: names without declaration that no instruction sets.
fn signals(texts: &[String]) -> Vec<String> {
    let mut found = BTreeSet::new();
    for text in texts {
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        found.extend(
            words.filter(|w| w.starts_with("di") || w.starts_with("gi")).map(str::to_owned),
        );
    }
    found.into_iter().filter(|word| word.len() > 2).collect()
}

/// How a program is retrofitted.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// Whether it may take longer than the original.
    slower: bool,
    /// Whether other tasks may write its `PERS` data at any time, or only while no stream runs.
    elsewhere: bool,
}

const WAYS: [Way; 3] = [
    Way { slower: false, elsewhere: true },
    Way { slower: true, elsewhere: true },
    Way { slower: false, elsewhere: false },
];

fn case((name, texts): (String, Vec<String>), model: &Model, way: Way) -> Option<Case> {
    let mut marks = 0;
    let mut original = Vec::new();
    for text in &texts {
        // Marks are numbered across the files.
        let (marked, count) = marked(text);
        original.push(renumbered(&marked, count, marks));
        marks += count;
    }
    let settings = Settings {
        budget: if way.slower { Budget::Factor(SLOWER) } else { Budget::AsBefore },
        written_elsewhere: if way.elsewhere { shared(&original) } else { BTreeSet::new() },
        // As many streams as possible.
        point_estimate: true,
        inline_targets: true,
        ..Settings::default()
    };
    let result = retrofit(&unchanged(&original), model, &settings, &|_, _| ()).ok()?;
    assert!(result.verification.passed, "{name}");
    let streams = result.segments.iter().filter(|segment| segment.rewritten).count();
    if streams == 0 {
        return None;
    }
    assert_streams_can_be_removed(&name, &original, &result);
    let emitted: Vec<String> = result
        .outputs
        .iter()
        .filter(|output| !output.path.ends_with("txt"))
        .map(|output| String::from_utf8_lossy(&output.bytes).into_owned())
        .collect();
    let whole = emitted.join("\n");
    let mut outside: Vec<usize> = (0..marks).filter(|mark| !is_within(&whole, *mark)).collect();
    if emitted.iter().any(|text| text.contains("jpPutOff:=")) {
        outside.retain(|mark| !is_between(model, (&original, &emitted), *mark));
    }
    let writes = if way.elsewhere { (0..marks).collect() } else { outside.clone() };
    let cell = Cell::new(&original.join("\n"), signals(&original), outside, writes);
    Some(Case { name, original, emitted, cell, slower: way.slower })
}

/// Whether a mark is between two pieces of a run, where a new statement needs another retrofit.
fn is_between(model: &Model, (original, emitted): (&[String], &[String]), mark: usize) -> bool {
    let probe = Change::Statement { mark, text: "WaitTime 0.5;".to_owned() };
    let run = |texts: &[String]| run(apply(texts, model, std::slice::from_ref(&probe)));
    match (run(original), run(emitted)) {
        (Some((before, _)), Some((after, _))) => {
            compare::compare(model, &before, &after, true).is_err()
        }
        _ => false,
    }
}

/// Removing the streams from a retrofit restores the original bytes.
fn assert_streams_can_be_removed(name: &str, original: &[String], result: &Retrofit) {
    let prefix = result.outputs.iter().find_map(|output| prefix(&output.bytes)).unwrap();
    for output in result.outputs.iter().filter(|output| output.kind != OutputKind::New) {
        let file = SourceFile::new(FileId(0), output.path.clone(), output.bytes.clone());
        let taken = String::from_utf8(without_streams(&file, &prefix)).unwrap();
        assert_eq!(taken, original[output.input.unwrap()], "{name}");
    }
}

/// PERS data of the programs, which other tasks may write.
fn shared(texts: &[String]) -> BTreeSet<String> {
    let cell = Cell::new(&texts.join("\n"), Vec::new(), Vec::new(), Vec::new());
    cell.shared.into_iter().map(|(name, _)| name.to_lowercase()).collect()
}

fn renumbered(text: &str, count: usize, from: usize) -> String {
    (0..count)
        .rev()
        .fold(text.to_owned(), |text, i| text.replace(&cell::mark(i), &cell::mark(from + i)))
}

fn run(changed: Changed) -> Option<(Simulation, Model)> {
    let (program, entry) = read_program(&sources(changed.files), "main").ok()?;
    let options = Options { max_time: Some(600.0), ..changed.options };
    Some((simulate(&program, entry, &changed.model, &options), changed.model))
}

#[test]
fn original_and_retrofit_agree_under_every_change() {
    let model = irb1600();
    let count = std::env::var("CHANGES").ok().and_then(|count| count.parse().ok());
    let count: usize = count.unwrap_or(CHANGES);
    let programs = programs();
    let cases: Vec<Case> = programs
        .par_iter()
        .flat_map(|program| WAYS.map(|way| (program.clone(), way)))
        .filter_map(|(program, way)| case(program, &model, way))
        .collect();
    let results: Vec<(Option<String>, Vec<&'static str>, bool)> = (0..count)
        .into_par_iter()
        .map(|draw| {
            let case = &cases[draw % cases.len()];
            let mut random = Random(draw as u64 * 7919 + 1);
            let changes: Vec<Change> =
                (0..=random.below(TOGETHER)).map(|_| case.cell.draw(&mut random)).collect();
            let kinds = changes.iter().map(kind).collect();
            let before = run(apply(&case.original, &model, &changes));
            let after = run(apply(&case.emitted, &model, &changes));
            let (before, robot, after) = match (before, after) {
                (Some((before, robot)), Some((after, _))) => (before, robot, after),
                // The change makes both programs unreadable.
                (None, None) => return (None, kinds, false),
                (before, _) => {
                    let which = if before.is_some() { "retrofit" } else { "original" };
                    let fault = format!(
                        "{draw} {}: {changes:?}: only the {which} can't be read",
                        case.name
                    );
                    return (Some(fault), kinds, false);
                }
            };
            let streams = compare::streams(&after) > 0;
            let fault = compare::compare(&robot, &before, &after, case.slower).err();
            (fault.map(|why| format!("{} {}: {changes:?}: {why}", draw, case.name)), kinds, streams)
        })
        .collect();
    let mut counts = Counts::new();
    for name in results.iter().flat_map(|(_, kinds, _)| kinds) {
        *counts.entry(name).or_default() += 1;
    }
    let faults: Vec<&String> = results.iter().filter_map(|(fault, ..)| fault.as_ref()).collect();
    let with_streams = results.iter().filter(|(_, _, streams)| *streams).count();
    let summary = format!(
        "{} cases of {} of {} programs, {count} draws, {with_streams} with streams, {counts:?}",
        cases.len(),
        cases.iter().map(|case| &case.name).collect::<BTreeSet<_>>().len(),
        programs.len(),
    );
    // The test requires enough streams to be meaningful.
    assert!(with_streams * 3 > count, "{summary}");
    let shown: Vec<&str> = faults.iter().take(20).map(|fault| fault.as_str()).collect();
    assert!(faults.is_empty(), "{} faults: {summary}\n{}", faults.len(), shown.join("\n"));
}

/// Settings that are inserted later must not affect a stream that was computed without them.
#[test]
fn settings_added_later_prevent_streams() {
    let model = irb1600();
    let (name, texts) = programs().into_iter().find(|(name, _)| name == MIXED).unwrap();
    let case = case((name, texts), &model, WAYS[2]).unwrap();
    let streams = |statement: &str| {
        let change = Change::Statement { mark: case.cell.outside[0], text: statement.to_owned() };
        compare::streams(&run(apply(&case.emitted, &model, &[change])).unwrap().0)
    };
    let usual = streams("ConfJ\\On;");
    assert!(usual > 0);
    for setting in [
        "VelSet 90,5000;",
        "AccSet 90,100;",
        "AccSet 100,90;",
        "AccSet 100,100\\FinePointRamp:=90;",
        "PathAccLim TRUE\\AccMax:=5,FALSE;",
        "WorldAccLim\\On:=5;",
        "SpeedRefresh 90;",
        "PathResol 90;",
        "PDispSet [[0,0,0.01],[1,0,0,0]];",
    ] {
        assert_eq!(streams(setting), 0, "{setting}");
    }
    // Settings of arcs and lines leave only the streams of joint movements.
    for setting in ["CirPathMode\\CirPointOri;", "SingArea\\Wrist;"] {
        assert!(streams(setting) < usual, "{setting}");
    }
}

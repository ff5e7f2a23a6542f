//! Import rules: the wings and rooms of `docs/architecture.md`, checked against the sources.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod layer_paths;
mod rust_source;

use std::collections::BTreeSet;
use std::fs;

use layer_paths::circles::circles;
use layer_paths::{Named, named};
use rust_source::SourceFile;

/// A folder of a wing, and its permitted imports: rooms, or wings for all of their rooms.
struct Room {
    name: &'static str,
    imports: &'static [&'static str],
}

/// A folder of `src`. A wing that is one room has that room's name.
struct Wing {
    name: &'static str,
    rooms: &'static [Room],
}

const fn room(name: &'static str, imports: &'static [&'static str]) -> Room {
    Room { name, imports }
}

const fn wing(name: &'static str, rooms: &'static [Room]) -> Wing {
    Wing { name, rooms }
}

/// From the lowest to the highest; the rooms of a wing, too.
const WINGS: [Wing; 7] = [
    wing(
        "rapid",
        &[
            room("text", &[]),
            room("syntax", &["text"]),
            room("diagnostics", &["text"]),
            room("format", &["text", "syntax"]),
            room("builtins", &[]),
            room("names", &["text", "syntax", "builtins"]),
            room("check", &["text", "syntax", "diagnostics", "builtins", "names"]),
            room("ir", &["text", "syntax", "builtins"]),
        ],
    ),
    wing(
        "arm",
        &[
            room("robot", &[]),
            room("kinematics", &["robot"]),
            room("dynamics", &["robot"]),
            room("effects", &["robot", "dynamics"]),
        ],
    ),
    wing(
        "retime",
        &[
            room("path", &["ir", "robot", "kinematics"]),
            room("motion", &["text", "builtins", "ir", "robot", "kinematics", "dynamics", "path"]),
            room("energy", &["text", "arm", "path", "motion"]),
            room("optimize", &["text", "builtins", "ir", "arm", "path", "motion", "energy"]),
        ],
    ),
    wing(
        "learn",
        &[
            room("log", &[]),
            room("excite", &["robot", "kinematics", "dynamics", "motion"]),
            room("identify", &["robot", "dynamics", "log"]),
            room("calibrate", &["robot", "dynamics", "effects", "motion", "energy", "log"]),
        ],
    ),
    wing("gap", &[room("gap", &["robot", "dynamics", "effects", "log", "identify"])]),
    wing(
        "examine",
        &[
            room("blind", &["robot"]),
            room("injected", &["robot", "dynamics", "log", "identify", "blind"]),
            room("worlds", &["blind"]),
            room("plant", &[]),
        ],
    ),
    wing(
        "tool",
        &[
            room("emit", &["text", "syntax", "ir"]),
            room("retrofit", &["rapid", "arm", "retime", "emit"]),
            room("generate", &["rapid", "arm", "retime", "emit", "retrofit"]),
            room("lint", &["rapid", "arm", "path", "motion", "energy"]),
            room("place", &["rapid", "arm", "retime", "retrofit", "lint"]),
            room("suggest", &["rapid", "arm", "retime", "retrofit", "lint"]),
            room("cell", &["rapid", "arm", "retime", "log", "emit", "retrofit"]),
            room("compare", &["rapid", "robot", "motion", "energy"]),
            room("config", &["format", "lint"]),
            room(
                "report",
                &[
                    "rapid", "arm", "retime", "learn", "gap", "examine", "retrofit", "lint",
                    "place", "suggest", "cell", "compare",
                ],
            ),
            room("lsp", &["rapid", "arm", "retime", "lint"]),
            room(
                "cli",
                &[
                    "rapid", "arm", "retime", "learn", "gap", "examine", "emit", "retrofit",
                    "generate", "lint", "place", "suggest", "cell", "compare", "config", "report",
                    "lsp",
                ],
            ),
        ],
    ),
];

/// A name that only some files may use.
struct Reserved {
    /// A crate or a module of the standard library.
    path: &'static [&'static str],
    /// Files, or folders with a trailing `/`.
    places: &'static [&'static str],
    why: &'static str,
}

const FILES_AND_TERMINALS: &[&str] = &["src/tool/cli/", "src/main.rs"];
const LOADERS: &[&str] = &["src/tool/cli/", "src/main.rs", "src/arm/robot/load.rs"];
const PURE: &str = "the core is made of pure functions: files, clocks and terminals stay outside";

const RESERVED: [Reserved; 15] = [
    Reserved { path: &["lsp_server"], places: &["src/tool/lsp/"], why: "only the server knows it" },
    Reserved {
        path: &["gen_lsp_types"],
        places: &["src/tool/lsp/"],
        why: "only the server knows it",
    },
    Reserved {
        path: &["nom"],
        places: &["src/rapid/syntax/"],
        why: "only the lexer and parser know it",
    },
    Reserved {
        path: &["clarabel"],
        places: &["src/retime/optimize/cone.rs"],
        why: "one file stands between the programs and their solver",
    },
    Reserved {
        path: &["tera"],
        places: &["src/tool/emit/", "src/tool/report/"],
        why: "only text for others is made by templates",
    },
    Reserved {
        path: &["csv"],
        places: &["src/learn/log/", "src/tool/generate/table.rs", "src/tool/cell/events/read.rs"],
        why: "only readers of tables know it",
    },
    Reserved {
        path: &["clap"],
        places: &["src/tool/cli/"],
        why: "options become plain settings there",
    },
    Reserved {
        path: &["anyhow"],
        places: &["src/tool/cli/"],
        why: "below the command line errors are enums",
    },
    Reserved { path: &["indicatif"], places: FILES_AND_TERMINALS, why: PURE },
    Reserved { path: &["tempfile"], places: FILES_AND_TERMINALS, why: PURE },
    Reserved { path: &["std", "fs"], places: LOADERS, why: PURE },
    Reserved { path: &["std", "env"], places: LOADERS, why: PURE },
    Reserved { path: &["std", "process"], places: FILES_AND_TERMINALS, why: PURE },
    Reserved { path: &["std", "time"], places: FILES_AND_TERMINALS, why: PURE },
    Reserved { path: &["std", "net"], places: FILES_AND_TERMINALS, why: PURE },
];

/// All rooms in order, each with the name of its wing.
fn rooms() -> impl Iterator<Item = (&'static str, &'static Room)> {
    WINGS.iter().flat_map(|wing| wing.rooms.iter().map(|room| (wing.name, room)))
}

fn wing_named(name: &str) -> Option<&'static Wing> {
    WINGS.iter().find(|wing| wing.name == name)
}

/// The room of a path below the crate's root; `None` for the root and a wing's `mod.rs`.
fn room_of(wing: &str, next: Option<&str>) -> Option<&'static Room> {
    let wing = wing_named(wing)?;
    match wing.rooms {
        [only] if only.name == wing.name => Some(only),
        rooms => rooms.iter().find(|room| Some(room.name) == next),
    }
}

/// The room of a file.
fn room_of_file(path: &str) -> Option<&'static Room> {
    let mut parts = path.strip_prefix("src/")?.split('/');
    room_of(parts.next()?, parts.next())
}

/// The entry of a room's table that permits the import of `to`.
fn entry(from: &Room, to: &Room) -> Option<&'static str> {
    let wing = rooms().find(|(_, room)| room.name == to.name).map(|(wing, _)| wing);
    from.imports.iter().copied().find(|entry| *entry == to.name || Some(*entry) == wing)
}

/// Violations of the tables in a file, one line each.
fn violations(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for Named { line, path: names } in named(path, text) {
        let shown = names.join("::");
        let forbidden = match names.as_slice() {
            [root, wing, next @ ..] if root == "crate" => {
                import(path, wing, next.first().map(String::as_str))
            }
            _ => None,
        };
        let reserved = RESERVED.iter().find(|reserved| {
            names.len() >= reserved.path.len()
                && names.iter().zip(reserved.path).all(|(a, b)| a == b)
                && !reserved.places.iter().any(|place| {
                    path == *place || (place.ends_with('/') && path.starts_with(place))
                })
        });
        let why = forbidden.or_else(|| reserved.map(|reserved| reserved.why.to_owned()));
        if let Some(why) = why {
            found.push(format!("{path}:{line}: {shown}: {why}"));
        }
    }
    found
}

/// The reason why a file may not import `crate::wing::next`.
fn import(path: &str, wing: &str, next: Option<&str>) -> Option<String> {
    let from = room_of_file(path)?;
    if wing_named(wing).is_none() {
        return Some(format!("'{wing}' is no wing: write the path from the wing's name on"));
    }
    // The visibility `pub(in crate::wing)` imports nothing.
    if next.is_none() && path.starts_with(&format!("src/{wing}/")) {
        return None;
    }
    let Some(to) = room_of(wing, next) else {
        return Some(format!("'{wing}' has no such room: write the path from the room's name on"));
    };
    if to.name == from.name || entry(from, to).is_some() {
        return None;
    }
    Some(match from.imports {
        [] => format!("{} imports no other room", from.name),
        allowed => format!("{} may import only {}", from.name, allowed.join(", ")),
    })
}

#[test]
fn every_import_goes_down() {
    let sources = rust_source::files(&["src"]);
    assert!(sources.len() > 100, "the sources were not found");
    let found: Vec<String> =
        sources.iter().flat_map(|file| violations(&file.path, &file.text)).collect();
    assert!(
        found.is_empty(),
        "{} imports break the table (docs/architecture.md):\n{}",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn every_folder_is_a_room() {
    for file in rust_source::files(&["src"]) {
        let parts: Vec<&str> = file.path.split('/').skip(1).collect();
        let at_the_top = matches!(parts.as_slice(), ["lib.rs" | "main.rs"] | [_, "mod.rs"]);
        let known = at_the_top || room_of_file(&file.path).is_some();
        assert!(known, "{} is in no room: add its folder to WINGS", file.path);
    }
}

#[test]
fn rooms_are_in_order() {
    let mut below = BTreeSet::new();
    for wing in &WINGS {
        for room in wing.rooms {
            for import in room.imports {
                assert!(
                    below.contains(import),
                    "{} imports {import}, which does not stand below it",
                    room.name
                );
            }
            below.insert(room.name);
        }
        below.insert(wing.name);
    }
}

/// Entries of the table without a corresponding `use`, one line each.
fn unused_entries(sources: &[SourceFile]) -> Vec<String> {
    let mut used = BTreeSet::new();
    for file in sources {
        let Some(from) = room_of_file(&file.path) else { continue };
        for Named { path, .. } in named(&file.path, &file.text) {
            let [root, wing, next @ ..] = path.as_slice() else { continue };
            if root == "crate"
                && let Some(to) = room_of(wing, next.first().map(String::as_str))
                && let Some(entry) = entry(from, to)
            {
                used.insert((from.name, entry));
            }
        }
    }
    rooms()
        .flat_map(|(_, room)| room.imports.iter().map(|entry| (room.name, *entry)))
        .filter(|edge| !used.contains(edge))
        .map(|(room, entry)| format!("{room} does not import {entry}: take it out of WINGS"))
        .collect()
}

#[test]
fn every_entry_of_the_table_is_used() {
    let unused = unused_entries(&rust_source::files(&["src"]));
    assert!(unused.is_empty(), "{}", unused.join("\n"));
}

#[test]
fn files_import_each_other_in_no_circle() {
    let sources = rust_source::files(&["src"]);
    let circles = circles(&sources);
    let shown: Vec<String> = circles.iter().map(|files| files.join("\n    ")).collect();
    assert!(circles.is_empty(), "files that import each other:\n    {}", shown.join("\n\n    "));
}

/// The documentation shows the table of this file.
#[test]
fn documentation_shows_the_rooms() {
    let shown = |room: &Room| match room.imports {
        [] => room.name.to_owned(),
        imports => format!("{}({})", room.name, imports.join(", ")),
    };
    let shown = |wing: &Wing| {
        let rooms: Vec<String> = wing.rooms.iter().map(shown).collect();
        [wing.name, "/\n    ", &rooms.join("\n    "), "\n"].concat()
    };
    let table: String = WINGS.iter().map(shown).collect();
    let text = include_str!("../docs/architecture.md");
    assert!(text.contains(&format!("```\n{table}```")), "docs/architecture.md lacks:\n{table}");
}

/// Sources with a violation each, and the expected message.
#[test]
fn forbidden_imports_are_found() {
    let cases = [
        ("src/rapid/syntax/a.rs", "use crate::tool::emit::Names;", "may import only text"),
        ("src/arm/robot/a.rs", "use crate::rapid::text::Span;", "imports no other room"),
        (
            "src/rapid/ir/a.rs",
            "use crate::{\n  rapid::text::Span,\n  arm::robot::{self, Model},\n};",
            "robot",
        ),
        ("src/retime/motion/a/b.rs", "fn f() -> crate::retime::optimize::Site {}", "optimize"),
        ("src/retime/path/a.rs", "use super::super::energy::Account;", "energy"),
        ("src/retime/path/mod.rs", "mod tests { use super::super::cli; }", "no such room"),
        ("src/retime/energy/a.rs", "use crate::nowhere::X;", "is no wing"),
        ("src/retime/energy/a.rs", "use crate::*;", "is no wing"),
        ("src/rapid/ir/a.rs", "use nom::IResult;", "lexer"),
        ("src/retime/optimize/a.rs", "let x = clarabel::solver::Settings::default();", "solver"),
        ("src/retime/motion/a.rs", "use tera::Tera;", "templates"),
        ("src/arm/robot/a.rs", "use std::{io, fs};", "pure"),
        ("src/retime/energy/a.rs", "let now = std::time::Instant::now();", "pure"),
    ];
    for (path, text, message) in cases {
        let found = violations(path, text);
        let is_found = found.iter().any(|line| line.contains(message));
        assert!(is_found, "{path}: {text}\ngave {found:?} and nothing with '{message}'");
    }
}

/// Sources without a violation.
#[test]
fn allowed_imports_are_left_alone() {
    let cases = [
        (
            "src/retime/energy/a.rs",
            "use crate::arm::robot::Model; use crate::retime::path::joint_path::Joints;",
        ),
        (
            "src/tool/retrofit/a.rs",
            "use crate::{tool::emit, rapid::text::Span, retime::optimize::site::Site};",
        ),
        ("src/tool/cli/a.rs", "use crate::tool::report; use clap::Parser; use std::fs;"),
        ("src/arm/robot/load.rs", "use std::fs;"),
        (
            "src/rapid/syntax/a.rs",
            "use nom::{IResult, Parser}; pub(in crate::rapid::syntax) fn f() {}",
        ),
        (
            "src/rapid/text/a.rs",
            "// use crate::tool::cli;\n/* crate::tool::cli::x */ const X: &str = \"crate::tool::cli::x\";",
        ),
        (
            "src/rapid/text/a.rs",
            "const Q: char = '\"'; const R: &str = r#\"crate::tool::cli::\"x\"#;",
        ),
        ("src/rapid/text/a.rs", "fn f<'a>(x: &'a str) { let nom = x; nom.len(); }"),
        ("src/retime/path/mod.rs", "mod tests { use super::*; use super::curve::Curve; }"),
        ("src/rapid/syntax/parser/a.rs", "use super::super::token::Token;"),
        ("src/rapid/ir/a.rs", "pub(in crate::rapid) fn f() {}"),
        ("src/lib.rs", "pub mod cli;"),
    ];
    for (path, text) in cases {
        assert_eq!(violations(path, text), [""; 0], "{path}: {text}");
    }
}

/// Sources with and without a cycle.
#[test]
fn circles_are_found() {
    let file = |path: &str, text: &str| SourceFile { path: path.into(), text: text.into() };
    let parent = file("src/rapid/ir/mod.rs", "mod a; mod b; pub use a::A; fn f() { b::g() }");
    let a = file("src/rapid/ir/a.rs", "use super::b::B; pub struct A;");
    let b = file("src/rapid/ir/b.rs", "#[cfg(test)] mod tests { use super::*; }");
    assert_eq!(circles(&[parent.clone(), a.clone(), b]), [[""; 0]; 0]);
    // Through the parent's export, and through the name that the parent calls.
    let to_sibling = file("src/rapid/ir/b.rs", "use super::a;");
    assert_eq!(circles(&[a.clone(), to_sibling]), [["src/rapid/ir/a.rs", "src/rapid/ir/b.rs"]]);
    let to_parent = file("src/rapid/ir/b.rs", "use super::A;");
    assert_eq!(
        circles(&[a, to_parent, parent]),
        [["src/rapid/ir/a.rs", "src/rapid/ir/b.rs", "src/rapid/ir/mod.rs"]]
    );
}

/// An entry counts as used only if a file names a permitted item.
#[test]
fn unused_entries_are_found() {
    let source =
        |text: &str| SourceFile { path: "src/rapid/syntax/a.rs".into(), text: text.into() };
    let unused = |text: &str| {
        let found = unused_entries(&[source(text)]);
        found.iter().any(|line| line.starts_with("syntax does not import text"))
    };
    assert!(unused("pub struct Nothing;"));
    assert!(!unused("use crate::rapid::text::Span;"));
}

/// Each public module of the root with its exported names, the root first.
fn exported(source: &str) -> String {
    let module = |part: &str| {
        let name = part.split_once(" {").map_or("", |(name, _)| name);
        let name =
            if name.is_empty() || name.contains(char::is_whitespace) { "crate" } else { name };
        let exports = part.split("pub use ").skip(1).map(|text| format!("use {text}"));
        let mut names: Vec<String> = exports
            .flat_map(|text| named("src/lib.rs", &text))
            .filter_map(|named| named.path.last().cloned())
            .collect();
        names.sort();
        [name, ": ", &names.join(", "), "\n"].concat()
    };
    source.split("\npub mod ").map(module).collect()
}

#[test]
fn exported_names_are_these() {
    let source = fs::read_to_string("src/lib.rs").unwrap();
    // The exports follow the declarations of the wings.
    let doors = source.rfind("pub mod tool;").unwrap() + "pub mod tool;".len();
    insta::assert_snapshot!("exported_names", exported(&source[doors..]));
}

#[test]
fn wings_are_private_or_hidden() {
    let source = fs::read_to_string("src/lib.rs").unwrap();
    for wing in &WINGS {
        let wing = wing.name;
        let private = format!("#[cfg(not(feature = \"internals\"))]\nmod {wing};\n");
        let hidden = format!("#[cfg(feature = \"internals\")]\n#[doc(hidden)]\npub mod {wing};\n");
        assert!(source.contains(&private) && source.contains(&hidden), "{wing}");
    }
}

//! Who may import whom: the layers of `docs/architecture.md`, checked against the sources.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod layer_paths;
mod rust_source;

use std::collections::BTreeSet;

use layer_paths::{Named, named};

/// A folder of `src`.
struct Layer {
    name: &'static str,
    /// Layers that it may import, besides those that they may import themselves.
    imports: &'static [&'static str],
}

const fn layer(name: &'static str, imports: &'static [&'static str]) -> Layer {
    Layer { name, imports }
}

/// Lowest first. A layer may be planned and not exist yet.
const LAYERS: [Layer; 24] = [
    layer("text", &[]),
    layer("syntax", &["text"]),
    layer("diagnostics", &["text"]),
    layer("robot", &[]),
    layer("log", &[]),
    layer("ir", &["text", "syntax", "diagnostics"]),
    layer("kinematics", &["robot"]),
    layer("dynamics", &["robot"]),
    layer("effects", &["robot", "dynamics"]),
    layer("path", &["ir", "kinematics"]),
    layer("motion", &["path", "ir", "kinematics", "dynamics", "effects"]),
    layer("energy", &["motion", "dynamics", "effects"]),
    layer("optimize", &["energy"]),
    layer("excite", &["kinematics", "dynamics", "motion"]),
    layer("identify", &["log", "effects", "dynamics"]),
    layer("lint", &["energy"]),
    layer("emit", &["ir"]),
    layer("retrofit", &["optimize", "emit"]),
    layer("generate", &["retrofit"]),
    layer("gap", &["log", "effects", "identify", "motion", "energy"]),
    layer("blind", &["robot"]),
    layer("calibrate", &["log", "energy"]),
    layer("report", &["calibrate", "retrofit", "excite", "identify", "lint", "gap", "blind"]),
    layer("config", &["retrofit", "lint"]),
];

/// Above all layers: they may import each of them, and each other.
const EDGES: [&str; 2] = ["cli", "lsp"];

/// Something that only some files may name.
struct Reserved {
    /// A crate or a module of the standard library.
    path: &'static [&'static str],
    /// Files, or folders with a `/` at the end.
    places: &'static [&'static str],
    why: &'static str,
}

const FILES_AND_TERMINALS: &[&str] = &["src/tool/cli/", "src/tool/lsp/", "src/main.rs"];
const LOADERS: &[&str] =
    &["src/tool/cli/", "src/tool/lsp/", "src/main.rs", "src/arm/robot/load.rs"];
const PURE: &str = "the core is made of pure functions: files, clocks and terminals stay outside";

const RESERVED: [Reserved; 14] = [
    Reserved { path: &["lsp_server"], places: &["src/tool/lsp/"], why: "only the server knows it" },
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
        places: &["src/learn/log/", "src/tool/generate/table.rs"],
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

/// Everything that a layer may import, itself included.
fn reach(name: &str) -> BTreeSet<&'static str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&str> = vec![name];
    while let Some(name) = open.pop() {
        if let Some(layer) = LAYERS.iter().find(|layer| layer.name == name)
            && reached.insert(layer.name)
        {
            open.extend(layer.imports);
        }
    }
    reached
}

/// The layer of a path below the crate's root; `None` for the root itself.
fn layer_of(path: &str) -> Option<&str> {
    let inner = path.strip_prefix("src/")?;
    match inner.split_once('/') {
        Some((folder, _)) => Some(folder),
        None => inner.strip_suffix(".rs").filter(|name| !matches!(*name, "lib" | "main")),
    }
}

/// What a file does that the tables forbid, one line each.
fn violations(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for Named { line, path: names } in named(path, text) {
        let shown = names.join("::");
        let forbidden = match names.as_slice() {
            [root, to, ..] if root == "crate" => import(path, to),
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

/// Why a file may not name something of the layer `to`.
fn import(path: &str, to: &str) -> Option<String> {
    let from = layer_of(path)?;
    if from == to || EDGES.contains(&from) {
        return None;
    }
    let known = LAYERS.iter().any(|layer| layer.name == to);
    if !known && !EDGES.contains(&to) {
        return Some(format!("'{to}' is no layer: write the path from the layer's name on"));
    }
    let allowed = reach(from);
    (!allowed.contains(to)).then(|| {
        let below: Vec<&str> = allowed.into_iter().filter(|name| *name != from).collect();
        match below.as_slice() {
            [] => format!("{from} imports no other layer"),
            below => format!("{from} may import only {}", below.join(", ")),
        }
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
        "{} imports break the layers (docs/architecture.md):\n{}",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn every_folder_is_a_layer() {
    for file in rust_source::files(&["src"]) {
        let Some(name) = layer_of(&file.path) else { continue };
        let known = EDGES.contains(&name) || LAYERS.iter().any(|layer| layer.name == name);
        assert!(known, "{} is in no layer: add '{name}' to LAYERS", file.path);
    }
}

#[test]
fn layers_are_in_order() {
    for (i, layer) in LAYERS.iter().enumerate() {
        for import in layer.imports {
            let below = LAYERS[..i].iter().any(|other| other.name == *import);
            assert!(below, "{} imports {import}, which does not stand below it", layer.name);
        }
    }
}

/// The table in the documentation is the one above.
#[test]
fn documentation_shows_the_layers() {
    let table: String = LAYERS
        .iter()
        .map(|layer| match layer.imports {
            [] => format!("{}\n", layer.name),
            imports => format!("{}({})\n", layer.name, imports.join(", ")),
        })
        .collect::<String>()
        + &EDGES.join(", ")
        + "\n";
    let text = include_str!("../docs/architecture.md");
    assert!(text.contains(&format!("```\n{table}```")), "docs/architecture.md lacks:\n{table}");
}

/// Sources that break a rule each, and what has to be said of them.
#[test]
fn forbidden_imports_are_found() {
    let cases = [
        ("src/rapid/syntax/a.rs", "use crate::tool::emit::Names;", "may import only text"),
        ("src/arm/robot/a.rs", "use crate::rapid::text::Span;", "imports no other layer"),
        ("src/rapid/ir/a.rs", "use crate::{\n  text::Span,\n  robot::{self, Model},\n};", "robot"),
        ("src/retime/motion/a/b.rs", "fn f() -> crate::retime::optimize::Site {}", "optimize"),
        ("src/retime/path/a.rs", "use super::super::energy::Account;", "energy"),
        ("src/retime/path/mod.rs", "mod tests { use super::super::cli; }", "cli"),
        ("src/retime/energy/a.rs", "use crate::nowhere::X;", "is no layer"),
        ("src/retime/energy/a.rs", "use crate::*;", "is no layer"),
        ("src/rapid/ir/a.rs", "use nom::IResult;", "lexer"),
        ("src/retime/optimize/a.rs", "let x = clarabel::solver::Settings::default();", "solver"),
        ("src/retime/motion/a.rs", "use tera::Tera;", "templates"),
        ("src/arm/robot/a.rs", "use std::{io, fs};", "pure"),
        ("src/retime/energy/a.rs", "let now = std::time::Instant::now();", "pure"),
    ];
    for (path, text, message) in cases {
        let found = violations(path, text);
        let told = found.iter().any(|line| line.contains(message));
        assert!(told, "{path}: {text}\ngave {found:?} and nothing with '{message}'");
    }
}

/// Sources that break none.
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
        ("src/lib.rs", "pub mod cli;"),
    ];
    for (path, text) in cases {
        assert_eq!(violations(path, text), [""; 0], "{path}: {text}");
    }
}

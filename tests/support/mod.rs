//! Functions for several tests.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each test uses its part of this module; an expectation would fail in the others"
)]

use std::ops::Range;
use std::path::{Path, PathBuf};

use joulepath::arm::robot::{Model, find};
use joulepath::rapid::syntax::{self, Element, Parse};
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::{Options, Simulation, simulate};
use joulepath::tool::retrofit::{Source, read_program};

/// Largest number of inspections of a token, per token: constant for any input.
const STEPS_PER_TOKEN: u64 = 8;

/// The inputs of a folder of `fixtures/syntax`: file names and bytes, sorted.
pub(crate) fn fixtures(folder: &str) -> Vec<(String, Vec<u8>)> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(fixture_folder(folder))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension().is_some_and(|extension| extension != "snap" && extension != "new")
        })
        .collect();
    paths.sort();
    let read = |path: PathBuf| {
        (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(&path).unwrap())
    };
    paths.into_iter().map(read).collect()
}

/// A robot of the catalogue with published dynamics.
pub(crate) fn irb1600() -> Model {
    find("IRB1600-10/1.45").unwrap()
}

/// The paths of the modules in a folder of `fixtures`, sorted.
pub(crate) fn module_paths(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(folder);
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "mod" || e == "sys"));
    paths.sort();
    paths
}

/// The program in a folder of `fixtures`.
pub(crate) fn modules(folder: &str) -> Vec<Source> {
    read(&module_paths(folder))
}

/// A program of the files with these paths.
pub(crate) fn read(paths: &[PathBuf]) -> Vec<Source> {
    let file = |(i, path): (usize, &PathBuf)| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        SourceFile::new(FileId(i as u32), name, std::fs::read(path).unwrap())
    };
    sources(paths.iter().enumerate().map(file).collect())
}

/// A program of these files.
pub(crate) fn sources(files: Vec<SourceFile>) -> Vec<Source> {
    files.into_iter().map(|file| Source { relative: file.path.clone(), file }).collect()
}

/// A program of one module.
pub(crate) fn program(text: impl Into<Vec<u8>>) -> Vec<Source> {
    sources(vec![SourceFile::new(FileId(0), "M.mod".to_owned(), text.into())])
}

/// Simulates the routine `main` of a program.
pub(crate) fn simulated(model: &Model, files: &[Source], options: &Options) -> Simulation {
    let (program, entry) = read_program(files, "main").unwrap();
    simulate(&program, entry, model, options)
}

/// The path of a folder of `fixtures/syntax`.
pub(crate) fn fixture_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/syntax").join(name)
}

/// Joined tokens are the source, children are inside their parents in order, and the walk over
/// elements meets each token once.
pub(crate) fn check_tree(parse: &Parse, bytes: &[u8]) {
    let root = parse.tree.root();
    let mut joined = 0;
    for token in root.all_tokens() {
        let range = token.range();
        assert!(range.start as usize == joined && range.end > range.start, "token {range:?}");
        joined = range.end as usize;
    }
    assert_eq!(joined, bytes.len(), "tokens end with the source");
    let mut walked = 0;
    let mut stack = vec![root];
    while let Some(node) = stack.pop() {
        let outer = node.range();
        let mut before = outer.start;
        for element in node.elements() {
            match element {
                Element::Token(_) => walked += 1,
                Element::Node(child) => {
                    let inner = child.range();
                    assert!(before <= inner.start && inner.end <= outer.end, "{:?}", child.kind());
                    before = inner.end;
                    stack.push(child);
                }
            }
        }
    }
    assert_eq!(walked, parse.tree.tokens().count(), "tokens in the walk");
    for error in &parse.errors {
        assert!(error.start <= error.end && error.end as usize <= bytes.len());
    }
}

/// The work of the parser is proportional to the number of tokens.
pub(crate) fn check_work(parse: &Parse) {
    let tokens = parse.tree.tokens().count() as u64;
    assert!(parse.steps <= STEPS_PER_TOKEN * (tokens + 1), "{} for {tokens}", parse.steps);
}

/// Splitmix64 (Steele, Lea, Flood 2014): repeatable random choices of mutations.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number below `limit`, which is positive.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }
}

/// The ranges of the tokens in a text.
pub(crate) fn token_ranges(bytes: &[u8]) -> Vec<Range<usize>> {
    let parse = syntax::parse(bytes);
    let range = |token: syntax::Token<'_>| token.range().start as usize..token.range().end as usize;
    parse.tree.root().all_tokens().map(range).collect()
}

/// Deletes, duplicates or swaps tokens of the original, or damages bytes.
pub(crate) fn mutate(bytes: &mut Vec<u8>, tokens: &[Range<usize>], random: &mut Random) {
    let clip = |range: &Range<usize>, length: usize| range.start.min(length)..range.end.min(length);
    let mut token = || match tokens.len() {
        0 => 0..0,
        count => clip(&tokens[random.below(count)], bytes.len()),
    };
    let (one, two) = (token(), token());
    let at = random.below(bytes.len() + 1);
    match random.below(7) {
        0 => {
            bytes.drain(one);
        }
        1 => {
            let copy = bytes[one.clone()].to_vec();
            bytes.splice(one.end..one.end, copy);
        }
        2 => {
            let (first, second) = if one.start < two.start { (one, two) } else { (two, one) };
            if first.end <= second.start {
                let moved = bytes[first.clone()].to_vec();
                let other = bytes.splice(second, moved).collect::<Vec<u8>>();
                bytes.splice(first, other);
            }
        }
        3 => {
            let noise = (0..=random.below(8)).map(|_| random.below(256) as u8);
            let noise: Vec<u8> = noise.collect();
            bytes.splice(at..at, noise);
        }
        4 if at < bytes.len() => bytes[at] = random.below(256) as u8,
        5 => bytes.truncate(at),
        _ => {
            let end = (at + random.below(20)).min(bytes.len());
            bytes.drain(at..end);
        }
    }
}

//! Programs with another layout and the same meaning.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each test uses its part of this module; an expectation would fail in the others"
)]

pub(crate) mod resaved;
pub(crate) mod single_edits;

use std::fs;
use std::path::{Path, PathBuf};

use joulepath::rapid::ir::lower;
use joulepath::rapid::syntax::{self, NodeKind, Parse, TokenKind};
use joulepath::rapid::text::{FileId, SourceFile};

/// Pseudo-random numbers (xorshift).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// A number below `bound`.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % bound.max(1)
    }

    pub(crate) fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// The modules in a folder of `fixtures` and below, sorted.
pub(crate) fn modules(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(folder)];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
            if path.is_dir() {
                open.push(path);
            } else if extension
                .is_some_and(|e| ["mod", "sys", "prg", "modx", "sysx"].contains(&e.as_str()))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

pub(crate) fn file(bytes: impl Into<Vec<u8>>) -> SourceFile {
    SourceFile::new(FileId(0), "M.mod".to_owned(), bytes.into())
}

pub(crate) fn read(path: &Path) -> SourceFile {
    SourceFile::new(FileId(0), path.display().to_string(), fs::read(path).unwrap())
}

/// What the rest of the compiler sees of a file, without its places in the text.
pub(crate) fn ir(bytes: &[u8]) -> String {
    let text = format!("{:?}", lower(FileId(0), &syntax::parse(bytes), bytes));
    let mut out = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some(at) = rest.find("Span { file") {
        out.push_str(&rest[..at]);
        rest = &rest[at + rest[at..].find('}').unwrap() + 1..];
    }
    out + rest
}

/// The tokens of a file that are no white space: kinds and bytes.
pub(crate) fn words(bytes: &[u8]) -> Vec<(TokenKind, Vec<u8>)> {
    let parse = syntax::parse(bytes);
    let tokens = parse.tree.root().all_tokens().filter(|t| t.kind() != TokenKind::Whitespace);
    tokens.map(|token| (token.kind(), token.text(bytes).to_vec())).collect()
}

/// The bytes whose white space has a meaning: headers, and text outside of modules.
fn kept(parse: &Parse) -> Vec<std::ops::Range<u32>> {
    let is_kept =
        |kind| matches!(kind, NodeKind::Header | NodeKind::OutsideText | NodeKind::EncodedModule);
    parse.tree.nodes().filter(|node| is_kept(node.kind())).map(syntax::Node::range).collect()
}

/// White space and comments that may stand between two tokens.
const GAPS: [&str; 10] = [
    " ",
    " ",
    "  ",
    "\t",
    "\n",
    "\r\n",
    "\n\n\n\n",
    " \t\n  ",
    " ! said \"here\"\n",
    "!\r\n  !x\n",
];

/// How lines are indented that continue a statement.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Continued {
    /// At random. The parser takes the first argument of a call for a new statement if it is on a line
    /// that is not indented further, so that the program may be another one.
    Anyhow,
    /// Further than the line before.
    Further,
}

/// The same program with random white space, comments, and case of keywords.
pub(crate) fn relaid(bytes: &[u8], continued: Continued, random: &mut Random) -> Vec<u8> {
    let parse = syntax::parse(bytes);
    let kept = kept(&parse);
    let tokens = parse.tree.tokens();
    let mut out = Vec::new();
    let mut gap = false;
    let mut before = TokenKind::EndOfFile;
    let mut column = 0;
    for index in 0..tokens.count() {
        let (kind, range) = (tokens.kind(index), tokens.range(index));
        let text = &bytes[range.start as usize..range.end as usize];
        let inside =
            |place: &std::ops::Range<u32>| place.start < range.end && range.start < place.end;
        if kept.iter().any(inside) {
            if gap && !out.is_empty() {
                out.push(b'\n');
            }
            out.extend(text);
            (gap, before) = (false, TokenKind::HeaderMark);
            continue;
        }
        if kind.is_trivia() {
            gap = true;
            continue;
        }
        // A byte order mark stays at the start.
        if out.is_empty() && bytes.starts_with(b"\xEF\xBB\xBF") {
            out.extend(b"\xEF\xBB\xBF");
        }
        if before == TokenKind::HeaderMark {
            out.extend(b"\n");
        } else if gap || random.below(6) == 0 && before != TokenKind::EndOfFile {
            out.extend(random.pick(&GAPS).bytes());
            let is_inside = before != TokenKind::Semicolon && before != TokenKind::Colon;
            let start = out.iter().rposition(|byte| matches!(byte, b'\n' | b'\r'));
            if let Some(start) = start
                && continued == Continued::Further
                && out[start..].iter().all(u8::is_ascii_whitespace)
            {
                column = if is_inside { column + 3 } else { random.below(8) };
                out.truncate(start + 1);
                out.extend(vec![b' '; column]);
            }
        }
        if kind.is_keyword() {
            out.extend(text.iter().map(|byte| match random.below(2) {
                0 => byte.to_ascii_uppercase(),
                _ => byte.to_ascii_lowercase(),
            }));
        } else {
            out.extend(text);
        }
        (gap, before) = (false, kind);
    }
    out.extend(b"\n");
    out
}

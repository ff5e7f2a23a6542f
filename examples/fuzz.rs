//! Parses mutated RAPID files and checks that the tree is lossless, nothing panics and the work
//! stays linear.
//!
//! `cargo run --release --example fuzz -- [SECONDS [SEED [FILE…]]]`; without
//! files the parser's fixtures are mutated. An input that fails is written to
//! the folder for temporary files, and the exit code is 1.

#![expect(clippy::print_stdout, reason = "it is a program for the terminal")]
#![expect(clippy::unwrap_used, reason = "missing fixtures end the program")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::panic::catch_unwind;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use joulepath::rapid::ir;
use joulepath::rapid::syntax;
use joulepath::rapid::text::FileId;
use support::{Random, check_tree, check_work, fixtures, mutate, token_ranges};

const SECONDS: u64 = 60;
/// Largest number of successive mutations of a file.
const LAYERS: usize = 12;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mut number =
        |default| arguments.next().and_then(|text| text.parse().ok()).unwrap_or(default);
    let (seconds, seed) = (number(SECONDS), number(1));
    let mut sources: Vec<Vec<u8>> = arguments.filter_map(|path| std::fs::read(path).ok()).collect();
    if sources.is_empty() {
        let shipped = fixtures("ok").into_iter().chain(fixtures("err"));
        sources.extend(shipped.map(|(_, bytes)| bytes));
    }
    let mut random = Random(seed);
    let end = Instant::now() + Duration::from_secs(seconds);
    let (mut read, mut size) = (0_u64, 0_u64);
    while Instant::now() < end {
        let source = &sources[random.below(sources.len())];
        let bytes = mutated(source, &mut random);
        read += 1;
        size += bytes.len() as u64;
        if catch_unwind(|| check(&bytes)).is_err() {
            let path = std::env::temp_dir().join(format!("fuzz-{seed}-{read}.mod"));
            let written = std::fs::write(&path, &bytes).is_ok();
            println!("failed: {} (written: {written})", path.display());
            return ExitCode::FAILURE;
        }
    }
    println!("{read} mutations of {} files, {size} bytes: nothing found", sources.len());
    ExitCode::SUCCESS
}

/// A few mutations; sometimes a piece is repeated many times.
fn mutated(source: &[u8], random: &mut Random) -> Vec<u8> {
    let tokens = token_ranges(source);
    let mut bytes = source.to_vec();
    for _ in 0..=random.below(LAYERS) {
        mutate(&mut bytes, &tokens, random);
    }
    if random.below(50) == 0 && !bytes.is_empty() {
        let start = random.below(bytes.len());
        let end = (start + 1 + random.below(40)).min(bytes.len());
        let piece = bytes[start..end].repeat(1 + random.below(5_000));
        bytes.splice(start..end, piece);
    }
    bytes
}

fn check(bytes: &[u8]) {
    let parse = syntax::parse(bytes);
    check_tree(&parse, bytes);
    check_work(&parse);
    let _ = ir::lower(FileId(0), &parse, bytes);
}

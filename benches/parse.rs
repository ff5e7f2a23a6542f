//! Bytes per second of the front end on one core, compared with `wc -l` on the same file. The
//! shipped programs are repeated to some megabytes.

use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use joulepath::rapid::syntax;

/// Size of the input: larger than the caches, small enough for many rounds.
const BYTES: usize = 10_000_000;

/// The programs below `fixtures` without those of the parser's tests, repeated.
fn programs() -> Vec<u8> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let mut paths: Vec<PathBuf> = ["hard", "paper", "pick_place"]
        .iter()
        .filter_map(|folder| fs::read_dir(root.join(folder)).ok())
        .flat_map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())))
        .filter(|path| path.extension().is_some_and(|end| end == "mod" || end == "sys"))
        .collect();
    paths.sort();
    let once: Vec<u8> = paths
        .iter()
        .filter_map(|path| fs::read(path).ok())
        // One encoding for the whole file, and no errors.
        .filter(|bytes| bytes.is_ascii() && syntax::parse(bytes).errors.is_empty())
        .flatten()
        .collect();
    once.repeat(BYTES / once.len().max(1) + 1)
}

fn front_end(c: &mut Criterion) {
    let bytes = programs();
    let parse = syntax::parse(&bytes);
    assert!(parse.errors.is_empty(), "{:?}", parse.errors.first());
    let mut group = c.benchmark_group("front end");
    group.throughput(Throughput::Bytes(bytes.len() as u64)).sample_size(20);
    group.bench_function("tokenize", |b| b.iter(|| syntax::tokenize(black_box(&bytes))));
    group.bench_function("parse", |b| b.iter(|| syntax::parse(black_box(&bytes))));
    if let Ok(file) = tempfile::NamedTempFile::new()
        && fs::write(file.path(), &bytes).is_ok()
    {
        group.bench_function("wc -l", |b| b.iter(|| count_lines(file.path())));
    }
    group.finish();
}

/// Runs the program; without it the figure is meaningless.
fn count_lines(path: &Path) -> bool {
    let status = Command::new("wc").arg("-l").arg(path).stdout(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

criterion_group!(benches, front_end);
criterion_main!(benches);

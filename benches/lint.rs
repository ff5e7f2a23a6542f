//! Linting folders: files and megabytes a second, with a robot.

use std::fs;
use std::path::{Path, PathBuf};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use joulepath::effects;
use joulepath::lint::{Group, Job, Settings, lint};
use joulepath::motion::Options;
use joulepath::text::{FileId, SourceFile};

/// Every program of the fixtures that starts and moves: each is simulated.
fn programs() -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::from("fixtures")];
    while let Some(folder) = open.pop() {
        let mut entries: Vec<PathBuf> = fs::read_dir(folder)
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path())
            .collect();
        entries.sort();
        for path in entries {
            let is = |extension: &str| path.extension().is_some_and(|e| e == extension);
            if path.is_dir() {
                open.push(path);
            } else if is("mod") || is("sys") {
                found.extend(fs::read(path).ok().filter(|bytes| runs(bytes)));
            }
        }
    }
    found
}

fn runs(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes).to_lowercase();
    text.contains("proc main") && text.contains("move")
}

/// A folder of so many files, each a program of its own where it has an entry.
fn folder(count: usize) -> Vec<SourceFile> {
    let programs = programs();
    let file = |i: usize| {
        let path = Path::new("plant").join(format!("{i}.mod")).display().to_string();
        SourceFile::new(FileId(i as u32), path, programs[i % programs.len()].clone())
    };
    (0..count).map(file).collect()
}

fn bench(criterion: &mut Criterion) {
    let Ok(model) = effects::load("IRB1600-10/1.45") else { return };
    let settings = Settings::default();
    let mut group = criterion.benchmark_group("lint");
    group.sample_size(10);
    for count in [75, 150, 300, 600] {
        let files = folder(count);
        let bytes: usize = files.iter().map(|file| file.bytes.len()).sum();
        let job = Job {
            files: &files,
            groups: vec![Group {
                files: (0..count).collect(),
                entry: "main".to_owned(),
                system: None,
            }],
            model: Some(&model),
            options: Options::default(),
            settings: &settings,
        };
        group.throughput(Throughput::ElementsAndBytes {
            elements: count as u64,
            bytes: bytes as u64,
        });
        group.bench_with_input(BenchmarkId::from_parameter(count), &job, |bencher, job| {
            bencher.iter(|| lint(job));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);

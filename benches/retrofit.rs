//! The complete `optimize` on the shipped cell: read, simulate, optimise, emit, verify.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the bench")]

use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use joulepath::arm::robot;
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::tool::retrofit::{Settings, Source, retrofit};

fn pick_place(c: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/pick_place");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let files: Vec<Source> = paths
        .iter()
        .enumerate()
        .map(|(i, path)| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let bytes = std::fs::read(path).unwrap();
            let file = SourceFile::new(FileId(i as u32), name.clone(), bytes);
            Source { file, relative: name }
        })
        .collect();
    let model = robot::find("IRB1600-10/1.45").unwrap();
    let settings = Settings::default();
    let mut group = c.benchmark_group("retrofit");
    group.sample_size(10);
    group.bench_function("pick_place", |b| {
        b.iter(|| retrofit(&files, &model, &settings, &|_, _| {}).unwrap());
    });
    group.finish();
}

criterion_group!(benches, pick_place);
criterion_main!(benches);

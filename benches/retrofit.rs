//! The complete `optimize` on the shipped cell: read, simulate, optimise, emit, verify.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the bench")]

#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{Criterion, criterion_group, criterion_main};
use joulepath::tool::retrofit::{Settings, retrofit};
use support::{irb1600, modules};

fn pick_place(c: &mut Criterion) {
    let files = modules("pick_place");
    let model = irb1600();
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

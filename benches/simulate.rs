//! The virtual controller: the shipped cell, and the time as a function of the movements.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the bench")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::fmt::Write;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use joulepath::retime::energy::account;
use joulepath::retime::motion::{Options, simulate};
use joulepath::tool::retrofit::read_program;
use support::{irb1600, modules, program};

/// Throughput: simulated milliseconds ("elements") per second of computing time.
fn pick_place(c: &mut Criterion) {
    let model = irb1600();
    let files = modules("pick_place");
    let (program, entry) = read_program(&files, "main").unwrap();
    let options = Options::default();
    let cycle = simulate(&program, entry, &model, &options).cycle_s;
    let mut group = c.benchmark_group("simulate pick_place");
    group.throughput(Throughput::Elements((1e3 * cycle) as u64));
    group.bench_function("motion", |b| b.iter(|| simulate(&program, entry, &model, &options)));
    group.bench_function("motion and energy", |b| {
        b.iter(|| account(&model, &simulate(&program, entry, &model, &options)));
    });
    group.finish();
}

fn movements(c: &mut Criterion) {
    let model = irb1600();
    let mut group = c.benchmark_group("simulate movements");
    group.sample_size(10);
    for count in [100_u32, 1_000, 10_000] {
        let mut text = String::from(
            "MODULE M\nPROC main()\nMoveAbsJ [[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,\
             fine,tool0;\nConfL\\Off;\n",
        );
        for i in 0..count {
            let turn = f64::from(i);
            let x = 700.0 + 200.0 * (0.7 * turn).sin();
            let y = 250.0 * (1.3 * turn).cos();
            let z = 700.0 + 100.0 * (0.37 * turn).sin();
            let zone = if i % 50 == 49 { "fine" } else { "z10" };
            writeln!(
                text,
                "MoveL [[{x:.2},{y:.2},{z:.2}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\
                 v500,{zone},tool0;"
            )
            .unwrap();
        }
        text.push_str("ENDPROC\nENDMODULE\n");
        let (program, entry) = read_program(&program(text), "main").unwrap();
        group.throughput(Throughput::Elements(u64::from(count)));
        group.bench_with_input(BenchmarkId::from_parameter(count), &count, |b, _| {
            b.iter(|| account(&model, &simulate(&program, entry, &model, &Options::default())));
        });
    }
    group.finish();
}

criterion_group!(benches, pick_place, movements);
criterion_main!(benches);

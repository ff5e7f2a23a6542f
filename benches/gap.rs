//! A complete diagnosis: two motions of seven periods of 10 s at 100 Hz, six joints, all effects.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed bench")]

#[path = "../tests/support/examined.rs"]
mod examined;

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use examined::{examined, records};
use joulepath::arm::effects::ALL;
use joulepath::examine::blind::{self, Case, Kind, Settings};
use joulepath::gap;

/// Seed of the development cases.
const SEED: u64 = 101;

fn bench(criterion: &mut Criterion) {
    let settings = Settings::new(SEED);
    let mut group = criterion.benchmark_group("gap");
    group.sample_size(10).measurement_time(Duration::from_secs(60));
    for kind in [Kind::Healthy, Kind::One] {
        let mut cases = (1..).map(|number| blind::case(&settings, number).unwrap());
        // Diagnoses of program runs do not include torque effects.
        let is_run = |case: &Case| case.files.iter().any(|(name, _)| name.contains('/'));
        let case = cases.find(|case| case.label.kind == kind && !is_run(case)).unwrap();
        let input = examined(&case, &settings);
        let settings = gap::Settings {
            trust: input.trust,
            effects: ALL.iter().collect(),
            tunables: gap::Tunables::DEFAULT,
        };
        group.bench_function(format!("diagnose_{}", kind.name()), |bencher| {
            bencher.iter(|| {
                let train = records(black_box(&input.nominal), &input.train);
                let heldout = records(&input.nominal, &input.heldout);
                gap::diagnose(&input.nominal, train, &heldout, &settings)
            });
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);

//! Identification from ten minutes at 100 Hz: from 60,000 rows of CSV to a model.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed bench")]

use std::fmt::Write as _;
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use joulepath::arm::dynamics::{Data, Load, torque};
use joulepath::arm::robot::{Model, find};
use joulepath::learn::identify::{Free, Hints, Settings, Weighting, identify, prepare, torques};
use joulepath::learn::log::{ColumnMap, read_csv};

const ROWS: usize = 60_000;

/// Positions without repetition, torques with noise, and optional rates.
fn csv(model: &Model, rates: &[&str]) -> String {
    let mut text = String::from("t");
    for name in ["q"].iter().chain(rates).chain(&["tau"]) {
        for joint in 1..=6 {
            let _ = write!(text, ",{name}{joint}");
        }
    }
    text.push('\n');
    let mut data = Data::new();
    let mut random = fastrand::Rng::with_seed(1);
    for row in 0..ROWS {
        let t = 0.01 * row as f64;
        let mut state = [[0.0; 6]; 3];
        for joint in 0..6 {
            for k in 1..4 {
                let w = 0.7 * f64::from(k * k) + 0.137 * joint as f64;
                let (sin, cos) = (w * t + joint as f64).sin_cos();
                let a = 0.6 / f64::from(k);
                state[0][joint] += a * sin;
                state[1][joint] += a * w * cos;
                state[2][joint] -= a * w * w * sin;
            }
        }
        let [q, qd, qdd] = &state;
        let parts = torque(model, &mut data, &Load::none(), q, qd, qdd);
        let _ = write!(text, "{t:.3}");
        for value in state[..=rates.len()].iter().flatten() {
            let _ = write!(text, ",{value:.8}");
        }
        for joint in 0..6 {
            let tau = parts.rigid[joint] + parts.friction[joint] + random.f64() - 0.5;
            let _ = write!(text, ",{tau:.4}");
        }
        text.push('\n');
    }
    text
}

fn bench(criterion: &mut Criterion) {
    let model = find("IRB1600-10/1.45").unwrap();
    let mut group = criterion.benchmark_group("identify");
    group.sample_size(10).throughput(Throughput::Elements(ROWS as u64));
    for (name, rates) in [("with_rates", &["qd", "qdd"][..]), ("positions_only", &[])] {
        let text = csv(&model, rates);
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let log = read_csv(black_box(text.as_bytes()), &ColumnMap::default()).unwrap();
                let tau = torques(&model, &log).unwrap().tau;
                let samples = prepare(&log, &tau, Hints::default()).unwrap();
                let settings = Settings {
                    free: Free::All,
                    weighting: Weighting::Joint,
                    source: "a bench".into(),
                };
                identify(&model, &samples, &[], &settings).unwrap()
            });
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);

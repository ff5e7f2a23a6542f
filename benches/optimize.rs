//! The numerical core of the optimiser on a synthetic arm, without set-up.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed benchmark")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use joulepath::retime::motion::stream::DOF;
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::time_optimal;
use joulepath::retime::optimize::path_energy::{EnergyModel, Sharing};
use joulepath::retime::optimize::polish_problem::PathPenalty;
use joulepath::retime::optimize::stream_fit::{StreamFit, fit_stream};
use joulepath::retime::optimize::stream_limits::StreamLimits;
use joulepath::retime::optimize::stream_polish::{Until, polish_stream};
use joulepath::retime::optimize::stream_reference::Reference;
use joulepath::retime::optimize::stream_spacing::{Spacing, adaptive_intervals};

#[expect(dead_code, reason = "the tests use more of it")]
#[path = "../tests/optimize/arm.rs"]
mod arm;

/// The path of all benchmarks.
const SEED: u64 = 2;

fn reachability(c: &mut Criterion) {
    let limits = arm::limits();
    for n in [100, 1000] {
        for (name, friction) in [("", 0.0), (" with viscous friction", 1.0)] {
            let grid = arm::grid(&arm::Path::random(SEED), n, friction);
            c.bench_function(&format!("reachability {n}{name}"), |b| {
                b.iter(|| time_optimal(black_box(&grid), &limits));
            });
        }
    }
}

fn energy(c: &mut Criterion) {
    let limits = arm::limits();
    for n in [50, 100] {
        for (name, sharing) in [("bus", Sharing::Bus), ("per joint", Sharing::PerJoint)] {
            let model = EnergyModel {
                work: 1.0,
                speed: 0.0,
                loss: arm::LOSS,
                base_w: 0.0,
                sharing,
                regeneration: 0.0,
            };
            let grid = arm::grid(&arm::Path::random(SEED), n, 1.0);
            let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
            let time = 1.1 * fastest.duration();
            c.bench_function(&format!("energy {n} {name}"), |b| {
                b.iter(|| arm::least_energy(black_box(&grid), &limits, &model, &fastest, time));
            });
        }
    }
}

fn stream(c: &mut Criterion) {
    let path = arm::Path::random(SEED);
    let profile: Profile =
        time_optimal(&arm::grid(&path, 100, 1.0), &arm::limits()).into_profile().unwrap();
    let profile = profile.scaled_to(1.3 * profile.duration()).unwrap();
    let reference = Reference::sample(profile.duration(), 1000, |t| {
        let (s, speed, _) = profile.at(t);
        let (q, q1, _) = path.at(s);
        (q, q1.map(|x| x * speed))
    })
    .unwrap();
    let limits = StreamLimits {
        velocity: arm::VELOCITY,
        acceleration: *arm::limits().acceleration(),
        jerk: arm::limits().acceleration().map(|a| 20.0 * a),
    };
    let fit = || {
        let spacing = Spacing { tolerance: 5e-4, ..Spacing::default() };
        let intervals = adaptive_intervals(&reference, profile.duration(), &spacing);
        fit_stream(black_box(&reference), intervals, &limits, &[1.0; DOF]).unwrap()
    };
    c.bench_function("stream fit", |b| b.iter(fit));
    let StreamFit::Fitted(fitted) = fit() else { return };
    let (sharing, regeneration) = (Sharing::Bus, 0.0);
    let model =
        EnergyModel { work: 1.0, speed: 0.0, loss: arm::LOSS, base_w: 0.0, sharing, regeneration };
    let corridor = PathPenalty { tolerance: 1e-3, lever: [1.0; DOF] };
    c.bench_function("stream polish", |b| {
        let stream = black_box(&fitted.stream);
        b.iter(|| {
            polish_stream(
                stream,
                &reference,
                &arm::SyntheticArm,
                &limits,
                &model,
                &corridor,
                Until::Least,
            )
        });
    });
}

criterion_group!(benches, reachability, energy, stream);
criterion_main!(benches);

//! The truth of a case of torques: nats of each fault, the joint of the largest share of the gap, and
//! the gap on the held-out log.

use super::bench::{Bench, ROWS};
use super::faults::Fault;
use super::plant::Sample;
use super::scene::Scene;
use crate::examine::worlds::api::{HeldOut, largest};
use crate::examine::worlds::model::{MAX, Row};

/// Changes of all logs behind one another, by joint.
fn changes(bench: &Bench, with: &[Vec<Sample>], without: &[Vec<Sample>]) -> Vec<Vec<f64>> {
    let mut out = vec![Vec::new(); bench.nominal.count()];
    for (a, b) in with.iter().zip(without) {
        for (joint, rows) in bench.change(a, b).into_iter().enumerate() {
            out[joint].extend(rows);
        }
    }
    out
}

/// Deviation \[Nm\] of one row of the mean of the repetitions, by joint.
fn deviations(scene: &Scene, bench: &Bench, without: &[Vec<Sample>]) -> Row {
    let mut out = [0.0; MAX];
    let repeats = scene.stage(0).track.cycles as f64;
    let days = if scene.plan.baseline { 2.0 } else { 1.0 };
    for samples in without {
        let left = bench.left(samples);
        for j in 0..bench.nominal.count() {
            let noise = scene.recorder.deviation(bench.robot.everyday, j);
            out[j] += (days * noise * noise / repeats + left[j] * left[j]) / without.len() as f64;
        }
    }
    out.map(f64::sqrt)
}

/// Fills in the nats of the faults; the place and the held-out gap.
pub(super) fn fill(
    scene: &Scene,
    bench: &Bench,
    faults: &mut [Fault],
) -> (Option<(usize, f64)>, Vec<HeldOut>) {
    let drifts = faults.iter().any(|fault| fault.drifts);
    let every: Vec<&Fault> = faults.iter().collect();
    let stage = scene.stage(scene.held());
    let heldout =
        bench.heldout(&bench.rows(&stage, &every, drifts), &bench.rows(&stage, &[], drifts));
    if faults.is_empty() {
        return (None, heldout);
    }
    // All present logs at the rows, with some of the faults.
    let all = |faults: &[&Fault]| -> Vec<Vec<Sample>> {
        (0..scene.held()).map(|log| bench.rows(&scene.stage(log), faults, drifts)).collect()
    };
    let (none, full) = (all(&[]), all(&every));
    let sd = deviations(scene, bench, &none);
    let rows: Vec<Sample> = none.iter().flat_map(|rows| rows.iter().take(ROWS)).copied().collect();
    let columns = bench.columns(&rows, scene.plan.spread, scene.plan.baseline);
    let without = |k: usize| {
        let mut others = every.clone();
        others.remove(k);
        if others.is_empty() { none.clone() } else { all(&others) }
    };
    let nats: Vec<f64> = (0..every.len())
        .map(|k| bench.nats(&changes(bench, &full, &without(k)), &sd, &columns))
        .collect();
    let squares: Vec<f64> =
        changes(bench, &full, &none).iter().map(|rows| rows.iter().map(|x| x * x).sum()).collect();
    for (fault, nats) in faults.iter_mut().zip(nats) {
        fault.truth.nats = nats;
    }
    (largest(&squares), heldout)
}

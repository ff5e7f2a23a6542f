//! The truth of a case of torques: nats of each fault, the joint of the largest share of the gap, and
//! the gap on the held-out log.

use crate::api::HeldOut;
use crate::arm::{MAX, Row};
use crate::bench::Bench;
use crate::faults::Fault;
use crate::plant::Sample;
use crate::torque_case::{HELD, Scene};

/// Samples of all logs at the rows with some of the faults, logs behind one another.
fn all(
    scene: &Scene,
    bench: &Bench,
    logs: &[usize],
    faults: &[&Fault],
    drifts: bool,
) -> Vec<Vec<Sample>> {
    logs.iter().map(|log| bench.rows(&scene.stage(*log), faults, drifts)).collect()
}

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
    for samples in without {
        let left = bench.left(samples);
        for j in 0..bench.nominal.count() {
            let noise = scene.recorder.deviation(bench.robot.everyday, j);
            let day = if scene.plan.baseline { 2.0 } else { 1.0 };
            out[j] += (day * noise * noise / repeats + left[j] * left[j]) / without.len() as f64;
        }
    }
    out.map(f64::sqrt)
}

/// The joint, from 1, with the largest share of the squared changes, and that share.
fn place(change: &[Vec<f64>]) -> Option<(usize, f64)> {
    let squares: Vec<f64> = change.iter().map(|rows| rows.iter().map(|x| x * x).sum()).collect();
    let whole: f64 = squares.iter().sum();
    let best = squares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (whole > 0.0).then(|| (best.0 + 1, best.1 / whole))
}

/// Fills in the nats of the faults; the place and the held-out gap.
pub fn fill(
    scene: &Scene,
    bench: &Bench,
    faults: &mut [Fault],
) -> (Option<(usize, f64)>, Vec<HeldOut>) {
    let held = scene.logs.iter().position(|log| log.name == HELD).unwrap_or(0);
    let new: Vec<usize> = (0..held).collect();
    let drifts = faults.iter().any(|fault| fault.drifts);
    let every: Vec<&Fault> = faults.iter().collect();
    let stage = scene.stage(held);
    let without = bench.rows(&stage, &[], drifts);
    let with = bench.rows(&stage, &every, drifts);
    let heldout = bench.heldout(&with, &without);
    if faults.is_empty() {
        return (None, heldout);
    }
    let none = all(scene, bench, &new, &[], drifts);
    let full = all(scene, bench, &new, &every, drifts);
    let sd = deviations(scene, bench, &none);
    let rows: Vec<&[Sample]> = none.iter().map(Vec::as_slice).collect();
    let columns = bench.columns(&rows, scene.plan.spread, scene.plan.baseline);
    let mut nats = Vec::new();
    for k in 0..faults.len() {
        let others: Vec<&Fault> =
            faults.iter().enumerate().filter(|(n, _)| *n != k).map(|(_, f)| f).collect();
        let rest =
            if others.is_empty() { none.clone() } else { all(scene, bench, &new, &others, drifts) };
        nats.push(bench.nats(&changes(bench, &full, &rest), &sd, &columns));
    }
    let place = place(&changes(bench, &full, &none));
    for (fault, value) in faults.iter_mut().zip(nats) {
        fault.truth.nats = value;
    }
    (place, heldout)
}

//! Comparison of the original with the retrofit.

use joulepath::arm::kinematics::fk;
use joulepath::arm::robot::Model;
use joulepath::retime::motion::Simulation;
use joulepath::retime::motion::timed::TimedMotion;
use joulepath::retime::motion::timeline::{Run, What};

/// Tolerance of stops, mm.
const PLACE_MM: f64 = 0.2;
/// Largest ratio of the TCP speed to that of the same original movement.
const FASTER: f64 = 1.02;
/// Largest ratio of the cycle times.
const LONGER: f64 = 1.005;
/// Rounding of a time, s.
const TIME: f64 = 1e-6;
/// Step of samples, s.
const STEP: f64 = 0.004;
/// Largest distance between a point of a stream and its movement, m; a rotation of the tool counts
/// as 0.1 m/rad.
const NEAR: f64 = 0.02;

/// Number of streams in a simulation.
pub(crate) fn streams(simulation: &Simulation) -> usize {
    let is_stream = |run: &Run| matches!(run.motions.as_slice(), [(_, TimedMotion::Stream(_))]);
    let events = simulation.events.iter();
    events.filter(|event| matches!(&event.what, What::Run(run) if is_stream(run))).count()
}

/// Compares simulations of original and retrofit under the same conditions.
pub(crate) fn compare(
    model: &Model,
    before: &Simulation,
    after: &Simulation,
    slower: bool,
) -> Result<(), String> {
    if before.events.len() != after.events.len() {
        return Err(format!("{} events instead of {}", after.events.len(), before.events.len()));
    }
    for (index, (a, b)) in before.events.iter().zip(&after.events).enumerate() {
        match (&a.what, &b.what) {
            (What::Run(a), What::Run(b)) => {
                same_rest(model, a, b).map_err(|why| format!("run {index}: {why}"))?;
                no_faster(model, a, b).map_err(|why| format!("run {index}: {why}"))?;
            }
            (What::Wait(a), What::Wait(b))
                if a.wait.instruction == b.wait.instruction && a.wait.signal == b.wait.signal => {}
            (What::Output(a, _), What::Output(b, _))
                if a.signal == b.signal && a.value == b.value => {}
            (What::Left(a), What::Left(b)) if a.reason == b.reason => {}
            _ => return Err(format!("event {index} is another one")),
        }
    }
    let limit = LONGER * before.cycle_s + TIME;
    if !slower && after.cycle_s > limit {
        return Err(format!("{:.4} s instead of {:.4} s", after.cycle_s, before.cycle_s));
    }
    Ok(())
}

fn same_rest(model: &Model, a: &Run, b: &Run) -> Result<(), String> {
    let tool = |run: &Run| run.legs.last().map(|leg| leg.tool);
    let (Some(tool), Some(_)) = (tool(a), tool(b)) else { return Ok(()) };
    let place = |run: &Run| tool.pose(&fk(model, &run.end)).translation.vector * 1e3;
    let apart = (place(a) - place(b)).norm();
    if apart > PLACE_MM {
        return Err(format!("it comes to rest {apart:.3} mm beside"));
    }
    Ok(())
}

/// A point of the original motion.
struct Place {
    at: nalgebra::Isometry3<f64>,
    movement: usize,
}

fn no_faster(model: &Model, a: &Run, b: &Run) -> Result<(), String> {
    let [(_, TimedMotion::Stream(_))] = b.motions.as_slice() else { return Ok(()) };
    if a.motions.iter().any(|(_, motion)| matches!(motion, TimedMotion::Stream(_))) {
        return Ok(());
    }
    let tool = &a.legs[0].tool;
    let speed = |run: &Run, t: f64| {
        let state = run.at(t);
        let twist = tool.twist(model, &state.q, &state.qd);
        (tool.pose(&fk(model, &state.q)), twist.fixed_rows::<3>(0).norm())
    };
    let mut peaks = vec![0.0_f64; a.moves.len()];
    let mut places = Vec::new();
    for (movement, record) in a.moves.iter().enumerate() {
        let count = (record.duration / STEP).ceil().max(1.0) as usize;
        for i in 0..=count {
            let t = record.t_start + record.duration * i as f64 / count as f64;
            let (at, v) = speed(a, t);
            peaks[movement] = peaks[movement].max(v);
            places.push(Place { at, movement });
        }
    }
    let count = (b.duration() / STEP).ceil() as usize;
    for i in 0..=count {
        let (at, v) = speed(b, b.duration() * i as f64 / count as f64);
        let distance = |place: &Place| {
            let turn = at.rotation.angle_to(&place.at.rotation);
            (at.translation.vector - place.at.translation.vector).norm() + 0.1 * turn
        };
        let near: Vec<(f64, usize)> =
            places.iter().map(|place| (distance(place), place.movement)).collect();
        let nearest = near.iter().map(|(d, _)| *d).fold(f64::INFINITY, f64::min);
        let own = near.iter().filter(|(d, _)| *d <= nearest + NEAR).map(|(_, m)| peaks[*m]);
        let allowed = FASTER * own.fold(0.0, f64::max);
        if v > allowed {
            return Err(format!("the TCP is at {:.0} of {:.0} mm/s", 1e3 * v, 1e3 * allowed));
        }
    }
    Ok(())
}

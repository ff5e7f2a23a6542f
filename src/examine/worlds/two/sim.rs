//! Closed loop: forward dynamics, motors, cascaded controller with feed-forward.
//!
//! Semi-implicit Euler with the speed derivative of friction taken implicitly (linearly implicit), at
//! 1 to 4 kHz. Positions and torques are what happens.

use super::fault::Fault;
use super::motion::{GRID, Motion};
use super::plant::{Plant, RAMP, REST, Record, Run};
use super::state::State;
use super::terms::TICK;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Angle over which feed-forward friction turns \[rad/s\].
const TURN: f64 = 0.02;

/// Reference on the grid with feed-forward torques.
fn feed_forward(plant: &Plant, motion: &Motion) -> Vec<Row> {
    let model = &plant.nominal;
    let rows = motion.q.iter().zip(&motion.v).zip(&motion.a);
    let count = motion.q.len();
    let mut out = Vec::with_capacity(count);
    for (k, ((q, v), a)) in rows.enumerate() {
        if k % 2 == 1 && k + 1 < count {
            let before = out.last().copied().unwrap_or([0.0; MAX]);
            out.push(before);
            continue;
        }
        let mut tau = model.arm.torques(q, v, a);
        for i in 0..model.arm.n() {
            tau[i] += model.arm.rotor[i] * a[i]
                + model.coulomb[i] * (v[i] / TURN).tanh()
                + model.viscous[i] * v[i];
        }
        out.push(tau);
    }
    out
}

/// Runs the robot with faults; `rng` draws what is random in the faults.
pub(super) fn run(plant: &Plant, faults: &[Fault], run: &Run, rng: &mut Rng) -> Record {
    let forward = feed_forward(plant, run.motion);
    let mut state = State::new(plant, faults, run);
    let mut record = Record { delta: vec![Vec::new(); faults.len()], ..Record::default() };
    let period = run.motion.period();
    let lead = ((REST + RAMP) / run.dt).round() as usize;
    let total = lead + (period * run.cycles as f64 / run.dt).round() as usize;
    let every = (1.0 / (run.rate * run.dt)).round().max(1.0) as usize;
    let tick = (TICK / run.dt).round().max(1.0) as usize;
    let from = if run.transient { lead - (RAMP / run.dt) as usize } else { lead };
    for k in 0..total {
        let t = (k as f64 - lead as f64) * run.dt;
        state.now.t = t;
        state.now.phase = t.rem_euclid(period);
        let (place, speed, ramp) = run_up(t);
        let (q, mut v, mut a) = run.motion.at(place);
        for i in 0..MAX {
            a[i] = a[i] * speed * speed + v[i] * ramp;
            v[i] *= speed;
        }
        let at = (place / GRID).rem_euclid(run.motion.q.len() as f64) as usize;
        let mut ahead = forward.get(at).copied().unwrap_or([0.0; MAX]);
        if t < 0.0 {
            ahead = plant.nominal.arm.torques(&q, &v, &a);
        }
        state.control(&q, &v, &ahead);
        let slow = k % tick == 0;
        if slow {
            for x in &mut state.now.chance {
                *x = rng.unit();
            }
            let cycle = (t.max(0.0) / period) as usize;
            for i in 0..plant.robot.arm.n() {
                let (dry, wet) = run.day.factors(i, t, cycle);
                (state.factors[0][i], state.factors[1][i]) = (dry, wet);
            }
        }
        state.step(slow);
        if k >= from && (k - from) % every == 0 {
            state.sample(&mut record);
        }
    }
    record
}

/// Place on the path \[s\], its rate and acceleration.
fn run_up(t: f64) -> (f64, f64, f64) {
    if t >= 0.0 {
        (t, 1.0, 0.0)
    } else if t > -RAMP {
        let x = t + RAMP;
        (-0.5 * RAMP + 0.5 * x * x / RAMP, x / RAMP, 1.0 / RAMP)
    } else {
        (-0.5 * RAMP, 0.0, 0.0)
    }
}

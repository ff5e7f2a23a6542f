//! The largest torque of each joint over plausible robots.

use rayon::prelude::*;

use super::along::{Along, Instant};
use super::plausible::{Interval, Robots};
use crate::dynamics::{Data, torque};
use crate::motion::Simulation;
use crate::motion::timeline::{Event, What};
use crate::robot::{MAX_DOF, Model};

/// Time between two instants that are looked at \[s\]: peaks of fixtures/hard/encoding.mod are within 2 % of
/// those at half of it.
const STEP: f64 = 0.02;
/// Instants of a joint at which plausible robots are looked at: those with the model's largest torques,
/// each the largest within this time \[s\].
const MOST: usize = 6;
const APART: f64 = 0.1;
/// Instants that may lie within that time of each other.
const NEAR: usize = 12;

/// Largest torques in a simulation by joint \[Nm\]; 0 where nothing moves.
pub(super) fn peaks(model: &Model, robots: &Robots, simulation: &Simulation) -> Vec<Interval> {
    let instants = largest(model, simulation);
    let along = Along::of(model, &instants, Vec::new());
    let all: Vec<Vec<f64>> = robots
        .drawn()
        .par_iter()
        .map(|robot| along.torques(robot).iter().map(nalgebra::Matrix::amax).collect())
        .collect();
    (0..model.dof)
        .map(|j| Interval::of(&all.iter().map(|tau| tau[j]).collect::<Vec<f64>>()))
        .collect()
}

/// A look at a run: the time in the cycle, the event, the time in it, torques by joint \[s, Nm\].
type Look = (f64, usize, f64, [f64; MAX_DOF]);

/// Instants at which some joint has one of its largest torques.
fn largest(model: &Model, simulation: &Simulation) -> Vec<Instant> {
    let looks: Vec<Look> = simulation
        .events
        .par_iter()
        .enumerate()
        .flat_map_iter(|(index, event)| looks(model, index, event))
        .collect();
    let mut chosen: Vec<&Look> = Vec::new();
    for j in 0..model.dof {
        let mut order: Vec<&Look> = looks.iter().collect();
        let most = (MOST * NEAR).min(order.len());
        if most == 0 {
            break;
        }
        let larger = |a: &&Look, b: &&Look| b.3[j].total_cmp(&a.3[j]);
        order.select_nth_unstable_by(most - 1, larger);
        order.truncate(most);
        order.sort_by(larger);
        let mut own: Vec<&Look> = Vec::new();
        for look in order {
            if own.len() < MOST && own.iter().all(|other| (other.0 - look.0).abs() > APART) {
                own.push(look);
            }
        }
        chosen.extend(own);
    }
    let instant = |(_, index, t, _): &Look| match &simulation.events[*index].what {
        What::Run(run) => {
            let state = run.at(*t);
            Some(Instant { load: run.load.clone(), state: [state.q, state.qd, state.qdd] })
        }
        _ => None,
    };
    chosen.into_iter().filter_map(instant).collect()
}

fn looks(model: &Model, index: usize, event: &Event) -> Vec<Look> {
    let What::Run(run) = &event.what else { return Vec::new() };
    let mut data = Data::new();
    let steps = (event.duration / STEP).ceil().max(1.0);
    let look = |i: usize| {
        let t = event.duration * i as f64 / steps;
        let state = run.at(t);
        let tau = torque(model, &mut data, &run.load, &state.q, &state.qd, &state.qdd);
        let tau = std::array::from_fn(|j| (tau.rigid[j] + tau.friction[j]).abs());
        (event.t_start + t, index, t, tau)
    };
    (0..=steps as usize).map(look).collect()
}

//! The largest torque of each joint over plausible robots.

use rayon::prelude::*;

use super::along::{Along, Instant};
use super::plausible::{Interval, Robots};
use crate::dynamics::{Data, torque};
use crate::motion::Simulation;
use crate::motion::timeline::What;
use crate::robot::Model;

/// Time between two instants that are looked at \[s\].
const STEP: f64 = 0.01;
/// Instants of a joint at which plausible robots are looked at: those with the model's largest torques,
/// each the largest within this time \[s\].
const MOST: usize = 12;
const APART: f64 = 0.1;

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

/// Instants at which some joint has one of its largest torques.
fn largest(model: &Model, simulation: &Simulation) -> Vec<Instant> {
    let mut data = Data::new();
    let mut looked: Vec<(f64, Instant, Vec<f64>)> = Vec::new();
    for event in &simulation.events {
        let What::Run(run) = &event.what else { continue };
        let steps = (event.duration / STEP).ceil().max(1.0);
        for i in 0..=steps as usize {
            let t = event.duration * i as f64 / steps;
            let state = run.at(t);
            let tau = torque(model, &mut data, &run.load, &state.q, &state.qd, &state.qdd);
            let tau = (0..model.dof).map(|j| (tau.rigid[j] + tau.friction[j]).abs()).collect();
            let state = [state.q, state.qd, state.qdd];
            let instant = Instant { load: run.load.clone(), state };
            looked.push((event.t_start + t, instant, tau));
        }
    }
    let mut chosen: Vec<usize> = Vec::new();
    for j in 0..model.dof {
        let mut order: Vec<usize> = (0..looked.len()).collect();
        order.sort_by(|a, b| looked[*b].2[j].total_cmp(&looked[*a].2[j]));
        let mut own: Vec<usize> = Vec::new();
        for i in order {
            if own.len() == MOST {
                break;
            }
            if own.iter().all(|k| (looked[*k].0 - looked[i].0).abs() > APART) {
                own.push(i);
            }
        }
        chosen.extend(own);
    }
    chosen.into_iter().map(|i| looked[i].1.clone()).collect()
}

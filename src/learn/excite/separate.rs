//! The motion that is worth most, whatever its worth is: random search within all limits.
//!
//! A worth that takes a tenth of a second leaves no room for differences over each variable: a motion is
//! changed at random, and kept where it is worth more (I. Rechenberg, Evolutionsstrategie, 1973).

use nalgebra::DVector;
use rayon::prelude::*;

use super::design::{Design, Designed, FINER, Problem, Work};
use super::error::ExciteError;
use super::plateaus::pose;
use super::series::State;
use crate::arm::robot::Model;

/// Random motions, and how many of them are changed.
const TRIED: usize = 48;
const STARTS: usize = 2;
/// Rounds of changes, changes in a round, and their sizes.
const ROUNDS: usize = 12;
const CHANGES: usize = 4;
const SIZES: [f64; CHANGES] = [0.6, 0.3, 0.15, 0.08];
/// Sizes of a joint's motion: friction shows at low speeds.
const SLOWER: [f64; 4] = [1.0, 0.6, 0.3, 0.1];
/// Time between the states of which a motion's worth is computed \[s\].
pub const STEP: f64 = 0.025;

/// The best motion found by the worth of its states every [`STEP`]; `progress` receives the number of
/// motions that were tried and the total.
///
/// # Errors
/// The robot lacks limits, or no motion keeps them.
pub fn design_for(
    model: &Model,
    settings: &Design,
    worth: &(dyn Fn(&[State]) -> f64 + Sync),
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Designed, ExciteError> {
    let problem = Problem::new(model, settings)?;
    pose(model, &problem.body())?;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let count = (1.0 / (settings.base_frequency * STEP)).round() as usize;
    let rated = |x: DVector<f64>| -> Option<(f64, DVector<f64>)> {
        let number = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
        progress(number, TRIED + STARTS * ROUNDS * CHANGES);
        let mut work = Work::new(&problem);
        let is_allowed = problem.excess(&mut work, &x, FINER) == 0.0;
        is_allowed.then(|| (worth(&problem.series(&x).sampled(count)), x))
    };
    let mut random = fastrand::Rng::with_seed(settings.seed);
    let tried: Vec<DVector<f64>> = (0..TRIED)
        .map(|_| {
            let mut x = problem.random(&mut random);
            for joint in 0..model.dof {
                let slower = SLOWER[random.usize(0..SLOWER.len())];
                let own = problem.per_joint();
                x.rows_mut(own * joint + 1, own - 1).scale_mut(slower);
            }
            x
        })
        .collect();
    let shrunk = |x: DVector<f64>| problem.shrunk(&mut Work::new(&problem), x);
    let mut best: Vec<(f64, DVector<f64>)> =
        tried.into_par_iter().filter_map(|x| rated(shrunk(x))).collect();
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    best.truncate(STARTS);
    for of in &mut best {
        for _ in 0..ROUNDS {
            let changed: Vec<DVector<f64>> =
                SIZES.iter().map(|size| of.1.map(|x| x + size * normal(&mut random))).collect();
            let next = changed.into_par_iter().filter_map(rated);
            if let Some(next) = next.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|it| it.0 > of.0) {
                *of = next;
            }
        }
    }
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    let found = best.iter().find_map(|(_, x)| problem.repaired(&problem.series(x)));
    found.ok_or(ExciteError::Nowhere)
}

/// A deviate with variance 1: the sum of twelve uniform ones.
fn normal(random: &mut fastrand::Rng) -> f64 {
    (0..12).map(|_| random.f64()).sum::<f64>() - 6.0
}

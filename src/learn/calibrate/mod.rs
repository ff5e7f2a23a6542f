//! Calibration of a robot by the measured power of a running program.
//!
//! Plausible robots ([`Spread`]) differ in the power that they take in a
//! program. The cycles of a log of the cabinet's power are found, folded onto the simulated cycle and
//! averaged in windows. Then each plausible robot is moved to one that fits the log (randomised
//! maximum likelihood, D. Oliver, N. He, A. Reynolds, "Conditioning permeability fields to pressure
//! data", ECMOR 1996): for a linear model these are exact draws of the posterior.

mod aligned;
mod cycle;
mod fold;
mod posterior;
mod refusal;

use nalgebra::DVector;
use rayon::prelude::*;

use crate::arm::effects::{drawn, with_estimates};
use crate::arm::robot::prior::{Plausible, Spread, type_name};
use crate::arm::robot::{Calibration, Model, from_toml, to_toml};
use crate::learn::log::Log;
use crate::retime::energy::along::{Along, Instant};
use crate::retime::energy::change::Changes;
use crate::retime::energy::plausible::{Plausibility, plausibility};
use crate::retime::energy::{account, plausible::DRAWS};
use crate::retime::motion::Simulation;

use aligned::{Aligned, align, check_alike};
use cycle::Cycle;
use fold::{Windows, fold};
use posterior::{Data, Fit};

pub use refusal::Refusal;

/// Robots that are moved to the log.
const ROBOTS: usize = 128;
/// Least number of windows with rows.
const LEAST_WINDOWS: usize = 10;
/// Share of the variance of the power over the cycle that the fitted robot has to explain.
const EXPLAINS: f64 = 0.75;
/// Correlation of the power in windows with the model's from which on it is the program's.
const ALIKE: f64 = 0.8;
/// Correlation without means of a torque with the model's below which its sign is wrong: friction and
/// gravity decide the sign, and no plausible robot turns both.
const AGAINST: f64 = -0.3;
/// Deviations from the plausible robots' mean beyond which a log belongs to none of them.
const FAR: f64 = 4.0;

/// A calibrated robot.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// The robot, with its draws.
    pub model: Model,
    /// How well its energies in the program were known.
    pub before: Plausibility,
    /// How well they are now.
    pub after: Plausibility,
    /// Robots that were moved to the log.
    pub robots: usize,
    /// What was found in the log.
    pub found: Found,
    /// Groups that are known better now: name, standard deviation left of one.
    pub narrowed: Vec<(String, f64)>,
}

/// What was found in the log.
#[derive(Clone, Debug)]
pub struct Found {
    /// Whether the power was in kW.
    pub kilowatts: bool,
    /// Cycles that were used.
    pub cycles: usize,
    /// Duration of the cycles over the simulated one.
    pub pace: f64,
    /// Share of the variance of the power that the fitted robot explains.
    pub explained: f64,
    /// What the fitted robot leaves unexplained over the noise of the log.
    pub misfit: f64,
    /// Whether the torques of the joints were used.
    pub torques: bool,
}

/// A log on a cycle.
struct Folded<'a> {
    aligned: Aligned,
    windows: Windows,
    along: Along<'a>,
}

impl<'a> Folded<'a> {
    fn new(
        model: &'a Model,
        cycle: &Cycle<'_>,
        log: &Log,
        torques: Option<&[Vec<f64>]>,
    ) -> Result<Folded<'a>, Refusal> {
        let aligned = align(cycle, log)?;
        let windows = fold(cycle, log, &aligned, torques);
        if windows.power.len() < LEAST_WINDOWS {
            return Err(Refusal::Sparse { windows: windows.power.len(), least: LEAST_WINDOWS });
        }
        check_alike(cycle, log, &aligned.passes)?;
        let instants: Vec<Instant> = windows.times.iter().map(|t| cycle.at(*t)).collect();
        let along = Along::new(model, &instants, windows.ranges.clone());
        Ok(Folded { aligned, windows, along })
    }
}

/// Moves plausible robots to the log of a program.
///
/// # Errors
/// The log is not of the program, or not of the robot.
pub fn calibrate(
    model: &Model,
    simulation: &Simulation,
    log: &Log,
    torques: Option<&[Vec<f64>]>,
) -> Result<Calibrated, Refusal> {
    if model.calibration.is_some() {
        return Err(Refusal::Again { name: model.name.clone() });
    }
    let before = plausibility(model, simulation, &account(model, simulation));
    let before = before.ok_or_else(|| Refusal::Known { name: model.name.clone() })?;
    let spread = Spread::new(model);
    let own = Changes::of_one(model, &Plausible::nominal(model));
    let cycle = Cycle::new(model, simulation)?;
    let rough = Folded::new(model, &cycle, log, torques)?;
    let data = Data::new(&rough.along, &rough.windows);
    let likely = Fit { model, spread: &spread, along: &rough.along, data: &data }.most_likely();
    let explained = data.explained(&likely.means);
    // The shape of the power identifies the program, its size the robot.
    if explained < EXPLAINS && data.likeness(&rough.along.means(&own)) < ALIKE {
        return Err(Refusal::Program { explained, least: EXPLAINS });
    }
    check_size(model, &spread, &rough)?;
    check_torques(&rough, &own)?;
    if explained < EXPLAINS {
        return Err(Refusal::Program { explained, least: EXPLAINS });
    }
    // Once more, with the cycle of a robot that is near the log.
    let near = spread.robot(model, |k| likely.z[k]);
    let near = drawn(model, &near).map_err(|error| Refusal::Model { reason: error.to_string() })?;
    let cycle = Cycle::new(&near, simulation)?;
    let Folded { aligned, windows, along } = Folded::new(model, &cycle, log, torques)?;
    let data = Data::new(&along, &windows);
    let fit = Fit { model, spread: &spread, along: &along, data: &data };
    let likely = fit.most_likely();
    let explained = data.explained(&likely.means);
    let misfit = fit.misfit_over_noise(&likely);
    let data = data.with_noise(misfit.max(1.0));
    let fit = Fit { data: &data, ..fit };
    let draws = fit.draws(&likely.z, ROBOTS);
    if draws.len() * 2 < ROBOTS {
        return Err(Refusal::Fit { fitted: draws.len(), robots: ROBOTS });
    }
    let calibrated = centred(model, &spread, &likely.z, &draws)?;
    let simulated = account(&calibrated, simulation);
    let after = plausibility(&calibrated, simulation, &simulated);
    let after = after.ok_or_else(|| Refusal::Known { name: model.name.clone() })?;
    Ok(Calibrated {
        narrowed: narrowed(&spread, &draws),
        model: calibrated,
        before,
        after,
        robots: ROBOTS,
        found: Found {
            kilowatts: aligned.kilowatts,
            cycles: aligned.passes.len(),
            pace: aligned.pace(),
            explained,
            misfit,
            torques: torques.is_some(),
        },
    })
}

/// Torques of the model and of the log go the same way, however large they are.
fn check_torques(rough: &Folded<'_>, own: &Changes) -> Result<(), Refusal> {
    let expected = rough.along.means(own).torque;
    for (j, ((measured, _), expected)) in rough.windows.torque.iter().zip(&expected).enumerate() {
        let measured = DVector::from_column_slice(measured);
        let norms = measured.norm() * expected.norm();
        let correlation = measured.dot(expected) / norms.max(f64::MIN_POSITIVE);
        if correlation < AGAINST {
            return Err(Refusal::Torque { joint: j + 1, correlation });
        }
    }
    Ok(())
}

/// A log whose power is far from that of all plausible robots belongs to another one.
fn check_size(
    model: &Model,
    spread: &Spread,
    Folded { along, windows, .. }: &Folded<'_>,
) -> Result<(), Refusal> {
    let size = |power: &[f64]| {
        let mean = power.iter().sum::<f64>() / power.len() as f64;
        let square: f64 = power.iter().map(|w| (w - mean).powi(2)).sum();
        [mean, (square / power.len() as f64).sqrt()]
    };
    let robots = spread.draws(model, DRAWS).robots;
    let sizes: Vec<[f64; 2]> = robots
        .par_iter()
        .map(|robot| size(along.means(&Changes::of_one(model, robot)).power.as_slice()))
        .collect();
    let measured = size(&windows.power);
    for (i, what) in ["mean power", "swing of the power"].into_iter().enumerate() {
        let logs: Vec<f64> = sizes.iter().map(|size| size[i].max(f64::MIN_POSITIVE).ln()).collect();
        let mean = logs.iter().sum::<f64>() / logs.len() as f64;
        let sd = logs.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / logs.len() as f64;
        let sd = sd.sqrt().max(f64::MIN_POSITIVE);
        let off = (measured[i].ln() - mean).abs();
        // A power below 0 has no logarithm: it is refused, too.
        if off.is_nan() || off > FAR * sd {
            let [low, high] = [-2.0, 2.0].map(|k: f64| (mean + k * sd).exp());
            return Err(Refusal::Robot {
                name: model.name.clone(),
                what,
                measured: measured[i],
                low,
                high,
            });
        }
    }
    Ok(())
}

/// The most likely robot, and the draws from there. Means of the latent numbers are no robot that fits
/// the log: where two powers are known by their sum alone, the sum at their means is a smaller one.
fn centred(
    model: &Model,
    spread: &Spread,
    likely: &[f64],
    draws: &[Vec<f64>],
) -> Result<Model, Refusal> {
    let mut new = spread.robot(model, |k| likely[k]).applied(model);
    new.type_name = Some(type_name(model).to_owned());
    let rounded = |x: f64| (x * ROUND).round() / ROUND;
    let of = |k: usize| draws.iter().map(|z| rounded(z[k] - likely[k])).collect::<Vec<f64>>();
    let names = spread.latents.iter().enumerate();
    new.calibration = Some(Calibration {
        robots: draws.len(),
        draws: names.map(|(k, latent)| (latent.name.clone(), of(k))).collect(),
        place: String::new(),
    });
    // The rounded values of the file are used.
    let read = from_toml("the calibrated robot", &to_toml(&new)).and_then(with_estimates);
    read.map_err(|error| Refusal::Model { reason: error.to_string() })
}

/// Draws are written with so many steps in a standard deviation.
const ROUND: f64 = 1e4;

/// Standard deviation that is left of each group, the smallest first.
fn narrowed(spread: &Spread, draws: &[Vec<f64>]) -> Vec<(String, f64)> {
    let count = draws.len() as f64;
    let variance = |k: usize| {
        let mean = draws.iter().map(|z| z[k]).sum::<f64>() / count;
        draws.iter().map(|z| (z[k] - mean).powi(2)).sum::<f64>() / (count - 1.0)
    };
    let mut groups: Vec<(String, f64)> = Vec::new();
    for (k, latent) in spread.latents.iter().enumerate() {
        let left = variance(k).sqrt();
        match groups.iter_mut().find(|(group, _)| *group == latent.group) {
            Some((_, least)) => *least = least.min(left),
            None => groups.push((latent.group.clone(), left)),
        }
    }
    groups.sort_by(|a, b| a.1.total_cmp(&b.1));
    groups
}

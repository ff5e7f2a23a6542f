//! Calibration of a robot with the measured power of a running program. Plausible robots
//! ([`Spread`]) differ in their power. The cycles of a power log are located, folded onto the
//! simulated cycle and averaged in windows. Then each plausible robot is fitted to the log
//! (randomised maximum likelihood, D. Oliver, N. He, A. Reynolds, "Conditioning permeability fields
//! to pressure data", ECMOR 1996): for a linear model this gives exact draws of the posterior.

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

/// Number of plausible robots that are fitted to the log.
const ROBOTS: usize = 128;
/// Least number of windows with rows.
const LEAST_WINDOWS: usize = 10;
/// Least share of the power's variance over the cycle that the fitted robot has to explain.
const EXPLAINS: f64 = 0.75;
/// Least correlation of measured and simulated window means for a log of this program.
const ALIKE: f64 = 0.8;
/// Uncentred correlation of measured and simulated torque below which the sign is wrong: friction
/// and gravity determine the sign for every plausible robot.
const AGAINST: f64 = -0.3;
/// Largest distance of a log from the mean of the plausible robots, in standard deviations.
const FAR: f64 = 4.0;

/// A calibrated robot.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// The robot, with its draws.
    pub model: Model,
    /// Uncertainty of its energies in the program before.
    pub before: Plausibility,
    /// Uncertainty after.
    pub after: Plausibility,
    /// Number of robots that were fitted to the log.
    pub robots: usize,
    /// Properties of the log.
    pub found: Found,
    /// Groups of parameters with less uncertainty: name, remaining share of the deviation.
    pub narrowed: Vec<(String, f64)>,
}

/// Properties of the log.
#[derive(Clone, Debug)]
pub struct Found {
    /// Whether the power was in kW.
    pub kilowatts: bool,
    /// Cycles that were used.
    pub cycles: usize,
    /// Duration of the cycles over the simulated duration.
    pub pace: f64,
    /// Share of the variance of the power that the fitted robot explains.
    pub explained: f64,
    /// Residual variance of the fitted robot over the variance of the noise.
    pub misfit: f64,
    /// Whether the torques of the joints were used.
    pub torques: bool,
}

/// A log folded onto a cycle.
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

/// Fits plausible robots to the log of a program.
///
/// # Errors
/// The log is of another program or of another robot.
pub fn calibrate(
    model: &Model,
    simulation: &Simulation,
    log: &Log,
    torques: Option<&[Vec<f64>]>,
) -> Result<Calibrated, Refusal> {
    if model.calibration.is_some() {
        return Err(Refusal::Again(model.name.clone()));
    }
    let before = plausibility(model, simulation, &account(model, simulation));
    let before = before.ok_or_else(|| Refusal::Known(model.name.clone()))?;
    let spread = Spread::new(model);
    let own = Changes::from_one(model, &Plausible::nominal(model));
    let cycle = Cycle::new(model, simulation)?;
    let rough = Folded::new(model, &cycle, log, torques)?;
    let data = Data::new(&rough.along, &rough.windows);
    let likely = Fit { model, spread: &spread, along: &rough.along, data: &data }.most_likely();
    let explained = data.explained(&likely.means);
    // The shape of the power identifies the program, its size the robot.
    if explained < EXPLAINS && data.correlation(&rough.along.means(&own)) < ALIKE {
        return Err(Refusal::Program { explained, least: EXPLAINS });
    }
    check_size(model, &spread, &rough)?;
    check_torques(&rough, &own)?;
    if explained < EXPLAINS {
        return Err(Refusal::Program { explained, least: EXPLAINS });
    }
    // The second pass uses the cycle of a robot that is near the log.
    let near = spread.robot(model, |k| likely.z[k]);
    let near = drawn(model, &near).map_err(|error| Refusal::Model(error.to_string()))?;
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
    let after = after.ok_or_else(|| Refusal::Known(model.name.clone()))?;
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

/// Refuses measured torques of the opposite sign.
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

/// Refuses a log whose power is far from that of all plausible robots.
fn check_size(
    model: &Model,
    spread: &Spread,
    Folded { along, windows, .. }: &Folded<'_>,
) -> Result<(), Refusal> {
    let robots = spread.draws(model, DRAWS).robots;
    let sizes: Vec<[f64; 2]> = robots
        .par_iter()
        .map(|robot| mean_and_sd(along.means(&Changes::from_one(model, robot)).power.as_slice()))
        .collect();
    let measured = mean_and_sd(&windows.power);
    for (i, what) in ["mean power", "swing of the power"].into_iter().enumerate() {
        let logs: Vec<f64> = sizes.iter().map(|size| size[i].max(f64::MIN_POSITIVE).ln()).collect();
        let [mean, sd] = mean_and_sd(&logs);
        let off = (measured[i].ln() - mean).abs();
        // A negative power has no logarithm and is refused, too.
        if off.is_nan() || off > FAR * sd.max(f64::MIN_POSITIVE) {
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

fn mean_and_sd(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    [mean, (squares / count).sqrt()]
}

/// The most likely robot, and the draws relative to it. The means of the latent parameters do not
/// give a robot that fits the log: if the log determines only the sum of two powers, the sum at the
/// means is too small.
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
    // The model is read back, because the file rounds its values.
    let read = from_toml("the calibrated robot", &to_toml(&new)).and_then(with_estimates);
    read.map_err(|error| Refusal::Model(error.to_string()))
}

/// Draws are rounded to this number of steps per standard deviation.
const ROUND: f64 = 1e4;

/// Remaining share of the standard deviation of each group, ascending.
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

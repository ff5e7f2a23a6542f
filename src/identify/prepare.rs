//! From a log to the instants at which equations are written down.

use crate::log::{Channel, Log, LowPass, Section, bandwidth, median_step, sections};

use super::error::IdentifyError;
use super::samples::{Block, Samples, Source};

/// Share of the power of the motion that its bandwidth holds.
const SHARE: f64 = 0.95;
/// Cut-off frequency of the filter over the bandwidth of the motion: friction changes its
/// sense faster than the motion.
const CUTOFF: f64 = 8.0;
/// Largest cut-off frequency, relative to the sampling rate.
const HIGHEST: f64 = 0.125;
/// Least range of a joint that moves \[rad\].
const MOVES: f64 = 1e-3;
/// Share of a joint's fast rates below which it counts as at rest.
const SLOW: f64 = 0.01;
/// The quantile of its rates that counts as fast.
const FAST: f64 = 0.95;

/// The instants of a log with the torques `tau` of each joint \[Nm\].
///
/// # Errors
/// The log is too short for a filter.
pub fn prepare(log: &Log, tau: &[Vec<f64>]) -> Result<Samples, IdentifyError> {
    let joints = log.joints();
    let q = owned(log, Channel::Position).unwrap_or_default();
    let (qd, qdd) = (owned(log, Channel::Velocity), owned(log, Channel::Acceleration));
    let resting: Vec<usize> = (0..joints).filter(|joint| range(&q[*joint]) < MOVES).collect();
    let mut samples = match (qd, qdd) {
        (Some(qd), Some(qdd)) => {
            let block = Block { t: log.time().to_vec(), q, qd, qdd, tau: tau.to_vec() };
            Samples {
                step: median_step(&block.t),
                blocks: vec![block],
                source: Source::Logged,
                rest: vec![0.0; joints],
                resting,
                noise: None,
            }
        }
        (qd, _) => differentiated(log, &q, qd.as_deref(), tau, resting)?,
    };
    still(&mut samples);
    Ok(samples)
}

fn owned(log: &Log, channel: fn(usize) -> Channel) -> Option<Vec<Vec<f64>>> {
    Some(log.of_joints(channel)?.into_iter().map(<[f64]>::to_vec).collect())
}

fn range(x: &[f64]) -> f64 {
    let (low, high) = x
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    high - low
}

/// Rates between samples \[rad/s\].
fn changes(x: &[f64], step: f64) -> Vec<f64> {
    x.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect()
}

/// A joint that rests does so exactly, so that nothing is read into its noise.
fn still(samples: &mut Samples) {
    for block in &mut samples.blocks {
        for joint in &samples.resting {
            let mean = block.q[*joint].iter().sum::<f64>() / block.len().max(1) as f64;
            block.q[*joint].fill(mean);
            block.qd[*joint].fill(0.0);
            block.qdd[*joint].fill(0.0);
        }
    }
}

fn differentiated(
    log: &Log,
    q: &[Vec<f64>],
    qd: Option<&[Vec<f64>]>,
    tau: &[Vec<f64>],
    resting: Vec<usize>,
) -> Result<Samples, IdentifyError> {
    let joints = q.len();
    let all: Vec<&[f64]> = q
        .iter()
        .chain(tau)
        .chain(qd.unwrap_or_default())
        .map(Vec::as_slice)
        .collect();
    let sections = sections(log.time(), &all);
    let Some(longest) = sections.iter().max_by_key(|section| section.len()) else {
        return Err(IdentifyError::Short { seconds: 0.0 });
    };
    let step = longest.step;
    let moving = (0..joints).filter(|joint| !resting.contains(joint));
    let fastest = moving
        .map(|joint| {
            // Logged rates have less noise than the changes of positions.
            let rates = longest.series.get(2 * joints + joint);
            rates.map_or_else(
                || bandwidth(&changes(&longest.series[joint], step), step, SHARE),
                |rates| bandwidth(rates, step, SHARE),
            )
        })
        .fold(0.0_f64, f64::max);
    let cutoff = (CUTOFF * fastest).min(HIGHEST / step);
    let filter = LowPass::new(cutoff, step);
    let blocks: Vec<Block> = sections
        .iter()
        // Twice the kernel, and some instants to use.
        .filter(|section| section.len() > 3 * filter.width())
        .map(|section| block(section, joints, &filter))
        .collect();
    if blocks.is_empty() {
        return Err(IdentifyError::Short { seconds: 3.0 * step * filter.width() as f64 });
    }
    let rest = (0..joints).map(|joint| slow(&blocks, joint)).collect();
    Ok(Samples { blocks, source: Source::Filtered { cutoff }, step, rest, resting, noise: None })
}

fn block(section: &Section, joints: usize, filter: &LowPass) -> Block {
    let all = |from: usize, order: usize| -> Vec<Vec<f64>> {
        section.series[from..from + joints].iter().map(|x| filter.filtered(x, order)).collect()
    };
    let rates = section.series.len() == 3 * joints;
    let (qd, qdd) = if rates {
        (all(2 * joints, 0), all(2 * joints, 1))
    } else {
        (all(0, 1), all(0, 2))
    };
    let q = all(0, 0);
    let count = q.first().map_or(0, Vec::len);
    let tau = section.series[joints..2 * joints]
        .iter()
        .map(|x| x[filter.half..filter.half + count].to_vec())
        .collect();
    let t = (0..count).map(|i| section.time(i + filter.half)).collect();
    Block { t, q, qd, qdd, tau }
}

/// The rate below which a joint counts as at rest \[rad/s\].
fn slow(blocks: &[Block], joint: usize) -> f64 {
    let mut rates: Vec<f64> =
        blocks.iter().flat_map(|block| block.qd[joint].iter().map(|x| x.abs())).collect();
    rates.sort_by(f64::total_cmp);
    let index = (FAST * rates.len() as f64) as usize;
    SLOW * rates.get(index).copied().unwrap_or(0.0)
}

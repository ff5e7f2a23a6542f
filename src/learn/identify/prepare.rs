//! Selection of the instants of a log at which the equations of motion are written.

use crate::learn::log::{
    Channel, Log, LowPass, Periods, Section, averaged, bandwidth, find_periods, median_step,
    quantile, range, sections,
};

use super::clipped::{Spans, clipped, folded};
use super::error::IdentifyError;
use super::noise::autocovariance;
use super::samples::{Block, Samples, Source};

/// Share of the motion's power within its bandwidth.
const SHARE: f64 = 0.95;
/// Cut-off frequency over the bandwidth of the motion: friction has a wider bandwidth.
const CUTOFF: f64 = 8.0;
/// Largest cut-off frequency, relative to the sampling rate.
const HIGHEST: f64 = 0.125;
/// Least range of a joint that moves \[rad\].
const MOVES: f64 = 1e-3;
/// Rate below which a joint counts as at rest, as a share of its fast rate.
const SLOW: f64 = 0.01;
/// Quantile of the rates that counts as fast.
const FAST: f64 = 0.95;

/// Sampling rate above which samples are decimated \[Hz\] …
const FASTEST: f64 = 1200.0;
/// … to about this rate \[Hz\], which contains all frequencies of a joint's motion.
const THINNED: f64 = 400.0;
/// Cut-off frequency of the decimation filter, relative to the new rate.
const PASSED: f64 = 0.4;
/// Duration of the filter's step response, in periods of its cut-off frequency.
const SMEARED: f64 = 1.0;
/// Ratio of squared deviations from the mean, first repetition to the others, above which the first
/// one counts as a transient.
const SETTLING: f64 = 4.0;

/// Known properties of a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hints {
    /// Duration of a repetition \[s\].
    pub period: Option<f64>,
    /// Cut-off frequency of the filter \[Hz\], if another log determined it.
    pub cutoff: Option<f64>,
}

/// The instants of a log with the joint torques `tau` \[Nm\], by joint, then by row of the log.
///
/// # Errors
/// Torques that do not fit the log, no joint moves, or the log is too short for a filter.
pub fn prepare(log: &Log, tau: &[Vec<f64>], hints: Hints) -> Result<Samples, IdentifyError> {
    let (joints, rows) = (log.joints(), log.time().len());
    if tau.len() != joints {
        return Err(IdentifyError::Torques { joints: tau.len(), logged: joints });
    }
    for (number, series) in (1..).zip(tau) {
        if series.len() != rows {
            let logged = rows;
            return Err(IdentifyError::TorqueRows { joint: number, rows: series.len(), logged });
        }
        if let Some(row) = series.iter().position(|tau| !tau.is_finite()) {
            return Err(IdentifyError::NotFinite { joint: number, row: row + 1 });
        }
    }
    let q = owned(log, Channel::Position).unwrap_or_default();
    let (qd, qdd) = (owned(log, Channel::Velocity), owned(log, Channel::Acceleration));
    let resting: Vec<usize> = (0..joints).filter(|joint| range(&q[*joint]) < MOVES).collect();
    if resting.len() == joints {
        return Err(IdentifyError::Still(MOVES));
    }
    let clipped = clipped(log.time(), &q, tau);
    let mut samples = match (qd, qdd) {
        (Some(qd), Some(qdd)) => {
            let block = Block { t: log.time().to_vec(), q, qd, qdd, tau: tau.to_vec(), clipped };
            Samples {
                step: median_step(&block.t),
                blocks: vec![block],
                source: Source::Logged,
                rest: vec![0.0; joints],
                resting,
                noise: None,
                repetitions: None,
            }
        }
        (qd, _) => differentiated(log, &q, qd.as_deref(), (tau, &clipped), resting, hints)?,
    };
    still(&mut samples);
    Ok(samples)
}

fn owned(log: &Log, channel: fn(usize) -> Channel) -> Option<Vec<Vec<f64>>> {
    Some(log.of_joints(channel)?.into_iter().map(<[f64]>::to_vec).collect())
}

/// Mean rates between samples \[rad/s\].
fn changes(x: &[f64], step: f64) -> Vec<f64> {
    x.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect()
}

/// Removes the encoder noise of resting joints.
fn still(samples: &mut Samples) {
    for block in &mut samples.blocks {
        for joint in &samples.resting {
            let mean = block.q[*joint].iter().sum::<f64>() / block.instants().max(1) as f64;
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
    (tau, clipped): (&[Vec<f64>], &Spans),
    resting: Vec<usize>,
    hints: Hints,
) -> Result<Samples, IdentifyError> {
    let joints = q.len();
    let all: Vec<&[f64]> =
        q.iter().chain(tau).chain(qd.unwrap_or_default()).map(Vec::as_slice).collect();
    let sections = sections(log.time(), &all);
    // Duration over which decimation smears the reversal of a joint \[s\].
    let smeared = sections.first().map_or(0.0, |section| {
        thinning(section).map_or(0.0, |every| SMEARED * every as f64 * section.step / PASSED)
    });
    let sections: Vec<Section> = sections.iter().map(thinned).collect();
    let Some(longest) = sections.iter().max_by_key(|section| section.samples()) else {
        return Err(IdentifyError::Short(0.0));
    };
    let step = longest.step;
    let known = hints.period.or_else(|| of_cycles(log));
    let positions: Vec<&[f64]> = longest.series[..joints].iter().map(Vec::as_slice).collect();
    // A motion that does not repeat with the given period may have another period.
    let found = |known| find_periods(&positions, step, known);
    if hints.cutoff.is_none()
        && let Some(periods) = found(known).or_else(|| known.and_then(|_| found(None)))
    {
        let mut samples = periodic(longest, &periods, joints, resting);
        let start = samples.blocks[0].t[0];
        samples.blocks[0].clipped = folded(clipped, start, periods.period);
        for (joint, rest) in samples.rest.iter_mut().enumerate() {
            let hard = samples.blocks[0].qdd[joint].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            *rest = rest.max(hard * smeared);
        }
        return Ok(samples);
    }
    let moving = (0..joints).filter(|joint| !resting.contains(joint));
    let fastest = moving
        .map(|joint| {
            // Logged rates have less noise than differences of positions.
            let rates = longest.series.get(2 * joints + joint);
            rates.map_or_else(
                || bandwidth(&changes(&longest.series[joint], step), step, SHARE),
                |rates| bandwidth(rates, step, SHARE),
            )
        })
        .fold(0.0_f64, f64::max);
    let cutoff = hints.cutoff.unwrap_or(CUTOFF * fastest).min(HIGHEST / step);
    let filter = LowPass::new(cutoff, step);
    let blocks: Vec<Block> = sections
        .iter()
        // The filter uses twice its kernel; some instants have to remain.
        .filter(|section| section.samples() > 3 * filter.width())
        .map(|section| block(section, joints, &filter, clipped))
        .collect();
    if blocks.is_empty() {
        return Err(IdentifyError::Short(3.0 * step * filter.width() as f64));
    }
    let rest = (0..joints).map(|joint| slow(&blocks, joint)).collect();
    Ok(Samples {
        blocks,
        source: Source::Filtered { cutoff },
        step,
        rest,
        resting,
        noise: None,
        repetitions: None,
    })
}

/// One of this many samples is kept; `None` for all.
fn thinning(section: &Section) -> Option<usize> {
    let fast = section.step * FASTEST <= 1.0;
    fast.then(|| (1.0 / (section.step * THINNED)).floor().max(2.0) as usize)
}

/// The section, decimated if its sampling rate is needlessly high.
fn thinned(section: &Section) -> Section {
    let Some(every) = thinning(section) else { return section.clone() };
    let step = section.step * every as f64;
    let filter = LowPass::new(PASSED / step, section.step);
    if section.samples() < 2 * filter.width() {
        return section.clone();
    }
    let of = |x: &Vec<f64>| -> Vec<f64> {
        let weights = filter.weights(0);
        x.windows(filter.width())
            .step_by(every)
            .map(|part| part.iter().zip(weights).map(|(x, w)| x * w).sum())
            .collect()
    };
    Section {
        start: section.time(filter.half),
        step,
        series: section.series.iter().map(of).collect(),
        lost: Vec::new(),
    }
}

/// The period according to the column `cycle` \[s\].
fn of_cycles(log: &Log) -> Option<f64> {
    let cycle = log.column(Channel::Cycle)?;
    let t = log.time();
    let begins: Vec<usize> = (1..t.len()).filter(|i| cycle[*i] != cycle[i - 1]).collect();
    // Complete repetitions lie between two changes; the log may lack some of them.
    let (first, last) = (*begins.first()?, *begins.last()?);
    let count = (cycle[last] - cycle[first]).max((begins.len() - 1) as f64);
    (count > 0.0).then(|| (t[last] - t[first]) / count)
}

/// Instants of one period: the mean of all repetitions.
fn periodic(section: &Section, periods: &Periods, joints: usize, resting: Vec<usize>) -> Samples {
    let mut periods = *periods;
    let mut mean = averaged(section, &periods, joints);
    if periods.count > 3 && is_settling(&mean.spread) {
        let samples = mean.spread.first().and_then(|of| of.first()).map_or(0, Vec::len);
        periods.first += samples;
        periods.count -= 1;
        mean = averaged(section, &periods, joints);
    }
    let count = periods.count as f64;
    let noise = mean.spread[..joints]
        .iter()
        .map(|repetitions| {
            let residuals: Vec<(usize, usize, f64)> = repetitions
                .iter()
                .enumerate()
                .flat_map(|(r, of)| of.iter().enumerate().map(move |(k, e)| (r, k, *e)))
                .collect();
            // The noise variance of the mean is that of a repetition over their number.
            let lost = residuals.len() as f64 / count;
            autocovariance(&residuals, lost).iter().map(|c| c / count).collect()
        })
        .collect();
    let [q, qd, qdd] = mean.motion;
    let samples = q.first().map_or(0, Vec::len);
    let start = section.time(periods.first);
    let block = Block {
        t: (0..samples).map(|k| start + mean.step * k as f64).collect(),
        q,
        qd,
        qdd,
        tau: mean.mean[..joints].to_vec(),
        clipped: vec![Vec::new(); joints],
    };
    let blocks = vec![block];
    Samples {
        rest: (0..joints).map(|joint| slow(&blocks, joint)).collect(),
        blocks,
        source: Source::Periodic {
            period: periods.period,
            periods: periods.count,
            harmonics: mean.harmonics,
        },
        step: mean.step,
        resting,
        noise: Some(noise),
        repetitions: Some(mean.spread.into_iter().take(joints).collect()),
    }
}

/// Whether the first repetition deviates much more from the mean than the others.
fn is_settling(spread: &[Vec<Vec<f64>>]) -> bool {
    let power = |x: &Vec<f64>| x.iter().map(|e| e * e).sum::<f64>();
    spread.iter().any(|repetitions| {
        let all: Vec<f64> = repetitions.iter().map(power).collect();
        let others = all[1..].iter().fold(0.0, |m: f64, x| m.max(*x));
        all[0] > SETTLING * others
    })
}

fn block(section: &Section, joints: usize, filter: &LowPass, clipped: &Spans) -> Block {
    let all = |from: usize, order: usize| -> Vec<Vec<f64>> {
        section.series[from..from + joints].iter().map(|x| filter.filtered(x, order)).collect()
    };
    let rates = section.series.len() == 3 * joints;
    let (qd, qdd) =
        if rates { (all(2 * joints, 0), all(2 * joints, 1)) } else { (all(0, 1), all(0, 2)) };
    let q = all(0, 0);
    let count = q.first().map_or(0, Vec::len);
    let tau = section.series[joints..2 * joints]
        .iter()
        .map(|x| x[filter.half..filter.half + count].to_vec())
        .collect();
    let t: Vec<f64> = (0..count).map(|i| section.time(i + filter.half)).collect();
    let here =
        |span: &&[f64; 2]| span[1] >= section.start && span[0] <= section.time(section.samples());
    let clipped = clipped.iter().map(|of| of.iter().filter(here).copied().collect()).collect();
    Block { t, q, qd, qdd, tau, clipped }
}

/// The rate below which a joint counts as at rest \[rad/s\].
fn slow(blocks: &[Block], joint: usize) -> f64 {
    SLOW * quantile(blocks.iter().flat_map(|block| &block.qd[joint]).map(|x| x.abs()), FAST)
}

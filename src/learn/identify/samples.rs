//! The instants of a log at which the equations of motion are written.

use crate::arm::robot::MAX_DOF;

use super::clipped::is_clipped;

/// Source of the rates and accelerations.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Logged; every row is an independent instant.
    Logged,
    /// Differentiated after a low-pass filter; torque and regressor pass the same filter.
    Filtered {
        /// Cut-off frequency \[Hz\].
        cutoff: f64,
    },
    /// Repetitions were averaged, and the Fourier series of the positions was differentiated.
    Periodic {
        /// Duration of a repetition \[s\].
        period: f64,
        /// Number of repetitions that were averaged.
        periods: usize,
        /// Harmonics of the series.
        harmonics: usize,
    },
}

/// Motion and torque without a gap; at equal intervals unless the rates were logged.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Times \[s\].
    pub t: Vec<f64>,
    /// Positions of each joint \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Rates \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<Vec<f64>>,
    /// Torques at each joint \[Nm\].
    pub tau: Vec<Vec<f64>>,
    /// For each joint, spans of time in which its torque is clipped \[s\].
    pub clipped: Vec<Vec<[f64; 2]>>,
}

impl Block {
    /// Number of instants.
    #[must_use]
    pub fn instants(&self) -> usize {
        self.t.len()
    }

    /// The instants of the block with these indices.
    #[must_use]
    pub(super) fn select(&self, kept: &[usize]) -> Block {
        let of = |x: &Vec<f64>| -> Vec<f64> { kept.iter().map(|i| x[*i]).collect() };
        let of_joints = |series: &[Vec<f64>]| series.iter().map(of).collect();
        Block {
            t: of(&self.t),
            q: of_joints(&self.q),
            qd: of_joints(&self.qd),
            qdd: of_joints(&self.qdd),
            tau: of_joints(&self.tau),
            clipped: self.clipped.clone(),
        }
    }

    /// One row of a series by joint; entries beyond the robot's joints are 0.
    #[must_use]
    pub fn at(series: &[Vec<f64>], index: usize) -> [f64; MAX_DOF] {
        let mut row = [0.0; MAX_DOF];
        for (to, from) in row.iter_mut().zip(series) {
            *to = from[index];
        }
        row
    }
}

/// All instants of one or several logs.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Blocks in order of time.
    pub blocks: Vec<Block>,
    /// Source of the rates.
    pub source: Source,
    /// Interval of the instants \[s\].
    pub step: f64,
    /// Rate of each joint up to which it counts as at rest \[rad/s\].
    pub rest: Vec<f64>,
    /// Joints that never move, from 0.
    pub resting: Vec<usize>,
    /// Autocovariances of each joint's torque noise at lag 0, 1, … \[N²m²\], if repetitions
    /// determine them.
    pub noise: Option<Vec<Vec<f64>>>,
    /// Deviation of each repetition's torque from the mean, by joint, by repetition \[Nm\].
    pub repetitions: Option<Vec<Vec<Vec<f64>>>>,
}

impl Samples {
    /// Number of instants.
    #[must_use]
    pub fn instants(&self) -> usize {
        self.blocks.iter().map(Block::instants).sum()
    }

    /// For each joint, the share of the instants at which its torque is clipped.
    #[must_use]
    pub fn share_at_limits(&self) -> Vec<f64> {
        let joints = self.blocks.first().map_or(0, |block| block.clipped.len());
        let mut counts = vec![0_usize; joints];
        for block in &self.blocks {
            for (count, spans) in counts.iter_mut().zip(&block.clipped) {
                if !spans.is_empty() {
                    *count += block.t.iter().filter(|t| is_clipped(spans, **t, 0.0)).count();
                }
            }
        }
        counts.iter().map(|count| *count as f64 / self.instants().max(1) as f64).collect()
    }
}

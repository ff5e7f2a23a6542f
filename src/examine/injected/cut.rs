//! A log in three parts of several blocks each.

use super::arm::Arm;
use super::motion::rms;
use crate::examine::blind::random::Random;
use crate::learn::identify::{Hints, prepare};
use crate::learn::log::{Channel, Log};

/// Numbers of blocks in a part.
const BLOCKS: [usize; 3] = [1, 2, 3];
/// Cuts that are tried.
const CUTS: usize = 64;
/// Excitation of all parts at which a cut is taken, and the least one of the best cut.
const EXCITED: f64 = 0.5;
const LEAST: f64 = 0.2;
/// Largest displacement of the border of a block, over its length.
const UNEVEN: f64 = 0.15;
/// Part of a block that has to be long enough already.
const ENOUGH: f64 = 0.75;

/// Rows of the blocks in each part.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cut {
    /// Measured before the effect.
    pub(super) baseline: Vec<Vec<usize>>,
    /// With the effect.
    pub(super) log: Vec<Vec<usize>>,
    /// With the effect, held out.
    pub(super) heldout: Vec<Vec<usize>>,
}

impl Cut {
    /// A random cut whose parts move all joints, or the best one of several; `None` if some joint
    /// hardly moves in a part.
    pub(super) fn drawn(arm: &Arm, random: &mut Random) -> Option<Cut> {
        let mut best: Option<(f64, Cut)> = None;
        for _ in 0..CUTS {
            let count = BLOCKS[random.below(BLOCKS.len())];
            let cut = Cut::of(arm.motion.rows(), count, random);
            let parts = cut.parts().into_iter();
            let excited = parts.map(|part| excitation(arm, part)).fold(f64::INFINITY, f64::min);
            let blocks = || cut.parts().into_iter().flatten();
            if best.as_ref().is_some_and(|(most, _)| excited <= *most)
                || !blocks().all(|rows| is_long_enough(arm, rows))
            {
                continue;
            }
            if excited >= EXCITED {
                return Some(cut);
            }
            best = Some((excited, cut));
        }
        best.filter(|(excited, _)| *excited >= LEAST).map(|(_, cut)| cut)
    }

    /// `count` blocks in each part: one of each in every round, in random order.
    fn of(rows: usize, count: usize, random: &mut Random) -> Cut {
        let mut parts = [const { Vec::new() }; 3];
        let blocks = 3 * count;
        let mut border = |block: usize| {
            let moved =
                if block.is_multiple_of(blocks) { 0.0 } else { random.between(-UNEVEN, UNEVEN) };
            (rows as f64 * (block as f64 + moved) / blocks as f64) as usize
        };
        let borders: Vec<usize> = (0..=blocks).map(&mut border).collect();
        for round in borders.windows(4).step_by(3) {
            let mut order = [0, 1, 2];
            random.shuffle(&mut order);
            for (part, ends) in order.into_iter().zip(round.windows(2)) {
                parts[part].push((ends[0]..ends[1]).collect());
            }
        }
        let [baseline, log, heldout] = parts;
        Cut { baseline, log, heldout }
    }

    /// The three parts.
    pub(super) fn parts(&self) -> [&[Vec<usize>]; 3] {
        [&self.baseline, &self.log, &self.heldout]
    }
}

/// How much a part moves each joint: the least rms rate or range over that in the whole log.
fn excitation(arm: &Arm, part: &[Vec<usize>]) -> f64 {
    let motion = &arm.motion;
    let of_joint = |joint: usize| {
        let rows = || part.iter().flatten().copied();
        let rate = rms(rows().map(|row| motion.qd[row][joint]));
        let q = rows().map(|row| motion.q[row][joint]);
        let [low, high] =
            q.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q), high.max(q)]);
        let [from, to] = motion.range(joint);
        f64::min(rate / motion.rms_rate(joint), (high - low) / (to - from))
    };
    (0..arm.dof()).map(of_joint).fold(f64::INFINITY, f64::min)
}

/// Whether `identify` can differentiate a block, even with a narrower filter.
fn is_long_enough(arm: &Arm, rows: &[usize]) -> bool {
    let rows = &rows[..(ENOUGH * rows.len() as f64) as usize];
    let column = |values: &dyn Fn(usize) -> f64| rows.iter().map(|row| values(*row)).collect();
    let mut channels = vec![Channel::Time];
    let mut columns: Vec<Vec<f64>> = vec![column(&|row| arm.motion.t[row])];
    let mut tau: Vec<Vec<f64>> = Vec::new();
    for joint in 0..arm.dof() {
        channels.push(Channel::Position(joint));
        columns.push(column(&|row| arm.motion.q[row][joint]));
        if let Some(rates) = &arm.rates {
            channels.push(Channel::Velocity(joint));
            columns.push(column(&|row| rates[row][joint]));
        }
        tau.push(column(&|row| arm.tau[row][joint]));
    }
    let log = Log {
        channels,
        values: columns,
        rows: rows.iter().map(|row| *row as u64).collect(),
        rejected: Vec::new(),
        degrees: Vec::new(),
    };
    prepare(&log, &tau, Hints::default()).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_take_each_row_once() {
        let cut = Cut::of(1000, 2, &mut Random::new(1, 1, "test"));
        let mut rows: Vec<usize> = cut.parts().into_iter().flatten().flatten().copied().collect();
        rows.sort_unstable();
        assert_eq!(rows, (0..1000).collect::<Vec<_>>());
        assert!(cut.parts().iter().all(|part| part.len() == 2));
        let rising = |rows: &Vec<usize>| rows.windows(2).all(|pair| pair[1] == pair[0] + 1);
        assert!(cut.parts().into_iter().flatten().all(rising));
    }
}

//! The instants of a motion that are compared, and their transform to rows of a spectrum.

use super::spectrum::Spectrum;
use crate::arm::effects::Motion;

/// Part of an open log at each end that is faded in and out.
const FADED: f64 = 0.05;
/// Rows over which a filter spreads, in parts of the period of its cut-off frequency.
const SPREAD: f64 = 0.8;

/// What is used of a motion.
#[derive(Clone)]
pub(super) struct Used {
    /// Weight of each instant, by joint: 0 where the joint rests.
    pub(super) window: Vec<Vec<f64>>,
    /// By joint, the rows of each rest, whose mean tells nothing.
    rests: Vec<Vec<Vec<usize>>>,
    /// The transform.
    pub(super) spectrum: Spectrum,
}

impl Used {
    /// Joints rest below the rates `rest` \[rad/s\]; frequencies up to `highest` \[Hz\], behind a
    /// filter with a cut-off frequency \[Hz\] where there is one.
    pub(super) fn new(
        motion: &Motion<'_>,
        rest: &[f64],
        highest: f64,
        cutoff: Option<f64>,
    ) -> Used {
        let fade: Vec<f64> = (0..motion.rows()).map(|row| faded(row, motion)).collect();
        let moving = |joint: usize| -> Vec<f64> {
            let moves = |row: usize| {
                motion.qd[joint][row].abs() > rest[joint] && senses_known(motion, joint, row)
            };
            (0..motion.rows()).map(|row| if moves(row) { fade[row] } else { 0.0 }).collect()
        };
        // A filter spreads what is unknown over the rows beside it: when a motor begins to move.
        let reach = cutoff.map_or(0, |cutoff| (SPREAD / (cutoff * motion.step())).ceil() as usize);
        let window = |joint: usize| {
            let known = passed(moving(joint), reach, &fade);
            let narrow = narrowed(&known, reach, motion.closed);
            // A motion of short moves alone is used as it is.
            if narrow.iter().any(|w| *w > 0.0) { narrow } else { known }
        };
        let rests = |joint: usize| match cutoff {
            Some(_) => rests(&motion.senses[joint], motion.closed),
            None => Vec::new(),
        };
        let joints = 0..motion.model.dof;
        let spectrum = Spectrum::new(motion.rows(), motion.step(), highest);
        Used {
            window: joints.clone().map(window).collect(),
            rests: joints.map(rests).collect(),
            spectrum: spectrum.filtered(cutoff.is_some()),
        }
    }

    /// Rows of a series of a joint.
    pub(super) fn rows(&self, joint: usize, x: &[f64]) -> Vec<f64> {
        self.spectrum.masked(&levelled(x, &self.rests[joint]), &self.window[joint])
    }
}

/// A window with the rests that are shorter than a filter's spread: the friction of a motor that turns
/// round is known on both sides, and filtered like the torques.
fn passed(mut window: Vec<f64>, reach: usize, fade: &[f64]) -> Vec<f64> {
    let mut row = 0;
    while row < window.len() {
        let from = row;
        while row < window.len() && window[row] == 0.0 {
            row += 1;
        }
        if row > from && row - from <= reach && from > 0 && row < window.len() {
            window[from..row].copy_from_slice(&fade[from..row]);
        }
        row += 1;
    }
    window
}

/// A series without its mean in each rest: stiction may be anything.
fn levelled(x: &[f64], rests: &[Vec<usize>]) -> Vec<f64> {
    let mut level = x.to_vec();
    for rest in rests {
        let mean = rest.iter().map(|row| x[*row]).sum::<f64>() / rest.len().max(1) as f64;
        for row in rest {
            level[*row] -= mean;
        }
    }
    level
}

/// Rows of each rest.
fn rests(senses: &[f64], closed: bool) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = Vec::new();
    let mut run = Vec::new();
    for (row, sense) in senses.iter().enumerate() {
        if *sense == 0.0 {
            run.push(row);
        } else if !run.is_empty() {
            all.push(std::mem::take(&mut run));
        }
    }
    if !run.is_empty() {
        // The rest at the end of a period goes on at its start.
        match all.first_mut().filter(|first| closed && first.first() == Some(&0)) {
            Some(first) => first.extend(run),
            None => all.push(run),
        }
    }
    all
}

/// Whether all motors whose friction a joint feels turn.
fn senses_known(motion: &Motion<'_>, joint: usize, row: usize) -> bool {
    let coupled = joint == 4 && motion.model.wrist.coupling != 0.0;
    motion.senses[joint][row] != 0.0 && !(coupled && motion.senses[5][row] == 0.0)
}

/// Ends of an open log fade in and out, so that they do not count as jumps.
fn faded(row: usize, motion: &Motion<'_>) -> f64 {
    if motion.closed {
        return 1.0;
    }
    let n = motion.rows();
    let edge = (FADED * n as f64).max(1.0);
    let near = row.min(n - 1 - row) as f64;
    if near >= edge { 1.0 } else { 0.5 - 0.5 * (std::f64::consts::PI * near / edge).cos() }
}

/// A window without the rows within `reach` of those that are left out.
fn narrowed(window: &[f64], reach: usize, closed: bool) -> Vec<f64> {
    let n = window.len();
    let mut narrow = window.to_vec();
    for row in (0..n).filter(|row| window[*row] == 0.0) {
        for k in 1..=reach.min(n) {
            for other in [(row + n - k % n) % n, (row + k) % n] {
                if closed || other.abs_diff(row) <= reach {
                    narrow[other] = 0.0;
                }
            }
        }
    }
    narrow
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rest_goes_on_over_the_end_of_a_period() {
        let senses = [0.0, 1.0, 0.0, 0.0, -1.0, 0.0];
        assert_eq!(rests(&senses, true), vec![vec![0, 5], vec![2, 3]]);
        assert_eq!(rests(&senses, false), vec![vec![0], vec![2, 3], vec![5]]);
    }

    #[test]
    fn rows_beside_a_rest_are_left_out() {
        let window = [1.0, 1.0, 1.0, 0.0, 1.0, 1.0];
        assert_eq!(narrowed(&window, 1, true), vec![1.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    }
}

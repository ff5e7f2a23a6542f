//! The grid for the timing of a run, with nodes at joint reversals and one-sided friction.

use crate::arm::robot::Model;
use crate::retime::motion::sampling::{self, Loaded, SpeedCap};
use crate::retime::motion::timing::grid::{GridError, PathGrid, PathPoint};
use crate::retime::path::joint_path::{DOF, JointPath, Piece};

/// Parts of a piece, each searched for one reversal per joint.
const PARTS: usize = 4;
/// Bisection steps to a reversal.
const BISECTIONS: usize = 40;
/// Joint rate below which its sign is a rounding error, rad per unit of s.
const STILL: f64 = 1e-7;
/// Distance of nodes at rounding level, as a share of the path.
const LEAST_DISTANCE: f64 = 1e-8;
/// Nodes closer to a reversal are moved there; m of the path or share of a short one.
const NODE_DISTANCE: (f64, f64) = (1e-5, 1e-4);

/// Nodes in s: about `count` intervals, denser where speeds change, and the reversals of joints,
/// where Coulomb friction jumps.
pub fn nodes(model: &Model, path: &JointPath, caps: &[SpeedCap], count: usize) -> Vec<f64> {
    let mut nodes = sampling::nodes(model, path, caps, count);
    let apart = NODE_DISTANCE.0.min(NODE_DISTANCE.1 * path.length());
    let nearest = LEAST_DISTANCE * path.length();
    for turn in path.pieces().iter().flat_map(turns) {
        let next = nodes.partition_point(|node| *node < turn);
        if next == 0 || next == nodes.len() {
            continue;
        }
        let last = nodes.len() - 1;
        // Two joints may reverse at the same place.
        if turn - nodes[next - 1] < nearest || nodes[next] - turn < nearest {
            continue;
        }
        match (turn - nodes[next - 1] < apart, nodes[next] - turn < apart) {
            (true, _) if next > 1 => nodes[next - 1] = turn,
            (_, true) if next < last => nodes[next] = turn,
            (false, false) => nodes.insert(next, turn),
            _ => {}
        }
    }
    nodes
}

/// Reversals of joints inside a piece.
fn turns(piece: &Piece) -> Vec<f64> {
    let at = |i: usize| piece.s + piece.length * i as f64 / PARTS as f64;
    let rates: Vec<_> = (0..=PARTS).map(|i| piece.eval(at(i)).q1).collect();
    let mut turns = Vec::new();
    for i in 0..PARTS {
        for j in 0..DOF {
            let (from, to) = (rates[i][j], rates[i + 1][j]);
            if from * to < 0.0 && from.abs().min(to.abs()) > STILL {
                let (mut lo, mut hi) = (at(i), at(i + 1));
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (lo + hi);
                    *(if piece.eval(middle).q1[j] * from > 0.0 { &mut lo } else { &mut hi }) =
                        middle;
                }
                turns.push(0.5 * (lo + hi));
            }
        }
    }
    turns
}

/// The grid at these nodes with the speed caps of the legs. At rest at both ends Coulomb friction
/// is 0, as it has no direction there.
///
/// # Errors
/// Values that are not finite.
pub fn grid(
    loaded: Loaded<'_>,
    path: &JointPath,
    nodes: &[f64],
    caps: &[SpeedCap],
) -> Result<PathGrid, GridError> {
    let grid = sampling::grid(loaded, path, nodes, caps)?;
    let last = grid.intervals() - 1;
    let is_still = |end: &PathPoint| end.q1.iter().any(|rate| rate.abs() < STILL);
    let dry = &loaded.model.friction.coulomb;
    Ok(grid.with_dry_friction(|k, pair| {
        let mut friction = [pair[0].coulomb, pair[1].coulomb];
        if pair.iter().any(is_still) {
            let rate = path.eval(0.5 * (nodes[k] + nodes[k + 1])).q1;
            for (end, friction) in pair.iter().zip(&mut friction) {
                for j in (0..DOF).filter(|j| rate[*j].abs() >= STILL && end.q1[*j].abs() < STILL) {
                    friction[j] = dry[j] * rate[j].signum();
                }
            }
        }
        if k == 0 {
            friction[0] = [0.0; DOF];
        }
        if k == last {
            friction[1] = [0.0; DOF];
        }
        friction
    }))
}

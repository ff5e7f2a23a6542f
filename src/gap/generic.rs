//! Any smooth function of one thing: what wins against all laws is none of them.

use crate::arm::effects::Motion;

use super::column::{Column, Owner, Piece};
use super::record::{Record, RecordKind};

/// Usual size of such a function, of the joint's torque.
const SIZE: f64 = 0.05;

/// What a function depends on.
struct Kind {
    id: &'static str,
    bumps: usize,
    /// The argument, from −1 to 1, and a factor, of a row.
    of: fn(&Motion<'_>, usize, usize, &Extent) -> [f64; 2],
    /// Bumps are closer near 0.
    dense: bool,
}

/// Largest values in a motion.
struct Extent {
    rate: f64,
    acceleration: f64,
    gear: f64,
    middle: f64,
    range: f64,
}

const KINDS: [Kind; 11] = [
    Kind {
        id: "speed",
        bumps: 13,
        of: |m, j, i, e| [m.rates[j][i] / e.rate, m.senses[j][i].abs()],
        dense: true,
    },
    Kind {
        id: "acceleration",
        bumps: 8,
        of: |m, j, i, e| [m.qdd[j][i] / e.acceleration, 1.0],
        dense: false,
    },
    Kind {
        id: "acceleration_and_sense",
        bumps: 8,
        of: |m, j, i, e| [m.qdd[j][i] / e.acceleration, m.senses[j][i]],
        dense: false,
    },
    Kind {
        id: "position",
        bumps: 14,
        of: |m, j, i, e| [(m.q[j][i] - e.middle) / e.range, 1.0],
        dense: false,
    },
    Kind {
        id: "position_and_sense",
        bumps: 14,
        of: |m, j, i, e| [(m.q[j][i] - e.middle) / e.range, m.senses[j][i]],
        dense: false,
    },
    Kind {
        id: "load_and_sense",
        bumps: 8,
        of: |m, j, i, e| [2.0 * m.gear[j][i].abs() / e.gear - 1.0, m.senses[j][i]],
        dense: false,
    },
    Kind { id: "load", bumps: 8, of: |m, j, i, e| [m.gear[j][i] / e.gear, 1.0], dense: false },
    Kind {
        id: "time_and_sense",
        bumps: 20,
        of: |m, j, i, _| [2.0 * i as f64 / m.rows().max(1) as f64 - 1.0, m.senses[j][i]],
        dense: false,
    },
    Kind {
        id: "time",
        bumps: 20,
        of: |m, _, i, _| [2.0 * i as f64 / m.rows().max(1) as f64 - 1.0, 1.0],
        dense: false,
    },
    Kind {
        id: "drift_with_position",
        bumps: 8,
        of: |m, j, i, e| [(m.q[j][i] - e.middle) / e.range, 1.0],
        dense: false,
    },
    Kind {
        id: "drift_with_load",
        bumps: 6,
        of: |m, j, i, e| [m.gear[j][i] / e.gear, 1.0],
        dense: false,
    },
];

/// Functions that change from repetition to repetition.
pub(super) const OF_DRIFT: [&str; 2] = ["drift_with_position", "drift_with_load"];

/// One piece for each thing that torques of a joint may depend on.
#[must_use]
pub(super) fn generic(records: &[Record<'_>], joint: usize) -> Vec<Piece> {
    let now = records.iter().filter(|record| record.kind != RecordKind::Before);
    let extents: Vec<Extent> = now.map(|record| extent(&record.motion, joint)).collect();
    let size = records.first().map_or(0.0, |of| SIZE * of.motion.scale(joint).torque[0]);
    // One function for all motions, so one range for all.
    let largest = |of: fn(&Extent) -> f64| extents.iter().map(of).fold(1e-9, f64::max);
    let low = extents.iter().map(|e| e.middle - e.range).fold(f64::INFINITY, f64::min);
    let high = extents.iter().map(|e| e.middle + e.range).fold(f64::NEG_INFINITY, f64::max);
    let all = Extent {
        rate: largest(|e| e.rate),
        acceleration: largest(|e| e.acceleration),
        gear: largest(|e| e.gear),
        middle: 0.5 * (low + high),
        range: (0.5 * (high - low)).max(1e-9),
    };
    KINDS
        .iter()
        .map(|kind| Piece {
            owner: Owner::Generic(kind.id),
            joint: Some(joint),
            shape: Vec::new(),
            choices: 1,
            columns: (0..kind.bumps)
                .map(|bump| column(kind, records, joint, bump, &all, size))
                .collect(),
        })
        .collect()
}

/// The columns of one of them.
pub(super) fn named(id: &str, records: &[Record<'_>], joint: usize) -> Vec<Column> {
    let piece = generic(records, joint).into_iter().find(|piece| piece.owner.id() == id);
    piece.map_or_else(Vec::new, |piece| piece.columns)
}

fn column(
    kind: &Kind,
    records: &[Record<'_>],
    joint: usize,
    bump: usize,
    extent: &Extent,
    size: f64,
) -> Column {
    let width = 2.0 / (kind.bumps - 1) as f64;
    let centre = -1.0 + width * bump as f64;
    let series = records
        .iter()
        .map(|record| {
            let acts =
                if OF_DRIFT.contains(&kind.id) { RecordKind::Drift } else { RecordKind::Mean };
            if record.kind != acts {
                return Vec::new();
            }
            let motion = &record.motion;
            let of = |row: usize| {
                let [x, factor] = (kind.of)(motion, joint, row, extent);
                // A root makes room where friction changes most.
                let x = if kind.dense { x.signum() * x.abs().sqrt() } else { x };
                size * factor * (-0.5 * ((x - centre) / (0.8 * width)).powi(2)).exp()
            };
            vec![(joint, (0..motion.rows()).map(of).collect())]
        })
        .collect();
    Column { series, mean: 0.0, sd: 1.0 }
}

fn extent(motion: &Motion<'_>, joint: usize) -> Extent {
    let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let q = &motion.q[joint];
    let low = q.iter().copied().fold(f64::INFINITY, f64::min);
    let high = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Extent {
        rate: largest(&motion.rates[joint]),
        acceleration: largest(&motion.qdd[joint]),
        gear: largest(&motion.gear[joint]),
        middle: 0.5 * (low + high),
        range: 0.5 * (high - low),
    }
}

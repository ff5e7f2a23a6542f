//! Where the energy of a run goes: pieces of time with a power each, added up exactly.

use std::f64::consts::TAU;

/// Swing of a movement's power about its mean: speeding up takes more, slowing down less.
const SWING: f64 = 0.8;

/// Whether the robot moves or holds its arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Doing {
    Moves,
    Holds,
}

#[derive(Clone, Debug)]
struct Piece {
    from: f64,
    to: f64,
    energy_j: f64,
    doing: Doing,
    /// Energy of all pieces before.
    before_j: f64,
}

impl Piece {
    fn until(&self, t: f64) -> f64 {
        let u = ((t - self.from) / (self.to - self.from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        self.energy_j
            * match self.doing {
                Doing::Moves => u + SWING / TAU * (1.0 - (TAU * u).cos()),
                Doing::Holds => u,
            }
    }
}

/// Energy over the plant's clock, of which 0 is the start of the run.
#[derive(Clone, Debug)]
pub(super) struct Ledger {
    base_w: f64,
    pieces: Vec<Piece>,
}

impl Ledger {
    /// No pieces, but a power that flows all the time \[W\].
    pub(super) fn new(base_w: f64) -> Ledger {
        Ledger { base_w, pieces: Vec::new() }
    }

    /// Adds what happens after all pieces so far \[s, s, J\].
    pub(super) fn add(&mut self, from: f64, to: f64, energy_j: f64, doing: Doing) {
        let before_j = self.pieces.last().map_or(0.0, |last| last.before_j + last.energy_j);
        self.pieces.push(Piece { from, to, energy_j, doing, before_j });
    }

    /// Energy from the start until a time \[J\].
    pub(super) fn until(&self, t: f64) -> f64 {
        let behind = self.pieces.partition_point(|piece| piece.from <= t);
        let last = behind.checked_sub(1).map(|at| &self.pieces[at]);
        self.base_w * t + last.map_or(0.0, |piece| piece.before_j + piece.until(t))
    }

    /// Energy of the movements between two times in standstill \[J\].
    pub(super) fn motion(&self, from: f64, to: f64) -> f64 {
        let first = self.pieces.partition_point(|piece| piece.from < from);
        let within = self.pieces[first..].iter().take_while(|piece| piece.from < to);
        within.filter(|piece| piece.doing == Doing::Moves).map(|piece| piece.energy_j).sum()
    }
}

//! A joint path q(s) as pieces of quintic polynomials.

use std::ops::Range;

use crate::arm::kinematics::Tcp;

/// Number of joints of a robot in RAPID.
pub const DOF: usize = 6;

/// One number per joint.
pub type Joints = [f64; DOF];

/// Whether no joint is farther apart than `tolerance`, rad.
pub fn are_close(a: &Joints, b: &Joints, tolerance: f64) -> bool {
    (0..DOF).all(|j| (a[j] - b[j]).abs() <= tolerance)
}

/// Coefficients by x/h, lowest first, of the quintic with these values, first and second derivatives
/// by x at 0 and at h.
pub fn quintic(h: f64, from: [f64; 3], to: [f64; 3]) -> [f64; 6] {
    let [[p0, v0, a0], [p1, v1, a1]] = [from, to].map(|[p, v, a]| [p, v * h, a * h * h]);
    let d = p1 - p0;
    [
        p0,
        v0,
        0.5 * a0,
        10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
        -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
        6.0 * d - 3.0 * (v0 + v1) - 0.5 * (a0 - a1),
    ]
}

/// Kind of the curve of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceKind {
    /// Straight in joint space.
    Joint,
    /// On a programmed line or arc.
    Cartesian,
    /// In a corner zone between two Cartesian legs.
    CartesianZone,
    /// In a corner zone that a joint leg touches.
    JointZone,
}

impl PieceKind {
    /// Whether the piece is in a corner zone.
    pub fn is_zone(self) -> bool {
        matches!(self, PieceKind::CartesianZone | PieceKind::JointZone)
    }
}

/// A stretch [s, s + length] of a joint path.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Start in the parameter.
    pub s: f64,
    /// Length in the parameter.
    pub length: f64,
    /// Index of its leg.
    pub leg: usize,
    /// Its kind.
    pub kind: PieceKind,
    /// Coefficients of u = (s − begin)/length, lowest first, per joint.
    coefficients: [[f64; 6]; DOF],
}

/// Values and derivatives by s at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Joint positions, rad.
    pub q: Joints,
    /// dq/ds.
    pub q1: Joints,
    /// d²q/ds².
    pub q2: Joints,
}

impl Piece {
    /// The quintic with these values and derivatives at the ends.
    pub fn hermite(
        (s, length): (f64, f64),
        leg: usize,
        kind: PieceKind,
        a: &PathPoint,
        b: &PathPoint,
    ) -> Piece {
        let at = |point: &PathPoint, j: usize| [point.q[j], point.q1[j], point.q2[j]];
        let coefficients = std::array::from_fn(|j| quintic(length, at(a, j), at(b, j)));
        Piece { s, length, leg, kind, coefficients }
    }

    /// q at s within the piece.
    pub fn position(&self, s: f64) -> Joints {
        let u = (s - self.s) / self.length;
        std::array::from_fn(|j| {
            let [c0, c1, c2, c3, c4, c5] = self.coefficients[j];
            c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
        })
    }

    /// dq/ds at s within the piece.
    pub fn rates(&self, s: f64) -> Joints {
        let u = (s - self.s) / self.length;
        std::array::from_fn(|j| {
            let [_, c1, c2, c3, c4, c5] = self.coefficients[j];
            (c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / self.length
        })
    }

    /// Values at s within the piece.
    pub fn eval(&self, s: f64) -> PathPoint {
        let h = self.length;
        let u = (s - self.s) / h;
        let q2 = self.coefficients.map(|[_, _, c2, c3, c4, c5]| {
            (2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))) / (h * h)
        });
        PathPoint { q: self.position(s), q1: self.rates(s), q2 }
    }
}

/// TCP motion on a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// TCP path length, m.
    pub length: f64,
    /// Rotation angle of the tool, rad.
    pub angle: f64,
    /// Length in the parameter s.
    pub extent: f64,
    /// The TCP, m.
    pub tool: Tcp,
    /// True for an arc with collinear points, which is followed as a line.
    pub flat_arc: bool,
}

/// A joint path over [0, length]: q and q′ are continuous; q″ may jump between pieces.
#[derive(Clone, Debug, Default)]
pub struct JointPath {
    pieces: Vec<Piece>,
    /// Index of the first leg; the legs from it on.
    legs: (usize, Vec<Extent>),
    /// Joint angles at both ends, rad.
    ends: [Joints; 2],
}

impl JointPath {
    /// A path of contiguous pieces and their legs from the index `first` on; `ends` are the joint
    /// angles at both ends without rounding errors of the pieces.
    pub fn new(
        pieces: Vec<Piece>,
        first: usize,
        legs: Vec<Extent>,
        ends: [Joints; 2],
    ) -> JointPath {
        JointPath { pieces, legs: (first, legs), ends }
    }

    /// Joint angles at the start, rad.
    pub fn start(&self) -> Joints {
        self.ends[0]
    }

    /// Joint angles at the end, rad.
    pub fn end(&self) -> Joints {
        self.ends[1]
    }

    /// The extent of a leg of the path.
    pub fn extent(&self, leg: usize) -> Extent {
        self.legs.1[leg - self.legs.0]
    }

    /// The indices of the legs.
    pub fn legs(&self) -> Range<usize> {
        self.legs.0..self.legs.0 + self.legs.1.len()
    }

    /// s at the programmed end of a leg: the middle of the zone.
    pub fn leg_end(&self, leg: usize) -> f64 {
        let after = self.pieces.partition_point(|p| p.leg <= leg);
        self.pieces.get(after).map_or(self.length(), |p| p.s)
    }

    /// The pieces in order.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Length in the parameter.
    pub fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p.s + p.length)
    }

    /// The piece at s; outside the path the nearest one.
    pub fn piece_at(&self, s: f64) -> &Piece {
        let after = self.pieces.partition_point(|p| p.s <= s);
        &self.pieces[after.saturating_sub(1)]
    }

    /// Values at s, clamped to [0, length].
    pub fn eval(&self, s: f64) -> PathPoint {
        let s = s.clamp(0.0, self.length());
        self.piece_at(s).eval(s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hermite_reproduces_a_quintic() {
        let c = [0.3, -1.0, 0.5, 2.0, -0.7, 0.2];
        let poly = |s: f64| {
            let q = c.iter().rev().fold(0.0, |acc, x| acc * s + x);
            let q1 = (1..6).rev().fold(0.0, |acc, i| acc * s + c[i] * i as f64);
            let q2 = (2..6).rev().fold(0.0, |acc, i| acc * s + c[i] * (i * (i - 1)) as f64);
            PathPoint { q: [q; DOF], q1: [q1; DOF], q2: [q2; DOF] }
        };
        let piece = Piece::hermite((0.2, 0.9), 0, PieceKind::Joint, &poly(0.2), &poly(1.1));
        for s in [0.2, 0.5, 0.77, 1.1] {
            let (got, want) = (piece.eval(s), poly(s));
            for (a, b) in [(got.q, want.q), (got.q1, want.q1), (got.q2, want.q2)] {
                assert!((a[3] - b[3]).abs() < 1e-9, "at {s}: {} {}", a[3], b[3]);
            }
        }
    }
}

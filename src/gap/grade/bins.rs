//! What a motion is at an instant, in pieces.

use crate::gap::data::Record;

/// A quantity by which the instants of a joint are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Rate of the joint.
    Speed,
    /// Its position.
    Position,
    /// What the model says of its torque.
    Load,
    /// Time since the motion began.
    Time,
}

/// All of them.
pub(super) const QUANTITIES: [Quantity; 4] =
    [Quantity::Speed, Quantity::Position, Quantity::Load, Quantity::Time];

impl Quantity {
    /// In a word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Speed => "speed",
            Quantity::Position => "position",
            Quantity::Load => "load",
            Quantity::Time => "time",
        }
    }

    /// Its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Speed => "rad/s",
            Quantity::Position => "rad",
            Quantity::Load => "Nm",
            Quantity::Time => "s",
        }
    }

    /// Its value at a row of a record, for a joint.
    #[must_use]
    pub fn at(self, record: &Record<'_>, joint: usize, row: usize) -> f64 {
        let motion = &record.motion;
        match self {
            Quantity::Speed => motion.qd[joint][row],
            Quantity::Position => motion.q[joint][row],
            Quantity::Load => motion.torque[joint][row],
            Quantity::Time => motion.t[row],
        }
    }
}

/// The ends of `count` pieces that hold equally many of `values`; `count` + 1 of them, ascending.
/// Empty without values.
#[must_use]
pub(super) fn ends(mut values: Vec<f64>, count: usize) -> Vec<f64> {
    values.retain(|x| x.is_finite());
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return Vec::new() };
    (0..=count).map(|k| values[last * k / count.max(1)]).collect()
}

/// The piece that `x` lies in, from 0; of a value beyond the ends the nearest one.
#[must_use]
pub(super) fn piece(ends: &[f64], x: f64) -> usize {
    let inner = ends.get(1..ends.len().saturating_sub(1)).unwrap_or_default();
    inner.iter().take_while(|end| x >= **end).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_hold_equally_many_values() {
        let values: Vec<f64> = (0..90).map(|k| f64::from(k * k)).collect();
        let ends = ends(values.clone(), 3);
        let mut counts = [0; 3];
        for x in values {
            counts[piece(&ends, x)] += 1;
        }
        assert!(counts.iter().all(|count| (29..=31).contains(count)), "{counts:?}");
        assert_eq!((piece(&ends, -1.0), piece(&ends, 1e9)), (0, 2));
    }
}

//! Positions, rates and accelerations of a log: as logged, or differentiated.

use super::differentiate::derivatives;
use super::{Channel, Log, Rejected};

/// The motion in a log, a row for each usable one.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Line of the file of each row.
    pub rows: Vec<u64>,
    /// Position of each joint at each time \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Rates \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<Vec<f64>>,
    /// What was not logged, but differentiated.
    pub differentiated: Vec<&'static str>,
    /// Rows that nothing can be differentiated at.
    pub left_out: Vec<Rejected>,
}

impl Log {
    /// The motion: rates and accelerations as they were logged, else from the positions,
    /// accelerations from the rates where those were logged.
    #[must_use]
    pub fn motion(&self) -> Motion {
        let t = self.time();
        let logged = |channel: fn(usize) -> Channel| -> Option<Vec<Vec<f64>>> {
            let columns = self.of_joints(channel)?;
            Some(columns.into_iter().map(<[f64]>::to_vec).collect())
        };
        let q = logged(Channel::Position).unwrap_or_default();
        let (qd, qdd) = (logged(Channel::Velocity), logged(Channel::Acceleration));
        let mut differentiated = Vec::new();
        if qd.is_none() {
            differentiated.push("rates");
        }
        if qdd.is_none() {
            differentiated.push("accelerations");
        }
        let mut usable = vec![true; t.len()];
        let mut taken = |series: &[Vec<f64>]| -> [Vec<Vec<f64>>; 2] {
            let mut orders = [Vec::new(), Vec::new()];
            for x in series {
                let found = derivatives(t, x);
                for (usable, at) in usable.iter_mut().zip(&found) {
                    *usable &= at.is_some();
                }
                for (order, out) in orders.iter_mut().enumerate() {
                    out.push(found.iter().map(|at| at.map_or(0.0, |at| at[order])).collect());
                }
            }
            orders
        };
        let [qd, qdd] = match (qd, qdd) {
            (Some(qd), Some(qdd)) => [qd, qdd],
            (Some(qd), None) => {
                let [first, _] = taken(&qd);
                [qd, first]
            }
            (None, qdd) => {
                let [first, second] = taken(&q);
                [first, qdd.unwrap_or(second)]
            }
        };
        let kept = |x: &[f64]| -> Vec<f64> {
            x.iter().zip(&usable).filter(|(_, usable)| **usable).map(|(x, _)| *x).collect()
        };
        let all = |series: &[Vec<f64>]| series.iter().map(|x| kept(x)).collect();
        let rows = self.rows.iter().zip(&usable);
        Motion {
            time: kept(t),
            q: all(&q),
            qd: all(&qd),
            qdd: all(&qdd),
            differentiated,
            rows: rows.clone().filter(|(_, usable)| **usable).map(|(row, _)| *row).collect(),
            left_out: rows
                .filter(|(_, usable)| !**usable)
                .map(|(row, _)| Rejected {
                    row: *row,
                    reason: "too few rows around it to differentiate".into(),
                })
                .collect(),
        }
    }
}

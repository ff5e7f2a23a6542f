//! Positions, rates and accelerations of a log, logged or differentiated.

use super::channel::Channel;
use super::data::{Log, Rejected};
use super::differentiate::derivatives;

/// The motion in a log, one entry for each usable row.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Line in the file of each row.
    pub rows: Vec<u64>,
    /// Position of each joint at each time \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Rates \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<Vec<f64>>,
    /// Description of the differentiated quantities.
    pub differentiated: Vec<String>,
    /// Rows without derivatives.
    pub left_out: Vec<Rejected>,
}

impl Log {
    /// The motion with logged rates and accelerations, joint by joint. Missing rates come from the
    /// positions, missing accelerations from logged rates or else from the positions.
    #[must_use]
    pub fn motion(&self) -> Motion {
        let t = self.time();
        let joints = self.joints();
        let mut usable = vec![true; t.len()];
        let mut taken = |x: &[f64]| -> [Vec<f64>; 2] {
            let found = derivatives(t, x);
            for (usable, at) in usable.iter_mut().zip(&found) {
                *usable &= at.is_some();
            }
            std::array::from_fn(|order| {
                found.iter().map(|at| at.map_or(0.0, |at| at[order])).collect()
            })
        };
        let [mut q, mut qd, mut qdd]: [Vec<Vec<f64>>; 3] = Default::default();
        for joint in 0..joints {
            let logged = |channel| self.column(channel).map(<[f64]>::to_vec);
            let position = logged(Channel::Position(joint)).unwrap_or_default();
            let rate = logged(Channel::Velocity(joint));
            let acceleration = logged(Channel::Acceleration(joint));
            let (rate, acceleration) = match (rate, acceleration) {
                (Some(rate), Some(acceleration)) => (rate, acceleration),
                (Some(rate), None) => {
                    let [first, _] = taken(&rate);
                    (rate, first)
                }
                (None, acceleration) => {
                    let [first, second] = taken(&position);
                    (first, acceleration.unwrap_or(second))
                }
            };
            q.push(position);
            qd.push(rate);
            qdd.push(acceleration);
        }
        let mut differentiated = Vec::new();
        self.missing("rates", Channel::Velocity, &mut differentiated);
        self.missing("accelerations", Channel::Acceleration, &mut differentiated);
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

    /// Adds a description of the joints without this quantity.
    fn missing(&self, what: &str, channel: fn(usize) -> Channel, out: &mut Vec<String>) {
        let joints = self.joints();
        let lacks: Vec<String> = (0..joints)
            .filter(|joint| self.column(channel(*joint)).is_none())
            .map(|joint| (joint + 1).to_string())
            .collect();
        if lacks.len() == joints {
            out.push(what.to_owned());
        } else if !lacks.is_empty() {
            out.push(format!("{what} of joints {}", lacks.join(", ")));
        }
    }
}

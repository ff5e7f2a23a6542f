//! The columns of effects as rows of the joints that they reach.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::basis::{functions, rms};
use super::form::form_of;
use super::joint::rows_of;
use super::Design;
use crate::arm::dynamics::RIGID;
use crate::arm::effects::{self, Effect, Form, Motion, Scope};
use crate::gap::column::{Column, Piece, columns_at, pieces};
use crate::gap::record::{Record, RecordKind};
use crate::gap::tunables::Tunables;

/// Rows of one effect at one joint, for one choice of its shape.
#[derive(Clone)]
pub struct PieceRows {
    /// The effect.
    pub effect: &'static Effect,
    /// Joint, from 0; `None` of the robot.
    pub joint: Option<usize>,
    /// Values of all coordinates: the usual size for linear ones.
    pub shape: Vec<f64>,
    /// Number of shapes that are tried at the joint.
    pub choices: usize,
    /// Number of its own columns; behind them are those of the effects that it brings along.
    pub own: usize,
    /// Expected factor of each column, and its standard deviation.
    pub prior: Vec<(f64, f64)>,
    /// Joints that it reaches, with their rows.
    pub rows: Vec<(usize, DMatrix<f64>)>,
    /// The clock of its window, if it has one.
    pub clock: Clock,
}

/// The time by which a window comes again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// That of the logs' columns `t`.
    Absolute,
    /// Each log begins at 0.
    Log,
}

/// An effect that acts all the time, to be cut to windows.
pub struct Whole {
    effect: &'static Effect,
    joint: Option<usize>,
    shape: Vec<f64>,
    columns: Vec<Column>,
}

impl Whole {
    /// The effect at a joint; its last coordinates are start, end and period of the window.
    #[must_use]
    pub fn new(records: &[Record<'_>], effect: &'static Effect, joint: usize) -> Option<Whole> {
        let scale = records.first()?.motion.scale(joint);
        let mut shape: Vec<f64> = effect.coordinates.iter().map(|c| (c.usual)(&scale)).collect();
        let n = shape.len();
        shape[n - 3..].copy_from_slice(&[-LONG, LONG, 0.0]);
        let columns = columns_at(effect, records, joint, &shape);
        let joint = (effect.scope == Scope::Joint).then_some(joint);
        Some(Whole { effect, joint, shape, columns })
    }

    /// The effect within a window \[s\].
    #[must_use]
    pub fn within(
        &self,
        records: &[Record<'_>],
        [start, end]: [f64; 2],
        period: f64,
        clock: Clock,
        choices: usize,
    ) -> PieceRows {
        let mut shape = self.shape.clone();
        let n = shape.len();
        shape[n - 3..].copy_from_slice(&[start, end, period]);
        let cut = |(record, series): (&Record<'_>, &Vec<(usize, Vec<f64>)>)| {
            let of = |(joint, series): &(usize, Vec<f64>)| {
                let pairs = series.iter().zip(&record.motion.t);
                let begins = record.times.first().map_or(0.0, |(begins, _)| *begins);
                let offset = if clock == Clock::Absolute { begins } else { 0.0 };
                let acts = |t: f64| {
                    let t = t + offset;
                    let t = if period > 0.0 { t.rem_euclid(period) } else { t };
                    (start..=end).contains(&t) || (period > 0.0 && (start..=end).contains(&(t + period)))
                };
                (*joint, pairs.map(|(x, t)| if acts(*t) { *x } else { 0.0 }).collect())
            };
            series.iter().map(of).collect()
        };
        let columns = self
            .columns
            .iter()
            .map(|column| Column {
                series: records.iter().zip(&column.series).map(cut).collect(),
                mean: column.mean,
                sd: column.sd,
            })
            .collect();
        let owner = crate::gap::column::Owner::Effect(self.effect);
        let piece = Piece { owner, joint: self.joint, shape, choices, columns };
        PieceRows { clock, ..to_rows(records, self.effect, piece) }
    }
}

/// Longer than any log \[s\].
const LONG: f64 = 1e9;

/// All pieces of the effects that may be found.
pub type Pieces = Vec<PieceRows>;

/// The pieces of the effects on their first grids of shapes.
#[must_use]
pub fn piece_rows(records: &[Record<'_>], wanted: &[&'static Effect]) -> Pieces {
    let n = records.first().map_or(0, |record| record.motion.model.dof);
    let all: Vec<(&'static Effect, usize)> = wanted
        .iter()
        .filter(|e| e.channel == effects::Channel::Torque && !matches!(e.form, Form::Elsewhere))
        .flat_map(|effect| {
            let joints = (effect.joints)(n);
            let count = if effect.scope == Scope::Robot { 1 } else { joints.len() };
            joints.into_iter().take(count).map(|joint| (*effect, joint))
        })
        // Parameters have their columns already.
        .filter(|(e, _)| e.id != "link_parameters")
        .collect();
    all.into_par_iter()
        .flat_map_iter(|(effect, joint)| {
            let pieces = pieces(effect, records, joint);
            let with = |piece| with_brought(records, effect, piece);
            pieces.into_iter().map(with).collect::<Vec<_>>()
        })
        .collect()
}

/// Pieces of the parameters of each link.
#[must_use]
pub fn link_pieces(records: &[Record<'_>], design: &Design, effect: &'static Effect) -> Pieces {
    let n = design.joints.len();
    let heights: Vec<(bool, usize)> = records
        .iter()
        .map(|record| (record.kind == RecordKind::Mean, record.spectrum.rows()))
        .collect();
    // What the last link has more is what it carries.
    (0..n.saturating_sub(1))
        .map(|link| {
            let rows = design.joints.iter().filter_map(|joint| {
                let columns = joint.base.columns(RIGID * link, RIGID);
                let mut rows = columns * design.tunables.link_change;
                let mut from = 0;
                for (is_mean, count) in &heights {
                    if !is_mean {
                        rows.rows_mut(from, *count).fill(0.0);
                    }
                    from += count;
                }
                (rows.norm() > 0.0).then_some((joint.joint, rows))
            });
            PieceRows {
                effect,
                joint: Some(link),
                shape: vec![1.0; RIGID],
                choices: 1,
                own: RIGID,
                prior: vec![(0.0, 1.0); RIGID],
                rows: rows.collect(),
                clock: Clock::Log,
            }
        })
        .collect()
}

impl PieceRows {
    /// The same effect with other values of its shape.
    #[must_use]
    pub fn reshaped(&self, records: &[Record<'_>], shape: &[f64]) -> PieceRows {
        let columns = columns_at(self.effect, records, self.joint.unwrap_or(0), shape);
        let owner = crate::gap::column::Owner::Effect(self.effect);
        let piece = Piece {
            owner,
            joint: self.joint,
            shape: shape.to_vec(),
            choices: self.choices,
            columns,
        };
        with_brought(records, self.effect, piece)
    }

    /// Functions of the coordinate of its form, of unit size: by joint, with their rows.
    #[must_use]
    pub fn forms(
        &self,
        records: &[Record<'_>],
        tunables: &Tunables,
    ) -> Vec<(usize, DMatrix<f64>)> {
        let Some(coordinate) = form_of(self.effect.id) else { return Vec::new() };
        let motions: Vec<&Motion<'_>> = records.iter().map(|record| &record.motion).collect();
        let height = records.iter().map(|record| record.spectrum.rows()).sum();
        let of_joint = |joint: usize| {
            let all = functions(coordinate, &motions, joint, tunables);
            let mut rows = DMatrix::zeros(height, all.len());
            for (k, series) in all.iter().enumerate() {
                let of = |(series, record): (&Vec<f64>, &Record<'_>)| -> Vec<f64> {
                    if record.kind == RecordKind::Mean { series.clone() } else { Vec::new() }
                };
                let series: Vec<Vec<f64>> = series.iter().zip(records).map(of).collect();
                let series: Vec<&[f64]> = series.iter().map(Vec::as_slice).collect();
                rows_of(records, joint, &series, rows.column_mut(k).as_mut_slice());
            }
            (joint, rows)
        };
        let own = |joint: &usize| self.joint.is_none_or(|own| own == *joint);
        self.rows.iter().map(|(joint, _)| *joint).filter(own).map(of_joint).collect()
    }

    /// Root mean square of a column's rows at a joint.
    #[must_use]
    pub fn size(&self, joint: usize, column: usize) -> f64 {
        let of = self.rows.iter().find(|(of, _)| *of == joint);
        of.map_or(0.0, |(_, rows)| rms(rows.column(column).iter()))
    }
}

/// Rows of a piece with the columns of the effects that it brings along.
fn with_brought(records: &[Record<'_>], effect: &'static Effect, mut piece: Piece) -> PieceRows {
    let own = piece.columns.len();
    for id in effect.brings {
        let (Some(brought), Some(joint)) = (effects::find(id), piece.joint) else { continue };
        if let Some(first) = pieces(brought, records, joint).into_iter().next() {
            piece.columns.extend(first.columns);
        }
    }
    PieceRows { own, ..to_rows(records, effect, piece) }
}

fn to_rows(records: &[Record<'_>], effect: &'static Effect, piece: Piece) -> PieceRows {
    let n = records.first().map_or(0, |record| record.motion.model.dof);
    let height: usize = records.iter().map(|record| record.spectrum.rows()).sum();
    let mut rows = Vec::new();
    for joint in 0..n {
        let of_joint = |series: &Vec<(usize, Vec<f64>)>| {
            series.iter().any(|(of, x)| *of == joint && x.iter().any(|x| *x != 0.0))
        };
        if !piece.columns.iter().any(|column| column.series.iter().any(of_joint)) {
            continue;
        }
        let mut of = DMatrix::zeros(height, piece.columns.len());
        for (k, column) in piece.columns.iter().enumerate() {
            let series: Vec<&[f64]> = column
                .series
                .iter()
                .map(|record| {
                    let found = record.iter().find(|(of, _)| *of == joint);
                    found.map_or(&[][..], |(_, series)| series.as_slice())
                })
                .collect();
            rows_of(records, joint, &series, of.column_mut(k).as_mut_slice());
        }
        rows.push((joint, of));
    }
    PieceRows {
        effect,
        joint: piece.joint,
        shape: piece.shape,
        choices: piece.choices,
        own: piece.columns.len(),
        prior: piece.columns.iter().map(|column| (column.mean, column.sd)).collect(),
        rows,
        clock: Clock::Log,
    }
}

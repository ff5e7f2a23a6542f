//! The columns of effects as rows of the joints that they reach.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::brought::{Brought, BroughtEffect};
use super::column::{Column, Piece, columns_at, pieces};
use super::problem::Design;
use super::set::Set;
use crate::arm::dynamics::RIGID;
use crate::arm::effects::{self, Coordinate, Effect, Form, Nature, Role, Scope};
use crate::arm::robot::Model;
use crate::gap::data::Record;

/// Deviation of a factor that is known.
const FIXED: f64 = 1e-6;

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
    /// The effects that it brings along.
    pub(in crate::gap) brought: Vec<BroughtEffect>,
    /// Whether it acts in the baseline, too: the robot has it, and it is no change.
    pub(in crate::gap) in_baseline: bool,
}

/// An effect that acts all the time, to be cut to windows.
pub(in crate::gap) struct Whole {
    effect: &'static Effect,
    joint: Option<usize>,
    shape: Vec<f64>,
    columns: Vec<Column>,
}

impl Whole {
    /// The effect at a joint; its last coordinates are start, end and period of the window.
    #[must_use]
    pub(in crate::gap) fn new(
        records: &[Record<'_>],
        effect: &'static Effect,
        joint: usize,
    ) -> Option<Whole> {
        let scale = records.first()?.motion.scale(joint);
        let mut shape: Vec<f64> = effect.coordinates.iter().map(|c| (c.usual)(&scale)).collect();
        let n = shape.len();
        shape[n - 3..].copy_from_slice(&[-LONG, LONG, 0.0]);
        let columns = columns_at(effect, records, joint, &shape, true);
        let joint = (effect.scope == Scope::Joint).then_some(joint);
        Some(Whole { effect, joint, shape, columns })
    }

    /// The shape of a window \[s\].
    #[must_use]
    pub(in crate::gap) fn shape(&self, window: [f64; 2], times: &Times) -> Vec<f64> {
        let mut shape = self.shape.clone();
        let n = shape.len();
        shape[n - 3..].copy_from_slice(&[window[0], window[1], times.period]);
        shape
    }

    /// How the effect grows in its window, where it may.
    #[must_use]
    pub(in crate::gap) fn rise(&self) -> Option<Rise> {
        let mut of = self.effect.coordinates.iter().enumerate();
        of.find_map(|(coordinate, of)| match of.role {
            Role::Rise { most, share } => Some(Rise { coordinate, most, share }),
            _ => None,
        })
    }

    /// The effect within the window of a shape.
    #[must_use]
    pub(in crate::gap) fn within(
        &self,
        design: &Design,
        records: &[Record<'_>],
        shape: Vec<f64>,
        times: &Times,
    ) -> PieceRows {
        let n = shape.len();
        let (start, end) = (shape[n - 3], shape[n - 2]);
        let acting = |t: f64| {
            let in_window =
                |t: f64| (start..=end).contains(&t).then_some((t - start) / (end - start));
            let x = in_window(t)
                .or_else(|| if times.period > 0.0 { in_window(t + times.period) } else { None });
            let Some(x) = x else { return 0.0 };
            let share = |(k, of): (usize, &Coordinate)| match of.role {
                Role::Rise { share, .. } => share(shape[k], x),
                _ => 1.0,
            };
            self.effect.coordinates.iter().enumerate().map(share).product()
        };
        let columns = self.columns.iter().map(|column| cut(column, records, times, &acting));
        let columns = columns.collect();
        self.piece(design, records, columns, shape, times)
    }

    /// The columns of the effect in each of `count` parts of a time \[s\], one after another.
    #[must_use]
    pub(in crate::gap) fn parts(
        &self,
        design: &Design,
        records: &[Record<'_>],
        (part, count): (f64, usize),
        times: &Times,
    ) -> PieceRows {
        let of_part = |k: usize| {
            let acting =
                move |t: f64| f64::from(u8::from(((t - times.begins) / part) as usize == k));
            self.columns.iter().map(move |column| cut(column, records, times, &acting))
        };
        let columns = (0..count).flat_map(of_part).collect();
        let shape = self.shape([times.begins, times.begins + part * count as f64], times);
        self.piece(design, records, columns, shape, times)
    }

    fn piece(
        &self,
        design: &Design,
        records: &[Record<'_>],
        columns: Vec<Column>,
        shape: Vec<f64>,
        times: &Times,
    ) -> PieceRows {
        let piece = Piece { joint: self.joint, shape, choices: times.choices, columns };
        to_rows(design, records, self.effect, piece)
    }
}

/// How an effect grows in its window.
pub(in crate::gap) struct Rise {
    /// The place of its coordinate.
    pub coordinate: usize,
    /// The largest value.
    pub most: f64,
    /// The share that acts, from the value and the part of the window that is over.
    pub share: fn(f64, f64) -> f64,
}

/// How windows come again.
#[derive(Clone, Copy)]
pub(in crate::gap) struct Times {
    /// When the first one may begin \[s\].
    pub begins: f64,
    /// Time after which they do \[s\]; 0: never.
    pub period: f64,
    /// Number of windows that are tried.
    pub choices: usize,
}

/// A column, as far as an effect acts at a time.
fn cut(
    column: &Column,
    records: &[Record<'_>],
    times: &Times,
    acting: &dyn Fn(f64) -> f64,
) -> Column {
    let of_record = |(record, series): (&Record<'_>, &Vec<(usize, Vec<f64>)>)| {
        let at = |t: &f64| {
            if times.period > 0.0 { t.rem_euclid(times.period) } else { *t }
        };
        let shares: Vec<f64> = record.motion.t.iter().map(|t| acting(at(t))).collect();
        let of = |(joint, series): &(usize, Vec<f64>)| {
            (*joint, series.iter().zip(&shares).map(|(x, share)| x * share).collect())
        };
        series.iter().map(of).collect()
    };
    Column {
        series: records.iter().zip(&column.series).map(of_record).collect(),
        mean: column.mean,
        sd: column.sd,
    }
}

/// Longer than any log \[s\].
const LONG: f64 = 1e9;

/// All pieces of the effects that may be found.
pub(in crate::gap) type Pieces = Vec<PieceRows>;

/// The pieces of the effects on their first grids of shapes.
#[must_use]
pub(in crate::gap) fn piece_rows(
    design: &Design,
    records: &[Record<'_>],
    wanted: &[&'static Effect],
) -> Pieces {
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
        .filter(|(e, _)| e.nature != Nature::Parameters)
        .collect();
    all.into_par_iter()
        .flat_map_iter(|(effect, joint)| {
            let own = pieces(effect, records, joint).into_iter();
            let own: Vec<_> = own.map(|of| to_rows(design, records, effect, of)).collect();
            let brought = brought_rows(design, records, effect, (joint, &reached(&own)));
            own.into_iter().map(|of| of.with_brought(&brought)).collect::<Vec<_>>()
        })
        .collect()
}

/// A piece in other records, with what it brings along there.
pub(in crate::gap) fn piece_at(
    design: &Design,
    records: &[Record<'_>],
    of: &PieceRows,
) -> PieceRows {
    let joint = of.joint.unwrap_or(0);
    let columns = columns_at(of.effect, records, joint, &of.shape, true);
    let piece = Piece { joint: of.joint, shape: of.shape.clone(), choices: of.choices, columns };
    let own = to_rows(design, records, of.effect, piece);
    let reached = reached(std::slice::from_ref(&own));
    let brought = brought_rows(design, records, of.effect, (joint, &reached));
    PieceRows { in_baseline: of.in_baseline, ..own.with_brought(&brought) }
}

/// Joints that pieces reach.
fn reached(pieces: &[PieceRows]) -> Vec<usize> {
    let mut all: Vec<usize> =
        pieces.iter().flat_map(|of| of.rows.iter().map(|(joint, _)| *joint)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Pieces of the parameters of each link.
#[must_use]
pub(in crate::gap) fn link_pieces(design: &Design, effect: &'static Effect) -> Pieces {
    let n = design.joints.len();
    // What the last link has more is what it carries.
    (0..n.saturating_sub(1))
        .map(|link| {
            let of_link = design.parameters.of_link(link).transpose();
            let rows = design.joints.iter().filter_map(|joint| {
                let columns = joint.base.columns(0, design.parameters.of_model());
                let mut rows = columns * &of_link * design.tunables.link_change;
                for cell in joint.cells.iter().filter(|cell| cell.set != Set::Now) {
                    rows.rows_mut(cell.rows.start, cell.rows.len()).fill(0.0);
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
                brought: Vec::new(),
                in_baseline: false,
            }
        })
        .collect()
}

impl PieceRows {
    /// An effect at a joint, of so many shapes, without rows.
    #[must_use]
    pub(in crate::gap) fn of_shape(
        effect: &'static Effect,
        joint: usize,
        shape: Vec<f64>,
        choices: usize,
    ) -> PieceRows {
        PieceRows {
            effect,
            joint: Some(joint),
            shape,
            choices,
            own: 0,
            prior: Vec::new(),
            rows: Vec::new(),
            brought: Vec::new(),
            in_baseline: false,
        }
    }

    /// The same effect of a robot that has it in the baseline, too; its rows are of records as they are
    /// now.
    #[must_use]
    pub(in crate::gap) fn of_baseline(self) -> PieceRows {
        PieceRows { in_baseline: true, ..self }
    }

    /// The same effect with other values of its shape; tangents tell how it changes with them.
    #[must_use]
    pub fn reshaped(
        &self,
        design: &Design,
        records: &[Record<'_>],
        shape: &[f64],
        with_tangents: bool,
    ) -> PieceRows {
        let joint = self.joint.unwrap_or(0);
        let columns = columns_at(self.effect, records, joint, shape, with_tangents);
        let piece =
            Piece { joint: self.joint, shape: shape.to_vec(), choices: self.choices, columns };
        let rows = to_rows(design, records, self.effect, piece).with_brought(&self.brought());
        PieceRows { in_baseline: self.in_baseline, ..rows }
    }

    /// What it adds with some factors to one record, as a column.
    #[must_use]
    pub(in crate::gap) fn in_record(
        &self,
        design: &Design,
        record: usize,
        factors: &DVector<f64>,
    ) -> PieceRows {
        let column = |(joint, rows): &(usize, DMatrix<f64>)| {
            let mut column = rows * factors;
            let cells = design.joints[*joint].cells.iter();
            for cell in cells.filter(|cell| cell.record != record) {
                column.rows_mut(cell.rows.start, cell.rows.len()).fill(0.0);
            }
            (*joint, DMatrix::from_columns(&[column]))
        };
        PieceRows {
            own: 1,
            prior: vec![(0.0, 1.0)],
            rows: self.rows.iter().map(column).collect(),
            brought: Vec::new(),
            ..self.clone().without_rows()
        }
    }

    /// The piece at its shape alone.
    #[must_use]
    pub(in crate::gap) fn without_tangents(mut self) -> PieceRows {
        let shapes = self.effect.coordinates.iter();
        let width = 1 + shapes.filter(|of| matches!(of.role, Role::Shape(_))).count();
        let tangents = self.prior[..self.own].iter_mut().enumerate().filter(|(k, _)| k % width > 0);
        tangents.for_each(|(_, prior)| prior.1 = FIXED);
        self
    }

    /// The piece with these values of its coordinates, all of which are linear.
    pub(in crate::gap) fn hold(&mut self, coordinates: &[f64]) {
        for ((prior, value), usual) in self.prior.iter_mut().zip(coordinates).zip(&self.shape) {
            *prior = (value / usual, FIXED);
        }
    }

    /// What it brings along within what can be: factors that are beyond that are at the bound. Whether
    /// one was.
    pub(in crate::gap) fn bound(&mut self, factors: &[f64], model: &Model) -> bool {
        let mut is_beyond = false;
        let least = self.brought.iter().flat_map(|of| of.least(model));
        for (k, least) in (self.own..).zip(least) {
            if factors[k] < least - FIXED {
                self.prior[k] = (least, FIXED);
                is_beyond = true;
            }
        }
        is_beyond
    }

    /// The columns that it brings along.
    fn brought(&self) -> Brought {
        let count = self.prior.len() - self.own;
        let rows = |(joint, rows): &(usize, DMatrix<f64>)| {
            (*joint, rows.columns(self.own, count).into_owned())
        };
        Brought {
            prior: self.prior[self.own..].to_vec(),
            rows: self.rows.iter().map(rows).collect(),
            effects: self.brought.clone(),
        }
    }

    /// The piece with columns behind its own.
    fn with_brought(mut self, brought: &Brought) -> PieceRows {
        for (joint, rows) in &brought.rows {
            let height = rows.nrows();
            let own = self.rows.iter().position(|(of, _)| of == joint).unwrap_or_else(|| {
                self.rows.push((*joint, DMatrix::zeros(height, self.own)));
                self.rows.len() - 1
            });
            let mut all = DMatrix::zeros(height, self.own + rows.ncols());
            all.columns_mut(0, self.own).copy_from(&self.rows[own].1);
            all.columns_mut(self.own, rows.ncols()).copy_from(rows);
            self.rows[own].1 = all;
        }
        let more = brought.prior.len();
        for (_, rows) in self.rows.iter_mut().filter(|(_, rows)| rows.ncols() < self.own + more) {
            *rows = std::mem::take(rows).resize_horizontally(self.own + more, 0.0);
        }
        self.prior.extend(&brought.prior);
        self.brought.clone_from(&brought.effects);
        self
    }

    /// Whether its shape acts by itself: it has no amplitude.
    #[must_use]
    pub(in crate::gap) fn is_fixed(&self) -> bool {
        self.prior.iter().any(|(mean, _)| *mean != 0.0)
    }
}

/// The columns of the effects that an effect brings along.
fn brought_rows(
    design: &Design,
    records: &[Record<'_>],
    effect: &'static Effect,
    (joint, reached): (usize, &[usize]),
) -> Brought {
    let mut all = Brought::default();
    // What acts on a motor by another joint brings along what is at that one.
    let joints = match effect.scope {
        Scope::Joint => vec![joint],
        Scope::Robot => reached.iter().copied().filter(|of| *of != joint).collect(),
    };
    let brought = effect.brings.iter().filter_map(|id| effects::find(id));
    for (brought, joint) in brought.flat_map(|of| joints.iter().map(move |joint| (of, *joint))) {
        let Some(first) = pieces(brought, records, joint).into_iter().next() else { continue };
        let of = to_rows(design, records, brought, first);
        let before = all.prior.len();
        all.prior.extend(of.prior);
        all.effects.extend(BroughtEffect::new(brought, joint, of.shape, records));
        for (at, rows) in of.rows {
            match all.rows.iter_mut().find(|(known, _)| *known == at) {
                Some((_, known)) => {
                    let count = known.ncols();
                    let mut both = DMatrix::zeros(rows.nrows(), count + rows.ncols());
                    both.columns_mut(0, count).copy_from(known);
                    both.columns_mut(count, rows.ncols()).copy_from(&rows);
                    *known = both;
                }
                None => all.rows.push((at, rows.insert_columns(0, before, 0.0))),
            }
        }
    }
    all
}

fn to_rows(
    design: &Design,
    records: &[Record<'_>],
    effect: &'static Effect,
    piece: Piece,
) -> PieceRows {
    let mut rows = Vec::new();
    for (joint, of_design) in design.joints.iter().enumerate() {
        let of_joint = |series: &Vec<(usize, Vec<f64>)>| {
            series.iter().any(|(of, x)| *of == joint && x.iter().any(|x| *x != 0.0))
        };
        if !piece.columns.iter().any(|column| column.series.iter().any(of_joint)) {
            continue;
        }
        let mut of = DMatrix::zeros(of_design.y.len(), piece.columns.len());
        for (k, column) in piece.columns.iter().enumerate() {
            let series: Vec<&[f64]> = column
                .series
                .iter()
                .map(|record| {
                    let found = record.iter().find(|(of, _)| *of == joint);
                    found.map_or(&[][..], |(_, series)| series.as_slice())
                })
                .collect();
            of_design.rows_of(records, &series, of.column_mut(k).as_mut_slice());
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
        brought: Vec::new(),
        in_baseline: false,
    }
}

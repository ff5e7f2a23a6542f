//! Points of the unit cube that are tried, and what became of each.

use rayon::prelude::*;

use super::candidate::{Placed, Ways};
use super::limits::Room;
use super::placement::{Placement, Refusals};
use crate::arm::kinematics::radical_inverse;
use crate::retime::motion::unreached;
use crate::tool::lint::process::{Kept, same_process};
use crate::tool::retrofit::{Simulated, read_program};

/// Bases of the sequences by axis (J. H. Halton, 1960); more axes than these are not searched.
pub(super) const BASES: [u32; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
/// Rounding of a time, s.
const TIME_TOLERANCE: f64 = 1e-6;

/// A point, and what is known of it.
pub(super) struct Tried {
    pub(super) point: Vec<f64>,
    /// Energy and duration of its cycle, J and s, where it could be simulated.
    pub(super) figures: Option<[f64; 2]>,
    /// What it is, unless it was refused.
    pub(super) accepted: Option<Placement>,
}

/// Point `n` of the unit cube, from 1.
pub(super) fn even(n: u32, dimension: usize) -> Vec<f64> {
    BASES[..dimension].iter().map(|base| radical_inverse(n, *base)).collect()
}

/// What a candidate is compared with.
pub(super) struct Today {
    pub(super) placement: Placement,
    pub(super) cycle: Simulated,
    /// Movements out of reach today.
    unreached: usize,
}

impl Ways<'_> {
    /// The program as it is.
    pub(super) fn look(&self) -> Option<Today> {
        let placed = self.today();
        let cycle = self.cell.simulated().ok()?;
        let unreached = self.unreached(&placed)?;
        let placement = placement(Vec::new(), placed, &cycle);
        Some(Today { placement, cycle, unreached })
    }

    /// The points whose targets are in reach, and the others.
    pub(super) fn in_reach(
        &self,
        points: Vec<Vec<f64>>,
        today: &Today,
        tick: &(dyn Fn() + Sync),
    ) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        points.into_par_iter().partition(|point| {
            tick();
            let unreached = self.placed(point).ok().and_then(|placed| self.unreached(&placed));
            unreached.is_some_and(|count| count <= today.unreached)
        })
    }

    /// Simulates the whole cycle at points, and judges it.
    pub(super) fn simulated(
        &self,
        points: Vec<Vec<f64>>,
        today: &Today,
        refusals: &mut Refusals,
        tick: &(dyn Fn() + Sync),
    ) -> Vec<Tried> {
        let one = |point: Vec<f64>| {
            tick();
            let mut refused = Refusals::default();
            let tried = self.judged(point, today, &mut refused);
            (tried, refused)
        };
        let (tried, all): (Vec<Tried>, Vec<Refusals>) = points.into_par_iter().map(one).unzip();
        for of in &all {
            refusals.add(of);
        }
        tried
    }

    /// The program at a point, and its cycle.
    pub(super) fn cycle_at(&self, point: &[f64]) -> Option<(Placed, Simulated)> {
        let placed = self.placed(point).ok()?;
        let cycle = placed.cell(self.cell).simulated().ok()?;
        Some((placed, cycle))
    }

    fn unreached(&self, placed: &Placed) -> Option<usize> {
        let cell = placed.cell(self.cell);
        let (program, entry) = read_program(cell.files, cell.entry).ok()?;
        Some(unreached(&program, entry, cell.model, cell.options))
    }

    fn judged(&self, point: Vec<f64>, today: &Today, refused: &mut Refusals) -> Tried {
        let is_sound = |(_, cycle): &(Placed, Simulated)| {
            same_process(self.cell.model, &today.cycle.simulation, &cycle.simulation, Kept::Order)
        };
        let Some((placed, cycle)) = self.cycle_at(&point).filter(is_sound) else {
            refused.reach += 1;
            return Tried { point, figures: None, accepted: None };
        };
        let placement = placement(point.clone(), placed, &cycle);
        let figures = Some([placement.energy.energy_j(), placement.cycle_s]);
        let was = &today.placement;
        let accepted = if !placement.room.is_regular(&was.room) {
            refused.singular += 1;
            None
        } else if !placement.room.is_clear(&was.room) {
            refused.keep_out += 1;
            None
        } else if placement.cycle_s > was.cycle_s + TIME_TOLERANCE {
            refused.slower += 1;
            None
        } else {
            Some(placement)
        };
        Tried { point, figures, accepted }
    }
}

fn placement(point: Vec<f64>, placed: Placed, cycle: &Simulated) -> Placement {
    Placement {
        point,
        room: Room::of(&placed.model, &cycle.simulation, &placed.obstacles),
        shifts: placed.shifts,
        cycle_s: cycle.simulation.cycle_s,
        energy: cycle.account.total,
    }
}

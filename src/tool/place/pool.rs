//! Points of the unit cube that are tried, and what became of each.

use rayon::prelude::*;

use super::candidate::Ways;
use super::limits::Room;
use super::placement::{Placement, Refusals};
use crate::arm::kinematics::radical_inverse;
use crate::arm::robot::Model;
use crate::retime::motion::unreached;
use crate::tool::retrofit::Simulated;

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
    /// Movements that cannot be simulated today either.
    unreached: usize,
    problems: usize,
}

impl Ways<'_> {
    /// The program as it is.
    pub(super) fn look(&self) -> Option<(Today, Simulated)> {
        let placed = self.today();
        let (read, entry) = placed.read(self.program.entry).ok()?;
        let unreached = unreached(&read, entry, &placed.model, self.program.options);
        let cycle = Simulated::new(&read, entry, &placed.model, self.program.options);
        let room = Room::of(&placed.model, &cycle.simulation, &placed.obstacles);
        let placement = Placement {
            point: Vec::new(),
            shifts: placed.shifts,
            cycle_s: cycle.simulation.cycle_s,
            energy: cycle.account.total,
            room,
        };
        let problems = cycle.problems();
        Some((Today { placement, unreached, problems }, cycle))
    }

    /// The points whose targets are in reach, and the others.
    pub(super) fn in_reach(
        &self,
        points: Vec<Vec<f64>>,
        today: &Today,
        tick: &(dyn Fn() + Sync),
    ) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let is_reached = |point: &Vec<f64>| {
            tick();
            let Ok(placed) = self.placed(point) else { return false };
            let Ok((read, entry)) = placed.read(self.program.entry) else { return false };
            unreached(&read, entry, &placed.model, self.program.options) <= today.unreached
        };
        points.into_par_iter().partition(is_reached)
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

    /// The cycle at a point.
    pub(super) fn cycle_at(&self, point: &[f64]) -> Option<(Model, Simulated, Room)> {
        let placed = self.placed(point).ok()?;
        let (read, entry) = placed.read(self.program.entry).ok()?;
        let cycle = Simulated::new(&read, entry, &placed.model, self.program.options);
        let room = Room::of(&placed.model, &cycle.simulation, &placed.obstacles);
        Some((placed.model, cycle, room))
    }

    fn judged(&self, point: Vec<f64>, today: &Today, refused: &mut Refusals) -> Tried {
        let nothing = |point: Vec<f64>| Tried { point, figures: None, accepted: None };
        let Some((_, cycle, room)) = self.cycle_at(&point) else {
            refused.reach += 1;
            return nothing(point);
        };
        if cycle.problems() > today.problems {
            refused.reach += 1;
            return nothing(point);
        }
        let cycle_s = cycle.simulation.cycle_s;
        let figures = Some([cycle.account.total.energy_j(), cycle_s]);
        let was = &today.placement;
        if !room.is_regular(&was.room) {
            refused.singular += 1;
        } else if !room.is_clear(&was.room) {
            refused.keep_out += 1;
        } else if cycle_s > was.cycle_s + TIME_TOLERANCE {
            refused.slower += 1;
        } else {
            let shifts = self.placed(&point).map(|placed| placed.shifts).unwrap_or_default();
            let accepted = Placement {
                point: point.clone(),
                shifts,
                cycle_s,
                energy: cycle.account.total,
                room,
            };
            return Tried { point, figures, accepted: Some(accepted) };
        }
        Tried { point, figures, accepted: None }
    }
}

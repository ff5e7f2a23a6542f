//! Margins of an attempt at a stream to the limits.

use super::check::Check;

/// Margin to acceleration and torque limits at first: what a stream between nodes needs.
const FIRST_MARGIN: f64 = 0.98;
/// Margin to speed ceilings where they were exceeded.
const SPEED_MARGIN: f64 = 0.995;
/// Reach of lower ceilings at first, m: half of a [`LONGEST_STEP`](super::run_plant::LONGEST_STEP).
const FIRST_REACH: f64 = 0.002;
/// Placing of the points at first, share of the tolerance of the path.
const FIRST_SPACING: f64 = 0.1;
/// Share of the allowed distance from the path that the polishing may use at first.
pub(super) const FIRST_DISTANCE: f64 = 0.95;

/// Clearance to keep-out zones at first, m: a motion is sampled in steps.
const FIRST_ROOM: f64 = 0.005;
/// Factor on the tolerance of the points' placing.
const CLOSER: f64 = 0.7;
/// Factor on the correction of an excess.
const FURTHER: f64 = 1.002;

/// Margins and tolerances of one attempt.
#[derive(Clone)]
pub(super) struct Margins {
    /// Share of acceleration and torque limits that the intended motion may use.
    pub(super) load: f64,
    /// Share of the speed ceilings.
    pub(super) speed: f64,
    /// Distance before and behind a lower ceiling from which it holds, m: a stream is shaped at
    /// places some way apart.
    pub(super) reach: f64,
    /// Tolerance of the points' placing, m.
    pub(super) spacing: f64,
    /// Distance of the points' polygon from the path that their placing expects, m.
    pub(super) polygon: f64,
    /// Share of the allowed distance of that polygon that the polishing may use; infinite until a check
    /// finds the polygon too far away.
    pub(super) edges: f64,
    /// Share of the allowed distance from the path that the polishing may use.
    pub(super) distance: f64,
    /// Clearance that the polishing keeps to keep-out zones, m.
    pub(super) room: f64,
}

impl Margins {
    /// Where the path has this tolerance, m.
    pub(super) fn first(tolerance: f64) -> Margins {
        Margins {
            load: FIRST_MARGIN,
            speed: 1.0,
            reach: FIRST_REACH,
            spacing: FIRST_SPACING * tolerance,
            polygon: tolerance,
            edges: f64::INFINITY,
            distance: FIRST_DISTANCE,
            room: FIRST_ROOM,
        }
    }

    /// Share of the torque limits. There is no margin at first: where the limit is the largest torque of
    /// the program, holding the arm may need all of it.
    pub(super) fn torque(&self) -> f64 {
        (self.load / FIRST_MARGIN).min(1.0)
    }

    /// Lower loads, where no stream was found.
    pub(super) fn lighten(&mut self) {
        self.load *= FIRST_MARGIN;
    }

    /// The limits themselves.
    pub(super) fn none() -> Margins {
        Margins {
            load: 1.0,
            speed: 1.0,
            reach: 0.0,
            spacing: 0.0,
            polygon: 0.0,
            edges: f64::INFINITY,
            distance: 1.0,
            room: 0.0,
        }
    }

    /// The largest share of the limits that apply.
    pub(super) fn worst(&self, check: &Check) -> f64 {
        let polygon = if self.edges.is_infinite() { 0.0 } else { check.polygon };
        Check { polygon, ..*check }.worst()
    }

    /// Tighter margins for a new attempt.
    pub(super) fn tighten(&mut self, check: &Check) {
        let load = check.torque.max(check.acceleration);
        if load > 1.0 {
            self.load *= FIRST_MARGIN / load;
        }
        if check.velocity > 1.0 {
            self.speed *= SPEED_MARGIN / check.velocity;
        }
        if check.tcp_speed > 1.0 {
            self.reach *= 2.0;
        }
        self.room += check.intrusion_m.max(0.0);
        if check.deviation > 1.0 {
            self.distance *= FIRST_DISTANCE / check.deviation.min(2.0);
        }
        // Distant points cause ripples of speed and path.
        if check.tcp_speed > 1.0 || check.deviation > 1.0 {
            self.spacing *= CLOSER;
        }
        if check.polygon > 1.0 {
            self.polygon /= check.polygon;
            self.edges = FIRST_DISTANCE;
        }
    }

    /// Tighter margins for more polishing of a stream that nearly holds.
    pub(super) fn tighten_a_little(&mut self, check: &Check) {
        // A share slightly above 1 would hardly change the margin.
        let over = |share: f64| if share > 1.0 { share * FURTHER } else { 1.0 };
        self.room += check.intrusion_m.max(0.0);
        self.load /= over(check.torque);
        self.speed /= over(check.tcp_speed);
        self.distance /= over(check.deviation);
        if check.polygon > 1.0 {
            self.edges = FIRST_DISTANCE.min(self.edges / over(check.polygon));
        }
    }
}

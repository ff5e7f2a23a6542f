//! Margins to the limits in one attempt at a stream.

use super::check::Check;

/// Initial share of acceleration and torque limits; a stream deviates between nodes.
const FIRST_MARGIN: f64 = 0.98;
/// Share of the speed ceilings after they were exceeded.
const SPEED_MARGIN: f64 = 0.995;
/// Initial reach of lower ceilings, m: half of a [`LONGEST_STEP`](super::run_plant::LONGEST_STEP).
const FIRST_REACH: f64 = 0.002;
/// Initial tolerances of the spacing of points, as shares of the path tolerance. Few points permit a
/// larger change of acceleration at each, many follow the path more closely; neither is always
/// better.
pub(super) const SPACINGS: [f64; 2] = [0.1, 0.01];
/// Initial share of the allowed distance from the path in polishing.
const FIRST_DISTANCE: f64 = 0.95;

/// Initial clearance to keep-out zones, m; a motion is sampled in steps.
const FIRST_ROOM: f64 = 0.005;
/// Factor that tightens the spacing tolerance.
const CLOSER: f64 = 0.7;
/// Factor that enlarges the correction of an excess.
const FURTHER: f64 = 1.002;

/// Margins and tolerances of one attempt.
#[derive(Clone)]
pub(super) struct Margins {
    /// Share of acceleration and torque limits for the reference motion.
    pub(super) load: f64,
    /// Share of the speed ceilings.
    pub(super) speed: f64,
    /// Distance by which a lower ceiling is extended to both sides, m: a stream is sampled at
    /// discrete places.
    pub(super) reach: f64,
    /// Tolerance of the spacing of points, m.
    pub(super) spacing: f64,
    /// Distance of the polygon from the path that the spacing of points permits, m.
    pub(super) polygon: f64,
    /// Share of the allowed distance of that polygon in polishing.
    pub(super) edges: f64,
    /// Share of the allowed distance from the path in polishing.
    pub(super) distance: f64,
    /// Clearance to keep-out zones in polishing, m.
    pub(super) room: f64,
}

impl Margins {
    /// The initial margins for a path tolerance (m), and the tolerance of the spacing as a share of it.
    pub(super) fn first(tolerance: f64, spacing: f64) -> Margins {
        Margins {
            load: FIRST_MARGIN,
            speed: 1.0,
            reach: FIRST_REACH,
            spacing: spacing * tolerance,
            polygon: tolerance,
            edges: FIRST_DISTANCE,
            distance: FIRST_DISTANCE,
            room: FIRST_ROOM,
        }
    }

    /// Share of the torque limits; initially 1: the limit may be the largest torque of the program,
    /// and this may be the holding torque.
    pub(super) fn torque(&self) -> f64 {
        (self.load / FIRST_MARGIN).min(1.0)
    }

    /// Lowers the loads after no stream was found.
    pub(super) fn lighten(&mut self) {
        self.load *= FIRST_MARGIN;
    }

    /// Another spacing, after a stream that is far from allowed: what it exceeds says nothing about the
    /// margins.
    pub(super) fn closer(&mut self) {
        self.spacing *= CLOSER;
    }

    /// No margins.
    pub(super) fn none() -> Margins {
        Margins { load: 1.0, reach: 0.0, distance: 1.0, room: 0.0, ..Margins::first(0.0, 0.0) }
    }

    /// Tightens the margins for a new attempt.
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
        // A wide spacing causes ripples of speed and path.
        if check.tcp_speed > 1.0 || check.deviation > 1.0 {
            self.spacing *= CLOSER;
        }
        if check.polygon > 1.0 {
            self.polygon *= FIRST_DISTANCE / check.polygon;
            self.edges = FIRST_DISTANCE;
        }
    }

    /// Tightens the margins for further polishing of a stream with a small excess.
    pub(super) fn tighten_a_little(&mut self, check: &Check) {
        // A share slightly above 1 alone would hardly change the margin.
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

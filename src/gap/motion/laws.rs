//! How each law changes the movements of a program.

use crate::arm::effects::Timing;

use super::changes::Movement;
use super::expected::{Expected, Mode};
use super::features::Feature::{Corner, Duration, End, Rest, Shift, Speed, Start};

/// A law with its parameter: a time \[s\], the logarithm of a factor, or a factor less 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Law {
    pub timing: Timing,
    /// The place of a wait among the movements.
    pub at: Option<usize>,
    pub value: f64,
    /// How probable it is that it changes a movement \[1\].
    pub reach: f64,
}

/// How probable the usual form of a law is, another one and a rare one \[1\].
const USUAL: f64 = 0.5;
const OTHER: f64 = 0.3;
const RARE: f64 = 0.2;
/// The same of two forms of which neither is more usual.
const EITHER: f64 = 0.5;
/// How exactly a law says what it says \[1\]: controllers have other forms of it.
const FORM: f64 = 0.03;
/// The same of the distance from a corner, which is not measured from a target.
const CORNER_FORM: f64 = 0.2;
/// The time that a robot needs to stop and to start again \[s\].
const STOP: f64 = 0.3;
/// Time of the slow ends of a movement \[s\].
const ENDS: f64 = 0.1;
/// How far a corner may move where the logarithm of a speed changes: by this power of the speed, as
/// blending may go by the time and by its square, and by some mrad \[rad\].
const TURNED: f64 = 4.0;
const DRIFT: f64 = 0.002;
/// Time constants after which a servo has come to rest.
const SETTLED: f64 = 6.0;
/// The time of a ramp \[s\]: a filter of that time takes its speed away.
const RAMP: f64 = 0.15;
/// What a filter of second order gains of what it takes \[1\].
const OVERSHOOT: f64 = 0.25;
/// Share of the way of a movement without a plateau on which its speed is near its highest, at most
/// \[1\]: that between two corners of a movement of fifth order.
const PEAK: f64 = 0.75;
/// Share of a change of speed that a smoothed ramp may show \[1\].
const ROUNDED: f64 = 0.15;
/// Logarithm of a speed by which other corners change a short movement at most \[1\].
const CORNERED: f64 = 0.5;
/// Shares of a change of a duration by which the two halves of a movement may differ: from rest to
/// rest, and beside a corner \[1\].
const ALIKE: f64 = 0.02;
const UNLIKE: f64 = 0.2;

impl Law {
    /// How it may change movement `k` of some.
    pub(super) fn modes(&self, movements: &[Movement], k: usize) -> Vec<Mode> {
        let movement = &movements[k];
        match self.timing {
            Timing::Lag => self.lag(movement),
            Timing::Wait => self.wait(movements, k),
            Timing::Acceleration => self.acceleration(movement),
            Timing::Speed => self.speed(movement),
            Timing::Blending => self.blending(movement),
        }
    }

    /// The factor or time that is published, and how its deviation follows from that of the value.
    pub(super) fn published(&self) -> (f64, f64) {
        match self.timing {
            Timing::Lag | Timing::Wait => (self.value, 1.0),
            Timing::Acceleration | Timing::Speed => (self.value.exp(), self.value.exp()),
            Timing::Blending => (1.0 + self.value, 1.0),
        }
    }

    /// All movements are later by the same time. A filter also rounds ramps and corners.
    fn lag(&self, movement: &Movement) -> Vec<Mode> {
        let lag = self.value;
        let late = Mode::unchanged(USUAL).with(Shift, Expected::exactly(lag, FORM));
        let speed = movement.before.mean(Speed).map_or(0.0, f64::exp);
        let slower = Expected::between(-lag / RAMP, OVERSHOOT * lag / RAMP);
        let filtered = late
            .with(Rest, Expected::between(-SETTLED * lag, lag))
            .with(Start, slower)
            .with(End, slower)
            .with(Corner, Expected::between(-OVERSHOOT * speed * lag, speed * lag));
        vec![late, filtered.weighing(OTHER), filtered.weighing(RARE).with(Speed, slower)]
    }

    /// One movement ends later. Where none of the baseline ended the robot may also have to stop.
    fn wait(&self, movements: &[Movement], k: usize) -> Vec<Mode> {
        let Some(at) = self.at else { return vec![Mode::unchanged(1.0)] };
        let (wait, movement) = (self.value, &movements[k]);
        let was_fly_by = !movements[at].stops();
        if at == k {
            let later = Mode::unchanged(1.0).with(Shift, Expected::exactly(-0.5 * wait, FORM));
            let waited = Expected::exactly(wait, FORM);
            if !was_fly_by {
                return vec![later.with(Duration, waited).with(Rest, waited)];
            }
            let cut = movement.before.mean(Corner).unwrap_or(0.0);
            let stopped = later.with(Rest, Expected::between(wait - ENDS, wait + ENDS));
            vec![
                stopped.weighing(EITHER).with(Duration, waited),
                stopped
                    .weighing(EITHER)
                    .with(Duration, Expected::between(wait, wait + STOP))
                    .with(Shift, Expected::between(-0.5 * wait, -0.5 * (wait + STOP)))
                    .with(Corner, Expected::within(cut)),
            ]
        } else if was_fly_by && movements[at].landmarks.next == Some(movement.landmarks.number) {
            let started = Mode::unchanged(EITHER);
            let stop = Expected::within(STOP);
            vec![started, started.with(Duration, stop).with(Shift, stop)]
        } else {
            vec![Mode::unchanged(1.0)]
        }
    }

    /// Ramps rise with the square root of the acceleration over the way; what has no plateau is
    /// slower in all, what a limit does not hold stays.
    fn acceleration(&self, movement: &Movement) -> Vec<Mode> {
        let scale = 0.5 * self.value;
        let longer = movement.moving() * ((-scale).exp() - 1.0);
        let slower = Expected::exactly(scale, FORM);
        let partly = Expected::between(scale, 0.0);
        let timed = stretched(movement, longer, scale);
        let ramps = [
            timed.weighing(USUAL).with(Start, slower).with(End, slower),
            timed.weighing(OTHER).with(Start, partly).with(End, partly),
            timed.weighing(EITHER * RARE).with(Start, slower),
            timed.weighing(EITHER * RARE).with(End, slower),
        ];
        if movement.landmarks.plateau > PEAK {
            return self.drifting(&ramps, movement, scale);
        }
        let modes = ramps.iter().flat_map(|ramp| {
            [
                ramp.weighing(USUAL * ramp.weight),
                ramp.weighing(RARE * ramp.weight).with(Speed, partly),
            ]
        });
        let modes = modes.chain(scaled(movement, scale)).collect::<Vec<Mode>>();
        self.drifting(&modes, movement, scale)
    }

    /// Plateaus are lower, ramps stay up to them; what has none is slower in all, what does not
    /// reach a limit stays.
    fn speed(&self, movement: &Movement) -> Vec<Mode> {
        let scale = self.value;
        let longer = movement.moving() * ((-scale).exp() - 1.0);
        let slower = Expected::exactly(scale, FORM);
        // The place of a ramp where it had half of the speed is on the plateau of less than that.
        let beyond = if scale < 0.0 { (scale + 2_f64.ln()).min(0.0) } else { 0.0 };
        let rounded = ROUNDED * scale.abs();
        let same = Expected::between(beyond - rounded, rounded);
        let capped = stretched(movement, longer, scale).with(Start, same).with(End, same);
        let [whole, part] = scaled(movement, scale);
        let modes = [
            capped.weighing(USUAL).with(Speed, slower),
            capped.weighing(RARE).with(Speed, Expected::between(scale, 0.0)),
            whole,
            part,
        ];
        self.drifting(&modes, movement, scale)
    }

    /// Corners are cut more or less between targets that are no stop points; the rest of the motion
    /// stays.
    fn blending(&self, movement: &Movement) -> Vec<Mode> {
        let larger = self.value;
        let cut = larger * movement.before.mean(Corner).unwrap_or(0.0);
        let shorter = -larger.signum() * STOP;
        let (from, to) = (!movement.starts(), !movement.stops());
        if !from && !to {
            return vec![Mode::unchanged(1.0)];
        }
        let timed = Mode::unchanged(1.0)
            .with(Duration, Expected::between(0.0, shorter))
            .with(Shift, Expected::within(0.5 * STOP));
        let turned = if to { timed.with(Rest, Expected::within(ENDS)) } else { timed };
        let near = Expected::between(0.0, cut);
        let modes = [
            turned.weighing(USUAL).with(Corner, Expected::exactly(cut, CORNER_FORM)),
            turned.weighing(OTHER).with(Corner, near),
            turned.weighing(RARE).with(Corner, near).with(Speed, Expected::within(CORNERED)),
        ];
        self.reaching(&modes)
    }

    /// These ways of a change, and none.
    fn reaching(&self, modes: &[Mode]) -> Vec<Mode> {
        let whole: f64 = modes.iter().map(|mode| mode.weight).sum();
        let share = |mode: &Mode| mode.weighing(self.reach * mode.weight / whole);
        let unchanged = Mode::unchanged(1.0 - self.reach);
        modes.iter().map(share).chain([unchanged]).collect()
    }

    /// The same of a change of speed, where corners stay as they were or move a little.
    fn drifting(&self, modes: &[Mode], movement: &Movement, scale: f64) -> Vec<Mode> {
        let cut = movement.before.mean(Corner).unwrap_or(0.0);
        let corner = Expected::within(DRIFT + cut * (1.0 - (-TURNED * scale.abs()).exp()));
        let both = modes.iter().flat_map(|mode| [*mode, mode.with(Corner, corner)]);
        self.reaching(&both.collect::<Vec<Mode>>())
    }
}

/// A movement that takes up to some time longer, as the logarithm of a speed falls by `scale`.
fn stretched(movement: &Movement, longer: f64, scale: f64) -> Mode {
    let ends = ENDS * ((-scale).exp() - 1.0);
    let shifted = if movement.starts() && movement.stops() { ALIKE } else { UNLIKE };
    Mode::unchanged(1.0)
        .with(Duration, Expected::between(0.0, longer))
        .with(Shift, Expected::within(shifted * longer))
        .with(Rest, Expected::between(-ends, ends))
}

/// A movement that takes its time in all of it, to the end or as far as its own speed says.
fn scaled(movement: &Movement, scale: f64) -> [Mode; 2] {
    let own = movement.change(Speed).map_or(scale, |change| change.value);
    let of = |change: f64, speed: Expected| {
        let longer = movement.moving() * ((-change).exp() - 1.0);
        let alike = Expected::exactly(change, FORM);
        stretched(movement, longer, change)
            .weighing(EITHER * OTHER)
            .with(Speed, speed)
            .with(Start, alike)
            .with(End, alike)
            .with(Duration, Expected::exactly(longer, FORM))
    };
    let part = own.clamp(scale.min(0.0), scale.max(0.0));
    [of(scale, Expected::exactly(scale, FORM)), of(part, Expected::between(scale, 0.0))]
}

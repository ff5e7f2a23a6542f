//! What torques go through on their way into a log.

use crate::arm::effects::Response;
use crate::learn::log::vertex;

use super::chosen::Found;
use super::late::{Kind, Late};
use super::search::Search;

/// Delays that are tried at first \[s\].
const DELAYS: [f64; 18] = [
    -0.006, -0.0045, -0.003, -0.0015, 0.0015, 0.003, 0.0045, 0.006, 0.0075, 0.009, 0.0105, 0.012,
    0.0135, 0.015, 0.0165, 0.018, 0.0195, 0.021,
];
/// Lags that are tried at first \[s\].
const LAGS: [f64; 11] =
    [0.001, 0.002, 0.003, 0.0045, 0.006, 0.008, 0.01, 0.013, 0.016, 0.02, 0.025];
/// Least value \[s\], first steps of a search for the best one, of itself, and the least step \[s\].
const LEAST: f64 = 1e-3;
const COARSE: f64 = 0.3;
const FINE: f64 = 0.1;
const STEP: f64 = 1e-6;
/// Rounds of such a search at most, and how far a parabola reaches beyond its points, in steps.
const ROUNDS: usize = 8;
const REACH: f64 = 2.0;
/// Deviations that the best value may still move, and of steps that tell a deviation.
const NEAR: f64 = 0.1;
const WIDE: f64 = 2.0;
/// Deviations by which a value has to move to be another one.
const STAYS: f64 = 0.3;
/// How far behind another kind may be before its best value is looked for.
const CLOSE: f64 = 50.0;
/// What a delay or a lag has to bring before all else is looked at.
const WORTH: f64 = 15.0;
/// The same in a log that does not tell its noise.
const OPEN: f64 = 30.0;
/// What naming one costs, and one joint of it.
const COST: f64 = 6.0;
const JOINT: f64 = 2.0;

impl Search<'_, '_> {
    /// The most probable error, behind the most probable delay or lag of all or of one joint, if
    /// there is one.
    pub fn choose_channel(&mut self, errors: &[f64], may: &dyn Fn(&str) -> bool) {
        let plain = self.choose_error(errors);
        let kinds: Vec<Kind> = [Kind::Delay, Kind::Lag]
            .into_iter()
            .filter(|kind| may(Late { kind: *kind, ..Late::none() }.id()))
            .collect();
        let dof = self.dof();
        let error = self.error;
        // With a large error of the model nothing would be late.
        self.error = errors.get(1).copied().unwrap_or(error);
        let mut best: Option<Late> = None;
        let none = self.total(Late::none(), &[]);
        for (kind, joint, value) in self.suspected(&kinds) {
            let step = COARSE * value.abs().max(LEAST);
            let from = Late { kind, joint, value, ..Late::none() };
            let (late, total) = self.tuned(from, &[], step);
            let cost = if joint.is_some() { JOINT } else { 0.0 };
            let nats = total - none - cost;
            if nats > best.map_or(WORTH, |best| best.nats) {
                best = Some(Late { nats, ..late });
            }
        }
        let Some(late) = best else {
            self.error = error;
            self.set_channels(&vec![Response::default(); dof]);
            return;
        };
        self.set_channels(&late.channels(dof));
        let behind = self.choose_error(errors);
        let clear = !self.is_open() || behind > plain + OPEN && late.is_longer(self.step());
        if behind > plain + COST && clear {
            self.late = Some(Late { nats: behind - plain - COST, ..late });
        } else {
            self.error = error;
            self.set_channels(&vec![Response::default(); dof]);
        }
    }

    /// The best set of effects, with what is late or without it: what one joint seems to be late by may
    /// be what moves it besides.
    pub fn run_late_or_not(&mut self, errors: &[f64]) -> Found {
        let behind = self.run();
        let Some(late) = self.late.filter(|late| late.joint.is_some()) else { return behind };
        let (total, error) = (self.evidence.null + behind.score, self.error);
        self.late = None;
        self.set_channels(&vec![Response::default(); self.dof()]);
        self.choose_error(errors);
        self.match_excess(&[]);
        let plain = self.run();
        if self.evidence.null + plain.score > total - COST - JOINT {
            return plain;
        }
        self.late = Some(late);
        self.error = error;
        self.set_channels(&late.channels(self.dof()));
        self.match_excess(&[]);
        self.run()
    }

    /// Interval of the rows \[s\].
    fn step(&self) -> f64 {
        self.records.first().map_or(0.0, |record| record.motion.step())
    }

    /// The best delay and lag of all joints and of each one that looks late, as the joints by
    /// themselves show them.
    fn suspected(&mut self, kinds: &[Kind]) -> Vec<(Kind, Option<usize>, f64)> {
        let dof = self.dof();
        let mut suspected = Vec::new();
        for kind in kinds {
            let tried: &[f64] = match kind {
                Kind::Delay => &DELAYS,
                Kind::Lag => &LAGS,
            };
            let mut gains = vec![vec![0.0; dof]; tried.len()];
            for joint in 0..dof {
                let mut null = |value: f64| {
                    let late = Late { kind: *kind, joint: Some(joint), value, ..Late::none() };
                    let channels = late.channels(dof);
                    self.table.of_joint(self.records, joint, &channels, self.error).null
                };
                let none = null(0.0);
                for (value, gains) in tried.iter().zip(&mut gains) {
                    gains[joint] = null(*value) - none;
                }
                null(0.0);
            }
            let all = |gains: &Vec<f64>| gains.iter().sum::<f64>();
            let best = |of: &dyn Fn(&Vec<f64>) -> f64| {
                let gains = gains.iter().zip(tried).map(|(gains, value)| (of(gains), *value));
                gains.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(gain, _)| *gain > WORTH)
            };
            suspected.extend(best(&all).map(|(_, value)| (*kind, None, value)));
            for joint in 0..dof {
                let own = best(&|gains: &Vec<f64>| gains[joint]);
                suspected.extend(own.map(|(_, value)| (*kind, Some(joint), value)));
            }
        }
        suspected
    }

    /// The delay or lag that was found, tuned once more with some columns there.
    pub(super) fn tune(&mut self, columns: &[usize]) {
        let Some(late) = self.late else { return };
        let own = if late.sd.is_finite() { late.sd } else { FINE * late.value.abs() };
        let (mut best, most) = self.tuned(late, columns, own.max(STEP));
        let other = match late.kind {
            Kind::Delay => Kind::Lag,
            Kind::Lag => Kind::Delay,
        };
        let value = late.value.abs().max(LEAST);
        let other = Late { kind: other, value, ..late };
        // Another kind takes the place where it may come close.
        if self.total(other, columns) > most - CLOSE {
            let (tuned, total) = self.tuned(other, columns, FINE * value);
            best = if total > most { tuned } else { best };
        }
        if best.kind == late.kind && (best.value - late.value).abs() <= STAYS * best.sd {
            self.late = Some(Late { sd: best.sd, ..late });
            self.table.through(self.records, &self.channels, columns);
            return;
        }
        self.late = Some(best);
        self.set_channels(&best.channels(self.dof()));
    }

    /// How probable the measurement is with what is late, and some columns.
    fn total(&mut self, late: Late, columns: &[usize]) -> f64 {
        self.table.through(self.records, &late.channels(self.dof()), columns);
        let evidence = self.table.evidence_of(self.error, columns);
        let all: Vec<usize> = (0..columns.len()).collect();
        evidence.null + evidence.gain(&all)
    }

    /// The best value of a kind with some columns there, from one near it and `step` beside it on, and
    /// how probable the measurement is with it.
    fn tuned(&mut self, from: Late, columns: &[usize], mut step: f64) -> (Late, f64) {
        let mut total = |value: f64| {
            let is_possible = from.kind == Kind::Delay || value > 0.0;
            if is_possible {
                self.total(Late { value, ..from }, columns)
            } else {
                f64::NEG_INFINITY
            }
        };
        let (mut value, mut most, mut sd) = (from.value, total(from.value), f64::INFINITY);
        for _ in 0..ROUNDS {
            let [low, high] = [value - step, value + step].map(&mut total);
            let before = value;
            let around = [-low, -most, -high];
            let curvature = 2.0 * most - low - high;
            if low.max(high) > most {
                let beside = if low > high { value - step } else { value + step };
                (value, most) = (beside, low.max(high));
            }
            if let Some(place) = vertex(around).filter(|_| curvature > 0.0 && curvature.is_finite())
            {
                sd = step / curvature.sqrt();
                let top = before + step * place.clamp(-REACH, REACH);
                if (top - before).abs() > NEAR * sd {
                    let at_top = total(top);
                    if at_top > most {
                        (value, most) = (top, at_top);
                    }
                }
                if (value - before).abs() <= NEAR * sd && step <= WIDE * sd {
                    break;
                }
                step = step.min(sd).max(STEP);
            } else if value == before {
                step *= 0.5;
            }
        }
        (Late { value, sd, ..from }, most)
    }
}

//! Everyday errors: what every robot has beside its model. They are nuisances, not findings.

use super::basis::{Functions, Range, functions, rms, roughness};
use crate::arm::effects::{Motion, Response, Variable};
use crate::gap::data::{Record, RecordKind};
use crate::gap::tunables::Tunables;

/// A group of everyday errors with one common size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// A smooth function of one variable of the joint; its size is a share of the torque.
    Smooth(Variable),
    /// Smooth functions of the joint's own and another joint's position.
    OtherPosition,
    /// What friction, as a smooth function, has more than in the baseline: it differs from day to
    /// day.
    Day(Variable),
    /// Friction that differs between logs; its size is a share of the friction.
    LogFriction,
    /// What needs no size of its own: one standard deviation is known.
    Fixed,
    /// The form of a law that deviates from the library's; its size is a share of the law.
    Form(usize),
}

/// Half waves over the position of another joint, and over the joint's own with them.
const OTHER: usize = 3;
const OWN: usize = 2;

/// Root mean square of the model's friction at a joint \[Nm\].
fn friction(m: &Motion<'_>, joint: usize) -> f64 {
    let scale = m.scale(joint);
    let at = |(sense, rate): (&f64, &f64)| scale.coulomb * sense + scale.viscous * rate;
    let all: Vec<f64> = m.senses[joint].iter().zip(&m.rates[joint]).map(at).collect();
    rms(all.iter())
}

/// Variables of smooth everyday errors.
pub(in crate::gap) const SMOOTH: [Variable; 6] = [
    Variable::Reversal,
    Variable::Speed,
    Variable::Position,
    Variable::PositionSense,
    Variable::Load,
    Variable::LoadSense,
];

/// Variables of friction that differs from day to day.
const DAYS: [Variable; 4] =
    [Variable::Reversal, Variable::Speed, Variable::PositionSense, Variable::LoadSense];

/// A column of a joint: its group, and its torques by record \[Nm\].
pub(super) struct Local {
    pub(super) group: Group,
    pub(super) series: Vec<Vec<f64>>,
    /// Of the mean friction of a log, the number of its record.
    pub(super) friction_of: Option<usize>,
}

/// All everyday errors of a joint.
pub(super) fn everyday(records: &[Record<'_>], joint: usize, tunables: &Tunables) -> Vec<Local> {
    let motions: Vec<&Motion<'_>> = records.iter().map(|record| &record.motion).collect();
    let torque = rms(motions.iter().flat_map(|m| &m.torque[joint])).max(1e-9);
    let is_mean: Vec<bool> = records.iter().map(|of| of.kind != RecordKind::Drift).collect();
    let friction = motions.iter().map(|m| friction(m, joint)).fold(0.0, f64::max);
    let unit = |variable: Variable| match variable {
        Variable::Position | Variable::Load => torque,
        Variable::Reversal => motions.first().map_or(torque, |m| m.scale(joint).coulomb),
        _ => torque.hypot(tunables.of_friction * friction),
    };
    let mut all = Vec::new();
    let push = |all: &mut Vec<Local>, group: Group, size: f64, series: Vec<Vec<f64>>| {
        let series = series.into_iter().zip(&is_mean).map(|(series, is_mean)| {
            if *is_mean { series.into_iter().map(|x| size * x).collect() } else { Vec::new() }
        });
        all.push(Local { group, series: series.collect(), friction_of: None });
    };
    for variable in SMOOTH {
        for series in functions(variable, &motions, joint, tunables) {
            push(&mut all, Group::Smooth(variable), unit(variable), series);
        }
    }
    if records.iter().any(|record| record.kind == RecordKind::Before) {
        for variable in DAYS {
            for series in functions(variable, &motions, joint, tunables) {
                let series = series.into_iter().zip(records).map(|(series, record)| {
                    if record.kind == RecordKind::Mean { series } else { vec![0.0; series.len()] }
                });
                push(&mut all, Group::Day(variable), unit(variable), series.collect());
            }
        }
    }
    for series in of_other_positions(&motions, joint, tunables) {
        push(&mut all, Group::OtherPosition, torque, series);
    }
    push(&mut all, Group::Fixed, 1.0, lagged(&motions, joint, tunables.joint_lag));
    all.extend(of_logs(records, joint, tunables));
    all
}

/// Smooth functions of another joint's position, times those of the own.
fn of_other_positions(motions: &[&Motion<'_>], joint: usize, tunables: &Tunables) -> Functions {
    let dof = motions.first().map_or(0, |m| m.model.dof);
    let range = |joint: usize| Range::of(motions.iter().flat_map(|m| &m.q[joint]));
    let own = range(joint);
    let mut all = Vec::new();
    for other in (0..dof).filter(|other| *other != joint) {
        let theirs = range(other);
        for (a, b) in (1..=OTHER).flat_map(|a| (0..OWN).map(move |b| (a, b))) {
            let size = roughness((a as f64).hypot(b as f64), tunables);
            let of = |m: &&Motion<'_>| -> Vec<f64> {
                let at = |row: usize| {
                    size * theirs.wave(m.q[other][row], a) * own.wave(m.q[joint][row], b)
                };
                (0..m.rows()).map(at).collect()
            };
            all.push(motions.iter().map(of).collect());
        }
    }
    all
}

/// What the everyday lag changes.
fn lagged(motions: &[&Motion<'_>], joint: usize, lag: f64) -> Vec<Vec<f64>> {
    let response = Response { delay: 0.0, lag };
    let of = |m: &&Motion<'_>| -> Vec<f64> {
        let late = response.behind(m, joint, &m.torque[joint]);
        late.iter().zip(&m.torque[joint]).map(|(late, x)| late - x).collect()
    };
    motions.iter().map(of).collect()
}

/// Half waves over a log in which its friction varies.
const PARTS: usize = 8;

/// Friction that differs between logs, and, in a drift, between repetitions. In a log that does not
/// repeat it varies with time.
fn of_logs(records: &[Record<'_>], joint: usize, tunables: &Tunables) -> Vec<Local> {
    let mut all = Vec::new();
    for (number, record) in records.iter().enumerate() {
        let motion = &record.motion;
        let scale = motion.scale(joint);
        let time = Range::of(motion.t.iter());
        let waves = if motion.closed { 0 } else { PARTS };
        for (size, series) in
            [(scale.coulomb, &motion.senses[joint]), (scale.viscous, &motion.rates[joint])]
        {
            for wave in 0..=waves {
                let size = if wave == 0 { size } else { size * roughness(wave as f64, tunables) };
                let of = |(x, t): (&f64, &f64)| size * x * time.wave(*t, wave);
                let mut by_record = vec![Vec::new(); records.len()];
                by_record[number] = series.iter().zip(&motion.t).map(of).collect();
                let friction_of = (wave == 0).then_some(number);
                all.push(Local { group: Group::LogFriction, series: by_record, friction_of });
            }
        }
    }
    all
}

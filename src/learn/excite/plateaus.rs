//! Constant joint speeds in both directions: friction as a function of speed.

use crate::arm::kinematics::Body;
use crate::arm::robot::{MAX_DOF, Model};

use super::error::ExciteError;
use super::feasible::rate_limits;
use super::series::State;

/// Number of speeds for each joint, equally spaced in their logarithm.
const SPEEDS: usize = 6;
/// Slowest speed over the fastest.
const SLOWEST: f64 = 0.02;
/// Share of the acceleration limit that is used.
const ACCELERATION: f64 = 0.5;
/// Initial share of a joint's range that is travelled.
const TRAVEL: f64 = 0.8;
/// Longest travel \[rad\] and longest time at one speed \[s\].
const MOST: [f64; 2] = [2.0, 15.0];
/// Factor by which the travel is reduced until there is room.
const SMALLER: f64 = 0.8;
/// Pause between two moves \[s\].
const PAUSE: f64 = 0.3;

/// A motion of straight joint moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Plateaus {
    /// Joint angles at the start \[rad\].
    pub start: Vec<f64>,
    /// The moves in order.
    moves: Vec<Move>,
}

#[derive(Clone, Debug, PartialEq)]
struct Move {
    /// Change of each joint over the move \[rad\].
    change: Vec<f64>,
    /// Duration of the move and of its acceleration phase \[s\].
    duration: f64,
    ramp: f64,
}

impl Plateaus {
    /// Total duration with the pauses \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.moves.iter().map(|m| m.duration + PAUSE).sum()
    }

    /// The states every `step` \[s\].
    #[must_use]
    pub fn sampled(&self, step: f64) -> Vec<State> {
        let mut states = Vec::new();
        let mut from = self.start.clone();
        let mut begin = 0.0;
        let mut t = 0.0;
        for m in &self.moves {
            while t < begin + m.duration + PAUSE {
                states.push(m.at(&from, (t - begin).min(m.duration)));
                t += step;
            }
            begin += m.duration + PAUSE;
            from.iter_mut().zip(&m.change).for_each(|(q, change)| *q += change);
        }
        states
    }
}

impl Move {
    fn at(&self, from: &[f64], t: f64) -> State {
        let mut state = [[0.0; MAX_DOF]; 3];
        let (r, d) = (self.ramp, self.duration);
        let speed = 1.0 / (d - r);
        // Share of the path, its rate and acceleration: speeding up, constant speed, slowing down.
        let (s, v, a) = if t < r {
            (0.5 * speed * t * t / r, speed * t / r, speed / r)
        } else if t < d - r {
            (speed * (t - 0.5 * r), speed, 0.0)
        } else {
            let left = d - t;
            (1.0 - 0.5 * speed * left * left / r, speed * left / r, -speed / r)
        };
        let rests = t >= d;
        for (joint, (from, change)) in from.iter().zip(&self.change).enumerate() {
            state[0][joint] = from + change * s;
            state[1][joint] = if rests { 0.0 } else { change * v };
            state[2][joint] = if rests { 0.0 } else { change * a };
        }
        state
    }
}

/// Each joint alone at six speeds in both directions, around a pose with room.
///
/// # Errors
/// A limit is missing, or there is no room to move.
pub fn friction_plateaus(
    model: &Model,
    body: &Body<'_>,
    speed_share: f64,
) -> Result<Plateaus, ExciteError> {
    let sets: Vec<Vec<f64>> = (0..model.dof).map(|joint| unit(model.dof, joint, 1.0)).collect();
    plateaus(model, body, speed_share, &sets)
}

/// Axis 5 alone, then axes 5 and 6 with the motor of axis 6 at rest, then axis 6.
///
/// # Errors
/// A limit is missing, or there is no room to move.
pub fn wrist_plateaus(
    model: &Model,
    body: &Body<'_>,
    speed_share: f64,
) -> Result<Plateaus, ExciteError> {
    let coupling = if model.wrist.coupling == 0.0 { 1.0 } else { model.wrist.coupling };
    let fifth = unit(model.dof, 4, 1.0);
    let mut both = fifth.clone();
    if let Some(sixth) = both.get_mut(5) {
        *sixth = -coupling;
    }
    let sixth = unit(model.dof, 5, 1.0);
    plateaus(model, body, speed_share, &[fifth, both, sixth])
}

fn unit(dof: usize, joint: usize, value: f64) -> Vec<f64> {
    (0..dof).map(|j| if j == joint { value } else { 0.0 }).collect()
}

fn plateaus(
    model: &Model,
    body: &Body<'_>,
    speed_share: f64,
    sets: &[Vec<f64>],
) -> Result<Plateaus, ExciteError> {
    let limits = &model.limits;
    let [velocity, acceleration] = rate_limits(model)?;
    let start = pose(model, body)?;
    let mut moves = Vec::new();
    for direction in sets {
        let share = (0..model.dof).filter(|j| direction[*j] != 0.0);
        let of = |limit: &dyn Fn(usize) -> f64| {
            share.clone().map(|j| limit(j) / direction[j].abs()).fold(f64::INFINITY, f64::min)
        };
        let fastest = speed_share * of(&|j| velocity[j]);
        let hardest = ACCELERATION * of(&|j| acceleration[j]);
        let room = of(&|j| {
            let [low, high] = limits.position[j];
            2.0 * (start[j] - low).min(high - start[j]).max(0.0)
        });
        let mut travel = (TRAVEL * room).min(MOST[0]);
        let clear = |travel: f64| {
            (-20..=20).all(|k| {
                let q: Vec<f64> = start
                    .iter()
                    .zip(direction)
                    .map(|(q, d)| q + 0.5 * travel * d * f64::from(k) / 20.0)
                    .collect();
                body.margins(&q).iter().all(|room| *room > 0.0)
            })
        };
        while !clear(travel) {
            travel *= SMALLER;
            if travel < 0.05 {
                return Err(ExciteError::Nowhere);
            }
        }
        let mut add = |length: f64, speed: f64| {
            // A short path has no room to accelerate to a fast speed.
            let speed = speed.min((0.5 * length.abs() * hardest).sqrt());
            let ramp = speed / hardest;
            moves.push(Move {
                change: direction.iter().map(|d| d * length).collect(),
                duration: length.abs() / speed + ramp,
                ramp,
            });
        };
        add(-0.5 * travel, 0.2 * fastest);
        for k in 0..SPEEDS {
            let speed = fastest * SLOWEST.powf(1.0 - k as f64 / (SPEEDS - 1) as f64);
            let way = travel.min(speed * MOST[1]);
            // Slow moves are shorter; both directions are centred in the travel.
            let aside = 0.5 * (travel - way);
            if aside > 1e-3 {
                add(aside, 0.2 * fastest);
            }
            add(way, speed);
            add(-way, speed);
            if aside > 1e-3 {
                add(-aside, 0.2 * fastest);
            }
        }
        add(0.5 * travel, 0.2 * fastest);
    }
    Ok(Plateaus { start, moves })
}

/// A collision-free pose: the middle of the ranges, or another one nearby.
///
/// # Errors
/// No pose is collision-free.
pub(super) fn pose(model: &Model, body: &Body<'_>) -> Result<Vec<f64>, ExciteError> {
    let mut random = fastrand::Rng::with_seed(1);
    let mut best: Option<(f64, Vec<f64>)> = None;
    for _ in 0..4000 {
        let q: Vec<f64> = model
            .limits
            .position
            .iter()
            .map(|[low, high]| {
                let half = 0.5 * (high - low).min(6.0);
                0.5 * (low + high) + 0.6 * half * (2.0 * random.f64() - 1.0)
            })
            .collect();
        let room = body.margins(&q).into_iter().fold(f64::INFINITY, f64::min);
        if best.as_ref().is_none_or(|(most, _)| room > *most) {
            best = Some((room, q));
        }
    }
    best.filter(|(room, _)| *room > 0.0).map(|(_, q)| q).ok_or(ExciteError::Nowhere)
}

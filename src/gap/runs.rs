//! Runs of a program: how long movements and waits take, how late the joints are, against runs
//! of the baseline.

use crate::arm::effects::{Effect, find};
use crate::arm::robot::Model;
use crate::learn::log::{Delay, median_step};

use super::decision::Estimated;

/// Deviations by which a duration has to differ, and by how much at least \[s\].
const BEYOND: f64 = 5.0;
const MOVES: f64 = 0.006;
const WAITS: f64 = 0.012;
/// Least lag \[s\].
const LAG: f64 = 0.002;
/// Odds below which two explanations cannot be told apart: 1 to 100.
const CLASS: f64 = 4.6;
/// Share of a duration that a law may miss.
const LAW: f64 = 0.01;

/// A log of repetitions of a program.
#[derive(Clone, Debug)]
pub struct Run {
    /// Times \[s\].
    pub t: Vec<f64>,
    /// Positions by joint \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Number of the movement, 0 for none.
    pub command: Vec<usize>,
}

/// A movement in some runs: its number, durations, waits behind it \[s\], positions since its
/// beginning.
#[derive(Clone, Debug, Default)]
struct Movement {
    number: usize,
    durations: Vec<f64>,
    waits: Vec<f64>,
    /// Rows of each time that it ran, as first row and number of rows of a run.
    rows: Vec<(usize, usize, usize)>,
}

/// What was found of the motion.
#[derive(Clone)]
pub struct RunFound {
    /// Effects.
    pub effects: Vec<RunEffect>,
    /// Whether movements differ in a way that no effect explains.
    pub is_unknown: bool,
    /// Rms of durations against the baseline, held-out: noise, before, after \[s\].
    pub gap: [f64; 3],
}

/// An effect of the motion.
#[derive(Clone)]
pub struct RunEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Ids that cannot be told apart.
    pub class: Vec<&'static str>,
    /// Its parameter.
    pub parameters: Vec<Estimated>,
    /// The movement behind which it is, from 1; `None` everywhere.
    pub movement: Option<usize>,
    /// Logarithm of the odds.
    pub nats: f64,
}

/// Movements of runs, in the order of their numbers.
fn movements(runs: &[Run]) -> Vec<Movement> {
    let mut all: Vec<Movement> = Vec::new();
    for (number, run) in runs.iter().enumerate() {
        let rows = run.command.len();
        let mut starts: Vec<usize> = vec![0];
        starts.extend((1..rows).filter(|row| run.command[*row] != run.command[row - 1]));
        // The first and the last piece may be cut off.
        for k in 1..starts.len().saturating_sub(1) {
            let (from, to) = (starts[k], starts[k + 1]);
            let command = run.command[from];
            if command == 0 {
                continue;
            }
            let at = all.iter().position(|of| of.number == command).unwrap_or_else(|| {
                all.push(Movement { number: command, ..Movement::default() });
                all.len() - 1
            });
            let movement = &mut all[at];
            movement.durations.push(run.t[to] - run.t[from]);
            movement.rows.push((number, from, to));
            let waits = run.command[to] == 0;
            match (waits, starts.get(k + 2)) {
                (true, Some(next)) => movement.waits.push(run.t[*next] - run.t[to]),
                (false, _) => movement.waits.push(0.0),
                (true, None) => {}
            }
        }
    }
    all.sort_by_key(|of| of.number);
    all
}

/// Mean and variance of the mean.
fn mean(x: &[f64], step: f64) -> (f64, f64) {
    let n = x.len().max(1) as f64;
    let mean = x.iter().sum::<f64>() / n;
    let spread = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    (mean, spread.max(step * step / 6.0) / n)
}

/// What separates runs from those of the baseline; `None` where there is too little of them.
#[must_use]
pub fn diagnose_runs(
    model: &Model,
    baseline: &[Run],
    train: &[Run],
    held: &[Run],
    may: &dyn Fn(&str) -> bool,
) -> Option<RunFound> {
    let (before, now) = (movements(baseline), movements(train));
    let step = baseline.first().and_then(|run| Some(run.t.get(1)? - run.t.first()?))?;
    let pairs: Vec<(&Movement, &Movement)> = now
        .iter()
        .filter_map(|of| Some((before.iter().find(|other| other.number == of.number)?, of)))
        .filter(|(a, b)| !a.durations.is_empty() && !b.durations.is_empty())
        .collect();
    if pairs.len() < 2 {
        return None;
    }
    let change = |a: &[f64], b: &[f64]| {
        let ((a, va), (b, vb)) = (mean(a, step), mean(b, step));
        (b - a, (va + vb).sqrt())
    };
    let moved: Vec<(f64, f64)> =
        pairs.iter().map(|(a, b)| change(&a.durations, &b.durations)).collect();
    let waited: Vec<(f64, f64)> = pairs.iter().map(|(a, b)| change(&a.waits, &b.waits)).collect();
    let mut found = RunFound { effects: Vec::new(), is_unknown: false, gap: [0.0; 3] };
    let push = |found: &mut RunFound,
                id: &'static str,
                class: Vec<&'static str>,
                value: f64,
                sd: f64,
                movement: Option<usize>,
                nats: f64| {
        let Some(effect) = find(id).filter(|_| may(id)) else {
            found.is_unknown = true;
            return;
        };
        let parameters = effect.parameters.iter().map(|parameter| Estimated {
            name: parameter.name.to_owned(),
            value,
            sd,
            unit: parameter.unit,
        });
        found.effects.push(RunEffect {
            effect,
            class,
            parameters: parameters.collect(),
            movement,
            nats,
        });
    };
    let stretched: Vec<usize> =
        (0..pairs.len()).filter(|k| moved[*k].0 > (BEYOND * moved[*k].1).max(MOVES)).collect();
    if !stretched.is_empty() {
        let laws = [
            law(model, train, &pairs, "speed_limit"),
            law(model, train, &pairs, "acceleration_limit"),
        ];
        let [speed, acceleration] = &laws;
        let (best, other) = if speed.misfit <= acceleration.misfit {
            (speed, acceleration)
        } else {
            (acceleration, speed)
        };
        let squares: f64 = moved.iter().map(|(change, sd)| (change / sd).powi(2)).sum();
        if best.misfit > 0.3 * squares && best.misfit > 40.0 {
            found.is_unknown = true;
        } else {
            let mut class = vec![best.id];
            if 0.5 * (other.misfit - best.misfit) < CLASS {
                class.push(other.id);
            }
            push(&mut found, best.id, class, best.factor, 0.01 * best.factor, None, 0.5 * squares);
        }
    }
    for (k, (change, sd)) in waited.iter().enumerate() {
        // A wait begins and ends at a row.
        let rows = 2.0 * train.first().map_or(0.0, |run| median_step(&run.t));
        if *change > (BEYOND * sd).max(WAITS).max(rows) {
            let nats = 0.5 * (change / sd).powi(2);
            let movement = Some(pairs[k].1.number);
            push(&mut found, "program_wait", vec!["program_wait"], *change, *sd, movement, nats);
        }
    }
    if found.effects.len() > 2 {
        // Everything takes longer: not a wait.
        found.effects.clear();
        found.is_unknown = true;
    }
    if stretched.is_empty()
        && let Some((lag, sd)) = lag(baseline, train, &pairs)
        && lag.abs() > (BEYOND * sd).max(LAG)
    {
        let nats = 0.5 * (lag / sd).powi(2);
        push(&mut found, "tracking_lag", vec!["tracking_lag"], lag, sd, None, nats);
    }
    found.gap =
        graded(&before, &movements(held), &pairs, &moved, &waited, !found.effects.is_empty());
    Some(found)
}

/// A law of stretched movements.
struct Law {
    id: &'static str,
    factor: f64,
    /// Squares of what it misses, in deviations.
    misfit: f64,
}

/// Durations are the longer of what they were and what the law asks for.
fn law(model: &Model, runs: &[Run], pairs: &[(&Movement, &Movement)], id: &'static str) -> Law {
    let is_speed = id == "speed_limit";
    let limits = if is_speed { &model.limits.velocity } else { &model.limits.acceleration };
    let needs: Vec<f64> = pairs
        .iter()
        .map(|(_, now)| {
            let Some((run, from, to)) = now.rows.first().copied() else { return 0.0 };
            let to = to.min(runs[run].t.len() - 1);
            let way = |joint: usize| (runs[run].q[joint][to] - runs[run].q[joint][from]).abs();
            (0..model.dof)
                .map(|joint| {
                    let limit = limits.as_ref().map_or(1.0, |limits| limits[joint]);
                    if is_speed { way(joint) / limit } else { (way(joint) / limit).sqrt() }
                })
                .fold(0.0, f64::max)
        })
        .collect();
    let misfit = |k: f64| -> f64 {
        pairs
            .iter()
            .zip(&needs)
            .map(|((before, now), need)| {
                let usual = mean(&before.durations, 0.0).0;
                let (found, variance) = mean(&now.durations, 0.01);
                let expected = usual.max(k * need);
                (found - expected).powi(2) / (variance + (LAW * found).powi(2))
            })
            .sum()
    };
    // From the slowest to the fastest that a movement can ask for.
    let mut best = (f64::INFINITY, 0.0);
    for ((_, now), need) in pairs.iter().zip(&needs).filter(|(_, need)| **need > 0.0) {
        let centre = mean(&now.durations, 0.0).0 / need;
        for step in -40..=40 {
            let k = centre * (1.0 + 0.001 * f64::from(step));
            let of = misfit(k);
            if of < best.0 {
                best = (of, k);
            }
        }
    }
    // A quintic's peaks.
    let factor = if is_speed { 1.875 / best.1 } else { 5.7736 / (best.1 * best.1) };
    Law { id, factor, misfit: best.0 }
}

/// How much later the joints are than in the baseline \[s\].
fn lag(baseline: &[Run], train: &[Run], pairs: &[(&Movement, &Movement)]) -> Option<(f64, f64)> {
    let mut lags = Vec::new();
    for (before, now) in pairs {
        let rows = before.rows.iter().chain(&now.rows).map(|(_, from, to)| to - from).min()?;
        let n = train.first()?.q.len();
        let average = |runs: &[Run], of: &Movement, joint: usize, k: usize| -> f64 {
            let at = |(run, from, _): &(usize, usize, usize)| runs[*run].q[joint][from + k];
            of.rows.iter().map(at).sum::<f64>() / of.rows.len() as f64
        };
        let step = baseline.first().map(|run| run.t[1] - run.t[0])?;
        let mut delay = Delay::default();
        for joint in 0..n {
            let [usual, now] = [(baseline, *before), (train, *now)].map(|(runs, of)| {
                (0..rows).map(|k| average(runs, of, joint, k)).collect::<Vec<f64>>()
            });
            delay.add(&usual, &now, step);
        }
        lags.extend(delay.seconds());
    }
    let n = lags.len() as f64;
    if n < 2.0 {
        return None;
    }
    let mean = lags.iter().sum::<f64>() / n;
    let spread = lags.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Some((mean, (spread / n).sqrt().max(2e-4)))
}

/// Rms of held-out durations and waits against the baseline, before and after.
fn graded(
    before: &[Movement],
    held: &[Movement],
    pairs: &[(&Movement, &Movement)],
    moved: &[(f64, f64)],
    waited: &[(f64, f64)],
    has_effect: bool,
) -> [f64; 3] {
    let (mut noise, mut first, mut last, mut count) = (0.0, 0.0, 0.0, 0.0_f64);
    for of in held {
        let Some(usual) = before.iter().find(|other| other.number == of.number) else { continue };
        let Some(k) = pairs.iter().position(|(_, now)| now.number == of.number) else { continue };
        for (now, usual, (change, sd)) in
            [(&of.durations, &usual.durations, moved[k]), (&of.waits, &usual.waits, waited[k])]
        {
            if now.is_empty() || usual.is_empty() {
                continue;
            }
            let late = mean(now, 0.0).0 - mean(usual, 0.0).0;
            noise += sd * sd;
            first += late * late;
            last += if has_effect { (late - change).powi(2) } else { late * late };
            count += 1.0;
        }
    }
    let rms = |sum: f64| (sum / count.max(1.0)).sqrt();
    [rms(noise), rms((first - noise).max(0.0)), rms((last - noise).max(0.0))]
}

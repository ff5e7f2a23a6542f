//! Coverage of the interval of a claimed reduction of residuals. The achieved reduction is that of
//! the same improved model on eight noiseless motions of the same robot, of the kind of the
//! held-out log, which no log contains: `cargo run --release --example shrink_coverage -- [SEED
//! [CASES]]`. To save time, the diagnosis of a case considers only its own effects. Rest and rows
//! near jumps of an acceleration are excluded, as in the claim.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/examined.rs"]
mod examined;

use examined::{examined, noiseless, records};
use joulepath::arm::effects::find;
use joulepath::arm::robot::Model;
use joulepath::examine::blind::{self, Kind, Settings};
use joulepath::gap::{self, Interval, Record, beside_no_jump, diagnose, predicted};
use rayon::prelude::*;

/// Seed of the development cases, and their number.
const SEED: u64 = 301;
const CASES: usize = 110;
/// Repetitions of each log, and duration of a repetition \[s\].
const CYCLES: usize = 5;
const PERIOD_S: f64 = 5.0;
/// Number of motions for the achieved reduction.
const MOTIONS: usize = 8;

/// Claimed intervals of all changes and of the effects alone, and the achieved reductions.
type Held = [(Interval, f64); 2];

fn main() {
    let mut given = std::env::args().skip(1).map(|x| x.parse::<u64>().unwrap());
    let seed = given.next().unwrap_or(SEED);
    let cases = given.next().map_or(CASES, |count| count as usize);
    let settings = Settings { cycles: CYCLES, period_s: PERIOD_S, ..Settings::new(seed) };
    let all: Vec<(usize, Held, bool)> =
        (1..=cases).into_par_iter().filter_map(|number| held(&settings, number)).collect();
    println!(
        "case    claimed, 95 %               achieved, of all changes and of the effects alone"
    );
    for (number, held, has_effect) in &all {
        for of in held.iter().take(1 + usize::from(*has_effect)) {
            let (claim, achieved) = of;
            let holds = if is_held(of) { "" } else { "   not held" };
            println!(
                "{number:>4} {:>8.3} ({:.3} to {:.3}) {achieved:>10.3}{holds}",
                claim.value, claim.low, claim.high
            );
        }
    }
    for (k, name) in ["all changes", "effects alone"].into_iter().enumerate() {
        // Without an asserted effect there is no claim for effects.
        let asked = all.iter().filter(|(_, _, has_effect)| k == 0 || *has_effect);
        let claims: Vec<&(Interval, f64)> = asked.map(|(_, held, _)| &held[k]).collect();
        let count = claims.iter().filter(|of| is_held(of)).count();
        let mut widths: Vec<f64> = claims.iter().map(|(of, _)| of.high - of.low).collect();
        widths.sort_by(f64::total_cmp);
        println!(
            "{name}: held in {count} of {} cases, {:.1} %; median width {:.3}",
            claims.len(),
            100.0 * count as f64 / claims.len() as f64,
            widths[widths.len() / 2]
        );
    }
}

fn is_held((claim, achieved): &(Interval, f64)) -> bool {
    (claim.low..=claim.high).contains(achieved)
}

/// Claims and achieved reductions of a torque case, and whether an effect was asserted.
fn held(settings: &Settings, number: usize) -> Option<(usize, Held, bool)> {
    let motions = blind::unlogged(settings, number, MOTIONS)?;
    let case = blind::case(settings, number).filter(|case| case.label.kind != Kind::Power)?;
    let input = examined(&case, settings);
    let effects = case.label.effects.iter().filter_map(|truth| find(&truth.id)).collect();
    let options = gap::Settings { trust: input.trust, effects, tunables: gap::Tunables::DEFAULT };
    let heldout = records(&input.nominal, &input.heldout);
    let found = diagnose(&input.nominal, records(&input.nominal, &input.train), &heldout, &options);
    let models = [&input.nominal, &found.refit.applied, &found.improved.applied];
    let logs = noiseless(&motions, settings);
    let [nominal, refit, improved] = squares(&records(&input.nominal, &logs), models);
    let shrink = |before: f64| if before > 0.0 { 1.0 - (improved / before).sqrt() } else { 0.0 };
    let claims = [(found.shrink.total, shrink(nominal)), (found.shrink.by_effect, shrink(refit))];
    Some((number, claims, !found.effects.is_empty()))
}

/// Squared residuals of models; each joint is scaled by its torque.
fn squares(records: &[Record<'_>], models: [&Model; 3]) -> [f64; 3] {
    let n = models[0].dof;
    let (mut missed, mut size) = (vec![[0.0; 3]; n], vec![0.0; n]);
    for record in records {
        let is_known = beside_no_jump(record);
        let predictions = models.map(|model| predicted(record, model));
        for joint in 0..n {
            for row in (0..record.motion.rows()).filter(|row| is_known[*row]) {
                if !record.moves(joint, row) {
                    continue;
                }
                let measured = record.measured[joint][row];
                size[joint] += measured * measured;
                for (sum, predicted) in missed[joint].iter_mut().zip(&predictions) {
                    *sum += (measured - predicted[joint][row]).powi(2);
                }
            }
        }
    }
    let relative = |k: usize| {
        let joints = missed.iter().zip(&size).filter(|(_, size)| **size > 0.0);
        joints.map(|(missed, size)| missed[k] / size).sum()
    };
    [relative(0), relative(1), relative(2)]
}

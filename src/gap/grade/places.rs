//! Where the gap is: shares of joints and regimes in what the effects change.

use crate::arm::robot::Model;

use super::attribution::{MOST, PARAMETERS, Subsets, brought, regime};
use super::bins::Quantity;
use super::heldout::predicted;
use super::pieces::{Pieces, difference};
use crate::gap::data::{REST, Record, RecordKind};
use crate::gap::decision::Place;
use crate::gap::model::Improved;

/// Shares of the joints in what changes from the model with other parameters to that with the
/// effects `ids` as well (without effects: from the nominal model), then those of each joint's
/// regimes. The regimes of a quantity add up to their joint's share, the effects of a regime to
/// the regime's.
pub(in crate::gap) fn places(
    records: &[Record<'_>],
    nominal: &Model,
    [refit, improved]: [&Improved; 2],
    ids: &[&'static str],
) -> Vec<Place> {
    let records: Vec<&Record<'_>> =
        records.iter().filter(|record| record.kind == RecordKind::Mean).collect();
    let shares = of_joints(&records, nominal, [refit, improved]);
    let whole = shares.iter().enumerate().map(|(joint, share)| Place {
        joint: Some(joint),
        regime: "all".to_owned(),
        share: *share,
        ..Place::default()
    });
    let mut places: Vec<Place> = whole.collect();
    places.extend(of_regimes(&records, nominal, [refit, improved], ids, &shares));
    places
}

/// Shares of the joints, and of their regimes, in what a model misses.
pub(in crate::gap) fn places_missed(records: &[Record<'_>], model: &Improved) -> Vec<Place> {
    let records: Vec<&Record<'_>> =
        records.iter().filter(|record| record.kind == RecordKind::Mean).collect();
    let Some(first) = records.first() else { return Vec::new() };
    let n = first.motion.model.dof;
    let pieces = Pieces::new(&records, n);
    let missed =
        pieces.squares(|record| difference(&record.measured, &predicted(record, &model.applied)));
    let mut of_joint = vec![0.0; n];
    for ((joint, quantity, _), missed) in pieces.places.iter().zip(&missed) {
        of_joint[*joint] += if *quantity == Quantity::Speed { *missed } else { 0.0 };
    }
    let sum = of_joint.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let whole = of_joint.iter().enumerate().map(|(joint, missed)| Place {
        joint: Some(joint),
        regime: "all".to_owned(),
        share: missed / sum,
        ..Place::default()
    });
    let of_pieces =
        pieces.places.iter().zip(&missed).map(|((joint, quantity, ends), missed)| Place {
            joint: Some(*joint),
            regime: regime(*quantity, *ends),
            share: missed / sum,
            span: (*quantity == Quantity::Time).then_some(*ends),
            ..Place::default()
        });
    whole.chain(of_pieces).collect()
}

/// Shares of the joints.
fn of_joints(
    records: &[&Record<'_>],
    nominal: &Model,
    [refit, improved]: [&Improved; 2],
) -> Vec<f64> {
    let n = nominal.dof;
    // The same parameters without the effects, or, where there are none, the nominal ones.
    let mut bare = improved.written.clone();
    if bare == refit.written {
        bare = nominal.clone();
    } else {
        bare.effects.clone_from(&refit.written.effects);
        bare.sensors.clone_from(&refit.written.sensors);
        bare.laws.clone_from(&refit.written.laws);
    }
    let (mut change, mut size) = (vec![0.0; n], vec![0.0; n]);
    for record in records {
        let (with, without) = (predicted(record, &improved.applied), predicted(record, &bare));
        for joint in 0..n {
            // The rows that are graded: a joint at rest has any friction.
            let moves = |row: &usize| record.motion.qd[joint][*row].abs() > REST;
            for row in (0..with[joint].len()).filter(moves) {
                change[joint] += (with[joint][row] - without[joint][row]).powi(2);
                size[joint] += record.measured[joint][row].powi(2);
            }
        }
    }
    let shares: Vec<f64> =
        change.iter().zip(&size).map(|(change, size)| change / size.max(1e-12)).collect();
    let sum: f64 = shares.iter().sum::<f64>().max(1e-300);
    shares.iter().map(|share| share / sum).collect()
}

/// The shares of joints, over the regimes in which the squares of what changes lie.
fn of_regimes(
    records: &[&Record<'_>],
    nominal: &Model,
    [refit, improved]: [&Improved; 2],
    ids: &[&'static str],
    shares: &[f64],
) -> Vec<Place> {
    let mut players: Vec<&'static str> = Vec::new();
    for id in ids {
        if !players.contains(id) {
            players.push(id);
        }
    }
    if players.len() > MOST {
        return Vec::new();
    }
    // Beside effects, other parameters are there from the start.
    let count = players.len().max(1);
    let start = if players.is_empty() { 0 } else { 1 << count };
    players.push(PARAMETERS);
    let models = Subsets { nominal, refit, improved, players: &players };
    let pieces = Pieces::new(records, nominal.dof);
    let bare = models.of(start);
    let change = |set: usize| {
        let model = models.of(start | set);
        pieces.squares(|record| difference(&predicted(record, &model), &predicted(record, &bare)))
    };
    let changes: Vec<Vec<f64>> = (0..1 << count).map(change).collect();
    let brought = brought(&changes, count);
    let Some(all) = changes.last() else { return Vec::new() };
    let place = |(k, (joint, quantity, ends)): (usize, &(usize, Quantity, [f64; 2]))| {
        let of_joint: f64 = (pieces.places.iter().zip(all))
            .filter(|((other, of, _), _)| other == joint && of == quantity)
            .map(|(_, change)| change)
            .sum();
        let unit = shares[*joint] / of_joint.max(f64::MIN_POSITIVE);
        Place {
            joint: Some(*joint),
            regime: regime(*quantity, *ends),
            share: unit * all[k],
            by_effect: players.iter().zip(&brought).map(|(id, of)| (*id, unit * of[k])).collect(),
            span: (*quantity == Quantity::Time).then_some(*ends),
            ..Place::default()
        }
    };
    pieces.places.iter().enumerate().map(place).collect()
}

//! Energies and savings of random programs: estimated and published dynamics.

use std::fmt::Write as _;

use joulepath::arm::robot::Model;
use joulepath::retime::energy::account;
use joulepath::retime::energy::plausible::{Interval, plausibility};
use joulepath::tool::retrofit::{Settings, retrofit};
use rayon::prelude::*;

use super::source;
use super::torques::{CASES, pose};

/// Movements of a program.
const MOVES: usize = 6;

/// Whether the intervals contain the motion energy and the saving of random programs.
pub(crate) fn held(truth: &Model, unknown: &Model) -> (Vec<bool>, Vec<bool>) {
    let mut random = fastrand::Rng::with_seed(1601);
    let programs: Vec<String> = (0..CASES).map(|_| program(truth, &mut random)).collect();
    let held: Vec<(bool, Option<bool>)> = programs
        .par_iter()
        .map(|text| {
            let files = [source(text)];
            let done = retrofit(&files, unknown, &Settings::default(), &|_, _| ()).unwrap();
            let holds = |Interval { low, high, .. }: Interval, x: f64| (low..=high).contains(&x);
            let (before, after) = (&done.before, &done.after);
            let plausible = plausibility(unknown, &before.0, &before.1).unwrap();
            let [was, is] =
                [&before.0, &after.0].map(|s| account(truth, s).total.motion_energy_j());
            let saving = done
                .uncertainty
                .filter(|_| done.optimized.motion_energy_j != done.original.motion_energy_j);
            let saved = saving.map(|all| holds(all.saving_percent[1], 100.0 * (was - is) / was));
            (holds(plausible.motion_energy_j, was), saved)
        })
        .collect();
    (
        held.iter().map(|(motion, _)| *motion).collect(),
        held.iter().filter_map(|(_, s)| *s).collect(),
    )
}

/// A program of joint movements between random poses.
fn program(model: &Model, random: &mut fastrand::Rng) -> String {
    let mut text = String::from("MODULE Random\n");
    let mut moves = String::new();
    for k in 0..=MOVES {
        let q: Vec<String> =
            pose(model, random).iter().map(|x| format!("{:.3}", x.to_degrees())).collect();
        let _ = writeln!(
            text,
            "  CONST jointtarget j{k}:=[[{}],[9E9,9E9,9E9,9E9,9E9,9E9]];",
            q.join(",")
        );
        let speed = [500, 1000, 2000][random.usize(0..3)];
        let _ = writeln!(moves, "    MoveAbsJ j{k},v{speed},fine,tool0;");
    }
    text + "  PROC main()\n" + &moves + "  ENDPROC\nENDMODULE\n"
}

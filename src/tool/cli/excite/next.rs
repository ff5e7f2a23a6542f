//! The motion that tells explanations of a gap apart, as RAPID with a logger.

use std::path::Path;

use super::area::{Cell, cell};
use super::args::ExperimentArgs;
use super::motion::{Motion, TABLE_STEP, blended};
use super::outputs::write;
use crate::arm::kinematics::Body;
use crate::arm::robot::Model;
use crate::gap::{Rivals, Separation};
use crate::learn::excite::{Design, Focus, STEP, State, design, design_for};
use crate::tool::cli::common;

const TITLE: &str = "Experiment that tells explanations of a gap apart";
/// Longest motion \[s\], the ways from rest and back among it.
const LONGEST: f64 = 60.0;
/// Base frequency \[Hz\], harmonics, and share of the speed limits.
const BASE_FREQUENCY: f64 = 0.1;
const HARMONICS: [usize; 3] = [1, 3, 7];
const SPEED_SHARE: f64 = 0.8;
/// Time between the points \[s\].
const SPACING: f64 = 0.01;
/// Repetitions, least and most: their mean and noise are known from three on.
const REPETITIONS: [usize; 2] = [3, 5];

/// An experiment that was written.
pub(in crate::tool::cli) struct Written {
    /// Duration, the ways from rest and back included \[s\].
    pub(in crate::tool::cli) seconds: f64,
    pub(in crate::tool::cli) cycles: usize,
    /// How well it tells the explanations apart; `None` where there are not two.
    pub(in crate::tool::cli) separation: Option<Separation>,
    pub(in crate::tool::cli) outputs: Vec<String>,
}

/// Writes the motion that tells rivals apart best; where there are none, one that shows all parameters.
pub(in crate::tool::cli) fn next_experiment(
    out: &Path,
    args: &ExperimentArgs,
    model: &Model,
    rivals: Option<&Rivals>,
    quiet: bool,
) -> anyhow::Result<Written> {
    let Cell { obstacles, tool, load } = cell(args, model)?;
    let settings = Design {
        focus: Focus::All,
        base_frequency: BASE_FREQUENCY,
        harmonics: HARMONICS.to_vec(),
        speed_share: SPEED_SHARE,
        obstacles,
        tool,
        load,
        seed: 1,
    };
    let body = Body::new(model, settings.tool, &settings.obstacles);
    let bar = common::progress(quiet, None);
    bar.set_message("the motion that tells the explanations apart");
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let [_, most] = REPETITIONS;
    let rivals = rivals.filter(|of| of.all.len() > 1);
    let found = match rivals {
        Some(rivals) => {
            let worth = |states: &[State]| rivals.separation(states, STEP, most).worth();
            design_for(model, &settings, &worth, &progress)?
        }
        None => design(model, &settings, &progress)?,
    };
    bar.finish_and_clear();
    let motion = blended(model, &settings, &body, &found, &|_| (SPACING, most))?;
    let ways: f64 = motion.blends.iter().flatten().map(|of| of.duration).sum();
    let fits = ((LONGEST - ways) / motion.period) as usize;
    let cycles = fits.clamp(REPETITIONS[0], most);
    let motion = Motion { cycles, ..motion };
    let every = (STEP / TABLE_STEP).round() as usize;
    let states: Vec<State> = motion.states.iter().step_by(every).copied().collect();
    Ok(Written {
        seconds: ways + motion.period * cycles as f64,
        cycles,
        separation: rivals.map(|of| of.separation(&states, STEP, cycles)),
        outputs: write(out, (TITLE, args.torque), model, &settings.load, &motion)?,
    })
}

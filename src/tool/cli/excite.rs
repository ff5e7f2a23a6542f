//! `joulepath excite`: a motion that identifies a robot's parameters.

mod area;
mod args;
mod motion;
mod next;
mod outputs;

pub(super) use area::{cell, floor};
pub(super) use args::{ExciteArgs, ExperimentArgs};
pub(super) use next::{Written, next_experiment};

use std::process::ExitCode;

use anyhow::bail;

use self::area::Cell;
use self::args::{MAX_SPACING, Spacing, Variant};
use self::motion::{TABLE_STEP, designed_motion, plateau_motion};
use self::outputs::{json, text, title, write};
use super::common;
use crate::arm::effects;
use crate::arm::kinematics::Body;
use crate::arm::robot::Model;
use crate::learn::excite::{Design, Focus, Plateaus, friction_plateaus, wrist_plateaus};

/// Range of base frequencies that can be designed and recorded \[Hz\].
const MIN_FREQUENCY: f64 = 0.01;
const MAX_FREQUENCY: f64 = 10.0;
/// Minimum share of the speed limits: joints stick at lower speeds.
const MIN_SPEED_SHARE: f64 = 0.001;
/// Maximum number of repetitions.
const MAX_CYCLES: usize = 10_000;
/// Minimum number of points per period of the highest harmonic.
const MIN_POINTS: f64 = 6.0;

pub(super) fn run(args: &ExciteArgs) -> anyhow::Result<ExitCode> {
    let model = effects::load_estimated(&args.robot)?;
    common::require_six_joints(&model, "RAPID is written for robots with 6")?;
    let settings = settings(args, &model)?;
    common::notes(args.quiet, model.assumed());
    let body = Body::new(&model, settings.tool, &settings.obstacles);
    let plateaus = |found: Plateaus| plateau_motion(args, &model, &settings, &body, &found);
    let motion = match args.variant {
        Variant::Friction => plateaus(friction_plateaus(&model, &body, args.speed_share)?),
        Variant::Wrist => plateaus(wrist_plateaus(&model, &body, args.speed_share)?),
        _ => designed_motion(args, &model, &settings, &body)?,
    };
    let logged = (title(args.variant), args.cell.torque);
    let outputs = write(&args.out, logged, &model, &settings.load, &motion)?;
    common::print(args.format, || json(&motion, &outputs), || text(&motion, &outputs))
}

fn settings(args: &ExciteArgs, model: &Model) -> anyhow::Result<Design> {
    let positive = |option: &str, value: f64| -> anyhow::Result<()> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        bail!("{option} {value}: give a number above 0")
    };
    positive("--base-frequency", args.base_frequency)?;
    positive("--speed-share", args.speed_share)?;
    if !(MIN_FREQUENCY..=MAX_FREQUENCY).contains(&args.base_frequency) {
        bail!(
            "--base-frequency {}: a repetition would last {:.3} s; give {MIN_FREQUENCY} to {MAX_FREQUENCY} Hz",
            args.base_frequency,
            1.0 / args.base_frequency
        );
    }
    if !(MIN_SPEED_SHARE..=1.0).contains(&args.speed_share) {
        bail!(
            "--speed-share {}: give a share of the speed limits, from {MIN_SPEED_SHARE} to 1",
            args.speed_share
        );
    }
    if !(1..=MAX_CYCLES).contains(&args.cycles) {
        bail!("--cycles {}: give 1 to {MAX_CYCLES}", args.cycles);
    }
    let mut harmonics = args.harmonics.clone();
    harmonics.sort_unstable();
    harmonics.dedup();
    if harmonics.is_empty() || harmonics[0] == 0 || harmonics[harmonics.len() - 1] > 100 {
        bail!(
            "--harmonics: give whole multiples of the base frequency from 1 to 100, such as 1,4,7"
        );
    }
    if let Spacing::Seconds(spacing) = args.spacing {
        let fastest = args.base_frequency * harmonics[harmonics.len() - 1] as f64;
        let widest = MAX_SPACING.min(1.0 / (MIN_POINTS * fastest));
        if !(TABLE_STEP..=widest).contains(&spacing) {
            bail!(
                "--spacing {spacing}: points have to be {TABLE_STEP} to {widest:.4} s apart, {MIN_POINTS} \
                 or more in a period of the fastest harmonic"
            );
        }
    }
    let Cell { obstacles, tool, load } = cell(&args.cell, model)?;
    let (focus, base_frequency, harmonics, speed_share) = match args.variant {
        // A tenth of the speed: little inertia, and friction of constant sign.
        Variant::Gravity => {
            (Focus::Gravity, 0.1 * args.base_frequency, harmonics, 0.1 * args.speed_share)
        }
        Variant::Payload => (Focus::Payload, args.base_frequency, harmonics, args.speed_share),
        _ => (Focus::All, args.base_frequency, harmonics, args.speed_share),
    };
    Ok(Design {
        focus,
        base_frequency,
        harmonics,
        speed_share,
        obstacles,
        tool,
        load,
        seed: args.seed,
    })
}

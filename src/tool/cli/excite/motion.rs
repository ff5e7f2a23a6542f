//! The motion of an experiment: optimised, or made of speed plateaus.

use anyhow::bail;

use super::args::{ExciteArgs, Spacing, Variant};
use crate::arm::kinematics::Body;
use crate::arm::robot::Model;
use crate::learn::excite::{
    Blend, Checked, Design, Designed, Information, Plateaus, Series, State, blends, check, design,
};
use crate::tool::cli::common::progress;

/// Row interval of the table \[s\]: the grid on which limits are checked.
pub(super) const TABLE_STEP: f64 = 0.001;
/// Resolution of the time between RAPID points \[s\].
const TICK: f64 = 1e-4;
/// Maximum factor on the number of points per period that makes the spacing a multiple of the tick.
const MAX_POINT_FACTOR: f64 = 1.3;
/// Factor on the point spacing for straight moves.
const PLATEAU_SPACING_FACTOR: f64 = 10.0;
/// Number of repetitions that warm a robot up.
const WARMING_CYCLES: usize = 120;

/// A motion to write.
pub(super) struct Motion {
    pub(super) period: f64,
    pub(super) cycles: usize,
    /// One repetition.
    pub(super) states: Vec<State>,
    /// The states at intervals of `spacing`.
    pub(super) points: Vec<State>,
    pub(super) blends: Option<[Blend; 2]>,
    pub(super) information: Option<Information>,
    pub(super) checked: Checked,
}

pub(super) fn designed_motion(
    args: &ExciteArgs,
    model: &Model,
    settings: &Design,
    body: &Body<'_>,
) -> anyhow::Result<Motion> {
    let bar = progress(args.quiet, None);
    let found = design(model, settings, &|done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    let cycles = if args.variant == Variant::Warming {
        WARMING_CYCLES.max(args.cycles)
    } else {
        args.cycles
    };
    // A slow motion needs no more points.
    let stretched = args.base_frequency / settings.base_frequency;
    blended(model, settings, body, &found, &|states| {
        let spacing = args.spacing.seconds(states);
        match args.spacing {
            Spacing::Seconds(_) => (stretched * spacing, cycles),
            Spacing::Adaptive => (spacing, cycles),
        }
    })
}

/// A designed motion with its ways from rest and back; `run` tells the time between points \[s\] and
/// the number of repetitions for the states of a repetition.
pub(super) fn blended(
    model: &Model,
    settings: &Design,
    body: &Body<'_>,
    found: &Designed,
    run: &dyn Fn(&[State]) -> (f64, usize),
) -> anyhow::Result<Motion> {
    let fits = |states: &[State]| {
        let checked = check(model, body, &settings.load, states);
        let r = &checked.ratios;
        [r.position, r.acceleration, r.torque].iter().all(|ratio| *ratio <= 1.0)
            && r.velocity <= settings.speed_share
            && checked.to_obstacles >= 0.0
            && checked.to_itself >= 0.0
    };
    let Some((series, blends)) = blends(model, &found.series, &fits) else {
        bail!("no blend from rest into the motion keeps the limits: give another --seed");
    };
    let states = sampled(&series);
    let (spacing, cycles) = run(&states);
    // A period has a whole number of points.
    let points = points_per_period(series.period(), spacing);
    Ok(Motion {
        period: series.period(),
        cycles,
        states,
        points: series.sampled(points),
        blends: Some(blends),
        information: Some(found.information),
        checked: found.checked,
    })
}

/// Number of points per period, at most `spacing` \[s\] apart; if possible the spacing is a
/// multiple of the tick, so that repetitions last exactly a period.
fn points_per_period(period: f64, spacing: f64) -> usize {
    let least = (period / spacing - 1e-6).ceil().max(3.0) as usize;
    let most = (MAX_POINT_FACTOR * least as f64) as usize;
    let is_exact = |points: &usize| {
        let ticks = period / (TICK * *points as f64);
        (ticks - ticks.round()).abs() < 1e-6 * ticks
    };
    (least..=most).find(is_exact).unwrap_or(least)
}

fn sampled(series: &Series) -> Vec<State> {
    series.sampled((series.period() / TABLE_STEP).round().max(1.0) as usize)
}

pub(super) fn plateau_motion(
    args: &ExciteArgs,
    model: &Model,
    settings: &Design,
    body: &Body<'_>,
    plateaus: &Plateaus,
) -> Motion {
    let states = plateaus.sampled(TABLE_STEP);
    Motion {
        period: plateaus.duration(),
        cycles: 1,
        points: plateaus.sampled(match args.spacing {
            Spacing::Seconds(seconds) => PLATEAU_SPACING_FACTOR * seconds,
            Spacing::Adaptive => args.spacing.seconds(&states),
        }),
        blends: None,
        information: None,
        checked: check(model, body, &settings.load, &states),
        states,
    }
}

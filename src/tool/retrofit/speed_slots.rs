//! Sites whose programmed speeds can be replaced, and the text of the new speeds.

use std::collections::BTreeMap;

use super::candidate::{Candidate, State, with_states};
use super::job::Original;
use super::settings::Settings;
use super::speed_arguments::{Argument, speed_arguments};
use crate::rapid::ir::movement::Speed;
use crate::rapid::ir::number::number;
use crate::rapid::text::{Edit, Span};
use crate::retime::motion::timeline::What;
use crate::retime::optimize::freedom::Bound;
use crate::retime::optimize::reason::Reason;

/// Maximum programmed speed of a controller, m/s.
const FASTEST: f64 = 7.0;
/// Decimals of a speed in mm/s and degrees/s.
const DECIMALS: usize = 1;
/// Decimals of a factor on a speed.
const SHARE_DECIMALS: usize = 4;

/// A site whose speeds may change.
pub(super) struct Slot {
    /// Index of the site.
    pub(super) site: usize,
    /// The events in which it runs.
    pub(super) events: Vec<usize>,
    speeds: Vec<ProgrammedSpeed>,
}

struct ProgrammedSpeed {
    argument: Argument,
    speed: Speed,
    /// Whether it is an upper limit.
    ceiling: bool,
}

impl Slot {
    /// Whether a factor changes the text.
    pub(super) fn is_changed(&self, factor: f64) -> bool {
        self.speeds.iter().any(|speed| factor_of(speed, factor) != 1.0)
    }

    /// The edits that multiply the speeds by a factor.
    pub(super) fn edits(&self, factor: f64) -> impl Iterator<Item = Edit> {
        let changed = self.speeds.iter().filter(move |speed| factor_of(speed, factor) != 1.0);
        changed.map(move |programmed| Edit {
            span: programmed.argument.span,
            text: speed_text(programmed, factor_of(programmed, factor)).into_bytes(),
        })
    }
}

/// The sites whose speeds can be replaced in the text; the other candidates get the reason.
pub(super) fn slots(
    original: &Original<'_>,
    settings: &Settings,
    candidates: Vec<Candidate>,
) -> (Vec<Slot>, Vec<Candidate>) {
    let arguments = speed_arguments(original.program, original.files);
    let mut slots = Vec::new();
    let mut refused = Vec::new();
    for site in 0..original.sites.len() {
        let own = || candidates.iter().enumerate().filter(|(_, candidate)| candidate.site == site);
        if own().any(|(_, candidate)| !matches!(candidate.state, State::Pending)) {
            continue;
        }
        match slot(original, settings, site, &arguments) {
            Ok(slot) => slots.push(slot),
            Err(why) => refused
                .extend(own().map(|(index, _)| {
                    (index, State::Refused(Reason::NotConstant(why.to_owned())))
                })),
        }
    }
    (slots, with_states(candidates, refused))
}

/// The speeds of a site, or why they cannot be replaced.
fn slot(
    original: &Original<'_>,
    settings: &Settings,
    site: usize,
    arguments: &BTreeMap<Span, Argument>,
) -> Result<Slot, &'static str> {
    let events: Vec<usize> =
        original.sites[site].variants.iter().flat_map(|v| v.events.iter().copied()).collect();
    let mut speeds: BTreeMap<Span, ProgrammedSpeed> = BTreeMap::new();
    for event in &events {
        let What::Run(run) = &original.cycle.simulation.events[*event].what else { continue };
        for movement in run.moves.iter().map(|record| &record.movement) {
            let Some(argument) = arguments.get(&movement.span).cloned() else {
                return Err("its speed is not one argument that can be written anew");
            };
            let ceiling = settings.freedom.bound(movement) == Bound::Original;
            let here = ProgrammedSpeed { argument, speed: movement.speed, ceiling };
            let known = speeds.entry(movement.span).or_insert(here);
            if known.speed != movement.speed {
                return Err("its speed is another one in another execution");
            }
        }
    }
    Ok(Slot { site, events, speeds: speeds.into_values().collect() })
}

/// The factor on a speed in a run with factor `factor`, limited by the ceiling.
fn factor_of(programmed: &ProgrammedSpeed, factor: f64) -> f64 {
    let most = if programmed.ceiling { 1.0 } else { (FASTEST / programmed.speed.tcp).max(1.0) };
    factor.min(most)
}

/// A `speeddata`. External axes do not move in changed runs.
fn speed_text(ProgrammedSpeed { argument, speed, .. }: &ProgrammedSpeed, factor: f64) -> String {
    if let Some(datum) = &argument.datum {
        let share = number(rounded_down(factor, 1e4), SHARE_DECIMALS);
        let scaled = ["v_tcp", "v_ori"].map(|part| format!("{share}*{datum}.{part}"));
        return format!("[{},{datum}.v_leax,{datum}.v_reax]", scaled.join(","));
    }
    let tcp = rounded_down(speed.tcp * 1e3 * factor, 10.0);
    let orientation = rounded_down(speed.orientation.to_degrees() * factor, 10.0);
    format!("[{},{},5000,1000]", number(tcp, DECIMALS), number(orientation, DECIMALS))
}

/// Rounded down to a multiple of `1 / parts`, so that rounding never exceeds a ceiling.
fn rounded_down(x: f64, parts: f64) -> f64 {
    /// Rounding error of the arithmetic.
    const SLACK: f64 = 1e-9;
    (x * parts + SLACK).floor().max(1.0) / parts
}

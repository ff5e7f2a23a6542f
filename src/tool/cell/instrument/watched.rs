//! The signals whose changes are recorded.

use std::collections::{BTreeMap, BTreeSet};

use super::error::{InstrumentError, MOST_SIGNALS};
use super::sites::{Site, SiteKind};
use crate::arm::robot::nearest;
use crate::rapid::builtins::SignalKind;
use crate::rapid::ir::signals::Signal;

/// A signal that is watched.
pub(super) struct Watched {
    pub(super) name: String,
    pub(super) is_output: bool,
}

/// The named signals; without names the digital inputs for which the program waits.
pub(super) fn watched(
    names: Option<&[String]>,
    known: &BTreeMap<String, Signal>,
    sites: &[Site],
) -> Result<Vec<Watched>, InstrumentError> {
    let outputs: BTreeSet<String> = sites
        .iter()
        .filter_map(|site| match &site.kind {
            SiteKind::Output { signal, .. } => Some(signal.to_lowercase()),
            _ => None,
        })
        .collect();
    let is_output = |name: &str| {
        let name = name.to_lowercase();
        outputs.contains(&name) || name.starts_with("do")
    };
    let Some(names) = names else {
        let awaited = sites.iter().filter_map(|site| match &site.kind {
            SiteKind::Wait { signal: Some(signal), .. } => known.get(&signal.to_lowercase()),
            _ => None,
        });
        let inputs: BTreeSet<&str> = awaited
            .filter(|signal| is_digital(signal) && !is_output(&signal.name))
            .map(|signal| signal.name.as_str())
            .collect();
        let input = |name: &str| Watched { name: name.to_owned(), is_output: false };
        return Ok(inputs.into_iter().take(MOST_SIGNALS).map(input).collect());
    };
    let mut found: Vec<Watched> = Vec::new();
    for name in names {
        let Some(signal) = known.get(&name.to_lowercase()) else {
            let names = known.values().map(|signal| signal.name.as_str());
            let way_out = nearest(name, names).map_or_else(
                || "correct the name or leave it out".to_owned(),
                |near| format!("did you mean {near}?"),
            );
            return Err(InstrumentError::UnknownSignal { name: name.clone(), way_out });
        };
        if !is_digital(signal) {
            return Err(InstrumentError::NotDigital(name.clone()));
        }
        if found.iter().all(|other| other.name != signal.name) {
            found.push(Watched { name: signal.name.clone(), is_output: is_output(name) });
        }
    }
    if found.len() > MOST_SIGNALS {
        return Err(InstrumentError::TooManySignals(found.len()));
    }
    Ok(found)
}

fn is_digital(signal: &Signal) -> bool {
    signal.kind == Some(SignalKind::Digital)
}

//! How many movements of a program the simulation makes, and why it does not make the others.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::context::Context;
use super::trace::Action;
use crate::rapid::text::Span;

/// Most names in a reason: enough to see which procedures are meant.
const MAX_NAMES: usize = 3;

/// The simulated movements among all.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Coverage {
    /// Movement statements that the program can reach.
    pub movements: usize,
    /// Those that the simulation makes as programmed.
    pub simulated: usize,
    /// Programs without their entry: their procedures are simulated one by one.
    pub without_entry: usize,
    /// Why the others are not simulated, with their number.
    pub missing: BTreeMap<String, usize>,
}

impl Coverage {
    /// The simulated movements of a program.
    pub(super) fn new(context: &Context<'_>) -> Coverage {
        let left: BTreeSet<Span> = context
            .trace
            .iter()
            .filter_map(|done| match done.what {
                Action::Left(span) => Some(span),
                _ => None,
            })
            .collect();
        let alone = context.entry.is_none() && !context.sites.is_empty();
        let mut found = Coverage { without_entry: usize::from(alone), ..Coverage::default() };
        let mut uncalled: BTreeMap<&str, usize> = BTreeMap::new();
        for site in context.sites.iter().filter(|site| site.reachable) {
            found.movements += 1;
            let mut failed = site.executions.iter().filter_map(|step| context.record(*step));
            let reason = if context.model.is_none() {
                "no robot is named (--robot NAME)"
            } else if left.contains(&site.stmt.span) {
                "the program does not tell where they go, or the robot does not get there: \
                 joulepath simulate tells which"
            } else if site.executions.is_empty() {
                let name = context.program.routine(site.place.0).name.text.as_str();
                *uncalled.entry(name).or_default() += 1;
                continue;
            } else if failed.any(|(run, ..)| run.problem.is_some()) {
                "the robot cannot follow their path as programmed"
            } else {
                found.simulated += 1;
                continue;
            };
            *found.missing.entry(reason.to_owned()).or_default() += 1;
        }
        if !uncalled.is_empty() {
            let names: Vec<&str> = uncalled.keys().copied().take(MAX_NAMES).collect();
            let more = if uncalled.len() > MAX_NAMES { ", …" } else { "" };
            let reason = format!("the simulated run does not come by ({}{more})", names.join(", "));
            found.missing.insert(reason, uncalled.values().sum());
        }
        found
    }

    /// Adds the movements of another program.
    pub(super) fn add(&mut self, other: Coverage) {
        self.movements += other.movements;
        self.simulated += other.simulated;
        self.without_entry += other.without_entry;
        for (reason, count) in other.missing {
            *self.missing.entry(reason).or_default() += count;
        }
    }

    /// A sentence where not all movements are simulated.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        let reasons: Vec<String> =
            self.missing.iter().map(|(reason, count)| format!("{count}: {reason}")).collect();
        (self.simulated < self.movements).then(|| {
            format!(
                "{} of {} movements simulated; {}",
                self.simulated,
                self.movements,
                reasons.join("; ")
            )
        })
    }
}

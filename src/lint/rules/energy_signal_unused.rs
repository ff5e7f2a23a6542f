//! The controller has a signal for energy saving that nothing uses.
//!
//! ## What it does
//! Finds signals in the `EIO.cfg` of a backup whose name or label speaks of energy saving, that
//! are tied to no system input or output, no cross connection, and no statement of the program.
//!
//! ## Why it wastes energy
//! Somebody meant the cell to save energy in breaks; it does not.
//!
//! ## How the saving is computed
//! There is none to tell: how long the breaks are, the backup does not say.
//!
//! ## Example
//! ```text
//! -Name "diSyEnEnSav" -SignalType "DI" -Label "System Enable Energy Saving"
//! ```
//!
//! ## Use instead
//! Tie the signal to the system action or to the PLC that starts breaks.
//!
//! ## Safety
//! Without a fix.
//!
//! ## Assumptions
//! What the configuration names once is used by nothing in it.

use super::super::context::Context;
use super::super::finding::Finding;
use crate::ir::signals::signals;

rule!("EW802", "energy-signal-unused", System, Backup, Info, "energy_signal_unused.rs");

/// Parts of names and labels of such signals.
const SAVING: [&str; 5] = ["energy sav", "energysav", "enensav", "energy_sav", "energiespar"];

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(system) = context.system else { return };
    let used = signals(context.program);
    for signal in system.signals(context.files) {
        let text = format!("{} {}", signal.name, signal.label).to_lowercase();
        let saves = SAVING.iter().any(|part| text.contains(part));
        if !saves
            || used.contains_key(&signal.name.to_lowercase())
            || system.mentions(context.files, &signal.name) > 1
        {
            continue;
        }
        let message = format!("{} is there to save energy, and nothing uses it", signal.name);
        findings.push(Finding::new(&RULE, signal.span, message));
    }
}

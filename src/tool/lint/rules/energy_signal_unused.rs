//! The controller has a signal for energy saving that nothing uses.
//!
//! ## What it does
//! Finds signals in the `EIO.cfg` of a backup whose name or label speaks of energy saving, that
//! are tied to no system input or output, no cross connection, and no statement of any task. A
//! backup says nowhere else what a signal is for, so the words of its name and label decide.
//!
//! ## Why it wastes energy
//! Somebody meant the cell to save energy in breaks; it does not.
//!
//! ## How the saving is computed
//! There is none: the backup does not say how long the breaks are.
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
//! A signal that the configuration names only in its declaration is not used by the configuration.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::words;

rule!("EW802", "energy-signal-unused", System, Backup, Info, "energy_signal_unused.rs");

/// Words for saving in names and labels that mention energy.
const SAVING: [&str; 4] = ["sav", "spar", "ahorr", "risparm"];
/// Words for saving energy, also as in a controller's own signals.
const SHORT: [&str; 4] = ["enensav", "powersav", "power sav", "profienergy"];

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(system) = context.system else { return };
    for signal in system.signals(context.files) {
        let text = format!("{} {}", signal.name, signal.label).to_lowercase();
        let says = |words: &[&str]| words.iter().any(|word| text.contains(word));
        let saves = text.contains("energ") && says(&SAVING) || says(&SHORT);
        // Any task of the controller may use it.
        let key = signal.name.to_lowercase();
        let others = context.files.iter().filter(|file| Some(file.id) != system.io);
        let used = || others.map(|file| words::in_file(file, &key)).sum::<usize>() > 0;
        if !saves || system.is_tied(context.files, &signal.name) || used() {
            continue;
        }
        let message = format!("{} is there to save energy, and nothing uses it", signal.name);
        findings.push(Finding::new(&RULE, signal.span, message));
    }
}

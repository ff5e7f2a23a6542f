//! `docs/effects.md` agrees with the register of effects.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use joulepath::arm::effects::{ALL, Channel, Scope};

#[test]
fn the_effects_page_agrees_with_the_register() {
    let fresh = page();
    let written = fs::read_to_string("docs/effects.md").unwrap_or_default();
    if fresh != written {
        let to = Path::new(env!("CARGO_TARGET_TMPDIR")).join("effects.md");
        fs::write(&to, fresh).unwrap();
        panic!("docs/effects.md is not what the register says; copy {} there", to.display());
    }
}

/// The text of `docs/effects.md`.
fn page() -> String {
    let mut out = String::from(
        "# Effects\n\nWhat robots and their logs have beyond rigid bodies and plain friction, from \
         the register\n(`src/arm/effects/register.rs`). Names, units and bounds are those of \
         `[effects.ID]` in robot files and of\nthe JSON of `diagnose`; values are changes against \
         the nominal model.\n",
    );
    for (channel, title) in [
        (Channel::Torque, "Torques"),
        (Channel::Motion, "Motion"),
        (Channel::Power, "Electrical power"),
    ] {
        let _ = writeln!(out, "\n## {title}");
        for effect in ALL.iter().filter(|effect| effect.channel == channel) {
            let scope = match effect.scope {
                Scope::Joint => "of joints",
                Scope::Robot => "of the robot",
            };
            let _ =
                writeln!(out, "\n### {}\n\n{}, {scope}. `{}`", effect.id, effect.title, effect.law);
            let _ = writeln!(out, "\nSource: {}.", effect.source);
            if !effect.parameters.is_empty() {
                out.push_str("\n| parameter | unit | what | from | to |\n|---|---|---|---|---|\n");
            }
            for parameter in effect.parameters {
                let [low, high] = parameter.bounds.map(|bound| {
                    if bound.is_finite() { bound.to_string() } else { "–".to_owned() }
                });
                let _ = writeln!(
                    out,
                    "| `{}` | {} | {} | {low} | {high} |",
                    parameter.name, parameter.unit, parameter.what
                );
            }
            if !effect.confused.is_empty() {
                let list: Vec<String> =
                    effect.confused.iter().map(|id| format!("`{id}`")).collect();
                let _ = writeln!(out, "\nConfused with {}.", list.join(", "));
            }
            let _ = writeln!(out, "\nInspect {}.", effect.inspect);
            let [options, why] = effect.experiment;
            if !why.is_empty() {
                let with = if options.is_empty() {
                    String::new()
                } else {
                    format!(" (`excite {options}`)")
                };
                let _ = writeln!(out, "\nTold apart by: {why}{with}.");
            }
        }
    }
    out
}

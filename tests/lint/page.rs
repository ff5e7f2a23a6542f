//! The page about all rules, `docs/lints.md`.

use std::fmt::Write as _;

use joulepath::tool::lint::{ALL, Needs};

/// Beginning of the page.
const HEAD: &str = "# Lints

What `joulepath lint` finds, from the rules' own files (`src/tool/lint/rules`); `joulepath rule CODE`
shows one of them. A test keeps this page fresh.

**Savings** are the difference of two simulated cycles, with and without the change that the
message names. They are given per simulated cycle. The interval holds what the change saves in 90 % of
the robots that are as plausible as the one given (docs/energy.md): it is wide for an estimated
robot, narrow for an identified or a calibrated one. Without a robot, without dynamics, and for
statements that the simulated cycle does not run, no saving is given: `saving_j` is null. Findings whose saving is below the
threshold (1 J, `--threshold`, or `[lint]` of the configuration) are not reported, and neither is a
change that saves nothing or whose interval reaches below zero.

**Fixes** are *safe* where path, order and end points provably stay, else *unsafe*. `--fix` applies
safe ones, `--unsafe-fixes` both, `--diff` shows what they would do. Before a fix is offered, it is made
in the text and the whole program is simulated again: it is not offered where the cycle takes more energy, or
where targets, waits and outputs are not the same in the same order at the same places. So fixes need a
robot. Where only the person who knows the cell can tell waste from a need of the process, a rule offers
none.

**Work** is an output, a wait, another tool or load, and everything else that may need a robot that stands.
Directly before and behind work no rule proposes to leave out a movement or to give it a zone: it may be the
lift behind a grip. Only EW104 does so for a stop whose one purpose is an output, as a finding of low confidence without a
fix. A **process** is a movement below 200 mm/s, or one with an output that is on for lines and arcs alone and holds no
part: no rule changes its speed.

**Severity** follows joules and confidence: a saving of at least 1 % of the cycle is a warning, a smaller one
information. A finding of low confidence is information whatever it saves. Findings without joules have the
severity of their rule.

**What to fix first**: the text ends with a list by joules of a cycle, with the kilowatt hours and the
price of a year (`--top N`, `--hours`, `--price`); `top` in the JSON. Findings of low confidence come last. \"Up
to\" marks what a fixed wait takes: how much of it can be saved only the cell knows.

**What is simulated**: the entry of the program; where it is missing or moves nothing, each procedure with
movements that no other one calls; and where it is a menu, each procedure that it may call and that the
simulated run did not come by. A cycle is then one run of each of them; what runs only after errors and at
interrupts is no part of it. Where not all movements are simulated, the last line says how many are, and why
the others are not.

**Comments** take findings back: `! joulepath: ignore EW101 reason`, at the end of the statement's
first line or on a line of its own above it.

**Configuration**, in `joulepath.toml`:

```toml
[lint]
select = [\"ALL\"]              # codes, starts of codes (EW1), names, families
ignore = [\"EW703\"]
threshold-j = 1.0
max-waste = \"3%\"              # or \"500J\": exit code 1 where more is wasted
baseline = \"baseline.json\"    # made by --write-baseline
[lint.per-file-ignores]
\"*.sys\" = [\"stops\"]
[lint.thresholds-j]
EW101 = 5.0
```
";

pub(crate) fn page() -> String {
    let mut out = String::from(HEAD);
    // The rules are in the order of their families.
    for rules in ALL.chunk_by(|a, b| a.family == b.family) {
        let _ = write!(
            out,
            "\n## {}\n\n| code | name | finds | needs |\n|---|---|---|---|\n",
            rules[0].family.name()
        );
        for rule in rules {
            let needs = match rule.needs {
                Needs::Text => "–",
                Needs::Robot => "a robot",
                Needs::Backup => "a backup",
            };
            let _ = writeln!(
                out,
                "| [{code}](#{anchor}-{name}) | {name} | {summary} | {needs} |",
                code = rule.code,
                anchor = rule.code.to_lowercase(),
                name = rule.name,
                summary = rule.summary(),
            );
        }
        for rule in rules {
            // Headings of a manual are two levels below the family.
            let manual = rule.manual().replace("\n## ", "\n#### ");
            let _ = write!(out, "\n### {} {}\n\n{manual}", rule.code, rule.name);
        }
    }
    out
}

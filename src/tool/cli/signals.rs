//! Checks the signals of the command line against the program.

use std::collections::BTreeMap;

use anyhow::bail;

use super::common::{CellArgs, Job};
use crate::arm::robot::nearest;
use crate::rapid::builtins::{SignalKind, instruction};
use crate::rapid::ir::hir::{Arg, Call, Callee, ExprKind, StmtKind};
use crate::rapid::ir::program::Program;
use crate::rapid::ir::signals::{Signal, signals};
use crate::retime::motion::Simulation;
use crate::tool::retrofit::read_program;

/// Checks the signal names of `--assume` and `--input`, and the levels. `--assume` also states answers of
/// the operator.
pub(super) fn check(
    args: &CellArgs,
    levels: &BTreeMap<String, f64>,
    program: &Program,
) -> anyhow::Result<()> {
    let known = signals(program);
    let answers = answers(program);
    for (option, texts) in [("--assume", &args.levels), ("--input", &args.inputs)] {
        for text in texts {
            let name = signal_name(text);
            let key = name.to_lowercase();
            let is_answer = option == "--assume" && answers.contains_key(&key);
            if !known.contains_key(&key) && !is_answer {
                let names = known.values().map(|signal| signal.name.as_str());
                let names = names.chain(answers.values().copied());
                let way_out = nearest(name, names).map_or_else(
                    || "leave it out or correct the name".to_owned(),
                    |near| format!("did you mean {near}?"),
                );
                bail!("{option} {text}: the program names no signal '{name}'; {way_out}");
            }
        }
    }
    for (key, level) in levels {
        let Some(Signal { name, kind: Some(kind) }) = known.get(key) else { continue };
        let (fits, what) = match kind {
            SignalKind::Digital => {
                (*level == 0.0 || *level == 1.0, "a digital signal; its level is 0 or 1")
            }
            SignalKind::Group => (
                *level >= 0.0 && level.fract() == 0.0,
                "a group of signals; its level is a whole number from 0",
            ),
            SignalKind::Analog => (level.is_finite(), "an analogue signal; its level is a number"),
        };
        if !fits {
            bail!("--assume {name}={level}: {name} is {what}");
        }
    }
    Ok(())
}

/// The data that instructions ask the operator for, by lower-case name.
fn answers(program: &Program) -> BTreeMap<String, &str> {
    let statements = program.routines().flat_map(|(_, routine)| routine.statements());
    let asked = statements.filter_map(|stmt| {
        let StmtKind::Call(Call { callee: Callee::Name(name), args, .. }) = &stmt.kind else {
            return None;
        };
        instruction(&name.key).filter(|it| it.asks_operator())?;
        match &args.iter().find_map(Arg::positional)?.kind {
            ExprKind::Ref(data) => Some((data.key.clone(), data.text.as_str())),
            _ => None,
        }
    });
    asked.collect()
}

/// The same for a program that is not read yet.
pub(super) fn check_job(args: &CellArgs, job: &Job) -> anyhow::Result<()> {
    if args.levels.is_empty() && args.inputs.is_empty() {
        return Ok(());
    }
    let (program, _) = read_program(&job.files, &job.entry)?;
    check(args, &job.options.levels, &program)
}

/// The signal of an option `SIGNAL=VALUE`.
fn signal_name(text: &str) -> &str {
    text.split('=').next().unwrap_or_default().trim()
}

/// Notes on levels that the simulated cycle did not use.
pub(super) fn unused_levels(args: &CellArgs, simulation: &Simulation) -> Vec<String> {
    let is_used = |name: &&str| {
        let begin = format!("{} is ", name.to_lowercase());
        simulation.assumed.iter().any(|text| text.to_lowercase().starts_with(&begin))
    };
    let unused = args.levels.iter().map(|text| signal_name(text)).filter(|name| !is_used(name));
    unused
        .map(|name| format!("the cycle does not ask for the level of {name}: it is not used"))
        .collect()
}

//! `--next`: the experiment that decides between what is left.

use std::path::Path;

use anyhow::bail;

use super::super::common;
use super::super::excite::{ExperimentArgs, Written, cell, next_experiment};
use super::super::logs::PreparedLog;
use super::args::DiagnoseArgs;
use crate::arm::robot::Model;
use crate::gap::{Diagnosis, Rival, Rivals, Separation};
use crate::tool::report::diagnose::{Experiment, Outcome, quoted};

/// Nats from which on one explanation is told from another: odds of 100 to 1.
const TOLD: f64 = 4.6;
/// The log that the written RAPID makes.
const LOG: &str = "joulepath_log.csv";

/// Refuses what `--next` cannot do, before the long search.
pub(super) fn check(args: &DiagnoseArgs, model: &Model) -> anyhow::Result<()> {
    if let Some(out) = &args.next {
        if out.is_file() {
            bail!("--next {}: this is a file; name a folder", out.display());
        }
        common::require_six_joints(model, "the RAPID of --next is written for robots with 6")?;
        // A plane that is wrong is told before the long search.
        cell(&args.experiment, model)?;
    } else if args.experiment != ExperimentArgs::default() {
        bail!(
            "--plane, --box, --tool, --load and --torque are those of the next experiment: add --next DIR"
        );
    }
    Ok(())
}

/// The next experiment, where one is left to be made: written with `--next`, else the command that
/// writes it.
pub(super) fn experiment(
    args: &DiagnoseArgs,
    model: &Model,
    logs: &[PreparedLog],
    found: &Diagnosis,
) -> anyhow::Result<Option<Experiment>> {
    let rivals = found.rivals.as_ref();
    if !found.is_open() {
        let text = "nothing is left to tell apart: no experiment is written";
        common::note(args.quiet || args.next.is_none(), text);
        return Ok(None);
    }
    let Some(out) = &args.next else {
        // RAPID is written for robots with 6 joints.
        let command = if model.dof == 6 {
            format!("{} --next next", again(args, None))
        } else {
            String::new()
        };
        return Ok(Some(Experiment { why: why(rivals), command, ..Experiment::default() }));
    };
    let model = within_logged(model, logs);
    let written = next_experiment(out, &args.experiment, &model, rivals, args.quiet)?;
    let Written { seconds, cycles, separation, outputs } = written;
    let folder = out.display();
    let why = format!(
        "{}: {seconds:.0} s of motion, {cycles} repetitions, in '{folder}'; run it as warm as the robot \
         was in the logs, and diagnose its log with the others",
        why(rivals)
    );
    let outcomes = match (rivals, &separation) {
        (Some(rivals), Some(separation)) => outcomes(rivals, separation),
        _ => Vec::new(),
    };
    Ok(Some(Experiment { why, command: again(args, Some(out)), cycles, outcomes, outputs }))
}

fn why(rivals: Option<&Rivals>) -> String {
    match rivals.filter(|of| of.all.len() > 1) {
        Some(of) => {
            let names: Vec<String> = of.all.iter().map(name).collect();
            let text = format!("to tell apart {}", names.join("; "));
            // What no motion of an optimiser shows.
            let first = of.all[0].effects.first().map(|(effect, _)| effect);
            match first.filter(|effect| !effect.experiment[1].is_empty()) {
                Some(effect) => format!("{text} ({} shows: {})", effect.id, effect.experiment[1]),
                None => text,
            }
        }
        None => "no law is near: a motion that shows all parameters".to_owned(),
    }
}

fn name(of: &Rival) -> String {
    if of.effects.is_empty() {
        return "everyday errors alone".to_owned();
    }
    let one = |(effect, joints): &(&crate::arm::effects::Effect, Vec<usize>)| {
        let joints: Vec<String> = joints.iter().map(|joint| (joint + 1).to_string()).collect();
        match joints.len() {
            0 => effect.id.to_owned(),
            _ => format!("{} of joint {}", effect.id, joints.join(", ")),
        }
    };
    of.effects.iter().map(one).collect::<Vec<_>>().join(" with ")
}

/// What the new log would show by each explanation.
fn outcomes(rivals: &Rivals, separation: &Separation) -> Vec<Outcome> {
    let all = rivals.all.iter().enumerate();
    all.filter_map(|(a, of)| {
        let b = separation.nearest(a)?;
        let nats = separation.between(a, b);
        let (joint, rms) = separation.most[a][b];
        let other = name(&rivals.all[b]);
        let told = if nats >= TOLD { "is told from" } else { "is hardly told from" };
        Some(Outcome {
            truth: name(of),
            so_far_nats: of.score,
            nats,
            text: format!(
                "it {told} {other} by {nats:.0} nats, by {rms:.3} Nm rms at joint {}",
                joint + 1
            ),
        })
    })
    .collect()
}

/// The model with limits: those that its file lacks are the largest values that were logged.
fn within_logged(model: &Model, logs: &[PreparedLog]) -> Model {
    let blocks = || logs.iter().flat_map(|log| &log.samples.blocks);
    let largest = |of: fn(&crate::learn::identify::Block) -> &Vec<Vec<f64>>| -> Vec<f64> {
        let most = |joint: usize| {
            blocks().flat_map(|block| &of(block)[joint]).fold(0.0, |most: f64, x| most.max(x.abs()))
        };
        (0..model.dof).map(most).collect()
    };
    let mut within = model.clone();
    within.limits.velocity.get_or_insert_with(|| largest(|block| &block.qd));
    within.limits.acceleration.get_or_insert_with(|| largest(|block| &block.qdd));
    within
}

/// The command of this diagnosis, with the log of the experiment.
fn again(args: &DiagnoseArgs, next: Option<&Path>) -> String {
    let mut words = vec!["joulepath".to_owned(), "diagnose".to_owned()];
    let mut push = |option: &str, values: Vec<String>| {
        if !values.is_empty() {
            words.push(option.to_owned());
            words.extend(values.iter().map(|value| quoted(value)));
        }
    };
    let shown = |paths: &[std::path::PathBuf]| -> Vec<String> {
        paths.iter().map(|path| path.display().to_string()).collect()
    };
    push("--robot", vec![args.robot.clone()]);
    let new = next.map(|folder| folder.join(LOG).display().to_string());
    push("--log", shown(&args.log).into_iter().chain(new).collect());
    push("--heldout", shown(&args.heldout));
    push("--baseline", shown(&args.baseline));
    if let Some(trust) = args.trust {
        push("--trust", vec![trust.name().to_owned()]);
    }
    push("--effects", args.effects.iter().cloned().collect());
    push("--map", Some(args.map.clone()).filter(|map| !map.is_empty()).into_iter().collect());
    push("--period", args.period.map(|period| period.to_string()).into_iter().collect());
    words.join(" ")
}

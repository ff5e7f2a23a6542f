//! `joulepath diff`: what changed in meaning between two programs.

mod git;
mod side;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use self::side::{Named, Read, named, of_working_tree, read};
use super::common::{self, CellArgs, Format, ProgramArgs};
use super::{output, signals};
use crate::arm::effects;
use crate::arm::robot::Model;
use crate::rapid::ir::lower;
use crate::rapid::ir::program::Program;
use crate::rapid::syntax;
use crate::rapid::text::{FileId, SourceFile};
use crate::retime::energy::plausible::Robots;
use crate::retime::motion::Options;
use crate::tool::compare::{Robot, compare, meaning};
use crate::tool::report::comparison::{Compared, json, text};
use crate::tool::report::html::comparison_report;

/// Compare two programs: what changed in meaning, and what a cycle takes more or less.
#[derive(Debug, Args)]
#[command(
    mut_arg("paths", |arg| arg.required(false).value_name("OLD NEW").help(
        "Two files, folders, .pgf programs, controller backups, or git revisions: REV or REV:PATH"
    )),
    after_help = "Left out: headers, comments, layout, case, the order of declarations, the form of \
    numbers, and values of PERS that define no motion, which a controller saves with a program.\n\n\
    A revision without a path has the path of the other side. With --git REV, the only path (or the \
    present folder) is compared with itself at that revision.\n\n\
    Exit codes: 0 the same meaning, 1 differences, 2 where nothing can be read.\n\n\
    Examples: joulepath diff old.mod new.mod --robot IRB1600-10/1.45\n          \
    joulepath diff --git HEAD cell --report diff.html\n          \
    joulepath diff v1.2:cell/Main.mod cell/Main.mod"
)]
pub(super) struct DiffArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// Compare the working tree with this revision.
    #[arg(long, value_name = "REV")]
    git: Option<String>,

    /// Print the meaning of one file as text, for a textconv of git.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["git", "report", "paths"])]
    textconv: Option<PathBuf>,

    /// Write a report as one HTML file: figures of the cycle, changes with both sources.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

pub(super) fn run(args: &DiffArgs) -> anyhow::Result<ExitCode> {
    if let Some(path) = &args.textconv {
        return print_meaning(path);
    }
    let quiet = args.program.cell.quiet;
    let [old, new] = sides(args)?;
    let near = [&new, &old].into_iter().find_map(|side| side.path.clone());
    let cell = CellArgs {
        paths: vec![near.unwrap_or_else(|| PathBuf::from("."))],
        ..args.program.cell.clone()
    };
    let (config, folder) = common::configuration(&cell)?;
    let stated = cell.entry.clone().or_else(|| config.entry.clone());
    let [old, new] = [read(old, stated.as_deref())?, read(new, stated.as_deref())?];
    for side in [&old, &new] {
        common::notes(quiet, &side.notes);
    }
    output::refuse_inputs(
        &[("--report", args.report.as_ref())],
        [&old, &new].into_iter().flat_map(|side| &side.files).map(PathBuf::as_path),
    )?;
    let (model, unknown) = match common::robot_name(&cell, &config, &folder) {
        Some(name) => (Some(effects::load_estimated(&name)?), String::new()),
        None => match of_backups(&[&new, &old], quiet) {
            Ok(model) => (Some(model), String::new()),
            Err(why) => (None, why),
        },
    };
    if let Some(model) = &model {
        common::require_six_joints(model, common::RUN_SIX_JOINTS)?;
    }
    let (options, _) = common::simulation_options(&cell, &config, model.as_ref())?;
    let options = common::with_overrides(&args.program, options)?;
    signals::check(&cell, &options.levels, &all(&[&old, &new]))?;
    let robots = model.as_ref().filter(|_| !args.program.point_estimate).and_then(Robots::new);
    let robot = robot(model.as_ref(), &options, robots.as_ref(), &unknown);
    let comparison = compare(&old.side, &new.side, robot);
    let of = Compared {
        comparison: &comparison,
        names: [&old.name, &new.name],
        files: [&old.side.files, &new.side.files],
        robot: model.as_ref().map(|model| model.name.as_str()),
    };
    if let Some(path) = &args.report {
        output::write(path, comparison_report(of)?.as_bytes())?;
    }
    if args.program.format == Format::Text {
        common::notes(quiet, of.notes());
    }
    common::print(args.program.format, || json(of), || text(of))?;
    Ok(ExitCode::from(u8::from(!comparison.changes.is_empty())))
}

/// Both sides, as named.
fn sides(args: &DiffArgs) -> anyhow::Result<[Named; 2]> {
    let paths = &args.program.cell.paths;
    match (&args.git, paths.as_slice()) {
        (Some(revision), []) => of_working_tree(revision, Path::new(".")),
        (Some(revision), [path]) => of_working_tree(revision, path),
        (Some(_), _) => bail!("--git REV compares one path with itself at that revision: name one"),
        (None, [old, new]) => named(old, new),
        (None, _) => {
            bail!("diff compares two programs: name the old and the new one, or one with --git REV")
        }
    }
}

fn robot<'r>(
    model: Option<&'r Model>,
    options: &'r Options,
    plausible: Option<&'r Robots>,
    unknown: &'r str,
) -> Robot<'r> {
    match model {
        Some(model) => Robot::Known { model, options, plausible },
        None => Robot::Unknown(unknown),
    }
}

/// The robot of the first controller backup that names one, or why there is none.
fn of_backups(sides: &[&Read], quiet: bool) -> Result<Model, String> {
    let Some((root, name)) = sides.iter().find_map(|side| side.robot.as_ref()) else {
        return Err("no robot is known: name it with --robot NAME or in joulepath.toml".to_owned());
    };
    let model = effects::load_estimated(name)
        .map_err(|error| format!("the robot of the backup is a {name}: {error}"))?;
    Ok(common::with_backup_configuration(root, model, quiet))
}

/// The modules of both sides, for the names of their signals.
fn all(sides: &[&Read]) -> Program {
    let files = sides.iter().flat_map(|side| &side.side.files);
    let modules = files.flat_map(|file| lower(file.id, &syntax::parse(&file.bytes), &file.bytes));
    Program::new(modules.collect())
}

fn print_meaning(path: &Path) -> anyhow::Result<ExitCode> {
    let shown = path.display().to_string();
    let bytes = std::fs::read(path)
        .with_context(|| format!("cannot read '{shown}'; --textconv needs one file"))?;
    let text = meaning(&SourceFile::new(FileId(0), shown, bytes));
    std::io::stdout().lock().write_all(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

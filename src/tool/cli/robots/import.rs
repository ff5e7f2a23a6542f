//! `joulepath robots import`: converts a robot's own files to Robot TOML.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use crate::arm::robot::{from_toml, import_moc, import_urdf};
use crate::rapid::text;
use crate::tool::cli::backup::motion_configuration;
use crate::tool::cli::common::notes;
use crate::tool::cli::output;

/// What to import, and where to.
#[derive(Debug, Args)]
pub(super) struct ImportArgs {
    /// A URDF, a controller's MOC.cfg, or a backup folder.
    source: PathBuf,

    /// The mechanical unit, where a controller has several robots.
    #[arg(long, value_name = "NAME")]
    unit: Option<String>,

    /// The Robot TOML to write; otherwise it goes to standard output.
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,
}

pub(super) fn run(args: &ImportArgs) -> anyhow::Result<ExitCode> {
    let path = configuration(&args.source)?;
    output::refuse_inputs(&[("--out", args.out.as_ref())], [path.as_path()])?;
    let shown = path.display().to_string();
    let bytes =
        fs::read(&path).with_context(|| format!("cannot read '{shown}'; check the path"))?;
    let text = text::decode(&bytes).text;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let imported = match extension.to_ascii_lowercase().as_str() {
        "urdf" => import_urdf(&shown, &text)?,
        "cfg" => import_moc(&shown, &text, args.unit.as_deref())?,
        _ => bail!("'{shown}': give a file that ends in .urdf or .cfg, or a backup folder"),
    };
    // Checks that the output can be loaded.
    let model = from_toml(&shown, &imported)?;
    notes(false, model.assumed());
    match &args.out {
        Some(out) => output::write(out, imported.as_bytes())?,
        None => std::io::stdout().lock().write_all(imported.as_bytes())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// The file itself, or the motion configuration of a backup.
fn configuration(source: &Path) -> anyhow::Result<PathBuf> {
    if !source.is_dir() {
        return Ok(source.to_path_buf());
    }
    motion_configuration(source).with_context(|| {
        format!("'{}' has no SYSPAR/MOC.cfg; give a backup folder or a file", source.display())
    })
}

//! `campaign.toml`: what a campaign is about.

use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::{Deserialize, Serialize};

use crate::tool::cli::output;

/// The state of a campaign; what is done shows in its folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct State {
    /// The program.
    pub(super) program: String,
    /// The robot, if no configuration names it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) robot: Option<String>,
    /// Share of cycles that may become longer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) risk: Option<String>,
}

const HEAD: &str = "# A campaign of joulepath: joulepath campaign FOLDER goes on with it.\n";

impl State {
    pub(super) fn path(folder: &Path) -> PathBuf {
        folder.join("campaign.toml")
    }

    pub(super) fn read(folder: &Path) -> anyhow::Result<State> {
        let path = State::path(folder);
        let text = std::fs::read_to_string(&path).with_context(|| {
            format!("'{}' is no campaign yet: begin it with --program PATH", folder.display())
        })?;
        toml::from_str(&text).with_context(|| {
            format!("{}: known keys are program, robot and risk; correct the file", path.display())
        })
    }

    pub(super) fn write(&self, folder: &Path) -> anyhow::Result<()> {
        let text = HEAD.to_owned() + &toml::to_string(self)?;
        output::write(&State::path(folder), text.as_bytes())
    }
}

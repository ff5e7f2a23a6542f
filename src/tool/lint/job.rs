//! What is linted, and how.

use super::group::Group;
use super::settings::Settings;
use crate::arm::robot::Model;
use crate::rapid::text::{FileId, SourceFile};
use crate::retime::motion::Options;

/// What is linted.
pub struct Job<'j> {
    /// The files; their ids count from 0.
    pub files: &'j [SourceFile],
    /// Which belong together.
    pub groups: Vec<Group>,
    /// The robot.
    pub model: Option<&'j Model>,
    /// How programs are simulated.
    pub options: Options,
    /// What the user asks.
    pub settings: &'j Settings,
}

/// Programs as they were read, with all that a [`Job`] needs.
#[derive(Default)]
pub struct Programs {
    /// The files; their ids count from 0.
    pub files: Vec<SourceFile>,
    /// Which belong together.
    pub groups: Vec<Group>,
    /// The robot.
    pub model: Option<Model>,
    /// How programs are simulated.
    pub options: Options,
    /// What the user asks.
    pub settings: Settings,
}

impl Programs {
    /// Adds a file to the first group; its index.
    pub fn add(&mut self, file: SourceFile) -> usize {
        let index = self.files.len();
        self.files.push(SourceFile { id: FileId(index as u32), ..file });
        if self.groups.is_empty() {
            let entry = "main".to_owned();
            self.groups.push(Group { files: Vec::new(), entry, system: None });
        }
        self.groups[0].files.push(index);
        index
    }

    /// All of it, to be linted.
    #[must_use]
    pub fn job(&self) -> Job<'_> {
        Job {
            files: &self.files,
            groups: self.groups.clone(),
            model: self.model.as_ref(),
            options: self.options.clone(),
            settings: &self.settings,
        }
    }
}

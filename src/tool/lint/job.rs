//! The input of a lint run.

use super::group::Group;
use super::settings::Settings;
use crate::arm::robot::Model;
use crate::rapid::text::{FileId, SourceFile};
use crate::retime::motion::Options;

/// The input of a lint run.
pub struct Job<'j> {
    /// The files; their ids count from 0.
    pub files: &'j [SourceFile],
    /// Groups of files that belong together.
    pub groups: Vec<Group>,
    /// The robot.
    pub model: Option<&'j Model>,
    /// Options of the simulations.
    pub options: Options,
    /// Settings of the user.
    pub settings: &'j Settings,
}

/// Programs with all data that a [`Job`] needs.
#[derive(Default)]
pub struct Programs {
    /// The files; their ids count from 0.
    pub files: Vec<SourceFile>,
    /// Groups of files that belong together.
    pub groups: Vec<Group>,
    /// The robot.
    pub model: Option<Model>,
    /// Options of the simulations.
    pub options: Options,
    /// Settings of the user.
    pub settings: Settings,
}

impl Programs {
    /// Adds a file to the first group; returns its index.
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

    /// The job that lints all of it.
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

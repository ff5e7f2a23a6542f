//! A program and its robot, to be simulated as they are and with edits.

use super::error::RetrofitError;
use super::files::{Source, by_file};
use super::read::read_program;
use super::simulated::Simulated;
use crate::arm::robot::Model;
use crate::rapid::text::{Edit, EditError};
use crate::retime::motion::Options;

/// A program and its robot.
#[derive(Clone, Copy)]
pub struct Cell<'a> {
    /// Its files, by id.
    pub files: &'a [Source],
    /// The routine that starts it.
    pub entry: &'a str,
    /// The robot.
    pub model: &'a Model,
    /// Options of the simulation.
    pub options: &'a Options,
}

impl Cell<'_> {
    /// One cycle with its energy.
    pub(in crate::tool) fn simulated(&self) -> Result<Simulated, RetrofitError> {
        let (program, entry) = read_program(self.files, self.entry)?;
        Ok(Simulated::new(&program, entry, self.model, self.options))
    }

    /// The files with edits of their text.
    pub(in crate::tool) fn edited(
        &self,
        edits: impl IntoIterator<Item = Edit>,
    ) -> Result<Vec<Source>, EditError> {
        let mut files = self.files.to_vec();
        for (index, edits) in by_file(edits) {
            files[index].file = files[index].file.edited(&edits)?;
        }
        Ok(files)
    }
}

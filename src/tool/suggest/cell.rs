//! A program whose text is changed, simulated as a whole.

use crate::arm::robot::Model;
use crate::rapid::syntax;
use crate::rapid::text::{Edit, SourceFile, apply};
use crate::retime::motion::Options;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::path::joint_path::{Joints, are_close};
use crate::tool::retrofit::{RetrofitError, Simulated, Source, read_program};

/// Largest distance of equal positions, rad.
const SAME_PLACE: f64 = 1e-4;
/// Rounding of a time, s.
const TIME_TOLERANCE: f64 = 1e-6;

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

/// Where the robot has to be for what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Places {
    /// At the same places as before at every wait and output, and at the end.
    Same,
    /// Elsewhere where it waits or ends, as the change wants it.
    Other,
}

impl Cell<'_> {
    /// The program as it is.
    ///
    /// # Errors
    /// It cannot be read.
    pub(super) fn cycle(&self) -> Result<Simulated, RetrofitError> {
        self.cycle_of(self.files)
    }

    fn cycle_of(&self, files: &[Source]) -> Result<Simulated, RetrofitError> {
        let (program, entry) = read_program(files, self.entry)?;
        Ok(Simulated::new(&program, entry, self.model, self.options))
    }

    /// The files with edits; `None` if these overlap or break the syntax.
    pub(super) fn edited(&self, edits: &[Edit]) -> Option<Vec<Source>> {
        let mut files = self.files.to_vec();
        for (index, source) in files.iter_mut().enumerate() {
            let of = |edit: &&Edit| edit.span.file.0 as usize == index;
            let own: Vec<Edit> = edits.iter().filter(of).cloned().collect();
            if own.is_empty() {
                continue;
            }
            let bytes = apply(&source.file.bytes, &own).ok()?;
            let errors = |bytes: &[u8]| syntax::parse(bytes).errors.len();
            if errors(&bytes) > errors(&source.file.bytes) {
                return None;
            }
            let stored = source.file.stored(&bytes).into_owned();
            source.file = SourceFile::new(source.file.id, source.file.path.clone(), stored);
        }
        Some(files)
    }

    /// The cycle after edits, if it does the same work without new problems in no more time.
    pub(super) fn after(
        &self,
        before: &Simulated,
        edits: &[Edit],
        places: Places,
    ) -> Option<Simulated> {
        let after = self.cycle_of(&self.edited(edits)?).ok()?;
        let is_sound = after.problems() <= before.problems()
            && after.simulation.cycle_s <= before.simulation.cycle_s + TIME_TOLERANCE
            && same_work(&before.simulation.events, &after.simulation.events, places);
        is_sound.then_some(after)
    }
}

/// Whether both cycles have the same waits and outputs in the same order, at the same places if these
/// have to stay.
fn same_work(before: &[Event], after: &[Event], places: Places) -> bool {
    let (a, b) = (work(before), work(after));
    let same_place =
        |a: &Joints, b: &Joints| places == Places::Other || are_close(a, b, SAME_PLACE);
    a.len() == b.len()
        && a.iter().zip(&b).all(|((a, at), (b, there))| a == b && same_place(at, there))
}

/// The waits and outputs at rest with their places, and the end; outputs in motion without a place.
fn work(events: &[Event]) -> Vec<(String, Joints)> {
    let mut q = [0.0; 6];
    let mut all = Vec::new();
    for event in events {
        match &event.what {
            What::Run(run) => q = run.end,
            What::Wait(wait) => {
                let of = &wait.wait;
                let length = of.duration.unwrap_or_default();
                all.push((format!("{} {:?} {length}", of.instruction, of.signal), wait.q));
            }
            What::Output(output, 0) => {
                all.push((format!("{} {}", output.signal, output.value), q));
            }
            What::Output(output, _) => {
                all.push((format!("{} {}", output.signal, output.value), [0.0; 6]));
            }
            What::Left(_) => all.push(("elsewhere".to_owned(), q)),
        }
    }
    all.push(("end".to_owned(), q));
    all
}

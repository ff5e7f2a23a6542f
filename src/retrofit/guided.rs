//! Streams as positions for externally guided motion, in a folder beside the program.
//!
//! The program itself stays as it was: nothing plans or limits a guided motion but its sender, and
//! the virtual controller does not run it.

use super::figures::{OutputFile, OutputKind};
use super::outputs::unchanged;
use super::work::{RetrofitError, Source, Way, run_of};
use crate::emit::{self, EGM_STEP_S, GeneratedNames, Names};
use crate::motion::Simulation;
use crate::motion::stream::{DOF, Joints, Stream};
use crate::optimize::reason::Reason;
use crate::optimize::site::Site;

/// The folder, relative to the program.
const FOLDER: &str = "egm";
/// Largest distance of a position in the file from the motion, rad: the rounding of its text.
const ROUNDING: f64 = 1e-7;

/// The files of the program as they were, and a module with its positions for each way that has a
/// stream. The ways then have their reason to stay.
pub(super) fn files(
    files: &[Source],
    simulation: &Simulation,
    sites: &[Site],
    ways: &mut [Way],
    names: &Names,
) -> Result<Vec<OutputFile>, RetrofitError> {
    let mut outputs: Vec<OutputFile> =
        files.iter().enumerate().map(|(i, source)| unchanged(i, source)).collect();
    for (index, way) in ways.iter_mut().enumerate() {
        let Some(run) = run_of(simulation, sites, way) else { continue };
        let Ok(retiming) = &way.outcome else { continue };
        let positions = positions(&retiming.stream);
        let number = index + 1;
        let names = GeneratedNames {
            module: format!("{}Egm{number}", names.module),
            procedure: format!("{}Egm{number}", names.prefix),
            main: String::new(),
        };
        let text = emit::egm_rows(&positions);
        way.outcome = if reads_as(&text, &positions) && ends_at(&positions, &run.end) {
            let duration = EGM_STEP_S * (positions.len() - 1) as f64;
            let module = emit::egm_module(&names, &run.start, duration)?;
            for (extension, text) in [("mod", module), ("csv", text)] {
                outputs.push(OutputFile {
                    path: format!("{FOLDER}/{}.{extension}", names.module),
                    kind: OutputKind::New,
                    bytes: text.into_bytes(),
                    input: None,
                });
            }
            Err(Reason::Guided(retiming.energy_before_j - retiming.energy.energy_j()))
        } else {
            Err(Reason::Verification(
                "the positions in the file are not those of the motion".into(),
            ))
        };
    }
    Ok(outputs)
}

/// A stream at the clock of the guide: its own motion, held for the rest of the last tick.
fn positions(stream: &Stream) -> Vec<Joints> {
    let duration = stream.duration();
    let count = (duration / EGM_STEP_S - ROUNDING).ceil().max(1.0) as usize;
    (0..=count).map(|i| stream.eval((EGM_STEP_S * i as f64).min(duration)).0).collect()
}

/// Whether the rows of a file are these positions.
fn reads_as(text: &str, positions: &[Joints]) -> bool {
    let rows = text.lines().skip(1);
    let row = |line: &str| -> Option<Vec<f64>> {
        line.split(',').skip(1).map(|x| x.parse::<f64>().ok().map(f64::to_radians)).collect()
    };
    let same = |(line, q): (&str, &Joints)| {
        row(line).is_some_and(|values| {
            values.len() == DOF && (0..DOF).all(|j| (values[j] - q[j]).abs() <= ROUNDING)
        })
    };
    rows.clone().count() == positions.len() && rows.zip(positions).all(same)
}

fn ends_at(positions: &[Joints], end: &Joints) -> bool {
    /// Distance of a stream's end from the programmed one, rad.
    const END: f64 = 1e-4;
    positions.last().is_some_and(|q| (0..DOF).all(|j| (q[j] - end[j]).abs() <= END))
}

//! Streams as positions for externally guided motion, in a folder beside the program.
//!
//! The program itself stays as it was: nothing plans or limits a guided motion but its sender, and
//! the virtual controller does not run it.

use super::figures::{OutputFile, OutputKind};
use super::outputs::unchanged;
use super::work::{RetrofitError, Source, Way, run_of};
use crate::rapid::ir::predefined;
use crate::rapid::ir::program::{Program, Symbol};
use crate::rapid::text::Span;
use crate::retime::motion::Simulation;
use crate::retime::motion::stream::{DOF, Joints, Stream};
use crate::retime::motion::timeline::Run;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::Site;
use crate::tool::emit::{self, EGM_STEP_S, GeneratedNames, Names};

/// The folder, relative to the program.
const FOLDER: &str = "egm";
/// Largest distance of a position in the file from the motion, rad: the rounding of its text.
const ROUNDING: f64 = 1e-7;

/// The files of the program as they were, and a module with its positions for each way that has a
/// stream. The ways then have their reason to stay.
pub(super) fn files(
    files: &[Source],
    program: &Program,
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
        let (tool, work_object) = match arguments(files, program, run) {
            Ok(arguments) => arguments,
            Err(reason) => {
                way.outcome = Err(reason);
                continue;
            }
        };
        let positions = positions(&retiming.stream);
        let number = index + 1;
        let names = GeneratedNames {
            module: format!("{}Egm{number}", names.module),
            procedure: format!("{}Egm{number}", names.prefix),
            main: String::new(),
        };
        let text = emit::egm_rows(&positions);
        way.outcome = if reads_as(&text, &positions) && ends_at(&positions, &run.end) {
            let module = emit::egm_module(&names, &positions, &tool, &work_object)?;
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

/// Tool and work object of a run as a module beside the program can name them.
fn arguments(files: &[Source], program: &Program, run: &Run) -> Result<(String, String), Reason> {
    let Some(record) = run.moves.first() else { return Err(Reason::NoMotion) };
    let movement = &record.movement;
    if movement.total_load.is_some() {
        return Err(Reason::Argument("TLoad".into()));
    }
    let named = |span: Option<Span>, unsaid: &str| {
        let Some(span) = span else { return Ok(unsaid.to_owned()) };
        let text = files[span.file.0 as usize].file.text(span).trim().to_owned();
        let why = format!("{text} is not known outside of its module, where EGM would need it");
        if is_known_everywhere(program, span, &text) { Ok(text) } else { Err(why) }
    };
    let tool = named(Some(movement.tool_span), "tool0");
    let stated = movement.arguments.iter().find(|argument| argument.type_name == "wobjdata");
    let work_object = named(stated.map(|argument| argument.span), "wobj0");
    tool.and_then(|tool| Ok((tool, work_object?))).map_err(Reason::NotConstant)
}

/// Whether a name means the same data in every module as at a place of the program.
fn is_known_everywhere(program: &Program, place: Span, name: &str) -> bool {
    let key = name.to_lowercase();
    let holds =
        |span: Span| span.file == place.file && span.start <= place.start && place.end <= span.end;
    let Some(module) = program.modules.iter().position(|module| holds(module.span)) else {
        return false;
    };
    let own = program.modules[module].routines.iter().filter(|routine| holds(routine.span)).any(
        |routine| {
            routine.params.iter().any(|param| param.name.key == key)
                || routine.data.iter().any(|data| data.name.key == key)
        },
    );
    let here = program.resolve(module, &key);
    let is_data = matches!(here, Some(Symbol::Data(_)));
    !own && (is_data || predefined::lookup(&key).is_some()) && here == program.resolve_global(&key)
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

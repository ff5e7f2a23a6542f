//! Streams as positions for externally guided motion (EGM), in a folder next to the program.
//!
//! The program itself stays unchanged: only the sender plans and limits a guided motion, and the
//! virtual controller does not run it.

use super::candidate::{Candidate, State, with_states};
use super::error::RetrofitError;
use super::files::{OutputFile, unchanged};
use super::job::Original;
use super::simulated::ENDPOINT_TOLERANCE;
use crate::rapid::ir::predefined;
use crate::rapid::ir::program::{Program, Symbol};
use crate::rapid::text::Span;
use crate::retime::motion::stream::{Joints, Stream};
use crate::retime::motion::timeline::Run;
use crate::retime::optimize::reason::Reason;
use crate::retime::path::joint_path::are_close;
use crate::tool::emit::{self, EGM_STEP_S, GeneratedNames, Names};

/// The folder, relative to the program.
const FOLDER: &str = "egm";
/// Maximum distance of a position in the file from the motion, rad: rounding of the text.
const ROUNDING: f64 = 1e-7;

/// The unchanged files, and a module with positions for each candidate that has a stream. These
/// candidates become refused with a reason.
pub(super) fn guided(
    original: &Original<'_>,
    candidates: Vec<Candidate>,
    names: &Names,
) -> Result<(Vec<OutputFile>, Vec<Candidate>), RetrofitError> {
    let mut outputs = unchanged(original.files);
    let mut refused = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        let Some(run) = original.run(candidate) else { continue };
        let Some(retiming) = candidate.retiming() else { continue };
        let (tool, work_object) = match arguments(original, run) {
            Ok(arguments) => arguments,
            Err(reason) => {
                refused.push((index, State::Refused(reason)));
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
        let rows = emit::egm_rows(&positions);
        let reason = if reads_as(&rows, &positions) && ends_at(&positions, &run.end) {
            let module = emit::egm_module(&names, &positions, &tool, &work_object)?;
            for (extension, text) in [("mod", module), ("csv", rows)] {
                let path = format!("{FOLDER}/{}.{extension}", names.module);
                outputs.push(OutputFile::added(path, text));
            }
            Reason::Guided(retiming.energy_before_j - retiming.energy.energy_j())
        } else {
            Reason::Verification("the positions in the file are not those of the motion".into())
        };
        refused.push((index, State::Refused(reason)));
    }
    Ok((outputs, with_states(candidates, refused)))
}

/// Tool and work object of a run, as a module outside the program can name them.
fn arguments(original: &Original<'_>, run: &Run) -> Result<(String, String), Reason> {
    let Original { files, program, .. } = original;
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

/// A stream sampled at the EGM period; the last position is held to the end of its period.
fn positions(stream: &Stream) -> Vec<Joints> {
    let duration = stream.duration();
    let count = (duration / EGM_STEP_S - ROUNDING).ceil().max(1.0) as usize;
    (0..=count).map(|i| stream.eval((EGM_STEP_S * i as f64).min(duration)).0).collect()
}

/// Whether the rows of a file are these positions.
fn reads_as(text: &str, positions: &[Joints]) -> bool {
    let rows = text.lines().skip(1);
    let row = |line: &str| -> Option<Joints> {
        let values = line.split(',').skip(1).map(|x| x.parse::<f64>().ok().map(f64::to_radians));
        values.collect::<Option<Vec<f64>>>()?.try_into().ok()
    };
    let same = |(line, q): (&str, &Joints)| {
        row(line).is_some_and(|values| are_close(&values, q, ROUNDING))
    };
    rows.clone().count() == positions.len() && rows.zip(positions).all(same)
}

fn ends_at(positions: &[Joints], end: &Joints) -> bool {
    positions.last().is_some_and(|q| are_close(q, end, ENDPOINT_TOLERANCE))
}

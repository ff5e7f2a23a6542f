//! What stays the same from one emission to the next, and how emitted text names parts of a program.

use super::files::Source;
use super::guards::Guards;
use super::job::Job;
use super::recorded::recorded;
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::{Argument, Movement};
use crate::rapid::ir::predefined;
use crate::rapid::ir::value::Datum;
use crate::rapid::text::{SourceFile, Span};
use crate::tool::emit::{Layout, Names, Parameter, Recorded, Robot};

/// What stays the same from one emission to the next.
pub(super) struct EmissionContext<'a> {
    /// The files of the program.
    pub(super) files: &'a [Source],
    /// The same as they are read.
    pub(super) originals: Vec<SourceFile>,
    /// The file beside which new modules lie.
    pub(super) beside: usize,
    /// What guards compare.
    pub(super) guards: &'a Guards<'a>,
    /// The robot that streams are made for.
    pub(super) robot: Robot,
    /// The operator's speed override that they are made for, %.
    pub(super) override_percent: f64,
    /// What the program writes down for them.
    pub(super) recorded: Recorded,
    /// Names that are free.
    pub(super) names: Names,
    /// How points are written.
    pub(super) layout: Layout,
}

impl<'a> EmissionContext<'a> {
    /// For the streams of a job.
    pub(super) fn new(job: &'a Job<'a>, guards: &'a Guards<'a>) -> EmissionContext<'a> {
        let Job { original, model, settings, .. } = job;
        let originals: Vec<SourceFile> =
            original.files.iter().map(|source| source.file.clone()).collect();
        let names = Names::free(&originals);
        EmissionContext {
            files: original.files,
            guards,
            robot: robot(model),
            override_percent: 100.0 * settings.options.speed_override.unwrap_or(1.0),
            recorded: recorded(original.program, original.files, &names),
            names,
            originals,
            beside: original.program.modules[original.entry.module].span.file.0 as usize,
            layout: settings.layout,
        }
    }
}

/// The robot as guards know it: what its controller calls it, and where a posture that no other
/// robot shares brings its flange.
fn robot(model: &Model) -> Robot {
    let place = (model.kinematics.base * fk(model, &POSTURE)).translation.vector;
    Robot { kind: model.type_name().to_owned(), posture: POSTURE, place: place.into() }
}

/// A posture in which every length of an arm counts, rad.
const POSTURE: [f64; 6] = [0.3, 0.2, -0.4, 0.5, 0.7, 0.0];

/// File and lines of some statements.
pub(super) fn place(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize];
    let first = file.file.position(span.start).line;
    let last = file.file.position(span.end).line;
    let lines = if first == last { format!("{first}") } else { format!("{first}-{last}") };
    format!("{} {lines}", ascii(&file.relative))
}

/// What a guard compares, and with what: arguments, and the load where the program changes it.
pub(super) fn compared(
    context: &EmissionContext<'_>,
    arguments: &[Argument],
    movement: &Movement,
) -> (Vec<Parameter>, Vec<Datum>) {
    let mut compared = context.guards.parameters(arguments);
    if context.recorded.load {
        let load = movement.settings.grip_load_data.clone();
        let load = load.or_else(|| predefined::lookup("load0").map(|value| value.datum));
        let parameter = Parameter {
            text: None,
            label: "GripLoad".to_owned(),
            type_name: "loaddata",
            is_computed: false,
        };
        compared.extend(load.map(|load| (parameter, load)));
    }
    compared.into_iter().unzip()
}

/// An argument as the program writes it, to be written again at the same place.
pub(super) fn argument(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize].file;
    file.text(span).into_owned()
}

/// Comments are plain ASCII, whatever the file's encoding.
fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
}

//! The constant input of all emissions, and the text for parts of a program.

use sha2::{Digest, Sha256};

use super::files::Source;
use super::guards::Guards;
use super::job::Job;
use super::recorded::recorded;
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::{self, Argument, Movement};
use crate::rapid::ir::predefined;
use crate::rapid::ir::value::Datum;
use crate::rapid::text::{SourceFile, Span};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;
use crate::tool::emit::{Emission, Names, Now, Parameter, Recorded, Robot};

/// The constant input of all emissions.
pub(super) struct EmissionContext<'a> {
    pub(super) files: &'a [Source],
    /// Index of the file whose folder receives the new modules.
    pub(super) beside: usize,
    /// The expressions that guards compare.
    pub(super) guards: &'a Guards<'a>,
    pub(super) emission: Emission,
    /// The settings that guards compare.
    compared: Vec<Compared>,
}

impl<'a> EmissionContext<'a> {
    pub(super) fn new(job: &'a Job<'a>, guards: &'a Guards<'a>) -> EmissionContext<'a> {
        let Job { original, model, settings, .. } = job;
        let files: Vec<SourceFile> =
            original.files.iter().map(|source| source.file.clone()).collect();
        let names = Names::free(&files);
        let compared = compared_settings(&original.cycle.simulation);
        let emission = Emission {
            layout: settings.layout,
            robot: robot(model),
            override_percent: 100.0 * settings.options.speed_override.unwrap_or(1.0),
            recorded: Recorded {
                compared: compared.iter().map(|setting| setting.label()).collect(),
                ..recorded(original.program, original.files, &names)
            },
            program: hash(&files),
            names,
            files,
        };
        let beside = original.program.modules[original.entry.module].span.file.0 as usize;
        EmissionContext { files: original.files, beside, guards, emission, compared }
    }
}

/// The settings of the program's movements that guards compare, because some are not the usual ones.
fn compared_settings(simulation: &Simulation) -> Vec<Compared> {
    let runs = simulation.events.iter().filter_map(|event| match &event.what {
        What::Run(run) => Some(run),
        _ => None,
    });
    let moves = runs.flat_map(|run| &run.moves).map(|record| &record.movement);
    let (mut is_scaled, mut is_capped, mut wrist) = (false, false, false);
    for Movement { speed, settings, .. } in moves {
        is_scaled |= settings.shares() != [1.0; 3];
        is_capped |= speed.tcp * settings.speed_override > settings.speed_max;
        wrist |= settings.axiswise_wrist();
    }
    let shares = [Compared::Override, Compared::Acceleration, Compared::Ramp];
    let mut compared = Vec::new();
    compared.extend(shares.into_iter().filter(|_| is_scaled));
    compared.extend(is_capped.then_some(Compared::MaxSpeed));
    compared.extend(wrist.then_some(Compared::Wrist));
    compared
}

/// A hash that identifies a version of the program.
fn hash(files: &[SourceFile]) -> String {
    let mut hasher = Sha256::new();
    for file in files {
        hasher.update((file.bytes.len() as u64).to_le_bytes());
        hasher.update(&file.bytes);
    }
    let mut digits = format!("{:x}", hasher.finalize());
    digits.truncate(HASH_DIGITS);
    digits
}

/// Number of emitted digits of the hash.
const HASH_DIGITS: usize = 16;

/// The robot as a guard identifies it: type name, and flange position at a fixed posture.
fn robot(model: &Model) -> Robot {
    let place = (model.kinematics.base * fk(model, &POSTURE)).translation.vector;
    Robot { kind: model.type_name().to_owned(), posture: POSTURE, place: place.into() }
}

/// A posture at which every length of the arm affects the flange position, rad.
const POSTURE: [f64; 6] = [0.3, 0.2, -0.4, 0.5, 0.7, 0.0];

/// File and lines of a span.
pub(super) fn place(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize];
    let first = file.file.position(span.start).line;
    let last = file.file.position(span.end).line;
    let lines = if first == last { format!("{first}") } else { format!("{first}-{last}") };
    format!("{} {lines}", ascii(&file.relative))
}

/// A setting that a guard compares with that of its streams.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Compared {
    Override,
    MaxSpeed,
    Acceleration,
    Ramp,
    Wrist,
}

impl Compared {
    /// The name in messages.
    fn label(self) -> &'static str {
        match self {
            Compared::Override => "VelSet",
            Compared::MaxSpeed => "VelSet max",
            Compared::Acceleration => "AccSet",
            Compared::Ramp => "AccSet ramp",
            Compared::Wrist => "SingArea Wrist",
        }
    }

    /// How a guard reads the setting.
    fn parameter(self) -> Parameter {
        let (expression, type_name) = match self {
            Compared::Override => ("C_MOTSET.vel.oride", "num"),
            Compared::MaxSpeed => ("C_MOTSET.vel.max", "num"),
            Compared::Acceleration => ("C_MOTSET.acc.acc", "num"),
            Compared::Ramp => ("C_MOTSET.acc.ramp", "num"),
            Compared::Wrist => ("C_MOTSET.sing.wrist", "bool"),
        };
        let (now, label) = (Now::Anywhere(expression), self.label().to_owned());
        Parameter { now, label, type_name, is_computed: false }
    }

    fn value(self, settings: &movement::Settings) -> Datum {
        let [speed, max, acceleration, ramp] = settings.limits().map(Datum::Num);
        match self {
            Compared::Override => speed,
            Compared::MaxSpeed => max,
            Compared::Acceleration => acceleration,
            Compared::Ramp => ramp,
            Compared::Wrist => Datum::Bool(settings.axiswise_wrist()),
        }
    }
}

/// The parameters and values that a guard compares: arguments, the load if the program changes
/// it, and settings that are not the usual ones.
pub(super) fn compared(
    context: &EmissionContext<'_>,
    arguments: &[Argument],
    movement: &Movement,
) -> (Vec<Parameter>, Vec<Datum>) {
    let mut compared = context.guards.parameters(arguments);
    if context.emission.recorded.load {
        let load = movement.settings.grip_load_data.clone();
        let load = load.or_else(|| predefined::lookup("load0").map(|value| value.datum));
        let parameter = Parameter {
            now: Now::Load,
            label: "GripLoad".to_owned(),
            type_name: "loaddata",
            is_computed: false,
        };
        compared.extend(load.map(|load| (parameter, load)));
    }
    let settings = context.compared.iter();
    compared.extend(settings.map(|it| (it.parameter(), it.value(&movement.settings))));
    compared.into_iter().unzip()
}

/// The source text of an argument, for reuse at the same place.
pub(super) fn argument(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize].file;
    file.text(span).into_owned()
}

/// Comments contain only ASCII, whatever the encoding of the file.
fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
}

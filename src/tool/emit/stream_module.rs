//! Emits the modules of streams, and the guards in the original.

use serde::Serialize;
use tera::{Context, Tera};

use super::guard::{Guard, guard, insertions, made_up_for, types};
use super::layout::{Layout, parts};
use super::literal::NO_AXIS;
use super::names::Names;
use super::site::{EmitError, Emitted, EmittedStream, Recorded, Robot, Site, Stop, Word};
use crate::rapid::ir::number::{joints, number};
use crate::rapid::text::{Charset, Edit, SourceFile, charset};

/// Maximum joint distance from the start of a stream, degrees: 0.5 mm at an arm stretched to 1.45
/// m. At a stop point servos are closer.
const JOINT_TOLERANCE_DEG: f64 = 0.02;
/// The same for an external axis, degrees or mm.
const EXTERNAL_TOLERANCE: f64 = 0.1;
/// Rounding of a position that the controller computes, mm: a `num` stores 1,000 mm to 0.00006.
const POSITION_ROUNDING_MM: f64 = 0.005;
/// The same for a quaternion component: less than 0.005 mm at 1 m from the flange.
const ORIENTATION_ROUNDING: f64 = 0.000_002;
/// The same for numbers and joint angles in degrees.
const NUMBER_ROUNDING: f64 = 0.0001;
/// Maximum distance of the controller's forward kinematics from that of the streams, mm.
const PLACE_TOLERANCE_MM: f64 = 0.1;

/// Decimals of a pause, s: the relocated wait must take exactly as long as the original one.
const PAUSE_DECIMALS: usize = 7;

/// Speed override at which movements take their `\T`, %.
const FULL_SPEED: f64 = 100.0;
/// Decimals of a `\T`, s: with an override, it is a fraction of a time with fewer decimals.
const T_DECIMALS: usize = 7;

#[derive(Serialize)]
struct StreamText {
    origin: String,
    before: String,
    after: String,
    /// Numbers of its site and of itself: the end of its names.
    index: String,
    start: String,
    made: Vec<String>,
    points: Vec<PointText>,
    /// Whether its points are arrays.
    is_array: bool,
    /// The number of points, and of those before the last.
    count: usize,
    fly_by: usize,
    /// The state of the movements that are put off already.
    follows: usize,
    puts_off: Option<PutOffText>,
}

/// Movements that are put off.
#[derive(Clone, Serialize)]
struct PutOffText {
    state: usize,
    /// The state before.
    follows: usize,
    /// Where the robot stands then.
    from: String,
    /// Declarations of the tools and work objects of the statements.
    data: Vec<String>,
    /// Assignments of the values that these have when the movements are put off.
    kept: Vec<String>,
    statements: Vec<String>,
}

#[derive(Serialize)]
struct PointText {
    target: String,
    time: String,
    zone: &'static str,
    /// Standstill at the point, s; empty for a fly-by point.
    pause: String,
}

#[derive(Serialize)]
struct SiteText {
    guard: Guard,
    streams: Vec<StreamText>,
}

/// The input of an emission.
pub struct Emission {
    /// The original files.
    pub files: Vec<SourceFile>,
    /// Unused names.
    pub names: Names,
    /// Layout of the points.
    pub layout: Layout,
    /// The robot.
    pub robot: Robot,
    /// The operator's speed override for the streams, %.
    pub override_percent: f64,
    /// The states that the program records for guards.
    pub recorded: Recorded,
    /// A hash that identifies the original.
    pub program: String,
}

/// Renders the streams of the sites. `stops`: statements before which movements that were put off
/// are made up for.
///
/// # Errors
/// A value has no RAPID text.
pub fn emit(emission: &Emission, sites: &[Site], stops: &[Stop]) -> Result<Emitted, EmitError> {
    let Emission { files, names, robot, recorded, .. } = emission;
    let mut tera = Tera::default();
    tera.add_raw_templates(vec![
        ("streams.mod", include_str!("../../../templates/streams.mod.tera")),
        ("guards.mod", include_str!("../../../templates/guards.mod.tera")),
        ("guard", include_str!("../../../templates/guard.tera")),
    ])?;
    let charsets: Vec<Charset> = files.iter().map(|file| charset(&file.bytes)).collect();
    let mut texts = Vec::new();
    let mut edits = recorded.edits.clone();
    let mut instructions = Vec::new();
    for (index, site) in sites.iter().enumerate() {
        let guard = guard(site, &names.prefix, recorded, index + 1);
        let streams: Result<Vec<StreamText>, EmitError> = site
            .streams
            .iter()
            .enumerate()
            .map(|(variant, stream)| stream_text(emission, site, stream, [index + 1, variant + 1]))
            .collect();
        let file = site.span.file.0 as usize;
        let source = (&files[file], charsets[file]);
        edits.extend(insertions(&tera, &names.prefix, source, site.span, &guard)?);
        instructions.push(guard.instructions);
        texts.push(SiteText { guard, streams: streams? });
    }
    for stop in stops {
        let file = &files[stop.span.file.0 as usize];
        let ends_here = |edit: &Edit| (edit.span.file, edit.span.start) == (file.id, stop.span.end);
        let is_block = recorded.edits.iter().any(ends_here);
        edits.extend(made_up_for(&names.prefix, file, *stop, is_block));
    }
    let streams = texts.iter().flat_map(|site| &site.streams);
    let puts_off: Vec<PutOffText> = streams.filter_map(|stream| stream.puts_off.clone()).collect();
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("program", &emission.program);
    context.insert("p", &names.prefix);
    context.insert("robot", &robot.kind);
    context.insert("override", &number(emission.override_percent, 6));
    context.insert("posture", &joints(&robot.posture));
    let place: Vec<String> = robot.place.iter().map(|x| number(1e3 * x, 4)).collect();
    context.insert("place", &place.join(","));
    context.insert("place_tolerance", &number(PLACE_TOLERANCE_MM, 6));
    context.insert("joint_tolerance", &number(JOINT_TOLERANCE_DEG, 6));
    context.insert("position_rounding", &number(POSITION_ROUNDING_MM, 6));
    context.insert("orientation_rounding", &number(ORIENTATION_ROUNDING, 6));
    context.insert("number_rounding", &number(NUMBER_ROUNDING, 6));
    context.insert("external_tolerance", &number(EXTERNAL_TOLERANCE, 6));
    context.insert("external", &sites.iter().any(Site::has_external));
    context.insert("switches", &recorded.switches);
    context.insert("load", &recorded.load);
    context.insert("compared", &recorded.compared);
    context.insert("count", &sites.len());
    context.insert("puts_off", &puts_off);
    let list = |text: &dyn Fn(&SiteText) -> String| texts.iter().map(text).collect::<Vec<_>>();
    context.insert("labels", &list(&|site| format!("\"{}\"", site.guard.label)).join(","));
    context.insert("zeros", &list(&|_| "0".to_owned()).join(","));
    context.insert("types", &types(&texts.iter().map(|site| &site.guard).collect::<Vec<_>>()));
    let counts: Vec<usize> = texts
        .iter()
        .map(|site| site.streams.iter().map(|stream| stream.points.len()).sum())
        .collect();
    let modules: Result<Vec<(String, String)>, tera::Error> = parts(&counts)
        .into_iter()
        .enumerate()
        .map(|(index, part)| {
            let name = names.part(index);
            context.insert("module", &name);
            context.insert("sites", &texts[part]);
            context.insert("functions", &(index == 0));
            Ok((name, tera.render("streams.mod", &context)?))
        })
        .collect();
    Ok(Emitted { modules: modules?, edits, instructions })
}

fn stream_text(
    emission: &Emission,
    site: &Site,
    stream: &EmittedStream,
    [guard, way]: [usize; 2],
) -> Result<StreamText, EmitError> {
    let made = site.parameters.iter().zip(&stream.values).map(|(parameter, value)| {
        super::literal::literal(value).ok_or_else(|| EmitError::Value(parameter.label.clone()))
    });
    let made = made.collect::<Result<Vec<String>, _>>()?;
    let p = &emission.names.prefix;
    let puts_off = stream.puts_off.as_ref().map(|put_off| {
        // The arguments for tool and work object must be persistent data.
        let own = |k: usize| format!("{p}Own{guard}_{way}_{}", k + 1);
        let is_kept = |k: usize| matches!(site.parameters[k].type_name, "tooldata" | "wobjdata");
        let word = |word: &Word| match word {
            Word::Text(text) => text.clone(),
            Word::Parameter(k) if is_kept(*k) => own(*k),
            Word::Parameter(k) => format!("{p}Kept{guard}_{way}.p{}", k + 1),
        };
        let statements = put_off.statements.iter();
        let kept = || (0..site.parameters.len()).filter(|k| is_kept(*k));
        PutOffText {
            state: put_off.state,
            follows: stream.follows,
            from: format!("{p}From{guard}{{{way}}}"),
            kept: kept().map(|k| format!("{}:={p}Own{guard}.p{}", own(k), k + 1)).collect(),
            data: kept()
                .map(|k| format!("{} {}:={}", site.parameters[k].type_name, own(k), made[k]))
                .collect(),
            statements: statements.map(|words| words.iter().map(word).collect()).collect(),
        }
    });
    let points = if puts_off.is_some() { &[][..] } else { stream.points.as_slice() };
    let count = points.len();
    let last = count.saturating_sub(1);
    let external = stream.external.map(external_axis).join(",");
    let points = points
        .iter()
        .zip(&stream.intervals)
        .enumerate()
        .map(|(i, (q, t))| {
            let pause = stream.pause.filter(|pause| pause.after == i);
            PointText {
                target: format!("[[{}],[{external}]]", joints(q)),
                time: time(*t, emission.override_percent),
                zone: if i == last || pause.is_some() { "fine" } else { "z200" },
                pause: pause.map_or(String::new(), |pause| number(pause.seconds, PAUSE_DECIMALS)),
            }
        })
        .collect();
    Ok(StreamText {
        origin: stream.origin.clone(),
        before: stream.before.clone(),
        after: stream.after.clone(),
        start: format!("[[{}],[{external}]]", joints(&stream.start)),
        made,
        index: format!("{guard}_{way}"),
        points,
        is_array: stream.pause.is_none() && emission.layout.is_array(count),
        count,
        fly_by: last,
        follows: stream.follows,
        puts_off,
    })
}

/// `\T` of a movement that takes `t` seconds at this override, which stretches it.
fn time(t: f64, override_percent: f64) -> String {
    number(override_percent / FULL_SPEED * t, T_DECIMALS)
}

fn external_axis(x: f64) -> String {
    if x >= NO_AXIS { "9E9".to_owned() } else { number(x, 9) }
}

//! The streams module and the guards in the original.

use serde::Serialize;
use tera::{Context, Tera};

use super::layout::{Layout, parts};
use super::names::Names;
use crate::ir::movement::LocalValue;
use crate::ir::number::{TIME_DECIMALS, joints, number};
use crate::ir::value::Datum;
use crate::text::{Charset, Edit, SourceFile, Span, charset};

/// How near the robot must stand to the start of a stream, degrees.
const JOINT_TOLERANCE_DEG: f64 = 0.1;
/// The same for an external axis, degrees or mm.
const EXTERNAL_TOLERANCE: f64 = 0.1;
/// How near a parameter must be to the target of a stream, mm.
const POSITION_TOLERANCE_MM: f64 = 0.01;
/// The same for the components of its quaternion.
const ORIENTATION_TOLERANCE: f64 = 0.000_01;
/// The same for numbers.
const NUMBER_TOLERANCE: f64 = 0.0005;

/// Decimals of a pause, s: with the ways to it and back it takes as long as the wait did.
const PAUSE_DECIMALS: usize = 7;

/// A stream to emit.
#[derive(Clone, Debug)]
pub struct EmittedStream {
    /// Where it starts, rad.
    pub start: [f64; 6],
    /// Its points, rad.
    pub points: Vec<[f64; 6]>,
    /// `\T` of each, s.
    pub intervals: Vec<f64>,
    /// Where the robot stands still on the way.
    pub pause: Option<Pause>,
    /// Where the external axes stand meanwhile, as the program writes it.
    pub external: [f64; 6],
    /// Values that loop variables and parameters must have.
    pub locals: Vec<LocalValue>,
    /// The tool as the program names it at that place.
    pub tool: String,
    /// Where it comes from, time and energy before and after, for comments.
    pub origin: String,
    /// Before, for comments.
    pub before: String,
    /// After, for comments.
    pub after: String,
}

/// Standing still at a point of a stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pause {
    /// The index of the point.
    pub after: usize,
    /// s.
    pub seconds: f64,
}

/// A place of the original with the streams that may stand for it.
#[derive(Clone, Debug)]
pub struct Site {
    /// The statements.
    pub span: Span,
    /// Their streams.
    pub streams: Vec<EmittedStream>,
}

/// What was emitted.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// Names and texts of the modules with streams; the first one has the functions of guards.
    pub modules: Vec<(String, String)>,
    /// Insertions into the original files.
    pub edits: Vec<Edit>,
}

/// Why nothing was emitted.
#[derive(Debug, thiserror::Error)]
pub enum EmitError {
    /// A value that a guard can't be written for.
    #[error("no condition can be written for {0}")]
    Condition(String),
    /// A template failed.
    #[error("a template of the emission failed: {0}")]
    Template(#[from] tera::Error),
}

#[derive(Serialize)]
struct StreamText {
    origin: String,
    before: String,
    after: String,
    start_name: String,
    proc_name: String,
    start: String,
    targets: Vec<TargetText>,
    points: Vec<PointText>,
    array: Option<ArrayText>,
}

/// What a stream from arrays needs besides its points.
#[derive(Serialize)]
struct ArrayText {
    points: String,
    times: String,
    /// The number of points in the braces of an index.
    last: String,
    /// The number of the last point but one.
    fly_by: String,
}

#[derive(Serialize)]
struct TargetText {
    r#type: &'static str,
    name: String,
    value: String,
}

#[derive(Serialize)]
struct PointText {
    target: String,
    time: String,
    zone: &'static str,
    /// How long the robot stands there, s; empty where it flies on.
    pause: String,
}

#[derive(Serialize)]
struct BranchText {
    condition: String,
    call: String,
}

/// Whether a guard can tell this value.
pub fn can_guard(local: &LocalValue) -> bool {
    condition(local, "x", &mut Vec::new(), "").is_ok()
}

/// Renders the streams of the sites.
///
/// # Errors
/// A local value that no condition can be written for.
pub fn emit(
    files: &[SourceFile],
    names: &Names,
    layout: Layout,
    sites: &[Site],
) -> Result<Emitted, EmitError> {
    let mut tera = Tera::default();
    tera.add_raw_templates(vec![
        ("streams.mod", include_str!("../../templates/streams.mod.tera")),
        ("guard", include_str!("../../templates/guard.tera")),
    ])?;
    let charsets: Vec<Charset> = files.iter().map(|file| charset(&file.bytes)).collect();
    let mut texts = Vec::new();
    let mut edits = Vec::new();
    for site in sites {
        let mut branches = Vec::new();
        for stream in &site.streams {
            let number = texts.len() + 1;
            let (text, conditions) = stream_text(stream, names, layout, number)?;
            branches.push(BranchText {
                condition: conditions.join(" AND "),
                call: format!("{} {}", text.proc_name, stream.tool),
            });
            texts.push(text);
        }
        let file = site.span.file.0 as usize;
        edits.extend(guard(&tera, &files[file], charsets[file], site.span, &branches)?);
    }
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("names", names);
    context.insert("joint_tolerance", &number(JOINT_TOLERANCE_DEG, 6));
    context.insert("position_tolerance", &number(POSITION_TOLERANCE_MM, 6));
    context.insert("orientation_tolerance", &number(ORIENTATION_TOLERANCE, 6));
    let external = sites.iter().flat_map(|site| &site.streams).any(has_external);
    context.insert("external", &external);
    context.insert("external_tolerance", &number(EXTERNAL_TOLERANCE, 6));
    let counts: Vec<usize> = texts.iter().map(|text| text.points.len()).collect();
    let modules: Result<Vec<(String, String)>, tera::Error> = parts(&counts)
        .into_iter()
        .enumerate()
        .map(|(index, part)| {
            let name = names.part(index);
            context.insert("module", &name);
            context.insert("functions", &(index == 0));
            context.insert("streams", &texts[part]);
            Ok((name, tera.render("streams.mod", &context)?))
        })
        .collect();
    Ok(Emitted { modules: modules?, edits })
}

fn stream_text(
    stream: &EmittedStream,
    names: &Names,
    layout: Layout,
    index: usize,
) -> Result<(StreamText, Vec<String>), EmitError> {
    let prefix = &names.prefix;
    let start_name = format!("{prefix}From{index}");
    let mut conditions = vec![format!("{}({start_name})", names.at)];
    if has_external(stream) {
        conditions.push(format!("{}({start_name}.extax)", names.external_at));
    }
    let mut targets = Vec::new();
    for local in &stream.locals {
        let name = format!("{prefix}For{index}_{}", targets.len() + 1);
        let text = condition(local, &name, &mut targets, &names.same_target)
            .map_err(EmitError::Condition)?;
        let text = text.replace("@joints", &names.same_joints);
        conditions.push(text);
    }
    let count = stream.points.len();
    let last = count.saturating_sub(1);
    let external = stream.external.map(external_axis).join(",");
    let array = (stream.pause.is_none() && layout.is_array(count)).then(|| ArrayText {
        points: format!("{prefix}Points{index}"),
        times: format!("{prefix}Times{index}"),
        last: format!("{{{count}}}"),
        fly_by: last.to_string(),
    });
    let points = stream
        .points
        .iter()
        .zip(&stream.intervals)
        .enumerate()
        .map(|(i, (q, t))| {
            let pause = stream.pause.filter(|pause| pause.after == i);
            PointText {
                target: format!("[[{}],[{external}]]", joints(q)),
                time: number(*t, TIME_DECIMALS),
                zone: if i == last || pause.is_some() { "fine" } else { "z200" },
                pause: pause.map_or(String::new(), |pause| number(pause.seconds, PAUSE_DECIMALS)),
            }
        })
        .collect();
    let text = StreamText {
        origin: stream.origin.clone(),
        before: stream.before.clone(),
        after: stream.after.clone(),
        start: format!("[[{}],[{external}]]", joints(&stream.start)),
        proc_name: format!("{prefix}Run{index}"),
        start_name,
        targets,
        points,
        array,
    };
    Ok((text, conditions))
}

/// The condition that a local name has its value, with the constant it needs.
fn condition(
    local: &LocalValue,
    constant: &str,
    targets: &mut Vec<TargetText>,
    same_target: &str,
) -> Result<String, String> {
    let name = &local.name;
    match (&*local.type_key, &local.datum) {
        ("robtarget", datum) if is_target(datum) => {
            let value = aggregate(datum).ok_or_else(|| name.to_string())?;
            targets.push(TargetText { r#type: "robtarget", name: constant.to_owned(), value });
            Ok(format!("{same_target}({name},{constant})"))
        }
        ("jointtarget", datum) if is_target(datum) => {
            let value = aggregate(datum).ok_or_else(|| name.to_string())?;
            targets.push(TargetText { r#type: "jointtarget", name: constant.to_owned(), value });
            Ok(format!("@joints({name},{constant}) AND {name}.extax={constant}.extax"))
        }
        ("num", Datum::Num(x)) if x.is_finite() => {
            Ok(format!("Abs({name}-({}))<{}", number(*x, 6), number(NUMBER_TOLERANCE, 6)))
        }
        (_, Datum::Bool(b)) => Ok(format!("{name}={}", if *b { "TRUE" } else { "FALSE" })),
        ("robtarget" | "jointtarget", _) => Err(name.to_string()),
        _ => match &local.alias {
            Some(alias) => Ok(format!("{name}={alias}")),
            None => Err(name.to_string()),
        },
    }
}

/// Whether a value is one target: an array of targets is of their type, too.
fn is_target(datum: &Datum) -> bool {
    let Datum::List(parts) = datum else { return false };
    let Some(Datum::List(place)) = parts.first() else { return false };
    place.iter().all(|x| matches!(x, Datum::Num(_)))
}

/// A value from here on is RAPID's 9E9, no axis.
const NO_AXIS: f64 = 9e8;

/// Whether the targets of a stream name external axes.
fn has_external(stream: &EmittedStream) -> bool {
    stream.external.iter().any(|x| *x < NO_AXIS)
}

fn external_axis(x: f64) -> String {
    if x >= NO_AXIS { "9E9".to_owned() } else { number(x, 9) }
}

/// A value as a RAPID aggregate.
fn aggregate(datum: &Datum) -> Option<String> {
    match datum {
        Datum::Num(x) if x.is_finite() => Some(external_axis(*x)),
        Datum::Bool(b) => Some(if *b { "TRUE" } else { "FALSE" }.to_owned()),
        Datum::List(items) => {
            let parts: Option<Vec<String>> = items.iter().map(aggregate).collect();
            Some(format!("[{}]", parts?.join(",")))
        }
        _ => None,
    }
}

/// Insertions before and after the statements of a site.
fn guard(
    tera: &Tera,
    file: &SourceFile,
    charset: Charset,
    span: Span,
    branches: &[BranchText],
) -> Result<[Edit; 2], EmitError> {
    let before = &file.bytes[..span.start as usize];
    let line = before.iter().rposition(|b| *b == b'\n' || *b == b'\r').map_or(0, |i| i + 1);
    let indent: String = before[line..]
        .iter()
        .take_while(|b| matches!(b, b' ' | b'\t'))
        .map(|b| char::from(*b))
        .collect();
    let end_of_line = end_of_line(&file.bytes);
    let mut context = Context::new();
    context.insert("indent", &indent);
    context.insert("branches", branches);
    let head = tera.render("guard", &context)?;
    let head = head.strip_suffix('\n').unwrap_or(&head).replace('\n', end_of_line);
    let after = file.bytes.get(span.end as usize);
    let apart = after.is_none_or(|b| b.is_ascii_whitespace() || *b == b'!');
    let tail = format!("{end_of_line}{indent}ENDIF{}", if apart { "" } else { " " });
    // Names of tools and data may be in it: it is written as the file is.
    let insertion = |at: u32, text: String| Edit {
        span: Span { file: span.file, start: at, end: at },
        text: charset.encode(&text).unwrap_or_else(|| text.into_bytes()),
    };
    Ok([insertion(span.start, head), insertion(span.end, tail)])
}

/// The end of line that a file uses first; LF where it has none.
pub fn end_of_line(bytes: &[u8]) -> &'static str {
    match bytes.iter().position(|b| *b == b'\n' || *b == b'\r') {
        Some(i) if bytes[i] == b'\r' && bytes.get(i + 1) == Some(&b'\n') => "\r\n",
        Some(i) if bytes[i] == b'\r' => "\r",
        _ => "\n",
    }
}

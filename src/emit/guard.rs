//! Guards: what stands before the movements of a site, and what the module compares for it.

use serde::Serialize;
use tera::{Context, Tera};

use super::names::Names;
use super::site::{EmitError, Parameter, Recorded, Site};
use super::stream_module::{end_of_line, has_external};
use crate::ir::number::number;
use crate::text::{Charset, Edit, SourceFile, Span};

/// Longest line of an inserted condition, characters.
const LINE: usize = 90;
/// Longest name of a datum in a message, characters.
const LABEL: usize = 24;
/// Longest name of a place in a message, characters.
const PLACE: usize = 30;
/// Instructions of a guard that every stream has: its settings, the robot, where it stands.
const COMMON: usize = 22;

/// A guard as text.
#[derive(Serialize)]
pub(super) struct Guard {
    pub(super) origin: String,
    /// The same, short enough for a line of the `FlexPendant`.
    pub(super) label: String,
    number: String,
    /// The record of what is compared.
    record: String,
    fits: String,
    run: String,
    tell: String,
    tool: String,
    parts: Vec<PartText>,
    /// Arguments of the function that looks at the settings.
    settings: String,
    external: bool,
    /// Instructions where a stream follows, at most.
    #[serde(skip)]
    pub(super) instructions: usize,
}

/// A component of a record.
#[derive(Serialize)]
struct PartText {
    name: String,
    r#type: &'static str,
    /// What messages call it.
    label: String,
    /// The argument; empty for what the module records.
    text: String,
    /// What stands for it in a comparison, with `{made}` for the record that it is compared with.
    now: [String; 2],
    /// Its value in a message, and that of the record compared with.
    shown: [String; 2],
}

/// The guard of a site.
pub(super) fn guard(site: &Site, names: &Names, recorded: &Recorded, index: usize) -> Guard {
    let prefix = &names.prefix;
    let parts: Vec<PartText> = site
        .parameters
        .iter()
        .enumerate()
        .map(|(i, parameter)| part(parameter, prefix, format!("p{}", i + 1)))
        .collect();
    let settings = &site.settings;
    let word = |on: bool| if on { "TRUE" } else { "FALSE" };
    Guard {
        label: shortened(&site.origin),
        origin: site.origin.clone(),
        number: index.to_string(),
        record: format!("{prefix}Data{index}"),
        fits: format!("{prefix}Fits{index}"),
        run: format!("{prefix}Run{index}"),
        tell: format!("{prefix}Tell{index}"),
        tool: site.tool.clone(),
        instructions: COMMON + recorded.switches.len() + 3 * site.streams.len(),
        parts,
        settings: format!(
            "{},{},{},{}",
            number(settings.fastest, 3),
            word(settings.conf_joint),
            word(settings.conf_linear),
            word(settings.lines),
        ),
        external: site.streams.iter().any(has_external),
    }
}

fn part(parameter: &Parameter, prefix: &str, name: String) -> PartText {
    let own = if parameter.text.is_some() { name.clone() } else { format!("{prefix}Load") };
    let near = match parameter.type_name {
        "robtarget" if parameter.is_computed => Some("NearTarget"),
        "jointtarget" if parameter.is_computed => Some("NearJoints"),
        "num" if parameter.is_computed => Some("NearNumber"),
        _ => None,
    };
    let now = match near {
        Some(near) => [format!("{prefix}{near}({own},"), format!(".{name})")],
        None => [own, String::new()],
    };
    let shown = |record: &str| {
        let value = |part: &str| format!("ValToStr({record}.{name}{part})");
        match parameter.type_name {
            "robtarget" => format!("{}+{}", value(".trans"), value(".rot")),
            "jointtarget" => value(".robax"),
            "tooldata" => format!("{}+{}", value(".tframe.trans"), value(".tload.mass")),
            "wobjdata" => format!("{}+{}", value(".uframe.trans"), value(".oframe.trans")),
            "loaddata" => format!("{}+{}", value(".mass"), value(".cog")),
            _ => value(""),
        }
    };
    PartText {
        r#type: parameter.type_name,
        label: parameter.label.chars().take(LABEL).collect(),
        text: parameter.text.clone().unwrap_or_default(),
        now,
        shown: [shown("now"), shown("made")],
        name,
    }
}

/// The end of a place's name: the line counts more than the folder.
fn shortened(origin: &str) -> String {
    let count = origin.chars().count();
    origin.chars().skip(count.saturating_sub(PLACE)).collect()
}

/// Insertions before and after the statements of a site.
pub(super) fn insertions(
    tera: &Tera,
    file: &SourceFile,
    charset: Charset,
    site: &Site,
    guard: &Guard,
) -> Result<[Edit; 2], EmitError> {
    let span = site.span;
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
    context.insert("guard", guard);
    let arguments = guard.parts.iter().map(|part| part.text.as_str()).filter(|t| !t.is_empty());
    context.insert("arguments", &lines(arguments, &indent));
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

/// Arguments with commas, on lines that are not too long.
fn lines<'t>(arguments: impl Iterator<Item = &'t str>, indent: &str) -> String {
    let mut text = String::new();
    let mut width = indent.len();
    for (i, argument) in arguments.enumerate() {
        if i > 0 {
            text.push(',');
        }
        if width + argument.len() > LINE {
            text.push('\n');
            text.push_str(indent);
            text.push_str("        ");
            width = indent.len() + 8;
        }
        text.push_str(argument);
        width += argument.len() + 1;
    }
    text
}

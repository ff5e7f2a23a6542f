//! Guards: the condition before a site, and its comparison in the module.

use std::collections::BTreeSet;

use serde::Serialize;
use tera::{Context, Tera};

use super::site::{EmitError, Now, Parameter, Recorded, Site, Stop};
use crate::rapid::ir::number::number;
use crate::rapid::text::{Charset, Edit, SourceFile, Span};

/// Remarks after the ELSE of a guard, without and with movements that are put off: the guard does not
/// compare literals in the lines below, nor what follows up to the stream.
pub const EDIT_REMARKS: [&str; 2] = [
    " ! after an edit of these lines: joulepath refresh",
    " ! joined with later movements: after an edit of these lines or up to there: joulepath refresh",
];

/// Maximum length of a line in an inserted condition, characters.
const LINE: usize = 90;
/// Maximum length of a datum's name in a message, characters: with place and component it fits into
/// an 80-character string.
const LABEL: usize = 20;
/// Maximum length of a place in a message, characters.
const PLACE: usize = 30;
/// Instructions that every guard runs: call and settings (21), robot (7), position, and counting
/// (7).
const COMMON: usize = 35;
/// Instructions per compared variant.
const EACH: usize = 5;
/// Additional instructions for a comparison with a rounding tolerance.
const ROUNDED: usize = 2;
/// Instructions before the first point of a stream.
const LEAD: usize = 4;

#[derive(Serialize)]
pub(super) struct Guard {
    pub(super) origin: String,
    /// The same, short enough for a line of the `FlexPendant`.
    pub(super) label: String,
    index: usize,
    tool: String,
    parts: Vec<PartText>,
    /// Number of streams.
    variants: usize,
    /// Arguments of the function that checks the settings.
    settings: String,
    external: bool,
    /// Whether movements are put off there.
    puts_off: bool,
    /// The remark after its ELSE.
    remark: &'static str,
    /// Number of instructions in a cycle.
    #[serde(skip)]
    pub(super) instructions: usize,
}

/// A component of a record.
#[derive(Serialize)]
struct PartText {
    name: String,
    r#type: &'static str,
    /// The argument; empty for a value that the module records.
    text: String,
    /// Text of the comparison before and after the record's name.
    now: [String; 2],
    /// Name in messages.
    label: String,
}

/// A data type that guards compare.
#[derive(Serialize)]
pub(super) struct TypeText {
    name: &'static str,
    /// Its components whose text is short enough for a string; empty if its own text is.
    parts: &'static [&'static str],
}

pub(super) fn guard(site: &Site, prefix: &str, recorded: &Recorded, index: usize) -> Guard {
    let parts: Vec<PartText> = site
        .parameters
        .iter()
        .enumerate()
        .map(|(i, parameter)| part(parameter, prefix, format!("p{}", i + 1)))
        .collect();
    let settings = &site.settings;
    let puts_off = site.streams.iter().any(|stream| stream.puts_off.is_some());
    let word = |on: bool| if on { "TRUE" } else { "FALSE" };
    Guard {
        label: shortened(&site.origin),
        origin: site.origin.clone(),
        index,
        tool: site.tool.clone(),
        variants: site.streams.len(),
        instructions: instructions(site, recorded),
        parts,
        settings: format!(
            "{},{},{},{}",
            number(settings.fastest, 3),
            word(settings.conf_joint),
            word(settings.conf_linear),
            word(settings.lines),
        ),
        external: site.has_external(),
        puts_off,
        remark: EDIT_REMARKS[usize::from(puts_off)],
    }
}

fn part(parameter: &Parameter, prefix: &str, name: String) -> PartText {
    let (own, text) = match &parameter.now {
        Now::Argument(text) => (name.clone(), text.clone()),
        Now::Load => (format!("{prefix}Load"), String::new()),
        Now::Anywhere(expression) => ((*expression).to_owned(), String::new()),
    };
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
    PartText {
        r#type: parameter.type_name,
        label: escaped(&parameter.label.chars().take(LABEL).collect::<String>()),
        text,
        now,
        name,
    }
}

/// The compared data types, with their parts in messages.
pub(super) fn types(guards: &[&Guard]) -> Vec<TypeText> {
    let parts = guards.iter().flat_map(|guard| &guard.parts);
    let names: BTreeSet<&'static str> = parts.map(|part| part.r#type).collect();
    names.into_iter().map(|name| TypeText { name, parts: components(name) }).collect()
}

fn components(type_name: &str) -> &'static [&'static str] {
    match type_name {
        "robtarget" => &["trans", "rot", "robconf", "extax"],
        "jointtarget" => &["robax", "extax"],
        "tooldata" => &[
            "robhold",
            "tframe.trans",
            "tframe.rot",
            "tload.mass",
            "tload.cog",
            "tload.aom",
            "tload.ix",
            "tload.iy",
            "tload.iz",
        ],
        "wobjdata" => &[
            "robhold",
            "ufprog",
            "ufmec",
            "uframe.trans",
            "uframe.rot",
            "oframe.trans",
            "oframe.rot",
        ],
        "loaddata" => &["mass", "cog", "aom", "ix", "iy", "iz"],
        _ => &[],
    }
}

/// Escapes the content of a RAPID string.
fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\"\"")
}

/// Number of instructions of a site's guard in a cycle. The search for the variant starts after the
/// last one and is cyclic.
fn instructions(site: &Site, recorded: &Recorded) -> usize {
    let variants = site.streams.len();
    let rounded = site.parameters.iter().filter(|parameter| parameter.is_computed).count();
    let each = EACH + ROUNDED * rounded;
    let mut last = variants - 1;
    let run = |variant: &Option<usize>| {
        let Some(variant) = *variant else { return variants * each };
        let looked_at = (variant + variants - last - 1) % variants + 1;
        last = variant;
        looked_at * each + LEAD
    };
    let looks: usize = site.order.iter().map(run).sum();
    looks + site.order.len() * (COMMON + recorded.switches.len())
}

/// The end of a place's name: the line matters more than the folder.
fn shortened(origin: &str) -> String {
    let count = origin.chars().count();
    origin.chars().skip(count.saturating_sub(PLACE)).collect()
}

/// The insertions before and after the statements of a site.
pub(super) fn insertions(
    tera: &Tera,
    prefix: &str,
    (file, charset): (&SourceFile, Charset),
    span: Span,
    guard: &Guard,
) -> Result<[Edit; 2], EmitError> {
    let indent = indent(file, span);
    let end_of_line = end_of_line(&file.bytes);
    let mut context = Context::new();
    context.insert("p", prefix);
    context.insert("indent", &indent);
    context.insert("guard", guard);
    let arguments = guard.parts.iter().map(|part| part.text.as_str()).filter(|t| !t.is_empty());
    context.insert("arguments", &lines(arguments, &indent));
    let head = tera.render("guard", &context)?;
    let head = head.strip_suffix('\n').unwrap_or(&head).replace('\n', end_of_line);
    let after = file.bytes.get(span.end as usize);
    let apart = after.is_none_or(|b| b.is_ascii_whitespace() || *b == b'!');
    let tail = format!("{end_of_line}{indent}ENDIF{}", if apart { "" } else { " " });
    // It may contain names of the program, so it gets the encoding of the file.
    let insertion = |at: u32, text: String| Edit {
        span: Span { file: span.file, start: at, end: at },
        text: charset.encode(&text).unwrap_or_else(|| text.into_bytes()),
    };
    Ok([insertion(span.start, head), insertion(span.end, tail)])
}

/// The insertions at a statement before which movements that were put off are made up for.
/// `is_block`: a compact IF around it becomes a block for another reason.
pub(super) fn made_up_for(
    prefix: &str,
    file: &SourceFile,
    stop: Stop,
    is_block: bool,
) -> Vec<Edit> {
    let Stop { span, is_compact } = stop;
    let insertion = |at: u32, text: String| Edit {
        span: Span { file: span.file, start: at, end: at },
        text: text.into_bytes(),
    };
    match (is_compact, is_block) {
        (false, _) => {
            let next = format!("{}{}", end_of_line(&file.bytes), indent(file, span));
            vec![insertion(span.start, format!("{prefix}Back;{next}"))]
        }
        (true, true) => vec![insertion(span.start, format!("{prefix}Back; "))],
        (true, false) => vec![
            insertion(span.start, format!("THEN {prefix}Back; ")),
            insertion(span.end, " ENDIF".to_owned()),
        ],
    }
}

/// The blanks before the first word of a statement's line.
fn indent(file: &SourceFile, span: Span) -> String {
    let before = &file.bytes[..span.start as usize];
    let line = before.rsplit(|b| matches!(b, b'\n' | b'\r')).next().unwrap_or_default();
    let blank = line.iter().take_while(|b| matches!(b, b' ' | b'\t'));
    blank.map(|b| char::from(*b)).collect()
}

/// Comma-separated arguments, broken into lines.
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

/// The first line ending of a file; LF if it has none.
pub fn end_of_line(bytes: &[u8]) -> &'static str {
    match bytes.iter().position(|b| *b == b'\n' || *b == b'\r') {
        Some(i) if bytes[i] == b'\r' && bytes.get(i + 1) == Some(&b'\n') => "\r\n",
        Some(i) if bytes[i] == b'\r' => "\r",
        _ => "\n",
    }
}

#[cfg(test)]
mod tests {
    use super::super::site::{EmittedStream, MotionSettings};
    use super::*;

    /// The search starts with the stream after the last one, so each costs one comparison in order.
    #[test]
    fn variants_in_their_order_cost_one_look() {
        let stream = EmittedStream {
            start: [0.0; 6],
            points: Vec::new(),
            intervals: Vec::new(),
            pause: None,
            external: [9e9; 6],
            values: Vec::new(),
            follows: 0,
            puts_off: None,
            origin: String::new(),
            before: String::new(),
            after: String::new(),
        };
        let site = |order: &[Option<usize>]| Site {
            span: Span { file: crate::rapid::text::FileId(0), start: 0, end: 0 },
            origin: String::new(),
            parameters: Vec::new(),
            settings: MotionSettings {
                fastest: 0.0,
                conf_joint: true,
                conf_linear: true,
                lines: false,
            },
            tool: "tool0".into(),
            streams: vec![stream.clone(); 4],
            order: order.to_vec(),
        };
        let looks = |order: &[Option<usize>]| {
            let runs = order.iter().flatten().count();
            let fixed = order.len() * COMMON + runs * LEAD;
            (instructions(&site(order), &Recorded::default()) - fixed) / EACH
        };
        let [a, b, c, d] = [Some(0), Some(1), Some(2), Some(3)];
        assert_eq!(looks(&[a, b, c, d, a, b, c, d]), 8);
        assert_eq!(looks(&[a, a]), 1 + 4);
        assert_eq!(looks(&[d, None, a]), 4 + 4 + 1);
    }
}

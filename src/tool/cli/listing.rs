//! The `.pgf` of a program: the controller loads only the modules that it lists.

use std::path::Path;

use memchr::memmem::find;

use super::input::{Input, Listing};
use crate::tool::retrofit::{OutputFile, OutputKind, Source};

const BEGIN: &[u8] = b"<Module>";
const END: &[u8] = b"</Module>";

/// Adds the program files to the outputs, with the new modules next to those of their folder.
/// Returns notes.
pub(super) fn add(outputs: &mut Vec<OutputFile>, input: &Input, files: &[Source]) -> Vec<String> {
    let mut notes = Vec::new();
    let new: Vec<String> = outputs
        .iter()
        .filter(|file| file.kind == OutputKind::New && is_module(file))
        .map(|file| file.path.clone())
        .collect();
    for listing in &input.listings {
        let is_ours = |path: &String| files.iter().any(|source| source.file.path == *path);
        if !listing.modules.iter().any(is_ours) {
            continue;
        }
        let mut output = OutputFile {
            path: listing.relative.clone(),
            kind: OutputKind::Unchanged,
            bytes: listing.bytes.clone(),
            input: None,
        };
        // Each is inserted after the same module, so in reverse order.
        for new in new.iter().rev() {
            let Some(neighbour) = neighbour(listing, input, new) else { continue };
            if let Some(bytes) = extended(&output.bytes, neighbour, new) {
                output.kind = OutputKind::Changed;
                output.bytes = bytes;
            } else {
                let path = &listing.path;
                notes.push(format!("'{path}' could not be extended: list {new} in it"));
            }
        }
        outputs.push(output);
    }
    notes
}

fn is_module(file: &OutputFile) -> bool {
    Path::new(&file.path).extension().is_some_and(|extension| extension == "mod")
}

fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The number of the last listed module in the folder of the new one.
fn neighbour(listing: &Listing, input: &Input, new: &str) -> Option<usize> {
    listing.modules.iter().rposition(|path| {
        let file = input.files.iter().find(|file| file.source.path == *path);
        file.is_some_and(|file| folder(&file.relative) == folder(new))
    })
}

/// A module list with one more module after `neighbour`, in the same form. All other bytes stay.
fn extended(bytes: &[u8], neighbour: usize, new: &str) -> Option<Vec<u8>> {
    let mut after = 0;
    let (mut begin, mut listed): (usize, &[u8]) = (0, &[]);
    for _ in 0..=neighbour {
        // Skips entries without a name.
        listed = &[];
        while listed.trim_ascii().is_empty() {
            begin = after + find(&bytes[after..], BEGIN)?;
            let name = begin + BEGIN.len();
            listed = &bytes[name..name + find(&bytes[name..], END)?];
            after = name + listed.len() + END.len();
        }
    }
    let name = new.rsplit('/').next().unwrap_or(new);
    // The folder in the spelling of the program file.
    let folder = listed.iter().rposition(|b| matches!(b, b'/' | b'\\')).map_or(0, |i| i + 1);
    let line = bytes[..begin].iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    let indent = &bytes[line..begin];
    let mut entry = Vec::new();
    if indent.iter().all(u8::is_ascii_whitespace) && line > 0 {
        let crlf = line > 1 && bytes[line - 2] == b'\r';
        entry.extend_from_slice(if crlf { b"\r\n" } else { b"\n" });
        entry.extend_from_slice(indent);
    }
    for part in [BEGIN, &listed[..folder], name.as_bytes(), END] {
        entry.extend_from_slice(part);
    }
    Some([&bytes[..after], &entry, &bytes[after..]].concat())
}

/// A module list without the modules of these file names; emptied lines are removed.
pub(super) fn without(bytes: &[u8], names: &[String]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    let mut from = 0;
    while let Some(begin) = find(&out[from..], BEGIN).map(|at| from + at) {
        let name = begin + BEGIN.len();
        let Some(length) = find(&out[name..], END) else { break };
        let listed = String::from_utf8_lossy(&out[name..name + length]).trim().to_lowercase();
        let listed = listed.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
        let end = name + length + END.len();
        if names.iter().any(|name| name.to_lowercase() == listed) {
            let line = out[..begin].iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
            let next = out[end..].iter().position(|b| *b == b'\n').map(|i| end + i + 1);
            let alone = |part: &[u8]| part.iter().all(u8::is_ascii_whitespace);
            match next {
                Some(next) if alone(&out[line..begin]) && alone(&out[end..next]) => {
                    out.drain(line..next);
                    from = line;
                }
                _ => {
                    out.drain(begin..end);
                    from = begin;
                }
            }
        } else {
            from = end;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_module_is_listed_as_its_neighbours_are() {
        let lines = b"<Program>\r\n\t<Module>A.mod</Module>\r\n</Program>\r\n";
        let longer = b"<Program>\r\n\t<Module>A.mod</Module>\r\n\t<Module>J.mod</Module>\r\n\
                       </Program>\r\n";
        assert_eq!(extended(lines, 0, "J.mod").as_deref(), Some(longer.as_slice()));
        assert_eq!(without(longer, &["j.mod".to_owned()]), lines);
        let one = b"<Program><Module>p\\A.mod</Module></Program>";
        let two = b"<Program><Module>p\\A.mod</Module><Module>p\\J.mod</Module></Program>";
        assert_eq!(extended(one, 0, "p/J.mod").as_deref(), Some(two.as_slice()));
        assert_eq!(without(two, &["J.mod".to_owned()]), one);
        let other = b"<Module>A.mod</Module>\n<Module></Module>\n<Module>p\\B.mod</Module>\n";
        let more = b"<Module>A.mod</Module>\n<Module></Module>\n<Module>p\\B.mod</Module>\n\
                     <Module>p\\J.mod</Module>\n";
        assert_eq!(extended(other, 1, "p/J.mod").as_deref(), Some(more.as_slice()));
        assert_eq!(extended(b"<Program></Program>", 0, "J.mod"), None);
    }
}

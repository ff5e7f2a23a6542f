//! `BACKINFO/backinfo.txt` of a controller backup. The controller loads only the modules in it.

use std::path::Path;

use super::input::Input;
use crate::tool::retrofit::{OutputFile, OutputKind};

/// Ends the name of a module in its line; the origin of the module may follow.
const MARK: u8 = b'@';

/// Adds the backup's list to the outputs, with the new modules next to those of their folder.
/// Returns notes.
pub(super) fn add(outputs: &mut Vec<OutputFile>, input: &Input) -> Vec<String> {
    let mut notes = Vec::new();
    let new: Vec<(String, String, String)> = outputs
        .iter()
        .filter(|file| file.kind == OutputKind::New)
        .filter_map(|file| task_and_place(input, &file.path))
        .collect();
    for info in &input.information {
        let mut bytes = info.bytes.clone();
        for (task, folder, name) in &new {
            if let Some(longer) = extended(&bytes, task, folder, name) {
                bytes = longer;
            } else {
                let path = &info.path;
                notes.push(format!("'{path}' could not be extended: list {name} in it"));
            }
        }
        let kind = if bytes == info.bytes { OutputKind::Unchanged } else { OutputKind::Changed };
        outputs.push(OutputFile { path: info.relative.clone(), kind, bytes, input: None });
    }
    notes
}

/// Task, folder and file of a new module, taken from the modules of its folder.
fn task_and_place(input: &Input, path: &str) -> Option<(String, String, String)> {
    let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
    Path::new(name).extension().filter(|extension| *extension == "mod")?;
    let beside = input.files.iter().find(|file| {
        file.place.is_some() && file.relative.rsplit_once('/').map_or("", |(f, _)| f) == folder
    })?;
    let place = beside.place.as_ref()?;
    let real = Path::new(&beside.source.path).canonicalize().ok()?;
    let modules = real.parent()?.file_name()?.to_string_lossy().into_owned();
    Some((place.folder.clone(), modules, name.to_owned()))
}

/// The list with one more module in the block of a task (`TASK1` …), after the last one of its
/// folder (`PROGMOD`) and in the same form. All other bytes stay.
fn extended(bytes: &[u8], task: &str, folder: &str, name: &str) -> Option<Vec<u8>> {
    let mut inside = false;
    let mut at = 0;
    let mut neighbour = None;
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        let text = line.trim_ascii();
        if let Some(head) = text.strip_prefix(b">>") {
            let block = head.split(|byte| *byte == b':').next().unwrap_or_default();
            inside = block.trim_ascii().eq_ignore_ascii_case(task.as_bytes());
        } else if inside && listed(text, folder).is_some() {
            neighbour = Some((at, line));
        }
        at += line.len();
    }
    let (at, line) = neighbour?;
    let start = line.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    let file = start + listed(&line[start..], folder)?;
    let mark = line.iter().position(|byte| *byte == MARK);
    // The origin after the mark belongs to the other module; the spaces are copied.
    let tail = mark.map_or(&b""[..], |mark| {
        let named = line[..mark].trim_ascii_end().len();
        let spaces =
            line[mark + 1..].iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
        &line[named..mark + 1 + spaces]
    });
    let end = if line.ends_with(b"\r\n") { &b"\r\n"[..] } else { b"\n" };
    // The last line may lack a line ending.
    let behind = if line.ends_with(b"\n") { &b""[..] } else { end };
    let at = at + line.len();
    let entry = [&line[..file], name.as_bytes(), tail].concat();
    let entry = if behind.is_empty() { [&entry, end].concat() } else { [behind, &entry].concat() };
    Some([&bytes[..at], &entry, &bytes[at..]].concat())
}

/// The list without the modules of these file names.
pub(super) fn without(bytes: &[u8], names: &[String]) -> Vec<u8> {
    let is_one = |line: &&[u8]| {
        let text = String::from_utf8_lossy(line).to_lowercase();
        let path = text.split(char::from(MARK)).next().unwrap_or_default().trim();
        let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
        path.len() > name.len() && names.iter().any(|known| known.to_lowercase() == name)
    };
    bytes
        .split_inclusive(|byte| *byte == b'\n')
        .filter(|line| !is_one(line))
        .flatten()
        .copied()
        .collect()
}

/// Start of the file name in a line of a module of this folder.
fn listed(line: &[u8], folder: &str) -> Option<usize> {
    let separator = line.get(folder.len())?;
    let is_it = line[..folder.len()].eq_ignore_ascii_case(folder.as_bytes());
    (is_it && matches!(separator, b'/' | b'\\')).then_some(folder.len() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_module_is_listed_as_its_neighbours_are() {
        let info =
            b">>TASK1: (T_A,,)\r\nPROGMOD/a.mod @ \r\n>>TASK2: (T_B,x,)\r\nSYSMOD/u.sys @ \r\n\
                     PROGMOD/b.mod @ RELEASE:/c.mod\r\n\r\n>>EOF:\r\n";
        let text = String::from_utf8_lossy(info);
        let longer = |task: &str| {
            extended(info, task, "PROGMOD", "J.mod")
                .map(|b| String::from_utf8_lossy(&b).into_owned())
        };
        let expected = text.replace("a.mod @ \r\n", "a.mod @ \r\nPROGMOD/J.mod @ \r\n");
        let shorter = without(expected.as_bytes(), &["j.mod".to_owned()]);
        assert_eq!(shorter, info);
        assert_eq!(longer("task1"), Some(expected));
        let expected = text.replace("c.mod\r\n", "c.mod\r\nPROGMOD/J.mod @ \r\n");
        assert_eq!(longer("TASK2"), Some(expected));
        assert_eq!(longer("TASK3"), None);
        assert_eq!(extended(info, "TASK1", "SYSMOD", "J.mod"), None);
        let last = extended(b">>TASK1:\nPROGMOD\\a.mod @", "TASK1", "PROGMOD", "J.mod");
        assert_eq!(last.as_deref(), Some(&b">>TASK1:\nPROGMOD\\a.mod @\nPROGMOD\\J.mod @"[..]));
    }
}

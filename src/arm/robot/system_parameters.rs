//! System parameters of a controller: `SYS.cfg`, `MOC.cfg` and other files of `SYSPAR`.
//!
//! Sections begin with `NAME:` and end with `#`; an entry is a list of `-key value`, where a
//! flag has no value and `\` at the end of a line continues it.

use std::collections::{BTreeMap, BTreeSet};

/// One entry: values by lower-case key, each with its line; the value of a flag is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Entry {
    line: usize,
    values: BTreeMap<String, (String, usize)>,
    repeated: Option<(String, usize)>,
}

impl Entry {
    /// The value of a lower-case key.
    pub fn get(&self, key: &str) -> Option<&String> {
        self.values.get(key).map(|(value, _)| value)
    }

    /// Whether the key is present.
    pub fn contains_key(&self, key: &str) -> bool {
        self.values.contains_key(key)
    }

    /// The keys, sorted.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.values.keys().map(String::as_str)
    }

    /// The line of the key, from 1; of the entry if it is missing.
    pub fn line_of(&self, key: &str) -> usize {
        self.values.get(key).map_or(self.line, |(_, line)| *line)
    }

    /// The first repeated key, with the line of its repetition; the first value holds.
    pub fn repeated(&self) -> Option<(&str, usize)> {
        self.repeated.as_ref().map(|(key, line)| (key.as_str(), *line))
    }

    /// Reads a line of the entry; `open` is a key without its value yet.
    fn read(&mut self, text: &str, line: usize, open: &mut Option<String>) {
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            let (word, after, quoted) = if let Some(inner) = rest.strip_prefix('"') {
                let (word, after) = inner.split_once('"').unwrap_or((inner, ""));
                (word, after, true)
            } else {
                let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                (word, after, false)
            };
            rest = after.trim_start();
            // A number may be negative; a key starts with a letter.
            let name = word.strip_prefix('-').filter(|name| name.starts_with(char::is_alphabetic));
            match (name, quoted) {
                (Some(name), false) => {
                    let name = name.to_lowercase();
                    *open = None;
                    if self.contains_key(&name) {
                        self.repeated.get_or_insert((name, line));
                    } else {
                        self.values.insert(name.clone(), (String::new(), line));
                        *open = Some(name);
                    }
                }
                _ => {
                    if let Some(value) = open.take().and_then(|key| self.values.get_mut(&key)) {
                        word.clone_into(&mut value.0);
                    }
                }
            }
        }
    }
}

/// The names of the entries of all sections.
pub fn names(text: &str) -> Vec<String> {
    let is_section = |line: &&str| !line.starts_with(['-', ' ', '\t']);
    let lines =
        text.lines().filter(is_section).filter_map(|line| line.trim_end().strip_suffix(':'));
    let sections: BTreeSet<String> = lines.map(str::to_lowercase).collect();
    let entries = sections.iter().flat_map(|name| section(text, name));
    entries.filter_map(|entry| entry.get("name").cloned()).collect()
}

/// The entries of a section; its name is not case-sensitive.
pub fn section(text: &str, name: &str) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut inside = false;
    let mut pending: Option<(Entry, Option<String>)> = None;
    for (i, line) in text.lines().map(str::trim).enumerate() {
        if pending.is_none() && !line.starts_with('-') {
            if let Some(section) = line.strip_suffix(':') {
                inside = section.eq_ignore_ascii_case(name);
            } else if line.starts_with('#') {
                inside = false;
            }
            continue;
        }
        let (mut entry, mut open) =
            pending.take().unwrap_or_else(|| (Entry { line: i + 1, ..Entry::default() }, None));
        let continued = line.strip_suffix('\\');
        entry.read(continued.unwrap_or(line), i + 1, &mut open);
        if continued.is_some() {
            pending = Some((entry, open));
        } else if inside {
            entries.push(entry);
        }
    }
    entries
}

/// The line at which the file is truncated, and the evidence, if it is. A controller ends each
/// line, closes each quote, continues no last line and writes each section that it names.
pub fn truncation(text: &str) -> Option<(usize, &'static str)> {
    let last = text.lines().count();
    let open = text.lines().position(|line| line.matches('"').count() % 2 == 1);
    if let Some(line) = open {
        return Some((line + 1, "a quote is not closed"));
    }
    if text.trim_end().ends_with('\\') {
        return Some((last, "the last line is continued by nothing"));
    }
    let written = text.trim_end();
    if written.lines().next_back().is_some_and(is_header) {
        return Some((written.lines().count(), "a section has its name only"));
    }
    (!text.ends_with(['\n', '\r'])).then_some((last, "the last line has no end"))
}

fn is_header(line: &str) -> bool {
    line.trim().strip_suffix(':').is_some_and(|name| !name.contains(':'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_read_with_flags_and_continued_lines() {
        let text = "SYS:CFG_1.0:6:0::\r\n#\r\nCAB_TASKS:\r\n\r\n      -Name \"T_ROB1\" -Type \"NORMAL\"\\\r\n      \
                    -MotionTask \r\n\r\n      -Name \"T_BG\" -Entry \"a b\"\r\n#\r\nOTHER:\r\n -Name \"x\" -Value -1.5\r\n";
        let tasks = section(text, "cab_tasks");
        assert_eq!(tasks.len(), 2);
        let value = |entry: &Entry, key: &str| entry.get(key).cloned().unwrap_or_default();
        assert_eq!(value(&tasks[0], "name"), "T_ROB1");
        assert!(tasks[0].contains_key("motiontask"));
        assert_eq!(value(&tasks[0], "motiontask"), "");
        assert_eq!((tasks[0].line_of("type"), tasks[0].line_of("motiontask")), (5, 6));
        assert_eq!(value(&tasks[1], "entry"), "a b");
        assert_eq!(tasks[1].line_of("absent"), 8);
        assert_eq!(value(&section(text, "OTHER")[0], "value"), "-1.5");
        assert!(section("-a \"unclosed", "x").is_empty());
    }

    #[test]
    fn the_first_of_two_values_holds() {
        let twice = section("A:\n -name \"x\"\\\n -speed 1 -speed 2 -mass 3\n", "A");
        assert_eq!(twice[0].get("speed").map(String::as_str), Some("1"));
        assert_eq!(twice[0].get("mass").map(String::as_str), Some("3"));
        assert_eq!(twice[0].repeated(), Some(("speed", 3)));
    }

    #[test]
    fn a_name_with_nothing_behind_it_is_a_cut() {
        let cut = "MOC:CFG_1.0:6:0::\n#\nARM:\n\n -name \"a\"\n#\nARM_LOAD:\n";
        assert_eq!(truncation(cut).map(|(line, _)| line), Some(7));
        assert!(truncation(&format!("{cut}\n")).is_some());
        assert_eq!(truncation("MOC:CFG_1.0:6:0::\n"), None);
    }

    #[test]
    fn a_file_that_breaks_off_is_told_from_a_whole_one() {
        let whole =
            "MOC:CFG_1.0:6:0::\n#\nARM:\n\n -name \"rob1_1\"\\\n -upper_joint_bound 3.1416\n";
        assert_eq!(truncation(whole), None);
        for end in (25..whole.len()).filter(|end| !whole[..*end].ends_with('\n')) {
            assert!(truncation(&whole[..end]).is_some(), "{:?}", &whole[..end]);
        }
    }
}

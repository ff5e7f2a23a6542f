//! A controller's system parameters: `SYS.cfg`, `MOC.cfg` and the others of `SYSPAR`.
//!
//! Sections begin with `NAME:` and end with `#`; an entry is a list of `-key value`, where a
//! flag has no value and `\` at the end of a line continues it.

use std::collections::BTreeMap;

/// One entry: values by lower-case key; a flag's value is empty.
pub type Entry = BTreeMap<String, String>;

/// The entries of a section, whose name is compared without case.
pub fn section(text: &str, name: &str) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut inside = false;
    let mut pending = String::new();
    for line in text.lines().map(str::trim) {
        if pending.is_empty() && !line.starts_with('-') {
            if let Some(section) = line.strip_suffix(':') {
                inside = section.eq_ignore_ascii_case(name);
            } else if line.starts_with('#') {
                inside = false;
            }
            continue;
        }
        let continued = line.strip_suffix('\\');
        pending.push_str(continued.unwrap_or(line));
        pending.push(' ');
        if continued.is_none() {
            if inside {
                entries.push(entry(&pending));
            }
            pending.clear();
        }
    }
    entries
}

/// The line at which the file breaks off, and how it can be told, if it does. A
/// controller ends every line, closes every quote and continues no last line.
pub fn break_off(text: &str) -> Option<(usize, &'static str)> {
    let last = text.lines().count();
    let open = text.lines().position(|line| line.matches('"').count() % 2 == 1);
    if let Some(line) = open {
        return Some((line + 1, "a quote is not closed"));
    }
    if text.trim_end().ends_with('\\') {
        return Some((last, "the last line is continued by nothing"));
    }
    (!text.ends_with(['\n', '\r'])).then_some((last, "the last line has no end"))
}

fn entry(text: &str) -> Entry {
    let mut entry = Entry::new();
    let mut key: Option<String> = None;
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
        // A number may be negative, a key never begins with a digit or a point.
        let name = word.strip_prefix('-').filter(|name| name.starts_with(char::is_alphabetic));
        match (name, quoted) {
            (Some(name), false) => {
                let name = name.to_lowercase();
                entry.insert(name.clone(), String::new());
                key = Some(name);
            }
            _ => {
                if let Some(key) = key.take() {
                    entry.insert(key, word.to_owned());
                }
            }
        }
    }
    entry
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
        assert_eq!(tasks[0]["name"], "T_ROB1");
        assert_eq!(tasks[0]["motiontask"], "");
        assert_eq!(tasks[1]["entry"], "a b");
        assert_eq!(section(text, "OTHER")[0]["value"], "-1.5");
        assert!(section("-a \"unclosed", "x").is_empty());
    }

    #[test]
    fn a_file_that_breaks_off_is_told_from_a_whole_one() {
        let whole =
            "MOC:CFG_1.0:6:0::\n#\nARM:\n\n -name \"rob1_1\"\\\n -upper_joint_bound 3.1416\n";
        assert_eq!(break_off(whole), None);
        for end in (25..whole.len()).filter(|end| !whole[..*end].ends_with('\n')) {
            assert!(break_off(&whole[..end]).is_some(), "{:?}", &whole[..end]);
        }
    }
}

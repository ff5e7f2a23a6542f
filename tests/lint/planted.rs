//! Planted programs: for each rule three with a finding and three near misses.

use std::collections::BTreeMap;
use std::fs;

use joulepath::tool::lint::{ALL, Needs, find};

use crate::Fixture;

/// Number of each kind for a rule.
const EACH: usize = 3;

/// A module of a file of `fixtures/lint/plants`, with the data that all of them share.
pub(crate) struct PlantedFault {
    pub(crate) code: String,
    pub(crate) name: String,
    pub(crate) fixture: Fixture,
}

impl PlantedFault {
    fn fires(&self) -> bool {
        self.name.starts_with("Fires")
    }
}

/// All planted faults and near misses. A file has a module with its own `main` for each; the lines
/// of the other modules are empty.
pub(crate) fn planted_faults() -> Vec<PlantedFault> {
    let folder = "fixtures/lint/plants";
    let shared = fs::read_to_string(format!("{folder}/Shared.mod")).unwrap();
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = entries.filter(|path| !path.ends_with("Shared.mod")).collect();
    paths.sort();
    let mut faults = Vec::new();
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let code = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let names = text.lines().filter_map(|line| line.strip_prefix("MODULE "));
        for name in names {
            let mut inside = false;
            let mut own = String::new();
            for line in text.lines() {
                inside |= line.strip_prefix("MODULE ") == Some(name);
                if inside {
                    own.push_str(line);
                }
                own.push('\n');
                inside &= line != "ENDMODULE";
            }
            let fixture = Fixture::from_texts(path.clone(), &[own, shared.clone()]);
            faults.push(PlantedFault { code: code.clone(), name: name.to_owned(), fixture });
        }
    }
    faults
}

#[test]
fn planted_faults_are_found_and_near_misses_are_not() {
    let mut wrong = Vec::new();
    for planted in planted_faults() {
        let (marked, found) = planted.fixture.marked_and_found(&planted.code);
        if marked != found || marked.is_empty() == planted.fires() {
            wrong.push(format!(
                "{} {}: marked {marked:?}, found {found:?}",
                planted.code, planted.name
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Fails for a removed rule, or a new one without planted faults; `tests/lint_command.rs` has those of
/// rules for backups.
#[test]
fn each_rule_has_planted_faults_and_near_misses() {
    let mut counts: BTreeMap<(String, bool), usize> = BTreeMap::new();
    for planted in planted_faults() {
        assert!(find(&planted.code).is_some(), "no rule {}", planted.code);
        *counts.entry((planted.code.clone(), planted.fires())).or_default() += 1;
    }
    for rule in ALL.iter().filter(|rule| rule.needs != Needs::Backup) {
        for fires in [true, false] {
            let count = counts.get(&(rule.code.to_owned(), fires)).copied().unwrap_or(0);
            assert!(count >= EACH, "{}: {count} programs that fire: {fires}", rule.code);
        }
    }
    let backup = ALL.iter().filter(|rule| rule.needs == Needs::Backup).map(|rule| rule.code);
    assert_eq!(backup.collect::<Vec<_>>(), ["EW801", "EW802"]);
}

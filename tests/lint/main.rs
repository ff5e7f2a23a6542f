//! Lint rules: true and false positives, savings, results of fixes.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod fixes;
mod formats;
mod hostile;
mod manuals;
mod page;
mod planted;
mod savings;
mod schema;

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use joulepath::arm::effects;
use joulepath::arm::robot::Model;
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::Options;
use joulepath::tool::lint::{ALL, Finding, Group, Job, Needs, Report, Settings, lint};

/// A program with the settings in its first comments.
pub(crate) struct Fixture {
    pub(crate) path: PathBuf,
    pub(crate) files: Vec<SourceFile>,
    pub(crate) model: Option<Model>,
    pub(crate) options: Options,
    pub(crate) settings: Settings,
}

impl Fixture {
    /// From the name and text of a file: `! robot: NAME`, `! inputs: diA=1 diB=2`.
    pub(crate) fn new(path: PathBuf, text: &str) -> Fixture {
        Fixture::from_texts(path, &[text.to_owned()])
    }

    /// From the texts of several files; the name is that of the first one.
    pub(crate) fn from_texts(path: PathBuf, texts: &[String]) -> Fixture {
        let setting = |key: &str| {
            let mut lines = texts.iter().flat_map(|text| text.lines());
            lines.find_map(|line| line.trim().strip_prefix(key)).map(str::trim)
        };
        let model = setting("! robot:").map(|name| effects::load(name).unwrap());
        let inputs = setting("! inputs:").unwrap_or_default().split_whitespace().map(|pair| {
            let (name, seconds) = pair.split_once('=').unwrap();
            (name.to_lowercase(), seconds.parse().unwrap())
        });
        let options = Options { inputs: inputs.collect(), ..Options::default() };
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let file = |(id, text): (usize, &String)| {
            let name = if id == 0 { name.clone() } else { format!("{id} {name}") };
            SourceFile::new(FileId(id as u32), name, text.as_bytes().to_vec())
        };
        let files = texts.iter().enumerate().map(file).collect();
        Fixture { path, files, model, options, settings: Settings::default() }
    }

    /// The fixture with another text of its first file.
    pub(crate) fn with_text(&self, text: String) -> Fixture {
        let others = self.files[1..].iter();
        let others = others.map(|file| String::from_utf8(file.bytes.clone()).unwrap());
        let texts: Vec<String> = std::iter::once(text).chain(others).collect();
        Fixture::from_texts(self.path.clone(), &texts)
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8(self.files[0].bytes.clone()).unwrap()
    }

    pub(crate) fn job(&self) -> Job<'_> {
        let files = (0..self.files.len()).collect();
        Job {
            files: &self.files,
            groups: vec![Group { files, entry: "main".to_owned(), system: None }],
            model: self.model.as_ref(),
            options: self.options.clone(),
            settings: &self.settings,
        }
    }

    pub(crate) fn report(&self) -> Report {
        lint(&self.job())
    }

    /// The lines of its first file that are marked with a rule, and those with its findings.
    pub(crate) fn marked_and_found(&self, code: &str) -> (BTreeSet<u32>, BTreeSet<u32>) {
        let mark = format!("!~ {code}");
        let text = self.text();
        let lines = (1..).zip(text.lines()).filter(|(_, line)| line.contains(&mark));
        let report = self.report();
        let own = report.findings.iter().filter(|it| it.rule.code == code);
        let line = |it: &Finding| self.files[it.span.file.0 as usize].position(it.span.start).line;
        (lines.map(|(number, _)| number).collect(), own.map(line).collect())
    }
}

/// All programs of `fixtures/lint`.
pub(crate) fn fixtures() -> Vec<Fixture> {
    let entries = fs::read_dir("fixtures/lint").unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|e| e == "mod")).collect();
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        Fixture::new(path, &text)
    };
    paths.into_iter().map(read).collect()
}

/// Each rule has a program with findings on the lines with `!~ CODE` and on no other line.
#[test]
fn rules_report_exactly_the_marked_lines() {
    let fixtures = fixtures();
    let mut wrong = Vec::new();
    for rule in ALL.iter().filter(|rule| rule.needs != Needs::Backup) {
        let stem = format!("{}_{}", rule.code, rule.name.replace('-', "_"));
        let fixture = fixtures.iter().find(|it| it.path.file_stem().unwrap() == stem.as_str());
        let fixture = fixture.unwrap_or_else(|| panic!("fixtures/lint/{stem}.mod is not there"));
        let (marked, found) = fixture.marked_and_found(rule.code);
        assert!(!marked.is_empty(), "{stem}: nothing is marked");
        if marked != found {
            wrong.push(format!("{stem}: marked {marked:?}, found {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The marks in a fixture of an unknown rule would never be checked.
#[test]
fn fixture_names_start_with_the_code_of_a_rule() {
    for fixture in fixtures() {
        let stem = fixture.path.file_stem().unwrap().to_str().unwrap();
        let code = stem.split('_').next().unwrap();
        assert!(joulepath::tool::lint::find(code).is_some(), "{stem}: no rule {code}");
    }
}

/// Findings without a robot have no joules, and rules that need a robot are silent.
#[test]
fn findings_without_a_robot_have_no_saving() {
    for mut fixture in fixtures() {
        fixture.model = None;
        for finding in fixture.report().findings {
            assert!(finding.saving.is_none(), "{:?} {}", fixture.path, finding.full_message());
            assert!(finding.rule.needs != Needs::Robot, "{:?} {:?}", fixture.path, finding.rule);
        }
    }
}

/// With a robot, savings below the threshold are not reported.
#[test]
fn savings_below_the_threshold_are_not_reported() {
    for mut fixture in fixtures() {
        fixture.settings.threshold_j = 30.0;
        for finding in fixture.report().findings {
            assert!(finding.saving.is_none_or(|saving| saving.energy_j >= 30.0));
        }
    }
}

/// Without a robot, a comment that refers to a rule for robots is not reported as unnecessary.
#[test]
fn comments_on_robot_rules_are_accepted_without_a_robot() {
    let all = fixtures();
    let path = all.iter().position(|it| it.path.ends_with("EW001_unused_suppression.mod"));
    let mut fixture = all.into_iter().nth(path.unwrap()).unwrap();
    fixture.model = None;
    let findings = fixture.report().findings;
    let reported: Vec<&str> = findings
        .iter()
        .filter(|finding| finding.rule.code == "EW001")
        .map(|finding| finding.message.as_str())
        .collect();
    assert_eq!(reported, ["there is no rule EW999: joulepath rule lists them"]);
}

/// A program that only moves has no unnecessary movement.
#[test]
fn a_program_of_movements_alone_has_no_unnecessary_movement() {
    let program = |wait: &str| {
        format!(
            "MODULE M
                CONST robtarget p1:=[[600,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                CONST robtarget p2:=[[600,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                CONST robtarget p3:=[[700,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                PROC main()
                    MoveJ p3,v1000,fine,tool0;
                    {wait}
                    MoveJ p1,v1000,fine,tool0;
                    MoveJ p2,v1000,z50,tool0;
                    MoveJ p1,v1000,fine,tool0;
                    {wait}
                    MoveJ p2,v1000,z50,tool0;
                    MoveJ p3,v1000,z50,tool0;
                    MoveJ p1,v1000,z50,tool0;
                    MoveJ p2,v1000,fine,tool0;
                ENDPROC
            ENDMODULE"
        )
    };
    let codes = |text: &str| -> Vec<&'static str> {
        let report = Fixture::new("M.mod".into(), text).report();
        let codes = report.findings.iter().map(|finding| finding.rule.code);
        codes.filter(|code| ["EW402", "EW403"].contains(code)).collect()
    };
    assert_eq!(codes(&program("WaitTime 1;")), ["EW402", "EW403"]);
    assert!(codes(&program("")).is_empty());
}

/// A repeated pose is a home pose only if the program also ends there; a pose on the way is not.
#[test]
fn a_home_pose_is_at_the_start_and_the_end_of_a_program() {
    let program = |zone: &str, end: &str| {
        format!(
            "MODULE M
                CONST robtarget p1:=[[600,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                CONST robtarget p2:=[[600,200,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                CONST robtarget p3:=[[700,-200,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                PROC main()
                    MoveJ p1,v1000,fine,tool0;
                    MoveJ p2,v1000,fine,tool0;
                    WaitTime 1;
                    MoveJ p1,v1000,{zone},tool0;
                    MoveJ p3,v1000,fine,tool0;
                    WaitTime 1;
                    MoveJ p1,v1000,{zone},tool0;
                    MoveJ p2,v1000,fine,tool0;
                    WaitTime 1;
                    MoveJ {end},v1000,fine,tool0;
                ENDPROC
            ENDMODULE"
        )
    };
    let homes = |zone: &str, end: &str| {
        let report = Fixture::new("M.mod".into(), &program(zone, end)).report();
        report.findings.iter().filter(|finding| finding.rule.code == "EW406").count()
    };
    assert_eq!(homes("fine", "p1"), 2);
    assert_eq!(homes("z50", "p1"), 0);
    assert_eq!(homes("fine", "p3"), 0);
}

/// The position before the first movement is assumed, so that the first movement has no findings.
#[test]
fn the_first_movement_has_no_findings() {
    let text = "MODULE M
        ! robot: IRB1600-10/1.45
        CONST robtarget p1:=[[900,0,1000],[0.5,0,0.866,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST robtarget p2:=[[800,300,700],[0.5,0.2,0.8,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        PROC main()
            ConfL\\Off;
            MoveL p1,v1000,fine,tool0;
            MoveL p2,v1000,fine,tool0;
        ENDPROC
    ENDMODULE";
    let report = Fixture::new("M.mod".into(), text).report();
    let line = |finding: &Finding| finding.span.start as usize <= text.find("MoveL p2").unwrap();
    let early = report.findings.iter().filter(|it| ["EW404", "EW604"].contains(&it.rule.code));
    assert_eq!(early.filter(|finding| line(finding)).count(), 0);
}

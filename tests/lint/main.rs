//! Lint rules: true and false positives, savings, results of fixes.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod carried;
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
use joulepath::rapid::diagnostics::Severity;
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::Options;
use joulepath::tool::lint::ranking::{joules, top};
use joulepath::tool::lint::{
    ALL, Confidence, Family, Finding, Group, Job, Needs, Report, Settings, lint,
};

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
                CONST robtarget p3:=[[900,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                CONST robtarget p4:=[[700,300,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                PROC main()
                    MoveJ p3,v1000,fine,tool0;
                    {wait}
                    MoveJ p4,v1000,z50,tool0;
                    MoveJ p1,v1000,fine,tool0;
                    MoveJ p2,v1000,z50,tool0;
                    MoveJ p1,v1000,fine,tool0;
                    {wait}
                    MoveJ p4,v1000,z50,tool0;
                    MoveJ p2,v1000,z50,tool0;
                    MoveJ p3,v1000,z50,tool0;
                    MoveJ p1,v1000,z50,tool0;
                    MoveJ p2,v1000,z50,tool0;
                    MoveJ p4,v1000,fine,tool0;
                ENDPROC
            ENDMODULE"
        )
    };
    let codes = |text: &str| -> Vec<&'static str> {
        let report = Fixture::new("M.mod".into(), text).report();
        let doubtful = report.findings.iter().filter(|it| it.confidence == Confidence::Low);
        let codes = doubtful.map(|finding| finding.rule.code);
        codes.filter(|code| ["EW402", "EW403"].contains(code)).collect()
    };
    assert_eq!(codes(&program("WaitTime 1;")), ["EW402", "EW403"]);
    assert!(codes(&program("")).is_empty());
}

/// A repeated pose is a home pose only if the program also ends there, also where it is passed.
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
                    rAt p2;
                    MoveJ p1,v1000,{zone},tool0;
                    rAt p3;
                    MoveJ p1,v1000,{zone},tool0;
                    rAt p2;
                    MoveJ {end},v1000,fine,tool0;
                ENDPROC
                PROC rAt(robtarget p)
                    MoveJ Offs(p,0,0,100),v1000,z10,tool0;
                    MoveL p,v500,fine,tool0;
                    WaitTime 1;
                    MoveL Offs(p,0,0,100),v500,z10,tool0;
                ENDPROC
            ENDMODULE"
        )
    };
    let homes = |zone: &str, end: &str| {
        let report = Fixture::new("M.mod".into(), &program(zone, end)).report();
        report.findings.iter().filter(|finding| finding.rule.code == "EW406").count()
    };
    assert_eq!(homes("fine", "p1"), 2);
    assert_eq!(homes("z50", "p1"), 2);
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

/// A lift behind a grip is no trip home, and no finding proposes to leave it out, whatever else it looks
/// like; nothing touches what is drilled.
#[test]
fn nothing_is_proposed_next_to_work_or_for_a_process() {
    let text = "MODULE M
        ! robot: IRB1600-10/1.45
        CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST robtarget p1:=[[900,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST robtarget p2:=[[700,400,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST speeddata vDrill:=[4,500,5000,1000];
        PROC main()
            MoveAbsJ jHome,v1000,fine,tool0;
            MoveJ p1,v1000,fine,tool0;
            Set doGrip;
            MoveAbsJ jHome,v1000,fine,tool0;
            MoveJ p2,v1000,fine,tool0;
            Reset doGrip;
            MoveAbsJ jHome,v1000,fine,tool0;
            MoveJ p2,v1000,fine,tool0;
            WaitTime 1;
            MoveL Offs(p2,0,0,-4),vDrill,fine,tool0;
            MoveL Offs(p2,0,0,-8),vDrill,fine,tool0;
            MoveL Offs(p2,0,0,-12),vDrill,fine,tool0;
            MoveL p2,v200,fine,tool0;
            MoveAbsJ jHome,v1000,fine,tool0;
        ENDPROC
    ENDMODULE";
    let report = Fixture::new("M.mod".into(), text).report();
    for finding in report.findings.iter().filter(|it| it.saving.is_some() || it.fix.is_some()) {
        let line = text[finding.span.start as usize..finding.span.end as usize].to_owned();
        let drills = line.contains("vDrill");
        let removes = finding.change.starts_with("leaving out");
        assert!(!drills && !removes, "{line}: {}", finding.full_message());
    }
}

/// Where the main routine is a menu or missing, each procedure that it may start is simulated by itself.
#[test]
fn procedures_of_a_menu_are_simulated_by_themselves() {
    let program = |main: &str| {
        format!(
            "MODULE M
                ! robot: IRB1600-10/1.45
                CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                CONST jointtarget jOut:=[[40,20,10,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                {main}
                PROC rOne()
                    rAway;
                    WaitTime 1;
                    MoveAbsJ jHome,v1000,fine,tool0;
                ENDPROC
                PROC rTwo()
                    MoveAbsJ jHome,v1000,fine,tool0;
                    MoveAbsJ jOut,v1000,fine,tool0;
                ENDPROC
                PROC rAway()
                    MoveAbsJ jHome,v1000,fine,tool0;
                    MoveAbsJ jOut,v1000,fine,tool0;
                ENDPROC
                PROC rWith(num x)
                    MoveAbsJ jOut,v1000,fine,tool0;
                ENDPROC
            ENDMODULE"
        )
    };
    let menu = "VAR num nJob;
        PROC main()
            TPReadFK nJob,\"Job\",\"1\",\"2\",stEmpty,stEmpty,stEmpty;
            TEST nJob
            CASE 1: rOne;
            CASE 2: rTwo;
            ENDTEST
        ENDPROC";
    for main in ["", menu] {
        let report = Fixture::new("M.mod".into(), &program(main)).report();
        let coverage = &report.coverage;
        assert_eq!((coverage.simulated, coverage.movements), (5, 6), "{:?}", coverage.missing);
        assert!(coverage.note().unwrap().starts_with("5 of 6 movements simulated; 1: "));
        assert!(report.cycle_energy_j.is_some());
    }
    // A procedure that a complete program does not call is none of its cycle.
    let whole = Fixture::new("M.mod".into(), &program("PROC main() rTwo; ENDPROC")).report();
    assert_eq!(whole.coverage.simulated, 2);
    // Neither is one that it calls after an error or at an interrupt.
    let main = "VAR intnum nStop;
        PROC main()
            CONNECT nStop WITH tStop;
            rTwo;
        ERROR
            rAway;
            RETRY;
        ENDPROC
        TRAP tStop
            rOne;
        ENDTRAP";
    let failing = Fixture::new("M.mod".into(), &program(main)).report();
    assert_eq!(failing.coverage.simulated, 2, "{:?}", failing.coverage.missing);
    assert_eq!(failing.cycle_energy_j, whole.cycle_energy_j);
}

/// A finding without joules says what would tell them; one with joules needs nothing.
#[test]
fn findings_without_joules_say_what_they_need() {
    let text = "MODULE M
        ! robot: IRB1600-10/1.45
        PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[-1,[0,0,0],[1,0,0,0],0,0,0]];
        PERS tooldata tArm:=[TRUE,[[0,0,120],[1,0,0,0]],[1.8,[0,0,52],[1,0,0,0],0.004,0.004,0.002]];
        CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST jointtarget jOut:=[[40,20,10,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST robtarget pA:=[[900,300,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST robtarget pB:=[[1000,-200,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        CONST robtarget pC:=[[800,-200,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        PROC main()
            MoveAbsJ jHome,v1000,fine,tArm;
            MoveAbsJ jOut,v1000,fine,tGrip;
            IF diOther=1 THEN
                MoveJ pA,v1000,fine,tArm;
                MoveJ pB,v1000,z1,tArm;
                MoveJ pC,v1000,fine,tArm;
            ENDIF
            WaitTime 1;
        ENDPROC
    ENDMODULE";
    let findings = Fixture::new("M.mod".into(), text).report().findings;
    let needs = |family: Family| {
        let own = findings.iter().filter(move |it| it.rule.family == family);
        own.filter_map(|it| it.needs.as_deref()).collect::<Vec<_>>()
    };
    assert!(needs(Family::Load).iter().any(|it| it.contains("LoadIdentify")), "{findings:?}");
    assert!(needs(Family::Stops).iter().any(|it| it.contains("--input")), "{findings:?}");
    assert!(findings.iter().all(|it| it.saving.is_none() || it.needs.is_none()));
}

/// The list of things to fix is by joules, the doubtful ones last.
#[test]
fn the_list_of_things_to_fix_begins_with_the_most_joules() {
    let mut listed = 0;
    for fixture in fixtures() {
        let report = fixture.report();
        let list = top(&report.findings, 3);
        let low = |finding: &&&Finding| finding.confidence == Confidence::Low;
        assert!(list.len() <= 3 && list.iter().skip_while(|it| !low(it)).all(|it| low(&it)));
        for pair in list.windows(2).filter(|pair| pair[0].confidence == pair[1].confidence) {
            assert!(joules(pair[0]) >= joules(pair[1]));
        }
        let worth = |finding: &&Finding| finding.severity > Severity::Info;
        for finding in report.findings.iter().filter(worth) {
            let share = finding.saving.zip(finding.cycle).map(|(a, b)| a.energy_j / b.energy_j);
            assert!(share.is_none_or(|share| share >= 0.01), "{}", finding.full_message());
            assert!(finding.confidence == Confidence::Usual, "{}", finding.full_message());
        }
        listed += list.len();
    }
    assert!(listed > 20, "{listed}");
}

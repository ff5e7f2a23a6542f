//! The steps of a campaign. A step is done when its result is there.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::Value;

use super::state::State;
use crate::tool::cli::output;
use crate::tool::report::campaign::Done;

/// The steps of a campaign in its folder.
pub(super) struct Steps<'a> {
    folder: &'a Path,
    state: &'a State,
}

/// A command of joulepath.
pub(super) struct Step {
    /// Its name.
    pub(super) name: &'static str,
    arguments: Vec<String>,
    /// Where its JSON goes.
    result: PathBuf,
}

/// What comes next.
pub(super) enum Next {
    /// A command.
    Do(Step),
    /// Something in the cell.
    InTheCell(String),
    /// Nothing.
    Finished,
}

impl Next {
    /// What to do, in words.
    pub(super) fn text(&self) -> String {
        match self {
            Next::Do(_) => String::new(),
            Next::InTheCell(text) => text.clone(),
            Next::Finished => {
                "nothing: the saving is proved or refuted, see report.html".to_owned()
            }
        }
    }
}

impl Step {
    /// The command line.
    pub(super) fn shown(&self) -> String {
        format!("joulepath {}", self.arguments.join(" "))
    }

    /// Runs it and keeps its JSON.
    pub(super) fn execute(&self) -> anyhow::Result<()> {
        let program = std::env::current_exe().context("cannot find the joulepath that runs")?;
        let mut command = Command::new(program);
        command.args(&self.arguments).args(["--format", "json", "--quiet"]);
        let output = command.output().with_context(|| format!("cannot run {}", self.shown()))?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            bail!("{}: {}", self.shown(), message.trim().trim_start_matches("error: "));
        }
        output::write(&self.result, &output.stdout)
    }
}

impl<'a> Steps<'a> {
    pub(super) fn new(folder: &'a Path, state: &'a State) -> Steps<'a> {
        Steps { folder, state }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }

    /// The logs in a folder, in the order of their names.
    fn logs(&self, name: &str) -> anyhow::Result<Vec<String>> {
        let folder = self.path(name);
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let failed = || format!("cannot read '{}'", folder.display());
        let mut logs = Vec::new();
        for entry in std::fs::read_dir(&folder).with_context(failed)? {
            let path = entry.with_context(failed)?.path();
            if path.extension().is_some_and(|extension| extension == "csv") {
                logs.push(path.display().to_string());
            }
        }
        logs.sort();
        Ok(logs)
    }

    /// The logs of events among some logs.
    fn of_events(logs: &[String]) -> anyhow::Result<Vec<String>> {
        let mut found = Vec::new();
        for log in logs {
            let bytes = std::fs::read(log).with_context(|| format!("cannot read '{log}'"))?;
            if crate::tool::cell::events::is_event_log(&bytes) {
                found.push(log.clone());
            }
        }
        Ok(found)
    }

    /// The next step.
    pub(super) fn next(&self) -> anyhow::Result<Next> {
        let program = &self.state.program;
        let has = |name: &str| self.path(name).exists();
        if !has("recorded.json") {
            return Ok(self.instrument(program, "recorded"));
        }
        let before = self.logs("logs/before")?;
        if before.is_empty() {
            return Ok(self.shift("recorded", "logs/before"));
        }
        if !has("waits.json") {
            let events = Steps::of_events(&before)?;
            if events.is_empty() {
                bail!(
                    "no log in '{}' is one of the recorder: copy HOME:/jr_….csv of the controller there",
                    self.text("logs/before")
                );
            }
            let mut arguments = vec!["waits".to_owned()];
            arguments.extend(events);
            arguments.extend(["--program".into(), program.clone(), "--out".into()]);
            arguments.extend([self.text("waits.toml"), "--report".into(), self.text("waits.html")]);
            return Ok(self.step("waits", arguments, "waits.json"));
        }
        if !has("optimized.json") {
            let mut arguments = vec!["optimize".to_owned(), program.clone()];
            arguments.extend(["--waits".into(), self.text("waits.toml")]);
            for (option, value) in [("--risk", &self.state.risk), ("--robot", &self.state.robot)] {
                arguments.extend(value.iter().flat_map(|it| [option.to_owned(), it.clone()]));
            }
            arguments.extend(["--out".into(), self.text("optimized"), "--report".into()]);
            arguments.push(self.text("optimized.html"));
            return Ok(self.step("optimize", arguments, "optimized.json"));
        }
        if !has("recorded-after.json") {
            return Ok(self.instrument(&self.text("optimized"), "recorded-after"));
        }
        let after = self.logs("logs/after")?;
        if after.is_empty() {
            return Ok(self.shift("recorded-after", "logs/after"));
        }
        if !has("proof.json") {
            let mut arguments = vec!["prove".to_owned(), "--before".to_owned()];
            arguments.extend(before);
            arguments.push("--after".to_owned());
            arguments.extend(after);
            arguments.extend(self.promised()?);
            arguments.extend(["--report".into(), self.text("proof.html")]);
            return Ok(self.step("prove", arguments, "proof.json"));
        }
        Ok(Next::Finished)
    }

    fn step(&self, name: &'static str, arguments: Vec<String>, result: &str) -> Next {
        Next::Do(Step { name, arguments, result: self.path(result) })
    }

    fn instrument(&self, program: &str, to: &str) -> Next {
        let mut arguments = vec!["instrument".to_owned(), program.to_owned()];
        let robot = self.state.robot.iter();
        arguments.extend(robot.flat_map(|robot| ["--robot".to_owned(), robot.clone()]));
        if self.state.robot.is_none() {
            // A retrofitted program lies elsewhere than the configuration of the original.
            let configured = crate::tool::config::candidates(Path::new(&self.state.program));
            let file = configured.into_iter().find(|path| path.is_file());
            let file = file.map(|path| path.display().to_string());
            arguments.extend(file.into_iter().flat_map(|file| ["--config".to_owned(), file]));
        }
        arguments.extend(["--out".to_owned(), self.text(to)]);
        self.step("instrument", arguments, &format!("{to}.json"))
    }

    fn shift(&self, program: &str, logs: &str) -> Next {
        Next::InTheCell(format!(
            "load {} into the controller, run it for a shift, and copy its log HOME:/jr_….csv and the log of the \
             power meter (t, power) into {}",
            self.text(program),
            self.text(logs)
        ))
    }

    /// The option with the saving that `optimize` promised.
    fn promised(&self) -> anyhow::Result<Vec<String>> {
        let result = self.result("optimized.json")?;
        let percent = result["saving_percent"].as_f64();
        Ok(percent.map_or_else(Vec::new, |x| vec![format!("--promised={x:.3}%")]))
    }

    fn result(&self, name: &str) -> anyhow::Result<Value> {
        let path = self.path(name);
        let shown = path.display();
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read '{shown}'"))?;
        serde_json::from_str(&text).with_context(|| {
            format!("'{shown}' is not what joulepath wrote; delete it to have the step done again")
        })
    }

    /// The steps that are done, each with its page.
    pub(super) fn done(&self) -> Vec<Done> {
        let step = |name: &'static str, result: &str, page: Option<&str>| {
            let is_done = self.path(result).exists();
            let page = page.filter(|page| self.path(page).exists()).map(str::to_owned);
            Done { name, is_done, page }
        };
        let logged = |name: &'static str, folder: &str| Done {
            name,
            is_done: self.logs(folder).is_ok_and(|logs| !logs.is_empty()),
            page: None,
        };
        vec![
            step("recorder put in", "recorded.json", None),
            logged("recorded before", "logs/before"),
            step("waits found", "waits.json", Some("waits.html")),
            step("program retrofitted", "optimized.json", Some("optimized.html")),
            step("recorder put into the retrofit", "recorded-after.json", None),
            logged("recorded after", "logs/after"),
            step("saving proved", "proof.json", Some("proof.html")),
        ]
    }

    /// What the steps found, for the report: a line each.
    pub(super) fn figures(&self) -> anyhow::Result<Vec<String>> {
        let mut lines = Vec::new();
        for (name, line) in [
            (
                "recorded.json",
                crate::tool::report::campaign::recorded as fn(&Value) -> Option<String>,
            ),
            ("waits.json", crate::tool::report::campaign::waits),
            ("optimized.json", crate::tool::report::campaign::promised),
            ("proof.json", crate::tool::report::campaign::proved),
        ] {
            if self.path(name).exists() {
                lines.extend(line(&self.result(name)?));
            }
        }
        Ok(lines)
    }
}

//! The steps of a campaign. A step is done when its result is there.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::Value;

use super::inputs::Inputs;
use super::state::State;
use crate::tool::cli::output;
use crate::tool::report::campaign::Done;
use crate::tool::report::diagnose::quoted;

/// The steps of a campaign in its folder.
pub(super) struct Steps<'a> {
    folder: &'a Path,
    state: &'a State,
    inputs: Inputs,
}

/// A command of joulepath.
pub(super) struct Step {
    /// Its name.
    pub(super) name: &'static str,
    arguments: Vec<String>,
    /// The file of its JSON.
    result: &'static str,
    /// What it is made from.
    inputs: Vec<PathBuf>,
}

/// What comes next.
pub(super) enum Next {
    /// A command.
    Do(Step),
    /// Something in the cell, or by the user.
    ByUser(String),
    /// Nothing: the outcome.
    Finished(String),
}

impl Next {
    /// What to do, in words.
    pub(super) fn text(&self) -> &str {
        match self {
            Next::Do(_) => "",
            Next::ByUser(text) | Next::Finished(text) => text,
        }
    }
}

/// Whether a step is to be done.
enum Due {
    No,
    Yes,
    /// Its result is in use, but what it was made from has changed: what to do.
    Changed(String),
}

impl Step {
    /// The command line.
    pub(super) fn shown(&self) -> String {
        let words: Vec<String> = self.arguments.iter().map(|word| quoted(word)).collect();
        format!("joulepath {}", words.join(" "))
    }

    /// Runs it: its JSON.
    fn run(&self) -> anyhow::Result<Vec<u8>> {
        let program = std::env::current_exe().context("cannot find the joulepath that runs")?;
        let mut command = Command::new(program);
        command.args(&self.arguments).args(["--format", "json", "--quiet"]);
        let output = command.output().with_context(|| format!("cannot run {}", self.shown()))?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            bail!("{}: {}", self.shown(), message.trim().trim_start_matches("error: "));
        }
        Ok(output.stdout)
    }
}

impl<'a> Steps<'a> {
    pub(super) fn new(folder: &'a Path, state: &'a State) -> anyhow::Result<Steps<'a>> {
        Ok(Steps { folder, state, inputs: Inputs::read(folder)? })
    }

    /// Runs a step, keeps its JSON, and notes what it was made from.
    pub(super) fn execute(&mut self, step: &Step) -> anyhow::Result<()> {
        let json = step.run()?;
        output::write(&self.path(step.result), &json)?;
        self.inputs.note(step.result, &step.inputs)
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

    /// Whether a step is to be done, which writes `outputs` beside its result. `is_used`: the cell or a
    /// later step has its result already.
    fn due(&self, step: &Step, outputs: &[&str], is_used: bool) -> anyhow::Result<Due> {
        let is_there = |name: &&str| self.path(name).exists();
        if !is_there(&step.result) {
            return Ok(Due::Yes);
        }
        let gone = outputs.iter().filter(|name| !is_there(name));
        let mut changes: Vec<String> =
            gone.map(|name| format!("{} is gone", self.text(name))).collect();
        changes.extend(self.inputs.changes(step.result, &step.inputs)?);
        Ok(match (changes.is_empty(), is_used) {
            (true, _) => Due::No,
            (false, false) => Due::Yes,
            (false, true) => Due::Changed(format!(
                "{}: what runs in the cell was made from other files ({}). Put these back, or delete {} and the \
                 results of the later steps to go on with what is there now",
                step.name,
                changes.join(", "),
                self.text(step.result)
            )),
        })
    }

    /// The next step.
    pub(super) fn next(&self) -> anyhow::Result<Next> {
        let [before, after] = [self.logs("logs/before")?, self.logs("logs/after")?];
        let is_in_cell = self.path("recorded-after.json").exists();
        let events = Steps::of_events(&before)?;

        let step = self.instrument(&self.state.program, ["recorded", "recorded.json"]);
        if let Some(next) = self.as_next(step, &["recorded"], !before.is_empty())? {
            return Ok(next);
        }
        if before.is_empty() {
            return Ok(self.shift("recorded", "logs/before"));
        }
        if events.is_empty() {
            bail!(
                "no log in '{}' is one of the recorder: copy HOME:/jr_….csv of the controller there",
                self.text("logs/before")
            );
        }
        if let Some(next) = self.as_next(self.waits(events), &["waits.toml"], is_in_cell)? {
            return Ok(next);
        }
        if let Some(next) = self.as_next(self.optimize(), &["optimized"], is_in_cell)? {
            return Ok(next);
        }
        let step =
            self.instrument(&self.text("optimized"), ["recorded-after", "recorded-after.json"]);
        if let Some(next) = self.as_next(step, &["recorded-after"], !after.is_empty())? {
            return Ok(next);
        }
        if after.is_empty() {
            return Ok(self.shift("recorded-after", "logs/after"));
        }
        if let Some(next) = self.as_next(self.prove(before, after)?, &[], false)? {
            return Ok(next);
        }
        self.outcome()
    }

    fn as_next(&self, step: Step, outputs: &[&str], is_used: bool) -> anyhow::Result<Option<Next>> {
        Ok(match self.due(&step, outputs, is_used)? {
            Due::No => None,
            Due::Yes => Some(Next::Do(step)),
            Due::Changed(text) => Some(Next::ByUser(text)),
        })
    }

    fn instrument(&self, program: &str, [to, result]: [&'static str; 2]) -> Step {
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
        Step { name: "instrument", arguments, result, inputs: vec![PathBuf::from(program)] }
    }

    fn waits(&self, events: Vec<String>) -> Step {
        let program = &self.state.program;
        let inputs = events.iter().chain([program]).map(PathBuf::from).collect();
        let mut arguments = vec!["waits".to_owned()];
        arguments.extend(events);
        arguments.extend(["--program".into(), program.clone(), "--out".into()]);
        arguments.extend([self.text("waits.toml"), "--report".into(), self.text("waits.html")]);
        Step { name: "waits", arguments, result: "waits.json", inputs }
    }

    fn optimize(&self) -> Step {
        let program = &self.state.program;
        let mut arguments = vec!["optimize".to_owned(), program.clone()];
        arguments.extend(["--waits".into(), self.text("waits.toml")]);
        for (option, value) in [("--risk", &self.state.risk), ("--robot", &self.state.robot)] {
            arguments.extend(value.iter().flat_map(|it| [option.to_owned(), it.clone()]));
        }
        arguments.extend(["--out".into(), self.text("optimized"), "--report".into()]);
        arguments.push(self.text("optimized.html"));
        let inputs = vec![PathBuf::from(program), self.path("waits.toml")];
        Step { name: "optimize", arguments, result: "optimized.json", inputs }
    }

    fn prove(&self, before: Vec<String>, after: Vec<String>) -> anyhow::Result<Step> {
        let inputs = before.iter().chain(&after).map(PathBuf::from).collect();
        let mut arguments = vec!["prove".to_owned(), "--before".to_owned()];
        arguments.extend(before);
        arguments.push("--after".to_owned());
        arguments.extend(after);
        arguments.extend(self.promised()?);
        arguments.extend(["--report".into(), self.text("proof.html")]);
        Ok(Step { name: "prove", arguments, result: "proof.json", inputs })
    }

    /// What the proof says, and what follows from it.
    fn outcome(&self) -> anyhow::Result<Next> {
        let proof = self.result("proof.json")?;
        let sentence = proof["sentence"].as_str().unwrap_or_default();
        Ok(match proof["verdict"].as_str() {
            Some("too_few_cycles") => Next::ByUser(format!(
                "record more cycles, {} on each side, and copy the logs beside those in {} and {}: {sentence}",
                proof["cycles"]["needed"],
                self.text("logs/before"),
                self.text("logs/after")
            )),
            Some("costs") => Next::Finished(format!("load the original program again: {sentence}")),
            _ => Next::Finished(format!("nothing: {sentence}")),
        })
    }

    fn shift(&self, program: &str, logs: &str) -> Next {
        Next::ByUser(format!(
            "load {} into the controller, run it for a shift, and copy its log HOME:/jr_….csv and the log of the \
             power meter (t, power) into {}",
            self.text(program),
            self.text(logs)
        ))
    }

    /// The option with the saving that `optimize` promised.
    fn promised(&self) -> anyhow::Result<Vec<String>> {
        let result = self.result("optimized.json")?;
        let percent = result["waits"]["expected_saving_percent"].as_f64();
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
        let is_shown = |proof: &Value| proof["verdict"] != "too_few_cycles";
        let mut proved = step("saving measured", "proof.json", Some("proof.html"));
        proved.is_done &= self.result("proof.json").is_ok_and(|proof| is_shown(&proof));
        vec![
            step("recorder put in", "recorded.json", None),
            logged("recorded before", "logs/before"),
            step("waits found", "waits.json", Some("waits.html")),
            step("program retrofitted", "optimized.json", Some("optimized.html")),
            step("recorder put into the retrofit", "recorded-after.json", None),
            logged("recorded after", "logs/after"),
            proved,
        ]
    }

    /// The commands that would tell what waits are of which the log does not, while the retrofit is not
    /// in the cell.
    pub(super) fn proposals(&self) -> anyhow::Result<Vec<String>> {
        let path = "waits.json";
        if !self.path(path).exists() || self.path("recorded-after.json").exists() {
            return Ok(Vec::new());
        }
        let result = self.result(path)?;
        let waits = result["waits"].as_array().cloned().unwrap_or_default();
        let command = |wait: &Value| wait["experiment"]["command"].as_str().map(str::to_owned);
        Ok(waits.iter().filter_map(command).collect())
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

//! What a rule is, and what it finds.

use super::context::Context;
use super::saving::Saving;
use crate::rapid::diagnostics::Severity;
use crate::rapid::text::{Edit, Span};

/// What rules are about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Comments of the linter itself.
    Comments,
    /// Stop points and zones.
    Stops,
    /// Speeds and accelerations.
    Speed,
    /// Waits.
    Dwell,
    /// Where movements lead.
    Path,
    /// Tool and payload data.
    Load,
    /// Motion settings.
    Settings,
    /// The program's structure.
    Program,
    /// The controller's configuration.
    System,
}

impl Family {
    /// Its name: a selector of all its rules.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Family::Comments => "comments",
            Family::Stops => "stops",
            Family::Speed => "speed",
            Family::Dwell => "dwell",
            Family::Path => "path",
            Family::Load => "load",
            Family::Settings => "settings",
            Family::Program => "program",
            Family::System => "system",
        }
    }
}

/// What a rule has to know to find anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// The text.
    Text,
    /// The robot too.
    Robot,
    /// A controller's backup.
    Backup,
}

/// A rule.
pub struct Rule {
    /// `EW101` …: the family's digit and a number.
    pub code: &'static str,
    /// The bad pattern.
    pub name: &'static str,
    /// What it is about.
    pub family: Family,
    /// What it has to know.
    pub needs: Needs,
    /// How much a finding matters.
    pub severity: Severity,
    /// The rule's own file: its doc comment is the manual.
    pub(super) source: &'static str,
    /// Finds it.
    pub(super) check: fn(&Context<'_>, &mut Vec<Finding>),
}

impl Rule {
    /// The manual, as Markdown: a sentence, then chapters (`## What it does` …).
    #[must_use]
    pub fn manual(&self) -> String {
        let lines = self.source.lines().map_while(|line| line.strip_prefix("//!"));
        let lines = lines.map(|line| line.strip_prefix(' ').unwrap_or(line));
        let mut out = lines.collect::<Vec<_>>().join("\n");
        out.push('\n');
        out
    }

    /// The first sentence of the manual.
    #[must_use]
    pub fn summary(&self) -> String {
        let manual = self.manual();
        manual.split("\n\n").next().unwrap_or_default().replace('\n', " ")
    }

    /// Whether a selector means it: its code, the start of its code, its name, or its family.
    #[must_use]
    pub fn is_meant(&self, selector: &str) -> bool {
        let selector = selector.trim();
        let code = selector.to_ascii_uppercase();
        code == "ALL"
            || (code.starts_with("EW") && self.code.starts_with(&code))
            || selector.eq_ignore_ascii_case(self.name)
            || selector.eq_ignore_ascii_case(self.family.name())
    }
}

impl std::fmt::Debug for Rule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.code, self.name)
    }
}

/// Something that wastes energy.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// The place.
    pub span: Span,
    /// What is wrong there, without the saving: lower case, no full stop.
    pub message: String,
    /// The change that saves, in words: "`z50` in place of `fine`".
    pub change: String,
    /// What the change saves in a cycle; `None` where it cannot be simulated.
    pub saving: Option<Saving>,
    /// What it rests on.
    pub assumptions: Vec<String>,
    /// The change as edits.
    pub fix: Option<Fix>,
    /// Other places that explain it.
    pub related: Vec<(Span, String)>,
}

impl Finding {
    /// A finding with a message alone.
    pub fn new(rule: &'static Rule, span: Span, message: impl Into<String>) -> Finding {
        Finding {
            rule,
            span,
            message: message.into(),
            change: String::new(),
            saving: None,
            assumptions: Vec::new(),
            fix: None,
            related: Vec::new(),
        }
    }

    /// The message, with what the change saves and how to reproduce it.
    #[must_use]
    pub fn full_message(&self) -> String {
        let Some(saving) = &self.saving else { return self.message.clone() };
        let time = match saving.time_s {
            t if t >= 0.0005 => format!(" and {t:.3} s"),
            t if t <= -0.0005 => format!(" and takes {:.3} s more", -t),
            _ => String::new(),
        };
        format!(
            "{}; {} saves {:.1} J ({:.1} to {:.1} J){time} per cycle: joulepath simulate before and \
             after that edit shows it",
            self.message, self.change, saving.energy_j, saving.low_j, saving.high_j
        )
    }
}

/// Whether the process stays the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Applicability {
    /// Provably: same path, same order, same end points.
    Safe,
    /// Somebody has to look at it first.
    Unsafe,
}

impl Applicability {
    /// Its name in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Applicability::Safe => "safe",
            Applicability::Unsafe => "unsafe",
        }
    }
}

/// A change of the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Fix {
    /// Whether the process stays the same.
    pub applicability: Applicability,
    /// What to replace; all or nothing.
    pub edits: Vec<Edit>,
}

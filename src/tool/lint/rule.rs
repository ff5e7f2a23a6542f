//! What a rule is.

use super::context::Context;
use super::finding::Finding;
use crate::rapid::diagnostics::Severity;

/// Headings that every manual has, in order.
pub const HEADINGS: [&str; 7] = [
    "What it does",
    "Why it wastes energy",
    "How the saving is computed",
    "Example",
    "Use instead",
    "Safety",
    "Assumptions",
];

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
    /// All, in the order of their codes.
    pub const ALL: [Family; 9] = [
        Family::Comments,
        Family::Stops,
        Family::Speed,
        Family::Dwell,
        Family::Path,
        Family::Load,
        Family::Settings,
        Family::Program,
        Family::System,
    ];

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
    /// The manual, as Markdown: a sentence, then a chapter for each of [`HEADINGS`].
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

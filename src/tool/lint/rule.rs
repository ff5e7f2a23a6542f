//! The types of rules and findings.

use super::context::Context;
use super::saving::Saving;
use crate::rapid::diagnostics::Severity;
use crate::rapid::text::{Edit, Span};

/// The subject of a rule.
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
    /// Targets of movements.
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
    /// Its name, which selects all its rules.
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

/// The input that a rule requires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Only the text.
    Text,
    /// The robot, too.
    Robot,
    /// A backup of the controller.
    Backup,
}

/// A rule.
pub struct Rule {
    /// `EW101` …: the family's digit and a number.
    pub code: &'static str,
    /// Name of the wasteful pattern.
    pub name: &'static str,
    /// The subject.
    pub family: Family,
    /// The required input.
    pub needs: Needs,
    /// Severity of a finding.
    pub severity: Severity,
    /// The rule's source file: its doc comment is the manual.
    pub(super) source: &'static str,
    /// Finds the pattern.
    pub(super) check: fn(&Context<'_>, &mut Vec<Finding>),
}

impl Rule {
    /// The manual as Markdown: a sentence, then chapters (`## What it does` …).
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

    /// Whether a selector matches it: its code, a prefix of its code, its name, or its family.
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

/// A place that wastes energy.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// The place.
    pub span: Span,
    /// The problem without the saving: lower case, no full stop.
    pub message: String,
    /// The saving change in words, such as "`z50` in place of `fine`".
    pub change: String,
    /// Saving of the change in a cycle; `None` if it cannot be simulated.
    pub saving: Option<Saving>,
    /// Assumptions of the saving.
    pub assumptions: Vec<String>,
    /// The change as edits.
    pub fix: Option<Fix>,
    /// Related places.
    pub related: Vec<(Span, String)>,
    /// By the joules and the confidence; before they are known that of the rule.
    pub severity: Severity,
    /// How sure the rule is.
    pub confidence: Confidence,
    /// Energy in a cycle of what the change shortens by an unknown part, J: no saving, but its limit.
    pub at_stake_j: Option<f64>,
    /// What would tell its joules, if they are not known.
    pub needs: Option<String>,
    /// Number of places that it stands for.
    pub count: usize,
    /// The cycle that it belongs to, if it is simulated with energies.
    pub cycle: Option<CycleFigures>,
}

/// What a cycle takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleFigures {
    /// J.
    pub energy_j: f64,
    /// s.
    pub time_s: f64,
}

/// How sure a rule is that a finding is waste.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confidence {
    /// Only who knows the cell can tell waste from a need of the process.
    Low,
    /// Waste, unless the cell has a reason that no program shows.
    Usual,
}

impl Confidence {
    /// Its name in outputs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Confidence::Low => "low",
            Confidence::Usual => "usual",
        }
    }
}

impl Finding {
    /// A finding with only a message.
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
            severity: rule.severity,
            confidence: Confidence::Usual,
            at_stake_j: None,
            needs: None,
            count: 1,
            cycle: None,
        }
    }

    /// The finding as one of which the rule is not sure.
    #[must_use]
    pub fn doubtful(self) -> Finding {
        Finding { confidence: Confidence::Low, ..self }
    }

    /// The finding as one for several places.
    #[must_use]
    pub fn for_places(self, count: usize) -> Finding {
        Finding { count, ..self }
    }

    /// The finding with the energy in a cycle of what the change shortens, J.
    #[must_use]
    pub fn with_at_stake(self, joules: Option<f64>) -> Finding {
        Finding { at_stake_j: joules, ..self }
    }

    /// The finding with a change in words, and its saving if that is known.
    #[must_use]
    pub fn with_saving(
        self,
        change: impl Into<String>,
        saving: impl Into<Option<Saving>>,
    ) -> Finding {
        Finding { change: change.into(), saving: saving.into(), ..self }
    }

    /// The finding with what would tell its joules.
    #[must_use]
    pub fn needing(self, needs: &str) -> Finding {
        Finding { needs: Some(needs.to_owned()), ..self }
    }

    /// The finding with a further assumption of the saving.
    #[must_use]
    pub fn with_assumption(mut self, assumption: impl Into<String>) -> Finding {
        self.assumptions.push(assumption.into());
        self
    }

    /// The finding with a further related place.
    #[must_use]
    pub fn with_related(mut self, span: Span, text: impl Into<String>) -> Finding {
        self.related.push((span, text.into()));
        self
    }

    /// The finding with a fix that the user must review; without edits there is none.
    #[must_use]
    pub fn with_unsafe_fix(self, edits: impl IntoIterator<Item = Edit>) -> Finding {
        let edits: Vec<Edit> = edits.into_iter().collect();
        let fix = Fix { applicability: Applicability::Unsafe, edits };
        Finding { fix: (!fix.edits.is_empty()).then_some(fix), ..self }
    }

    /// The message with the saving, and how to reproduce it.
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

/// Whether a fix keeps the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Applicability {
    /// Provably: same path, same order, same end points.
    Safe,
    /// The user must review it first.
    Unsafe,
}

impl Applicability {
    /// Its name in outputs.
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
    /// Whether it keeps the process.
    pub applicability: Applicability,
    /// The edits, to be applied together.
    pub edits: Vec<Edit>,
}

//! What a rule finds.

use super::rule::Rule;
use crate::rapid::text::{Edit, Span};

/// Something that wastes energy.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// The place.
    pub span: Span,
    /// What is wrong there, without the saving: lower case, no full stop.
    pub message: String,
    /// The change that the saving is of, as one says it: "`z50` in place of `fine`".
    pub change: String,
    /// What the change saves in a cycle; none where nothing honest can be said.
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

    /// The message with what the change saves and how to see that again.
    #[must_use]
    pub fn told(&self) -> String {
        let Some(saving) = &self.saving else { return self.message.clone() };
        let time = match saving.time_s {
            t if t >= 0.0005 => format!(" and {t:.3} s"),
            t if t <= -0.0005 => format!(" and takes {:.3} s more", -t),
            _ => String::new(),
        };
        format!(
            "{}; {} saves {:.1} J ({:.1} to {:.1} J){time} per {}: joulepath simulate before and \
             after that edit shows it",
            self.message,
            self.change,
            saving.energy_j,
            saving.low_j,
            saving.high_j,
            saving.per.name()
        )
    }
}

/// What a change saves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saving {
    /// J.
    pub energy_j: f64,
    /// J: 90 % of the plausible robots save more than `low_j` and less than `high_j`, 5 % on each side
    /// left out.
    pub low_j: f64,
    /// As before.
    pub high_j: f64,
    /// s; negative where the change takes longer.
    pub time_s: f64,
    /// How often.
    pub per: Per,
}

/// How often something is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// Each time that the statement is executed.
    Execution,
    /// In each simulated cycle, all executions together.
    Cycle,
}

impl Per {
    /// Its name in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Per::Execution => "execution",
            Per::Cycle => "cycle",
        }
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

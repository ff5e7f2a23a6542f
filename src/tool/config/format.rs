//! The section `[format]` of the configuration.

use serde::Deserialize;

use crate::rapid::format::{Indent, KeywordCase, Style};

/// Widest step of indentation.
const WIDEST: usize = 16;
/// Most blank lines in a row that can be asked for.
const MOST_BLANK_LINES: usize = 100;

/// Style of formatted programs; keys accept `_` instead of `-`.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Format {
    /// Spaces of one step of indentation.
    #[serde(alias = "indent_width")]
    pub indent_width: Option<usize>,
    /// Spaces, or one tab for each step.
    #[serde(alias = "indent_style")]
    pub indent_style: Option<IndentStyle>,
    /// Case of reserved words.
    #[serde(alias = "keyword_case")]
    pub keyword_case: Option<Case>,
    /// Largest number of blank lines in a row.
    #[serde(alias = "max_blank_lines")]
    pub max_blank_lines: Option<usize>,
}

/// What a step of indentation is made of.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum IndentStyle {
    /// As many as `indent-width` says.
    Spaces,
    /// One.
    Tabs,
}

/// Case of reserved words.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Case {
    /// `IF`.
    Upper,
    /// As written.
    Keep,
}

impl Format {
    /// The style of the formatter.
    #[must_use]
    pub fn style(&self) -> Style {
        let default = Style::default();
        let spaces = self.indent_width.map_or(default.indent, Indent::Spaces);
        Style {
            indent: match self.indent_style {
                Some(IndentStyle::Tabs) => Indent::Tab,
                Some(IndentStyle::Spaces) | None => spaces,
            },
            keywords: match self.keyword_case {
                Some(Case::Keep) => KeywordCase::Keep,
                Some(Case::Upper) | None => default.keywords,
            },
            blank_lines: self.max_blank_lines.unwrap_or(default.blank_lines),
        }
    }

    /// What is wrong with it, if anything.
    pub(super) fn fault(&self) -> Option<String> {
        if let Some(width) = self.indent_width.filter(|width| !(1..=WIDEST).contains(width)) {
            return Some(format!("[format]: indent-width = {width}: give 1 to {WIDEST} spaces"));
        }
        let lines = self.max_blank_lines.filter(|lines| *lines > MOST_BLANK_LINES)?;
        Some(format!("[format]: max-blank-lines = {lines}: give 0 to {MOST_BLANK_LINES}"))
    }
}

//! A formatter: it changes white space and the case of keywords, and nothing else.
//!
//! `layout` decides from the tree what begins a line and how far it is indented, `spacing` what stands
//! between two words, `edits` makes the changes, `check` reads the result again. What has a syntax error
//! stays as it is.

mod alignment;
mod check;
mod edits;
mod gap;
mod layout;
mod protected;
mod spacing;
mod style;
mod units;

use std::ops::Range;

use super::syntax::{self, Parse};
use super::text::{Edit, SourceFile, apply};
use check::is_same;
use edits::edits;
use protected::Protected;
pub use style::{Indent, KeywordCase, Style};

/// The edits that format a whole file. None where the result would not read as the same program.
#[must_use]
pub fn format(file: &SourceFile, style: &Style) -> Vec<Edit> {
    checked(file, style, None)
}

/// The edits that format the statements, declarations and comments that a range of bytes touches, and
/// no others.
#[cfg(any(feature = "internals", feature = "lsp"))]
#[must_use]
pub fn format_range(file: &SourceFile, range: Range<u32>, style: &Style) -> Vec<Edit> {
    checked(file, style, Some(&range))
}

fn checked(file: &SourceFile, style: &Style, range: Option<&Range<u32>>) -> Vec<Edit> {
    let parse = syntax::parse(&file.bytes);
    let attempt = |protected: &Protected| {
        let edits = edits(file, &parse, style, protected, range);
        reads_the_same(file, &parse, &edits).then_some(edits)
    };
    let lines = Protected::lines(file, &parse);
    // Recovery from an error looks at lines and columns: the rest of a routine with an error can have
    // another meaning with another layout.
    attempt(&lines).or_else(|| attempt(&lines.with_declarations(file, &parse))).unwrap_or_default()
}

fn reads_the_same(file: &SourceFile, parse: &Parse, edits: &[Edit]) -> bool {
    edits.is_empty()
        || apply(&file.bytes, edits)
            .is_ok_and(|bytes| is_same(&file.bytes, parse, &bytes, &syntax::parse(&bytes)))
}

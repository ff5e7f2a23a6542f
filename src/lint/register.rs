//! All rules.

use super::rule::Rule;
use super::rules;

/// Each rule once, by code.
pub static ALL: [&Rule; 4] = [
    &rules::unused_suppression::RULE,
    &rules::unneeded_stop_point::RULE,
    &rules::stop_in_line::RULE,
    &rules::racing_to_wait::RULE,
];

/// The rule of a code or a name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Rule> {
    let name = name.trim();
    ALL.into_iter()
        .find(|rule| rule.code.eq_ignore_ascii_case(name) || rule.name.eq_ignore_ascii_case(name))
}

//! Settings of the linter.

use std::collections::BTreeMap;

use super::rule::Rule;

/// Default threshold of a reported saving, J.
pub const THRESHOLD_J: f64 = 1.0;

/// Settings of the linter.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Enabled rules: codes, prefixes of codes, names or families.
    pub select: Vec<String>,
    /// Disabled rules, in the same form.
    pub ignore: Vec<String>,
    /// Disabled rules by path pattern with `*`, `**` and `?`.
    pub per_file_ignores: BTreeMap<String, Vec<String>>,
    /// Minimum reported saving, J.
    pub threshold_j: f64,
    /// The same by code, name or family, J.
    pub thresholds_j: BTreeMap<String, f64>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            select: vec!["ALL".to_owned()],
            ignore: Vec::new(),
            per_file_ignores: BTreeMap::new(),
            threshold_j: THRESHOLD_J,
            thresholds_j: BTreeMap::new(),
        }
    }
}

impl Settings {
    /// Whether a rule is enabled.
    pub fn selects(&self, rule: &Rule) -> bool {
        let any = |list: &[String]| list.iter().any(|selector| rule.is_meant(selector));
        any(&self.select) && !any(&self.ignore)
    }

    /// Whether a rule is disabled in a file.
    pub fn ignores_in(&self, rule: &Rule, path: &str) -> bool {
        self.per_file_ignores.iter().any(|(pattern, selectors)| {
            fits_path(pattern, path) && selectors.iter().any(|selector| rule.is_meant(selector))
        })
    }

    /// Minimum reported saving of a rule, J. The most specific key counts: code, name, prefix of
    /// the code, family.
    pub fn threshold_j(&self, rule: &Rule) -> f64 {
        let closeness = |key: &str| {
            if key.eq_ignore_ascii_case(rule.name) || key.eq_ignore_ascii_case(rule.code) {
                usize::MAX
            } else if rule.code.to_lowercase().starts_with(&key.to_lowercase()) {
                key.len()
            } else {
                usize::from(key.eq_ignore_ascii_case(rule.family.name()))
            }
        };
        let meant = self.thresholds_j.iter().filter(|(key, _)| rule.is_meant(key));
        meant.max_by_key(|(key, _)| closeness(key)).map_or(self.threshold_j, |(_, joules)| *joules)
    }
}

/// Whether a pattern matches a path, its file name, or its end after a `/`.
fn fits_path(pattern: &str, path: &str) -> bool {
    let starts = std::iter::once(0).chain(path.match_indices('/').map(|(at, _)| at + 1));
    let (pattern, path) = (pattern.to_lowercase(), path.to_lowercase());
    starts.into_iter().any(|at| fits(pattern.as_bytes(), path.as_bytes().get(at..).unwrap_or(&[])))
}

/// `*` matches anything except `/`, `**` anything, `?` one character.
fn fits(pattern: &[u8], text: &[u8]) -> bool {
    // Pattern positions reachable by the consumed text.
    let mut here = vec![false; pattern.len() + 1];
    here[0] = true;
    let spread = |here: &mut Vec<bool>| {
        for at in 0..pattern.len() {
            if here[at] && pattern[at] == b'*' {
                here[at + 1] = true;
            }
        }
    };
    spread(&mut here);
    for byte in text {
        let mut next = vec![false; pattern.len() + 1];
        for (at, sign) in pattern.iter().enumerate().filter(|(at, _)| here[*at]) {
            let doubled = pattern.get(at + 1) == Some(&b'*') || at > 0 && pattern[at - 1] == b'*';
            match sign {
                b'*' if *byte != b'/' || doubled => next[at] = true,
                b'*' => {}
                b'?' if *byte != b'/' => next[at + 1] = true,
                sign if sign == byte => next[at + 1] = true,
                _ => {}
            }
        }
        spread(&mut next);
        here = next;
    }
    here[pattern.len()]
}

#[cfg(test)]
mod tests {
    use super::super::rules::unneeded_stop_point::RULE;
    use super::*;

    #[test]
    fn the_closest_threshold_counts() {
        let thresholds = [("all", 1.0), ("stops", 2.0), ("EW1", 3.0), ("ew10", 4.0)];
        let mut settings = Settings::default();
        let threshold = |settings: &Settings| settings.threshold_j(&RULE);
        assert_eq!(threshold(&settings), THRESHOLD_J);
        for (key, joules) in thresholds {
            settings.thresholds_j.insert(key.to_owned(), joules);
            assert_eq!(threshold(&settings), joules, "{key}");
        }
        settings.thresholds_j.insert("EW101".to_owned(), 5.0);
        settings.thresholds_j.insert("EW2".to_owned(), 6.0);
        assert_eq!(threshold(&settings), 5.0);
    }

    #[test]
    fn patterns_fit_ends_of_paths() {
        for (pattern, path, fit) in [
            ("*.sys", "cell/User.sys", true),
            ("cell/*.sys", "a/cell/User.sys", true),
            ("cell/*.mod", "a/cell/b/M.mod", false),
            ("cell/**", "a/cell/b/M.mod", true),
            ("M?.mod", "m1.MOD", true),
            ("M.mod", "xM.mod", false),
        ] {
            assert_eq!(fits_path(pattern, path), fit, "{pattern} {path}");
        }
    }
}

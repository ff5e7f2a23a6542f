//! Robot names as people and controllers write them.
//!
//! `IRB 1600-10/1.45`, `irb1600_10_145`, `IRB1600-1.45` and the controller's
//! `ROB1_1600_1.45_10` are one robot: a type, and a payload and a reach, of
//! which one may be missing.

/// Largest share of letters that may differ in a suggestion.
const NEAR: f64 = 0.5;

/// What a name says.
#[derive(Debug, PartialEq)]
pub(super) struct Name {
    /// `1600`, `2600id`, `6650s`.
    kind: String,
    /// The numbers as written: payload \[kg\] and reach \[m, or cm without a point\].
    numbers: Vec<String>,
    /// Other words, such as `lid`.
    words: Vec<String>,
}

impl Name {
    /// Reads a name; any text has a reading.
    pub(super) fn parse(text: &str) -> Name {
        let lower = text.trim().to_lowercase();
        let mut tokens = lower
            .split(|c: char| !c.is_alphanumeric() && c != '.')
            .filter(|token| !token.is_empty())
            .map(|token| match token.strip_prefix("irb").or_else(|| token.strip_prefix("crb")) {
                Some(rest) => rest,
                None => token,
            })
            .filter(|token| !token.is_empty() && !is_mechanical_unit(token));
        let kind = tokens.next().unwrap_or_default().to_owned();
        let (mut numbers, mut words) = (Vec::new(), Vec::new());
        for token in tokens {
            if token.parse::<f64>().is_ok_and(f64::is_finite) {
                numbers.push(token.to_owned());
            } else if !token.starts_with("type") {
                words.push(token.to_owned());
            }
        }
        Name { kind, numbers, words }
    }

    /// Whether `self`, as asked for, can mean the full name `full`.
    pub(super) fn means(&self, full: &Name) -> bool {
        if self.kind != full.kind || self.words != full.words {
            return false;
        }
        match (self.numbers.as_slice(), full.numbers.as_slice()) {
            ([], _) => true,
            ([one], [payload, reach]) => same_payload(one, payload) || same_reach(one, reach),
            ([one, two], [payload, reach]) => {
                (same_payload(one, payload) && same_reach(two, reach))
                    || (same_payload(two, payload) && same_reach(one, reach))
            }
            (asked, known) => asked == known,
        }
    }
}

/// The name among `known` that is nearest to `text`, if one is near.
pub fn nearest<'a>(text: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let asked = compact(text);
    let (distance, name) = known
        .map(|name| (edit_distance(&asked, &compact(name)), name))
        .min_by_key(|(distance, _)| *distance)?;
    let longest = asked.len().max(compact(name).len());
    (distance as f64 <= NEAR * longest as f64).then_some(name)
}

/// `rob1`, `rob2` …, as controllers begin a robot's type.
fn is_mechanical_unit(token: &str) -> bool {
    token.strip_prefix("rob").is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()))
}

fn same_payload(asked: &str, known: &str) -> bool {
    asked.parse::<f64>().ok() == known.parse::<f64>().ok()
}

fn same_reach(asked: &str, known: &str) -> bool {
    reach(asked).is_some_and(|r| Some(r) == reach(known))
}

/// Reach in tenths of a millimetre, of `1.45`, `145`, `058` or `0475`.
fn reach(text: &str) -> Option<i64> {
    let metres = if text.contains('.') {
        text.parse::<f64>().ok()?
    } else if let Some(decimals) = text.strip_prefix('0') {
        format!("0.{decimals}").parse::<f64>().ok()?
    } else {
        text.parse::<f64>().ok()? / 100.0
    };
    Some((metres * 1e4).round() as i64)
}

fn compact(text: &str) -> Vec<char> {
    text.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect()
}

/// Levenshtein distance.
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

//! Robot names in common spellings.
//!
//! `IRB 1600-10/1.45`, `irb1600_10_145` and `ROB1_1600_1.45_10` of a controller are one robot: a
//! type with payload and reach, one of which may be missing.

use strsim::osa_distance;

/// Largest share of different letters in a suggestion.
const NEAR: f64 = 0.5;

/// Quality of the match of a requested name with a full one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fit {
    /// The reach matches when rounded to the requested digits.
    Rounded,
    /// The requested parts match, but are incomplete.
    Part,
    /// The full name.
    Whole,
}

/// Series names and their numbers.
const SERIES: [(&str, &str); 2] = [("gofa", "15000"), ("yumi", "14000")];

/// The parts of a name.
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
    /// Parses a name; every text is accepted.
    pub(super) fn parse(text: &str) -> Name {
        let mut lower = text.trim().to_lowercase();
        for (series, number) in SERIES {
            lower = lower.replace(series, &format!("{number} "));
        }
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
        while let Some(token) = tokens.next() {
            if token.parse::<f64>().is_ok_and(f64::is_finite) {
                numbers.push(token.to_owned());
            } else if token == "type" {
                // `Type C` is a generation of castings.
                tokens.next();
            } else if !token.starts_with("type") {
                words.push(token.to_owned());
            }
        }
        // In a file name `1_5_037` means 1.5 kg and 0.37 m.
        if let [whole, decimals, _] = numbers.as_slice()
            && !decimals.starts_with('0')
        {
            let payload = format!("{whole}.{decimals}");
            numbers.splice(..2, [payload]);
        }
        Name { kind, numbers, words }
    }

    /// The type, such as `1600`.
    pub(super) fn kind(&self) -> &str {
        &self.kind
    }

    /// Type and numbers in the order of a full name, and with reversed numbers, as in controllers.
    pub(super) fn spellings(&self) -> [String; 2] {
        let reversed: Vec<String> = self.numbers.iter().rev().cloned().collect();
        [&self.numbers, &reversed].map(|numbers| format!("irb{} {}", self.kind, numbers.join(" ")))
    }

    /// Match of this requested name with the full name `full`, if any.
    pub(super) fn fit(&self, full: &Name) -> Option<Fit> {
        if self.kind != full.kind || self.words != full.words {
            return None;
        }
        match (self.numbers.as_slice(), full.numbers.as_slice()) {
            ([], []) => Some(Fit::Whole),
            ([], _) => Some(Fit::Part),
            ([one], [payload, reach]) => {
                let fits = same_payload(one, payload) || same_reach(one, reach);
                fits.then_some(Fit::Part)
            }
            ([one, two], [payload, reach]) => [(one, two), (two, one)]
                .into_iter()
                .filter(|(asked, _)| same_payload(asked, payload))
                .filter_map(|(_, asked)| {
                    if same_reach(asked, reach) {
                        Some(Fit::Whole)
                    } else {
                        rounds_to(reach, asked).then_some(Fit::Rounded)
                    }
                })
                .max(),
            _ => None,
        }
    }
}

/// The known type most similar to the requested one, if similar enough.
pub(super) fn nearest_kind(asked: &Name, known: impl Iterator<Item = Name>) -> Option<String> {
    let kinds: Vec<String> = known.map(|name| name.kind).collect();
    nearest(&asked.kind, kinds.iter().map(String::as_str)).map(str::to_owned)
}

/// Optimal string alignment distance of the compact names.
pub(super) fn distance(a: &str, b: &str) -> usize {
    osa_distance(&compact(a), &compact(b))
}

/// The known name most similar to `text`, if similar enough.
pub fn nearest<'a>(text: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let (distance, name) =
        known.map(|name| (distance(text, name), name)).min_by_key(|(distance, _)| *distance)?;
    let longest = [text, name].map(|text| compact(text).chars().count()).into_iter().max()?;
    (distance as f64 <= NEAR * longest as f64).then_some(name)
}

/// `rob1`, `rob2` …, the prefix of robot types in controllers.
fn is_mechanical_unit(token: &str) -> bool {
    token.strip_prefix("rob").is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()))
}

fn same_payload(asked: &str, known: &str) -> bool {
    asked.parse::<f64>().ok() == known.parse::<f64>().ok()
}

fn same_reach(asked: &str, known: &str) -> bool {
    reach(asked).is_some_and(|r| Some(r) == reach(known))
}

/// Whether the known reach, rounded to the requested decimals, equals the requested one: ABB states
/// 0.6 m for the 0.58 m of an IRB120.
fn rounds_to(known: &str, asked: &str) -> bool {
    let Some((_, decimals)) = asked.split_once('.') else { return false };
    known.parse::<f64>().is_ok_and(|reach| format!("{reach:.*}", decimals.len()) == asked)
}

/// Reach in tenths of a millimetre from `1.45`, `145`, `058` or `0475`.
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

fn compact(text: &str) -> String {
    text.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect()
}

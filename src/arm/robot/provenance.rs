//! Where a number comes from.

use std::fmt;

/// How a number is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Provenance {
    /// Published by the maker.
    Datasheet,
    /// Identified or measured on a robot.
    Identified,
    /// Taken from a paper.
    Paper,
    /// Follows from what is known of the robot, with a spread.
    Estimated,
    /// Chosen by us because nothing is published; reports list it.
    Assumed,
}

impl Provenance {
    pub(super) const WORDS: [(&'static str, Provenance); 5] = [
        ("datasheet", Provenance::Datasheet),
        ("identified", Provenance::Identified),
        ("paper", Provenance::Paper),
        ("estimated", Provenance::Estimated),
        ("assumed", Provenance::Assumed),
    ];
}

impl fmt::Display for Provenance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Provenance::Datasheet => "datasheet",
            Provenance::Identified => "identified",
            Provenance::Paper => "paper",
            Provenance::Estimated => "estimated",
            Provenance::Assumed => "assumed",
        })
    }
}

/// The origin of one number or list of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// Its table, such as `limits` or `link 3`.
    pub table: String,
    /// Its key, such as `torque`.
    pub key: String,
    /// How it is known; `None` where the file does not say.
    pub provenance: Option<Provenance>,
    /// The source; `None` where the file does not say.
    pub source: Option<String>,
    /// Standard deviation of each number, in its unit, or one for all; `None` where the file states none.
    pub sd: Option<Vec<f64>>,
}

/// The origins of a provenance as sentences, one for each run of keys that share a
/// table and a source.
pub(super) fn sentences(origins: &[Origin], provenance: Provenance) -> Vec<String> {
    let mut sentences: Vec<String> = Vec::new();
    let mut last: Option<(&Origin, String)> = None;
    for origin in origins.iter().filter(|o| o.provenance == Some(provenance)) {
        match &mut last {
            Some((head, keys)) if head.table == origin.table && head.source == origin.source => {
                keys.push_str(", ");
                keys.push_str(&origin.key);
            }
            _ => {
                sentences.extend(last.take().map(|(head, keys)| sentence(head, &keys, provenance)));
                last = Some((origin, origin.key.clone()));
            }
        }
    }
    sentences.extend(last.map(|(head, keys)| sentence(head, &keys, provenance)));
    sentences
}

fn sentence(head: &Origin, keys: &str, provenance: Provenance) -> String {
    match &head.source {
        Some(source) => format!("{}.{keys} ({provenance}): {source}", head.table),
        None => format!("{}.{keys} ({provenance})", head.table),
    }
}

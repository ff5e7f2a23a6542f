//! Origins of numbers.

use std::fmt;

/// Kind of origin of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Provenance {
    /// Published by the maker.
    Datasheet,
    /// Identified or measured on a robot.
    Identified,
    /// Taken from a paper.
    Paper,
    /// Estimated from known properties of the robot, with a standard deviation.
    Estimated,
    /// Chosen without a published source; reports list it.
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
        let word = Provenance::WORDS.iter().find(|(_, provenance)| provenance == self);
        f.write_str(word.map_or("", |(word, _)| word))
    }
}

/// The origin of one number or list of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// Its table, such as `limits` or `link 3`.
    pub table: String,
    /// Its key, such as `torque`.
    pub key: String,
    /// Its provenance, if stated.
    pub provenance: Option<Provenance>,
    /// Its source, if stated.
    pub source: Option<String>,
    /// Standard deviation of each number, in its unit, or one for all, if stated.
    pub sd: Option<Vec<f64>>,
}

/// The origins of one provenance as sentences, one per sequence of keys with the same table and
/// source.
pub(super) fn sentences(origins: &[Origin], provenance: Provenance) -> Vec<String> {
    let chosen = origins.iter().filter(|origin| origin.provenance == Some(provenance));
    let chosen: Vec<&Origin> = chosen.collect();
    let alike = |a: &&Origin, b: &&Origin| a.table == b.table && a.source == b.source;
    let sentence = |group: &[&Origin]| {
        let keys = group.iter().map(|origin| origin.key.as_str()).collect::<Vec<_>>().join(", ");
        let source = group[0].source.as_ref().map_or(String::new(), |source| format!(": {source}"));
        format!("{}.{keys} ({provenance}){source}", group[0].table)
    };
    chosen.chunk_by(alike).map(sentence).collect()
}

//! A set of effects that a search chose.

/// A chosen family with its pieces.
#[derive(Clone)]
pub struct Chosen {
    /// Number of the family.
    pub family: usize,
    /// Its pieces.
    pub pieces: Vec<usize>,
}

/// Effects that were found.
#[derive(Clone)]
pub struct Found {
    /// In the order in which they were found.
    pub chosen: Vec<Chosen>,
    /// Logarithm of the odds against no effect.
    pub score: f64,
}

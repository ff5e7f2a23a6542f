//! What a diagnosis is busy with.

/// A phase of a diagnosis, in the order in which they come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The rows that are compared.
    Design,
    /// Effects are looked for.
    Search,
    /// What may be asserted.
    Decision,
    /// The models that come of it, and what they miss.
    Grading,
}

impl Phase {
    /// All of them.
    pub const ALL: [Phase; 4] = [Phase::Design, Phase::Search, Phase::Decision, Phase::Grading];

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Phase::Design => "logs and model",
            Phase::Search => "effects that explain the gap",
            Phase::Decision => "what may be asserted",
            Phase::Grading => "what the models miss",
        }
    }
}

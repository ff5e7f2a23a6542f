//! What a diagnosis is busy with.

/// A phase of a diagnosis, in the order in which they come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// What a baseline shows.
    Baseline,
    /// Signs, delays, the model's own error.
    Channel,
    /// Effects are looked for.
    Search,
    /// Effects that are there at times only.
    Windows,
    /// The best shapes of what was found.
    Shapes,
    /// The models that come of it, and what they miss.
    Grading,
}

impl Phase {
    /// All of them.
    pub const ALL: [Phase; 6] = [
        Phase::Baseline,
        Phase::Channel,
        Phase::Search,
        Phase::Windows,
        Phase::Shapes,
        Phase::Grading,
    ];

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Phase::Baseline => "the robot as it was before",
            Phase::Channel => "signs, delays and the error of the model",
            Phase::Search => "effects that explain the gap",
            Phase::Windows => "effects that come and go",
            Phase::Shapes => "their shapes",
            Phase::Grading => "what the models miss",
        }
    }
}

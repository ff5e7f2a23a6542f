//! The cycle of a program as the steps of the robot.

/// Where a statement is in the program without the recorder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// File of the module.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
}

/// One statement of the cycle, with the place where it stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A movement.
    Move {
        /// File of the statement.
        file: String,
        /// Line of the statement.
        line: usize,
        /// Duration at full speed \[s\].
        duration_s: f64,
        /// What the movement takes beyond the power of standing, with a warm robot \[J\].
        energy_j: f64,
        /// Whether it ends at a stop point.
        stops: bool,
    },
    /// Waits until a signal is 1.
    Wait {
        /// File of the statement.
        file: String,
        /// Line of the statement.
        line: usize,
        /// The input.
        signal: String,
    },
    /// `WaitTime`.
    Pause {
        /// File of the statement.
        file: String,
        /// Line of the statement.
        line: usize,
        /// Duration \[s\].
        seconds: f64,
    },
    /// Sets an output.
    Output {
        /// File of the statement.
        file: String,
        /// Line of the statement.
        line: usize,
        /// The output.
        signal: String,
        /// Its new level.
        level: u8,
    },
    /// States the load, `GripLoad`.
    Load {
        /// File of the statement.
        file: String,
        /// Line of the statement.
        line: usize,
        /// Mass \[kg\].
        mass_kg: f64,
    },
}

impl Step {
    /// Where the statement stands.
    #[must_use]
    pub fn place(&self) -> Place {
        let (Step::Move { file, line, .. }
        | Step::Wait { file, line, .. }
        | Step::Pause { file, line, .. }
        | Step::Output { file, line, .. }
        | Step::Load { file, line, .. }) = self;
        Place { file: file.clone(), line: *line }
    }
}

/// One way through the program: a branch, or the cycle for one sort of parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Name of the part, for the log of power.
    pub part: String,
    /// Weight with which a cycle takes this way.
    pub frequency: f64,
    /// The cycle.
    pub steps: Vec<Step>,
}

/// A program. Two scripts of one program differ in the movements' durations and energies.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// The ways through it, at least one.
    pub variants: Vec<Variant>,
}

impl Script {
    /// A program with one way.
    #[must_use]
    pub fn single(steps: Vec<Step>) -> Script {
        Script { variants: vec![Variant { part: "A".into(), frequency: 1.0, steps }] }
    }

    /// The program with movements that take `factor` times the energy.
    #[must_use]
    pub fn with_motion_energy(&self, factor: f64) -> Script {
        self.changed(|step| {
            if let Step::Move { energy_j, .. } = step {
                *energy_j *= factor;
            }
        })
    }

    /// The program with a movement that takes `seconds` longer.
    #[must_use]
    pub fn slowed(&self, at: &Place, seconds: f64) -> Script {
        self.changed(|step| {
            let there = step.place() == *at;
            if let Step::Move { duration_s, .. } = step
                && there
            {
                *duration_s += seconds;
            }
        })
    }

    /// The program for another mix of parts, `frequencies` in the order of the variants.
    #[must_use]
    pub fn with_mix(&self, frequencies: &[f64]) -> Script {
        let mut script = self.clone();
        for (variant, frequency) in script.variants.iter_mut().zip(frequencies) {
            variant.frequency = *frequency;
        }
        script
    }

    fn changed(&self, change: impl Fn(&mut Step)) -> Script {
        let mut script = self.clone();
        script.variants.iter_mut().flat_map(|variant| &mut variant.steps).for_each(change);
        script
    }

    /// All steps of all variants.
    pub(super) fn steps(&self) -> impl Iterator<Item = &Step> {
        self.variants.iter().flat_map(|variant| &variant.steps)
    }

    /// The awaited signals in the order of the program.
    pub(super) fn awaited(&self) -> Vec<String> {
        let mut signals: Vec<String> = Vec::new();
        for step in self.steps() {
            if let Step::Wait { signal, .. } = step
                && !signals.contains(signal)
            {
                signals.push(signal.clone());
            }
        }
        signals
    }
}

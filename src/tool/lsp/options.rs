//! What an editor may choose.

/// Options that an editor may send at the start of the server.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(default)]
pub struct Options {
    /// The robot, by name or file.
    pub robot: Option<String>,
    /// The routine that starts the program.
    pub entry: Option<String>,
    /// Times of inputs, such as `diPart=2.5`.
    pub inputs: Vec<String>,
}

impl Options {
    /// These options, and those of `defaults` where nothing is given.
    pub(super) fn or(self, defaults: Options) -> Options {
        Options {
            robot: self.robot.or(defaults.robot),
            entry: self.entry.or(defaults.entry),
            inputs: if self.inputs.is_empty() { defaults.inputs } else { self.inputs },
        }
    }
}

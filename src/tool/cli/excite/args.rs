//! The options of `joulepath excite`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};

use crate::learn::excite::State;
use crate::tool::cli::common::Format;

/// Maximum distance of adaptive points from the path \[rad\].
const PATH_TOLERANCE: f64 = 1e-3;
/// Maximum time between points \[s\].
pub(super) const MAX_SPACING: f64 = 0.1;

/// Design a motion that identifies a robot's parameters from its torques, as RAPID with a logger.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath excite --robot IRB1600-10/1.45 --plane \"1,0,0,-0.8\" --out excitation"
)]
pub(in crate::tool::cli) struct ExciteArgs {
    /// The robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) robot: String,

    /// Where the RAPID modules and excitation.csv go.
    #[arg(long, value_name = "DIR")]
    pub(super) out: PathBuf,

    /// What the motion identifies.
    #[arg(long, value_enum, default_value_t = Variant::Full)]
    pub(super) variant: Variant,

    /// Base frequency, Hz.
    #[arg(long, allow_negative_numbers = true, value_name = "HZ", default_value_t = 0.1)]
    pub(super) base_frequency: f64,

    /// Harmonics of it that are used.
    #[arg(long, allow_negative_numbers = true, value_name = "K,…", value_delimiter = ',', default_values_t = [1, 4, 7])]
    pub(super) harmonics: Vec<usize>,

    /// Repetitions.
    #[arg(long, allow_negative_numbers = true, value_name = "N", default_value_t = 7)]
    pub(super) cycles: usize,

    #[command(flatten)]
    pub(super) cell: ExperimentArgs,

    /// Share of the joints' speed limits that is used.
    #[arg(long, allow_negative_numbers = true, value_name = "SHARE", default_value_t = 0.8)]
    pub(super) speed_share: f64,

    /// Time between the points of the stream, seconds, or `adaptive`: as far apart as keeps the
    /// path within 1 mrad.
    #[arg(long, allow_negative_numbers = true, value_name = "SECONDS", default_value = "0.01")]
    pub(super) spacing: Spacing,

    /// Another seed starts the search elsewhere.
    #[arg(long, allow_negative_numbers = true, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(super) format: Format,

    /// No notes and no progress on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// The cell in which a motion runs, and how it is logged.
#[derive(Clone, Debug, Default, PartialEq, Args)]
pub(in crate::tool::cli) struct ExperimentArgs {
    /// Keep arm and tool where n·x ≥ d: a normal and a distance in m, base frame; repeatable.
    #[arg(long = "plane", value_name = "NX,NY,NZ,D", allow_hyphen_values = true)]
    pub(in crate::tool::cli) planes: Vec<String>,

    /// Keep arm and tool out of the box between two corners, m, base frame; repeatable.
    #[arg(long = "box", value_name = "X,Y,Z,X,Y,Z", allow_hyphen_values = true)]
    pub(in crate::tool::cli) boxes: Vec<String>,

    /// The tool centre point in tool0, mm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(in crate::tool::cli) tool: Option<String>,

    /// What the flange carries: KG, KG,X,Y,Z (mm) or a loaddata of RAPID.
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    pub(in crate::tool::cli) load: Option<String>,

    /// Where the logger reads torques from.
    #[arg(long, value_enum, default_value_t = TorqueArg::TestSignal)]
    pub(in crate::tool::cli) torque: TorqueArg,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spacing {
    /// \[s\].
    Seconds(f64),
    /// The longest spacing that keeps the path tolerance.
    Adaptive,
}

impl FromStr for Spacing {
    type Err = String;

    fn from_str(text: &str) -> Result<Spacing, String> {
        if text == "adaptive" {
            return Ok(Spacing::Adaptive);
        }
        match text.parse() {
            Ok(seconds) if f64::is_finite(seconds) && seconds > 0.0 => {
                Ok(Spacing::Seconds(seconds))
            }
            _ => Err("give a number of seconds above 0, or adaptive".into()),
        }
    }
}

impl Spacing {
    /// The time between points of a motion with these states \[s\].
    pub(super) fn seconds(self, states: &[State]) -> f64 {
        match self {
            Spacing::Seconds(seconds) => seconds,
            Spacing::Adaptive => {
                let hardest = states.iter().flat_map(|[_, _, qdd]| qdd.iter());
                let hardest = hardest.fold(0.0, |m: f64, x| m.max(x.abs()));
                // The corner at a point is cut by q̈ Δt²/8.
                (8.0 * PATH_TOLERANCE / hardest).sqrt().min(MAX_SPACING)
            }
        }
    }
}

/// Where the logger has torques from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::tool::cli) enum TorqueArg {
    #[default]
    /// Test signal 4002, arm side.
    TestSignal,
    /// `GetMotorTorque`, for controllers without test signals; needs the robot's gear ratios.
    MotorTorque,
}

/// Experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Variant {
    /// All parameters.
    Full,
    /// Weights: slowly, each pose from both sides.
    Gravity,
    /// Friction over speed: each joint alone, six speeds both ways.
    Friction,
    /// What the flange carries: run it with and without.
    Payload,
    /// Axis 5 alone, 5 and 6 against each other, 6 alone.
    Wrist,
    /// The full motion again and again, from cold to warm.
    Warming,
}

//! Reasons for which a part of a program stays unchanged. `docs/reasons.md` explains each.

/// A documented reason.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// The first movement after the start of the program.
    FirstMovement,
    /// The robot position before the movement is unknown.
    UnknownStart(String),
    /// A target or other argument that may have another value in the next run.
    NotConstant(String),
    /// The target is written in the movement itself, where `ModPos` changes the text.
    InlineTarget,
    /// A value on which it depends may change during its execution.
    Meanwhile(String),
    /// It could not be evaluated.
    Unresolved(String),
    /// It is not executed in the simulated cycle.
    NotReached,
    /// It is in a compact IF, which holds one statement only.
    CompactIf,
    /// The path cannot be followed as programmed.
    Path(String),
    /// An instruction that does more than move.
    Instruction(String),
    /// A movement with a programmed time.
    Timed,
    /// An argument with an effect on the movement that is not modelled.
    Argument(String),
    /// A motion setting in force that would change a stream.
    Setting(String),
    /// A handler of its routine may repeat it, or contains it.
    Handler(String),
    /// An interrupt routine may affect it during its execution.
    Interrupt(String),
    /// External axes move with it, or may.
    ExternalAxes,
    /// Other statements between fly-by movements: what stands or runs there.
    LogicBetween(String),
    /// An output is set during its last movement, which ends in a fly-by point.
    EarlyOutput,
    /// Fly-by movements that continue in another routine or branch: the end of the sentence that says
    /// why that is not possible.
    Scattered(String),
    /// Runs that begin or end at different statements in different executions.
    Overlapping,
    /// Its last movement ends in a fly-by point, and a movement may follow: in another branch or at
    /// the restart of the program.
    FliesOn,
    /// The program already contains streams of joulepath.
    Already,
    /// The program declares a name that streams use in its RAPID meaning.
    OwnName(String),
    /// A point passed without a stop and without space for a zone.
    SharpCorner,
    /// An equivalent for externally guided motion outside the program saves this much, J.
    Guided(f64),
    /// The robot is already at the target.
    NoMotion,
    /// No energy is saved in the available time.
    NoSaving,
    /// It saves energy in this share of the plausible robots, which is too small.
    UncertainSaving(f64),
    /// A joint (from 1) of unknown torque limit would have a larger load than in the original
    /// cycle; not so in this share of the plausible robots, which is too small.
    AsksMore(usize, f64),
    /// The requested time is below the least time, s.
    TooShort(f64),
    /// No stream within the limits was found.
    NoStream(String),
    /// It might leave its path, which already enters a keep-out zone.
    KeepOut,
    /// More variants than a program should contain.
    TooManyVariants(usize),
    /// The emitted text failed its verification.
    Verification(String),
    /// A dwell below the break-even time of the brake (s).
    ShortDwell(f64),
    /// A dwell of unknown duration.
    UnknownDwell,
    /// A dwell above the break-even time (s) that needs a controller setting.
    NeedsSetting(f64),
}

impl Reason {
    /// Its name in `docs/reasons.md`.
    pub fn code(&self) -> &'static str {
        match self {
            Reason::FirstMovement => "first-movement",
            Reason::UnknownStart(_) => "unknown-start",
            Reason::NotConstant(_) => "not-constant",
            Reason::InlineTarget => "inline-target",
            Reason::Meanwhile(_) => "meanwhile",
            Reason::Unresolved(_) => "unresolved",
            Reason::NotReached => "not-reached",
            Reason::CompactIf => "compact-if",
            Reason::Path(_) => "path",
            Reason::Instruction(_) => "instruction",
            Reason::Timed => "timed",
            Reason::Argument(_) => "argument",
            Reason::Setting(_) => "setting",
            Reason::Handler(_) => "handler",
            Reason::Interrupt(_) => "interrupt",
            Reason::ExternalAxes => "external-axes",
            Reason::LogicBetween(_) => "logic-between",
            Reason::EarlyOutput => "early-output",
            Reason::Scattered(_) => "scattered",
            Reason::Overlapping => "overlapping",
            Reason::FliesOn => "flies-on",
            Reason::Already => "already",
            Reason::OwnName(_) => "own-name",
            Reason::SharpCorner => "sharp-corner",
            Reason::Guided(_) => "guided",
            Reason::NoMotion => "no-motion",
            Reason::NoSaving => "no-saving",
            Reason::TooShort(_) => "too-short",
            Reason::UncertainSaving(_) => "uncertain-saving",
            Reason::AsksMore(..) => "asks-more",
            Reason::NoStream(_) => "no-stream",
            Reason::KeepOut => "keep-out",
            Reason::TooManyVariants(_) => "too-many-variants",
            Reason::Verification(_) => "verification",
            Reason::ShortDwell(_) => "short-dwell",
            Reason::UnknownDwell => "unknown-dwell",
            Reason::NeedsSetting(_) => "needs-setting",
        }
    }

    /// True if a change that a user may want was refused; false if there is nothing to do.
    pub fn is_refusal(&self) -> bool {
        !matches!(
            self,
            Reason::FirstMovement
                | Reason::Already
                | Reason::Guided(_)
                | Reason::NoMotion
                | Reason::NoSaving
                | Reason::UncertainSaving(_)
                | Reason::AsksMore(..)
                | Reason::Timed
                | Reason::NotReached
                | Reason::KeepOut
                | Reason::ShortDwell(_)
                | Reason::UnknownDwell
                | Reason::NeedsSetting(_)
        )
    }
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let words: &str = match self {
            Reason::FirstMovement => "the first movement brings the robot to a known place",
            Reason::UnknownStart(why) => &format!("where it starts is not known ({why})"),
            Reason::InlineTarget => {
                "its target stands in the movement itself, where no guard sees that ModPos changes \
                 it: give the target a name, or allow it with --inline-targets"
            }
            Reason::NotConstant(words)
            | Reason::Meanwhile(words)
            | Reason::Unresolved(words)
            | Reason::Path(words)
            | Reason::Handler(words)
            | Reason::Interrupt(words)
            | Reason::NoStream(words)
            | Reason::Verification(words) => words,
            Reason::UncertainSaving(share) => &format!(
                "it saves in {:.0} % of the robots that are plausible, which is not enough: \
                 joulepath robots show says how well its figures are known, joulepath calibrate narrows them",
                100.0 * share
            ),
            Reason::AsksMore(joint, share) => &format!(
                "joint {joint} would need no more torque than in the original cycle in {:.0} % of the \
                 robots that are plausible, which is not enough: its limit is not known",
                100.0 * share
            ),
            Reason::NotReached => "it does not run in the simulated cycle",
            Reason::CompactIf => "a compact IF holds one statement only",
            Reason::Instruction(name) => &format!("{name} does more than move"),
            Reason::Timed => "it has its time already (\\T)",
            Reason::Argument(name) => &format!("the argument \\{name} is not modelled"),
            Reason::Setting(name) => &format!("{name} is in force"),
            Reason::ExternalAxes => {
                "its targets move external axes, or where they stood is not known"
            }
            Reason::LogicBetween(what) => &format!("{what} between its fly-by movements"),
            Reason::EarlyOutput => {
                "an output is set while its last movement, which does not stop, is under way"
            }
            Reason::Scattered(why) => {
                &format!("its fly-by movements go on in another routine or branch{why}")
            }
            Reason::Overlapping => "it begins or ends at another statement in another execution",
            Reason::FliesOn => "it ends in a zone, and what comes behind it may move on",
            Reason::Already => {
                "the program has streams of joulepath; start from the original to time it anew"
            }
            Reason::OwnName(name) => {
                &format!("the program declares {name} itself, which streams need as RAPID has it")
            }
            Reason::SharpCorner => "it passes a point without a stop and without room for a zone",
            Reason::Guided(saved) => &format!(
                "positions for externally guided motion beside the program would save {saved:.1} J"
            ),
            Reason::NoMotion => "the robot is there already",
            Reason::NoSaving => "no energy is saved in the time that there is",
            Reason::TooShort(least) => &format!("it takes at least {least:.3} s"),
            Reason::KeepOut => {
                "it keeps to its path, which comes into what the cell keeps free already"
            }
            Reason::TooManyVariants(n) => &format!("it runs in {n} different ways"),
            Reason::ShortDwell(break_even) if break_even.is_infinite() => {
                "nothing is to be held, or no brake is known"
            }
            Reason::ShortDwell(break_even) => &format!("the brake pays from {break_even:.1} s on"),
            Reason::UnknownDwell => "how long it waits is not known (--input states it)",
            Reason::NeedsSetting(break_even) => {
                &format!("the brake pays from {break_even:.1} s on, by a setting of the controller")
            }
        };
        write!(f, "{}: {words}", self.code())
    }
}

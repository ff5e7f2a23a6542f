//! Why a piece of a program stays as it is. `docs/reasons.md` explains each.

/// A documented reason.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// The first movement after the start of the program.
    FirstMovement,
    /// The robot's position before it is not known.
    UnknownStart(String),
    /// A target or other argument that may be another one at the next run.
    NotConstant(String),
    /// Its target stands in the movement itself, where `ModPos` changes the text.
    InlineTarget,
    /// Something on which it depends may change while it runs.
    Meanwhile(String),
    /// It could not be worked out.
    Unresolved(String),
    /// It does not run in the simulated cycle.
    NotReached,
    /// It stands in a compact IF, which holds one statement only.
    CompactIf,
    /// The path can't be followed as programmed.
    Path(String),
    /// An instruction that does more than move.
    Instruction(String),
    /// A movement that has its time already.
    Timed,
    /// An argument that changes the movement in a way that is not modelled.
    Argument(String),
    /// A motion setting in force that would change a stream.
    Setting(String),
    /// A handler of its routine that may begin it again, or that it stands in.
    Handler(String),
    /// An interrupt routine that may do something to it while it runs.
    Interrupt(String),
    /// External axes that move with it, or may.
    ExternalAxes,
    /// Other statements between fly-by movements.
    LogicBetween,
    /// An output that is set while its last movement, which flies on, is under way.
    EarlyOutput,
    /// Fly-by movements that go on in another routine or branch.
    Scattered,
    /// Runs that begin or end at different statements at different times.
    Overlapping,
    /// Its last movement does not stop, and what comes behind it may move on: another branch, or the
    /// beginning of the program again.
    FliesOn,
    /// The program has streams of joulepath already.
    Already,
    /// The program declares a name of its own that streams need in RAPID's sense.
    OwnName(String),
    /// A point passed without a stop and without room for a zone.
    SharpCorner,
    /// It has an equivalent for externally guided motion beside the program, which takes so much
    /// less, J.
    Guided(f64),
    /// It goes nowhere.
    NoMotion,
    /// Nothing is saved in the time that there is.
    NoSaving,
    /// It saves in this share of the robots that are plausible, which is too few.
    UncertainSaving(f64),
    /// A joint, from 1, has more to do than in the original cycle, which is all that is known of what it can;
    /// no more in this share of the plausible robots.
    AsksMore(usize, f64),
    /// The time asked for is below the possible, s.
    TooShort(f64),
    /// No stream within the limits was found.
    NoStream(String),
    /// It might leave its path, which comes into what the cell keeps free already.
    KeepOut,
    /// More variants than a program should carry.
    TooManyVariants(usize),
    /// The emitted text did not hold what was promised.
    Verification(String),
    /// A dwell: the break-even of the brake is not reached.
    ShortDwell(f64),
    /// A dwell of unknown length.
    UnknownDwell,
    /// A dwell that pays, but needs a setting of the controller.
    NeedsSetting(f64),
}

impl Reason {
    /// The name under which `docs/reasons.md` explains it.
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
            Reason::LogicBetween => "logic-between",
            Reason::EarlyOutput => "early-output",
            Reason::Scattered => "scattered",
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
}

impl Reason {
    /// True if something that a user may want rewritten was refused; not where there is
    /// nothing to do.
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
        write!(f, "{}: ", self.code())?;
        match self {
            Reason::FirstMovement => {
                f.write_str("the first movement brings the robot to a known place")
            }
            Reason::UnknownStart(why) => write!(f, "where it starts is not known ({why})"),
            Reason::NotConstant(what) | Reason::Meanwhile(what) => f.write_str(what),
            Reason::InlineTarget => f.write_str(
                "its target stands in the movement itself, where no guard sees that ModPos changes \
                 it: give the target a name, or allow it with --inline-targets",
            ),
            Reason::Unresolved(why)
            | Reason::Path(why)
            | Reason::Handler(why)
            | Reason::Interrupt(why)
            | Reason::NoStream(why)
            | Reason::Verification(why) => f.write_str(why),
            Reason::UncertainSaving(share) => write!(
                f,
                "it saves in {:.0} % of the robots that are plausible, which is not enough: \
                 joulepath robots show says how well its figures are known, joulepath calibrate narrows them",
                100.0 * share
            ),
            Reason::AsksMore(joint, share) => write!(
                f,
                "joint {joint} would need no more torque than in the original cycle in {:.0} % of the \
                 robots that are plausible, which is not enough: its limit is not known",
                100.0 * share
            ),
            Reason::NotReached => f.write_str("it does not run in the simulated cycle"),
            Reason::CompactIf => f.write_str("a compact IF holds one statement only"),
            Reason::Instruction(name) => write!(f, "{name} does more than move"),
            Reason::Timed => f.write_str("it has its time already (\\T)"),
            Reason::Argument(name) => write!(f, "the argument \\{name} is not modelled"),
            Reason::Setting(name) => write!(f, "{name} is in force"),
            Reason::ExternalAxes => {
                f.write_str("its targets move external axes, or where they stood is not known")
            }
            Reason::LogicBetween => f.write_str("other statements stand between fly-by movements"),
            Reason::EarlyOutput => f.write_str(
                "an output is set while its last movement, which does not stop, is under way",
            ),
            Reason::Scattered => {
                f.write_str("its fly-by movements go on in another routine or branch")
            }
            Reason::Overlapping => {
                f.write_str("it begins or ends at another statement in another execution")
            }
            Reason::FliesOn => {
                f.write_str("it ends in a zone, and what comes behind it may move on")
            }
            Reason::Already => f.write_str(
                "the program has streams of joulepath; start from the original to time it anew",
            ),
            Reason::OwnName(name) => {
                write!(f, "the program declares {name} itself, which streams need as RAPID has it")
            }
            Reason::SharpCorner => {
                f.write_str("it passes a point without a stop and without room for a zone")
            }
            Reason::Guided(saved) => write!(
                f,
                "positions for externally guided motion beside the program would save {saved:.1} J"
            ),
            Reason::NoMotion => f.write_str("the robot is there already"),
            Reason::NoSaving => f.write_str("no energy is saved in the time that there is"),
            Reason::TooShort(least) => write!(f, "it takes at least {least:.3} s"),
            Reason::KeepOut => f.write_str(
                "it keeps to its path, which comes into what the cell keeps free already",
            ),
            Reason::TooManyVariants(n) => write!(f, "it runs in {n} different ways"),
            Reason::ShortDwell(break_even) if break_even.is_infinite() => {
                f.write_str("nothing is to be held, or no brake is known")
            }
            Reason::ShortDwell(break_even) => {
                write!(f, "the brake pays from {break_even:.1} s on")
            }
            Reason::UnknownDwell => {
                f.write_str("how long it waits is not known (--input states it)")
            }
            Reason::NeedsSetting(break_even) => write!(
                f,
                "the brake pays from {break_even:.1} s on, by a setting of the controller"
            ),
        }
    }
}

//! The result of a retrofit as plain data.

use super::files::OutputFile;
use super::padding::Padding;
use super::signals::SignalShift;
use super::uncertainty::Uncertainty;
use super::whole_cycle::WholeCycle;
use crate::rapid::text::Span;
use crate::retime::energy::Account;
use crate::retime::motion::Simulation;
use crate::retime::optimize::check::Check;
use crate::retime::optimize::energy_curve::TimeEnergy;
use crate::retime::optimize::reason::Reason;

/// Time and energy of one cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// s.
    pub cycle_s: f64,
    /// All six energy parts, J.
    pub energy_j: f64,
    /// The four energy parts of the motion, J.
    pub motion_energy_j: f64,
}

/// Time of a RAPID instruction, ms. Assumed: ABB publishes none; a PLC cycle is of this order. To
/// be replaced by a measurement on a controller.
pub(in crate::tool) const INSTRUCTION_MS: f64 = 0.05;

/// Cycle times if the assumed limits of acceleration and torque are too high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowerLimits {
    /// Ratio of the true limits to the assumed ones.
    pub share: f64,
    /// s.
    pub original_s: f64,
    /// s.
    pub optimized_s: f64,
}

impl Figures {
    /// The figures with an added wait at the end.
    pub(super) fn padded(self, padding: Option<&Padding>) -> Figures {
        padding.map_or(self, |padding| Figures {
            cycle_s: self.cycle_s + padding.duration_s,
            energy_j: self.energy_j + padding.energy.energy_j(),
            ..self
        })
    }
}

/// The kind of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentKind {
    /// Movements with new timing on the same path.
    Timing,
    /// Movements that leave their path.
    Path,
    /// A dwell.
    Idle,
}

/// A piece of the program with its time and energy in one cycle.
#[derive(Clone, Debug)]
pub struct Segment {
    /// The statements.
    pub span: Span,
    /// The pieces of a run that goes on elsewhere, in the order of execution; otherwise the span.
    pub pieces: Vec<Span>,
    /// The kind.
    pub kind: SegmentKind,
    /// Whether its executed RAPID code has changed.
    pub rewritten: bool,
    /// Why it is unchanged, or unchanged in some executions.
    pub reason: Option<Reason>,
    /// Number of executions in the cycle.
    pub executions: usize,
    /// Number of rewritten executions.
    pub rewritten_executions: usize,
    /// s, all executions.
    pub time_before_s: f64,
    /// s, all executions.
    pub time_after_s: f64,
    /// J, all executions.
    pub energy_before_j: f64,
    /// J, all executions.
    pub energy_after_j: f64,
    /// Lower bound of the energy on the same path in the same time, J; `None` if not rewritten.
    pub lower_bound_j: Option<f64>,
    /// Number of emitted points.
    pub points: usize,
    /// Saving by closed brakes after a change of a controller setting, J.
    pub potential_j: f64,
    /// Its events in the simulations, for plots.
    pub events: Vec<usize>,
    /// Minimum energy over time of one execution of the first variant; may be empty.
    pub pareto: Vec<TimeEnergy>,
}

impl Segment {
    /// A segment with zero time and energy.
    pub(super) fn new(span: Span, kind: SegmentKind, reason: Option<Reason>) -> Segment {
        Segment {
            span,
            pieces: vec![span],
            kind,
            rewritten: false,
            reason,
            executions: 0,
            rewritten_executions: 0,
            time_before_s: 0.0,
            time_after_s: 0.0,
            energy_before_j: 0.0,
            energy_after_j: 0.0,
            lower_bound_j: None,
            points: 0,
            potential_j: 0.0,
            events: Vec::new(),
            pareto: Vec::new(),
        }
    }
}

/// The result of the verification.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Whether all checks passed.
    pub passed: bool,
    /// Worst figures of all streams.
    pub worst: Check,
    /// Largest distance of a joint of a simulated stream from the intended one at any time, rad.
    pub intended_error_rad: f64,
    /// The checks in words, and whether each passed.
    pub checks: Vec<(String, bool)>,
}

impl Verification {
    /// The verification of an unchanged program.
    pub(super) fn none() -> Verification {
        let checks = Vec::new();
        Verification { passed: true, worst: Check::none(), intended_error_rad: 0.0, checks }
    }

    /// Adds a check.
    pub(super) fn note(&mut self, what: &str, held: bool) {
        self.checks.push((what.to_owned(), held));
        self.passed &= held;
    }

    /// The first check that failed.
    pub(super) fn broken(&self) -> Option<&str> {
        self.checks.iter().find(|(_, held)| !held).map(|(what, _)| what.as_str())
    }
}

/// The saving with one spacing of the points of streams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpacingSaving {
    /// Least time between two points, s.
    pub spacing_s: f64,
    /// Points of all streams.
    pub points: usize,
    /// Saved energy of the cycle, J.
    pub saved_j: f64,
    /// Saved share of the motion energy, %.
    pub motion_saving_percent: f64,
    /// Whether it is the spacing of this retrofit.
    pub is_used: bool,
}

/// A retrofit.
#[derive(Debug)]
pub struct Retrofit {
    /// Original, with the padding.
    pub original: Figures,
    /// The wait that the padding adds to the original.
    pub padding: Option<Padding>,
    /// Retrofit.
    pub optimized: Figures,
    /// Both cycles with the rest of the takt.
    pub whole_cycle: WholeCycle,
    /// Further saving by settings of the controller, J.
    pub potential_j: f64,
    /// In the order of the source.
    pub segments: Vec<Segment>,
    /// The result of the verification.
    pub verification: Verification,
    /// The signals before and after.
    pub signals: Vec<SignalShift>,
    /// The complete program.
    pub outputs: Vec<OutputFile>,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// Both cycles under lower limits; empty if no limit is assumed.
    pub lower_limits: Vec<LowerLimits>,
    /// Energies and savings over plausible robots; `None` for a point estimate.
    pub uncertainty: Option<Uncertainty>,
    /// Savings over the spacing of points; empty without curves.
    pub spacings: Vec<SpacingSaving>,
    /// Maximum number of RAPID instructions of guards in a cycle.
    pub guard_instructions: usize,
    /// The original cycle.
    pub before: (Simulation, Account),
    /// The cycle of the emitted program.
    pub after: (Simulation, Account),
}

impl Retrofit {
    /// Time of the guards in a cycle, ms.
    #[must_use]
    pub fn guards_ms(&self) -> f64 {
        INSTRUCTION_MS * self.guard_instructions as f64
    }

    /// Saved share of the energy, %.
    pub fn saving_percent(&self) -> f64 {
        percent(self.original.energy_j, self.optimized.energy_j)
    }

    /// Saved share of the motion energy, %.
    pub fn motion_saving_percent(&self) -> f64 {
        percent(self.original.motion_energy_j, self.optimized.motion_energy_j)
    }

    /// Whether some piece that could have been rewritten was refused.
    pub fn refused(&self) -> bool {
        self.segments.iter().any(|s| s.reason.as_ref().is_some_and(Reason::is_refusal))
    }
}

fn percent(before: f64, after: f64) -> f64 {
    if before > 0.0 { 100.0 * (before - after) / before } else { 0.0 }
}

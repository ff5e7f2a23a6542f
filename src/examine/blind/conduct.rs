//! Faults of the motion: the controller deviates from its program.

use super::label::{TrueParameter, Truth};
use super::program::{Conduct, JITTER_S, Program};
use super::random::Random;
use super::workspace::Workspace;

/// A fault of a run.
pub(super) struct Misconduct {
    pub(super) conduct: Conduct,
    /// The truth; `nats` is set later.
    pub(super) truth: Truth,
    /// Lines at which it appears.
    pub(super) lines: Vec<usize>,
    /// Expected log-likelihood ratio of one run of the program \[nats\].
    pub(super) nats_per_cycle: f64,
}

/// A random fault of the motion.
pub(super) fn motion_effect(
    program: &Program,
    workspace: &Workspace,
    random: &mut Random,
) -> Misconduct {
    let plain = Conduct::plain();
    let mut lines = Vec::new();
    let (id, form, name, value, conduct) = match random.below(4) {
        0 => {
            let lag = random.log_between(5e-3, 80e-3);
            let poles = [1, 2, 4][random.below(3)];
            let form = match poles {
                1 => "one_pole",
                2 => "two_poles",
                _ => "four_poles",
            };
            ("tracking_lag", form, "lag", lag, Conduct { lag, poles, ..plain })
        }
        1 => {
            let factor = random.between(0.25, 0.85);
            let conduct = Conduct { acceleration: factor, ..plain };
            ("acceleration_limit", "stretched_moves", "factor", factor, conduct)
        }
        2 => {
            let factor = random.between(0.25, 0.85);
            ("speed_limit", "stretched_moves", "factor", factor, Conduct { speed: factor, ..plain })
        }
        _ => {
            let wait = random.log_between(0.03, 1.0);
            let after = 1 + random.below(program.moves().saturating_sub(1));
            // The move, the following wait, or the next move: all of these are correct.
            lines = (program.line(after)..=program.line(after + 1)).collect();
            let kind = random.below(3);
            let form = ["constant", "jittering", "irregular"][kind];
            let pause = Some((after, wait, [0.0, 0.05, 0.3][kind]));
            ("program_wait", form, "wait", wait, Conduct { pause, ..plain })
        }
    };
    let usual = program.durations(workspace, &plain);
    let longer = program.durations(workspace, &conduct);
    let later = usual.iter().zip(&longer).map(|(usual, longer)| longer - usual);
    let mut squares: f64 = later.map(|late| late * late).sum();
    squares += conduct.pause.map_or(0.0, |(_, wait, _)| wait * wait);
    squares += conduct.lag * conduct.lag * (program.moves() - 1) as f64;
    let graded = id == "program_wait";
    let parameter = TrueParameter { name: name.into(), joint: None, value, graded };
    let truth = Truth { parameters: vec![parameter], ..Truth::new(id, form, &[]) };
    let nats_per_cycle = 0.5 * squares / (2.0 * JITTER_S * JITTER_S);
    Misconduct { conduct, truth, lines, nats_per_cycle }
}

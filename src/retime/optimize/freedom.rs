//! What a stream may change relative to its original movements.

use std::collections::BTreeSet;

use super::allowed::Loads;
use crate::arm::kinematics::Obstacle;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::Movement;
use crate::rapid::text::Span;

/// The bound on a quantity of a stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bound {
    /// The largest value of the movements themselves.
    #[default]
    Original,
    /// The limits of the robot.
    Robot,
}

/// What a stream may change relative to its original movements; by default nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Freedom {
    /// TCP speed along lines and arcs; [`Bound::Original`] includes their programmed speed.
    pub tcp: Bound,
    /// Joint speeds, and the TCP speed of joint movements.
    pub joints: Bound,
    /// Joint accelerations, jerks and torques; `None` if the limits of the robot are known.
    pub loads: Option<Loads>,
    /// Largest deviation of free movements from their path, m; 0 if none is free.
    pub deviation: f64,
    /// Lines, arcs and waits that the user declares free; joint movements always are.
    pub freed: BTreeSet<Span>,
    /// Keep-out zones for arm and tool off their path.
    pub keep_out: Vec<Obstacle>,
}

impl Freedom {
    /// Largest joint loads.
    pub fn loads(&self, model: &Model) -> Loads {
        self.loads.unwrap_or_else(|| Loads::limits(model))
    }

    /// The bound on the speed of a movement.
    pub fn bound(&self, movement: &Movement) -> Bound {
        match movement.form {
            MoveForm::Linear | MoveForm::Circular => self.tcp,
            _ => self.joints,
        }
    }

    /// The same without deviation from paths.
    #[must_use]
    pub fn strict(&self) -> Freedom {
        Freedom { deviation: 0.0, ..self.clone() }
    }

    /// Permitted deviation of a movement from its path, m, beyond the tolerance of each path.
    pub fn free_deviation(&self, movement: &Movement) -> f64 {
        let joint = matches!(movement.form, MoveForm::AbsJ | MoveForm::Joint);
        let free = joint || self.freed.contains(&movement.span);
        if free { self.deviation } else { 0.0 }
    }
}

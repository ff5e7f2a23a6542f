//! Freedoms of a stream beyond its original movements.

use std::collections::BTreeSet;

use super::allowed::Loads;
use crate::arm::kinematics::Obstacle;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::Movement;
use crate::rapid::text::Span;

/// The bound on a quantity of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The largest value of the movements themselves.
    Original,
    /// The limits of the robot.
    Robot,
}

/// Freedoms of a stream beyond its original movements.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedom {
    /// TCP speed along lines and arcs; [`Bound::Original`] includes their programmed speed.
    pub tcp: Bound,
    /// Joint speeds, and the TCP speed of joint movements.
    pub joints: Bound,
    /// Joint accelerations, jerks and torques; `None` where the limits of the robot are known.
    pub loads: Option<Loads>,
    /// How far free movements may leave their path, m; 0 where none is free.
    pub deviation: f64,
    /// Statements of lines, arcs and waits that the user made free; joint movements are.
    pub freed: BTreeSet<Span>,
    /// Keep-out zones of arm and tool where they leave their path.
    pub keep_out: Vec<Obstacle>,
}

impl Freedom {
    /// None.
    pub fn none() -> Freedom {
        Freedom {
            tcp: Bound::Original,
            joints: Bound::Original,
            loads: None,
            deviation: 0.0,
            freed: BTreeSet::new(),
            keep_out: Vec::new(),
        }
    }

    /// Largest loads of the joints.
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

    /// The same without leaving any path.
    #[must_use]
    pub fn strict(&self) -> Freedom {
        Freedom { deviation: 0.0, ..self.clone() }
    }

    /// How far a movement may leave its path, m, more than the least that is always allowed.
    pub fn free_deviation(&self, movement: &Movement) -> f64 {
        let joint = matches!(movement.form, MoveForm::AbsJ | MoveForm::Joint);
        let free = joint || self.freed.contains(&movement.span);
        if free { self.deviation } else { 0.0 }
    }
}

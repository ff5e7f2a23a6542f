//! How much the parameters of a model are believed.

/// How much the parameters of the model are believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trust {
    /// Identified on this robot.
    Commissioned,
    /// From drawings.
    Cad,
    /// Not at all.
    Unknown,
}

/// Standard deviations of the parameters.
pub(super) struct Spread {
    /// Of a mass, relative.
    pub(super) mass: f64,
    /// Of a centre of mass \[m\].
    pub(super) com: f64,
    /// Of inertias of links and rotors, relative.
    pub(super) inertia: f64,
    /// Of friction, relative.
    pub(super) friction: f64,
    /// Of an offset, of the largest torque.
    pub(super) offset: f64,
}

impl Trust {
    /// The spreads of the contract of `--trust`.
    pub(super) fn spread(self) -> Spread {
        match self {
            Trust::Commissioned => {
                Spread { mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05, offset: 0.002 }
            }
            Trust::Cad => {
                Spread { mass: 0.1, com: 0.015, inertia: 0.2, friction: 0.25, offset: 0.002 }
            }
            Trust::Unknown => {
                Spread { mass: 10.0, com: 1.0, inertia: 20.0, friction: 20.0, offset: 2.0 }
            }
        }
    }
}

//! Time profiles of moves between stops.

use super::mechanics::Joints;
use super::workspace::Workspace;

/// Time profile of a move, normalised to distance 1 and duration 1.
#[derive(Clone, Copy)]
pub(super) enum Profile {
    /// Trapezoidal speed with the share of time of each ramp.
    Trapezoid(f64),
    Quintic,
    /// Half a cosine wave.
    Cosine,
}

impl Profile {
    /// Position, rate and acceleration at the normalised time `x`.
    pub(super) fn at(self, x: f64) -> [f64; 3] {
        match self {
            Profile::Quintic => [
                x.powi(3) * (10.0 + x * (6.0 * x - 15.0)),
                30.0 * (x * (1.0 - x)).powi(2),
                60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
            ],
            Profile::Cosine => {
                let (sin, cos) = (std::f64::consts::PI * x).sin_cos();
                let pi = std::f64::consts::PI;
                [0.5 * (1.0 - cos), 0.5 * pi * sin, 0.5 * pi * pi * cos]
            }
            Profile::Trapezoid(ramp) => {
                let top = 1.0 / (1.0 - ramp);
                let push = top / ramp;
                if x < ramp {
                    [0.5 * push * x * x, push * x, push]
                } else if x > 1.0 - ramp {
                    let left = 1.0 - x;
                    [1.0 - 0.5 * push * left * left, push * left, -push]
                } else {
                    [top * (x - 0.5 * ramp), top, 0.0]
                }
            }
        }
    }

    /// Largest rate and acceleration of the normalised move.
    fn peaks(self) -> [f64; 2] {
        match self {
            Profile::Quintic => [1.875, 5.7736],
            Profile::Cosine => [std::f64::consts::FRAC_PI_2, 4.9349],
            Profile::Trapezoid(ramp) => [1.0 / (1.0 - ramp), 1.0 / (ramp * (1.0 - ramp))],
        }
    }

    /// Least duration of a move with these factors of the limits of speed and acceleration \[s\].
    pub(super) fn least_time(
        self,
        workspace: &Workspace,
        [speed, acceleration]: [f64; 2],
        from: &Joints,
        to: &Joints,
    ) -> f64 {
        let [rate, push] = self.peaks();
        let time = |joint: usize| {
            let way = (to[joint] - from[joint]).abs();
            let by_rate = rate * way / (speed * workspace.velocity[joint]);
            by_rate.max((push * way / (acceleration * workspace.acceleration[joint])).sqrt())
        };
        (0..workspace.dof).map(time).fold(0.0, f64::max)
    }
}

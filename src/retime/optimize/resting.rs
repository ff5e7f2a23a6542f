//! The rest of the takt after the last part of a cycle.
//!
//! The robot stands in it, or it is in an idle state of the controller from which it needs some time
//! to move again. With the rest R, the standing power `P_s`, and power P, wake-up time w and wake-up
//! energy W of a state: E = P (R − w) + `P_s` w + W if R ≥ w. The least of these lines over all states
//! is concave in R.

/// An idle state of the controller.
#[derive(Clone, Debug, PartialEq)]
pub struct IdleState {
    /// Its name.
    pub name: String,
    /// Power of the robot from the grid, W.
    pub power_w: f64,
    /// Time until the robot can move again, s.
    pub wake_s: f64,
    /// Energy of waking up beyond that of standing, J.
    pub wake_j: f64,
}

/// A way to spend a rest R ≥ `least_s`: it takes `energy_j` + `power_w` · (R − `least_s`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resting {
    /// Shortest rest, s.
    pub least_s: f64,
    /// Energy of the shortest rest, J.
    pub energy_j: f64,
    /// Power beyond the shortest rest, W.
    pub power_w: f64,
}

impl Resting {
    /// Energy of a rest (s), J; `None` if the rest is too short.
    fn energy(&self, rest: f64) -> Option<f64> {
        let spare = rest - self.least_s;
        (spare >= 0.0).then_some(self.energy_j + self.power_w * spare)
    }
}

/// All ways to spend a rest: standing at `standing_w`, then each state. Energies are counted without
/// a power of `without_w` that is drawn anyway.
pub fn ways(standing_w: f64, states: &[IdleState], without_w: f64) -> Vec<Resting> {
    let standing_w = standing_w - without_w;
    let standing = Resting { least_s: 0.0, energy_j: 0.0, power_w: standing_w };
    let idle = states.iter().map(|state| Resting {
        least_s: state.wake_s,
        energy_j: standing_w * state.wake_s + state.wake_j,
        power_w: state.power_w - without_w,
    });
    std::iter::once(standing).chain(idle).collect()
}

/// The cheapest way to spend a rest (s) with its energy, J. Of equal ones it is the first.
pub fn cheapest(ways: &[Resting], rest: f64) -> (usize, f64) {
    let possible = ways.iter().enumerate();
    let possible =
        possible.filter_map(|(way, resting)| Some((way, resting.energy(rest.max(0.0))?)));
    possible.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
}

#[cfg(test)]
mod tests {
    use super::{IdleState, cheapest, ways};

    /// Standing takes 200 W, a light sleep 120 W and a deep one 20 W.
    #[test]
    fn the_deeper_state_pays_from_its_break_even_on() {
        let state =
            |power_w, wake_s, wake_j| IdleState { name: String::new(), power_w, wake_s, wake_j };
        let states = [state(120.0, 2.0, 40.0), state(20.0, 10.0, 0.0)];
        for without in [0.0, 90.0] {
            let ways = ways(200.0, &states, without);
            let taken = |rest: f64| {
                let (way, energy) = cheapest(&ways, rest);
                (way, (energy + without * rest).round())
            };
            // 80 W are saved beyond 2 s, and 40 J lost.
            assert_eq!(taken(2.4), (0, 480.0));
            assert_eq!(taken(2.6), (1, 512.0));
            // No time to wake up from the deep one.
            assert_eq!(taken(9.9), (1, 1388.0));
            assert_eq!(taken(12.0), (1, 1640.0));
            assert_eq!(taken(20.0), (2, 2200.0));
        }
    }
}

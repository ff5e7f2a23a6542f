//! A path in the form that COPP takes: one value per node, and no viscous friction, since it
//! takes rows in s̈ and ṡ² only. Both sides get these numbers.

use joulepath::retime::motion::controller::joint_limits;
use joulepath::retime::motion::sampling::{Loaded, SpeedCap};
use joulepath::retime::motion::timing::grid::{PathGrid, PathPoint};
use joulepath::retime::motion::timing::limits::PathLimits;
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::time_optimal;
use joulepath::retime::optimize::cost::Cost;
use joulepath::retime::optimize::energy_program::{EnergyOutcome, energy_bound, minimize_energy};
use joulepath::retime::optimize::path_energy::EnergyModel;
use joulepath::retime::optimize::path_grid;
use joulepath::retime::path::joint_path::{DOF, JointPath, Joints};
use serde_json::{Value, json};

use super::cases::Case;
use super::{FEW, REPEATS, least_s};

/// Time for the least energy over the least time.
const SLOWER: f64 = 1.1;
/// Step of the finite difference of q'', as a share of a piece.
const STEP: f64 = 1e-3;

/// The nodes with the results and times of this crate on them.
pub(crate) fn nodes(case: &Case, grid: &PathGrid, limits: &PathLimits) -> Value {
    let velocity = joint_limits(case.model.limits.velocity.as_ref());
    let points = values(grid, &velocity);
    let s = grid.s().to_vec();
    let model = EnergyModel { work: 0.0, regeneration: 1.0, ..Cost::Electrical.model(&case.model) };
    let set_up = || PathGrid::from_nodes(s.clone(), &points).unwrap();
    let fastest = |grid: &PathGrid| time_optimal(grid, limits).into_profile().unwrap();
    let least = |grid: &PathGrid, fastest: &Profile| {
        minimize_energy(grid, limits, &model, fastest, SLOWER * fastest.duration(), None)
    };
    let grid = set_up();
    let fast = fastest(&grid);
    let outcome = least(&grid, &fast);
    let converged = matches!(outcome, EnergyOutcome::Converged(_));
    let optimum = outcome.into_optimum().unwrap();
    let list = |of: fn(&PathPoint) -> Joints| points.iter().map(of).collect::<Vec<Joints>>();
    json!({
        "s": s,
        "q1": list(|p| p.q1),
        "q2": list(|p| p.q2),
        "q3": third(case.path().unwrap(), &s),
        "inertial": list(|p| p.m),
        "centrifugal": list(|p| p.c),
        "gravity": list(|p| p.g),
        "dry": list(|p| p.coulomb),
        "velocity": velocity,
        "acceleration": limits.acceleration(),
        "torque": limits.torque(),
        "jerk": joint_limits(case.model.limits.jerk.as_ref()),
        "loss": model.loss,
        "fastest_b": fast.b(),
        "fastest_s": least_s(REPEATS, || time_optimal(&set_up(), limits)),
        "fastest_without_set_up_s": least_s(REPEATS, || time_optimal(&grid, limits)),
        "least_b": optimum.profile.b(),
        "least_s": least_s(FEW, || {
            let grid = set_up();
            let fast = fastest(&grid);
            least(&grid, &fast)
        }),
        "marginal_w": optimum.marginal,
        "converged": converged,
    })
}

/// One point per node with the values of the later interval. The limits are those of the joints.
fn values(grid: &PathGrid, velocity: &Joints) -> Vec<PathPoint> {
    let ends = grid.ends();
    let points = ends.iter().map(|pair| pair[0]).chain(ends.last().map(|pair| pair[1]));
    let value = |point: PathPoint| {
        let speeds = (0..DOF).map(|j| velocity[j] / point.q1[j].abs());
        let v_max = speeds.fold(f64::INFINITY, f64::min);
        PathPoint {
            m: point.m,
            c: point.c,
            g: point.g,
            coulomb: point.coulomb,
            ..PathPoint::kinematic(point.q, point.q1, point.q2, v_max)
        }
    };
    points.map(value).collect()
}

/// q''' at the nodes, on the side of the later interval.
fn third(path: &JointPath, s: &[f64]) -> Vec<Joints> {
    let last = s.len() - 1;
    let at = |k: usize| -> Joints {
        let interval = k.min(last - 1);
        let piece = path.piece_at(0.5 * (s[interval] + s[interval + 1]));
        let step = STEP * piece.length;
        let [before, after] = [-step, step].map(|step| piece.eval(s[k] + step).q2);
        std::array::from_fn(|j| 0.5 * (after[j] - before[j]) / step)
    };
    (0..=last).map(at).collect()
}

/// Where the time of a whole energy result goes, s.
pub(crate) fn stages(
    case: &Case,
    nodes: impl Fn() -> Vec<f64>,
    limits: &PathLimits,
    caps: &[SpeedCap],
) -> Value {
    let (path, load) = (case.path().unwrap(), &case.run().load);
    let loaded = Loaded { model: &case.model, load };
    let model = Cost::Electrical.model(&case.model);
    let set_up = || path_grid::grid(loaded, path, &nodes(), caps).unwrap();
    let grid = set_up();
    let fastest = || time_optimal(&grid, limits).into_profile().unwrap();
    let fast = fastest();
    let time = SLOWER * fast.duration();
    let relax = || energy_bound(&grid, limits, &model, &fast, time);
    let bound = relax();
    json!({
        "set_up": least_s(FEW, set_up),
        "time_optimal": least_s(FEW, fastest),
        "energy_bound": least_s(FEW, relax),
        "minimize_energy": least_s(FEW, || {
            minimize_energy(&grid, limits, &model, &fast, time, bound.as_ref())
        }),
    })
}

//! Paths with closed-form optimal profiles: one joint moves along q = s.

use joulepath::retime::motion::stream::DOF;
use joulepath::retime::motion::timing::grid::{PathGrid, PathPoint};

/// A joint of inertia `inertia` with viscous friction `viscous` over `length` rad; `n` intervals.
pub(crate) fn single_joint(
    length: f64,
    n: usize,
    v_max: f64,
    inertia: f64,
    viscous: f64,
) -> PathGrid {
    let mut q1 = [0.0; DOF];
    q1[0] = 1.0;
    let node = |s: f64| {
        let mut point = PathPoint::kinematic([0.0; DOF], q1, [0.0; DOF], v_max);
        point.q[0] = s;
        point.m[0] = inertia;
        point.viscous[0] = viscous;
        point
    };
    let s: Vec<f64> = (0..=n).map(|k| length * k as f64 / n as f64).collect();
    let nodes: Vec<PathPoint> = s.iter().map(|s| node(*s)).collect();
    PathGrid::from_nodes(s, &nodes).unwrap()
}

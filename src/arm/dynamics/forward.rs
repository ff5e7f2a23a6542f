//! Forward dynamics: M(q) q̈ = τ − b(q, q̇).

use crate::arm::robot::{MAX_DOF, Model};

use super::crba::crba;
use super::data::Data;
use super::load::Load;
use super::rnea::rnea;

/// Acceleration of each joint \[rad/s²\] under the torques `tau` \[Nm\] (without friction) at `q`
/// \[rad\], `qd` \[rad/s\]. `None` if the mass matrix is not positive definite, as for a robot
/// without dynamics.
pub fn forward_dynamics(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    tau: &[f64],
) -> Option<[f64; MAX_DOF]> {
    let bias = rnea(model, data, load, q, qd, &[]);
    let mut lower = crba(model, data, load, q);
    let mut x = [0.0; MAX_DOF];
    let n = model.dof;
    // M = L Lᵀ by Cholesky, together with L y = τ − b.
    for i in 0..n {
        for j in 0..=i {
            let mut sum = lower[(i, j)];
            for k in 0..j {
                sum -= lower[(i, k)] * lower[(j, k)];
            }
            if i > j {
                lower[(i, j)] = sum / lower[(j, j)];
            } else if sum > 0.0 {
                lower[(i, i)] = sum.sqrt();
            } else {
                return None;
            }
        }
        let mut sum = tau.get(i).copied().unwrap_or(0.0) - bias[i];
        for k in 0..i {
            sum -= lower[(i, k)] * x[k];
        }
        x[i] = sum / lower[(i, i)];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= lower[(k, i)] * x[k];
        }
        x[i] /= lower[(i, i)];
    }
    Some(x)
}

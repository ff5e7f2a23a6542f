//! The examination's simulator against the library's dynamics, its seals and its grades.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use joulepath::blind;
use joulepath::dynamics::{self, Data, Load};
use joulepath::robot::{self, MAX_DOF, Model};

/// What two formulations of the same dynamics may differ by, over the largest torque.
const SAME: f64 = 1e-9;

/// Some state of a robot: angles, rates, accelerations.
fn state(k: usize) -> [[f64; MAX_DOF]; 3] {
    let of = |offset: f64, size: f64| {
        std::array::from_fn(|joint| size * (offset + 1.7 * k as f64 + 2.3 * joint as f64).sin())
    };
    [of(0.0, 1.5), of(1.0, 2.0), of(2.0, 9.0)]
}

fn same_torques(model: &Model) {
    let mut data = Data::new();
    for k in 0..40 {
        let [q, qd, qdd] = state(k);
        let n = model.dof;
        let theirs =
            dynamics::torque(model, &mut data, &Load::none(), &q[..n], &qd[..n], &qdd[..n]);
        let own = blind::torque(model, &q, &qd, &qdd);
        for joint in 0..n {
            let theirs = theirs.rigid[joint] + theirs.friction[joint];
            let missed = (own[joint] - theirs).abs();
            assert!(missed <= SAME * (1.0 + theirs.abs()), "{}: {own:?} {theirs}", model.name);
        }
    }
}

#[test]
fn virtual_work_is_newton_euler() {
    same_torques(&robot::find("IRB1600-10/1.45").unwrap());
    for file in ["fixtures/dynamics/skew.toml", "fixtures/dynamics/seven.toml"] {
        same_torques(&robot::load(file).unwrap());
    }
    let coupled = "name = \"coupled\"\nextends = \"IRB1600-10/1.45\"\n[wrist]\ncoupling = -0.7\n\
        [kinematics.base]\norigin = [0.0, 0.0, 0.0]\nrpy = [0.3, 1.2, 0.0]\n";
    same_torques(&robot::from_toml("coupled.toml", coupled).unwrap());
}

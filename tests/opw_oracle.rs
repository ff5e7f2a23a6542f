//! Comparison with rs-opw-kinematics, an independent solver for the same arms.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod arms;

use arms::same_angles;
use joulepath::arm::kinematics::{fk, ik_all};
use joulepath::arm::robot::{Model, find, from_toml};
use proptest::prelude::*;
use rs_opw_kinematics::kinematic_traits::Kinematics;
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

/// Tolerance of positions \[m\] and quaternion entries.
const POSE: f64 = 1e-12;
/// Arms of the catalogue of different sizes.
const ROBOTS: [&str; 8] = [
    "IRB1010-1.5/0.37",
    "IRB120-3/0.58",
    "IRB140-6/0.81",
    "IRB1300-10/1.15",
    "IRB1600-10/1.45",
    "IRB2600ID-15/1.85",
    "IRB6640-180/2.55",
    "IRB6650S-90/3.9",
];
/// Tolerance of angles \[rad\].
const ANGLE: f64 = 1e-7;

fn robots() -> Vec<Model> {
    let position = "[limits]\nposition = [[-3,3],[-3,3],[-3,3],[-3,3],[-3,3],[-3,3]]\n";
    // Lateral offset, reversed directions, unusual zeros: properties that no ABB arm has.
    let odd = "name = \"odd\"\n[kinematics.opw]\na1 = 0.2\na2 = -0.05\nb = 0.08\nc1 = 0.5\n\
               c2 = 0.6\nc3 = 0.65\nc4 = 0.1\noffsets = [0.1, -0.2, -1.4, 0.3, 0.2, -0.5]\n\
               signs = [-1, 1, -1, -1, 1, -1]\n";
    let plain = "name = \"plain\"\n[kinematics.opw]\na1 = 0.15\na2 = 0.1\nb = 0.0\nc1 = 0.4\n\
                 c2 = 0.3\nc3 = 0.7\nc4 = 0.0\noffsets = [0, 0, 0, 0, 0, 0]\n\
                 signs = [1, 1, 1, 1, 1, 1]\n";
    let mut robots: Vec<Model> = ROBOTS.iter().map(|name| find(name).unwrap()).collect();
    for text in [odd, plain] {
        robots.push(from_toml("test.toml", &format!("{text}{position}")).unwrap());
    }
    robots
}

fn oracle(model: &Model) -> OPWKinematics {
    let opw = model.kinematics.opw.as_ref().unwrap();
    OPWKinematics::new(Parameters {
        a1: opw.a1,
        a2: opw.a2,
        b: opw.b,
        c1: opw.c1,
        c2: opw.c2,
        c3: opw.c3,
        c4: opw.c4,
        offsets: opw.offsets,
        sign_corrections: opw.signs.map(|sign| sign as i8),
        dof: 6,
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2_000, failure_persistence: None, ..Default::default()
    })]

    #[test]
    fn kinematics_agree_with_the_other_solver(q in prop::array::uniform6(-3.0..3.0)) {
        for model in &robots() {
            let other = oracle(model);
            let (ours, theirs) = (fk(model, &q), other.forward(&q));
            let t = ours.translation.vector;
            prop_assert!((t.x - theirs.translation.x).abs() < POSE);
            prop_assert!((t.y - theirs.translation.y).abs() < POSE);
            prop_assert!((t.z - theirs.translation.z).abs() < POSE);
            let r = theirs.rotation;
            let dot = ours.rotation.i * r.x + ours.rotation.j * r.y
                + ours.rotation.k * r.z + ours.rotation.w * r.w;
            prop_assert!((dot.abs() - 1.0).abs() < POSE, "{} {dot}", model.name);

            prop_assume!(q[4].sin().abs() > 1e-3);
            let found = ik_all(model, &ours).unwrap();
            let is_found = found.iter().any(|solution| same_angles(solution, &q, ANGLE));
            prop_assert!(is_found, "{}", model.name);
            for solution in other.inverse(&theirs) {
                prop_assert!(
                    found.iter().any(|ours| same_angles(ours, &solution, ANGLE)),
                    "{}: {solution:?} not in {found:?}", model.name
                );
            }
        }
    }
}

//! Effects of real robots that are removed from the nominal model.

use joulepath::gap::{Diagnosis, JointGap, Trust};

use super::real_logs::{PANDA, RealRobot, TX40, UR10, diagnosed, named};

/// Largest held-out residuals of joints 5 and 6 of the TX40 \[Nm\].
const MISSED: [f64; 2] = [1.4, 0.9];
/// Largest held-out residual of joint 1 of the UR10 with its friction law \[Nm\].
const MISSED_BY_UR10: f64 = 1.2;

/// The diagnosis of a robot, if its files exist.
fn diagnosis_of(robot: &RealRobot) -> Option<Diagnosis> {
    let (urdf, csv) = (super::shared(robot.urdf)?, super::shared(robot.csv)?);
    let found = diagnosed(robot, &urdf, &csv, Trust::Commissioned);
    let rms =
        |of: fn(&JointGap) -> f64| -> Vec<f64> { found.shrink.joints.iter().map(of).collect() };
    eprintln!(
        "{}: {:?} {:?}, held out {:.2?} → {:.2?} → {:.2?}",
        robot.csv,
        found.verdict,
        named(&found),
        rms(|of| of.model),
        rms(|of| of.refit),
        rms(|of| of.refit_plus_effect)
    );
    Some(found)
}

#[test]
fn the_coupled_wrist_of_a_tx40_is_found() {
    let Some(found) = diagnosis_of(&TX40) else { return };
    assert!(named(&found).contains(&"wrist_coupling"), "{:?}", named(&found));
    for (joint, most) in [4, 5].into_iter().zip(MISSED) {
        let missed = found.shrink.joints[joint].refit_plus_effect;
        assert!(missed <= most, "joint {}: {missed} Nm", joint + 1);
    }
}

#[test]
fn speed_dependent_friction_of_a_ur10_is_found() {
    let Some(found) = diagnosis_of(&UR10) else { return };
    assert!(named(&found).contains(&"stribeck"), "{:?}", named(&found));
    let first = &found.shrink.joints[0];
    assert!(first.refit_plus_effect <= MISSED_BY_UR10, "{first:?}");
}

#[test]
fn a_panda_has_no_effect() {
    let Some(found) = diagnosis_of(&PANDA) else { return };
    let told = found.effects.iter().map(|of| (of.effect.id, &of.joints, &of.parameters));
    assert!(named(&found).is_empty(), "{:?}", told.collect::<Vec<_>>());
}

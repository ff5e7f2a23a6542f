//! Effects that are added to real logs.

use joulepath::arm::robot::{Model, from_toml, import_urdf};
use joulepath::examine::blind::{Case, Kind};
use joulepath::examine::injected::{Arm, Cases};
use joulepath::learn::log::{Channel, ColumnMap, Log, read_csv};

use super::real_logs::{PANDA, RealRobot, TX40, UR10, log};

/// Bounds of an effect's rms share, with the accuracy of its size.
const SHARES: [f64; 2] = [0.029, 0.155];
const COUNT: usize = 6;

fn arm(robot: &RealRobot) -> Option<Arm> {
    let (urdf, csv) = (super::shared(robot.urdf)?, super::shared(robot.csv)?);
    let bare: Model = from_toml(robot.urdf, &import_urdf(robot.urdf, &urdf).unwrap()).unwrap();
    Some(Arm::new(&bare, &log(&bare, &csv, robot)).unwrap())
}

fn arms() -> Option<Vec<Arm>> {
    [TX40, UR10, PANDA].iter().map(arm).collect()
}

fn part(case: &Case, name: &str) -> Vec<Log> {
    let files = case.files.iter().filter(|(file, _)| file.starts_with(&format!("{name}-")));
    files.map(|(_, text)| read_csv(text.as_bytes(), &ColumnMap::default()).unwrap()).collect()
}

#[test]
fn effects_in_real_logs_have_labels_and_the_same_bytes_for_a_seed() {
    let (Some(once), Some(again)) = (arms(), arms()) else { return };
    let (once, again) = (Cases::new(once, 5).unwrap(), Cases::new(again, 5).unwrap());
    let cases: Vec<Case> = (1..=COUNT).map(|number| once.case(number).unwrap()).collect();
    for (case, number) in cases.iter().zip(1..) {
        assert_eq!(*case, again.case(number).unwrap());
        let (_, model) = &case.files[0];
        let model = from_toml("nominal.toml", model).unwrap();
        let parts = ["log", "heldout", "baseline"].map(|name| part(case, name));
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for log in parts.iter().flatten() {
            assert_eq!(log.joints(), model.dof);
            assert!(log.of_joints(Channel::Torque).is_some());
            spans.push([log.time()[0], *log.time().last().unwrap()]);
        }
        assert!(parts.iter().all(|logs| logs.len() == parts[0].len() && !logs.is_empty()));
        spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert!(spans.windows(2).all(|pair| pair[0][1] < pair[1][0]), "blocks overlap");
        labelled(case);
    }
    let healthy = cases.iter().filter(|case| case.label.kind == Kind::Healthy).count();
    assert!((1..=2).contains(&healthy), "{healthy}");
    let mut ids: Vec<&str> =
        cases.iter().flat_map(|case| &case.label.effects).map(|of| of.id.as_str()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), COUNT - healthy, "an effect is there twice: {ids:?}");
}

/// The label has the share of the effect in the torque, and the residual of the real robot.
fn labelled(case: &Case) {
    let label = &case.label;
    assert_eq!(label.effects.len(), usize::from(label.kind == Kind::One));
    for effect in &label.effects {
        let shares = effect.parameters.iter().filter(|of| of.name == "rms_share");
        let largest = shares.map(|of| of.value).fold(0.0, f64::max);
        assert!((SHARES[0]..=SHARES[1]).contains(&largest), "{}: {largest}", effect.id);
        assert!(effect.nats >= 20.0 && !effect.form.is_empty());
        let at: Vec<f64> =
            effect.joints.iter().map(|joint| label.heldout[joint - 1].effects).collect();
        assert!(at.iter().all(|rms| *rms > 0.0), "{}: {at:?}", effect.id);
    }
    for joint in &label.heldout {
        assert!(joint.left > 0.0 && joint.left < joint.torque, "{joint:?}");
        let healthy = label.effects.is_empty();
        assert!(!healthy || (joint.effects == 0.0 && joint.model == joint.left));
    }
}

//! Diagnosis of simulated gaps.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]
#![expect(clippy::print_stderr, reason = "tests report figures")]

mod simulated;

use joulepath::effects::{ALL, Effect, Form, Motion, Role, find as effect};
use joulepath::gap::{Record, Search, Table, Trust, polish};
use joulepath::robot::Model;

use simulated::{Robot, irb1600};

/// Effects that a diagnosis may name.
fn named() -> Vec<&'static Effect> {
    ALL.iter()
        .filter(|e| {
            !["apparent_torque", "torque_offset"].contains(&e.id) || e.id == "torque_offset"
        })
        .collect()
}

fn diagnosed(nominal: &Model, robot: &Robot<'_>) -> (Vec<(String, Vec<usize>)>, f64, f64) {
    let samples = [1, 2].map(|seed| robot.samples(seed));
    let records: Vec<Record<'_>> =
        samples.iter().flat_map(|samples| Record::all(nominal, samples)).collect();
    let start = std::time::Instant::now();
    let mut best: Option<(f64, f64, Vec<(String, Vec<usize>)>)> = None;
    for error in [0.003, 0.01, 0.03] {
        let table = Table::new(&records, &named(), Trust::Commissioned);
        let mut search = Search::new(&records, table, Trust::Commissioned, error);
        let null = search.evidence.null;
        let found = search.run();
        let total = null + found.score;
        if best.as_ref().is_some_and(|(most, ..)| total <= *most) {
            continue;
        }
        let pieces: Vec<usize> = found.chosen.iter().flat_map(|of| of.pieces.clone()).collect();
        let mut names = Vec::new();
        if let Some(polished) = polish(&search, &pieces) {
            for fitted in &polished.effects {
                let values: Vec<String> = fitted
                    .effect
                    .parameters
                    .iter()
                    .zip(fitted.parameters.iter().zip(&fitted.deviations))
                    .map(|(p, (value, sd))| format!("{} {value:.4} ± {sd:.4}", p.name))
                    .collect();
                names.push((
                    format!("{} ({})", fitted.effect.id, values.join(", ")),
                    fitted.joint.into_iter().map(|j| j + 1).collect(),
                ));
            }
            for (id, joint) in &polished.generic {
                names.push((format!("any {id}"), joint.iter().map(|j| j + 1).collect()));
            }
        }
        best = Some((total, error, names));
    }
    let (total, error, names) = best.unwrap();
    eprintln!("{:.1} s, total {total:.0}, error {error}", start.elapsed().as_secs_f64());
    (names, error, total)
}

#[test]
fn effects_of_the_library_are_found() {
    let nominal = irb1600();
    let truth = simulated::spread(&nominal, 3);
    for which in ALL.iter().filter(|e| !matches!(e.form, Form::Elsewhere)) {
        if which.channel != joulepath::effects::Channel::Torque {
            continue;
        }
        let joints = (which.joints)(6);
        let joint = joints[joints.len() / 2];
        // The same in both motions.
        let sized = std::cell::RefCell::new(Vec::new());
        let size = |motion: &Motion<'_>| -> Vec<f64> {
            if !sized.borrow().is_empty() {
                return sized.borrow().clone();
            }
            let scale = motion.scale(joint);
            let values: Vec<f64> = which
                .coordinates
                .iter()
                .map(|c| match c.role {
                    Role::Linear => 1.5 * (c.usual)(&scale),
                    Role::Shape(of) | Role::Choice(of) => {
                        let all = of(&scale);
                        all[all.len() / 2] * 1.13
                    }
                })
                .collect();
            sized.borrow_mut().clone_from(&values);
            values
        };
        let robot = Robot { model: &truth, effect: Some((which, joint, &size)), noise: 0.005 };
        let (names, ..) = diagnosed(&nominal, &robot);
        let truth = which.parameters_of(&sized.borrow());
        eprintln!("{:20} at {} {truth:?}: {names:?}", which.id, joint + 1);
    }
    let healthy = Robot { model: &truth, effect: None, noise: 0.005 };
    let (names, ..) = diagnosed(&nominal, &healthy);
    eprintln!("healthy: {names:?}");
    assert!(names.is_empty());
    let _ = effect;
}

//! Diagnosis of simulated gaps.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]
#![expect(clippy::print_stderr, reason = "tests report figures")]

mod simulated;

use joulepath::effects::{ALL, Effect, Form, Motion, Role, find as effect};
use joulepath::gap::{Owner, Record, Table, Trust, search};
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
    let table = Table::new(&records, &named(), Trust::Commissioned);
    eprint!("table {:.1} s, ", start.elapsed().as_secs_f64());
    let mut best: Option<(f64, f64, Vec<(String, Vec<usize>)>)> = None;
    for error in [0.003, 0.01, 0.03] {
        let evidence = table.evidence(error);
        let (of, found) = search(&table, &evidence);
        let names = found
            .chosen
            .iter()
            .map(|chosen| {
                let joints =
                    chosen.pieces.iter().filter_map(|p| table.pieces[*p].joint).map(|j| j + 1);
                let id = match of.families[chosen.family].owner {
                    Owner::Effect(effect) => effect.id.to_owned(),
                    Owner::Generic(id) => format!("any function of {id}"),
                };
                (id, joints.collect())
            })
            .collect();
        let total = evidence.null + found.score;
        if best.as_ref().is_none_or(|(most, ..)| total > *most) {
            best = Some((total, error, names));
        }
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
        let size = |motion: &Motion<'_>| -> Vec<f64> {
            let scale = motion.scale(joint);
            which
                .coordinates
                .iter()
                .map(|c| match c.role {
                    Role::Linear => 1.5 * (c.usual)(&scale),
                    Role::Shape(of) | Role::Choice(of) => {
                        let all = of(&scale);
                        all[all.len() / 2] * 1.13
                    }
                })
                .collect()
        };
        let robot = Robot { model: &truth, effect: Some((which, joint, &size)), noise: 0.005 };
        let (names, ..) = diagnosed(&nominal, &robot);
        eprintln!("{:20} at {}: {names:?}", which.id, joint + 1);
    }
    let healthy = Robot { model: &truth, effect: None, noise: 0.005 };
    let (names, ..) = diagnosed(&nominal, &healthy);
    eprintln!("healthy: {names:?}");
    assert!(names.is_empty());
    let _ = effect;
}

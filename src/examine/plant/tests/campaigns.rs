//! Two campaigns can be compared cycle by cycle, and their differences are those asked for.

use super::super::{Campaign, Conditions, Disturbance, Plant, Run, Trouble, campaign};
use super::{cell, events, place};

const CYCLES: usize = 150;
const SAVED: f64 = 0.08;

fn plant() -> Plant {
    Plant::draw(11, &cell())
}

fn with(troubles: &[Trouble]) -> Campaign {
    let new = cell().with_motion_energy(1.0 - SAVED);
    campaign(&plant(), (&cell(), &new), &Conditions::usual(CYCLES, 5), troubles)
}

/// A column of the log of power.
fn column(run: &Run, at: usize) -> Vec<f64> {
    run.power.lines().skip(1).map(|row| row.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn parts(run: &Run) -> usize {
    run.cycles.iter().filter(|cycle| cycle.part == "heavy").count()
}

/// Times from the robot's arrival to the gripper's answer.
fn answers(run: &Run) -> Vec<f64> {
    let visits = run.cycles.iter().flat_map(|cycle| &cycle.visits);
    let answered = visits.filter(|visit| visit.place == place(15));
    answered.filter_map(|visit| visit.came_s.map(|came| came - visit.arrived_s)).collect()
}

#[test]
fn another_script_meets_the_same_times_of_machines() {
    let plant = plant();
    let slower = cell().slowed(&place(17), 1.0);
    let (a, b) = (events(&plant, &cell(), 400, 9), events(&plant, &slower, 400, 9));
    let kinds = |of: Disturbance| a.cycles.iter().filter(|cycle| cycle.disturbance == of).count();
    assert!(kinds(Disturbance::Stop) + kinds(Disturbance::Restart) > 0);
    assert!(kinds(Disturbance::Slow) > 0);
    let mut longer = Vec::new();
    for (a, b) in a.cycles.iter().zip(&b.cycles) {
        assert_eq!((&a.part, a.number, a.disturbance), (&b.part, b.number, b.disturbance));
        assert_eq!(a.motion_j, b.motion_j);
        longer.push(b.duration_s - a.duration_s);
    }
    let same = answers(&a).iter().zip(&answers(&b)).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(same && answers(&a).len() > 300);
    // The script's second appears, where slack does not take it.
    assert!(longer.iter().any(|longer| *longer > 0.5) && mean(&longer) < 1.2);
}

#[test]
fn the_saving_of_the_motion_is_the_one_asked_for() {
    let sides = with(&[]);
    assert!((sides.motion_saving - SAVED).abs() < 1e-9);
    assert!(0.0 < sides.saving && sides.saving < SAVED);
    let metered = 1.0 - mean(&column(&sides.after, 1)) / mean(&column(&sides.before, 1));
    assert!((metered - sides.saving).abs() < 2e-3, "{metered} for {}", sides.saving);
    assert_eq!(sides.before.cycles.len(), CYCLES);
    let durations = |run: &Run| run.cycles.iter().map(|of| of.duration_s).collect::<Vec<_>>();
    assert_eq!(durations(&sides.before), durations(&sides.after));
    assert!(sides.after.events.contains("# session 2026-03-09 06:00:00\n"));
}

#[test]
fn troubles_change_what_they_name() {
    let plain = with(&[]);
    let ratio = |sides: &Campaign| mean(&column(&sides.after, 1)) / mean(&column(&plain.after, 1));

    let sides = with(&[Trouble::Kilowatts]);
    assert!((ratio(&sides) * 1000.0 - 1.0).abs() < 1e-3);
    let sides = with(&[Trouble::Gain(1.04)]);
    assert!((ratio(&sides) - 1.04).abs() < 1e-3);
    let sides = with(&[Trouble::Drift(0.02)]);
    assert!(ratio(&sides) > 1.01);
    assert_eq!(sides.after.energy_j(), plain.after.energy_j());

    let sides = with(&[Trouble::Mix([0.1, 0.9, 0.0])]);
    assert_eq!(parts(&sides.before), parts(&plain.before));
    assert!(parts(&sides.after) > 2 * parts(&plain.after));

    let sides = with(&[Trouble::Ambient(8.0)]);
    assert!(column(&sides.after, 4)[0] < column(&plain.after, 4)[0] - 10.0);
    assert!(sides.after.motion_j() > 1.01 * plain.after.motion_j());

    let sides = with(&[Trouble::Swapped(0.2)]);
    let swapped = sides.before.cycles.iter().filter(|cycle| cycle.by_other).count();
    assert!((15..46).contains(&swapped), "{swapped}");
    assert!(sides.before.motion_j() < plain.before.motion_j());
    assert!(sides.after.motion_j() > plain.after.motion_j());

    let sides = with(&[Trouble::Machines(1.2)]);
    assert_eq!(sides.before, plain.before);
    let (old, new) = (mean(&answers(&plain.after)), mean(&answers(&sides.after)));
    assert!((1.05..1.4).contains(&(new / old)), "{old} s, then {new} s");
    assert_eq!(sides.saving, plain.saving);

    let sides = with(&[Trouble::OtherDays]);
    assert_eq!(sides.before, plain.before);
    let faults = |run: &Run| run.cycles.iter().map(|of| of.disturbance).collect::<Vec<_>>();
    assert_ne!(faults(&sides.after), faults(&plain.after));
}

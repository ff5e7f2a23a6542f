//! Calibration with power logs of random robots, of other programs and of other robots.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;
mod support;

use joulepath::arm::dynamics::{Data, torque};
use joulepath::arm::effects::{drawn, with_estimates};
use joulepath::arm::robot::prior::{Spread, standard_normals};
use joulepath::arm::robot::{Model, find, from_toml, to_toml};
use joulepath::learn::calibrate::{Refusal, calibrate};
use joulepath::learn::log::{Channel, Log};
use joulepath::retime::energy::account;
use joulepath::retime::energy::plausible::{DRAWS, Interval, plausibility};
use joulepath::retime::energy::trajectory::{Sample, trajectory};
use joulepath::retime::motion::timeline::{Event, What};
use joulepath::retime::motion::{Options, Simulation};
use joulepath::tool::report::html::optimize_report;
use joulepath::tool::retrofit::{Settings, Source, retrofit};
use rayon::prelude::*;
use support::program as source;

/// A program with another cycle.
const OTHER: &str = "MODULE Other
  CONST jointtarget a:=[[0,-10,20,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget b:=[[70,30,-20,40,60,90],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget c:=[[-60,-30,40,-40,-60,-120],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ a,v1000,fine,tool0;
    MoveAbsJ b,v2500,fine,tool0;
    WaitTime 1.5;
    MoveAbsJ c,v1500,fine,tool0;
    MoveAbsJ a,v1000,z10,tool0;
    MoveAbsJ b,v800,fine,tool0;
    WaitTime 2;
    MoveAbsJ a,vmax,fine,tool0;
  ENDPROC
ENDMODULE
";

/// Number of true robots, and accepted number of them within the 90 % intervals.
const TRUTHS: usize = 100;
const INSIDE: std::ops::RangeInclusive<usize> = 85..=95;
/// Least number of true robots whose calibrated energy lies in its own interval.
const POINTS: usize = 95;

fn pick_place() -> Vec<Source> {
    support::modules("pick_place")
}

fn simulated(model: &Model, files: &[Source]) -> Simulation {
    support::simulated(model, files, &Options::default())
}

fn robot(name: &str) -> Model {
    with_estimates(find(name).unwrap()).unwrap()
}

/// Properties of a recording.
struct Recording {
    /// Interval, s.
    step: f64,
    /// Standard deviation of the noise relative to the value.
    noise: f64,
    seed: u64,
    cycles: f64,
    /// Unit of the log over 1 W.
    unit: f64,
    marks: Marks,
}

/// Marks of the program's progress in a log.
#[derive(Clone, Copy)]
enum Marks {
    None,
    /// The number of the movement.
    Commands,
    /// The number of the repetition.
    Cycles,
}

/// A log of a robot's power in a program; it starts anywhere in the cycle.
fn log(model: &Model, simulation: &Simulation, recording: &Recording) -> Log {
    recorded(model, simulation, recording).0
}

/// The log, and the torques of the joints.
fn recorded(model: &Model, simulation: &Simulation, recording: &Recording) -> (Log, Vec<Vec<f64>>) {
    let samples = trajectory(model, simulation);
    let duration = simulation.cycle_s;
    let count = (recording.cycles * duration / recording.step) as usize;
    let mut noise = standard_normals(1 + model.dof, count, recording.seed).into_iter();
    let begin = duration * fastrand::Rng::with_seed(recording.seed).f64();
    let t: Vec<f64> = (0..count).map(|i| recording.step * i as f64).collect();
    let mut column = |value: &dyn Fn(&Sample) -> f64| -> Vec<f64> {
        let noise = noise.next().unwrap();
        let noisy = t.iter().zip(noise).map(|(t, noise)| {
            let now = (t + begin) % duration;
            let place = samples.partition_point(|sample| sample.t < now).min(samples.len() - 1);
            let (a, b) = (&samples[place.saturating_sub(1)], &samples[place]);
            let share = if b.t > a.t { (now - a.t) / (b.t - a.t) } else { 0.0 };
            (value(a) + share * (value(b) - value(a))) * (1.0 + recording.noise * noise)
        });
        noisy.collect()
    };
    let power = column(&|sample| sample.electrical_w.unwrap());
    let torques: Vec<Vec<f64>> =
        (0..model.dof).map(|j| column(&|sample| sample.power.as_ref().unwrap().tau[j])).collect();
    let mut numbers: Vec<(f64, f64)> = Vec::new();
    for event in &simulation.events {
        let What::Run(run) = &event.what else { continue };
        let moves = run.moves.iter().map(|m| event.t_start + m.t_start);
        numbers.extend(moves.zip(run.moves.iter().map(|m| m.duration)));
    }
    let command = |t: &f64| {
        let now = (t + begin) % duration;
        let running = numbers.iter().position(|(from, lasts)| (*from..from + lasts).contains(&now));
        running.map_or(0.0, |index| index as f64 + 1.0)
    };
    let mut all = Log {
        channels: vec![Channel::Time, Channel::Power],
        values: vec![t.clone(), power.iter().map(|w| w * recording.unit).collect()],
        rows: (0..t.len() as u64).map(|i| i + 2).collect(),
        rejected: Vec::new(),
        degrees: Vec::new(),
    };
    match recording.marks {
        Marks::None => {}
        Marks::Commands => {
            all.channels.push(Channel::Command);
            all.values.push(t.iter().map(command).collect());
        }
        Marks::Cycles => {
            all.channels.push(Channel::Cycle);
            all.values.push(t.iter().map(|t| ((t + begin) / duration).floor()).collect());
        }
    }
    (all, torques)
}

const METER: Recording =
    Recording { step: 0.02, noise: 0.02, seed: 1, cycles: 2.5, unit: 1.0, marks: Marks::None };

fn holds(Interval { low, high, .. }: Interval, x: f64) -> bool {
    (low..=high).contains(&x)
}

#[test]
fn calibrated_intervals_contain_the_truth_as_often_as_stated() {
    let model = robot("IRB2600-20/1.65");
    let simulation = simulated(&model, &pick_place());
    let other = simulated(&model, &source(OTHER));
    let spread = Spread::new(&model);
    let z = standard_normals(spread.latents.len(), TRUTHS, 4711);
    let trial = |i: usize| {
        let truth = drawn(&model, &spread.robot(&model, |k| z[k][i])).unwrap();
        let log = log(&truth, &simulation, &Recording { seed: i as u64, ..METER });
        let found = calibrate(&model, &simulation, &log, None).unwrap();
        let there = account(&found.model, &other);
        let there = plausibility(&found.model, &other, &there).unwrap();
        let (own, beyond) = (account(&truth, &simulation).total, account(&truth, &other).total);
        let point = account(&found.model, &simulation).total.energy_j();
        // The energy of the robot as it is written, then energy and motion energy of the program and
        // motion energy of another one.
        [
            holds(found.after.energy_j, point),
            holds(found.after.energy_j, own.energy_j()),
            holds(found.after.motion_energy_j, own.motion_energy_j()),
            holds(there.motion_energy_j, beyond.motion_energy_j()),
        ]
    };
    let trials: Vec<[bool; 4]> = (0..TRUTHS).into_par_iter().map(trial).collect();
    let [points, inside @ ..] =
        std::array::from_fn::<usize, 4, _>(|k| trials.iter().filter(|trial| trial[k]).count());
    assert!(points >= POINTS, "{points} energies of the robot as it is written");
    // The energy of the calibrated program is measured: its interval nearly always holds.
    assert!(inside[0] >= *INSIDE.start(), "{inside:?}");
    assert!(inside[1..].iter().all(|count| INSIDE.contains(count)), "{inside:?}");
}

/// Largest half width of the interval of the saving, relative to the saving.
const USEFUL_WIDTH: f64 = 0.5;

/// Least share of plausible robots without a larger joint torque in a run than in the original
/// cycle, and tolerance of a peak between two instants.
const NO_MORE: f64 = 0.95;
const BETWEEN: f64 = 1.02;

/// Whether each run of a retrofit needs no larger joint torque than the original cycle, for each
/// robot with its own dynamics.
fn needs_no_larger_torques(model: &Model, before: &Simulation, after: &Simulation) -> bool {
    let robots = Spread::new(model).draws(model, DRAWS).robots;
    let robots: Vec<Model> = robots.iter().map(|robot| drawn(model, robot).unwrap()).collect();
    let peaks = |robot: &Model, event: &Event| {
        let mut most = [0.0_f64; 6];
        let What::Run(run) = &event.what else { return most };
        let steps = (event.duration / 0.01).ceil().max(1.0);
        for i in 0..=steps as usize {
            let s = run.at(event.duration * i as f64 / steps);
            let tau = torque(robot, &mut Data::new(), &run.load, &s.q, &s.qd, &s.qdd);
            for j in 0..6 {
                most[j] = most[j].max((tau.rigid[j] + tau.friction[j]).abs());
            }
        }
        most
    };
    let originals: Vec<[f64; 6]> = robots
        .par_iter()
        .map(|robot| {
            let all = before.events.iter().map(|event| peaks(robot, event));
            all.fold([0.0; 6], |a, b| std::array::from_fn(|j| f64::max(a[j], b[j])))
        })
        .collect();
    after.events.iter().all(|event| {
        let own: Vec<[f64; 6]> = robots.par_iter().map(|robot| peaks(robot, event)).collect();
        (0..6).all(|j| {
            let within = own.iter().zip(&originals).filter(|(a, b)| a[j] <= BETWEEN * b[j]).count();
            within as f64 >= NO_MORE * robots.len() as f64
        })
    })
}

#[test]
fn a_calibrated_saving_has_a_narrow_interval_for_robots_of_all_sizes() {
    let files = pick_place();
    for name in
        ["IRB1600-6/1.45", "IRB2400", "IRB2600-20/1.65", "IRB4600-60/2.05", "IRB6700-200/2.6"]
    {
        let model = robot(name);
        let simulation = simulated(&model, &files);
        let spread = Spread::new(&model);
        let z = standard_normals(spread.latents.len(), 8, 99);
        let truth = drawn(&model, &spread.robot(&model, |k| z[k][3])).unwrap();
        let log = log(&truth, &simulation, &METER);
        let found = calibrate(&model, &simulation, &log, None).unwrap();
        let settings = Settings { entry: "main".into(), ..Settings::default() };
        let done = retrofit(&files, &found.model, &settings, &|_, _| ()).unwrap();
        for segment in &done.segments {
            let (after, bound) = (segment.energy_after_j, segment.lower_bound_j);
            assert!(bound.is_none_or(|bound| bound <= after), "{name}: {bound:?} J, {after} J");
        }
        let page = optimize_report(&done, &files, &found.model, "main").unwrap();
        for reported in
            ["plausible robots it saves", "shares of the variance", "most informative measurement"]
        {
            assert!(page.contains(reported), "{name}: {reported}");
        }
        let Interval { median, low, high } = done.uncertainty.unwrap().saving_percent[1];
        assert!(needs_no_larger_torques(&found.model, &done.before.0, &done.after.0), "{name}");
        let width = 0.5 * (high - low);
        assert!(width <= USEFUL_WIDTH * median && median > 0.0, "{name}: {median} {low} {high}");
    }
}

/// In a short program each movement is among those with the largest torques.
#[test]
fn streams_of_a_short_program_need_no_larger_torques() {
    let files = source(OTHER);
    let model = robot("IRB7600-400/2.55");
    let settings = Settings { entry: "main".into(), ..Settings::default() };
    let done = retrofit(&files, &model, &settings, &|_, _| ()).unwrap();
    let rewritten = done.segments.iter().filter(|segment| segment.rewritten).count();
    assert!(rewritten >= 2, "{:#?}", done.segments);
    let saving = done.uncertainty.unwrap().saving_percent[1];
    assert!(saving.low > 0.0, "{saving:?}");
    assert!(needs_no_larger_torques(&model, &done.before.0, &done.after.0));
}

#[test]
fn logs_of_other_programs_and_robots_are_refused() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let other = simulated(&model, &source(OTHER));
    for (here, there) in [(&program, &other), (&other, &program)] {
        let log = log(&model, there, &Recording { cycles: 6.0, ..METER });
        let refusal = calibrate(&model, here, &log, None).unwrap_err();
        let program = matches!(
            refusal,
            Refusal::Shape { .. } | Refusal::Program { .. } | Refusal::Short { .. }
        );
        assert!(program, "{refusal}");
    }
    let large = robot("IRB6700-200/2.6");
    let large_log = log(&large, &simulated(&large, &pick_place()), &METER);
    assert!(calibrate(&model, &program, &large_log, None).is_err());
    // The same motion with thirty times the power above that at rest.
    let own = log(&model, &program, &METER);
    let rest = own.values[1].iter().copied().fold(f64::INFINITY, f64::min);
    let mut strong = own.clone();
    strong.values[1].iter_mut().for_each(|w| *w = rest + 30.0 * (*w - rest));
    let refusal = calibrate(&model, &program, &strong, None).unwrap_err();
    assert!(matches!(refusal, Refusal::Robot { .. }), "{refusal}");
}

#[test]
fn logs_in_kilowatts_and_with_movement_or_cycle_numbers_are_read() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let plain = calibrate(&model, &program, &log(&model, &program, &METER), None).unwrap();
    let in_kw = log(&model, &program, &Recording { unit: 1e-3, ..METER });
    let in_kilowatts = calibrate(&model, &program, &in_kw, None).unwrap();
    assert!(in_kilowatts.found.kilowatts && !plain.found.kilowatts);
    let width = |i: Interval| i.high - i.low;
    let before = width(plain.before.energy_j);
    let with_commands = log(&model, &program, &Recording { marks: Marks::Commands, ..METER });
    let by_commands = calibrate(&model, &program, &with_commands, None).unwrap();
    let with_cycles = log(&model, &program, &Recording { marks: Marks::Cycles, ..METER });
    let by_cycles = calibrate(&model, &program, &with_cycles, None).unwrap();
    for found in [&plain, &in_kilowatts, &by_commands, &by_cycles] {
        assert!(width(found.after.energy_j) < 0.1 * before, "{:?}", found.after.energy_j);
    }
}

/// The start of a log determines the first movement of its first pass.
#[test]
fn logs_with_movement_numbers_may_begin_anywhere() {
    // For a large robot the power of movements is many times that of waits.
    let model = robot("IRB7600-400/2.55");
    let program = simulated(&model, &source(OTHER));
    for seed in 1..=BEGINS {
        let recording = Recording { seed, marks: Marks::Commands, ..METER };
        let log = log(&model, &program, &recording);
        let refusal = calibrate(&model, &program, &log, None).err();
        assert!(refusal.is_none(), "{seed}: {}", refusal.unwrap());
    }
}

/// Number of starts of the logs in the cycle.
const BEGINS: u64 = 8;

#[test]
fn input_files_are_not_overwritten() {
    let (folder, program) = command::module(OTHER);
    let log = command::written(&folder, "power.csv", "t,power\n0,400\n");
    for target in [&program, &log] {
        let before = std::fs::read(target).unwrap();
        let args = ["calibrate", &program, "--robot", "IRB2600-20/1.65", "--log", &log];
        let args = [&args[..], &["--out", target]].concat();
        command::refused(&args, "this file is read");
        assert_eq!(std::fs::read(target).unwrap(), before);
    }
}

#[test]
fn logged_torques_narrow_the_friction_more_than_power_alone() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let spread = Spread::new(&model);
    let z = standard_normals(spread.latents.len(), 8, 5);
    let truth = drawn(&model, &spread.robot(&model, |k| z[k][2])).unwrap();
    let (log, torques) = recorded(&truth, &program, &METER);
    // Remaining share of the friction's uncertainty, by joint.
    let left = |torques: Option<&[Vec<f64>]>| -> Vec<f64> {
        let found = calibrate(&model, &program, &log, torques).unwrap();
        let friction = (1..=model.dof).map(|j| format!("friction of joint {j}"));
        let remaining =
            |group: String| found.narrowed.iter().find(|(name, _)| *name == group).unwrap().1;
        friction.map(remaining).collect()
    };
    let (alone, with) = (left(None), left(Some(&torques)));
    assert!(with.iter().zip(&alone).all(|(with, alone)| with < alone), "{with:?}, {alone:?}");
    let mut turned = torques.clone();
    turned[2].iter_mut().for_each(|tau| *tau *= -1.0);
    let refusal = calibrate(&model, &program, &log, Some(&turned)).unwrap_err();
    assert!(matches!(refusal, Refusal::Torque { joint: 3, .. }), "{refusal}");
}

#[test]
fn unusable_logs_are_refused() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let own = log(&model, &program, &METER);
    let short = own.of_rows(&(0..500).collect::<Vec<usize>>());
    let seldom = log(
        &model,
        &program,
        &Recording { step: 20.0, cycles: 20.0, marks: Marks::Cycles, ..METER },
    );
    let mut negative = own.clone();
    negative.values[1].iter_mut().for_each(|w| *w -= 5000.0);
    // In kW from the middle on.
    let mut mixed = own.clone();
    let half = mixed.values[1].len() / 2;
    mixed.values[1][half..].iter_mut().for_each(|w| *w /= 1000.0);
    let refusal = |log: &Log| calibrate(&model, &program, log, None).unwrap_err();
    assert!(matches!(refusal(&short), Refusal::Short { .. }), "{}", refusal(&short));
    assert!(matches!(refusal(&seldom), Refusal::Sparse { .. }), "{}", refusal(&seldom));
    assert!(matches!(refusal(&negative), Refusal::Negative { .. }), "{}", refusal(&negative));
    let mut constant = own.clone();
    constant.values[1].fill(400.0);
    assert!(matches!(refusal(&constant), Refusal::Constant { .. }), "{}", refusal(&constant));
    assert!(matches!(refusal(&mixed), Refusal::Unlike { .. }), "{}", refusal(&mixed));
}

#[test]
fn a_calibrated_robot_is_unchanged_after_writing_and_reading() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let found = calibrate(&model, &program, &log(&model, &program, &METER), None).unwrap();
    let read = with_estimates(from_toml("cell.toml", &to_toml(&found.model)).unwrap()).unwrap();
    let energy = |model: &Model| plausibility(model, &program, &account(model, &program)).unwrap();
    assert_eq!(energy(&found.model), energy(&read));
    // Groups that are coupled do not count twice.
    let shares = energy(&read).contributions.iter().map(|part| part.share).sum::<f64>();
    assert!((0.0..=1.0).contains(&shares), "{shares}");
    assert!(matches!(
        calibrate(&read, &program, &log(&model, &program, &METER), None),
        Err(Refusal::Again { .. })
    ));
    // Another name does not change the robot.
    let text = to_toml(&found.model).replace("name = \"IRB2600-20/1.65\"", "name = \"cell 7\"");
    let renamed = with_estimates(from_toml("cell.toml", &text).unwrap()).unwrap();
    assert_eq!(renamed.name, "cell 7");
    assert_eq!(energy(&found.model), energy(&renamed));
    let foreign = to_toml(&found.model).replace("\"base power\" =", "\"base mass\" =");
    let error = with_estimates(from_toml("cell.toml", &foreign).unwrap()).unwrap_err();
    assert!(error.to_string().contains("base mass"), "{error}");
}

//! Calibration by a log of power: logs of drawn robots, of other programs and other robots.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::path::Path;

use joulepath::calibrate::{Refusal, calibrate};
use joulepath::effects::{drawn, with_estimates};
use joulepath::energy::account;
use joulepath::energy::plausible::{Interval, plausibility};
use joulepath::energy::trajectory::trajectory;
use joulepath::log::{Channel, Log};
use joulepath::motion::timeline::What;
use joulepath::motion::{Options, Simulation, simulate};
use joulepath::retrofit::{Settings, Source, read_program, retrofit};
use joulepath::robot::prior::{Spread, standard_normals};
use joulepath::robot::{Model, find, from_toml, to_toml};
use joulepath::text::{FileId, SourceFile};

/// A program of another cycle.
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

/// Truths of which 90 % should lie in the intervals, and how many of them may.
const TRUTHS: usize = 100;
const INSIDE: std::ops::RangeInclusive<usize> = 85..=95;

fn source(text: &str) -> Vec<Source> {
    let file = SourceFile::new(FileId(0), "other.mod".to_owned(), text.as_bytes().to_vec());
    vec![Source { relative: file.path.clone(), file }]
}

fn pick_place() -> Vec<Source> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/pick_place");
    let mut files = Vec::new();
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    for path in
        paths.iter().filter(|path| path.extension().is_some_and(|e| e == "mod" || e == "sys"))
    {
        let id = FileId(files.len() as u32);
        let file = SourceFile::new(id, path.display().to_string(), std::fs::read(path).unwrap());
        files.push(Source { relative: file.path.clone(), file });
    }
    files
}

fn simulated(model: &Model, files: &[Source]) -> Simulation {
    let (program, entry) = read_program(files, "main").unwrap();
    simulate(&program, entry, model, &Options::default())
}

fn robot(name: &str) -> Model {
    with_estimates(find(name).unwrap()).unwrap()
}

/// How a meter logs.
struct Recording {
    /// s.
    step: f64,
    /// Standard deviation of a row over its value.
    noise: f64,
    seed: u64,
    cycles: f64,
    /// What 1 W is in the log.
    unit: f64,
    /// Whether the number of the movement is logged.
    commands: bool,
}

/// The power of a robot in a program, as a meter logs it that starts anywhere.
fn log(model: &Model, simulation: &Simulation, recording: &Recording) -> Log {
    let samples = trajectory(model, simulation);
    let duration = simulation.cycle_s;
    let count = (recording.cycles * duration / recording.step) as usize;
    let noise = &standard_normals(1, count, recording.seed)[0];
    let mut random = fastrand::Rng::with_seed(recording.seed);
    let begin = duration * random.f64();
    let (mut t, mut power) = (Vec::new(), Vec::new());
    for (i, noise) in noise.iter().enumerate() {
        let at = recording.step * i as f64;
        let now = (at + begin) % duration;
        let place = samples.partition_point(|sample| sample.t < now).min(samples.len() - 1);
        let (a, b) = (&samples[place.saturating_sub(1)], &samples[place]);
        let share = if b.t > a.t { (now - a.t) / (b.t - a.t) } else { 0.0 };
        let [low, high] = [a, b].map(|sample| sample.electrical_w.unwrap());
        t.push(100.0 + at);
        power.push((low + share * (high - low)) * (1.0 + recording.noise * noise) * recording.unit);
    }
    let mut numbers: Vec<(f64, f64)> = Vec::new();
    for event in &simulation.events {
        let What::Run(run) = &event.what else { continue };
        let moves = run.moves.iter().map(|m| event.t_start + m.t_start);
        numbers.extend(moves.zip(run.moves.iter().map(|m| m.duration)));
    }
    let command = |t: &f64| {
        let now = (t - 100.0 + begin) % duration;
        let running = numbers.iter().position(|(from, lasts)| (*from..from + lasts).contains(&now));
        running.map_or(0.0, |index| index as f64 + 1.0)
    };
    let commands: Vec<f64> = t.iter().map(command).collect();
    let rows = (0..t.len() as u64).map(|i| i + 2).collect();
    let all = Log {
        channels: vec![Channel::Time, Channel::Power, Channel::Command],
        values: vec![t, power, commands],
        rows,
        rejected: Vec::new(),
        degrees: Vec::new(),
    };
    if recording.commands { all } else { without_commands(all) }
}

fn without_commands(mut log: Log) -> Log {
    log.channels.pop();
    log.values.pop();
    log
}

const METER: Recording =
    Recording { step: 0.02, noise: 0.02, seed: 1, cycles: 2.5, unit: 1.0, commands: false };

fn holds(Interval { low, high, .. }: Interval, x: f64) -> bool {
    (low..=high).contains(&x)
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let model = robot("IRB2600-20/1.65");
    let simulation = simulated(&model, &pick_place());
    let other = simulated(&model, &source(OTHER));
    let spread = Spread::of(&model);
    let z = standard_normals(spread.latents.len(), TRUTHS, 4711);
    // Energy and motion energy of the program, motion energy of another one.
    let mut inside = [0; 3];
    for i in 0..TRUTHS {
        let truth = drawn(&model, &spread.robot(&model, |k| z[k][i])).unwrap();
        let log = log(&truth, &simulation, &Recording { seed: i as u64, ..METER });
        let found = calibrate(&model, &simulation, &log, None).unwrap();
        let there = account(&found.model, &other);
        let there = plausibility(&found.model, &other, &there).unwrap();
        let (own, beyond) = (account(&truth, &simulation).total, account(&truth, &other).total);
        let checks = [
            holds(found.after.energy_j, own.energy_j()),
            holds(found.after.motion_energy_j, own.motion_energy_j()),
            holds(there.motion_energy_j, beyond.motion_energy_j()),
        ];
        for (count, holds) in inside.iter_mut().zip(checks) {
            *count += usize::from(holds);
        }
    }
    // The energy of the program itself is measured: its interval holds it nearly always.
    assert!(inside[0] >= *INSIDE.start(), "{inside:?}");
    assert!(inside[1..].iter().all(|count| INSIDE.contains(count)), "{inside:?}");
}

/// Half of the interval of the saving over the saving, at most.
const OF_USE: f64 = 0.5;

#[test]
fn a_calibrated_saving_is_of_use_for_robots_of_all_sizes() {
    let files = pick_place();
    for name in
        ["IRB1600-6/1.45", "IRB2400", "IRB2600-20/1.65", "IRB4600-60/2.05", "IRB6700-200/2.6"]
    {
        let model = robot(name);
        let simulation = simulated(&model, &files);
        let spread = Spread::of(&model);
        let z = standard_normals(spread.latents.len(), 8, 99);
        let truth = drawn(&model, &spread.robot(&model, |k| z[k][3])).unwrap();
        let log = log(&truth, &simulation, &METER);
        let found = calibrate(&model, &simulation, &log, None).unwrap();
        let settings = Settings { entry: "main".into(), ..Settings::default() };
        let done = retrofit(&files, &found.model, &settings, &|_, _| ()).unwrap();
        let Interval { median, low, high } = done.uncertainty.unwrap().saving_percent[1];
        let width = 0.5 * (high - low);
        assert!(width <= OF_USE * median && median > 0.0, "{name}: {median} {low} {high}");
    }
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
    let of_large = log(&large, &simulated(&large, &pick_place()), &METER);
    assert!(calibrate(&model, &program, &of_large, None).is_err());
    // The same motion, but thirty times the power beyond that at rest.
    let own = log(&model, &program, &METER);
    let rest = own.values[1].iter().copied().fold(f64::INFINITY, f64::min);
    let mut strong = own.clone();
    strong.values[1].iter_mut().for_each(|w| *w = rest + 30.0 * (*w - rest));
    let refusal = calibrate(&model, &program, &strong, None).unwrap_err();
    assert!(matches!(refusal, Refusal::Robot { .. }), "{refusal}");
}

#[test]
fn kilowatts_and_numbers_of_movements_are_understood() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let plain = calibrate(&model, &program, &log(&model, &program, &METER), None).unwrap();
    let in_kw = log(&model, &program, &Recording { unit: 1e-3, ..METER });
    let of_kw = calibrate(&model, &program, &in_kw, None).unwrap();
    assert!(of_kw.found.kilowatts && !plain.found.kilowatts);
    let width = |i: Interval| i.high - i.low;
    let before = width(plain.before.energy_j);
    let with_commands = log(&model, &program, &Recording { commands: true, ..METER });
    let of_commands = calibrate(&model, &program, &with_commands, None).unwrap();
    for found in [&plain, &of_kw, &of_commands] {
        assert!(width(found.after.energy_j) < 0.1 * before, "{:?}", found.after.energy_j);
    }
}

#[test]
fn a_calibrated_robot_is_read_back_as_it_was() {
    let model = robot("IRB2600-20/1.65");
    let program = simulated(&model, &pick_place());
    let found = calibrate(&model, &program, &log(&model, &program, &METER), None).unwrap();
    let read = with_estimates(from_toml("cell.toml", &to_toml(&found.model)).unwrap()).unwrap();
    let energy = |model: &Model| plausibility(model, &program, &account(model, &program)).unwrap();
    assert_eq!(energy(&found.model), energy(&read));
    assert!(matches!(
        calibrate(&read, &program, &log(&model, &program, &METER), None),
        Err(Refusal::Again { .. })
    ));
    let foreign = to_toml(&found.model).replace("\"base power\" =", "\"base mass\" =");
    let error = with_estimates(from_toml("cell.toml", &foreign).unwrap()).unwrap_err();
    assert!(error.to_string().contains("base mass"), "{error}");
}

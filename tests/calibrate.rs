//! Calibration by a log of power: logs of drawn robots, of other programs and other robots.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::path::Path;

use joulepath::calibrate::calibrate;
use joulepath::effects::with_estimates;
use joulepath::energy::account;
use joulepath::energy::plausible::{Interval, plausibility};
use joulepath::energy::trajectory::trajectory;
use joulepath::log::{Channel, Log};
use joulepath::motion::{Options, Simulation, simulate};
use joulepath::retrofit::{Source, read_program};
use joulepath::robot::prior::{Plausible, Spread, standard_normals};
use joulepath::robot::{Model, find, from_toml, to_toml};
use joulepath::text::{FileId, SourceFile};

fn simulated(model: &Model, folder: &str) -> Simulation {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
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
    let (program, entry) = read_program(&files, "main").unwrap();
    simulate(&program, entry, model, &Options::default())
}

fn robot(name: &str) -> Model {
    with_estimates(find(name).unwrap()).unwrap()
}

/// The model of a drawn robot, effects worked out anew.
fn drawn(base: &Model, robot: &Plausible) -> Model {
    with_estimates(from_toml("drawn", &to_toml(&robot.applied(base))).unwrap()).unwrap()
}

struct Recording {
    step: f64,
    noise: f64,
    seed: u64,
    cycles: f64,
    unit: f64,
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
    let rows = (0..t.len() as u64).map(|i| i + 2).collect();
    Log {
        channels: vec![Channel::Time, Channel::Power],
        values: vec![t, power],
        rows,
        rejected: Vec::new(),
        degrees: Vec::new(),
    }
}

const METER: Recording = Recording { step: 0.02, noise: 0.02, seed: 1, cycles: 2.5, unit: 1.0 };

#[test]
fn experiment() {
    let name = std::env::var("ROBOT").unwrap_or("IRB2600-20/1.65".into());
    let model = robot(&name);
    let program = std::env::var("PROGRAM").unwrap_or("fixtures/pick_place".into());
    let simulation = simulated(&model, &program);
    let other = simulated(&model, "/tmp/other");
    let count: usize = std::env::var("COUNT").map_or(20, |x| x.parse().unwrap());
    let spread = Spread::of(&model);
    let z = standard_normals(spread.latents.len(), count, 4711);
    let mut inside = [0; 4];
    let mut ok = 0;
    for i in 0..count {
        let truth = drawn(&model, &spread.robot(&model, |k| z[k][i]));
        let log = log(&truth, &simulation, &Recording { seed: i as u64, ..METER });
        match calibrate(&model, &simulation, &log, None) {
            Ok(found) => {
                ok += 1;
                let own = account(&truth, &simulation).total;
                let there = account(&truth, &other).total;
                let their = plausibility(&found.model, &other, &account(&found.model, &other)).unwrap();
                let has = |i: &Interval, x: f64| i.low <= x && x <= i.high;
                let f = &found.found;
                let checks = [
                    has(&found.after.energy_j, own.energy_j()),
                    has(&found.after.motion_energy_j, own.motion_energy_j()),
                    has(&their.energy_j, there.energy_j()),
                    has(&their.motion_energy_j, there.motion_energy_j()),
                ];
                for (n, c) in inside.iter_mut().zip(checks) { *n += i32::from(c); }
                eprintln!("{i} {checks:?} acc {} explained {:.4} misfit {:.2} pace {:.5} cycles {} E {:.0} in {:.0}..{:.0} | before {:.0}..{:.0} other {:.0} in {:.0}..{:.0}",
                    found.model.calibration.as_ref().unwrap().robots, f.explained, f.misfit, f.pace, f.cycles,
                    own.motion_energy_j(), found.after.motion_energy_j.low, found.after.motion_energy_j.high,
                    found.before.motion_energy_j.low, found.before.motion_energy_j.high, there.motion_energy_j(), their.motion_energy_j.low, their.motion_energy_j.high);
            }
            Err(e) => eprintln!("{i} {e}"),
        }
    }
    eprintln!("{name}: {inside:?} of {ok} of {count}");
}

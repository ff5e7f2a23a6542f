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

#[test]
fn debug_along() {
    use joulepath::energy::along::{Along, Instant};
    use joulepath::energy::change::Change;
    let name = std::env::var("ROBOT").unwrap_or("IRB6700-200/2.6".into());
    let model = robot(&name);
    let simulation = simulated(&model, "fixtures/pick_place");
    let spread = Spread::of(&model);
    let z = standard_normals(spread.latents.len(), 20, 4711);
    let samples = trajectory(&model, &simulation);
    // loads
    let mut instants = Vec::new();
    let mut times = Vec::new();
    use joulepath::motion::timeline::What;
    for event in simulation.events.iter().filter(|e| e.duration > 0.0) {
        let n = (event.duration / 0.02) as usize;
        for i in 0..n {
            let t = event.duration * (i as f64 + 0.5) / n as f64;
            times.push(event.t_start + t);
            instants.push(match &event.what {
                What::Run(run) => { let s = run.at(t); Instant { load: run.load.clone(), state: [s.q, s.qd, s.qdd] } }
                What::Wait(w) => Instant::rest(&w.load, &w.q),
                _ => continue,
            });
        }
    }
    let windows = (0..instants.len()).map(|i| i..i + 1).collect();
    let along = Along::of(&model, &instants, windows);
    for i in 0..3 {
        let plausible = spread.robot(&model, |k| z[k][i]);
        let truth = drawn(&model, &plausible);
        let tr = trajectory(&truth, &simulation);
        let means = along.means(&Change::of(&model, &plausible));
        let mut worst: Vec<(f64, usize, f64, f64)> = Vec::new();
        for (k, t) in times.iter().enumerate() {
            let p = tr.partition_point(|s| s.t < *t).max(1).min(tr.len() - 1);
            let (a, b) = (&tr[p - 1], &tr[p]);
            let s = (t - a.t) / (b.t - a.t).max(1e-12);
            let (x, y) = (a.electrical_w.unwrap(), b.electrical_w.unwrap());
            let exact = x + s * (y - x);
            worst.push(((means.power[k] - exact).abs(), k, exact, means.power[k]));
        }
        let rms = (worst.iter().map(|w| w.0 * w.0).sum::<f64>() / worst.len() as f64).sqrt();
        worst.sort_by(|a, b| b.0.total_cmp(&a.0));
        eprintln!("rms {rms:.1}");
        for (d, k, e, m) in worst.iter().step_by(worst.len() / 12) { eprintln!("  {d:.1} at {:.2} exact {e:.1} along {m:.1} rest {}", times[*k], instants[*k].state[1].iter().all(|x| *x == 0.0)); }
    }
    let _ = samples;
}

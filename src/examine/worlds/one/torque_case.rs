//! Cases whose logs have torques: healthy robots, faults of torques and of electric power.

use super::arm::{Arm, neat, real};
use super::bench::{Bench, Stage};
use super::everyday::{Everyday, Level};
use super::faults::catalogue::{self, Choice};
use super::faults::{Context, Fault};
use super::logger::Recorder;
use super::motion::{STEP, Style, Track, style, track};
use super::plan::{Plan, Rotors};
use super::plant::{Robot, Run, Sample, level, tables};
use super::scene::{HELD, Log, Scene};
use super::{power_case, truth};
use crate::examine::worlds::api::{Case, Kind, options};
use crate::examine::worlds::model::MAX;
use crate::examine::worlds::random::Rng;

/// Period of a repeated motion \[s\].
const PERIOD: (f64, f64) = (5.0, 20.0);
/// Share of motions without repetition, and their duration \[s\].
const ONCE: (f64, (f64, f64)) = (0.15, (30.0, 55.0));
/// Repetitions, least and most.
const REPEATS: (usize, usize) = (3, 10);
/// Most seconds of one log, and of all logs of a case: they bound the time of the simulation.
const LONGEST: f64 = 110.0;
/// Most seconds of all logs.
const ALL: f64 = 280.0;
/// Most rows of a log: people do not record more.
const ROWS: f64 = 16_000.0;
/// Size of a fault over the everyday error: from barely visible to strong.
const SIZES: (f64, f64) = (0.8, 16.0);
/// The same for bodies that are far off.
const FAR_OFF: (f64, f64) = (4.0, 40.0);
/// Factor of sizes without a baseline: of effects that look like parameters under a model from
/// drawings, and of the others.
const HIDDEN_CAD: f64 = 4.0;
/// The same for other effects and models.
const HIDDEN: f64 = 1.5;
/// Largest share of the torque that a fault may have: beyond it the robot would stop.
const MOST: f64 = 0.6;
/// Bounds of one correction of a size.
const CORRECTION: (f64, f64) = (0.002, 200.0);
/// A correction of a size by less than this (logarithm) needs no second one.
const NEAR: f64 = 1.2;
/// Corrections of a size: builders are nearly linear.
const CORRECTIONS: usize = 2;

/// The logs: new ones, the held-out one, and those from before.
fn logs(plan: &Plan, rng: &mut Rng) -> (Vec<Log>, usize) {
    // Two faults take more runs: fewer logs keep the time of a case.
    let shares = if plan.kind == Kind::Two { [0.6, 0.4, 0.0] } else { [0.5, 0.3, 0.2] };
    let count = 1 + rng.weighted(&shares);
    let mut out = Vec::new();
    let mut motions = 0;
    for k in 0..count {
        // Some people record the same motion again.
        let again = k > 0 && rng.chance(0.3);
        let motion = if again { rng.below(motions) } else { motions };
        motions = motions.max(motion + 1);
        out.push(Log { name: format!("log-{}.csv", k + 1), motion, faulty: true });
    }
    out.push(Log { name: HELD.to_owned(), motion: motions, faulty: true });
    motions += 1;
    if plan.baseline {
        let count = 1 + rng.weighted(&[0.65, 0.35]);
        for k in 0..count {
            let same = k == 0 && rng.chance(0.75);
            let motion = if same { 0 } else { motions };
            motions = motions.max(motion + 1);
            out.push(Log { name: format!("baseline-{}.csv", k + 1), motion, faulty: false });
        }
    }
    (out, motions)
}

/// The motions. Faults in a window need the same period everywhere.
fn motions(plan: &Plan, arm: &Arm, timed: bool, count: usize, rng: &mut Rng) -> Vec<Track> {
    let rests = plan.kind == Kind::Power;
    let once = rng.chance(ONCE.0) && !rests;
    let mut out: Vec<Track> = Vec::new();
    let budget = (ALL / count as f64).min(LONGEST);
    for k in 0..count {
        let mut way = style(rng);
        if k == 0 && !rests && rng.chance(0.3) {
            way = Style::Fourier;
        } else if rests {
            way = if rng.chance(0.5) { Style::Curve } else { Style::Trapezoid };
        }
        let mut period = if once { rng.uniform(ONCE.1) } else { rng.uniform(PERIOD) };
        if timed && k > 0 {
            period = out[0].period();
            way = if rng.chance(0.8) { Style::Fourier } else { Style::Chirp };
        }
        let most = ((budget / period) as usize).clamp(1, REPEATS.1);
        let repeats = if once || most < REPEATS.0 {
            if once { 1 } else { REPEATS.0 }
        } else {
            REPEATS.0 + rng.below(most - REPEATS.0 + 1)
        };
        out.push(track(arm, way, (period, repeats, rests), rng));
    }
    out
}

/// Draws the faults of a case.
fn choices(plan: &Plan, rng: &mut Rng) -> Vec<Choice> {
    let count = plan.nominal.count();
    match plan.kind {
        Kind::One => vec![catalogue::torque(count, rng)],
        Kind::Two => {
            let first = catalogue::torque(count, rng);
            let mut second = catalogue::torque(count, rng);
            while !catalogue::apart(&first, &second) {
                second = catalogue::torque(count, rng);
            }
            vec![first, second]
        }
        Kind::Outside => vec![catalogue::outer(count, rng)],
        Kind::ParametersOnly => {
            let mut choice = catalogue::named("link_parameters", count, rng);
            choice.joints.truncate(2);
            vec![choice]
        }
        _ => Vec::new(),
    }
}

/// Largest size of what a fault changes: over the everyday error, and over the torque. `plain` are the
/// samples without the fault.
fn measure(bench: &Bench, stages: &[Stage], plain: &[Vec<Sample>], fault: &Fault) -> (f64, f64) {
    let (mut over, mut share) = (0.0_f64, 0.0_f64);
    for (stage, without) in stages.iter().zip(plain) {
        let with = bench.rows(stage, &[fault], fault.drifts);
        let (change, left) = (bench.spread(&with, without), bench.left(without));
        for j in 0..bench.nominal.count() {
            over = over.max(change[j] / left[j].max(1e-12));
            share = share.max(change[j] / bench.robot.level.torque[j].max(1e-12));
        }
    }
    (over, share)
}

/// Builds a fault of a wanted size over the everyday error.
fn sized(choice: &Choice, ctx: &Context, bench: &Bench, stages: &[Stage], want: f64) -> Fault {
    let mut size = 1.0;
    let mut fault = choice.build(ctx, size);
    // Faults that change from period to period are measured over whole logs: one is enough.
    let stages = if fault.drifts { &stages[..1] } else { stages };
    let plain: Vec<Vec<Sample>> =
        stages.iter().map(|stage| bench.rows(stage, &[], fault.drifts)).collect();
    for _ in 0..CORRECTIONS {
        let (over, share) = measure(bench, stages, &plain, &fault);
        if over <= 0.0 {
            break;
        }
        let by = (want / over).min(MOST / share.max(1e-12)).clamp(CORRECTION.0, CORRECTION.1);
        size *= by;
        fault = choice.build(ctx, size);
        if (by.ln()).abs() < NEAR {
            break;
        }
    }
    fault
}

pub(super) fn make(plan: &Plan) -> Case {
    let mut rng = plan.rng("scene");
    let arm = real(&plan.nominal, plan.spread, &mut plan.rng("real"));
    let choices = choices(plan, &mut plan.rng("faults"));
    let timed = choices.iter().any(Choice::timed);
    let drifting = choices.iter().any(|c| c.entry.id == "warm_up");
    let (logs, count) = logs(plan, &mut rng);
    let tracks = motions(plan, &arm, timed, count, &mut plan.rng("motions"));
    let level = levels(&arm, &tracks);
    let everyday = Everyday::new(&arm, &level, &mut plan.rng("everyday"));
    let mut removed = [0.0; MAX];
    if plan.rotors == Rotors::Removed {
        removed = plan.nominal.rotor;
    }
    let robot = Robot { arm: &arm, everyday: &everyday, level: &level, removed };
    let bench = Bench { robot: &robot, nominal: &plan.nominal, rotors: plan.rotors };
    let mut recorder = Recorder::new(&arm, timed || drifting, &mut rng);
    let longest = tracks.iter().map(|t| t.steps * t.cycles).max().unwrap_or(0) as f64 * STEP;
    recorder.limit(longest, ROWS);
    let days = logs.iter().map(|_| everyday.day(&mut rng)).collect();
    let stages = tracks.into_iter().map(|track| (tables(&robot, &track), track)).collect();
    let scene = Scene { plan, stages, days, logs, recorder };
    let faults = build(&scene, &bench, &choices);
    finish(&scene, &bench, faults)
}

/// Factor of the size of a fault that the spread of the parameters hides, where no baseline tells them.
fn hidden(plan: &Plan, choice: &Choice) -> f64 {
    const LIKE_PARAMETERS: [&str; 8] = [
        "payload",
        "link_parameters",
        "rotor_inertia",
        "torque_constant",
        "friction_level",
        "encoder_offset",
        "apparent_torque",
        "torque_offset",
    ];
    let like = LIKE_PARAMETERS.contains(&choice.entry.id) && plan.kind != Kind::ParametersOnly;
    match (plan.baseline, plan.spread.trust, like) {
        (true, _, _) => 1.0,
        (false, "cad", true) => HIDDEN_CAD,
        _ => HIDDEN,
    }
}

/// Levels of all motions of a case; the ranges of angles are those of the first.
fn levels(arm: &Arm, tracks: &[Track]) -> Level {
    let mut out = level(arm, &tracks[0].cycle);
    for track in &tracks[1..] {
        let own = level(arm, &track.cycle);
        for j in 0..arm.count() {
            out.torque[j] += own.torque[j];
            out.peak[j] = out.peak[j].max(own.peak[j]);
            out.load[j] = out.load[j].max(own.load[j]);
            out.speed[j] = out.speed[j].max(own.speed[j]);
            out.acceleration[j] = out.acceleration[j].max(own.acceleration[j]);
        }
    }
    out.torque = out.torque.map(|tau| tau / tracks.len() as f64);
    out
}

/// Builds the faults with their sizes.
fn build(scene: &Scene, bench: &Bench, choices: &[Choice]) -> Vec<Fault> {
    let first = scene.stage(0);
    let period = first.track.period();
    let ctx = Context {
        arm: bench.robot.arm,
        level: bench.robot.level,
        path: &first.track.cycle,
        period,
        duration: period * first.track.cycles as f64,
        rate: scene.recorder.rate,
    };
    let range = if scene.plan.kind == Kind::ParametersOnly { FAR_OFF } else { SIZES };
    let mut rng = scene.plan.rng("sizes");
    let stages = [scene.stage(0), scene.stage(scene.held())];
    let mut out = Vec::new();
    for choice in choices {
        let want = rng.log(range) * hidden(scene.plan, choice);
        out.push(sized(choice, &ctx, bench, &stages, want));
    }
    out
}

/// Runs the logs and writes the truth.
fn finish(scene: &Scene, bench: &Bench, mut faults: Vec<Fault>) -> Case {
    let mut files = vec![scene.plan.robot_file()];
    let electric = power_case::Electric::new(scene, bench);
    for (number, log) in scene.logs.iter().enumerate() {
        let mut rng = scene.plan.rng(&log.name);
        let stage = scene.stage(number);
        let duration = (stage.track.steps * stage.track.cycles) as f64 * STEP;
        let (truth, stamps) = scene.recorder.times(duration, &mut rng);
        let acting: Vec<&Fault> = faults.iter().filter(|_| log.faulty).collect();
        let samples: Vec<Sample> =
            Run::new(bench.robot, (stage.track, stage.tables), &acting, stage.day).samples(&truth);
        let powers = electric.as_ref().map(|e| e.log(&samples, log.faulty, &mut rng));
        let text = scene.recorder.csv(
            &stamps,
            &samples,
            bench.robot.everyday,
            powers.as_deref(),
            &mut rng,
        );
        files.push((log.name.clone(), text));
    }
    let (place, heldout) = truth::fill(scene, bench, &mut faults);
    let mut effects: Vec<_> = faults.into_iter().map(|f| f.truth).collect();
    effects.extend(electric.map(|e| e.truth(scene, bench)));
    let first = scene.stage(0).track;
    let period = (first.cycles > 1 && scene.plan.period_told).then(|| neat(first.period()));
    let options = options(&files[0].0, scene.plan.spread.trust, period);
    Case { effects, place, heldout, ..Case::new(files, options, scene.plan.kind) }
}

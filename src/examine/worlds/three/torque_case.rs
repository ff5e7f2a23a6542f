//! Cases with torque logs: healthy, parameters, one, two, outside.

use super::build::nominal;
use super::catalogue::{self, EFFECTS, MOTOR_EFFECTS};
use super::drive::{Rotors, Run, World, logged};
use super::drive_faults::small_lag_equivalents;
use super::everyday::{Day, Everyday};
use super::fault::{Fault, Place};
use super::logfile::{Recorder, csv};
use super::motion::{Style, entry, style, track};
use super::truth::{Evidence, apart, everyday, heldout, share};
use crate::examine::worlds::api::{Case, Kind, Truth, largest, options, rms};
use crate::examine::worlds::model::{CAD, COMMISSIONED, MAX, Row, Spread};
use crate::examine::worlds::random::Rng;

/// Rows of a log at most: files stay small.
const MOST_ROWS: f64 = 10_000.0;
/// A fault below this share of a joint's torque is drawn anew: nobody could see it.
const LEAST_SHARE: f64 = 0.006;
/// Draws of a fault at most.
const DRAWS: usize = 5;

/// How the logs of a case are taken.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    /// Duration of a period \[s\].
    pub(super) period: f64,
    pub(super) cycles: usize,
    /// Sampling rate \[Hz\].
    pub(super) rate: f64,
    /// Whether the options tell the period.
    pub(super) told: bool,
}

impl Schedule {
    /// A schedule: mostly repeated periods.
    pub(super) fn new(rng: &mut Rng) -> Self {
        let repeated = rng.chance(0.85);
        let grid = if rng.chance(0.5) { 0.5 } else { 0.1 };
        let (shortest, longest) = if repeated { (5.0, 20.0) } else { (30.0, 60.0) };
        let period = (rng.log_between(shortest, longest) / grid).round() * grid;
        let cycles = if repeated { rng.whole(3, 10).min((140.0 / period) as usize) } else { 1 };
        let mut rates = vec![50.0, 100.0, 125.0, 250.0, 500.0];
        rates.retain(|rate| rate * period * cycles as f64 <= MOST_ROWS);
        Self { period, cycles, rate: rng.pick(&rates), told: repeated && rng.chance(0.5) }
    }

    /// The period, if logs repeat it.
    pub(super) fn repeats(&self) -> Option<f64> {
        (self.cycles > 1).then_some(self.period)
    }
}

/// A robot, its logs and what is told of them.
pub(super) struct Setting {
    pub(super) world: World,
    pub(super) spread: Spread,
    pub(super) schedule: Schedule,
    pub(super) runs: Vec<Run>,
    pub(super) heldout: Run,
    pub(super) baselines: Vec<Run>,
}

/// One recording of a motion.
fn run(setting: (&World, &Schedule), style: Style, mut rng: Rng) -> Run {
    let (world, schedule) = setting;
    let track = track(style, &world.nominal, schedule.period, &mut rng);
    let day = Day::new(&mut rng);
    let mut started = None;
    if schedule.cycles > 3 && rng.chance(0.2) {
        let mut offset = [0.0; MAX];
        for (i, offset) in offset.iter_mut().enumerate().take(world.nominal.axes()) {
            *offset = 0.1 * world.nominal.span[i] * rng.between(-1.0, 1.0);
        }
        started = Some(entry(&track, &offset, rng.between(1.5, 3.0)));
    }
    Run { track, entry: started, cycles: schedule.cycles, day, stream: rng }
}

impl Setting {
    /// A setting of a case; `rotors` in the model if torques must be the motors'.
    pub(super) fn new(seed: u64, number: usize, motors: bool, baseline: bool) -> Self {
        let stream = |purpose: &str| Rng::stream(seed, number, purpose);
        let mut rng = stream("setting");
        let arm = nominal(&mut stream("robot"), number, false);
        let trusted = rng.chance(if baseline { 0.75 } else { 0.5 });
        let spread = if trusted { COMMISSIONED } else { CAD };
        let real = arm.real(&spread, &mut stream("real"));
        let habits = Everyday::new(&arm, &mut stream("everyday"));
        let rotors = if motors || rng.chance(0.5) {
            Rotors::InModel
        } else if rng.chance(0.75) {
            Rotors::Subtracted
        } else {
            Rotors::Left
        };
        let world = World { nominal: arm, real, everyday: habits, rotors };
        let schedule = Schedule::new(&mut rng);
        let of = (&world, &schedule);
        let count = rng.pick(&[1, 1, 2, 2, 3]);
        let runs: Vec<Run> =
            (0..count).map(|k| run(of, style(&mut rng), stream(&format!("log {k}")))).collect();
        // A slow sweep would test little: the held-out motion is a livelier one.
        let other = rng.pick(&[Style::Fourier, Style::Moves, Style::PickAndPlace]);
        let heldout = run(of, other, stream("heldout"));
        let mut baselines = Vec::new();
        if baseline {
            let same = rng.chance(0.7);
            for (k, now) in runs.iter().enumerate().take(rng.whole(1, 2)) {
                let mut before = run(of, style(&mut rng), stream(&format!("baseline {k}")));
                if same {
                    before.track.clone_from(&now.track);
                    before.entry = None;
                }
                baselines.push(before);
            }
        }
        Self { world, spread, schedule, runs, heldout, baselines }
    }

    /// What a fault's draw needs.
    fn place(&self) -> Place<'_> {
        Place {
            arm: &self.world.nominal,
            period: self.schedule.period,
            length: self.schedule.period * self.schedule.cycles as f64,
            rate: self.schedule.rate,
        }
    }

    /// Name and text of the model's file.
    fn model(&self) -> (String, String) {
        self.world.nominal.sheet().file(self.world.rotors != Rotors::InModel)
    }

    pub(super) fn options(&self) -> serde_json::Value {
        let period = self.schedule.told.then_some(self.schedule.period);
        options(&self.model().0, self.spread.trust, period)
    }
}

fn sized(setting: &Setting, wanted: &[&'static str], rng: &mut Rng) -> Vec<Fault> {
    let Some(first) = setting.runs.first() else { return Vec::new() };
    let mut short = Run { entry: None, cycles: first.cycles.min(2), ..first.clone() };
    let place = setting.place();
    let mut faults = Vec::new();
    for id in wanted {
        // What changes over the whole log is judged on the whole log.
        short.cycles = if *id == "warm_up" { first.cycles } else { first.cycles.min(2) };
        let clean = logged(&setting.world, &short, &[]);
        let torque = rms(clean.iter().copied());
        for draw in 1..=DRAWS {
            // Seven axes have no coupled wrist: another rotor instead.
            let drawn = catalogue::draw(id, &place, rng)
                .or_else(|| catalogue::draw("rotor_inertia", &place, rng));
            let Some(drawn) = drawn else { break };
            // From barely visible to strong; two in three above 5 % of the joint's torque.
            let target = rng.log_between(0.02, 0.4);
            let size = |fault: &Fault| {
                share(
                    &apart(&logged(&setting.world, &short, std::slice::from_ref(fault)), &clean),
                    &torque,
                )
            };
            let [least, most] = drawn.bounds;
            let mut factor = 1.0_f64.clamp(least, most);
            let mut fault = drawn.scaled(factor);
            let mut seen = size(&fault);
            for _ in 0..3 {
                let next = (factor * target / seen.max(1e-6))
                    .clamp(least, most)
                    .clamp(0.1 * factor, 10.0 * factor);
                if (next / factor - 1.0).abs() < 0.15 {
                    break;
                }
                factor = next;
                fault = drawn.scaled(factor);
                seen = size(&fault);
            }
            if seen.is_finite() && (seen > LEAST_SHARE || draw == DRAWS) {
                fault.keep(|alone| size(alone) > LEAST_SHARE);
                faults.push(small_lag_equivalents(fault));
                break;
            }
        }
    }
    faults
}

/// Ids of the faults of a kind.
fn wanted(kind: Kind, rng: &mut Rng) -> Vec<&'static str> {
    match kind {
        Kind::ParametersOnly => vec!["link_parameters"],
        Kind::Outside => vec!["outside"],
        Kind::One | Kind::Two => {
            // Coupled wrists are an emphasis of this world.
            let first = if rng.chance(0.05) { "wrist_coupling" } else { rng.pick(&EFFECTS) };
            let mut ids = vec![first];
            while kind == Kind::Two && ids.len() < 2 {
                let next = rng.pick(&EFFECTS);
                if next != first {
                    ids.push(next);
                }
            }
            ids
        }
        _ => Vec::new(),
    }
}

/// A case of a kind.
pub(super) fn case(seed: u64, number: usize, kind: Kind) -> Case {
    let mut rng = Rng::stream(seed, number, "faults");
    let ids = wanted(kind, &mut rng);
    let motors = ids.iter().any(|id| MOTOR_EFFECTS.contains(id));
    let baseline = rng.chance(0.6);
    let setting = Setting::new(seed, number, motors, baseline);
    let faults = sized(&setting, &ids, &mut rng);
    let kind = match (kind, faults.len()) {
        (Kind::Two, 1) => Kind::One,
        (Kind::One | Kind::Two | Kind::Outside | Kind::ParametersOnly, 0) => Kind::Healthy,
        (kind, _) => kind,
    };
    let series: Vec<Vec<Row>> =
        setting.runs.iter().map(|run| logged(&setting.world, run, &faults)).collect();
    let files = files(&setting, &faults, &series, seed, number);
    let effects = truths(&setting, &faults, &series);
    let gap = heldout(&setting.world, &setting.heldout, &faults);
    let squares: Vec<f64> = gap.iter().map(|row| row.effects * row.effects).collect();
    let place = largest(&squares);
    Case { place, effects, heldout: gap, ..Case::new(files, setting.options(), kind) }
}

/// All files of a case.
fn files(
    setting: &Setting,
    faults: &[Fault],
    series: &[Vec<Row>],
    seed: u64,
    number: usize,
) -> Vec<(String, String)> {
    let world = &setting.world;
    let mut files = vec![setting.model()];
    let mut rng = Rng::stream(seed, number, "logger");
    // Windows count from the start of a log: its times then start at 0.
    let zero = faults.iter().any(|fault| fault.window.is_some());
    let logger = Recorder::new(setting.schedule.rate, zero, &mut rng);
    let mut add = |name: String, run: &Run, series: &[Row]| {
        let mut rng = Rng::stream(seed, number, &name);
        let text = csv(world, run, series, &[], &logger, &mut rng);
        files.push((name, text));
    };
    for (k, (run, series)) in setting.runs.iter().zip(series).enumerate() {
        add(format!("log-{}.csv", k + 1), run, series);
    }
    add("heldout.csv".to_owned(), &setting.heldout, &logged(world, &setting.heldout, faults));
    for (k, run) in setting.baselines.iter().enumerate() {
        add(format!("baseline-{}.csv", k + 1), run, &logged(world, run, &[]));
    }
    files
}

/// The truth of each fault.
fn truths(setting: &Setting, faults: &[Fault], series: &[Vec<Row>]) -> Vec<Truth> {
    let Some(first) = setting.runs.first() else { return Vec::new() };
    if faults.is_empty() {
        return Vec::new();
    }
    let left = everyday(&setting.world, first, &logged(&setting.world, first, &[]));
    let evidence =
        Evidence::new(&setting.world, &setting.runs, &setting.baselines, &setting.spread, &left);
    let one = |(which, fault): (usize, &Fault)| Truth {
        nats: evidence.nats(faults, which, series),
        ..fault.truth(setting.schedule.repeats())
    };
    faults.iter().enumerate().map(one).collect()
}

//! `joulepath excite`: a motion from which a robot's parameters can be told.

mod area;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use anyhow::bail;
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget};
use nalgebra::Vector3;
use serde_json::{Value, json};

use self::area::{keep_out, numbers, plane};
use super::common::{self, Format};
use super::{load, output};
use crate::arm::dynamics::{Data, Load, torque};
use crate::arm::effects;
use crate::arm::kinematics::{Body, Obstacle, Plane};
use crate::arm::robot::Model;
use crate::learn::excite::{
    Blend, Checked, Design, Focus, Information, Plateaus, Series, State, blends, check, design,
    friction_plateaus, wrist_plateaus,
};
use crate::tool::emit::{Excitation, LoggedTorques, Points, excitation};

/// Interval of the rows of the table \[s\]: the grid on which limits are checked.
const FINE: f64 = 0.001;
/// What adaptive points may lie off the path \[rad\], and their largest distance \[s\].
const OFF_PATH: f64 = 1e-3;
const WIDEST: f64 = 0.1;
/// Base frequencies of a motion that can be designed and recorded \[Hz\].
const SLOWEST: f64 = 0.01;
const FASTEST: f64 = 10.0;
/// Least share of the speed limits: slower, joints stick.
const LEAST_SPEED: f64 = 0.001;
/// Most repetitions.
const MOST_CYCLES: usize = 10_000;
/// Points in a period of the fastest harmonic, at least.
const LEAST_POINTS: f64 = 6.0;
/// What the RAPID can tell of the time between points \[s\], and how many more points than
/// were asked for may be needed to make a period of such times.
const TICK: f64 = 1e-4;
const MORE_POINTS: f64 = 1.3;
/// Share of joint 1's range by which its marks lie off its middle.
const MARKS: f64 = 0.02;

/// A motion that lets a robot's parameters be told from its torques, as RAPID with a logger.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath excite --robot IRB1600-10/1.45 --plane \"1,0,0,-0.8\" --out excitation"
)]
pub struct ExciteArgs {
    /// The robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    robot: String,

    /// Where the RAPID modules and excitation.csv go.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// What is to be told.
    #[arg(long, value_enum, default_value_t = Variant::Full)]
    variant: Variant,

    /// Base frequency, Hz.
    #[arg(long, allow_negative_numbers = true, value_name = "HZ", default_value_t = 0.1)]
    base_frequency: f64,

    /// Harmonics of it that are used.
    #[arg(long, allow_negative_numbers = true, value_name = "K,…", value_delimiter = ',', default_values_t = [1, 4, 7])]
    harmonics: Vec<usize>,

    /// Repetitions.
    #[arg(long, allow_negative_numbers = true, value_name = "N", default_value_t = 7)]
    cycles: usize,

    /// Keep arm and tool where n·x ≥ d: a normal and a distance in m, base frame; repeatable.
    #[arg(long = "plane", value_name = "NX,NY,NZ,D", allow_hyphen_values = true)]
    planes: Vec<String>,

    /// Keep arm and tool out of the box between two corners, m, base frame; repeatable.
    #[arg(long = "box", value_name = "X,Y,Z,X,Y,Z", allow_hyphen_values = true)]
    boxes: Vec<String>,

    /// Share of the joints' speed limits that is used.
    #[arg(long, allow_negative_numbers = true, value_name = "SHARE", default_value_t = 0.8)]
    speed_share: f64,

    /// Time between the points of the stream, seconds, or `adaptive`: as far apart as keeps the
    /// path within 1 mrad.
    #[arg(long, allow_negative_numbers = true, value_name = "SECONDS", default_value = "0.01")]
    spacing: Spacing,

    /// Where the logger has torques from.
    #[arg(long, value_enum, default_value_t = TorqueArg::TestSignal)]
    torque: TorqueArg,

    /// Where the tool reaches, tool0, mm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    tool: Option<String>,

    /// What the flange carries: KG, KG,X,Y,Z (mm) or a loaddata of RAPID.
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    load: Option<String>,

    /// Another seed starts the search elsewhere.
    #[arg(long, allow_negative_numbers = true, value_name = "N", default_value_t = 1)]
    seed: u64,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No notes and no progress on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// Time between points.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spacing {
    /// \[s\].
    Seconds(f64),
    /// As the motion allows.
    Adaptive,
}

impl FromStr for Spacing {
    type Err = String;

    fn from_str(text: &str) -> Result<Spacing, String> {
        if text == "adaptive" {
            return Ok(Spacing::Adaptive);
        }
        match text.parse() {
            Ok(seconds) if f64::is_finite(seconds) && seconds > 0.0 => {
                Ok(Spacing::Seconds(seconds))
            }
            _ => Err("give a number of seconds above 0, or adaptive".into()),
        }
    }
}

impl Spacing {
    /// For a motion with such states \[s\].
    fn of(self, states: &[State]) -> f64 {
        match self {
            Spacing::Seconds(seconds) => seconds,
            Spacing::Adaptive => {
                let hardest = states.iter().flat_map(|[_, _, qdd]| qdd.iter());
                let hardest = hardest.fold(0.0, |m: f64, x| m.max(x.abs()));
                // A corner is cut in the middle between points: q̈ Δt²/8 off.
                (8.0 * OFF_PATH / hardest).sqrt().min(WIDEST)
            }
        }
    }
}

/// Where the logger has torques from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TorqueArg {
    /// Test signal 4002, arm side.
    TestSignal,
    /// `GetMotorTorque`, for controllers without test signals; needs the robot's gear ratios.
    MotorTorque,
}

/// Experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Variant {
    /// All parameters.
    Full,
    /// Weights: slowly, each pose from both sides.
    Gravity,
    /// Friction over speed: each joint alone, six speeds both ways.
    Friction,
    /// What the flange carries: run it with and without.
    Payload,
    /// Axis 5 alone, 5 and 6 against each other, 6 alone.
    Wrist,
    /// The full motion again and again, from cold to warm.
    Warming,
}

/// A motion to be written.
struct Motion {
    period: f64,
    cycles: usize,
    /// One repetition.
    states: Vec<State>,
    /// The states every `spacing`.
    points: Vec<State>,
    blends: Option<[Blend; 2]>,
    information: Option<Information>,
    checked: Checked,
}

/// Runs the command.
///
/// # Errors
/// A robot without limits, options that make no sense, or output that can't be written.
pub fn run(args: &ExciteArgs) -> anyhow::Result<ExitCode> {
    let model = effects::load_estimated(&args.robot)?;
    if model.dof != 6 {
        bail!("{} has {} joints; RAPID is written for robots with 6", model.name, model.dof);
    }
    let settings = settings(args, &model)?;
    for text in model.assumed() {
        common::note(args.quiet, &text);
    }
    let body = Body::new(&model, settings.tool, &settings.obstacles);
    let plateaus = |found: Plateaus| of_plateaus(args, &model, &settings, &body, &found);
    let motion = match args.variant {
        Variant::Friction => plateaus(friction_plateaus(&model, &body, args.speed_share)?),
        Variant::Wrist => plateaus(wrist_plateaus(&model, &body, args.speed_share)?),
        _ => of_design(args, &model, &settings, &body)?,
    };
    let outputs = write(args, &model, &settings.load, &motion)?;
    let mut out = std::io::stdout().lock();
    match args.format {
        Format::Json => writeln!(out, "{:#}", document(&motion, &outputs))?,
        Format::Text => write!(out, "{}", text(&motion, &outputs))?,
    }
    Ok(ExitCode::SUCCESS)
}

fn settings(args: &ExciteArgs, model: &Model) -> anyhow::Result<Design> {
    let positive = |option: &str, value: f64| -> anyhow::Result<()> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        bail!("{option} {value}: give a number above 0")
    };
    positive("--base-frequency", args.base_frequency)?;
    positive("--speed-share", args.speed_share)?;
    if !(SLOWEST..=FASTEST).contains(&args.base_frequency) {
        bail!(
            "--base-frequency {}: a repetition would last {:.3} s; give {SLOWEST} to {FASTEST} Hz",
            args.base_frequency,
            1.0 / args.base_frequency
        );
    }
    if !(LEAST_SPEED..=1.0).contains(&args.speed_share) {
        bail!(
            "--speed-share {}: give a share of the speed limits, from {LEAST_SPEED} to 1",
            args.speed_share
        );
    }
    if !(1..=MOST_CYCLES).contains(&args.cycles) {
        bail!("--cycles {}: give 1 to {MOST_CYCLES}", args.cycles);
    }
    let mut harmonics = args.harmonics.clone();
    harmonics.sort_unstable();
    harmonics.dedup();
    if harmonics.is_empty() || harmonics[0] == 0 || harmonics[harmonics.len() - 1] > 100 {
        bail!(
            "--harmonics: give whole multiples of the base frequency from 1 to 100, such as 1,4,7"
        );
    }
    if let Spacing::Seconds(spacing) = args.spacing {
        let fastest = args.base_frequency * harmonics[harmonics.len() - 1] as f64;
        let widest = WIDEST.min(1.0 / (LEAST_POINTS * fastest));
        if !(FINE..=widest).contains(&spacing) {
            bail!(
                "--spacing {spacing}: points have to be {FINE} to {widest:.4} s apart, {LEAST_POINTS} \
                 or more in a period of the fastest harmonic"
            );
        }
    }
    let mut obstacles = Vec::new();
    for text in &args.planes {
        obstacles.push(Obstacle::Plane(plane(text)?));
    }
    for text in &args.boxes {
        obstacles.push(Obstacle::KeepOut(keep_out(text)?));
    }
    obstacles.extend(floor(model));
    let tool = match &args.tool {
        Some(text) => {
            let [x, y, z] = numbers("--tool", text, "three lengths in mm, such as 0,0,250")?;
            Vector3::new(x, y, z) * 1e-3
        }
        None => Vector3::zeros(),
    };
    let (focus, base_frequency, harmonics, speed_share) = match args.variant {
        // A tenth of the speed: hardly any inertia, and friction that keeps its sense.
        Variant::Gravity => {
            (Focus::Gravity, 0.1 * args.base_frequency, harmonics, 0.1 * args.speed_share)
        }
        Variant::Payload => (Focus::Payload, args.base_frequency, harmonics, args.speed_share),
        _ => (Focus::All, args.base_frequency, harmonics, args.speed_share),
    };
    let load = load::of_option(args.load.as_deref())?;
    Ok(Design {
        focus,
        base_frequency,
        harmonics,
        speed_share,
        obstacles,
        tool,
        load,
        seed: args.seed,
    })
}

/// The floor that a robot stands on, which it does not reach below; none of one that hangs or leans.
pub(super) fn floor(model: &Model) -> Option<Obstacle> {
    let base = &model.kinematics.base;
    let distance = -base.translation.z;
    let stands = base.rotation.angle() < 1e-6;
    stands.then_some(Obstacle::Plane(Plane { normal: Vector3::z(), distance }))
}

fn of_design(
    args: &ExciteArgs,
    model: &Model,
    settings: &Design,
    body: &Body<'_>,
) -> anyhow::Result<Motion> {
    let target =
        if args.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(None, target);
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let found = design(model, settings, &progress)?;
    bar.finish_and_clear();
    let fits = |states: &[State]| {
        let checked = check(model, body, &settings.load, states);
        let r = &checked.ratios;
        [r.position, r.acceleration, r.torque].iter().all(|ratio| *ratio <= 1.0)
            && r.velocity <= settings.speed_share
            && checked.to_obstacles >= 0.0
            && checked.to_itself >= 0.0
    };
    let Some((series, blends)) = blends(model, &found.series, &fits) else {
        bail!("no way from rest into the motion keeps the limits: give another --seed");
    };
    let states = sampled(&series);
    // A period is a whole number of points; a slow motion needs no more of them.
    let spacing = match args.spacing {
        Spacing::Seconds(_) => args.base_frequency / settings.base_frequency,
        Spacing::Adaptive => 1.0,
    } * args.spacing.of(&states);
    let points = whole(series.period(), spacing);
    let cycles =
        if args.variant == Variant::Warming { WARMING.max(args.cycles) } else { args.cycles };
    Ok(Motion {
        period: series.period(),
        cycles,
        states,
        points: series.sampled(points),
        blends: Some(blends),
        information: Some(found.information),
        checked: found.checked,
    })
}

/// Points of a period that are at most `spacing` \[s\] apart, by a time that the RAPID can
/// state exactly where there is one: else repetitions would last longer than the period.
fn whole(period: f64, spacing: f64) -> usize {
    let least = (period / spacing - 1e-6).ceil().max(3.0) as usize;
    let most = (MORE_POINTS * least as f64) as usize;
    let is_exact = |points: &usize| {
        let ticks = period / (TICK * *points as f64);
        (ticks - ticks.round()).abs() < 1e-6 * ticks
    };
    (least..=most).find(is_exact).unwrap_or(least)
}

/// How much further apart the points of straight moves may be.
const EVEN: f64 = 10.0;

/// Repetitions that take a robot from cold to warm.
const WARMING: usize = 120;

fn sampled(series: &Series) -> Vec<State> {
    series.sampled((series.period() / FINE).round().max(1.0) as usize)
}

fn of_plateaus(
    args: &ExciteArgs,
    model: &Model,
    settings: &Design,
    body: &Body<'_>,
    plateaus: &Plateaus,
) -> Motion {
    let states = plateaus.sampled(FINE);
    Motion {
        period: plateaus.duration(),
        cycles: 1,
        points: plateaus.sampled(match args.spacing {
            Spacing::Seconds(seconds) => EVEN * seconds,
            Spacing::Adaptive => args.spacing.of(&states),
        }),
        blends: None,
        information: None,
        checked: check(model, body, &settings.load, &states),
        states,
    }
}

/// Writes the modules and the table; their paths.
fn write(
    args: &ExciteArgs,
    model: &Model,
    load: &Load,
    motion: &Motion,
) -> anyhow::Result<Vec<String>> {
    let six = |state: &State| -> [f64; 6] { std::array::from_fn(|joint| state[0][joint]) };
    let of = |states: &[State]| states.iter().map(six).collect::<Vec<_>>();
    let mut lists = Vec::new();
    let (mut start, mut stop) = (motion.points.first().map(six), motion.points.last().map(six));
    let spacing = motion.period / motion.points.len().max(1) as f64;
    let into = motion.blends.as_ref().map(|[into, _]| into.sampled(spacing));
    let out = motion.blends.as_ref().map(|[_, out]| out.sampled(spacing));
    if let Some(into) = &into {
        start = into.first().map(six);
        let points = of(into.get(1..).unwrap_or_default());
        lists.push(Points { what: "From rest", name: "In", repeated: false, points });
    }
    // A blend ends where the period begins, and the period where the next one does.
    let mut period = motion.points.clone();
    if motion.blends.is_some() && !period.is_empty() {
        period.rotate_left(1);
    }
    let repeated = motion.cycles > 1;
    lists.push(Points { what: "One repetition", name: "Q", repeated, points: of(&period) });
    if let Some(out) = &out {
        stop = out.last().map(six);
        let points = of(out.get(1..out.len().saturating_sub(1)).unwrap_or_default());
        lists.push(Points { what: "To rest", name: "Out", repeated: false, points });
    }
    let first: Vec<f64> = motion.states.iter().map(|state| state[0][0]).collect();
    let low = first.iter().copied().fold(f64::INFINITY, f64::min);
    let high = first.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (middle, range) = (0.5 * (low + high), high - low);
    let modules = excitation(&Excitation {
        title: title(args.variant).to_owned(),
        robot: model.name.clone(),
        cycles: motion.cycles,
        period: motion.period,
        spacing,
        start: start.unwrap_or_default(),
        lists,
        stop: stop.unwrap_or_default(),
        marks: [middle - MARKS * range, middle + MARKS * range],
        torques: logged_torques(args.torque, model)?,
    })?;
    let mut outputs = Vec::new();
    let table = table(model, load, motion);
    for (name, text) in [modules.motion, modules.logger, ("excitation.csv".to_owned(), table)] {
        let path = args.out.join(name);
        output::write(&path, text.as_bytes())?;
        outputs.push(path.display().to_string());
    }
    Ok(outputs)
}

fn logged_torques(from: TorqueArg, model: &Model) -> anyhow::Result<LoggedTorques> {
    if from == TorqueArg::TestSignal {
        return Ok(LoggedTorques::TestSignals);
    }
    let Some(motors) = &model.motors else {
        bail!(
            "--torque motor-torque: {} has no gear ratios; give them in [motors] of a robot file",
            model.name
        );
    };
    Ok(LoggedTorques::Motors { ratio: motors.ratio.clone(), coupling: model.wrist.coupling })
}

fn title(variant: Variant) -> &'static str {
    match variant {
        Variant::Full => "Excitation of all parameters",
        Variant::Gravity => "Slow excitation of the weights",
        Variant::Friction => "Friction of each joint over speed",
        Variant::Payload => "Excitation of what the flange carries",
        Variant::Wrist => "Axes 5 and 6 alone and against each other",
        Variant::Warming => "Excitation of all parameters, from cold to warm",
    }
}

/// One repetition, every millisecond.
fn table(model: &Model, load: &Load, motion: &Motion) -> String {
    let n = model.dof;
    let mut csv = String::from("t");
    for name in ["q", "qd", "qdd", "tau"] {
        for joint in 1..=n {
            let _ = write!(csv, ",{name}{joint}");
        }
    }
    csv.push('\n');
    let mut data = Data::new();
    let step = motion.period / motion.states.len().max(1) as f64;
    for (row, [q, qd, qdd]) in motion.states.iter().enumerate() {
        // Whole microseconds read better than what rounding leaves.
        let _ = write!(csv, "{}", (step * row as f64 * 1e6).round() / 1e6);
        for values in [q, qd, qdd] {
            for value in &values[..n] {
                let _ = write!(csv, ",{value}");
            }
        }
        let parts = torque(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
        for joint in 0..n {
            if model.has_dynamics() {
                let _ = write!(csv, ",{}", parts.rigid[joint] + parts.friction[joint]);
            } else {
                csv.push(',');
            }
        }
        csv.push('\n');
    }
    csv
}

fn document(motion: &Motion, outputs: &[String]) -> Value {
    let information = motion.information.as_ref();
    let checked = &motion.checked;
    let room = |room: f64| if room.is_finite() { json!(room) } else { Value::Null };
    json!({
        "period_s": motion.period,
        "cycles": motion.cycles,
        "points": motion.points.len(),
        "rank": information.map(|i| i.rank),
        "condition": {
            "scaled": information.map(|i| i.scaled),
            "raw": information.map(|i| i.raw),
        },
        "log_det": information.map(|i| i.log_det),
        "max_ratio": {
            "position": checked.ratios.position,
            "velocity": checked.ratios.velocity,
            "acceleration": checked.ratios.acceleration,
            "torque": checked.ratios.torque,
        },
        "workspace_margin_m": room(checked.to_obstacles),
        "self_margin_m": room(checked.to_itself),
        "blend_s": motion.blends.as_ref().map(|of| of.iter().map(|b| b.duration).collect::<Vec<_>>()),
        "outputs": outputs,
    })
}

fn text(motion: &Motion, outputs: &[String]) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{} repetition(s) of {:.2} s, {} points each",
        motion.cycles,
        motion.period,
        motion.points.len()
    );
    if let Some(told) = &motion.information {
        let _ = writeln!(
            text,
            "{} base parameters, condition {:.1} scaled, {:.0} raw, log det {:.1}",
            told.rank, told.scaled, told.raw, told.log_det
        );
    }
    let r = &motion.checked.ratios;
    let torque = match r.torque {
        0.0 => "not known (no dynamics or no limits)".to_owned(),
        torque => format!("{torque:.2}"),
    };
    let _ = writeln!(
        text,
        "largest share of the limits: position {:.2}, speed {:.2}, acceleration {:.2}, torque {torque}",
        r.position, r.velocity, r.acceleration
    );
    let _ = writeln!(
        text,
        "least room: {:.3} m to planes and boxes, {:.3} m of the arm to itself (capsules of assumed radii)",
        motion.checked.to_obstacles, motion.checked.to_itself
    );
    for path in outputs {
        let _ = writeln!(text, "{path}");
    }
    text
}

//! The virtual controller compared with logged runs of an IRC5: durations, joint paths, corners.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use flate2::read::GzDecoder;
use joulepath::arm::kinematics::fk;
use joulepath::arm::robot::{Model, find};
use joulepath::retime::motion::Options;
use joulepath::retime::motion::timeline::{Run, What};
use nalgebra::Vector3;
use serde_json::Value;

use super::{shared, support};

/// The virtual controller logs ticks of 4 ms for periods of 4.032 ms.
const VIRTUAL_CLOCK: f64 = 1.008;
/// Rate in rad/s below which a joint counts as at rest, as in the published durations.
const STANDS: f64 = 0.3_f64 / 180.0 * std::f64::consts::PI;
/// Pause between the approach and the run in a log, s.
const PAUSE: f64 = 0.09;
/// Sampling interval of the comparison, s.
const PERIOD: f64 = 0.004;
/// Least difference of the directions before and after a corner.
const CORNER: f64 = 0.1;
/// Relative and absolute tolerance of the closest approach to a corner.
const APPROACH: (f64, f64) = (0.1, 0.5e-3);

/// Limits of the errors of the durations (%) and of the share of missed corners.
struct Limits {
    median: f64,
    p90: f64,
    worst: f64,
    corners: f64,
}
const VIRTUAL: Limits = Limits { median: 1.0, p90: 3.0, worst: 8.0, corners: 0.15 };
/// The logs of two real runs are incomplete.
const REAL: Limits = Limits { median: 2.0, p90: 5.0, worst: 15.0, corners: 0.25 };
/// Median over the runs of the joints' RMS, rad.
const JOINTS: f64 = 5e-3;

/// One logged run.
struct Logged {
    real: bool,
    program: String,
    speed: String,
    zone: String,
    /// Published duration with corrected clock, s.
    duration: f64,
    /// Time (s) and joints (rad) from the start of the motion to its end.
    motion: Vec<(f64, [f64; 6])>,
}

impl Logged {
    /// A third of the programs and settings, excluded from every fit (FNV-1a of the name).
    fn held_out(&self) -> bool {
        let name = format!("{}/{}_{}", self.program, self.speed, self.zone);
        let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        (hash >> 32) % 3 == 0
    }
}

/// A run and its simulation.
struct Compared {
    logged: Logged,
    duration: f64,
    /// RMS of the joint path at equal times, rad.
    rms: f64,
    /// Closest approach to each corner, logged and simulated, m.
    corners: Vec<(f64, f64)>,
}

impl Compared {
    fn error(&self) -> f64 {
        self.duration / self.logged.duration - 1.0
    }

    fn corner_fails(&self) -> usize {
        self.corners.iter().filter(|(l, s)| !near(*l, *s)).count()
    }
}

fn near(logged: f64, simulated: f64) -> bool {
    (simulated - logged).abs() <= (APPROACH.0 * logged).max(APPROACH.1)
}

/// The programs of the published study as RAPID.
fn rapid(program: &[Value], speed: &str, zone: &str) -> String {
    let speed = if speed == "vmax" {
        "[10000,9999999,9999999,999999]".to_owned()
    } else {
        speed.to_owned()
    };
    let zone = if zone == "z500" { "[FALSE,500,750,750,75,750,75]" } else { zone };
    let list = |value: &Value| {
        let numbers: Vec<String> =
            value.as_array().unwrap().iter().map(ToString::to_string).collect();
        format!("[{}]", numbers.join(","))
    };
    let none = "[9E9,9E9,9E9,9E9,9E9,9E9]";
    let target = |value: &Value| {
        let [trans, rot, conf] = ["trans_mm", "rot_wxyz", "conf"].map(|key| list(&value[key]));
        format!("[{trans},{rot},{conf},{none}]")
    };
    let mut text = String::from(
        "MODULE Logged\nPERS tooldata tool:=[TRUE,[[75,0,493.30127019],\
         [0.9659258262890683,0,0.25881904510252074,0]],[1,[0,0,0.001],[1,0,0,0],0,0,0]];\n\
         PROC main()\n",
    );
    for (index, step) in program.iter().enumerate() {
        let (speed, zone) = if index == 0 { ("v500", "fine") } else { (speed.as_str(), zone) };
        let end = format!("{speed},{zone},tool;");
        let line = match step["op"].as_str().unwrap() {
            "MoveAbsJ" => format!("MoveAbsJ [{},{none}],{end}", list(&step["joints_deg"])),
            "MoveL" => format!("MoveL {},{end}", target(&step["target"])),
            "MoveJ" => format!("MoveJ {},{end}", target(&step["target"])),
            "MoveC" => format!("MoveC {},{},{end}", target(&step["via"]), target(&step["target"])),
            other => panic!("unknown movement {other}"),
        };
        writeln!(text, "{line}").unwrap();
    }
    text.push_str("WaitTime 0.1;\nENDPROC\nENDMODULE\n");
    text
}

/// The rows of a log during the programmed motion.
fn motion(text: &str, clock: f64) -> Vec<(f64, [f64; 6])> {
    let mut rows: Vec<(f64, [f64; 6])> = Vec::new();
    for line in text.lines() {
        let cells: Vec<f64> = line.split(',').filter_map(|x| x.trim().parse().ok()).collect();
        if let [t, _, joints @ ..] = cells.as_slice()
            && joints.len() == 6
        {
            rows.push((t * clock, std::array::from_fn(|j| joints[j].to_radians())));
        }
    }
    // Time stamps jitter by a millisecond, the sampling does not.
    let (first, last) = (rows[0].0, rows[rows.len() - 1].0);
    let step = (last - first) / (rows.len() - 1) as f64;
    for (i, row) in rows.iter_mut().enumerate() {
        row.0 = first + step * i as f64;
    }
    let moves = |pair: &[(f64, [f64; 6])]| {
        (0..6).any(|j| (pair[1].1[j] - pair[0].1[j]).abs() > STANDS * step)
    };
    let moving: Vec<usize> =
        rows.windows(2).enumerate().filter(|(_, p)| moves(p)).map(|(i, _)| i).collect();
    let pause = (PAUSE / step) as usize;
    let begin = moving.windows(2).rposition(|p| p[1] - p[0] > pause).map_or(0, |i| i + 1);
    let (begin, end) = (moving[begin], moving[moving.len() - 1] + 1);
    let start = rows[begin].0;
    rows[begin..=end].iter().map(|(t, q)| (t - start, *q)).collect()
}

fn logged(summary: &str) -> Vec<Logged> {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join("controller_runs");
    let rows = summary.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    rows.map(|cells| {
        let [env, program, speed, zone] = [0, 1, 2, 3].map(|i| cells[i].to_owned());
        let path = folder.join(&env).join(&program).join(format!("{speed}_{zone}.csv.gz"));
        let mut text = String::new();
        GzDecoder::new(File::open(path).unwrap()).read_to_string(&mut text).unwrap();
        let real = env == "real";
        let clock = if real { 1.0 } else { VIRTUAL_CLOCK };
        let duration = clock * cells[4].parse::<f64>().unwrap();
        let motion = motion(&text, clock);
        Logged { real, program, speed, zone, duration, motion }
    })
    .collect()
}

/// The runs of the simulated program after the approach, each with its start, s.
fn simulated(model: &Model, text: &str) -> Vec<(f64, Run)> {
    let simulation = support::simulated(model, &support::program(text), &Options::default());
    assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
    let runs = simulation.events.into_iter().filter_map(|event| match event.what {
        What::Run(run) if event.duration > 0.0 => Some((event.t_start, *run)),
        _ => None,
    });
    runs.collect()
}

fn state(runs: &[(f64, Run)], t: f64) -> ([f64; 6], [f64; 6]) {
    let (start, run) =
        runs.iter().rfind(|(start, _)| *start <= t).unwrap_or_else(|| runs.first().unwrap());
    let state = run.at((t - start).max(0.0));
    (state.q, state.qd)
}

fn at(rows: &[(f64, [f64; 6])], t: f64) -> [f64; 6] {
    let after = rows.partition_point(|(at, _)| *at <= t).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[after - 1], &rows[after]);
    let share = ((t - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
    std::array::from_fn(|j| a.1[j] + share * (b.1[j] - a.1[j]))
}

/// Least distance between a polyline and a point.
fn approach(points: &[Vector3<f64>], corner: &Vector3<f64>) -> f64 {
    points
        .windows(2)
        .map(|p| {
            let along = p[1] - p[0];
            let square = along.norm_squared();
            let share = if square > 0.0 {
                ((corner - p[0]).dot(&along) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (p[0] + along * share - corner).norm()
        })
        .fold(f64::INFINITY, f64::min)
}

fn compare(model: &Model, program: &[Value], logged: Logged) -> Compared {
    let runs = simulated(model, &rapid(program, &logged.speed, &logged.zone));
    let origin = runs[0].0;
    let duration: f64 = runs.iter().map(|(_, run)| run.duration()).sum();
    let tool = runs[0].1.legs[0].tool;
    let tcp = |q: &[f64; 6]| tool.pose(&fk(model, q)).translation.vector;

    let moves = |t: f64| state(&runs, origin + t).1.iter().any(|qd| qd.abs() > STANDS);
    let times = (0..(1e3 * duration) as u32).map(|i| f64::from(i) * 1e-3);
    let begin = times.into_iter().find(|t| moves(*t)).unwrap();
    let end = logged.motion[logged.motion.len() - 1].0.max(duration - begin);
    let steps = (end / PERIOD) as usize;
    let mut square = 0.0;
    let mut points = Vec::new();
    for i in 0..=steps {
        let t = i as f64 * PERIOD;
        let (a, b) = (at(&logged.motion, t), state(&runs, origin + begin + t).0);
        square += (0..6).map(|j| (a[j] - b[j]).powi(2)).sum::<f64>();
        points.push(tcp(&b));
    }
    let rms = (square / (6 * (steps + 1)) as f64).sqrt();

    let logged_points: Vec<_> = logged.motion.iter().map(|(_, q)| tcp(q)).collect();
    let legs: Vec<_> = runs.iter().flat_map(|(_, run)| &run.legs).collect();
    let mut corners = Vec::new();
    for pair in legs.windows(2) {
        let at = |q: &[f64; 6]| tcp(q);
        let corner = pair[0].target.translation.vector;
        let before = (corner - at(&pair[0].start)).normalize();
        let after = (pair[1].target.translation.vector - corner).normalize();
        if !pair[0].zone.fine && (after - before).norm() > CORNER {
            corners.push((approach(&logged_points, &corner), approach(&points, &corner)));
        }
    }
    Compared { logged, duration, rms, corners }
}

fn percentile(values: &[f64], share: f64) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let at = share * (values.len() - 1) as f64;
    let (low, high) = (at.floor() as usize, at.ceil() as usize);
    values[low] + (values[high] - values[low]) * at.fract()
}

/// Median, 90th percentile and worst of |error| of the durations in %, and median RMS in mrad.
struct Figures {
    runs: usize,
    median: f64,
    p90: f64,
    worst: f64,
    rms: f64,
    corners: (usize, usize),
}

fn figures<'a>(compared: impl Iterator<Item = &'a Compared>) -> Figures {
    let compared: Vec<_> = compared.collect();
    let errors: Vec<f64> = compared.iter().map(|c| 100.0 * c.error().abs()).collect();
    let rms: Vec<f64> = compared.iter().map(|c| 1e3 * c.rms).collect();
    Figures {
        runs: errors.len(),
        median: percentile(&errors, 0.5),
        p90: percentile(&errors, 0.9),
        worst: percentile(&errors, 1.0),
        rms: percentile(&rms, 0.5),
        corners: (
            compared.iter().map(|c| c.corner_fails()).sum(),
            compared.iter().map(|c| c.corners.len()).sum(),
        ),
    }
}

fn table(compared: &[Compared]) {
    let mut cells: BTreeMap<(bool, &str, usize, usize), &Compared> = BTreeMap::new();
    let speeds = ["v50", "v300", "v500", "v1000", "v1500", "vmax"];
    let zones = ["fine", "z1", "z10", "z20", "z50", "z100", "z200", "z500"];
    let index = |list: &[&str], name: &str| list.iter().position(|x| *x == name).unwrap();
    for c in compared {
        let (speed, zone) = (index(&speeds, &c.logged.speed), index(&zones, &c.logged.zone));
        cells.insert((c.logged.real, &c.logged.program, speed, zone), c);
    }
    let mut row = None;
    let mut text = String::new();
    for ((real, program, speed, _), c) in &cells {
        if row != Some((*real, *program, *speed)) {
            row = Some((*real, *program, *speed));
            let env = if *real { "real" } else { "virtual" };
            write!(text, "\n{env:8}{program:15}{:6}", speeds[*speed]).unwrap();
        }
        let mark = if c.logged.held_out() { '*' } else { ' ' };
        let fails = c.corner_fails();
        let corners = if fails > 0 { format!("!{fails}") } else { String::new() };
        let error = 100.0 * c.error();
        write!(text, "  {}{mark}{error:+.2}%/{:.1}{corners}", c.logged.zone, 1e3 * c.rms).unwrap();
    }
    eprintln!("duration error / RMS of the joints in mrad, * held out, ! corners missed{text}");
}

#[test]
fn simulated_runs_agree_with_logged_runs_of_an_irc5() {
    let Some(programs) = shared("controller_runs/programs.json") else { return };
    let Some(summary) = shared("controller_runs/summary.csv") else { return };
    let programs: Value = serde_json::from_str(&programs).unwrap();
    let model = find("IRB6640-180/2.55").unwrap();
    let compared: Vec<Compared> = logged(&summary)
        .into_iter()
        .map(|run| {
            let program = programs["programs"][&run.program].as_array().unwrap();
            compare(&model, program, run)
        })
        .collect();
    table(&compared);
    for real in [false, true] {
        for held_out in [Some(false), Some(true), None] {
            let chosen = compared.iter().filter(|c| {
                c.logged.real == real && held_out.is_none_or(|h| c.logged.held_out() == h)
            });
            let f = figures(chosen);
            eprintln!(
                "{} {}: {} runs, duration median {:.2} % p90 {:.2} % worst {:.2} %, \
                 joints {:.2} mrad, corners {} of {} missed",
                if real { "real" } else { "virtual" },
                match held_out {
                    Some(false) => "fit",
                    Some(true) => "held out",
                    None => "all",
                },
                f.runs,
                f.median,
                f.p90,
                f.worst,
                f.rms,
                f.corners.0,
                f.corners.1
            );
        }
    }
    let errors = |real: bool| figures(compared.iter().filter(|c| c.logged.real == real));
    for (f, limits) in [(errors(false), VIRTUAL), (errors(true), REAL)] {
        assert!(f.median <= limits.median && f.p90 <= limits.p90, "{} % {} %", f.median, f.p90);
        assert!(f.worst <= limits.worst, "{} %", f.worst);
        assert!(f.corners.0 as f64 <= limits.corners * f.corners.1 as f64, "{:?}", f.corners);
    }
    let rms: Vec<f64> = compared.iter().map(|c| c.rms).collect();
    assert!(percentile(&rms, 0.5) <= JOINTS);
}

//! How often the intervals of `prove` hold, and how often it says `saves` where nothing was saved:
//! simulated campaigns with memory, heavy tails, other parts, longer waits, warmth and faults of the meter.
//!
//! `cargo run --release --example prove_coverage -- 200`

#![expect(clippy::print_stdout, reason = "an example prints")]

use std::collections::BTreeMap;
use std::fmt::Write as _;

use joulepath::learn::log::{Channel, Log, Scan};
use joulepath::tool::cell::prove::{PowerLog, Proof, Settings, Side, Stamp, Verdict, prove};

/// W, s, W: base load, time of the motion, mean work of the motion above the base load.
const BASE_W: f64 = 300.0;
const MOTION_S: f64 = 7.0;
const WORK_W: f64 = 520.0;
/// Rows a second.
const RATE: f64 = 20.0;

/// A kind of campaign.
#[derive(Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a condition of its own")]
struct World {
    name: &'static str,
    saving: f64,
    cycles: [usize; 2],
    /// Relative standard deviation of a cycle's work, its memory, and whether its tails are heavy.
    noise: f64,
    phi: f64,
    heavy: bool,
    /// Mean of the exponential waits on both sides, s.
    wait_s: [f64; 2],
    /// Motion after over motion before; the waits are shortened by as much if there is slack.
    slower: f64,
    has_slack: bool,
    /// Share of the heavy part on both sides.
    parts: [f64; 2],
    /// Temperature at the begin of both sides, °C; it rises by 5 K.
    degrees: [f64; 2],
    /// Gain of the meter after, and its drift from the begin to the end of all.
    gain: f64,
    drift: f64,
    /// Share of the cycles that are on the wrong side.
    swapped: f64,
    is_kilowatts: bool,
    has_cycle: bool,
}

const PLAIN: World = World {
    name: "plain",
    saving: 0.0,
    cycles: [40, 40],
    noise: 0.03,
    phi: 0.0,
    heavy: false,
    wait_s: [0.8, 0.8],
    slower: 1.0,
    has_slack: false,
    parts: [0.0, 0.0],
    degrees: [30.0, 30.0],
    gain: 1.0,
    drift: 0.0,
    swapped: 0.0,
    is_kilowatts: false,
    has_cycle: true,
};

struct Cycle {
    /// Relative noise of the work.
    noise: f64,
    part: usize,
    wait_s: f64,
    is_after: bool,
}

fn normal(random: &mut fastrand::Rng) -> f64 {
    (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (std::f64::consts::TAU * random.f64()).cos()
}

fn series(world: &World, side: usize, random: &mut fastrand::Rng) -> Vec<Cycle> {
    let mut last = normal(random);
    (0..world.cycles[side])
        .map(|_| {
            let shock = if world.heavy {
                // Student's t with 4 degrees of freedom, of unit variance.
                let chi: f64 = (0..4).map(|_| normal(random).powi(2)).sum();
                normal(random) / (chi / 4.0).sqrt() / 2.0_f64.sqrt()
            } else {
                normal(random)
            };
            last = world.phi * last + (1.0 - world.phi * world.phi).sqrt() * shock;
            let part = usize::from(random.f64() < world.parts[side]);
            let spread = if part == 1 { 1.5 } else { 1.0 };
            let wait_s = 1.2 - world.wait_s[side] * (1.0 - random.f64()).ln();
            Cycle { noise: world.noise * spread * last, part, wait_s, is_after: side == 1 }
        })
        .collect()
}

/// Work of the motion over the base load \[J\] of a cycle without noise at 30 °C; a saving is of all energy.
fn work(world: &World, cycle: &Cycle, degrees: f64) -> f64 {
    let plain = MOTION_S * WORK_W * [1.0, 1.25][cycle.part];
    let total = plain + BASE_W * (MOTION_S + 1.2 + world.wait_s[0]);
    let saved = if cycle.is_after { world.saving * total } else { 0.0 };
    // What the slower motion takes of the base load is in the saving, unless the waits make up for it.
    let longer =
        if cycle.is_after && !world.has_slack { MOTION_S * (world.slower - 1.0) } else { 0.0 };
    plain - saved - BASE_W * longer - 12.0 * (degrees - 30.0)
}

fn log(world: &World, side: usize, cycles: &[Cycle], random: &mut fastrand::Rng) -> Log {
    let channels =
        vec![Channel::Time, Channel::Power, Channel::Cycle, Channel::Part, Channel::Temperature(0)];
    let mut values = vec![Vec::new(); 5];
    let mut now = 0.0;
    let mut row = 0;
    for (number, cycle) in cycles.iter().enumerate() {
        let progress = number as f64 / cycles.len() as f64;
        let degrees = world.degrees[side] + 5.0 * progress;
        let motion = if cycle.is_after { MOTION_S * world.slower } else { MOTION_S };
        let shortened = if world.has_slack { motion - MOTION_S } else { 0.0 };
        let lasts = motion + cycle.wait_s - shortened;
        let gain = if side == 1 { world.gain } else { 1.0 };
        let gain = gain * (1.0 + world.drift * 0.5 * (side as f64 + progress));
        let level = work(world, cycle, degrees) * (1.0 + cycle.noise) / motion;
        while f64::from(row) / RATE < now + lasts {
            let t = f64::from(row) / RATE;
            let u = (t - now) / motion;
            // Mean 1 over the motion.
            let shape = 1.0
                - 0.6 * (9.0 * std::f64::consts::TAU * u).cos() * (1.0 - u)
                - 0.4 * (2.0 * std::f64::consts::TAU * u).cos();
            let power = BASE_W + if u < 1.0 { level * shape } else { 0.0 };
            let power = gain * power + 3.0 * normal(random);
            let unit = if world.is_kilowatts && side == 1 { 1e-3 } else { 1.0 };
            let fields = [t, unit * power, (number + 1) as f64, cycle.part as f64, degrees];
            for (column, field) in values.iter_mut().zip(fields) {
                column.push(field);
            }
            row += 1;
        }
        now += lasts;
    }
    let rows = (0..values[0].len() as u64).map(|row| row + 2).collect();
    let mut log = Log { channels, values, rows, rejected: Vec::new(), degrees: Vec::new() };
    if !world.has_cycle {
        log.channels.remove(2);
        log.values.remove(2);
    }
    log
}

fn campaign(world: &World, seed: u64) -> Proof {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut cycles = [0, 1].map(|side| series(world, side, &mut random));
    let count = (world.swapped * world.cycles[0] as f64).round() as usize;
    for _ in 0..count {
        let [a, b] = [0, 1].map(|side: usize| random.usize(0..cycles[side].len()));
        let [before, after] = &mut cycles;
        if !before[a].is_after && after[b].is_after {
            std::mem::swap(&mut before[a], &mut after[b]);
        }
    }
    let sides = [0, 1].map(|side| {
        let log = log(world, side, &cycles[side], &mut random);
        let shown = ["before.csv", "after.csv"][side].to_owned();
        let log = PowerLog { shown, log, scan: Scan::default(), stamp: Stamp::default() };
        Side { logs: vec![log], events: Vec::new() }
    });
    let settings = Settings { effect: 0.03, promised: None };
    prove(&sides[0], &sides[1], settings).unwrap_or_else(|error| panic!("{}: {error}", world.name))
}

fn worlds() -> Vec<World> {
    let rough = World { noise: 0.04, phi: 0.5, heavy: true, ..PLAIN };
    let mixed = World {
        parts: [0.3, 0.6],
        wait_s: [0.6, 1.2],
        degrees: [26.0, 29.0],
        noise: 0.04,
        phi: 0.3,
        heavy: true,
        ..PLAIN
    };
    let of = |name, saving, world: World| World { name, saving, ..world };
    vec![
        of("plain", 0.0, PLAIN),
        of("plain", 0.05, PLAIN),
        of("memory, heavy tails", 0.0, rough),
        of("memory, heavy tails", 0.05, rough),
        of("22 cycles", 0.0, World { cycles: [22, 22], ..PLAIN }),
        of("22 cycles", 0.05, World { cycles: [22, 22], ..PLAIN }),
        of("12 and 15, heavy tails", 0.0, World { cycles: [12, 15], heavy: true, ..PLAIN }),
        of("12 and 15, heavy tails", 0.05, World { cycles: [12, 15], heavy: true, ..PLAIN }),
        of("8 cycles", 0.0, World { cycles: [8, 8], ..PLAIN }),
        of("8 cycles", 0.05, World { cycles: [8, 8], ..PLAIN }),
        of("120, memory 0.7", 0.0, World { cycles: [120, 120], phi: 0.7, ..PLAIN }),
        of("120, memory 0.7", 0.05, World { cycles: [120, 120], phi: 0.7, ..PLAIN }),
        of("other parts, waits, warmth", 0.0, mixed),
        of("other parts, waits, warmth", 0.05, mixed),
        of("slack used up", 0.05, World { slower: 1.08, has_slack: true, ..PLAIN }),
        of("slower program", 0.0, World { slower: 1.08, ..PLAIN }),
        of("a fifth swapped", 0.05, World { swapped: 0.2, noise: 0.015, ..PLAIN }),
        of("a fifth swapped, more noise", 0.05, World { swapped: 0.2, ..PLAIN }),
        of("meter 3 % off after", 0.0, World { gain: 0.97, ..PLAIN }),
        of("meter drifts by 4 %", 0.0, World { drift: -0.04, ..PLAIN }),
        of("kW after", 0.05, World { is_kilowatts: true, ..PLAIN }),
        of("no column cycle", 0.0, World { has_cycle: false, ..PLAIN }),
        of("no column cycle", 0.05, World { has_cycle: false, ..PLAIN }),
    ]
}

fn main() {
    let count: u64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(200);
    let mut out = String::from(
        "| world | true % | campaigns | holds % | says saves % | mean % | half width | doubts | by the scatter alone % |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for world in worlds() {
        let (mut holds, mut saves, mut doubts, mut sum, mut width, mut plain) =
            (0, 0, 0, 0.0, 0.0, 0);
        let mut names: BTreeMap<&str, u64> = BTreeMap::new();
        for seed in 0..count {
            let proof = campaign(&world, 1000 + seed);
            let [low, high] = proof.saving.interval.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            let [sharp, blunt] = proof.statistical.unwrap_or([low, high]);
            holds += u64::from((low..=high).contains(&world.saving));
            plain += u64::from((sharp..=blunt).contains(&world.saving));
            saves += u64::from(proof.verdict == Verdict::Saves);
            doubts += u64::from(!proof.doubts.is_empty());
            for doubt in &proof.doubts {
                *names.entry(doubt.name).or_insert(0) += 1;
            }
            sum += 100.0 * proof.saving.value;
            width += 50.0 * (high - low);
        }
        let share = |n: u64| 100.0 * n as f64 / count as f64;
        let _ = writeln!(
            out,
            "| {} | {:.0} | {count} | {:.1} | {:.1} | {:.2} | {:.2} | {:.1} {} | {:.1} |",
            world.name,
            100.0 * world.saving,
            share(holds),
            share(saves),
            sum / count as f64,
            width / count as f64,
            share(doubts),
            names.iter().map(|(name, n)| format!("{name} {n}")).collect::<Vec<_>>().join(", "),
            share(plain),
        );
    }
    println!("{out}");
}

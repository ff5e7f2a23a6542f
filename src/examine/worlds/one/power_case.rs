//! Electric power of the cabinet: mechanical power, copper losses, what braking gives back, and its
//! faults.

use super::arm::factor;
use super::bench::Bench;
use super::plant::Sample;
use super::scene::Scene;
use crate::examine::worlds::api::{self, Kind, Truth};
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Change of the mean power by a fault, over the mean power.
const SIZES: (f64, f64) = (0.012, 0.3);
/// Real copper loss and base load differ from the nominal ones by these shares.
const LOSS_SPREAD: f64 = 0.06;
/// Spread of the base load.
const BASE_SPREAD: f64 = 0.04;
/// Noise of the meter over the mean power.
const NOISE: (f64, f64) = (0.003, 0.012);
/// Lag of the meter \[s\].
const LAG: (f64, f64) = (0.004, 0.03);
/// Base load changes from day to day by this share.
const DAY: f64 = 0.008;
/// Share by which everyday losses grow with torque and speed together.
const BENT: f64 = 0.03;
/// Currents at the largest torque \[A\].
const CURRENT: (f64, f64) = (3.0, 30.0);
/// Rest after which the brakes fall in \[s\], and the speed that counts as rest \[rad/s\].
const BRAKES: (f64, f64) = (0.8, 0.003);
/// Extra power for the time in which brakes are pulled open \[s\], relative.
const PULL: (f64, f64) = (0.2, 0.5);
/// With a baseline, losses are known to this share.
const KNOWN: f64 = 0.02;
/// Faults and forms.
const FAULTS: [(&str, [&str; 2]); 6] = [
    ("copper_loss", ["warm_windings", "skin_effect"]),
    ("inverter_loss", ["threshold_and_resistance", "rounded_switching"]),
    ("iron_loss", ["steinmetz", "hysteresis_and_eddy"]),
    ("no_regeneration", ["chopper", "small_capacitor"]),
    ("base_load", ["ripple_and_ramp", "cycling_fan"]),
    ("brake_power", ["economy_circuit", "axis_by_axis"]),
];

/// Electric side of a robot.
pub(super) struct Electric {
    number: usize,
    form: usize,
    joints: Vec<usize>,
    size: f64,
    loss: Row,
    base: f64,
    regeneration: f64,
    current: Row,
    top: Row,
    count: usize,
    noise: f64,
    lag: f64,
    bent: f64,
}

/// States along a log.
struct Living {
    heat: f64,
    store: f64,
    idle: [f64; MAX],
    released: f64,
}

impl Electric {
    /// The electric side of a case of power; its fault has a size that shows.
    pub(super) fn new(scene: &Scene, bench: &Bench) -> Option<Self> {
        if scene.plan.kind != Kind::Power {
            return None;
        }
        let mut rng = scene.plan.rng("power");
        let (arm, level) = (bench.nominal, bench.robot.level);
        let count = arm.count();
        let number = rng.below(FAULTS.len());
        let mut out = Self {
            number,
            form: rng.below(2),
            joints: Vec::new(),
            size: 0.0,
            loss: arm.loss,
            base: arm.base_w * factor(&mut rng, BASE_SPREAD),
            regeneration: arm.regeneration,
            current: [1.0; MAX],
            top: level.speed,
            count,
            noise: 0.0,
            lag: rng.log(LAG),
            bent: BENT * rng.spread(1.0),
        };
        let amperes = rng.log(CURRENT);
        for j in 0..count {
            out.loss[j] *= factor(&mut rng, LOSS_SPREAD);
            out.current[j] = amperes * rng.uniform((0.7, 1.3)) / arm.effort[j];
            out.top[j] = out.top[j].max(0.01);
        }
        if matches!(FAULTS[number].0, "copper_loss" | "iron_loss") {
            let first = rng.below(count);
            out.joints = vec![first];
            if rng.chance(0.4) {
                out.joints.push((first + 1 + rng.below(count - 1)) % count);
                out.joints.sort_unstable();
            }
        }
        let rows = bench.rows(&scene.stage(0), &[], false);
        let plain = out.raw(&rows, false);
        let mean = |p: &[f64]| p.iter().map(|x| x.abs()).sum::<f64>() / p.len().max(1) as f64;
        out.noise = rng.log(NOISE) * mean(&plain);
        out.size = 1.0;
        if FAULTS[number].0 != "no_regeneration" {
            let changed: Vec<f64> =
                out.raw(&rows, true).iter().zip(&plain).map(|(a, b)| a - b).collect();
            out.size = rng.log(SIZES) * mean(&plain) / mean(&changed).max(1e-12);
        }
        Some(out)
    }

    /// What the fault adds before the intermediate circuit \[W\].
    fn more(&self, s: &Sample, live: &Living) -> f64 {
        let currents = (0..self.count).map(|j| self.current[j] * s.motor[j].abs());
        let own = |f: &dyn Fn(usize) -> f64| self.joints.iter().map(|j| f(*j)).sum::<f64>();
        let wave = (s.t * std::f64::consts::TAU / 11.0).sin();
        self.size
            * match (FAULTS[self.number].0, self.form) {
                ("copper_loss", 0) => (0.92 + 0.16 * live.heat) * own(&|j| s.motor[j] * s.motor[j]),
                ("copper_loss", _) => own(&|j| {
                    let share = (s.v[j] / self.top[j]).powi(2);
                    s.motor[j] * s.motor[j] * (0.9 + 0.4 * share)
                }),
                ("inverter_loss", 0) => currents.map(|i| i + 0.04 * i * i).sum::<f64>(),
                ("inverter_loss", _) => currents.map(|i| (i * i + 0.25).sqrt() - 0.5).sum::<f64>(),
                ("iron_loss", 0) => own(&|j| s.v[j].abs().powf(1.6)),
                ("iron_loss", _) => {
                    own(&|j| s.v[j].abs() * (0.35 * self.top[j] + 0.65 * s.v[j].abs()))
                }
                ("base_load", 0) => 1.0 + 0.05 * wave - 0.1 * (-s.t / 30.0).exp(),
                ("base_load", _) => 1.0 + 0.12 * wave.signum(),
                ("brake_power", 0) => live.released,
                ("brake_power", _) => {
                    let open = live.idle[..self.count].iter().filter(|t| **t < BRAKES.0).count();
                    open as f64 / self.count as f64
                }
                _ => 0.0,
            }
    }

    /// Power without noise \[W\] at samples, with or without the fault.
    fn raw(&self, samples: &[Sample], fault: bool) -> Vec<f64> {
        let mut live = Living { heat: 0.0, store: 0.0, idle: [0.0; MAX], released: 0.0 };
        let mut out = Vec::with_capacity(samples.len());
        let (mut shown, mut last) = (None, samples.first().map_or(0.0, |s| s.t));
        let full = 0.15 * self.base;
        for s in samples {
            let dt = (s.t - last).max(0.0);
            last = s.t;
            self.follow(s, dt, &mut live);
            let mut dc = 0.0;
            for j in 0..self.count {
                let bent = 1.0 + self.bent * (s.v[j] / self.top[j]).abs();
                dc += s.motor[j] * s.v[j] + self.loss[j] * bent * s.motor[j] * s.motor[j];
            }
            let more = if fault { self.more(s, &live) } else { 0.0 };
            // Loads of the cabinet do not pass through the intermediate circuit.
            let (inner, outer) = if self.number >= 4 { (0.0, more) } else { (more, 0.0) };
            dc += inner;
            let lost = fault && FAULTS[self.number].0 == "no_regeneration";
            let net = if dc >= 0.0 {
                // What a small capacitor has stored is used first.
                let drawn = if lost { live.store.min(dc * dt) } else { 0.0 };
                live.store -= drawn;
                if dt > 0.0 { dc - drawn / dt } else { dc }
            } else if lost {
                if self.form == 1 {
                    live.store = (live.store - dc * dt).min(full);
                }
                0.0
            } else {
                self.regeneration * dc
            };
            let power = self.base + outer + net;
            let before = shown.unwrap_or(power);
            let now = power + (before - power) * (-dt / self.lag).exp();
            shown = Some(now);
            out.push(now);
        }
        out
    }

    /// Heat of the windings and the brakes.
    fn follow(&self, s: &Sample, dt: f64, live: &mut Living) {
        live.heat += (1.0 - live.heat) * dt / (40.0 + dt);
        let mut rest = f64::MAX;
        for j in 0..self.count {
            live.idle[j] = if s.v[j].abs() < BRAKES.1 { live.idle[j] + dt } else { 0.0 };
            rest = rest.min(live.idle[j]);
        }
        // Open brakes hold at 1 after a stronger pull.
        let goal = if rest < BRAKES.0 { 1.0 } else { 0.0 };
        if goal == 0.0 {
            live.released = 0.0;
        } else if live.released == 0.0 {
            live.released = 1.0 + PULL.1;
        } else {
            live.released = 1.0 + (live.released - 1.0) * (-dt / PULL.0).exp();
        }
    }

    /// Logged power \[W\].
    pub(super) fn log(&self, samples: &[Sample], fault: bool, rng: &mut Rng) -> Vec<f64> {
        let day = self.base * DAY * rng.spread(1.0);
        self.raw(samples, fault)
            .into_iter()
            .map(|p| p + day + self.noise * rng.spread(1.0))
            .collect()
    }

    /// The fault with its parameter.
    fn named(&self) -> Truth {
        let ((id, forms), form) = (FAULTS[self.number], self.form);
        let mut truth = Truth::new(id, forms[form], &self.joints);
        let name = match id {
            "copper_loss" | "iron_loss" => "loss",
            "inverter_loss" => "per_current",
            "no_regeneration" => return truth,
            _ => "power",
        };
        let graded = matches!((id, form), ("copper_loss", 0) | ("base_load" | "brake_power", _));
        if self.joints.is_empty() {
            truth.tell(name, None, self.size, graded);
        }
        for joint in &self.joints {
            truth.tell(name, Some(*joint), self.size, graded);
        }
        truth
    }

    /// The truth of the fault.
    pub(super) fn truth(&self, scene: &Scene, bench: &Bench) -> Truth {
        let (mut delta, mut columns) = (Vec::new(), vec![Vec::new(); self.count + 2]);
        let mut cycles = 1;
        for number in 0..scene.held() {
            let stage = scene.stage(number);
            cycles = stage.track.cycles;
            let rows = bench.rows(&stage, &[], false);
            let (with, without) = (self.raw(&rows, true), self.raw(&rows, false));
            delta.extend(with.iter().zip(&without).map(|(a, b)| a - b));
            for s in &rows {
                columns[0].push(KNOWN * self.base);
                let dc: f64 = (0..self.count)
                    .map(|j| s.motor[j] * s.v[j] + self.loss[j] * s.motor[j] * s.motor[j])
                    .sum();
                columns[1].push(2.0 * KNOWN * dc.min(0.0));
                for j in 0..self.count {
                    columns[j + 2].push(2.0 * KNOWN * self.loss[j] * s.motor[j] * s.motor[j]);
                }
            }
        }
        let everyday = self.noise * self.noise / cycles as f64 + (0.004 * self.base).powi(2);
        let columns: Vec<Vec<Vec<f64>>> = columns.into_iter().map(|c| vec![c]).collect();
        let nats = api::nats(&[delta], &[everyday.sqrt()], &columns);
        Truth { nats, ..self.named() }
    }
}

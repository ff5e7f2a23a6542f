//! Electric power of the robot, and faults of it.

use super::drive::World;
use super::everyday::Day;
use super::law::step;
use super::motion::STEP;
use super::spatial::Point;
use crate::examine::worlds::api::Truth;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Rate \[rad/s\] of joints below which the arm stands.
const STANDS: f64 = 1e-4;
/// Standstill after which controllers close the brakes \[s\].
const BRAKE_AFTER: f64 = 2.0;
/// Temperature rise of windings in usual work times the coefficient of copper, 0.0039/K.
const COPPER_HEAT: f64 = 0.12;

/// What a robot's power has beyond its model.
#[derive(Clone, Debug)]
pub(super) struct Supply {
    base: f64,
    loss: Row,
    regeneration: f64,
    /// Fans: share of the base power, and period \[s\].
    fans: [f64; 2],
    /// Ripple of the losses over the rate, share.
    bend: f64,
    /// Lag of the meter \[s\].
    lag: f64,
    /// Noise \[W\].
    noise: f64,
}

impl Supply {
    pub(super) fn new(world: &World, spread: f64, rng: &mut Rng) -> Self {
        let arm = &world.nominal;
        let mut loss = [1.0; MAX];
        for loss in &mut loss {
            *loss += rng.spread(0.5 * spread);
        }
        let regeneration = if arm.regeneration > 0.0 {
            (arm.regeneration + rng.spread(0.02)).clamp(0.0, 0.95)
        } else {
            0.0
        };
        Self {
            base: 1.0 + rng.spread(0.02),
            loss,
            regeneration,
            fans: [rng.between(0.0, 0.02), rng.between(20.0, 90.0)],
            bend: rng.between(-0.03, 0.03),
            lag: rng.log_between(0.004, 0.03),
            noise: arm.base * rng.log_between(0.003, 0.02),
        }
    }
}

/// A fault of the power.
#[derive(Clone, Debug)]
pub(super) struct PowerFault {
    pub(super) id: &'static str,
    pub(super) form: &'static str,
    pub(super) joints: Vec<usize>,
    /// Size: of the unit of the library's parameter, by joint or in the first place.
    pub(super) size: Row,
    second: bool,
    /// Shape: a rate \[rad/s\], a current \[A\], a time \[s\] or an energy \[J\].
    shape: f64,
}

/// All power effects.
pub(super) const EFFECTS: [&str; 6] =
    ["copper_loss", "inverter_loss", "iron_loss", "no_regeneration", "base_load", "brake_power"];

impl PowerFault {
    /// A fault of a usual size.
    pub(super) fn draw(id: &'static str, world: &World, rng: &mut Rng) -> Self {
        let arm = &world.nominal;
        let second = rng.chance(0.5);
        let all: Vec<usize> = (0..arm.axes()).collect();
        let count = rng.whole(1, 3);
        let joints = if matches!(id, "copper_loss" | "iron_loss") {
            rng.choose(&all, count)
        } else {
            Vec::new()
        };
        let mut size = [0.0; MAX];
        let (forms, shape) = match id {
            "copper_loss" => {
                for i in &joints {
                    size[*i] = 0.5 * arm.loss[*i];
                }
                (["corroded terminal that heats up", "shorted turns"], 0.3 * arm.speed[0])
            }
            "inverter_loss" => {
                size[0] = 4.0;
                (
                    ["rounded modulus of the current", "switching and conduction"],
                    rng.between(0.3, 1.5),
                )
            }
            "iron_loss" => {
                for i in &joints {
                    size[*i] = 0.1 * arm.usual[*i] / arm.speed[*i];
                }
                (
                    ["hysteresis, eddy and excess loss", "eddy loss with skin effect"],
                    rng.between(0.2, 0.5),
                )
            }
            "no_regeneration" => {
                size[0] = 1.0;
                (["resistor at once", "link capacitor, then chopper"], rng.between(5.0, 40.0))
            }
            "base_load" => {
                size[0] = 0.1 * arm.base;
                (["constant with a slow wave", "fan with thermostat"], rng.between(10.0, 40.0))
            }
            _ => {
                size[0] = 0.15 * arm.base;
                (["coil with economy circuit", "coil that warms"], rng.between(0.1, 0.3))
            }
        };
        Self { id, form: forms[usize::from(second)], joints, size, second, shape }
    }

    /// The fault, `factor` times as large; lost regeneration has one size.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut fault = self.clone();
        if fault.id != "no_regeneration" {
            fault.size = fault.size.map(|size| size * factor);
        }
        fault
    }

    /// What is true of it.
    pub(super) fn truth(&self) -> Truth {
        let mut truth = Truth::new(self.id, self.form, &self.joints);
        let name = match self.id {
            "copper_loss" | "iron_loss" => "loss",
            "inverter_loss" => "per_current",
            "no_regeneration" => return truth,
            _ => "power",
        };
        let graded = !self.second && matches!(self.id, "copper_loss" | "base_load" | "brake_power");
        if self.joints.is_empty() {
            truth.tell(name, None, self.size[0], graded);
        }
        for i in &self.joints {
            truth.tell(name, Some(*i), self.size[*i], graded);
        }
        truth
    }

    /// Power \[W\] more of joint `i`.
    fn joint(&self, i: usize, torque: f64, rate: f64, heat: f64, world: &World) -> f64 {
        let size = self.size[i];
        match (self.id, self.second) {
            ("copper_loss", false) => size * torque * torque * (0.85 + 0.15 * heat),
            // Turns of the short see the speed's voltage too.
            ("copper_loss", true) => {
                size * torque * torque * (0.7 + 0.3 * (rate / self.shape).tanh().powi(2))
            }
            ("inverter_loss", second) => {
                let current =
                    world.everyday.joints.get(i).map_or(0.0, |habit| torque / habit.motor.constant);
                if second {
                    let conduction = current * current / (current.abs() + 5.0 * self.shape);
                    self.size[0] * (0.6 * current.abs() + 0.4 * conduction)
                } else {
                    self.size[0]
                        * ((current * current + self.shape * self.shape).sqrt() - self.shape)
                }
            }
            ("iron_loss", second) => {
                let usual = self.shape * world.nominal.speed[i];
                let ratio = rate.abs() / usual;
                let units = size * usual * usual;
                if second {
                    units * ratio * ratio / (1.0 + 0.4 * ratio)
                } else {
                    // G. Bertotti, IEEE T-Mag 24, 1988.
                    units * (0.25 * ratio + 0.55 * ratio * ratio + 0.2 * ratio.powf(1.5))
                }
            }
            _ => 0.0,
        }
    }

    /// Power \[W\] more of the cabinet; `released` is the time since the brakes opened.
    fn cabinet(&self, time: f64, released: Option<f64>) -> f64 {
        let size = self.size[0];
        match (self.id, self.second, released) {
            ("base_load", false, _) => size * (1.0 + 0.08 * (time / self.shape).sin()),
            // On in six of ten parts of its period; its mean is the size.
            ("base_load", true, _) if (time / self.shape).fract() < 0.6 => size / 0.6,
            ("brake_power", false, Some(open)) => size * if open < self.shape { 2.0 } else { 1.0 },
            ("brake_power", true, Some(open)) => {
                size * (0.85 + 0.3 * (-open / (60.0 * self.shape)).exp())
            }
            _ => 0.0,
        }
    }
}

/// Powers \[W\] of a log on its grid, with the meter's lag, without noise.
pub(super) fn powers(
    world: &World,
    supply: &Supply,
    day: &Day,
    points: &[Point],
    torques: &[Row],
    fault: Option<&PowerFault>,
) -> Vec<f64> {
    let arm = &world.nominal;
    let lost = fault.is_some_and(|fault| fault.id == "no_regeneration");
    let capacitor = fault.map_or(0.0, |fault| if fault.second { fault.shape } else { 0.0 });
    let (mut stands, mut opened, mut stored) = (0.0, Some(0.0), 0.0);
    let mut heat = 1.0;
    let mut metered = f64::NAN;
    let gain = 1.0 - (-STEP / supply.lag).exp();
    let mut out = Vec::with_capacity(points.len());
    for (k, (at, torques)) in points.iter().zip(torques).enumerate() {
        let time = k as f64 * STEP;
        let moves = at.v.iter().any(|rate| rate.abs() > STANDS);
        stands = if moves { 0.0 } else { stands + STEP };
        opened = if stands > BRAKE_AFTER {
            None
        } else {
            Some(opened.map_or(0.0, |open: f64| open + STEP))
        };
        let fans = 1.0 + supply.fans[0] * (time / supply.fans[1] * std::f64::consts::TAU).sin();
        // Day to day: the friction's common part moves the base by less than its hundredth.
        let mut total = arm.base * supply.base * fans * (1.0 + 0.2 * (day.warmth[0] - 1.0) * 0.1);
        let mut load = 0.0;
        for i in 0..arm.axes() {
            let (torque, rate) = (torques[i], at.v[i]);
            let mechanical = torque * rate;
            let copper =
                arm.loss[i] * supply.loss[i] * torque * torque * (1.0 + COPPER_HEAT * (heat - 1.0));
            load += (torque / arm.usual[i]).powi(2) / arm.axes() as f64;
            // The change between drive and brake is soft: a width of 0.1 % of the axis's power.
            let width = 0.001 * arm.usual[i] * arm.speed[i];
            let share = step(mechanical / width);
            let back = if lost { 0.0 } else { supply.regeneration };
            let bent = 1.0 + supply.bend * (rate.abs() / arm.speed[i] - 0.3);
            total += mechanical * (share + (1.0 - share) * back) * bent + copper;
            if lost && capacitor > 0.0 && mechanical < 0.0 {
                stored = f64::min(stored - mechanical * supply.regeneration * STEP, capacitor);
            }
            total += fault.map_or(0.0, |fault| fault.joint(i, torque, rate, heat, world));
        }
        heat += (load - heat) * STEP / 300.0;
        if stored > 0.0 && total > 0.0 {
            // The capacitor gives its energy back to the axes within some 50 ms.
            let given = (stored / 0.05).min(total - arm.base).max(0.0);
            stored -= given * STEP;
            total -= given;
        }
        total += fault.map_or(0.0, |fault| fault.cabinet(time, opened));
        metered = if metered.is_nan() { total } else { metered + (total - metered) * gain };
        out.push(metered);
    }
    out
}

impl Supply {
    /// Powers as the meter shows them.
    pub(super) fn shown(&self, powers: &[f64], rng: &mut Rng) -> Vec<f64> {
        powers.iter().map(|power| power + self.noise * rng.normal()).collect()
    }

    /// Standard deviation of a row \[W\]: noise, and an everyday error of 1 % of what varies.
    pub(super) fn sd(&self, powers: &[f64], cycles: usize) -> f64 {
        let count = powers.len().max(1) as f64;
        let mean = powers.iter().sum::<f64>() / count;
        let variance = powers.iter().map(|power| (power - mean).powi(2)).sum::<f64>() / count;
        (self.noise.powi(2) / cycles as f64 + 1e-4 * (variance + mean * mean)).sqrt()
    }
}

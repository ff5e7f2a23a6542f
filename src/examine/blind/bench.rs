//! A healthy robot with sensors, and the faults of a case.

use super::disturbance;
use super::fault::Disturbance;
use super::fourier::fourier;
use super::label::Kind;
use super::mechanics::{Joints, of_slice};
use super::model_error::ModelError;
use super::motion::Motion;
use super::noise::Noise;
use super::pick_place::pick_place;
use super::plant::Plant;
use super::random::Random;
use super::robots;
use super::scale::Scale;
use super::simulate::{Robot, Supply};
use super::sizes::{Sizes, rms_power, sizes};
use super::trust::Trust;
use super::workspace::Workspace;
use crate::arm::robot::{MAX_DOF, Model};

/// Pause between two logs \[s\].
const PAUSE_S: [f64; 2] = [5.0, 60.0];
/// Relative change of friction from period to period.
const VARIATION: [f64; 2] = [0.001, 0.006];
/// Share of the cases with program runs.
const PROGRAMS: f64 = 0.12;
/// Largest number of draws for two different effects.
const DRAWS: usize = 32;

/// Settings of the generation: seed and lengths of the logs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Seed; the output depends on the settings only.
    pub seed: u64,
    /// Number of periods in each log.
    pub cycles: usize,
    /// Duration of a period \[s\].
    pub period_s: f64,
}

impl Settings {
    /// Seven periods of 10 s.
    #[must_use]
    pub fn new(seed: u64) -> Settings {
        Settings { seed, cycles: 7, period_s: 10.0 }
    }
}

/// A healthy robot with sensors.
pub(super) struct Bench<'a> {
    pub(super) settings: &'a Settings,
    pub(super) number: usize,
    pub(super) model: Model,
    pub(super) nominal: Plant,
    pub(super) workspace: Workspace,
    pub(super) trust: Trust,
    /// Drawn before the faults, so that the files do not depend on them.
    pub(super) with_program: bool,
    pub(super) with_baseline: bool,
    #[cfg(feature = "internals")]
    pub(super) heldout_works: bool,
    pub(super) variation: f64,
    /// Two motions for training, one held out, one baseline.
    pub(super) motions: [Motion; 4],
    sizes: Sizes,
    ratio: Joints,
    /// Rms power \[W\].
    power: f64,
    pub(super) plant: Plant,
    supply: Supply,
    pub(super) error: ModelError,
    pub(super) noise: Noise,
}

impl<'a> Bench<'a> {
    pub(super) fn drawn(settings: &'a Settings, number: usize) -> Option<Bench<'a>> {
        let stream = |purpose: &str| Random::new(settings.seed, number as u64, purpose);
        let model = nominal(&mut stream("robot"))?;
        let nominal = Plant::new(&model);
        let workspace = Workspace::new(&model);

        let mut draws = stream("setting");
        let with_program = draws.chance(PROGRAMS);
        let with_baseline = with_program || draws.chance(0.5);
        let trust =
            if with_baseline || draws.chance(0.4) { Trust::COMMISSIONED } else { Trust::CAD };
        let variation = draws.log_between(VARIATION[0], VARIATION[1]);
        let heldout_works = draws.chance(0.5);

        let mut draws = stream("motions");
        let exciting = |draws: &mut Random| fourier(&workspace, settings.period_s, draws);
        let motions = [
            exciting(&mut draws),
            exciting(&mut draws),
            if heldout_works {
                pick_place(&workspace, settings.period_s, &mut draws)
            } else {
                exciting(&mut draws)
            },
            exciting(&mut draws),
        ];
        let sizes = sizes(&nominal, &motions[..2]);
        let (of_model, ratio) = supply(&model);
        let power = rms_power(&nominal, &of_model, &motions[..2]);
        let noise = Noise::drawn(&sizes.rms, &sizes.peak, power, &mut stream("noise levels"));
        let error = ModelError::drawn(
            nominal.dof,
            &sizes.rms,
            &sizes.fastest,
            &noise.torque,
            &ratio,
            &mut stream("model error"),
        );
        let mut draws = stream("spread");
        let plant = trust.real(&nominal, &mut draws);
        let mut supply = of_model;
        supply.base *= 1.0 + 0.02 * draws.normal_within(2.0);
        for loss in &mut supply.loss {
            *loss *= 1.0 + 0.5 * trust.friction * draws.normal_within(2.0);
        }
        Some(Bench {
            settings,
            number,
            model,
            nominal,
            workspace,
            trust,
            with_program,
            with_baseline,
            #[cfg(feature = "internals")]
            heldout_works,
            variation,
            motions,
            sizes,
            ratio,
            power,
            plant,
            supply,
            error,
            noise,
        })
    }

    pub(super) fn stream(&self, purpose: &str) -> Random {
        Random::new(self.settings.seed, self.number as u64, purpose)
    }

    /// The faults of a robot with logged torques or power.
    pub(super) fn wrong(&self) -> (Kind, Vec<Disturbance>) {
        let scale = Scale {
            nominal: &self.nominal,
            plant: &self.plant,
            workspace: &self.workspace,
            trust: self.trust,
            period_s: self.settings.period_s,
            ratio: self.ratio,
            rms: self.sizes.rms,
            peak: self.sizes.peak,
            fastest: self.sizes.fastest,
            load: self.sizes.load,
            power: self.power,
        };
        wrong(&scale, self.with_baseline, &mut self.stream("truth"))
    }

    /// Start times of three logs \[s\]: two for training, one held out.
    pub(super) fn clocks(&self) -> [f64; 3] {
        let lasts = self.settings.cycles as f64 * self.settings.period_s;
        clocks(lasts, &mut self.stream("clock"))
    }

    pub(super) fn robot<'b>(&'b self, disturbances: Vec<&'b Disturbance>) -> Robot<'b> {
        let Bench { plant, error, supply, .. } = self;
        Robot { plant, error, supply, disturbances }
    }
}

/// Start times of three logs of the duration `lasts` \[s\].
pub(super) fn clocks(lasts: f64, random: &mut Random) -> [f64; 3] {
    let mut clocks = [0.0; 3];
    for i in 1..clocks.len() {
        clocks[i] = clocks[i - 1] + lasts + random.between(PAUSE_S[0], PAUSE_S[1]).round();
    }
    clocks
}

/// A robot model; half of the drives regenerate.
fn nominal(random: &mut Random) -> Option<Model> {
    let mut model = robots::robot(random)?;
    if random.chance(0.5) {
        model.drive.regeneration = (random.between(0.5, 0.9) * 100.0).round() / 100.0;
    }
    Some(model)
}

/// Draws the kind of the case and its faults.
fn wrong(scale: &Scale<'_>, with_baseline: bool, random: &mut Random) -> (Kind, Vec<Disturbance>) {
    match random.unit() {
        x if x < 0.20 => (Kind::Healthy, Vec::new()),
        x if x < 0.28 => (Kind::ParametersOnly, vec![disturbance::link_parameters(scale, random)]),
        x if x < 0.66 => (Kind::One, vec![disturbance::torque_effect(scale, random)]),
        x if x < 0.78 => {
            let first = disturbance::torque_effect(scale, random);
            let mut second = disturbance::torque_effect(scale, random);
            for _ in 0..DRAWS {
                let (known, new) = (&first.truth, &second.truth);
                if new.id != known.id && !known.equivalents.contains(&new.id) {
                    break;
                }
                second = disturbance::torque_effect(scale, random);
            }
            (Kind::Two, vec![first, second])
        }
        x if x < 0.92 || !with_baseline => {
            (Kind::Outside, vec![disturbance::outside(scale, random)])
        }
        _ => (Kind::Power, vec![disturbance::power_effect(scale, random)]),
    }
}

/// The electrical parameters of a model, and the gear ratios.
fn supply(model: &Model) -> (Supply, Joints) {
    let (loss, ratio) = match &model.motors {
        Some(motors) => (of_slice(&motors.loss_constant), of_slice(&motors.ratio)),
        None => ([0.0; MAX_DOF], [1.0; MAX_DOF]),
    };
    let drive = &model.drive;
    (Supply { base: drive.base_w, loss, regeneration: drive.regeneration }, ratio)
}

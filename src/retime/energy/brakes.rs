//! Energy that closed brakes save at standstill.
//!
//! At rest with released brakes a robot takes base power, holding power and the power of the brake
//! coils; with closed brakes only base power. Break-even time: Paes et al. 2014, figure 7, plus the
//! coils: energy of one release over saved power, plus the engage and release times.

use crate::arm::robot::Model;

/// Break-even time of the brakes at a holding power of `holding_w`, s: the shortest dwell in which
/// closing them saves energy. `None` if nothing is saved or no brake is known.
pub fn break_even_s(model: &Model, holding_w: f64) -> Option<f64> {
    let brakes = model.brakes.as_ref()?;
    let spared_w = holding_w + brakes.power_released_w;
    let delay = brakes.engage_s + brakes.release_s;
    (spared_w > 0.0).then(|| brakes.energy_per_release_j / spared_w + delay)
}

/// Energy that closed brakes save in a dwell of `duration` (s) at a holding power of `holding_w`,
/// J; 0 up to the break-even time or without a known brake.
pub fn spared_j(model: &Model, holding_w: f64, duration: f64) -> f64 {
    let Some(brakes) = &model.brakes else { return 0.0 };
    let spared_w = holding_w + brakes.power_released_w;
    let closed_s = duration - brakes.engage_s - brakes.release_s;
    (spared_w * closed_s - brakes.energy_per_release_j).max(0.0)
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::{break_even_s, spared_j};
    use crate::arm::dynamics::Load;
    use crate::arm::effects;
    use crate::retime::energy::account::at_rest;
    use crate::retime::energy::power::holding_w;

    /// Compares with the energy at rest without the parts that closed brakes save.
    #[test]
    fn closed_brakes_leave_the_base_power() {
        let model = effects::load("IRB1600-10/1.45").unwrap();
        let brakes = model.brakes.as_ref().unwrap();
        let (load, q) = (Load::none(), [0.0, 0.6, -0.3, 0.0, 0.9, 0.0]);
        let duration = 12.0;
        let open = at_rest(&model, &load, &q, duration).energy_j();
        let delay = brakes.engage_s + brakes.release_s;
        let closed = at_rest(&model, &load, &q, delay).energy_j()
            + model.drive.base_w * (duration - delay)
            + brakes.energy_per_release_j;
        let holding = holding_w(&model, &load, &q).iter().sum();
        let spared = spared_j(&model, holding, duration);
        assert!((spared - (open - closed)).abs() < 1e-9, "{spared} J, {} J", open - closed);
        assert!(spared > brakes.power_released_w * (duration - 1.0));
    }

    #[test]
    fn nothing_is_spared_up_to_the_break_even() {
        let model = effects::load("IRB1600-10/1.45").unwrap();
        // The coils take power also without holding power.
        for holding in [0.0, 20.0] {
            let pays_from = break_even_s(&model, holding).unwrap();
            assert_eq!(spared_j(&model, holding, 0.99 * pays_from), 0.0);
            assert!(spared_j(&model, holding, 1.01 * pays_from) > 0.0);
        }
        let mut without = model.clone();
        without.brakes = None;
        assert_eq!((break_even_s(&without, 20.0), spared_j(&without, 20.0, 60.0)), (None, 0.0));
    }
}

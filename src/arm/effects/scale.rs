//! Typical magnitudes at a joint in a motion for the priors of effects.

use super::motion::Motion;

/// Default friction of a joint as a share of its torque.
const FRICTION: f64 = 0.05;
/// Typical flange load as a share of the mass of all links.
const PAYLOAD: f64 = 0.03;

/// Typical magnitudes at a joint in a motion.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Coulomb friction, known or typical \[Nm\].
    pub coulomb: f64,
    /// Viscous friction, known or typical \[Nm s/rad\].
    pub viscous: f64,
    /// Reflected rotor inertia \[kg m²\].
    pub rotor: f64,
    /// Mean inertia that the joint moves \[kg m²\].
    pub inertia: f64,
    /// RMS and peak torque \[Nm\].
    pub torque: [f64; 2],
    /// Largest speed \[rad/s\].
    pub rate: f64,
    /// Gear ratio; 1 if unknown.
    pub ratio: f64,
    /// Interval of the rows \[s\].
    pub step: f64,
    /// Typical flange load \[kg\].
    pub payload: f64,
    /// Mass of the link \[kg\] and its mean moment of inertia about the joint origin \[kg m²\].
    pub link: (f64, f64),
}

impl Motion<'_> {
    /// Typical magnitudes at a joint.
    #[must_use]
    pub fn scale(&self, joint: usize) -> Scale {
        let model = self.model;
        let tau = &self.torque[joint];
        let rms = (tau.iter().map(|x| x * x).sum::<f64>() / tau.len().max(1) as f64).sqrt();
        let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let rate = largest(&self.rates[joint]);
        let or = |given: f64, else_: f64| if given > 0.0 { given } else { else_ };
        let coulomb = or(model.friction.coulomb[joint], FRICTION * rms);
        let motors = model.motors.as_ref();
        let mass: f64 = model.links.iter().map(|link| link.mass).sum();
        Scale {
            coulomb,
            viscous: or(model.friction.viscous[joint], coulomb / rate.max(1e-3)),
            rotor: motors.map_or(0.0, |motors| motors.reflected_inertia(joint)),
            inertia: self.mean_inertia(joint),
            torque: [rms, largest(tau)],
            rate,
            ratio: motors.map_or(1.0, |motors| motors.ratio[joint]),
            step: self.step(),
            payload: PAYLOAD * mass,
            link: model.links.get(joint).map_or((0.0, 0.0), |link| {
                let about = link.com.norm_squared() * link.mass * 2.0 / 3.0;
                (link.mass, link.inertia.trace() / 3.0 + about)
            }),
        }
    }
}

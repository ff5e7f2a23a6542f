//! Typical sizes at a joint in a motion, from which effects take their priors.

use super::motion::Motion;

/// Friction of a joint over its torque where the robot states none.
const FRICTION: f64 = 0.05;
/// Mass that a flange may carry over that of all links.
const PAYLOAD: f64 = 0.03;

/// Typical sizes at a joint in a motion.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Coulomb friction, or what it may be \[Nm\].
    pub coulomb: f64,
    /// Viscous friction, or what it may be \[Nm s/rad\].
    pub viscous: f64,
    /// Inertia that the motor sees: rotor \[kg m²\].
    pub rotor: f64,
    /// Root mean square and largest of the torque \[Nm\].
    pub torque: [f64; 2],
    /// Largest rate \[rad/s\].
    pub rate: f64,
    /// Gear ratio; 1 where it is not known.
    pub ratio: f64,
    /// Interval of the rows \[s\].
    pub step: f64,
    /// Mass that the flange may carry \[kg\].
    pub payload: f64,
    /// Mass of the joint's link \[kg\], and its mean moment about the joint's origin \[kg m²\].
    pub link: (f64, f64),
}

impl Motion<'_> {
    /// Typical sizes at a joint.
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

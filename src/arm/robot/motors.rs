//! Motors and gears.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Number of motor phases, each with the rms current.
const PHASES: f64 = 3.0;

/// Motor torque constants \[Nm per A rms\].
const TORQUE_CONSTANT: Accepts = Accepts::Between(
    f64::MIN_POSITIVE,
    50.0,
    "more than 0 and at most 50, in Nm per A rms at the motor (not mNm)",
);
/// Largest rotor inertia \[kg m²\].
const LARGEST_ROTOR: f64 = 0.5;
/// Largest rotor inertia at the joint \[kg m²\]; a motor without a gear, or with the ratio 1 for an
/// unknown one, may have it at the motor side.
const LARGEST_AT_JOINT: f64 = 1000.0;

/// One motor with its gear per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Motors {
    /// Gear ratio: motor turns per turn of the joint.
    pub ratio: Vec<f64>,
    /// Torque constant, motor side \[Nm per A rms\].
    pub torque_constant: Option<Vec<f64>>,
    /// Rotor inertia, motor side \[kg m²\].
    pub rotor_inertia: Vec<f64>,
    /// Copper loss per squared torque at the joint \[W/(Nm)²\].
    pub loss_constant: Vec<f64>,
    /// Largest current \[A rms\].
    pub peak_current: Option<Vec<f64>>,
    /// Largest continuous current \[A rms\].
    pub rated_current: Option<Vec<f64>>,
}

impl Motors {
    /// Whether some rotor has an inertia.
    #[must_use]
    pub fn has_rotors(&self) -> bool {
        self.rotor_inertia.iter().any(|inertia| *inertia > 0.0)
    }

    /// Rotor inertia of `joint` (from 0) reflected to the joint \[kg m²\].
    #[must_use]
    pub fn reflected_inertia(&self, joint: usize) -> f64 {
        self.ratio[joint] * self.ratio[joint] * self.rotor_inertia[joint]
    }

    pub(super) fn read(fields: &mut Fields, dof: usize) -> Result<Motors, RobotError> {
        let ratio = fields.must("ratio", |f, key| f.per_joint(key, dof, Accepts::Positive))?;
        let torque_constant = fields.per_joint("torque_constant", dof, TORQUE_CONSTANT)?;
        let rotor_place = fields.place_of("rotor_inertia");
        let rotor_inertia = fields.per_joint("rotor_inertia", dof, Accepts::NonNegative)?;
        let largest = |ratio: f64| LARGEST_ROTOR.max(LARGEST_AT_JOINT / (ratio * ratio));
        let mut rotors = rotor_inertia.iter().flatten().zip(&ratio);
        if let Some((value, ratio)) = rotors.find(|(value, ratio)| **value > largest(**ratio)) {
            return Err(RobotError::Value {
                place: rotor_place,
                key: "motors.rotor_inertia".into(),
                value: value.to_string(),
                must: format!(
                    "0 or more and at most {}, in kg m2 at the motor (not at the joint, not in kg cm2)",
                    largest(*ratio)
                ),
            });
        }
        let place = fields.place_of("resistance");
        let loss = fields.per_joint("loss_constant", dof, Accepts::NonNegative)?;
        let resistance = fields.per_joint("resistance", dof, Accepts::NonNegative)?;
        let loss_constant = match (loss, resistance) {
            (Some(_), Some(_)) => {
                return Err(RobotError::Value {
                    place,
                    key: "motors.resistance".into(),
                    value: "[…]".into(),
                    must: "absent where loss_constant is given: remove one of the two".into(),
                });
            }
            (Some(loss), None) => loss,
            (None, Some(resistance)) => {
                let constant = fields.required("torque_constant", torque_constant.as_ref())?.iter();
                let per_ampere = constant.zip(&ratio).map(|(k, n)| k * n);
                resistance.iter().zip(per_ampere).map(|(r, k)| PHASES * r / (k * k)).collect()
            }
            (None, None) => vec![0.0; dof],
        };
        Ok(Motors {
            rotor_inertia: rotor_inertia.unwrap_or_else(|| vec![0.0; dof]),
            torque_constant,
            loss_constant,
            peak_current: fields.per_joint("peak_current", dof, Accepts::Positive)?,
            rated_current: fields.per_joint("rated_current", dof, Accepts::Positive)?,
            ratio,
        })
    }
}

//! The draws of a calibrated robot: `[calibration]`.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Largest number of robots of a calibration.
const MAX_ROBOTS: f64 = 4096.0;
/// Largest absolute value of a latent variable, which is standard normal.
const MAX_LATENT: f64 = 20.0;

/// Draws of the robot that fit the measured data.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Number of draws.
    pub robots: usize,
    /// Name of each latent variable and its value in each draw, in standard deviations of the
    /// estimate relative to the model.
    pub draws: Vec<(String, Vec<f64>)>,
    /// Position of the table.
    pub place: String,
}

impl Calibration {
    pub(super) fn read(mut fields: Fields) -> Result<Calibration, RobotError> {
        let place = fields.place();
        let count = Accepts::Between(2.0, MAX_ROBOTS, "a whole number from 2 to 4096");
        let robots = fields.must("robots", |f, key| f.number(key, count))? as usize;
        let mut draws = Vec::new();
        if let Some(mut table) = fields.table("draws")? {
            let far = Accepts::Between(-MAX_LATENT, MAX_LATENT, "at least -20 and at most 20");
            let expected = format!("{robots}, one for each robot");
            for name in table.keys() {
                if let Some(list) = table.numbers(&name, robots, &expected, far)? {
                    draws.push((name, list));
                }
            }
            table.finish()?;
        }
        fields.finish()?;
        Ok(Calibration { robots, draws, place })
    }
}

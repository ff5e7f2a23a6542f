//! Modules for points of the user.

use serde::Serialize;
use tera::{Context, Tera};

use super::site::EmitError;
use crate::rapid::ir::number::{TIME_DECIMALS, joints, number};

/// Maximum length of a RAPID name.
const LONGEST_NAME: usize = 32;
/// Characters reserved for a suffix.
const SUFFIX: usize = 4;

/// The names of a generated program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct GeneratedNames {
    /// Module name, also the file name.
    pub module: String,
    /// The procedure with the movements.
    pub procedure: String,
    /// The module with the entry routine.
    pub main: String,
}

impl GeneratedNames {
    /// Names derived from a file name.
    pub fn from_file_name(file: &str) -> GeneratedNames {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let mut name: String = file.chars().map(plain).collect();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            name.insert_str(0, "p_");
        }
        name.truncate(LONGEST_NAME - SUFFIX);
        GeneratedNames {
            procedure: format!("{name}Run"),
            main: format!("{name}Main"),
            module: format!("{name}Mod"),
        }
    }
}

/// A movement to a joint target.
#[derive(Clone, Debug, Serialize)]
pub struct GeneratedMove {
    /// `MoveAbsJ`, `MoveJ` or `MoveL`.
    pub instruction: &'static str,
    /// A joint target or robtarget as an aggregate.
    pub target: String,
    /// Speed with its optional arguments.
    pub speed: String,
    /// Zone with its optional arguments.
    pub zone: String,
}

/// A joint target as RAPID aggregate, from rad.
pub fn jointtarget(q: &[f64; 6]) -> String {
    format!("[[{}],[9E9,9E9,9E9,9E9,9E9,9E9]]", joints(q))
}

/// The time argument of a stream point, s.
pub fn stream_time(seconds: f64) -> String {
    format!("v1000\\T:={}", number(seconds, TIME_DECIMALS))
}

/// The module with the movements.
///
/// # Errors
/// The template failed.
pub fn generated_module(
    names: &GeneratedNames,
    about: &str,
    moves: &[GeneratedMove],
) -> Result<String, EmitError> {
    let mut context = context(names, about);
    context.insert("moves", moves);
    Ok(Tera::one_off(include_str!("../../../templates/generated.mod.tera"), &context, false)?)
}

/// The module with the entry routine, which calls the procedure.
///
/// # Errors
/// The template failed.
pub fn main_module(names: &GeneratedNames) -> Result<String, EmitError> {
    let context = context(names, "");
    Ok(Tera::one_off(include_str!("../../../templates/main.mod.tera"), &context, false)?)
}

/// The module that runs externally guided motion (EGM). Tool and work object are RAPID names; the
/// joints start at the first of the positions (rad, one per EGM period).
///
/// # Errors
/// The template failed.
pub fn egm_module(
    names: &GeneratedNames,
    positions: &[[f64; 6]],
    tool: &str,
    work_object: &str,
) -> Result<String, EmitError> {
    let start = positions.first().copied().unwrap_or_default();
    let duration_s = EGM_STEP_S * positions.len().saturating_sub(1) as f64;
    let mut context = context(names, "");
    context.insert("start", &jointtarget(&start));
    context.insert("duration", &number(duration_s, 3));
    context.insert("tool", tool);
    context.insert("work_object", work_object);
    context.insert("fastest", &number(speed_deviation(positions), 0));
    context.insert("joints", &[1, 2, 3, 4, 5, 6]);
    Ok(Tera::one_off(include_str!("../../../templates/egm.mod.tera"), &context, false)?)
}

/// Period of externally guided motion, s.
pub const EGM_STEP_S: f64 = 0.004;

/// Ratio by which a joint may exceed its sent speed to catch up with the sent positions.
const EGM_SPEED_MARGIN: f64 = 1.25;

/// The maximum EGM speed of a joint, degrees/s; the controller's default is 1.
fn speed_deviation(positions: &[[f64; 6]]) -> f64 {
    let steps =
        positions.windows(2).flat_map(|pair| (0..6).map(|j| (pair[1][j] - pair[0][j]).abs()));
    let fastest = steps.fold(0.0, f64::max) / EGM_STEP_S;
    (EGM_SPEED_MARGIN * fastest.to_degrees()).ceil().max(1.0)
}

/// The CSV file of the positions to send (rad, one per EGM period).
pub fn egm_rows(positions: &[[f64; 6]]) -> String {
    let header = "t,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n".to_owned();
    let row = |(i, q): (usize, &[f64; 6])| {
        format!("{},{}\n", number(EGM_STEP_S * i as f64, 3), joints(q))
    };
    std::iter::once(header).chain(positions.iter().enumerate().map(row)).collect()
}

fn context(names: &GeneratedNames, about: &str) -> Context {
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("names", names);
    context.insert("about", about);
    context
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_rapids_whatever_the_file_is_called() {
        for file in ["points", "2 Teile (größer)", "", "a_very_long_name_of_a_file_with_points"] {
            let names = GeneratedNames::from_file_name(file);
            for name in [&names.module, &names.procedure, &names.main] {
                assert!(name.len() <= LONGEST_NAME, "{name}");
                assert!(name.starts_with(|c: char| c.is_ascii_alphabetic()), "{name}");
                assert!(name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'), "{name}");
            }
        }
    }
}

//! The complete identification: free parameters, fit, physically consistent model.

use nalgebra::DVector;

use crate::arm::dynamics::{JOINT, RIGID, base_parameters_among, link_parameters};
use crate::arm::robot::Model;

use super::consistent::{BODY, margin};
use super::equations::{Equations, Known};
use super::error::IdentifyError;
use super::factors::Factors;
use super::fit::{Fit, fit, held_out_rms, reweighted};
use super::identified::Identified;
use super::misses::Misses;
use super::nearest::Nearest;
use super::quality::{explained, quality, surely_negative};
use super::samples::Samples;
use super::settings::{Free, Settings};
use super::updated::{Estimates, informed_links, updated};
use super::wrist::wrist_coupling;

/// Identifies a model from `training`; `validation` is used for prediction only.
///
/// # Errors
/// The log has another number of joints, there are too few equations, or the model lacks fixed
/// parameters.
pub fn identify(
    model: &Model,
    training: &Samples,
    validation: &[Samples],
    settings: &Settings,
) -> Result<Identified, IdentifyError> {
    check_inputs(model, training, validation, settings)?;
    let (among, known) = free_parameters(settings.free, model.dof);
    let mut nominal = model.clone();
    let among_base = |model: &Model| base_parameters_among(model, &among);
    let mut coupling = None;
    if settings.free == Free::All && nominal.wrist.coupling == 0.0 {
        coupling = wrist_coupling(&nominal, &among_base(&nominal), training);
        nominal.wrist.coupling = coupling.unwrap_or(0.0);
    }
    let base = among_base(&nominal);
    let equations = Equations { model: &nominal, base: &base, known };
    let fit = fit(&equations, training, settings.weighting)?;
    let nearest = Nearest::new(&nominal, settings.free, &fit, &base, &among);
    let parameters = nearest.parameters(&fit.factors).ok_or(IdentifyError::Inconsistent)?;
    let parameters: Vec<f64> = parameters.iter().copied().collect();
    let of_part = |part: &Factors| match nearest.parameters(part) {
        Some(found) => nearest.base_values(found.as_slice()),
        None => reweighted(part, settings.weighting, base.rank()).0.beta,
    };
    let cross_rms = held_out_rms(fit.folds.as_deref(), &fit.factors, &of_part);

    let beta = nearest.base_values(&parameters);
    let held_out: Vec<Factors> =
        validation.iter().map(|samples| Factors::new(&equations, samples, 1)).collect();
    let on_held_out =
        |beta: &DVector<f64>| (!held_out.is_empty()).then(|| Misses::new(beta, &held_out));
    let training_misses = Misses::new(&beta, std::slice::from_ref(&fit.factors));
    let validation_misses = on_held_out(&beta);

    let fitted = explained(std::slice::from_ref(training), &training_misses);
    let predicted = match &validation_misses {
        Some(misses) => Some(explained(validation, misses)),
        // A single repetition is mostly noise.
        None if fit.over_repetitions => None,
        None => {
            let misses = training_misses.with_rms(&cross_rms);
            Some(explained(std::slice::from_ref(training), &misses))
        }
    };
    let quality = quality(
        &equations,
        training,
        [&training_misses.rms, &fit.rms],
        (fitted, predicted),
        joints_giving_power(&equations, &fit),
        &fit.whiteness,
    );
    let estimates = Estimates {
        values: &parameters,
        coupling,
        informed: &informed_links(&base, &fit.solution),
        resting: &training.resting,
    };
    let (mut identified, payload) = updated(&nominal, settings, &estimates);
    // The identified parameters contain the effects.
    identified.effects.clear();
    let physically_consistent =
        identified.links.iter().all(|link| margin(&link_parameters(link)) > BODY);
    Ok(Identified {
        model: identified,
        parameters,
        coupling,
        training: training_misses,
        validation: validation_misses,
        unconstrained_validation: on_held_out(&fit.solution.beta),
        cross_rms,
        physically_consistent,
        payload,
        resting: training.resting.clone(),
        source: training.source.clone(),
        quality,
        among,
        base,
        fit,
    })
}

/// Refuses logs of another robot, and a model without the parameters that stay.
fn check_inputs(
    model: &Model,
    training: &Samples,
    validation: &[Samples],
    settings: &Settings,
) -> Result<(), IdentifyError> {
    let logged = |samples: &Samples| samples.rest.len();
    let mut others = std::iter::once(training).chain(validation).map(logged);
    if let Some(logged) = others.find(|logged| *logged != model.dof) {
        return Err(IdentifyError::OtherRobot { logged, dof: model.dof });
    }
    if settings.free != Free::All && !model.has_dynamics() {
        return Err(IdentifyError::NoDynamics(model.name.clone()));
    }
    Ok(())
}

/// Indices of the free parameters among all standard parameters, and the known part of the model.
fn free_parameters(free: Free, dof: usize) -> (Vec<usize>, Known) {
    let rigid = RIGID * dof;
    let all = rigid + JOINT * dof;
    match free {
        Free::All => ((0..all).collect(), Known::Nothing),
        Free::Friction => {
            let is_rotor = |index: &usize| (index - rigid).is_multiple_of(JOINT);
            ((rigid..all).filter(|index| !is_rotor(index)).collect(), Known::Rigid)
        }
        Free::Payload => ((rigid - RIGID..rigid).collect(), Known::All),
    }
}

/// Joints, from 0, with significantly negative Coulomb friction in the unconstrained fit.
fn joints_giving_power(equations: &Equations<'_>, fit: &Fit) -> Vec<usize> {
    let gives = |joint: &usize| {
        let name = format!("fc{}", joint + 1);
        let all = fit.solution.determined.iter().enumerate();
        all.filter(|(_, row)| equations.base.name(**row) == name)
            .any(|(k, row)| surely_negative(fit.solution.beta[*row], fit.covariance[(k, k)].sqrt()))
    };
    (0..equations.model.dof).filter(gives).collect()
}

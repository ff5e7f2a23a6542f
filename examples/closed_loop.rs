//! The complete loop: a nominal model, logs of a robot with an additional effect, the diagnosis,
//! the improved model, and its predictions of torques and power for unused motions: `cargo run
//! --release --example closed_loop -- [SEED [CASES]]`.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/examined.rs"]
mod examined;

use examined::{examined, noiseless, records};
use joulepath::arm::dynamics::{Data, Load};
use joulepath::arm::effects::ALL;
use joulepath::arm::robot::Model;
use joulepath::examine::blind::{self, Kind, Settings, Unlogged};
use joulepath::gap::{self, diagnose, predicted};
use joulepath::retime::energy::power::{power_at, supply_w};

/// Seed of the development cases, and their number.
const SEED: u64 = 101;
const CASES: usize = 24;
/// Number of unused motions.
const MOTIONS: usize = 4;

/// Residuals of a model: relative torque, power \[W\], relative energy.
struct Residuals {
    torque: f64,
    power: f64,
    energy: f64,
}

fn main() {
    let mut given = std::env::args().skip(1).map(|x| x.parse::<u64>().unwrap());
    let settings = Settings::new(given.next().unwrap_or(SEED));
    let cases = given.next().map_or(CASES, |count| count as usize);
    println!("missed of motions that took no part: nominal → improved");
    println!(
        "case  true effect          named                 torque, %       power, W        energy, %"
    );
    for number in 1..=cases {
        let Some(motions) = blind::unlogged(&settings, number, MOTIONS) else { continue };
        let case = blind::case(&settings, number).unwrap();
        if case.label.kind != Kind::One {
            continue;
        }
        let input = examined(&case, &settings);
        let options = gap::Settings {
            trust: input.trust,
            effects: ALL.iter().collect(),
            tunables: gap::Tunables::DEFAULT,
        };
        let heldout = records(&input.nominal, &input.heldout);
        let found =
            diagnose(&input.nominal, records(&input.nominal, &input.train), &heldout, &options);
        let named: Vec<&str> = found.effects.iter().map(|asserted| asserted.effect.id).collect();
        let [before, after] = [&input.nominal, &found.improved.applied]
            .map(|model| residuals(model, &input.nominal, &motions, &settings));
        println!(
            "{number:>4}  {:<20} {:<20} {:>6.2} → {:<6.2} {:>7.1} → {:<7.1} {:>6.2} → {:<6.2}",
            case.label.effects[0].id,
            named.join(" + "),
            100.0 * before.torque,
            100.0 * after.torque,
            before.power,
            after.power,
            100.0 * before.energy,
            100.0 * after.energy
        );
    }
}

/// Residuals of a model for the robot's true torques and power.
fn residuals(
    model: &Model,
    nominal: &Model,
    motions: &[Unlogged],
    settings: &Settings,
) -> Residuals {
    let logs = noiseless(motions, settings);
    let (mut torque, mut size) = (vec![0.0; model.dof], vec![0.0; model.dof]);
    for record in records(nominal, &logs) {
        let predictions = predicted(&record, model);
        for joint in 0..model.dof {
            for (measured, predicted) in record.measured[joint].iter().zip(&predictions[joint]) {
                torque[joint] += (measured - predicted).powi(2);
                size[joint] += measured * measured;
            }
        }
    }
    let relative = torque.iter().zip(&size).map(|(missed, size)| missed / size).sum::<f64>();
    let (mut squares, mut rows, mut energies) = (0.0, 0.0, [0.0; 2]);
    let mut data = Data::new();
    for of in motions {
        for (row, measured) in of.power.iter().enumerate() {
            let [q, qd, qdd]: [Vec<f64>; 3] =
                [&of.q, &of.qd, &of.qdd].map(|x| x.iter().map(|x| x[row]).collect());
            let state: [&[f64]; 3] = [&q, &qd, &qdd];
            let power = power_at(model, &mut data, &Load::none(), state);
            let predicted = supply_w(model, &mut data, &Load::none(), state, &power);
            squares += (measured - predicted).powi(2);
            rows += 1.0;
            energies[0] += measured;
            energies[1] += predicted;
        }
    }
    Residuals {
        torque: (relative / model.dof as f64).sqrt(),
        power: f64::sqrt(squares / rows),
        energy: (energies[1] / energies[0] - 1.0).abs(),
    }
}

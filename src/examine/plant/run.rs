//! A run: cycle after cycle, and then what recorder and meter wrote.

use super::conditions::Conditions;
use super::course::Course;
use super::layout::Plant;
use super::random::Random;
use super::script::Script;
use super::truth::Run;

impl Plant {
    /// A run on a usual day. Equal arguments give equal bytes; another script of the program meets the
    /// same times of machines, faults and parts, cycle by cycle.
    #[must_use]
    pub fn run(&self, script: &Script, cycles: usize, seed: u64) -> Run {
        self.run_in(script, &Conditions::usual(cycles, seed))
    }

    /// A run in given conditions.
    #[must_use]
    pub fn run_in(&self, script: &Script, conditions: &Conditions) -> Run {
        run(self, script, conditions)
    }
}

fn run(plant: &Plant, script: &Script, conditions: &Conditions) -> Run {
    let mut course = Course::new(plant, conditions);
    let mut cycles = Vec::new();
    for index in 0..conditions.cycles {
        let other = conditions.other.as_ref().filter(|(_, share)| {
            Random::of(conditions.seed, "other", &[index as u64]).chance(*share)
        });
        let script_now = other.map_or(script, |(other, _)| other);
        let weights: Vec<f64> = script_now.variants.iter().map(|of| of.frequency).collect();
        let chosen = Random::of(conditions.seed, "part", &[index as u64]).weighted(&weights);
        let Some(variant) = script_now.variants.get(chosen) else { break };
        let mut cycle = course.cycle(variant, index);
        cycle.by_other = other.is_some();
        cycles.push(cycle);
    }
    course.end();
    for cycle in &mut cycles {
        let end = cycle.start_s + cycle.duration_s;
        cycle.energy_j = course.ledger.until(end) - course.ledger.until(cycle.start_s);
        cycle.motion_j = course.ledger.motion(cycle.start_s, end);
    }
    let temperature = |cycle| plant.cell.temperature(cycle, conditions.ambient_c);
    let power = conditions.meter.log(&course.ledger, &cycles, temperature, conditions.seed);
    let events = course.recorder.log(&hash(script), conditions);
    Run { events, power, sessions: course.recorder.starts(), cycles }
}

/// Stands for the hash of the program: scripts that differ have different ones.
fn hash(script: &Script) -> String {
    let mut draws = Random::of(0, &format!("{script:?}"), &[]);
    (0..4).fold(String::new(), |text, _| text + &format!("{:04x}", draws.below(0x1_0000)))
}

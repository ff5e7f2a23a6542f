//! The course of a run: the robot goes through its cycles, the machines answer.

use std::collections::BTreeMap;

use super::cell::{Circumstances, Fault};
use super::conditions::Conditions;
use super::law::Moment;
use super::layout::Plant;
use super::ledger::{Doing, Ledger};
use super::random::Random;
use super::recorder::{Entry, Recorder};
use super::script::{Place, Step, Variant};
use super::signal::{Coming, Signal};
use super::truth::{CycleTruth, Disturbance, Event, Visit};

/// Time that the controller takes for a statement that does not move the robot \[s\].
const STATEMENT_S: f64 = 0.002;
/// From the signal to the end of its wait \[s\].
const NOTICED_S: (f64, f64) = (0.002, 0.012);

/// The cell in the course of a run. Times are those of the plant's clock \[s\].
pub(super) struct Course<'a> {
    plant: &'a Plant,
    conditions: &'a Conditions,
    now: f64,
    /// Since when the robot stands; `None` if it moves on without a stop.
    stands: Option<f64>,
    signals: BTreeMap<&'a str, Signal>,
    /// Last occurrences.
    events: BTreeMap<Event, f64>,
    pub(super) ledger: Ledger,
    pub(super) recorder: Recorder,
    /// Number of the cycle in the session.
    number: usize,
    /// Cycles since a restart.
    since_restart: Option<u64>,
}

/// What one cycle has beside the state of the cell.
struct Cycle {
    of: Circumstances,
    mood: (f64, f64),
    moves: usize,
    /// Occurrences of places and of awaited signals.
    places: BTreeMap<Place, u64>,
    awaited: BTreeMap<String, u64>,
    /// The last arrival, output or end of a wait: what machines that answer have seen.
    asked: Option<f64>,
    visits: Vec<Visit>,
}

/// The step at which a fault happens.
fn position(fault: &Fault, steps: &[Step]) -> Option<usize> {
    let waits = |(number, step)| matches!(step, &Step::Wait { .. }).then_some(number);
    let waits: Vec<usize> = steps.iter().enumerate().filter_map(waits).collect();
    let nth = |count: usize| (fault.at * count as f64) as usize;
    if fault.at_wait { waits.get(nth(waits.len())).copied() } else { Some(nth(steps.len())) }
}

impl<'a> Course<'a> {
    pub(super) fn new(plant: &'a Plant, conditions: &'a Conditions) -> Course<'a> {
        let signals = plant.machines.keys().map(|name| (name.as_str(), Signal::low())).collect();
        let mut course = Course {
            plant,
            conditions,
            now: 0.0,
            stands: Some(0.0),
            signals,
            events: BTreeMap::new(),
            ledger: Ledger::new(plant.power.base_w),
            recorder: Recorder::default(),
            number: 0,
            since_restart: None,
        };
        course.recorder.session(0.0);
        course
    }

    fn write(&mut self, cycle: &Cycle, place: Place, entry: Entry) {
        self.recorder.program(self.now, (self.number, cycle.moves), Some(place), entry);
    }

    /// Enters the energy of standing, which lasts until a time.
    fn stand_until(&mut self, t: f64) {
        if let Some(since) = self.stands.take()
            && t > since
        {
            let power = self.plant.power;
            let held = (t - since).min(power.brakes_after_s);
            self.ledger.add(since, since + held, power.hold_w * held, Doing::Holds);
        }
    }

    /// The end of the last cycle.
    pub(super) fn end(&mut self) {
        self.stand_until(self.now);
    }

    /// The robot goes on: what it waited for falls.
    fn go_on(&mut self) {
        for (name, signal) in &mut self.signals {
            let machine = self.plant.machines.get(*name);
            if let Some(fell) = machine.and_then(|machine| signal.go_on(self.now, machine)) {
                self.recorder.signal(fell, name, 0);
            }
        }
    }

    /// One cycle; its energies follow from the ledger at the end.
    pub(super) fn cycle(&mut self, variant: &Variant, index: usize) -> CycleTruth {
        let (plant, conditions, seed) = (self.plant, self.conditions, self.conditions.seed);
        let at = index as u64;
        let speed = plant.cell.speed(seed, at, self.since_restart);
        let temperature = plant.cell.temperature(at, conditions.ambient_c);
        let mut cycle = Cycle {
            of: Circumstances { seed, cycle: at, speed, temperature },
            mood: plant.cell.mood(conditions.machine_seed(), at),
            moves: 0,
            places: BTreeMap::new(),
            awaited: BTreeMap::new(),
            asked: None,
            visits: Vec::new(),
        };
        self.number += 1;
        self.since_restart = self.since_restart.map(|since| since + 1);
        let (start_s, session, number) = (self.now, self.recorder.starts().len() - 1, self.number);
        self.recorder.program(self.now, (number, 0), None, ("cycle", String::new(), ""));
        self.now += STATEMENT_S;
        let fault = plant.cell.fault(seed, at);
        let stop = fault.and_then(|fault| position(&fault, &variant.steps));
        let mut disturbance = if speed < 1.0 { Disturbance::Slow } else { Disturbance::None };
        for (number, step) in variant.steps.iter().enumerate() {
            if let Some(fault) = fault.filter(|_| stop == Some(number)) {
                disturbance = Disturbance::Stop;
                if fault.restarts {
                    self.restart(step, &mut cycle, fault.seconds);
                    disturbance = Disturbance::Restart;
                    break;
                }
                self.stands = self.stands.or(Some(self.now));
                self.now += fault.seconds;
            }
            self.step(step, &mut cycle);
        }
        CycleTruth {
            index,
            session,
            number,
            part: variant.part.clone(),
            by_other: false,
            disturbance,
            start_s,
            duration_s: self.now - start_s,
            energy_j: 0.0,
            motion_j: 0.0,
            visits: cycle.visits,
        }
    }

    /// A fault at a step ends the cycle. If the robot was waiting, the wait has no end.
    fn restart(&mut self, step: &Step, cycle: &mut Cycle, seconds: f64) {
        if let Step::Wait { signal, .. } = step {
            self.write(cycle, step.place(), ("wait", String::new(), signal));
        }
        self.stands = self.stands.or(Some(self.now));
        self.now += seconds;
        self.recorder.session(self.now);
        self.number = 0;
        self.since_restart = Some(0);
        // People clear the cell: nothing asks or holds any more.
        self.go_on();
    }

    fn step(&mut self, step: &Step, cycle: &mut Cycle) {
        let nth = cycle.places.entry(step.place()).or_default();
        let occurrence = *nth;
        *nth += 1;
        match step {
            Step::Move { duration_s, energy_j, stops, .. } => {
                cycle.asked = None;
                cycle.moves += 1;
                if self.stands.is_some() {
                    self.write(cycle, step.place(), ("start", String::new(), ""));
                    self.events.insert(Event::Departure { place: step.place() }, self.now);
                    self.go_on();
                }
                self.stand_until(self.now);
                let planned = (*duration_s, *energy_j);
                let (time, energy) =
                    self.plant.cell.movement(planned, &cycle.of, &step.place(), occurrence);
                self.ledger.add(self.now, self.now + time, energy, Doing::Moves);
                self.now += time;
                if *stops {
                    self.stands = Some(self.now);
                    cycle.asked = Some(self.now);
                    self.write(cycle, step.place(), ("arrive", String::new(), ""));
                }
            }
            Step::Pause { seconds, .. } => {
                self.stands = self.stands.or(Some(self.now));
                self.now += seconds;
            }
            Step::Output { signal, level, .. } => {
                self.write(cycle, step.place(), ("output", level.to_string(), signal));
                let (place, signal, level) = (step.place(), signal.clone(), *level);
                self.events.insert(Event::Output { place, signal, level }, self.now);
                self.go_on();
                cycle.asked = Some(self.now);
                self.now += STATEMENT_S;
            }
            Step::Load { mass_kg, .. } => {
                self.write(cycle, step.place(), ("load", format!("{mass_kg}"), ""));
                self.now += STATEMENT_S;
            }
            Step::Wait { signal, .. } => self.wait(step.place(), signal, cycle),
        }
    }

    fn wait(&mut self, place: Place, name: &str, cycle: &mut Cycle) {
        self.write(cycle, place.clone(), ("wait", String::new(), name));
        let nth = cycle.awaited.entry(name.to_owned()).or_default();
        let visit = [cycle.of.cycle, *nth];
        *nth += 1;
        let (Some(machine), Some(signal)) =
            (self.plant.machines.get(name), self.signals.get_mut(name))
        else {
            return;
        };
        let (seed, arrived_s) = (self.conditions.machine_seed(), self.now);
        let moment = Moment {
            signal: name,
            seed,
            visit,
            arrived: arrived_s,
            lead: cycle.asked.map_or(0.0, |asked| arrived_s - asked),
            anchor: None,
            fell: 0.0,
            temperature: cycle.of.temperature,
            factor: self.conditions.machine_factor(),
            mood: cycle.mood,
        };
        let last = machine.starter.as_ref().and_then(|event| self.events.get(event).copied());
        let Coming { came, changed, later_s } = signal.visit(machine, last, moment);
        let mut draws = Random::of(seed, &format!("then {name}"), &visit);
        signal.keep(draws.chance(machine.stays));
        let noticed_s = draws.between(NOTICED_S.0, NOTICED_S.1);
        let ends = came.map_or(arrived_s, |came| came.max(arrived_s));
        if ends > arrived_s {
            self.stands = self.stands.or(Some(arrived_s));
        }
        if let Some(came) = came.filter(|_| changed) {
            self.recorder.signal(came, name, 1);
        }
        self.now = ends + noticed_s;
        cycle.asked = Some(self.now);
        self.write(cycle, place.clone(), ("end", "0".into(), name));
        let (signal, came_s, ended_s) = (name.to_owned(), came, self.now);
        cycle.visits.push(Visit { place, signal, arrived_s, came_s, ended_s, later_s });
    }
}

//! Made-up lines: stations of drawn kinds in a row.

use std::collections::BTreeMap;

use super::recorder::{Chance, Recorder};

/// What ends the wait at a station.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Station {
    /// A machine that was started in the cycle before, when the robot left it.
    Machine,
    /// A line with a clock of its own.
    Clock,
    /// An operator, who begins when the robot has taken the last part.
    Operator,
    /// A test that was started two stations ago.
    Test,
    /// A sensor that answers an output.
    Sensor,
    /// A machine part that answers an output after some time, such as a clamp.
    Clamp,
    /// A door that opens when the robot comes; open already at times.
    Door,
    /// A press that waits in part.
    Press,
}

impl Station {
    pub(super) fn is_slack(self) -> bool {
        matches!(self, Station::Machine | Station::Clock | Station::Operator | Station::Test)
    }
}

/// How wide a line's numbers are drawn.
#[derive(Clone, Copy)]
pub(super) struct Wide {
    /// Spread of machines relative to their time, least and most.
    pub(super) spread: [f64; 2],
    /// Deviation of a movement, s, least and most.
    pub(super) jitter: [f64; 2],
    /// Cycles, least and most.
    pub(super) cycles: [f64; 2],
    /// Most that machines and movements drift over the shift, relative.
    pub(super) drift: f64,
    /// Stops of minutes per cycle.
    pub(super) stops: f64,
}

struct Drawn {
    station: Station,
    travel: f64,
    /// Time of the machine, s, and its deviation.
    time: f64,
    spread: f64,
    heavy: bool,
    already: f64,
}

/// A drawn line.
pub(super) struct Line {
    drawn: Vec<Drawn>,
    jitter: f64,
    scan: f64,
    hears: bool,
    stops: f64,
    drift: f64,
    pub(super) cycles: usize,
}

/// A wait at which the robot comes later in every second cycle: its line, and s.
pub(super) type Late = (u32, f64);

impl Line {
    pub(super) fn new(seed: u64, wide: Wide) -> Line {
        let mut chance = Chance::new(seed);
        let count = 5 + chance.whole(4);
        let mut drawn: Vec<Drawn> = (0..count).map(|k| draw(&mut chance, k, wide)).collect();
        let travel: f64 = drawn.iter().map(|of| of.travel).sum();
        let answers: f64 = drawn.iter().filter(|of| !of.station.is_slack()).map(|of| of.time).sum();
        // Machines end about when the robot comes: a share of the cycles finds them ready.
        let round = (travel + answers) * chance.between(1.05, 1.4);
        for k in 0..count {
            let late = chance.between(-0.03, 0.12) * round;
            let near = drawn[k].travel + drawn[(k + count - 1) % count].travel;
            drawn[k].time = match drawn[k].station {
                Station::Machine | Station::Operator | Station::Press => {
                    round - drawn[k].travel + late
                }
                Station::Test => near + late.abs(),
                Station::Clock => round + late,
                _ => drawn[k].time,
            };
            drawn[k].spread *= drawn[k].time;
        }
        Line {
            drawn,
            scan: [0.001, 0.004, 0.012][chance.whole(3)],
            hears: chance.is(0.5),
            jitter: chance.scale(wide.jitter[0], wide.jitter[1]),
            cycles: chance.scale(wide.cycles[0], wide.cycles[1]) as usize,
            drift: wide.drift,
            stops: wide.stops,
        }
    }

    /// What each line of the program waits for.
    pub(super) fn truths(&self) -> BTreeMap<u32, Station> {
        self.drawn.iter().enumerate().map(|(k, of)| (at(k), of.station)).collect()
    }

    /// A recording of so many cycles.
    pub(super) fn record(&self, seed: u64, cycles: usize, late: Option<Late>) -> Recorder {
        let mut chance = Chance::new(seed);
        let mut log = Recorder::new(self.scan);
        log.hears = self.hears;
        let restart = if chance.is(0.4) { cycles / 2 } else { cycles };
        let drifts = [(); 2].map(|()| chance.between(-1.0, 1.0) * self.drift);
        self.run(&mut chance, &mut log, &Run { cycles, drifts, restart, late });
        log
    }
}

/// Line of a station's wait.
fn at(station: usize) -> u32 {
    10 * station as u32 + 14
}

fn draw(chance: &mut Chance, place: usize, wide: Wide) -> Drawn {
    let station = match (place, chance.whole(10)) {
        (0, 0..=4) => Station::Operator,
        (0, _) => Station::Clock,
        (1, _) | (_, 5) => Station::Sensor,
        (_, 0..=2) => Station::Machine,
        (_, 3) => Station::Test,
        (_, 4) => Station::Operator,
        (_, 7) => Station::Door,
        (_, 8) => Station::Press,
        (_, _) => Station::Clamp,
    };
    let (time, spread) = match station {
        Station::Sensor => (chance.scale(0.15, 0.6), chance.scale(0.02, 0.1)),
        Station::Clamp => (chance.scale(0.8, 3.0), chance.scale(0.02, 0.08)),
        Station::Door => (chance.scale(1.5, 5.0), chance.scale(0.03, 0.1)),
        Station::Operator => (0.0, chance.scale(0.1, 0.3)),
        Station::Press => (0.0, chance.scale(0.005, 0.02)),
        _ => (0.0, chance.scale(wide.spread[0], wide.spread[1])),
    };
    let already =
        if station == Station::Door && chance.is(0.4) { chance.between(0.1, 0.5) } else { 0.0 };
    let travel = chance.between(2.0, 9.0);
    Drawn { station, travel, time, spread, heavy: chance.is(0.3), already }
}

struct Run {
    cycles: usize,
    drifts: [f64; 2],
    restart: usize,
    late: Option<Late>,
}

impl Line {
    fn run(&self, chance: &mut Chance, log: &mut Recorder, of: &Run) {
        let drawn = &self.drawn;
        let count = drawn.len();
        // When each station was left, and the next part of each clock.
        let mut left = vec![0.0; count];
        let mut next: Vec<f64> = drawn.iter().map(|of| of.time).collect();
        for i in 0..of.cycles {
            if i > 0 && i == of.restart {
                log.restart();
                left.fill(0.0);
                next = drawn.iter().map(|of| of.time).collect();
            }
            let shift = i as f64 / of.cycles as f64;
            log.cycle();
            let mut tested = log.t;
            for (k, station) in drawn.iter().enumerate() {
                let line = at(k);
                let speed = 1.0 + of.drifts[0] * shift;
                if let Some((_, late)) = of.late.filter(|(place, _)| *place == line && i % 2 == 1) {
                    log.t += late;
                }
                log.travel(
                    line - 4,
                    (station.travel * speed + chance.normal(self.jitter)).max(0.1),
                );
                if chance.is(self.stops) {
                    log.t += chance.scale(20.0, 400.0);
                }
                let noise = chance.normal(station.spread);
                let tail =
                    if station.heavy { noise.abs() * chance.normal(0.6).exp() } else { noise };
                let time = (station.time * (1.0 + of.drifts[1] * shift) + tail).max(0.05);
                let came = log.t;
                let due = match station.station {
                    Station::Machine | Station::Operator => left[k] + time,
                    Station::Test => tested + time,
                    Station::Clock => next[k] + noise,
                    Station::Press => {
                        left[k] + time + 0.5 * (came - left[k] - station.time).clamp(-8.0, 8.0)
                    }
                    Station::Sensor | Station::Clamp => {
                        log.output(line - 1, &format!("doAsk{k}")) + time
                    }
                    Station::Door if chance.is(station.already) => came - 1.0,
                    Station::Door => came + time,
                };
                log.wait(line, &format!("di{k}"), due);
                next[k] = f64::max(next[k] + station.time, log.t - station.time);
                if station.station.is_slack() || station.station == Station::Press {
                    log.travel(line + 1, 1.5 + chance.normal(self.jitter).abs());
                    left[k] = log.output(line + 2, &format!("doStart{k}"));
                }
                if drawn[(k + 2) % count].station == Station::Test {
                    tested = log.output(line + 3, &format!("doTest{k}"));
                }
            }
        }
    }
}

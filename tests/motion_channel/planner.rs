//! A robot that runs a program, and its logs.

use joulepath::gap::Run;

/// Targets \[rad\], whether the robot stops there, and the wait there \[s\].
pub(crate) const PROGRAM: [([f64; 3], bool, f64); 8] = [
    ([0.9, -0.3, 0.4], true, 0.3),
    ([1.1, 0.1, 0.3], false, 0.0),
    ([0.2, 0.8, -0.5], false, 0.0),
    ([-0.6, 0.2, 0.6], true, 0.0),
    ([-0.5, 0.3, 0.5], true, 0.1),
    ([-0.9, -0.7, -0.4], false, 0.0),
    ([0.3, -0.4, -0.9], true, 0.4),
    ([0.0, 0.0, 0.0], true, 0.2),
];

/// A robot that moves all joints together by trapezoids of speed, and cuts corners by beginning a
/// movement before the end of the last one.
#[derive(Clone)]
pub(crate) struct Robot {
    /// Largest speed of a joint \[rad/s\], of each movement.
    pub(crate) speed: [f64; 8],
    /// Largest acceleration \[rad/s²\].
    pub(crate) acceleration: f64,
    /// Share of a ramp by which movements overlap at a corner \[1\].
    pub(crate) overlap: f64,
    /// Lateness \[s\].
    pub(crate) lag: f64,
    /// Added waits \[s\].
    pub(crate) waits: [f64; 8],
}

pub(crate) const HEALTHY: Robot = Robot {
    speed: [1.6, 1.6, 1.2, 1.6, 1.6, 1.2, 1.6, 0.8],
    acceleration: 6.0,
    overlap: 0.6,
    lag: 0.0,
    waits: [0.0; 8],
};

/// How a log is recorded.
#[derive(Clone, Copy)]
pub(crate) struct Recorder {
    /// Interval of the rows \[s\].
    pub(crate) step: f64,
    /// Standard deviation of a position \[rad\].
    pub(crate) noise: f64,
    /// Seed of noise and jitter.
    pub(crate) seed: u64,
}

pub(crate) const BEFORE: Recorder = Recorder { step: 0.01, noise: 3e-5, seed: 1 };
pub(crate) const NOW: Recorder = Recorder { step: 0.008, noise: 3e-5, seed: 2 };
pub(crate) const HELD: Recorder = Recorder { step: 0.008, noise: 3e-5, seed: 3 };
const CYCLES: usize = 4;

/// Uniform numbers between −1 and 1 (Knuth's linear congruential generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A sum of twelve uniform numbers has twice the deviation of a standard normal one.
    fn normal(&mut self) -> f64 {
        0.5 * (0..12).map(|_| self.next()).sum::<f64>()
    }
}

/// A movement: number, beginning \[s\], from where, by how much \[rad\], speed \[rad/s\].
struct Leg {
    number: usize,
    start: f64,
    command: f64,
    by: [f64; 3],
    way: f64,
    speed: f64,
}

impl Robot {
    /// Duration of a leg and of its ramp \[s\].
    fn times(&self, leg: &Leg) -> (f64, f64) {
        let ramp = (leg.speed / self.acceleration).min((leg.way / self.acceleration).sqrt());
        (ramp + leg.way / (ramp * self.acceleration), ramp)
    }

    /// Share of a leg's way at a time after its beginning.
    fn share(&self, leg: &Leg, t: f64) -> f64 {
        let (whole, ramp) = self.times(leg);
        let t = t.clamp(0.0, whole);
        let up = |t: f64| 0.5 * self.acceleration * t * t;
        let gone = if t < ramp {
            up(t)
        } else if t > whole - ramp {
            leg.way - up(whole - t)
        } else {
            up(ramp) + ramp * self.acceleration * (t - ramp)
        };
        gone / leg.way
    }

    /// The legs of some cycles, and the end \[s\]. Every stop takes some ms more or less.
    fn legs(&self, random: &mut Random) -> (Vec<Leg>, f64) {
        let (mut legs, mut t, mut at) = (Vec::new(), 0.35, [0.0; 3]);
        for _ in 0..CYCLES {
            let mut overlap = 0.0;
            for (k, (target, stops, wait)) in PROGRAM.iter().enumerate() {
                let mut by = *target;
                by.iter_mut().zip(at).for_each(|(by, at)| *by -= at);
                let way = by.iter().fold(0.0_f64, |most, by| most.max(by.abs()));
                let start = t - overlap;
                let command = t - 0.5 * overlap;
                let leg = Leg { number: k + 1, start, command, by, way, speed: self.speed[k] };
                let (whole, ramp) = self.times(&leg);
                t = start + whole;
                overlap = if *stops { 0.0 } else { self.overlap * ramp };
                if *stops {
                    t += wait + self.waits[k] + 0.001 * random.next();
                }
                at = *target;
                legs.push(leg);
            }
        }
        (legs, t)
    }

    /// The log of some cycles.
    pub(crate) fn log(&self, recorder: Recorder) -> Run {
        let mut random = Random(recorder.seed);
        let (legs, end) = self.legs(&mut random);
        let mut run = Run { t: Vec::new(), q: vec![Vec::new(); 3], command: Vec::new() };
        // The log ends within a cycle.
        for row in 0..((end - 0.5) / recorder.step) as usize {
            let t = recorder.step * (row as f64 + 0.05 * random.next());
            run.t.push(t);
            let begun = legs.iter().take_while(|leg| leg.command <= t).last();
            run.command.push(begun.map_or(0, |leg| leg.number));
            for joint in 0..3 {
                let way = |leg: &Leg| leg.by[joint] * self.share(leg, t - self.lag - leg.start);
                let q = legs.iter().map(way).sum::<f64>() + recorder.noise * random.normal();
                run.q[joint].push((q * 1e5).round() / 1e5);
            }
        }
        run
    }
}

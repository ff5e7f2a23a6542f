//! A recorder of made-up cells.

use std::fmt::Write as _;

use crate::tool::cell::events::read;
use crate::tool::cell::waits::{Log, Reference, Shift, Verdict, samples, verdict};

/// Writes a log as a cell runs.
pub(super) struct Recorder {
    /// s since the start of the session.
    pub(super) t: f64,
    cmd: u64,
    /// Resolution of the clock, s.
    scan: f64,
    rows: Vec<(f64, u64, String)>,
    text: String,
    /// Whether changes of signals are recorded.
    pub(super) hears: bool,
}

impl Recorder {
    pub(super) fn new(scan: f64) -> Recorder {
        let mut recorder = Recorder {
            t: 0.0,
            cmd: 0,
            scan,
            rows: Vec::new(),
            text: "# joulepath recorder 1\n# program 3f2a9c0d11e8a4b7\n".to_owned(),
            hears: false,
        };
        recorder.restart();
        recorder
    }

    /// A new session.
    pub(super) fn restart(&mut self) {
        self.flush();
        let _ = writeln!(self.text, "# session 2026-11-29 {:.3}", self.t + self.text.len() as f64);
        self.text.push_str("t,cycle,cmd,file,line,event,value,signal\n");
        self.t = 0.0;
    }

    fn flush(&mut self) {
        self.rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut cycle = 1;
        for (t, cmd, rest) in self.rows.drain(..) {
            if rest.starts_with(",,cycle") && t > 0.0 {
                cycle += 1;
            }
            let shown = (t / self.scan).round() * self.scan;
            let _ = writeln!(self.text, "{shown:.3},{cycle},{cmd},{rest}");
        }
    }

    fn row(&mut self, t: f64, rest: &str) {
        self.rows.push((t, self.cmd, rest.to_owned()));
    }

    pub(super) fn cycle(&mut self) {
        self.cmd = 0;
        self.row(self.t, ",,cycle,,");
    }

    /// A movement to a stop point.
    pub(super) fn travel(&mut self, line: u32, seconds: f64) {
        self.cmd += 1;
        self.row(self.t, &format!("Cell.mod,{line},start,,"));
        self.t += seconds;
        self.row(self.t, &format!("Cell.mod,{line},arrive,,"));
        self.t += 0.002;
    }

    /// Sets an output; returns when.
    pub(super) fn output(&mut self, line: u32, signal: &str) -> f64 {
        self.row(self.t, &format!("Cell.mod,{line},output,1,{signal}"));
        self.t += 0.002;
        self.t - 0.002
    }

    /// A measured value changes.
    pub(super) fn value(&mut self, signal: &str, value: f64) {
        self.row(self.t, &format!(",,signal,{value},{signal}"));
        self.t += 0.002;
    }

    /// Waits for a signal that comes, or came, at `at`.
    pub(super) fn wait(&mut self, line: u32, signal: &str, at: f64) {
        self.row(self.t, &format!("Cell.mod,{line},wait,,{signal}"));
        if self.hears && !signal.is_empty() && at >= 0.0 {
            self.row(at, &format!(",,signal,1,{signal}"));
        }
        self.t = self.t.max(at) + 0.002;
        self.row(self.t, &format!("Cell.mod,{line},end,0,{signal}"));
        if self.hears && !signal.is_empty() {
            self.row(self.t + 0.4, &format!(",,signal,0,{signal}"));
        }
    }

    pub(super) fn text(mut self) -> String {
        self.flush();
        self.text
    }

    /// The log.
    pub(super) fn log(self, name: &str) -> Log {
        let recording = read(self.text().as_bytes()).expect("a log");
        Log { name: name.to_owned(), recording }
    }

    /// The verdict on each line.
    pub(super) fn verdicts(self) -> Vec<(u32, Verdict, Option<Reference>)> {
        let shift = Shift::new(&[self.log("a.csv")], None).expect("cycles");
        let all = samples(&shift);
        all.iter()
            .map(|of| {
                let verdict = verdict(&shift, of);
                let after = verdict.after.map(|index| of.candidates[index].reference.clone());
                (of.key.place.line, verdict, after)
            })
            .collect()
    }
}

/// Random times.
pub(in crate::tool::cell::waits) struct Chance(fastrand::Rng);

impl Chance {
    pub(in crate::tool::cell::waits) fn new(seed: u64) -> Chance {
        Chance(fastrand::Rng::with_seed(seed))
    }

    pub(in crate::tool::cell::waits) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    /// Evenly in the logarithm.
    pub(in crate::tool::cell::waits) fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    pub(in crate::tool::cell::waits) fn is(&mut self, share: f64) -> bool {
        self.0.f64() < share
    }

    pub(in crate::tool::cell::waits) fn whole(&mut self, below: usize) -> usize {
        self.0.usize(..below)
    }

    /// Normal with this deviation (Box and Muller).
    pub(in crate::tool::cell::waits) fn normal(&mut self, deviation: f64) -> f64 {
        let radius = (-2.0 * (1.0 - self.0.f64()).ln()).sqrt();
        deviation * radius * (std::f64::consts::TAU * self.0.f64()).cos()
    }
}

//! `joulepath prove` on logs that are made here, by formulas of their own.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fmt::Write as _;
use std::fs;

use command::{joulepath, json, number, parsed, refused, run, stderr, stdout, written};
use serde_json::Value;
use tempfile::TempDir;

/// Power at rest, W, and the longest motion, s.
const REST_W: f64 = 300.0;
const MOTION_S: f64 = 6.0;

/// How a log is made.
#[derive(Clone)]
struct Made {
    seed: u64,
    cycles: usize,
    /// Factor of all power above rest.
    work: f64,
    /// Factor of all power.
    gain: f64,
    /// Mean wait, s.
    wait_s: f64,
    /// Time that the motion takes more, s.
    slower_s: f64,
    /// Interval of the rows, s, and the largest error of the meter, W.
    step: f64,
    noise_w: f64,
    /// Movements of a cycle.
    movements: f64,
    /// Power above rest by which the robot moves during the wait but for its last 0.8 s, W.
    creep_w: f64,
    /// First part of the names of parts, and whether there is the column.
    part: Option<&'static str>,
    unit: f64,
    has_cycle: bool,
    /// A cycle that stands still for minutes.
    stopped: Option<usize>,
    start: f64,
    head: String,
}

impl Made {
    fn new(seed: u64) -> Made {
        Made {
            seed,
            cycles: 30,
            work: 1.0,
            gain: 1.0,
            wait_s: 2.0,
            slower_s: 0.0,
            step: 0.05,
            noise_w: 0.5,
            movements: 6.0,
            creep_w: 0.0,
            part: None,
            unit: 1.0,
            has_cycle: true,
            stopped: None,
            start: 0.0,
            head: String::new(),
        }
    }

    /// Work of the motion of a cycle: 6 s · 500 W.
    fn saving(self, share: f64) -> Made {
        let work = 500.0 * MOTION_S;
        let all = work + REST_W * (MOTION_S + 2.0);
        Made { work: 1.0 - share * all / work, ..self }
    }

    fn text(&self) -> String {
        let mut random = fastrand::Rng::with_seed(self.seed);
        let mut out = self.head.clone();
        out += "t,power";
        out += if self.has_cycle { ",cycle" } else { "" };
        out += if self.part.is_some() { ",part\n" } else { "\n" };
        let (mut now, mut row) = (0.0, 0);
        for cycle in 0..self.cycles {
            let noise = 1.0 + 0.04 * (random.f64() + random.f64() - 1.0);
            let wait = self.wait_s + 0.6 * (random.f64() - 0.5);
            let wait = wait + if self.stopped == Some(cycle) { 200.0 } else { 0.0 };
            let motion = MOTION_S + self.slower_s;
            while (f64::from(row) * self.step) < now + motion + wait {
                let t = f64::from(row) * self.step;
                let u = (t - now) / motion;
                let shape = if u < 1.0 {
                    1.0 - 0.8 * (self.movements * std::f64::consts::TAU * u).cos() * (1.0 - u)
                } else {
                    0.0
                };
                let power = REST_W + 500.0 * MOTION_S / motion * self.work * noise * shape;
                let creeps = u >= 1.0 && t < now + motion + wait - 0.8;
                let power = power + if creeps { self.creep_w } else { 0.0 };
                let error = 2.0 * self.noise_w * (random.f64() - 0.5);
                let power = self.unit * self.gain * (power + error);
                let _ = write!(out, "{:.3},{power:.5}", t + self.start);
                if self.has_cycle {
                    let _ = write!(out, ",{}", cycle + 1);
                }
                if let Some(part) = self.part {
                    let _ = write!(out, ",{part}{}", cycle % 2);
                }
                out += "\n";
                row += 1;
            }
            now += motion + wait;
        }
        out
    }
}

struct Campaign {
    folder: TempDir,
}

impl Campaign {
    fn new() -> Campaign {
        Campaign { folder: tempfile::tempdir().unwrap() }
    }

    fn log(&self, name: &str, made: &Made) -> String {
        written(&self.folder, name, made.text())
    }

    fn proof(&self, before: &Made, after: &Made) -> Value {
        let [before, after] = [self.log("before.csv", before), self.log("after.csv", after)];
        json(&["prove", "--before", &before, "--after", &after, "--format", "json", "--quiet"])
    }
}

fn percent(proof: &Value, end: &str) -> f64 {
    number(proof, &format!("/saving_percent/{end}"))
}

fn mentions(proof: &Value, text: &str) -> bool {
    proof.to_string().contains(text)
}

#[test]
fn a_saving_is_proved_with_its_interval() {
    let campaign = Campaign::new();
    let proof = campaign.proof(&Made::new(1), &Made::new(2).saving(0.05));
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    assert!(percent(&proof, "low") < 5.0 && percent(&proof, "high") > 5.0, "{proof:#}");
    assert!(percent(&proof, "high") - percent(&proof, "low") < 3.0, "{proof:#}");
    assert_eq!(proof["cycles"]["before"], 30);
    assert!(number(&proof, "/cycle_s/difference_high").abs() < 0.3);
    let [before, after] = ["before.csv", "after.csv"].map(|name| campaign.folder.path().join(name));
    let page = campaign.folder.path().join("proof.html").display().to_string();
    let [before, after] = [before, after].map(|path| path.display().to_string());
    let args =
        ["prove", "--before", &before, "--after", &after, "--report", &page, "--promised", "9"];
    let text = stdout(&run(&args));
    for expected in
        ["saves", "per part", "baseline period", "measurement boundary", "diagnose", "points"]
    {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("<svg") && html.contains("IPMVP") && !html.contains("NaN"));
    // The same bytes again.
    let first = fs::read(&page).unwrap();
    run(&args);
    assert_eq!(first, fs::read(&page).unwrap());
}

#[test]
fn nothing_changed_is_no_saving() {
    let campaign = Campaign::new();
    let proof = campaign.proof(&Made::new(3), &Made::new(4));
    assert_eq!(proof["verdict"], "no_difference", "{proof:#}");
    let worse = campaign.proof(&Made::new(3), &Made::new(4).saving(-0.06));
    assert_eq!(worse["verdict"], "costs", "{worse:#}");
    let [before, after] =
        [campaign.log("a.csv", &Made::new(3)), campaign.log("b.csv", &Made::new(4))];
    let strict = joulepath(&["prove", "--before", &before, "--after", &after, "--strict"]);
    assert_eq!(strict.status.code(), Some(1));
    let few = Made { cycles: 3, ..Made::new(5) };
    let proof = campaign.proof(&few, &Made { seed: 6, ..few.clone() }.saving(0.05));
    assert_eq!(proof["verdict"], "too_few_cycles", "{proof:#}");
}

#[test]
fn the_power_analysis_stands_before_the_campaign() {
    let campaign = Campaign::new();
    let before = campaign.log("before.csv", &Made::new(7));
    let plan =
        json(&["prove", "--before", &before, "--effect", "1%", "--format", "json", "--quiet"]);
    assert!(plan["verdict"].is_null());
    // The work varies by 0.04/√6; it is 3000 of 5400 J.
    let deviation = 0.04 / 6.0_f64.sqrt() * 3000.0 / 5400.0;
    let expected = 7.85 * 2.0 * (deviation / 0.01).powi(2) + 2.0;
    let needed = number(&plan, "/cycles/needed");
    assert!(needed > 0.5 * expected && needed < 2.0 * expected, "{needed} {expected}");
    let text = stdout(&run(&["prove", "--before", &before]));
    assert!(text.contains("cycles each side will show 3.0 %"), "{text}");
}

#[test]
fn longer_waits_are_no_waste_and_slower_motion_is_no_saving() {
    let campaign = Campaign::new();
    // The machine is slower by 1 s, and nothing else has changed.
    let proof = campaign.proof(&Made::new(8), &Made { wait_s: 3.0, ..Made::new(9) });
    assert_eq!(proof["verdict"], "no_difference", "{proof:#}");
    assert!(percent(&proof, "value").abs() < 1.0, "{proof:#}");
    // The same by a meter that is slow and noisy.
    let by_meter =
        |seed: u64, wait_s: f64| Made { wait_s, step: 0.1, noise_w: 12.0, ..Made::new(seed) };
    let values = (0..4).map(|seed| {
        let proof = campaign.proof(&by_meter(40 + seed, 2.0), &by_meter(50 + seed, 3.0));
        percent(&proof, "value")
    });
    let mean = values.sum::<f64>() / 4.0;
    assert!(mean.abs() < 0.5, "{mean}");
    // The slack is used up: the cycle has the same length, the motion needs 5 % of all energy less.
    let slack = Made { wait_s: 1.4, slower_s: 0.6, ..Made::new(10).saving(0.05) };
    let proof = campaign.proof(&Made::new(8), &slack);
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    assert!((percent(&proof, "value") - 5.0).abs() < 1.0, "{proof:#}");
    // The program itself is slower; what its motion needs less goes into the base load.
    let slower = Made { slower_s: 0.6, ..Made::new(11).saving(REST_W * 0.6 / 5400.0) };
    let proof = campaign.proof(&Made::new(8), &slower);
    assert_ne!(proof["verdict"], "saves", "{proof:#}");
    assert!(mentions(&proof, "longer"), "{proof:#}");
}

#[test]
fn only_what_both_sides_made_is_compared() {
    let campaign = Campaign::new();
    let of = |seed: u64, part: &'static str| Made { part: Some(part), ..Made::new(seed) };
    let proof = campaign.proof(&of(12, "A"), &of(13, "A").saving(0.05));
    assert_eq!(proof["strata"].as_array().unwrap().len(), 2);
    assert!(mentions(&proof, "part A1"), "{proof:#}");
    let [before, after] =
        [campaign.log("a.csv", &of(12, "A")), campaign.log("b.csv", &of(13, "B"))];
    let message = refused(&["prove", "--before", &before, "--after", &after], "same parts");
    assert!(message.contains("part A0") && message.contains("part B1"), "{message}");
}

#[test]
fn the_meter_is_checked() {
    let campaign = Campaign::new();
    let kilowatts = Made { unit: 1e-3, ..Made::new(14).saving(0.05) };
    let proof = campaign.proof(&Made::new(15), &kilowatts);
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    assert!(mentions(&proof, "kW"));
    let off = Made { gain: 0.96, ..Made::new(16) };
    let proof = campaign.proof(&Made::new(15), &off);
    assert_ne!(proof["verdict"], "saves", "{proof:#}");
    assert!(mentions(&proof, "while the robot stands, the power is"), "{proof:#}");
    // Waits used up by slow motion are no other power at rest.
    let creeps = Made { creep_w: 45.0, ..Made::new(31).saving(0.05) };
    let proof = campaign.proof(&Made::new(15), &creeps);
    assert_eq!(proof["doubts"].as_array().unwrap().len(), 0, "{proof:#}");
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    let other = Made { unit: 5.0, ..Made::new(17) };
    let [before, after] = [campaign.log("a.csv", &Made::new(15)), campaign.log("b.csv", &other)];
    refused(&["prove", "--before", &before, "--after", &after], "same meter");
}

#[test]
fn another_product_is_noticed() {
    let campaign = Campaign::new();
    for movements in [3.0, 9.0] {
        let other = Made { movements, work: 0.8, ..Made::new(32) };
        let proof = campaign.proof(&Made::new(15), &other);
        assert_ne!(proof["verdict"], "saves", "{proof:#}");
        assert!(mentions(&proof, "another product"), "{proof:#}");
    }
    // Used-up waits and longer waits leave the order of the movements.
    for of in [
        Made { wait_s: 0.9, slower_s: 1.1, ..Made::new(33) },
        Made { wait_s: 3.0, ..Made::new(34) },
    ] {
        let proof = campaign.proof(&Made::new(15), &of.saving(0.05));
        assert!(!mentions(&proof, "another product"), "{proof:#}");
    }
}

#[test]
fn faults_are_left_out_and_named() {
    let campaign = Campaign::new();
    let stopped = Made { stopped: Some(7), ..Made::new(18).saving(0.05) };
    let proof = campaign.proof(&Made::new(19), &stopped);
    assert_eq!(proof["cycles"]["after"], 29);
    assert!(mentions(&proof, "stopped on the way"), "{proof:#}");
    assert!((percent(&proof, "value") - 5.0).abs() < 1.0, "{proof:#}");
}

#[test]
fn cycles_are_found_by_the_power_alone() {
    let campaign = Campaign::new();
    let of = |seed: u64| Made { has_cycle: false, ..Made::new(seed) };
    let proof = campaign.proof(&of(20), &of(21).saving(0.05));
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    assert!((percent(&proof, "value") - 5.0).abs() < 1.0, "{proof:#}");
    assert!(number(&proof, "/cycles/before") >= 26.0);
    // Movements that resemble each other are no cycles.
    let mut random = fastrand::Rng::with_seed(35);
    let (mut text, mut row) = ("t,power\n".to_owned(), 0);
    for _ in 0..40 {
        let rows = 140 + 40 + (40.0 * random.f64()) as u32;
        let work = 1.0 + 0.05 * random.f64();
        for i in 0..rows {
            let u = f64::from(i) / 140.0;
            let wave = (5.0 * std::f64::consts::PI * u).sin().powi(2);
            let power = if u < 1.0 { work * (900.0 * wave + 200.0 * u) } else { 0.0 };
            let error = 8.0 * (random.f64() + random.f64() - 1.0);
            let _ = writeln!(text, "{:.1},{:.2}", 0.1 * f64::from(row), 300.0 + power + error);
            row += 1;
        }
    }
    let before = written(&campaign.folder, "repeats.csv", text);
    let plan = json(&["prove", "--before", &before, "--format", "json", "--quiet"]);
    assert!((number(&plan, "/cycle_s/before") - 20.0).abs() < 1.0, "{plan:#}");
}

/// The log of events of the same cycles: the first cycle begins at 0, each has a wait and an output.
fn events(power: &str, program: &str) -> String {
    let mut out = format!("# program {program}\nt,cycle,cmd,file,line,event,value,signal\n");
    let mut last = String::new();
    for row in power.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        if cells[2] == last {
            continue;
        }
        cells[2].clone_into(&mut last);
        let t: f64 = cells[0].parse().unwrap();
        let _ = writeln!(out, "{t},{last},0,,,cycle,,");
        let _ = writeln!(out, "{:.3},{last},1,A.mod,9,wait,,diDoor", t + 6.0);
        let _ = writeln!(out, "{:.3},{last},1,A.mod,9,end,0,diDoor", t + 7.0);
        let _ = writeln!(out, "{:.3},{last},1,,,output,{},doGrip", t + 7.1, cells[2].len() % 2);
    }
    out
}

#[test]
fn logs_of_events_give_waits_and_ways() {
    let campaign = Campaign::new();
    let [before, after] = [Made::new(22).text(), Made::new(23).saving(0.05).text()];
    let [events_before, events_after] = [events(&before, "aa"), events(&after, "bb")];
    let path = |name: &str, text: &str| written(&campaign.folder, name, text);
    let [b, a] = [path("b.csv", &before), path("a.csv", &after)];
    let [eb, ea] = [path("eb.csv", &events_before), path("ea.csv", &events_after)];
    let args = ["prove", "--before", &b, &eb, "--after", &a, &ea, "--format", "json", "--quiet"];
    let proof = json(&args);
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    assert!(mentions(&proof, "way 1") && mentions(&proof, "way 2"), "{proof:#}");
    assert_eq!(proof["programs"][1], "bb");
    assert_eq!(
        proof["cycles"]["after"], 29,
        "the last one has no end in the log of events: {proof:#}"
    );
    let other = path("other.csv", &events(&before, "cc"));
    refused(&["prove", "--before", &b, &eb, &other, "--after", &a], "one version");
    refused(&["prove", "--before", &eb, "--after", &a], "no log of power");
}

#[test]
fn joints_are_the_measure_without_power() {
    let campaign = Campaign::new();
    let text = |seed: u64, factor: f64| {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut out = String::from("t,cycle,qd1,tau1\n");
        let mut noise = 1.0;
        for row in 0..6000 {
            let phase = f64::from(row % 200) / 200.0;
            if row % 200 == 0 {
                noise = 1.0 + 0.02 * (random.f64() - 0.5);
            }
            let rate = (std::f64::consts::TAU * phase).sin();
            let _ = writeln!(
                out,
                "{:.3},{},{rate},{}",
                0.02 * f64::from(row),
                row / 200,
                factor * noise * 40.0 * rate
            );
        }
        out
    };
    let [before, after] = [text(1, 1.0), text(2, 0.95)];
    let [b, a] =
        [written(&campaign.folder, "b.csv", before), written(&campaign.folder, "a.csv", after)];
    let proof = json(&["prove", "--before", &b, "--after", &a, "--format", "json", "--quiet"]);
    assert_eq!(proof["verdict"], "saves", "{proof:#}");
    assert!((percent(&proof, "value") - 5.0).abs() < 0.5, "{proof:#}");
    assert!(mentions(&proof, "joints"));
    let power = campaign.log("power.csv", &Made::new(24));
    refused(&["prove", "--before", &b, "--after", &power], "measure the same");
}

#[test]
fn bad_logs_are_refused_by_name() {
    let campaign = Campaign::new();
    let good = campaign.log("good.csv", &Made::new(25));
    let plain = Made::new(26);
    let check = |name: &str, text: &str, way_out: &str, found: &str| {
        let path = written(&campaign.folder, name, text);
        let message = refused(&["prove", "--before", &good, "--after", &path], way_out);
        assert!(message.contains(name) && message.contains(found), "{message}");
    };
    // Over midnight, and back to winter time.
    let day = Made { start: 86_300.0, ..plain.clone() }.text();
    let wrapped = |above: f64, back: f64| {
        let row = |line: &str| {
            let (t, rest) = line.split_once(',').unwrap();
            match t.parse::<f64>() {
                Ok(t) if t >= above => format!("{:.3},{rest}\n", t - back),
                _ => format!("{line}\n"),
            }
        };
        day.lines().map(row).collect::<String>()
    };
    check("midnight.csv", &wrapped(86_400.0, 86_400.0), "divide the file", "at midnight");
    check("autumn.csv", &wrapped(86_400.0, 3600.0), "divide the file", "summer time ends");
    // Two robots, row by row and cycle by cycle.
    let [first, second] = [plain.text(), Made { gain: 2.0, ..Made::new(27) }.text()];
    let pairs = first.lines().zip(second.lines()).skip(1);
    let rows = pairs.fold(String::new(), |mut rows, (a, b)| {
        let (t, rest) = b.split_once(',').unwrap();
        let _ = write!(rows, "{a}\n{:.3},{rest}\n", t.parse::<f64>().unwrap() + 0.02);
        rows
    });
    check("two.csv", &format!("t,power,cycle\n{rows}"), "a file of its own", "two robots");
    let turns: String = first
        .lines()
        .enumerate()
        .map(|(row, line)| match (row, line.rsplit_once(',')) {
            (1.., Some((rest, _))) => format!("{rest},{}\n", 5 + row / 300 % 2),
            _ => format!("{line}\n"),
        })
        .collect();
    check("turns.csv", &turns, "a file of its own", "line");
    // Two versions of the program, the wrong column, no cycles, no file.
    let versions = format!("# program 11\n{first}# program 22\n");
    check("versions.csv", &versions, "one version", "program 22");
    check("names.csv", &first.replace("power", "watts"), "--map power=NAME", "line 1");
    check("negative.csv", &Made { unit: -1.0, ..plain.clone() }.text(), "sign", "line 1");
    let rows = (0..2000).map(|row| format!("{:.1},500,{}", 0.1 * f64::from(row), row / 80));
    let stuck: Vec<String> = std::iter::once("t,power,cycle".to_owned()).chain(rows).collect();
    check("stuck.csv", &(stuck.join("\n") + "\n"), "check the meter", "never changes");
    check("binary.csv", "\u{1b}[31mred\u{7},\u{fffd}\n1,2\n", "names the columns", "\\u{1b}[31m");
    check("empty.csv", "", "the first row names the columns", "empty.csv");
    let short = first.lines().take(30).collect::<Vec<_>>().join("\n") + "\n";
    check("short.csv", &short, "column `cycle`", "short.csv");
    let same = written(&campaign.folder, "same.csv", Made::new(25).text());
    refused(&["prove", "--before", &good, "--after", &same], "each log once");
    refused(&["prove", "--before", &good, "--after", &good], "each log once");
    refused(&["prove", "--before", &good, "--after", "/nowhere/x.csv"], "check the path");
    refused(&["prove", "--before", &good, "--effect", "x"], "such as 3%");
    refused(&["prove", "--before", &good, "--promised=-900"], "between -100 and 100 %");
}

#[test]
fn a_truncated_log_loses_its_last_cycle_only() {
    let campaign = Campaign::new();
    let text = Made::new(28).text();
    let cut = written(&campaign.folder, "cut.csv", &text[..text.len() - 1505]);
    let whole = campaign.log("whole.csv", &Made::new(29));
    let output = joulepath(&["prove", "--before", &whole, "--after", &cut, "--format", "json"]);
    let proof = parsed(&output);
    assert_eq!(proof["cycles"]["after"], 29, "{}", stderr(&output));
    assert!(mentions(&proof, "cut by the begin or the end"), "{proof:#}");
    // Summer time begins within a cycle.
    let spring: String = text
        .lines()
        .enumerate()
        .map(|(row, line)| match line.split_once(',') {
            Some((t, rest)) if row > 1000 => {
                format!("{:.3},{rest}\n", t.parse::<f64>().unwrap() + 3600.0)
            }
            _ => format!("{line}\n"),
        })
        .collect();
    let spring = written(&campaign.folder, "spring.csv", spring);
    let proof =
        json(&["prove", "--before", &whole, "--after", &spring, "--format", "json", "--quiet"]);
    assert!(mentions(&proof, "summer time begins"), "{proof:#}");
    assert_eq!(proof["cycles"]["after"], 29, "{proof:#}");
}

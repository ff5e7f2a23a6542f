//! The HTML report of a retrofit.
#![expect(clippy::unwrap_used, reason = "a failed set-up fails the test")]

mod support;

use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::LazyLock;

use joulepath::arm::robot::Model;
use joulepath::rapid::text::{FileId, SourceFile, Span};
use joulepath::retime::energy::{Account, EnergyParts, account};
use joulepath::retime::motion::timeline::What;
use joulepath::retime::motion::{Options, Simulation};
use joulepath::retime::optimize::check::Check;
use joulepath::retime::optimize::reason::Reason;
use joulepath::tool::report::html::optimize_report;
use joulepath::tool::retrofit::{
    Figures, OutputFile, OutputKind, Retrofit, Segment, SegmentKind, Settings, SignalKind,
    SignalShift, Source, Verification, WholeCycle, retrofit,
};
use support::{irb1600, modules, program, simulated, sources};

/// The retrofit of a whole cell, with its page.
struct Cell {
    files: Vec<Source>,
    model: Model,
    retrofit: Retrofit,
    page: String,
}

static CELL: LazyLock<Cell> = LazyLock::new(|| {
    let files = modules("pick_place");
    let model = irb1600();
    let settings = Settings::default();
    let retrofit = retrofit(&files, &model, &settings, &|_, _| ()).unwrap();
    let page = optimize_report(&retrofit, &files, &model, "main").unwrap();
    Cell { files, model, retrofit, page }
});

/// A small program with a manually written stream, so that its report does not depend on the
/// optimiser.
struct Small {
    files: Vec<Source>,
    model: Model,
    retrofit: Retrofit,
}

const HEAD: &str = "MODULE Cell
    CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget jAside:=[[20,10,-5,0,80,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pFront:=[[750,150,1121.5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

    PROC main()
        MoveAbsJ jHome,v1000,fine,tool0;
        ! <script>alert(\"1 < 2 & 'x'\")</script>
        FOR nPart FROM 1 TO 2 DO
            rFront;
            WaitTime 3;
            MoveAbsJ jHome,v1000,fine,tool0;
        ENDFOR
        WaitDI diReady,1;
    ENDPROC

    PROC rFront()
";
const ORIGINAL: &str = "        MoveAbsJ jAside,v1000,z50,tool0;
        MoveL pFront,v300,fine,tool0;
";
const TAIL: &str = "    ENDPROC
ENDMODULE
";
/// Interval between two points of the stream, s.
const SPACING: f64 = 0.1;

fn run(model: &Model, text: &str) -> (Simulation, Account) {
    let simulation = simulated(model, &program(text), &Options::default());
    let account = account(model, &simulation);
    (simulation, account)
}

/// The same movement as timed points.
fn stream(before: &Simulation, event: usize) -> String {
    let What::Run(run) = &before.events[event].what else { panic!("no run") };
    let n = (run.duration() / SPACING).floor();
    let mut text = String::new();
    for i in 1..=n as usize {
        let last = i == n as usize;
        let q = if last { run.end } else { run.at(run.duration() * i as f64 / n).q };
        let q: Vec<String> = q.iter().map(|x| format!("{:.5}", x.to_degrees())).collect();
        writeln!(
            text,
            "        MoveAbsJ [[{}],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000\\T:={:.4},{},tool0;",
            q.join(","),
            run.duration() / n,
            if last { "fine" } else { "z200" }
        )
        .unwrap();
    }
    text
}

fn span(text: &str, part: &str) -> Span {
    let start = text.find(part).unwrap();
    Span { file: FileId(0), start: start as u32, end: (start + part.len()) as u32 }
}

fn small(path: &str) -> Small {
    let model = irb1600();
    let text = format!("{HEAD}{ORIGINAL}{TAIL}");
    let before = run(&model, &text);
    let changed = format!("{HEAD}{}{TAIL}", stream(&before.0, 1));
    let after = run(&model, &changed);
    let figures = |(simulation, account): &(Simulation, Account)| Figures {
        cycle_s: simulation.cycle_s,
        energy_j: account.total.energy_j(),
        motion_energy_j: account.total.motion_energy_j(),
    };
    let segment = |part: &str, kind, events: &[usize], reason: Option<Reason>| {
        let time = |(simulation, _): &(Simulation, Account)| -> f64 {
            events.iter().map(|i| simulation.events[*i].duration).sum()
        };
        let energy = |(_, account): &(Simulation, Account)| -> f64 {
            events.iter().flat_map(|i| &account.events[*i]).map(EnergyParts::energy_j).sum()
        };
        let rewritten = kind == SegmentKind::Timing && reason.is_none();
        Segment {
            span: span(&text, part),
            pieces: vec![span(&text, part)],
            kind,
            rewritten,
            reason,
            executions: events.len(),
            rewritten_executions: if rewritten { events.len() } else { 0 },
            time_before_s: time(&before),
            time_after_s: time(&after),
            energy_before_j: energy(&before),
            energy_after_j: energy(&after),
            lower_bound_j: rewritten.then(|| 0.9 * energy(&after)),
            points: 9,
            potential_j: if kind == SegmentKind::Idle { 12.5 } else { 0.0 },
            events: events.to_vec(),
            pareto: Vec::new(),
        }
    };
    let home = "MoveAbsJ jHome,v1000,fine,tool0;";
    let mut segments = vec![
        segment(home, SegmentKind::Timing, &[0], Some(Reason::FirstMovement)),
        segment("WaitTime 3;", SegmentKind::Idle, &[2, 5], Some(Reason::NeedsSetting(0.7))),
        segment(home, SegmentKind::Timing, &[3, 6], Some(Reason::NoSaving)),
        segment(ORIGINAL.trim(), SegmentKind::Timing, &[1, 4], None),
    ];
    let second = text.rfind(home).unwrap();
    segments[2].span.start = second as u32;
    segments[2].span.end = (second + home.len()) as u32;
    segments[2].pieces = vec![segments[2].span];
    let retrofit = Retrofit {
        lower_limits: Vec::new(),
        uncertainty: None,
        spacings: Vec::new(),
        guard_instructions: 0,
        original: figures(&before),
        optimized: figures(&after),
        padding: None,
        whole_cycle: WholeCycle::default(),
        potential_j: 25.0,
        notes: Vec::new(),
        segments,
        verification: Verification {
            passed: true,
            worst: Check { velocity: 0.5, torque: 0.25, deviation_m: 0.001, ..Check::none() },
            intended_error_rad: 2e-9,
            checks: vec![("the emitted text parses".into(), true)],
        },
        signals: vec![SignalShift {
            name: "doGrip".into(),
            kind: SignalKind::Output,
            times: 2,
            order_kept: true,
            largest_shift_s: -0.12,
        }],
        outputs: vec![OutputFile {
            path: path.to_owned(),
            kind: OutputKind::Changed,
            bytes: changed.into_bytes(),
            input: Some(0),
        }],
        before,
        after,
    };
    let file = SourceFile::new(FileId(0), path.to_owned(), text.into_bytes());
    Small { files: sources(vec![file]), model, retrofit }
}

fn small_page(path: &str) -> String {
    let small = small(path);
    optimize_report(&small.retrofit, &small.files, &small.model, "main").unwrap()
}

/// The visible text of a page, one cell or paragraph per line.
fn text_of(page: &str) -> String {
    let body = page.split("<body>").nth(1).unwrap();
    let mut out = String::new();
    let mut rest = body;
    while let Some(open) = rest.find('<') {
        out.push_str(&rest[..open]);
        let close = open + rest[open..].find('>').unwrap();
        let name = rest[open + 1..close].trim_start_matches('/').split([' ', '/']).next().unwrap();
        if matches!(name, "td" | "th" | "text" | "title" | "summary" | "div" | "label") {
            out.push_str(" | ");
        } else if !matches!(name, "span" | "code" | "i" | "a") {
            out.push('\n');
        }
        rest = &rest[close + 1..];
    }
    let lines: Vec<String> = out
        .lines()
        .map(|line| {
            let cells: Vec<&str> =
                line.split('|').map(str::trim).filter(|cell| !cell.is_empty()).collect();
            cells.join(" | ")
        })
        .filter(|line| !line.is_empty())
        .collect();
    lines.join("\n")
}

/// Errors of the markup: unclosed or misordered tags, attributes without quotes, invalid
/// references, repeated identifiers.
fn malformed(page: &str) -> Option<String> {
    const VOID: [&str; 4] = ["meta", "input", "br", "link"];
    let mut open: Vec<&str> = Vec::new();
    let mut ids: BTreeSet<&str> = BTreeSet::new();
    let mut rest = page.strip_prefix("<!DOCTYPE html>")?;
    while let Some(at) = rest.find('<') {
        let text = &rest[..at];
        if open.last() != Some(&"style") {
            if text.contains('>') {
                return Some(format!("a bare > in {text:?}"));
            }
            for reference in text.split('&').skip(1) {
                let name = reference.split(';').next().unwrap_or_default();
                if !matches!(name, "amp" | "lt" | "gt" | "quot" | "#39") {
                    return Some(format!("a bare & in {text:?}"));
                }
            }
        }
        let Some(end) = rest[at..].find('>') else { return Some("a tag without end".into()) };
        let tag = &rest[at + 1..at + end];
        rest = &rest[at + end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name) {
                return Some(format!("</{name}> closes nothing"));
            }
            continue;
        }
        let (tag, closed) = match tag.strip_suffix('/') {
            Some(tag) => (tag, true),
            None => (tag, false),
        };
        let name = tag.split(' ').next().unwrap_or_default();
        if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric()) {
            return Some(format!("<{tag}> is no tag"));
        }
        if closed && !open.contains(&"svg") {
            return Some(format!("<{tag}/> outside of a drawing"));
        }
        let mut attributes = tag[name.len()..].trim_start();
        while !attributes.is_empty() {
            let length = attributes.find(['=', ' ']).unwrap_or(attributes.len());
            let (key, after) = attributes.split_at(length);
            attributes = if let Some(value) = after.strip_prefix("=\"") {
                let Some(end) = value.find('"') else { return Some(format!("<{tag}>")) };
                if key == "id" && !ids.insert(&value[..end]) {
                    return Some(format!("id {} occurs twice", &value[..end]));
                }
                value[end + 1..].trim_start()
            } else if after.starts_with('=') {
                return Some(format!("a value without quotes in <{tag}>"));
            } else {
                after.trim_start()
            };
        }
        if !closed && !VOID.contains(&name) {
            open.push(name);
        }
    }
    for reference in page.split("href=\"#").skip(1) {
        let id = reference.split('"').next().unwrap_or_default();
        if !ids.contains(id) {
            return Some(format!("#{id} leads nowhere"));
        }
    }
    (!open.is_empty()).then(|| format!("{open:?} stay open"))
}

#[test]
fn text_of_a_small_report() {
    let text = text_of(&small_page("Cell.mod"));
    // Assumptions about the robot are in its own section.
    let (page, robot) = text.split_once("About the robot").unwrap();
    assert!(robot.contains("friction.coulomb"));
    insta::assert_snapshot!(page);
}

#[test]
fn pages_are_well_formed() {
    assert_eq!(malformed(&CELL.page), None);
    assert_eq!(malformed(&small_page("Cell.mod")), None);
    // The checker detects errors.
    for (bad, what) in [
        ("<p><b></p>", "closes nothing"),
        ("<p>", "stay open"),
        ("<p>a & b</p>", "bare &"),
        ("<p class=x></p>", "without quotes"),
        ("<p id=\"a\"></p><p id=\"a\"></p>", "twice"),
        ("<a href=\"#b\"></a>", "nowhere"),
        ("<p/>", "outside"),
    ] {
        let seen = malformed(&format!("<!DOCTYPE html>{bad}")).unwrap();
        assert!(seen.contains(what), "{bad}: {seen}");
    }
}

#[test]
fn pages_load_no_external_content() {
    for foreign in ["http://", "https://", "src=", "@import", "<script", "<link", "url("] {
        assert!(!CELL.page.contains(foreign), "{foreign}");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let again = optimize_report(&CELL.retrofit, &CELL.files, &CELL.model, "main").unwrap();
    assert_eq!(again, CELL.page);
    assert_eq!(small_page("Cell.mod"), small_page("Cell.mod"));
}

#[test]
fn foreign_text_is_escaped() {
    let mut small = small("<img onerror=\"x\">/Cell's & <b>.mod");
    small.model.name = "IRB <script>".into();
    small.retrofit.segments[0].reason = Some(Reason::Instruction("<i>\"&'".into()));
    small.retrofit.before.0.assumed.push("<u>".into());
    small.retrofit.verification.checks.push(("<s>".into(), true));
    let page = optimize_report(&small.retrofit, &small.files, &small.model, "<em>main").unwrap();
    assert_eq!(malformed(&page), None);
    for tag in ["<script", "<img", "<b>", "<i>", "<u>", "<s>", "<em>"] {
        // The `<i>` elements of the legend contain no text.
        let own = page.matches("<i></i>").count() * usize::from(tag == "<i>");
        assert_eq!(page.matches(tag).count(), own, "{tag}");
    }
    for text in [
        "&lt;script&gt;alert(&quot;1 &lt; 2 &amp; &#39;x&#39;&quot;)&lt;/script&gt;",
        "&lt;img onerror=&quot;x&quot;&gt;/Cell&#39;s &amp; &lt;b&gt;.mod:7",
        "IRB &lt;script&gt;",
        "&lt;em&gt;main",
    ] {
        assert!(page.contains(text), "{text}");
    }
}

/// The values in the cells after a label.
fn cells(page: &str, label: &str) -> Vec<f64> {
    let row = page.split(label).nth(1).unwrap().split("</tr>").next().unwrap();
    row.split("<td class=\"n\">")
        .skip(1)
        .map(|cell| cell.split('<').next().unwrap().replace('\u{2212}', "-").parse().unwrap())
        .collect()
}

#[test]
fn segments_and_the_rest_add_up_to_the_cycle() {
    const ROUNDING: [f64; 4] = [0.0005, 0.0005, 0.05, 0.05];
    let listed: BTreeSet<usize> =
        CELL.retrofit.segments.iter().flat_map(|segment| segment.events.iter().copied()).collect();
    let sides = [&CELL.retrofit.before, &CELL.retrofit.after];
    let time = |(simulation, _): &(Simulation, Account), all: bool| -> f64 {
        let events = simulation.events.iter().enumerate();
        events.filter(|(i, _)| all || !listed.contains(i)).map(|(_, e)| e.duration).sum()
    };
    let energy = |(_, account): &(Simulation, Account), all: bool| -> f64 {
        let events = account.events.iter().enumerate();
        events
            .filter(|(i, _)| all || !listed.contains(i))
            .flat_map(|(_, parts)| parts)
            .map(EnergyParts::energy_j)
            .sum()
    };
    for (label, all) in [("short waits and the rest", false), (">cycle<", true)] {
        let seen = cells(&CELL.page, label);
        let expected = [
            time(sides[0], all),
            time(sides[1], all),
            energy(sides[0], all),
            energy(sides[1], all),
        ];
        for i in 0..4 {
            let error = (seen[i] - expected[i]).abs();
            assert!(error <= 1.001 * ROUNDING[i], "{label}: {} for {}", seen[i], expected[i]);
        }
    }
}

#[test]
fn energies_of_the_source_add_up_to_the_total() {
    let source = CELL.page.split("<section id=\"source\">").nth(1).unwrap();
    let source = source.split("</section>").next().unwrap();
    let mut sums = [0.0; 2];
    let mut files = 0.0;
    for file in source.split("<summary>").skip(1) {
        let summary = file.split("</span>: ").nth(1).unwrap().split("</summary>").next().unwrap();
        let figures: Vec<f64> = summary.split(' ').filter_map(|word| word.parse().ok()).collect();
        sums = [sums[0] + figures[0], sums[1] + figures[1]];
        files += 1.0;
    }
    let rounding = 0.051 * files;
    assert!((sums[0] - CELL.retrofit.original.energy_j).abs() < rounding, "{sums:?}");
    assert!((sums[1] - CELL.retrofit.optimized.energy_j).abs() < rounding, "{sums:?}");
}

#[test]
fn each_rewritten_segment_has_plots_before_and_after() {
    let rewritten = CELL.retrofit.segments.iter().filter(|s| s.rewritten).count();
    assert!(rewritten > 0);
    let movements = CELL.page.split("<section id=\"movements\">").nth(1).unwrap();
    let movements = movements.split("</section>").next().unwrap();
    assert_eq!(movements.matches("<h3 id=\"movement-").count(), rewritten);
    let ways: Vec<&str> = movements.split("<details class=\"way\"").skip(1).collect();
    assert!(ways.len() >= rewritten);
    for way in ways {
        assert_eq!(way.matches("<figure>").count(), 4);
        for curve in ["before", "after"] {
            for j in 1..=6 {
                // Speed and torque.
                assert_eq!(way.matches(&format!("class=\"{curve} j{j}\"")).count(), 2);
            }
            // Power and TCP speed.
            assert_eq!(way.matches(&format!("class=\"{curve} one\"")).count(), 2);
        }
    }
}

#[test]
fn executions_of_one_stream_share_their_plots() {
    let page = small_page("Cell.mod");
    assert_eq!(page.matches("<details class=\"way\"").count(), 1);
    assert!(page.contains("<summary>2 runs: "));
    // The programmed 300 mm/s of the line.
    assert!(page.contains("class=\"ceiling\""));
}

#[test]
fn each_rewritten_segment_has_its_arrow() {
    let figure = CELL.page.split("<h3>Energy over time").nth(1).unwrap();
    let figure = figure.split("</svg>").next().unwrap();
    let moving = CELL
        .retrofit
        .segments
        .iter()
        .filter(|s| s.kind == SegmentKind::Timing && s.time_before_s > 0.0);
    let rewritten = moving.clone().filter(|s| s.rewritten).count();
    assert_eq!(figure.matches("<circle").count(), moving.count());
    assert_eq!(figure.matches("class=\"head\"").count(), rewritten);
    assert_eq!(figure.matches("class=\"bound\"").count(), rewritten);
}

#[test]
fn savings_of_the_dwells_add_up_to_the_potential() {
    let table = CELL.page.split("<section id=\"dwells\">").nth(1).unwrap();
    let table = table.split("</section>").next().unwrap();
    let potentials: Vec<f64> = table
        .split("<td class=\"n good\">")
        .skip(1)
        .map(|cell| cell.split('<').next().unwrap().parse().unwrap())
        .collect();
    let sum: f64 = potentials.iter().sum();
    assert!(CELL.retrofit.potential_j > 0.0);
    assert!((sum - CELL.retrofit.potential_j).abs() < 0.051 * potentials.len() as f64, "{sum}");
}

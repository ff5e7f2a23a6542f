#![allow(dead_code, unused)]
pub use joulepath::{arm, learn};
mod gap;
use learn::identify::{Hints, Samples, prepare, torques, cleaned};
use learn::log::{self, ColumnMap};
use gap::{Trust, Settings, Logs, Tunables, Finding};
use serde_json::{json, Value};
static COUNTS: std::sync::Mutex<std::collections::BTreeMap<String,f64>> = std::sync::Mutex::new(std::collections::BTreeMap::new());
pub fn count(n: &str, x: f64) { *COUNTS.lock().unwrap().entry(n.to_owned()).or_default() += x; }
fn read(model: &arm::robot::Model, path: &str, period: Option<f64>, cutoff: Option<f64>) -> Samples {
    let mut f = std::fs::File::open(path).expect(path);
    let log = log::read_from(&mut f, &ColumnMap::parse("").unwrap()).unwrap();
    let (log, _) = cleaned(&log);
    let tau = torques(model, &log).unwrap();
    prepare(&log, &tau.tau, Hints { period, cutoff }).unwrap()
}
fn finding(of: &Finding) -> Value {
    json!({"id": of.effect.id, "joints": of.joints.iter().map(|j| j + 1).collect::<Vec<_>>(), "class": of.class, "p": of.probability, "nats": (of.nats*10.0).round()/10.0, "size": (of.size*1e4).round()/100.0,
      "parameters": of.parameters.iter().map(|p| format!("{} {:.4}±{:.4}", p.name, p.value, p.sd)).collect::<Vec<_>>()})
}
fn main() {
    if let Ok(seed) = std::env::var("JP_LABELS") { use joulepath::examine::blind; let seed: u64 = seed.parse().unwrap(); for n in 1..=70 { let st = blind::Settings { cycles: 4, period_s: 5.0, ..blind::Settings::new(seed) }; let Some(c) = blind::case(&st, n) else { continue }; let ids: Vec<String> = c.label.effects.iter().map(|e| format!("{}:{:.0}", e.id, e.nats)).collect(); println!("{seed} {n} {} {:?}", c.label.trust, ids); if ids.is_empty() { continue } let d = format!("/tmp/claims/{seed}_{n}"); std::fs::create_dir_all(&d).unwrap(); for (f, t) in &c.files { let p = format!("{d}/{f}"); std::fs::create_dir_all(std::path::Path::new(&p).parent().unwrap()).unwrap(); std::fs::write(p, t).unwrap(); } std::fs::remove_file(format!("{d}/case.json")).ok(); std::fs::write(format!("{d}/command.txt"), format!("diagnose --robot nominal.toml --log log-1.csv --log heldout.csv --heldout log-2.csv --trust {} --period 5", c.label.trust)).unwrap(); } return; }
    for dir in std::env::args().skip(1) {
        let cmd = match std::fs::read_to_string(format!("{dir}/case.json")) {
            Ok(t) => {
                let v: serde_json::Value = serde_json::from_str(&t).unwrap();
                let mut c = format!("--robot {} --trust {}", v["robot"].as_str().unwrap(), v["trust"].as_str().unwrap());
                for k in ["log", "baseline", "heldout"] { for f in v[k].as_array().into_iter().flatten() { c += &format!(" --{k} {}", f.as_str().unwrap()); } }
                if let Some(h) = v["heldout"].as_str() { c += &format!(" --heldout {h}"); }
                if let Some(p) = v["period"].as_f64() { c += &format!(" --period {p}"); }
                c
            }
            Err(_) => std::fs::read_to_string(format!("{dir}/command.txt")).unwrap(),
        };
        let w: Vec<&str> = cmd.split_whitespace().collect();
        let mut lists: std::collections::HashMap<String, Vec<String>> = Default::default();
        let mut key = String::new();
        for x in &w { if let Some(k) = x.strip_prefix("--") { key = k.into(); } else { lists.entry(key.clone()).or_default().push(x.to_string()); } }
        let all = |k: &str| -> Vec<String> { lists.get(k).into_iter().flatten().map(|x| if x.starts_with('/') { x.clone() } else { format!("{dir}/{x}") }).collect() };
        let one = |k: &str| lists.get(k).and_then(|x| x.first().cloned());
        let model = arm::effects::load(&all("robot")[0]).unwrap();
        let period = one("period").and_then(|x| x.parse().ok());
        let base = all("baseline");
        let trust = match one("trust").as_deref() { Some("commissioned") => Trust::Commissioned, Some("cad") => Trust::Cad, Some("unknown") => Trust::Unknown, _ => if base.is_empty() { Trust::Cad } else { Trust::Commissioned } };
        let t0 = std::time::Instant::now();
        let r = |k: &str, c: Option<f64>| -> Vec<Samples> { all(k).iter().map(|p| read(&model, p, period, c)).collect() };
        let (mut train, mut held, mut before) = (r("log", None), r("heldout", None), r("baseline", None));
        let cut: Vec<f64> = train.iter().chain(&held).chain(&before).filter_map(|s| match s.source { learn::identify::Source::Filtered { cutoff } => Some(cutoff), _ => None }).collect();
        let least = cut.iter().copied().fold(f64::INFINITY, f64::min);
        if cut.iter().any(|c| *c > 1.01 * least) { (train, held, before) = (r("log", Some(least)), r("heldout", Some(least)), r("baseline", Some(least))); }
        if held.is_empty() && train.len() > 1 { held.extend(train.pop()); }
        let t1 = t0.elapsed().as_secs_f64();
        let settings = Settings { trust, effects: arm::effects::ALL.iter().filter(|e| e.id != "apparent_torque" && std::env::var("EFFECTS").map_or(true, |l| l.split(',').any(|x| x == e.id))).collect(), tunables: { let mut t = Tunables::DEFAULT; if let Ok(x) = std::env::var("HELD") { t.left_in_heldout = x.parse().unwrap(); } t } };
        let refs = |x: &'static [Samples]| -> Vec<&'static Samples> { x.iter().collect() };
        let (train, held, before): (&'static [Samples], &'static [Samples], &'static [Samples]) = (train.leak(), held.leak(), before.leak());
        let (a, b, c) = (refs(train), refs(held), refs(before));
        if let Ok(j) = std::env::var("JP_RES") { let j: usize = j.parse().unwrap(); for r in gap::Record::all(&model, &train[0]).iter().take(1) { let m = &r.motion; println!("# {:?} step {}", train[0].source, m.step()); for i in 0..m.rows() { println!("{} {} {} {} {} {} {} {}", m.t[i], m.q[j][i], m.qd[j][i], m.senses[j][i], m.gear[j][i], r.modelled[j][i], r.measured[j][i], r.moves(j, i) as u8); } } return; }
        if let Ok(c) = std::env::var("JP_FX") { let v: Vec<&str> = c.split(':').collect(); let e = arm::effects::find(v[0]).unwrap(); let j: usize = v[1].parse().unwrap(); let vals: Vec<f64> = v[2].split(',').map(|x| x.parse().unwrap()).collect();
            for r in gap::Record::all(&model, &train[0]).iter().take(1) { let m = &r.motion; let a = e.added(m, j, &vals); println!("# step {}", m.step()); for i in 0..m.rows() { println!("{} {} {} {} {} {} {} {}", m.t[i], m.q[j][i], m.qd[j][i], m.senses[j][i], m.gear[j][i], r.modelled[j][i], r.measured[j][i], a.iter().find(|x| x.0 == j).map_or(0.0, |x| x.1[i])); } } return; }
        let laps = std::cell::RefCell::new(vec![]);
        let t = std::time::Instant::now();
        let d = gap::diagnose_logs(&model, Logs { train: &a, held: &b, before: &c }, &settings, &|p| laps.borrow_mut().push((p.name(), (t.elapsed().as_secs_f64()*100.0).round()/100.0)));
        if let Ok(j) = std::env::var("JP_LEFT") { let j: usize = j.parse().unwrap(); for r in gap::Record::all(&d.improved.applied, if std::env::var("ON_HELD").is_ok() { &held[0] } else { &train[0] }).iter().take(1) { let m = &r.motion; for i in 0..m.rows() { println!("{} {} {} {} {} {} {} {}", m.t[i], m.q[j][i], m.qd[j][i], m.qd[(j+1)%6][i], m.qdd[j][i], r.modelled[j][i], r.measured[j][i], r.moves(j, i) as u8); } } return; }
        let n = d.shrink.joints.len();
        println!("{}", json!({"case": dir, "verdict": d.verdict.name(), "effects": d.effects.iter().map(finding).collect::<Vec<_>>(), "candidates": d.candidates.iter().map(finding).collect::<Vec<_>>(),
          "everyday": d.everyday.iter().map(|x| (x*1e4).round()/100.0).collect::<Vec<_>>(), "remainder": d.remainder.iter().map(|r| format!("{} J{} {:.3}", r.id, r.joint+1, r.share)).collect::<Vec<_>>(),
          "failed": d.trail.iter().filter(|e| !e.passed).map(|e| format!("{} {:?} {:.3} {:.3}", e.hypothesis, e.gate, e.value, e.limit)).collect::<Vec<_>>(),
          "gap": d.shrink.joints.iter().map(|j| [j.torque, j.noise, j.model, j.refit, j.refit_plus_effect].map(|x| (x*1e4).round()/1e4)).collect::<Vec<_>>(),
          "shrink": [d.shrink.total.value, d.shrink.total.low, d.shrink.total.high, d.shrink.by_effect.value], "where": d.places.iter().filter(|p| p.regime == "all").map(|p| (p.joint.map(|j| j+1), (p.share*100.0).round())).collect::<Vec<_>>(),
          "gates": d.trail.iter().filter(|e| matches!(e.gate, gap::Gate::HeldOut)).map(|e| format!("{} {:.3}", e.hypothesis, e.value)).collect::<Vec<_>>(), "before": d.before.iter().map(finding).collect::<Vec<_>>(), "reasons": d.reasons, "read": t1, "t": t.elapsed().as_secs_f64(), "counts": COUNTS.lock().unwrap().iter().map(|(k,v)| format!("{k} {v:.2}")).collect::<Vec<_>>(), "laps": *laps.borrow()}));
    }
}

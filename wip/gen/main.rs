use serde_json::json;
macro_rules! write_case { ($c:expr, $dir:expr) => {{ let c = $c; std::fs::create_dir_all(&$dir).unwrap();
  for (n, t) in &c.files { let p = format!("{}/{n}", $dir); std::fs::create_dir_all(std::path::Path::new(&p).parent().unwrap()).unwrap(); std::fs::write(format!("{}/{n}", $dir), t).unwrap(); }
  std::fs::write(format!("{}/case.json", $dir), c.options.to_string()).unwrap();
  std::fs::write(format!("{}/truth.json", $dir), json!({"kind": c.kind, "effects": c.effects, "place": c.place, "lines": c.lines, "heldout": c.heldout}).to_string()).unwrap(); }}; }
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (w, seed, from, to, out) = (a[1].as_str(), a[2].parse::<u64>().unwrap(), a[3].parse::<usize>().unwrap(), a[4].parse::<usize>().unwrap(), a[5].clone());
    for n in from..to { let dir = format!("{out}/case{n:04}");
        match w { "one" => write_case!(worldone::case(seed, n), dir), "two" => write_case!(worldtwo::case(seed, n), dir), _ => write_case!(worldthree::case(seed, n), dir) } }
}

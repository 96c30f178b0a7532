//! tmp
use granular_core::glam::DVec2;
use granular_core::Solver;
use granular_dem::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let steps: u64 = args[2].parse().unwrap();
    let threads: usize = args[3].parse().unwrap();
    let skin: f64 = args.get(4).map_or(0.25, |s| s.parse().unwrap());
    let mut materials = Materials::new();
    let m = Material { restitution: 0.75, damping_ratio: 0.0, ..Material::default() };
    let glass = materials.add(m).unwrap();
    let grains: Vec<_> = text.lines().map(|l| { let v: Vec<f64> = l.split_whitespace().map(|x| x.parse().unwrap()).collect();
        if v.len()==3 { Grain::at(DVec2::new(v[0], v[1]), v[2], glass) } else {
        Grain::at(DVec2::new(v[0], v[1]), v[5], glass).moving(DVec2::new(v[2], v[3])).turning(v[4]) }}).collect();
    let walls = vec![Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap(), Wall::plane("left", DVec2::ZERO, DVec2::X, glass).unwrap()];
    let n = grains.len();
    let ledger = args.get(5).is_some();
    let mut dem = Dem2::new(Setup { materials, grains, walls, gravity: DVec2::new(0.0, -9.81), options: Options { skin, ledger, ..Options::default() } }).unwrap();
    let dt = 92.5e-6 / args.get(7).map_or(50.0, |s| s.parse::<f64>().unwrap());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        dem.advance(dt, 200).unwrap();
        let t = std::time::Instant::now();
        dem.advance(dt, steps).unwrap();
        let s = t.elapsed().as_secs_f64();
        if let Some(path) = args.get(6) { let mut t = String::new(); for (_, g) in dem.grains() { t += &format!("{:.12e} {:.12e} {:.12e}\n", g.position.x, g.position.y, g.radius); } std::fs::write(path, t).unwrap(); }
        println!("N={n} threads={threads} skin={skin} rate={:.3e} front={:.5} bytes/grain {} residual {:?}", n as f64 * steps as f64 / s, dem.reach(0), dem.memory().bytes_per_item, dem.energy_residual().map(|r| r / dem.energies().potential));
    });
}

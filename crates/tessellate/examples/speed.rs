//! Speed.
use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain};
use std::time::Instant;
fn main() {
    for n in std::env::args().nth(1).map(|a| vec![a.parse::<usize>().unwrap()]).unwrap_or(vec![1000usize, 10000, 100000, 1000000]) {
        let mut s = 1u64;
        let mut unit = || {
            s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (s >> 11) as f64 / (1u64 << 53) as f64
        };
        let l = 1.0 / (n as f64).sqrt();
        let p: Vec<DVec2> = (0..n).map(|_| DVec2::new(unit(), unit())).collect();
        let r: Vec<f64> = (0..n).map(|_| l * (0.2 + 0.3 * unit())).collect();
        let dom = Domain::rectangle(DVec2::ZERO, DVec2::ONE).unwrap();
        for _ in 0..10 {
            let t = Instant::now();
            let d = Diagram::new(&p, &r).unwrap();
            let a = t.elapsed().as_secs_f64();
            let c = d.cells(&dom);
            let b = t.elapsed().as_secs_f64();
            println!(
                "{n} {:.0} sites/s diagram, {:.0} with cells, sum-1 {:e}",
                n as f64 / a,
                n as f64 / b,
                c.areas().iter().sum::<f64>() - 1.0
            );
        }
    }
    let n = 100usize;
    for sp in [1.0, 0.1] {
        let p: Vec<DVec2> = (0..n * n).map(|k| DVec2::new((k % n) as f64, (k / n) as f64) * sp).collect();
        let t = Instant::now();
        let d = Diagram::new(&p, &vec![0.0; n * n]).unwrap();
        println!(
            "lattice {sp}: {:.0} sites/s, {}",
            (n * n) as f64 / t.elapsed().as_secs_f64(),
            d.vertices().len()
        );
    }
}

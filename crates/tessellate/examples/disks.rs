//! The cells of random disks, some hidden, with their densities; draws them to a file.
//!
//! ```text
//! cargo run -p granular-tessellate --example disks -- cells.svg
//! ```

use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain, FREE_SURFACE, bulk_density, local_densities};
use std::fmt::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A low-discrepancy sequence: fractions of multiples of the golden ratio and its square.
    let fraction = |k: u32, by: f64| (f64::from(k) * by).fract();
    let centres: Vec<DVec2> =
        (1..=60).map(|k| DVec2::new(fraction(k, 0.754_877_666), fraction(k, 0.569_840_291))).collect();
    let radii: Vec<f64> = (1..=60).map(|k| 0.02 + 0.1 * fraction(k, 0.618_033_989).powi(3)).collect();

    let diagram = Diagram::new(&centres, &radii)?;
    let domain = Domain::rectangle(DVec2::ZERO, DVec2::ONE)?;
    let cells = diagram.cells(&domain);
    let densities = local_densities(&radii, cells.areas());
    for (site, density) in densities.iter().enumerate().take(5) {
        let area = cells.areas()[site];
        println!(
            "disk {site}: cell {area:.5}, density {density:.3}, neighbours {:?}",
            cells.neighbours(site)
        );
    }
    let hidden = (0..diagram.len()).filter(|&site| diagram.hidden_by(site).is_some()).count();
    println!("{hidden} hidden; areas sum to {:.15}", cells.areas().iter().sum::<f64>());
    if let Some(bulk) = bulk_density(&radii, cells.areas(), FREE_SURFACE) {
        println!("bulk density {:.4} of {} cells", bulk.density, bulk.cells);
    }

    if let Some(path) = std::env::args().nth(1) {
        let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\">\n");
        for (centre, radius) in centres.iter().zip(&radii) {
            writeln!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\" fill=\"#ccc\"/>", centre.x, centre.y)?;
        }
        for side in (0..diagram.len()).flat_map(|site| cells.boundary(site)).flatten() {
            let points = (0..=16).map(|k| side.point(f64::from(k) / 16.0));
            let points: Vec<String> = points.map(|point| format!("{:.5},{:.5}", point.x, point.y)).collect();
            writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"black\" stroke-width=\"0.002\"/>",
                points.join(" ")
            )?;
        }
        std::fs::write(path, svg + "</svg>\n")?;
    }
    Ok(())
}

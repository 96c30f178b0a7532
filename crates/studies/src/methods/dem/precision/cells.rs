//! Areas of Voronoi cells: error against run time of a raster, of exact cells, and of an estimate from a grid.

use crate::bench::study::{Point, Study};
use crate::methods::tessellate::speed::Disks;
use granular_core::glam::DVec2;
use granular_core::{D2, Dim};
use granular_dem::{CoarseGrid, Dem, Grain, Material, Materials, Options, Setup};
use granular_driver::failure::Failure;
use granular_driver::statistics::{median, order};
use granular_tessellate::{Diagram, Domain};
use std::collections::BTreeMap;
use std::time::Instant;

/// Disks of the sample.
const DISKS: usize = 2000;
/// Points of the raster to a spacing of the disks. None divides another.
const RASTERS: [f64; 6] = [3.1, 6.7, 13.3, 27.1, 53.9, 107.3];
/// Scale of the kernel of the grid over the spacing of the disks.
const KERNELS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
/// Runs that the wall time is the median of.
const ROUNDS: usize = 5;

pub(super) fn study() -> Result<Study, Failure> {
    let disks = Disks::packed(DISKS);
    let domain = Domain::rectangle(DVec2::ZERO, DVec2::ONE)?;
    let exact = areas(&disks, &domain)?;
    // Disks at the border are left out: a grid knows no walls.
    let inner: Vec<usize> = (0..DISKS).filter(|&k| depth(disks.centres[k]) > 0.15).collect();
    let error = |found: &[f64]| {
        let squares = inner.iter().map(|&k| (found[k] / exact[k] - 1.0).powi(2));
        (squares.sum::<f64>() / inner.len() as f64).sqrt()
    };
    let point = |scheme: &str, resolution: f64, (seconds, found): (f64, Vec<f64>)| {
        let error = error(&found);
        let scheme = scheme.to_owned();
        Point {
            problem: String::new(),
            scheme,
            resolution,
            dt: f64::NAN,
            error,
            band: 0.0,
            seeds: 1,
            seconds,
            pareto: false,
        }
    };
    let mut points = Vec::new();
    for resolution in RASTERS {
        points.push(point("raster", resolution, timed(|| Ok(raster(&disks, resolution)))?));
    }
    // Against the same diagram turned by an angle: what rounding does.
    points.push(point("exact cells", 1.0, timed(|| turned(&disks))?));
    let dem = grains(&disks);
    for kernel in KERNELS {
        points.push(point("grid estimate", kernel, timed(|| Ok(on_grid(&dem, &disks, kernel)))?));
    }
    let of_raster: Vec<(f64, f64)> =
        points.iter().filter(|p| p.scheme == "raster").map(|p| (1.0 / p.resolution, p.error)).collect();
    let orders = BTreeMap::from([("raster".to_owned(), order(&of_raster))]);
    let notes = vec![
        format!("{DISKS} graded disks that do not overlap; root mean square of the relative error of the {} cells \
             that are 0.15 of the side or more from the border", inner.len()),
        "raster: points to a spacing, each given to the nearest disk; grid estimate: area of the disk over the \
         solid fraction at its centre, scale of the kernel over the spacing: a mean over neighbours, so it does not \
         converge to single cells"
            .to_owned(),
        "exact cells: against the same diagram turned by an angle, which leaves rounding only".to_owned(),
        format!("wall time of all cells on one thread, median of {ROUNDS}"),
    ];
    let error = "relative error of the area of a cell [-]";
    let resolution = "points per spacing";
    Ok(Study { case: "cells", error, resolution, points, orders, notes }.mark_front())
}

/// Distance to the border of the unit square.
fn depth(p: DVec2) -> f64 {
    p.min(DVec2::ONE - p).min_element()
}

/// Wall time and result.
fn timed(run: impl Fn() -> Result<Vec<f64>, Failure>) -> Result<(f64, Vec<f64>), Failure> {
    let mut seconds = Vec::new();
    let mut found = Vec::new();
    for _ in 0..ROUNDS {
        let begun = Instant::now();
        found = run()?;
        seconds.push(begun.elapsed().as_secs_f64());
    }
    Ok((median(seconds), found))
}

fn areas(disks: &Disks, domain: &Domain) -> Result<Vec<f64>, Failure> {
    Ok(Diagram::new(&disks.centres, &disks.radii)?.cells(domain).areas().to_vec())
}

/// Areas of the diagram turned about the origin.
fn turned(disks: &Disks) -> Result<Vec<f64>, Failure> {
    let turn = |p: DVec2| DVec2::from_angle(0.7).rotate(p);
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(turn);
    let centres: Vec<DVec2> = disks.centres.iter().map(|&p| turn(p)).collect();
    let diagram = Diagram::new(&centres, &disks.radii)?;
    Ok(diagram.cells(&Domain::polygon(&corners)?).areas().to_vec())
}

/// Areas by points of a raster, each given to the disk that is nearest by its weighted distance.
fn raster(disks: &Disks, resolution: f64) -> Vec<f64> {
    let side = (resolution / disks.spacing).round() as usize;
    let pixel = 1.0 / side as f64;
    // No point of a cell in such a packing is further away from its disk.
    let reach = 1.5 * disks.spacing;
    let mut nearest = vec![(f64::INFINITY, 0); side * side];
    for (site, (&centre, &radius)) in disks.centres.iter().zip(&disks.radii).enumerate() {
        let range = |at: f64| {
            let place = |x: f64| ((x / pixel).round() as usize).min(side);
            place(at - reach)..place(at + reach)
        };
        for row in range(centre.y) {
            for column in range(centre.x) {
                let point = (DVec2::new(column as f64, row as f64) + 0.5) * pixel;
                let distance = (point - centre).length() - radius;
                let best = &mut nearest[row * side + column];
                if distance < best.0 {
                    *best = (distance, site);
                }
            }
        }
    }
    let mut areas = vec![0.0; disks.centres.len()];
    nearest.iter().for_each(|&(_, site)| areas[site] += pixel * pixel);
    areas
}

const FITS: &str = "the sample is in range";

fn grains(disks: &Disks) -> Dem<D2> {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).expect(FITS);
    let grain = |(&centre, &radius): (&DVec2, &f64)| Grain::at(centre, radius, glass);
    let grains = disks.centres.iter().zip(&disks.radii).map(grain).collect();
    let (gravity, options) = (DVec2::ZERO, Options::default());
    Dem::new(Setup { materials, grains, walls: Vec::new(), gravity, options }).expect(FITS)
}

/// Areas of disks over the solid fraction of the cell of a grid in which their centre lies.
fn on_grid(dem: &Dem<D2>, disks: &Disks, kernel: f64) -> Vec<f64> {
    let spacing = kernel * disks.spacing;
    let margin = DVec2::splat(4.0 * spacing);
    let grid = CoarseGrid::<D2>::new(-margin, DVec2::ONE + margin, spacing, 1).expect(FITS);
    let fields = dem.coarse_fields(&grid);
    let [columns, ..] = grid.cells();
    let density = Material::default().density;
    let area = |(&centre, &radius): (&DVec2, &f64)| {
        let place = ((centre + margin) / spacing).floor();
        let solid = fields.density()[place.y as usize * columns + place.x as usize] / density;
        D2::ball_volume(radius) / solid
    };
    disks.centres.iter().zip(&disks.radii).map(area).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_raster_comes_near_to_exact_cells() {
        let disks = Disks::packed(100);
        let exact = areas(&disks, &Domain::rectangle(DVec2::ZERO, DVec2::ONE).unwrap()).unwrap();
        let worst =
            |found: Vec<f64>| found.iter().zip(&exact).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        let [coarse, fine] = [10.0, 60.0].map(|resolution| worst(raster(&disks, resolution)));
        assert!(fine < 0.3 * coarse && fine < 0.01, "{coarse} {fine}");
        assert!(worst(turned(&disks).unwrap()) < 1e-11);
        let share: f64 = disks.radii.iter().map(|r| PI * r * r).sum();
        assert!(share > 0.5);
    }
}

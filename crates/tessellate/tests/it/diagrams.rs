//! Diagrams with known cells, and random ones against brute force.

use crate::support::{Random, distance, unit_square, violation};
use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain, bulk_density, encloses};

fn sites(count: usize, largest: f64, random: &mut Random) -> (Vec<DVec2>, Vec<f64>) {
    (0..count).map(|_| (random.point(), largest * random.unit())).unzip()
}

#[test]
fn two_disks_share_a_box_along_a_hyperbola() {
    let domain = Domain::rectangle(DVec2::splat(-2.0), DVec2::splat(2.0)).unwrap();
    let centres = [DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0)];
    let equal = Diagram::new(&centres, &[0.3, 0.3]).unwrap();
    assert_eq!(equal.cells(&domain).areas(), [8.0, 8.0]);
    let unequal = Diagram::new(&centres, &[0.5, 0.1]).unwrap();
    let edge = unequal.edges().next().unwrap();
    assert!((edge.curve.point(0.0) - DVec2::new(0.2, 0.0)).length() < 1e-15);
    // x = 0.2 sqrt(1 + y^2 / 0.96): 8 and twice the integral over 0..2.
    let (a, b) = (0.2, 0.96_f64.sqrt());
    let y = 2.0 / b;
    let beyond = a * b * (y * (1.0 + y * y).sqrt() + y.asinh());
    let areas = unequal.cells(&domain).areas().to_vec();
    assert!((areas[0] - 8.0 - beyond).abs() < 1e-14, "{areas:?}");
    assert!((areas[0] + areas[1] - 16.0).abs() < 1e-14);
}

#[test]
fn hidden_and_touching_disks_have_no_cell() {
    let centres = [DVec2::ZERO, DVec2::new(0.3, 0.0), DVec2::new(0.5, 0.0), DVec2::ZERO];
    let diagram = Diagram::new(&centres, &[1.0, 0.5, 0.5, 1.0]).unwrap();
    let hidden: Vec<_> = (0..4).map(|site| diagram.hidden_by(site)).collect();
    assert_eq!(hidden, [None, Some(0), Some(0), Some(0)]);
}

#[test]
fn random_diagrams_obey_the_definition() {
    let domain = unit_square();
    for seed in 0..300 {
        let mut random = Random(seed);
        let count = 1 + random.below(60);
        let largest = [0.0, 1e-3, 0.05, 0.3, 1.0][seed as usize % 5];
        let (positions, radii) = sites(count, largest, &mut random);
        let diagram = Diagram::new(&positions, &radii).unwrap();
        assert_eq!(violation(&diagram, &domain, 1e-12), None, "seed {seed}, {count} sites");
    }
}

#[test]
fn points_lie_in_the_cell_of_the_nearest_disk() {
    let domain = unit_square();
    let mut count = 0;
    for seed in 0..60 {
        let mut random = Random(1000 + seed);
        let (positions, radii) = sites(12, [0.02, 0.2, 0.6][seed as usize % 3], &mut random);
        let diagram = Diagram::new(&positions, &radii).unwrap();
        let cells = diagram.cells(&domain);
        let boundaries: Vec<_> = (0..12).map(|site| cells.boundary(site)).collect();
        for _ in 0..300 {
            let point = random.point();
            let nearest = diagram.nearest(point);
            let least = distance(&diagram, nearest, point);
            let others = (0..12).filter(|&other| other != nearest);
            // At a border rounding decides.
            if others.map(|other| distance(&diagram, other, point) - least).all(|margin| margin > 1e-12) {
                count += 1;
                for (site, boundary) in boundaries.iter().enumerate() {
                    assert_eq!(encloses(boundary, point), site == nearest, "{seed} {site} {point}");
                }
            }
        }
    }
    assert!(count > 17_000, "{count}");
}

#[test]
fn domains_may_be_polygons_and_sites_may_lie_outside() {
    let corners: Vec<DVec2> = (0..7).map(|k| DVec2::from_angle(f64::from(k) * 0.9)).collect();
    let domain = Domain::polygon(&corners).unwrap();
    for seed in 0..100 {
        let mut random = Random(seed);
        let count = 1 + random.below(40);
        let (mut positions, radii) = sites(count, 0.4, &mut random);
        positions.iter_mut().for_each(|position| *position = (*position - 0.5) * 6.0);
        let diagram = Diagram::new(&positions, &radii).unwrap();
        assert_eq!(violation(&diagram, &domain, 1e-12), None, "seed {seed}, {count} sites");
    }
    let clockwise: Vec<DVec2> = corners.iter().rev().copied().collect();
    assert!(Domain::polygon(&clockwise).unwrap_err().to_string().contains("counter-clockwise"));
    let star: Vec<DVec2> =
        (0..5).map(|k| DVec2::from_angle(f64::from(k) * 2.0 * 1.256_637_061_435_917)).collect();
    assert!(Domain::polygon(&star).is_err());
}

#[test]
fn bad_input_is_refused_by_name() {
    let centres = [DVec2::ZERO, DVec2::new(f64::NAN, 0.0)];
    let says = |positions: &[DVec2], radii: &[f64]| Diagram::new(positions, radii).unwrap_err().to_string();
    assert!(says(&[], &[]).contains("number of sites is 0"));
    assert!(says(&centres, &[1.0]).contains("number of radii is 1"));
    assert!(says(&centres, &[1.0, 1.0]).contains("x of site 1 is NaN"));
    assert!(says(&centres[..1], &[f64::INFINITY]).contains("radius of site 0 is inf"));
}

#[test]
fn bulk_density_leaves_out_the_free_surface() {
    // Ten compact cells and two that are open to the air.
    let radii = [0.5; 12];
    let mut areas = vec![1.0; 10];
    areas.extend([4.0, 30.0]);
    let bulk = bulk_density(&radii, &areas, 2.0).unwrap();
    assert!((bulk.density - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    assert_eq!(bulk.cells, 10);
    assert_eq!(bulk_density(&radii, &areas, 1e3).unwrap().cells, 12);
    assert_eq!(bulk_density(&radii, &[0.0; 12], 2.0), None);
}

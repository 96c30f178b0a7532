//! Cells in a periodic plane.

use crate::support::Random;
use granular_core::glam::DVec2;
use granular_tessellate::periodic_areas;
use std::f64::consts::PI;

#[test]
fn one_disk_owns_its_period() {
    // However flat or sheared: its own images are enough.
    for edges in [[DVec2::X, DVec2::Y], [DVec2::new(3.0, 0.1), DVec2::new(-1.0, 0.02)]] {
        let areas = periodic_areas(&[DVec2::new(7.3, -2.0)], &[0.3], edges).unwrap();
        assert!((areas[0] - edges[0].perp_dot(edges[1])).abs() < 1e-12);
    }
}

#[test]
fn a_hexagonal_lattice_has_the_density_of_closest_packing() {
    let (across, up, radius) = (6, 4, 0.01);
    let rise = 3f64.sqrt() * radius;
    let edges = [DVec2::new(2.0 * radius * f64::from(across), 0.0), DVec2::new(0.0, rise * f64::from(up))];
    let place = |k: i32| {
        let (column, row) = (k % across, k / across);
        DVec2::new(radius * f64::from(2 * column + row % 2), rise * f64::from(row))
    };
    let positions: Vec<DVec2> = (0..across * up).map(place).collect();
    for area in periodic_areas(&positions, &vec![radius; positions.len()], edges).unwrap() {
        assert!((PI * radius * radius / area - PI / (2.0 * 3f64.sqrt())).abs() < 1e-12);
    }
}

#[test]
fn shifts_and_other_edges_of_one_lattice_change_nothing() {
    let mut random = Random(3);
    for count in [1, 2, 7, 60] {
        let positions: Vec<DVec2> = (0..count).map(|_| random.point()).collect();
        let radii: Vec<f64> = (0..count).map(|_| 0.2 * random.unit()).collect();
        let areas = periodic_areas(&positions, &radii, [DVec2::X, DVec2::Y]).unwrap();
        assert!((areas.iter().sum::<f64>() - 1.0).abs() < 1e-11);
        let moved: Vec<DVec2> = positions.iter().map(|&p| p + DVec2::new(-3.21, 0.77)).collect();
        // The plane repeats along the sheared edge too.
        let again = periodic_areas(&moved, &radii, [DVec2::X, DVec2::new(2.0, 1.0)]).unwrap();
        for (a, b) in areas.iter().zip(again) {
            assert!((a - b).abs() < 1e-12, "{count}: {a} {b}");
        }
    }
}

#[test]
fn bad_input_is_refused_by_its_own_number() {
    let says = |positions: &[DVec2], edges: [DVec2; 2]| {
        periodic_areas(positions, &vec![0.1; positions.len()], edges).unwrap_err().to_string()
    };
    let edges = [DVec2::X, DVec2::Y];
    assert!(says(&[], edges).contains("number of sites is 0"));
    assert!(says(&[DVec2::ZERO, DVec2::new(0.0, f64::NAN)], edges).contains("y of site 1 is NaN"));
    assert!(says(&[DVec2::ZERO], [DVec2::Y, DVec2::X]).contains("counter-clockwise"));
}

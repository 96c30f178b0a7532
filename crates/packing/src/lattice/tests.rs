use super::*;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Linear};
use std::f64::consts::PI;

fn closest<D: Dim>(centres: &[D::Vec]) -> f64 {
    let mut closest = f64::INFINITY;
    for (index, &a) in centres.iter().enumerate() {
        for &b in &centres[..index] {
            closest = closest.min((a - b).length());
        }
    }
    closest
}

/// Neighbours that touch the ball nearest to the middle of the box.
fn touching<D: Dim>(centres: &[D::Vec], middle: D::Vec, radius: f64) -> usize {
    let inner = centres
        .iter()
        .min_by(|a, b| (**a - middle).length().total_cmp(&(**b - middle).length()))
        .copied()
        .unwrap();
    centres.iter().filter(|&&c| ((c - inner).length() - 2.0 * radius).abs() < 1e-9 * radius).count()
}

#[test]
fn densities_are_the_known_ones() {
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} {b}");
    close(Lattice::Cubic.density::<D2>(), PI / 4.0);
    close(Lattice::Cubic.density::<D3>(), PI / 6.0);
    close(Lattice::Hexagonal.density::<D2>(), PI / (2.0 * 3.0_f64.sqrt()));
    close(Lattice::Hexagonal.density::<D3>(), PI / (3.0 * 2.0_f64.sqrt()));
    assert!((Lattice::Hexagonal.density::<D2>() - 0.906_899_682_1).abs() < 1e-10);
}

#[test]
fn neighbours_touch_and_never_overlap() {
    let radius = 0.7e-3;
    for (lattice, plane, space) in [(Lattice::Cubic, 4, 6), (Lattice::Hexagonal, 6, 12)] {
        let high = DVec2::new(20.0, 15.0) * radius;
        let centres = lattice.fill::<D2>(radius, DVec2::ZERO, high).unwrap();
        assert!((closest::<D2>(&centres) / radius - 2.0).abs() < 1e-12);
        assert_eq!(touching::<D2>(&centres, high * 0.5, radius), plane);
        let high = DVec3::new(13.0, 12.0, 11.0) * radius;
        let centres = lattice.fill::<D3>(radius, DVec3::ZERO, high).unwrap();
        assert!((closest::<D3>(&centres) / radius - 2.0).abs() < 1e-12);
        assert_eq!(touching::<D3>(&centres, high * 0.5, radius), space);
    }
}

#[test]
fn balls_lie_inside_and_fill_a_large_box() {
    let (low, high) = (DVec3::new(-1.0, 2.0, 3.0), DVec3::new(99.0, 102.0, 103.0));
    for lattice in [Lattice::Cubic, Lattice::Hexagonal] {
        let centres = lattice.fill::<D3>(1.0, low, high).unwrap();
        let inside = |c: &DVec3| c.cmpge(low + 1.0 - 1e-9).all() && c.cmple(high - 1.0 + 1e-9).all();
        assert!(centres.iter().all(inside));
        let density = centres.len() as f64 * D3::ball_volume(1.0) / 1e6;
        // Faces cost at most one layer of 50 along each axis.
        assert!(
            density <= lattice.density::<D3>() + 1e-12 && density > 0.94 * lattice.density::<D3>(),
            "{density}"
        );
    }
}

#[test]
fn round_off_does_not_cost_a_layer() {
    for count in 1..60 {
        let edge = 0.2 * f64::from(count);
        let centres = Lattice::Cubic.fill::<D2>(0.1, DVec2::ZERO, DVec2::splat(edge)).unwrap();
        assert_eq!(centres.len() as i32, count * count);
    }
    // A hexagonal box of the exact size: rows of 10 and 9 in turn.
    let high = DVec2::new(20.0, 2.0 + 3.0 * 3.0_f64.sqrt());
    assert_eq!(Lattice::Hexagonal.fill::<D2>(1.0, DVec2::ZERO, high).unwrap().len(), 38);
}

#[test]
fn boxes_without_room_are_refused() {
    let fill = |radius, edge| Lattice::Cubic.fill::<D2>(radius, DVec2::ZERO, DVec2::new(10.0, edge));
    assert!(fill(1.0, 1.9).unwrap_err().to_string().contains("edge of the box [m] is 1.9"));
    for (radius, edge) in [(0.0, 1.0), (f64::NAN, 1.0), (1.0, f64::NAN), (1.0, f64::INFINITY), (1e-6, 10.0)] {
        assert!(fill(radius, edge).is_err());
    }
}

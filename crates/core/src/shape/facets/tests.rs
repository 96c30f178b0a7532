use super::*;
use crate::dim::D3;
use glam::DVec3;

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 * 2.0_f64.powi(-53) - 0.5
}

fn point(state: &mut u64) -> DVec3 {
    DVec3::new(random(state), random(state), random(state))
}

#[test]
fn the_nearest_point_of_a_triangle_is_that_of_a_fine_raster() {
    let mut state = 7;
    for _ in 0..50 {
        let [a, b, c, x] = std::array::from_fn(|_| point(&mut state));
        let exact = (x - nearest_on_triangle::<D3>(a, b, c, x)).length();
        let mut raster = f64::INFINITY;
        for i in 0..=200 {
            for j in 0..=(200 - i) {
                let (u, v) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
                raster = raster.min((x - (a + (b - a) * u + (c - a) * v)).length());
            }
        }
        assert!(exact <= raster + 1e-12 && raster < exact + 0.01, "{exact} {raster}");
    }
}

#[test]
fn the_tree_finds_what_a_search_of_all_parts_finds() {
    let mut state = 3;
    let corners: Vec<DVec3> = (0..300)
        .flat_map(|_| {
            let at = point(&mut state);
            std::array::from_fn::<_, 3, _>(|_| at + point(&mut state) * 0.1)
        })
        .collect();
    let facets = Facets::<D3>::new(corners, 3).unwrap();
    for _ in 0..100 {
        let x = point(&mut state);
        let nearest =
            (0..facets.len()).map(|part| facets.distance_to(part, x).0).fold(f64::INFINITY, f64::min);
        assert_eq!(facets.distance(x).0, nearest);
        let mut found = Vec::new();
        facets.visit_near(x, 0.2, |part| found.push(part as usize));
        let near = (0..facets.len()).filter(|&part| facets.distance_to(part, x).0 < 0.2);
        assert!(near.clone().count() > 0 && near.into_iter().all(|part| found.contains(&part)));
    }
}

#[test]
fn what_is_no_surface_is_refused() {
    assert!(Facets::<D3>::new(vec![], 3).is_err());
    assert!(Facets::<D3>::new(vec![DVec3::ONE; 3], 3).is_err());
    assert!(Facets::<D3>::new(vec![DVec3::X, DVec3::NAN, DVec3::Y], 3).is_err());
    assert!(Facets::<D3>::balls(&[(DVec3::ZERO, 0.0)]).is_err());
    // A sliver is not: scanned meshes have some.
    let sliver = Facets::<D3>::new(vec![DVec3::ZERO, DVec3::X, DVec3::X * 0.5], 3).unwrap();
    assert!((sliver.distance(DVec3::new(0.7, 0.0, 2.0)).0 - 2.0).abs() < 1e-15);
}

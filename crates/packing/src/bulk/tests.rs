use super::*;
use crate::Lattice;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3};

fn lattice<D: Dim>(high: D::Vec) -> Bulk {
    let sites = Lattice::Cubic.fill::<D>(0.5, D::Vec::ZERO, high).unwrap();
    Bulk::of::<D>(&sites, &vec![0.5; sites.len()]).unwrap()
}

#[test]
fn a_square_lattice_has_its_density() {
    // 20 by 15 unit disks: cells of 2.5 cut disks through the middle, and 15 x 2.5 by 10 tile it.
    let bulk = lattice::<D2>(DVec2::new(20.0, 15.0));
    assert_eq!(bulk.bands.len(), 4);
    let density = core::f64::consts::FRAC_PI_4;
    assert!((bulk.solid_fraction().unwrap() - density).abs() < 1e-12, "{bulk:?}");
    // Bands of 2.5 layers begin in turn with half a disk and a gap: the same area by symmetry.
    assert!(bulk.homogeneity().unwrap() < 1e-20);
}

#[test]
fn a_cubic_lattice_has_its_density() {
    let bulk = lattice::<D3>(DVec3::new(10.0, 15.0, 10.0));
    assert_eq!(bulk.bands.len(), 2);
    let density = core::f64::consts::PI / 6.0;
    assert!((bulk.solid_fraction().unwrap() - density).abs() < 1e-9, "{bulk:?}");
}

#[test]
fn a_slope_has_a_bulk_below_its_surface() {
    let sites: Vec<DVec2> = Lattice::Cubic
        .fill::<D2>(0.5, DVec2::ZERO, DVec2::new(40.0, 20.0))
        .unwrap()
        .into_iter()
        .filter(|site| site.y < 20.0 - 0.5 * site.x)
        .collect();
    let bulk = Bulk::of::<D2>(&sites, &vec![0.5; sites.len()]).unwrap();
    let [first, last] = [bulk.bands[0][1], bulk.bands[bulk.bands.len() - 1][1]];
    assert!(bulk.bands.len() > 3 && last < first, "{bulk:?}");
    // No cell holds the empty space above the slope.
    assert!(bulk.bands.iter().all(|[solid, volume]| solid / volume > 0.7), "{bulk:?}");
}

#[test]
fn a_handful_has_no_bulk() {
    let bulk = lattice::<D2>(DVec2::new(4.0, 4.0));
    assert_eq!((bulk.solid_fraction(), bulk.homogeneity()), (None, None));
    assert!(Bulk::of::<D2>(&[], &[]).is_err());
}

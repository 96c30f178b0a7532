use super::*;
use crate::material::Material;
use granular_core::D2;
use granular_core::glam::DVec2;

/// Grains that creep need no long lists.
#[test]
fn lists_are_cut_short_for_slow_grains_with_and_without_a_cell() {
    for in_cell in [false, true] {
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        let grains =
            [2e-3, 7e-3].map(|x| Grain::at(DVec2::new(x, 5e-3), 1e-3, glass).moving(DVec2::Y * 1e-3));
        let setup = Setup {
            materials,
            grains: grains.to_vec(),
            walls: vec![],
            gravity: DVec2::ZERO,
            options: Options::default(),
        };
        let mut dem = Dem::<D2>::new(setup).unwrap();
        if in_cell {
            dem.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::splat(10e-3), &[true, true]).unwrap())
                .unwrap();
        }
        let longest = dem.reach;
        dem.advance(1e-7, 1).unwrap();
        assert!(dem.reach < 0.3 * longest, "{in_cell}: {} of {longest}", dem.reach);
    }
}

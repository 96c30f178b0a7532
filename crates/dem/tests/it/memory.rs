//! A scene pays for what it uses: arrays, bytes and the saved state.

use crate::sample::{Lattice, free};
use granular_core::{D2, D3, Dim, Section, Solver};
use granular_dem::{ContactModel, Dem, Elasticity, Material, Materials, Options};

/// Grains that touch nothing, so that lists hold no pairs.
fn apart<D: Dim>(material: Material, two_materials: bool) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let other = if two_materials { materials.add(material).unwrap() } else { glass };
    let lattice = Lattice { side: 8, spacing: 5e-3, ..Lattice::default() };
    free(materials, lattice.grains::<D>(&[glass, other]), Options::default())
}

fn smooth() -> Material {
    Material { friction: 0.0, ..Material::default() }
}

fn resisting() -> Material {
    Material { rolling_friction: 0.1, ..Material::default() }
}

fn bytes_of_entry<D: Dim>(dem: &Dem<D>, entry: &str) -> usize {
    let mut section = Section::new("solver");
    dem.save(&mut section);
    section.entries().find(|(name, _)| *name == entry).unwrap().1.len()
}

#[test]
fn disks_without_friction_neither_turn_nor_remember() {
    let dem = apart::<D2>(smooth(), false);
    assert!(!dem.turns());
    for entry in ["spin", "spin acceleration", "contact pairs", "contact memories", "material"] {
        assert_eq!(bytes_of_entry(&dem, entry), 0, "{entry}");
    }
    let left_out = dem.memory().left_out;
    for what in ["rotation", "contact history", "material per grain", "energy ledger", "third axis"] {
        assert!(left_out.iter().any(|text| text.starts_with(what)), "{what} in {left_out:?}");
    }
    let rough = apart::<D2>(Material::default(), false);
    assert!(rough.turns());
    assert_eq!(bytes_of_entry(&rough, "spin"), 64 * 8);
    let left_out = rough.memory().left_out;
    assert!(!left_out.iter().any(|text| text.starts_with("rotation") || text.contains("history")));
    assert!(!apart::<D3>(smooth(), false).memory().left_out.iter().any(|text| text.contains("axis")));
}

#[test]
fn bytes_per_grain_are_as_expected() {
    let bytes = |memory: granular_core::Memory| (memory.bytes_per_item, memory.bytes);
    // Position, velocity, acceleration and middle velocity, radius, mass, identifier: 4 x 16 + 20
    // in the plane, 4 x 24 + 20 in space; spin, its rate and middle: 3 x 8 or 3 x 24; material: 1.
    // The lists of 64 and 512 grains without pairs: where the partners of each start.
    let lists = |dem: usize, grains: usize| (dem / grains, dem);
    let (share, all) = lists(4 * 128, 64);
    assert_eq!(bytes(apart::<D2>(smooth(), false).memory()), (84 + share, 84 * 64 + all));
    assert_eq!(bytes(apart::<D2>(Material::default(), false).memory()), (108 + share, 108 * 64 + all));
    assert_eq!(bytes(apart::<D2>(resisting(), false).memory()), (108 + share, 108 * 64 + all));
    assert_eq!(bytes(apart::<D2>(Material::default(), true).memory()), (109 + share, 109 * 64 + all));
    let (share, all) = lists(4 * 4 * 256, 512);
    assert_eq!(bytes(apart::<D3>(smooth(), false).memory()), (116 + share, 116 * 512 + all));
    assert_eq!(bytes(apart::<D3>(Material::default(), false).memory()), (188 + share, 188 * 512 + all));
}

#[test]
fn one_contact_remembers_as_little_as_its_law_needs() {
    fn remembered<D: Dim>(material: Material) -> usize {
        remembered_by::<D>(material, ContactModel::Linear)
    }
    fn remembered_by<D: Dim>(material: Material, contact: ContactModel) -> usize {
        let mut materials = Materials::new();
        let glass = materials.add(material).unwrap();
        let lattice = Lattice { side: 6, ..Lattice::default() };
        let options = Options { contact, ..Options::default() };
        let mut dem = free::<D>(materials, lattice.grains(&[glass]), options);
        dem.advance(dem.recommended_step(), 10).unwrap();
        let pairs = bytes_of_entry(&dem, "contact pairs") / 8;
        bytes_of_entry(&dem, "contact memories").checked_div(pairs).unwrap_or(0)
    }
    assert_eq!([remembered::<D2>(smooth()), remembered::<D3>(smooth())], [0, 0]);
    let rough = Material::default();
    assert_eq!([remembered::<D2>(rough), remembered::<D3>(rough)], [8, 24]);
    assert_eq!([remembered::<D2>(resisting()), remembered::<D3>(resisting())], [16, 48]);
    // Disks cannot twist.
    let twisting = Material { twisting_friction: 0.1, ..resisting() };
    assert_eq!([remembered::<D2>(twisting), remembered::<D3>(twisting)], [16, 56]);
    assert!(apart::<D2>(twisting, false).memory().left_out.iter().any(|text| text.starts_with("twisting")));
    let elastic = |of: Material| Material {
        elasticity: Some(Elasticity { young_modulus: 5e10, poisson_ratio: 0.2 }),
        ..of
    };
    for (material, plane, space) in
        [(smooth(), 0, 0), (rough, 16, 32), (resisting(), 24, 56), (twisting, 24, 64)]
    {
        let bytes = [
            remembered_by::<D2>(elastic(material), ContactModel::Hertz),
            remembered_by::<D3>(elastic(material), ContactModel::Hertz),
        ];
        assert_eq!(bytes, [plane, space]);
    }
}

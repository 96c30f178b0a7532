//! Grains that come and go: none overlaps, none is lost silently, and the bits are the same.

use crate::sample::{Lattice, down};
use granular_core::glam::DVec2;
use granular_core::testing::{Breach, Contract};
use granular_core::{D2, Dim, Section, Solver};
use granular_dem::{Dem2, Inlet, Material, MaterialId, Materials, Options, Outlet, Setup, Wall};
use std::collections::BTreeSet;

fn inlet(material: MaterialId) -> Inlet<D2> {
    Inlet {
        name: "top".to_owned(),
        low: DVec2::new(2e-3, 30e-3),
        high: DVec2::new(12e-3, 36e-3),
        rate: 2e5,
        number: u64::MAX,
        radii: vec![0.4e-3, 0.5e-3, 0.6e-3],
        velocity: DVec2::new(0.0, -2.0),
        material,
        seed: 3,
        runs: true,
    }
}

/// A bed with grains of another material that come in above it; what flies out on top or to the right is taken.
fn fed(side: usize, friction: f64) -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(Material { friction, ..Material::default() }).unwrap();
    let steel = materials.add(Material { density: 7800.0, friction, ..Material::default() }).unwrap();
    let lattice = Lattice { side, ..Lattice::default() };
    let grains = if side == 0 { vec![] } else { lattice.grains::<D2>(&[glass]) };
    let walls = vec![
        Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap(),
        Wall::block("hood", DVec2::new(5e-3, 33e-3), DVec2::new(7e-3, 34e-3), glass).unwrap(),
    ];
    let options = Options { ledger: true, ..Options::default() };
    let mut dem = Dem2::new(Setup { materials, grains, walls, gravity: down::<D2>(9.81), options }).unwrap();
    dem.add_inlet(inlet(steel)).unwrap();
    dem.add_outlet(Outlet::Beyond { point: DVec2::new(24.2e-3, 0.0), normal: DVec2::X }).unwrap();
    dem.add_outlet(Outlet::Outside { low: DVec2::new(-0.3e-3, -1.0), high: DVec2::splat(1.0) }).unwrap();
    dem
}

fn contract() -> Contract {
    Contract::new(|| fed(24, 0.5), 1.5e-6).steps(350)
}

#[test]
fn same_bits_for_any_number_of_threads() -> Result<(), Breach> {
    contract().threads()
}

#[test]
fn same_bits_for_any_split_into_calls() -> Result<(), Breach> {
    contract().split()
}

#[test]
fn same_bits_after_a_restart() -> Result<(), Breach> {
    contract().restart()?;
    // Into a solver of other grains, and of none.
    Contract::new(|| fed(0, 0.0), 1.5e-6).steps(350).restart()
}

#[test]
fn a_damaged_section_is_refused() -> Result<(), Breach> {
    contract().damage()?;
    contract().not_finite()?;
    contract().bad_steps()
}

#[test]
fn all_is_shown_once_and_limits_can_be_used() -> Result<(), Breach> {
    contract().show()?;
    contract().limits()?;
    Contract::new(|| fed(0, 0.5), 1.5e-6).steps(350).limits()
}

#[test]
fn a_restart_takes_up_grains_that_came_and_went_since_the_scene_began() {
    let mut dem = fed(24, 0.5);
    dem.advance(1.5e-6, 1234).unwrap();
    let state = |dem: &Dem2| {
        let mut section = Section::new("solver");
        dem.save(&mut section);
        section
    };
    let mut restarted = fed(24, 0.5);
    restarted.restore(&state(&dem)).unwrap();
    for _ in 0..20 {
        dem.advance(1.5e-6, 77).unwrap();
        restarted.advance(1.5e-6, 77).unwrap();
        assert!(state(&dem) == state(&restarted), "step {}", dem.steps());
    }
    assert!(dem.exchanged().removed > 10 && dem.exchanged().inserted > 100, "{:?}", dem.exchanged());
}

#[test]
fn grains_come_at_the_rate_without_overlap_and_all_are_counted() {
    let mut dem = fed(24, 0.5);
    let mass = |dem: &Dem2| {
        let one =
            |material: MaterialId, radius| dem.materials().get(material).density * D2::ball_volume(radius);
        dem.grains().map(|(_, grain)| one(grain.material, grain.radius)).sum::<f64>()
    };
    let (start, number) = (mass(&dem), dem.len() as u64);
    let mut seen: BTreeSet<u32> = dem.grains().map(|(id, _)| id).collect();
    for _ in 0..40 {
        // Looks are at the start of steps 0, 100, 200 and so on.
        dem.advance(1.5e-6, 1).unwrap();
        let came: Vec<_> = dem.grains().filter(|(id, _)| !seen.contains(id)).collect();
        let ids: BTreeSet<u32> = dem.grains().map(|(id, _)| id).collect();
        assert_eq!(ids.len(), dem.len());
        seen.extend(ids);
        for (id, grain) in &came {
            let overlap = |other: &granular_dem::Grain<D2>| {
                grain.radius + other.radius - (grain.position - other.position).length()
            };
            let deepest = dem.grains().filter(|(other, _)| other != id).map(|(_, other)| overlap(&other));
            // What they moved in one step.
            assert!(deepest.fold(0.0, f64::max) < 1e-5);
        }
        dem.advance(1.5e-6, 99).unwrap();
    }
    let done = dem.exchanged();
    let due = (2e5 * dem.time()).floor() as u64;
    // The last look was at step 3900.
    let looked = (2e5 * 3900.0 * 1.5e-6_f64).floor() as u64;
    assert_eq!(done.inserted + done.not_placed, looked, "{done:?} of {due}");
    assert!(done.not_placed > 0 && done.removed > 0, "{done:?}");
    assert_eq!(number + done.inserted - done.removed, dem.len() as u64);
    assert!((start + done.mass_inserted - done.mass_removed - mass(&dem)).abs() < 1e-12 * start);
    let turnover = dem.energies().mechanical() + dem.losses().total();
    let residual = dem.energy_residual().unwrap().abs() / turnover;
    println!("inlets and outlets: {done:?}, residual {residual:.1e}");
    assert!(residual < 1e-3, "{residual:e}");
}

#[test]
fn an_inlet_stops_starts_and_ends_and_is_refused_when_nothing_fits() {
    let mut dem = fed(0, 0.5);
    assert!(dem.is_empty() && dem.set_inlet("top", false) && !dem.set_inlet("bottom", true));
    dem.advance(1.5e-6, 301).unwrap();
    assert_eq!(dem.exchanged().inserted, 0);
    dem.set_inlet("top", true);
    dem.advance(1.5e-6, 300).unwrap();
    // From step 301 to the look at step 600.
    let due = dem.exchanged().inserted + dem.exchanged().not_placed;
    assert_eq!(due, (2e5 * 299.0 * 1.5e-6_f64) as u64);
    let glass = Materials::new().add(Material::default()).unwrap();
    let tight = Inlet { high: DVec2::new(12e-3, 31e-3), ..inlet(glass) };
    assert!(dem.add_inlet(tight).unwrap_err().to_string().contains("extent of inlet `top`"));
    assert!(dem.add_inlet(Inlet { rate: 0.0, ..inlet(glass) }).is_err());
    assert!(dem.add_inlet(Inlet { radii: vec![], ..inlet(glass) }).is_err());
    assert!(dem.add_outlet(Outlet::Beyond { point: DVec2::ZERO, normal: DVec2::ZERO }).is_err());
}

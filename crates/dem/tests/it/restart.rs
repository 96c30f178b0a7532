//! Restarts across sorting in memory, changes between stages, and long lists.

use crate::sample::{Lattice, down};
use granular_core::testing::{Breach, Contract};
use granular_core::{D2, D3, Section, Solver};
use granular_dem::{Dem, Dem2, Material, MaterialId, Materials, Options, Setup};

fn state(dem: &Dem2) -> Section {
    let mut section = Section::new("solver");
    dem.save(&mut section);
    section
}

fn column(side: usize, friction: f64) -> (Dem2, MaterialId) {
    let mut materials = Materials::new();
    let glass = materials.add(Material { friction, ..Material::default() }).unwrap();
    let lattice = Lattice { side, speed: 0.3, ..Lattice::default() };
    let (grains, walls) = (lattice.grains::<D2>(&[glass]), lattice.walls::<D2>(glass));
    let options = Options { ledger: true, ..Options::default() };
    (Dem2::new(Setup { materials, grains, walls, gravity: down::<D2>(9.81), options }).unwrap(), glass)
}

const STEP: f64 = 2e-6;

fn follow(uninterrupted: &mut Dem2, mut restarted: Dem2, legs: &[u64]) {
    restarted.restore(&state(uninterrupted)).unwrap();
    assert_eq!(state(uninterrupted), state(&restarted));
    for &leg in legs {
        uninterrupted.advance(STEP, leg).unwrap();
        restarted.advance(STEP, leg).unwrap();
        assert!(state(uninterrupted) == state(&restarted), "step {}", uninterrupted.steps());
    }
}

#[test]
fn a_restart_before_at_and_after_sorting_gives_the_same_bits() {
    let ids = |dem: &Dem2| dem.grains().map(|(id, _)| id).collect::<Vec<_>>();
    let (mut dem, _) = column(24, 0.5);
    dem.advance(STEP, 4990).unwrap();
    let before = ids(&dem);
    // Sorted once, at the very first step; the next time is at step 5000.
    assert!(!before.is_sorted());
    follow(&mut dem, column(24, 0.5).0, &[1, 8, 1, 1, 1, 10]);
    assert_ne!(ids(&dem), before);
    let (mut dem, _) = column(24, 0.5);
    dem.advance(STEP, 5000).unwrap();
    follow(&mut dem, column(24, 0.5).0, &[1, 1, 20]);
    follow(&mut dem, column(24, 0.5).0, &[1, 1, 20]);
    // Sorted anew, and back in the middle of the next interval.
    dem.advance(STEP, 10_000 - dem.steps() - 3).unwrap();
    follow(&mut dem, column(24, 0.5).0, &[2, 2, 10]);
}

#[test]
fn small_samples_are_not_sorted() {
    let (mut dem, _) = column(22, 0.5);
    dem.advance(STEP, 5010).unwrap();
    assert!(dem.grains().map(|(id, _)| id).is_sorted());
}

#[test]
fn a_restart_keeps_what_stages_changed() {
    let fresh = || column(12, 0.0).0;
    let (mut dem, glass) = column(12, 0.0);
    assert!(!dem.turns());
    dem.advance(STEP, 100).unwrap();
    follow(&mut dem, fresh(), &[5]);
    dem.set_friction(glass, 0.7);
    dem.set_gravity(down::<D2>(-4.0));
    assert!(dem.set_open("x_high", true) && !dem.set_open("nothing", true));
    dem.advance(STEP, 200).unwrap();
    assert!(dem.turns());
    follow(&mut dem, fresh(), &[1, 1, 20]);
    // Friction taken away again: grains still turn, and a restart must know.
    dem.set_friction(glass, 0.0);
    follow(&mut dem, fresh(), &[1, 1, 20]);
    dem.stop_motion();
    dem.set_open("x_high", false);
    follow(&mut dem, fresh(), &[1, 1, 20]);
}

#[test]
fn a_section_with_a_grain_twice_or_of_another_sample_is_refused() {
    let (dem, _) = column(12, 0.5);
    let saved = state(&dem);
    let mut twice = Section::new("solver");
    for (name, bytes) in saved.entries() {
        let mut bytes = bytes.to_vec();
        if name == "id" {
            bytes.copy_within(0..4, 4);
        }
        twice.put_bytes(name, bytes);
    }
    let error = column(12, 0.5).0.restore(&twice).unwrap_err();
    assert!(error.to_string().contains("is there twice"), "{error}");
    assert!(column(13, 0.5).0.restore(&saved).is_err());
    assert!(column(12, 0.0).0.restore(&saved).is_ok());
}

#[test]
fn rebuilding_long_lists_does_not_allocate() -> Result<(), Breach> {
    // Hardly any loss, so that grains keep the speed that outdates their lists within 72 steps.
    // Reach of a diameter: each block is owed thousands of loads by others.
    let build = || {
        let mut materials = Materials::new();
        let glass =
            materials.add(Material { restitution: 1.0, friction: 0.01, ..Material::default() }).unwrap();
        let lattice = Lattice { side: 13, speed: 50.0, ..Lattice::default() };
        let (grains, walls) = (lattice.grains::<D3>(&[glass]), lattice.walls::<D3>(glass));
        let options = Options { skin: 1.0, ..Options::default() };
        Dem::<D3>::new(Setup { materials, grains, walls, gravity: down::<D3>(9.81), options }).unwrap()
    };
    Contract::new(build, 8e-8).steps(150).warm_up(1500).allocations()
}

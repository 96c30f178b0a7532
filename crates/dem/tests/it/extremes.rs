//! Extreme scenes finish or are refused with a reason: never NaN, never a panic.

use crate::sample::{Lattice, down, free};
use granular_core::{D2, D3, Dim, Limits, Linear, Numbers, Section, Solver, StepError, Vector};
use granular_dem::{Dem, Grain, Material, Materials, Options, Setup, Tension};

fn boxed<D: Dim>(lattice: Lattice, material: Material, gravity: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let (grains, walls) = (lattice.grains::<D>(&[glass]), lattice.walls::<D>(glass));
    let gravity = down::<D>(gravity);
    Dem::new(Setup { materials, grains, walls, gravity, options: Options::default() }).unwrap()
}

/// Whether all is finite: state, energies, limits and what is shown of them.
fn is_sound<D: Dim>(dem: &Dem<D>) -> bool {
    let grains =
        dem.grains().all(|(_, g)| g.position.is_finite() && g.velocity.is_finite() && g.spin.is_finite());
    let mut limits = Limits::default();
    dem.limits(&mut limits);
    let steps = limits.steps.iter().all(|limit| limit.dt.is_finite() && limit.dt > 0.0);
    let bounds = limits.bounds.iter().all(|bound| bound.value.is_finite());
    let mut numbers = Numbers::wanting(["kinetic_energy", "largest_overlap", "contacts", "coordination"]);
    dem.show(&mut numbers);
    grains && steps && bounds && numbers.values().iter().all(|(.., value)| value.is_finite())
}

/// Runs for so many recommended steps and checks the outcome.
fn runs<D: Dim>(mut dem: Dem<D>, steps: u64) -> Dem<D> {
    let dt = dem.recommended_step();
    dem.advance(dt, steps).unwrap();
    assert!(is_sound(&dem));
    dem
}

/// Runs until it ends or fails; a failure must give a reason, and everything before it be sound.
fn ends<D: Dim>(mut dem: Dem<D>, dt: f64, steps: u64) -> Option<StepError> {
    for _ in 0..steps {
        if let Err(error) = dem.step(dt) {
            assert!(!error.to_string().is_empty());
            return Some(error);
        }
        assert!(dem.grains().all(|(_, g)| g.position.is_finite() && g.velocity.is_finite()));
    }
    None
}

fn in_both(check: impl Fn(bool)) {
    check(true);
    check(false);
}

/// A grain that is nothing beside another once ended in an overflow, with a ratio of radii that is infinite.
#[test]
fn sizes_beyond_reason_are_refused() {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let refused = |radii: [f64; 2]| {
        let grains = vec![
            Grain::<D2>::at(Vector::along(0, 0.0), radii[0], glass),
            Grain::at(Vector::along(0, 3.0 * (radii[0] + radii[1])), radii[1], glass),
        ];
        let (walls, gravity) = (Vec::new(), down::<D2>(9.81));
        let setup =
            Setup { materials: materials.clone(), grains, walls, gravity, options: Options::default() };
        Dem::new(setup).err().map(|error| error.to_string())
    };
    assert_eq!(refused([1e-3, 1.1e-9]), None);
    let beside = refused([1e-3, 0.9e-9]).unwrap();
    assert!(beside.contains("smallest radius of a grain, where the largest is 0.001 m,"), "{beside}");
    assert!(beside.contains("at least a millionth of the largest"), "{beside}");
    let beside = refused([1e-3, 5e-324]).unwrap();
    assert!(
        beside.contains("smallest radius of a grain, where the largest is 0.001 m, is 5e-324"),
        "{beside}"
    );
    for radius in [5e-324, 1e-160, 1e160] {
        let alone = refused([radius, radius]).unwrap();
        assert!(alone.contains("moment of inertia of a grain"), "{alone}");
    }
}

#[test]
fn no_grains_and_one_grain() {
    fn few<D: Dim>(side: usize) {
        let lattice = Lattice { side, radii: (0.3e-3, 0.4e-3), ..Lattice::default() };
        let dem = runs(boxed::<D>(lattice, Material::default(), 9.81), 3000);
        let mut section = Section::new("solver");
        dem.save(&mut section);
        let mut again = boxed::<D>(lattice, Material::default(), 9.81);
        again.restore(&section).unwrap();
        assert_eq!(dem.size().0, side.min(1));
        assert!(dem.memory().left_out.iter().any(|text| text.contains("ledger")));
        // All there is can be shown.
        let shown = dem.shown();
        let mut numbers = Numbers::wanting(shown.iter().map(|shown| shown.name.as_str()));
        dem.show(&mut numbers);
        assert!(numbers.get("contacts").is_some());
    }
    in_both(|disks| {
        for side in [0, 1] {
            if disks { few::<D2>(side) } else { few::<D3>(side) }
        }
    });
}

#[test]
fn weightless_and_under_a_hundred_times_the_weight() {
    let lattice = Lattice { side: 6, speed: 0.1, ..Lattice::default() };
    for gravity in [0.0, 981.0] {
        runs(boxed::<D2>(lattice, Material::default(), gravity), 3000);
        runs(boxed::<D3>(lattice, Material::default(), gravity), 3000);
    }
}

#[test]
fn all_of_the_restitution_and_none_and_friction_without_bounds() {
    let lattice = Lattice { side: 5, radii: (0.45e-3, 0.49e-3), speed: 0.5, ..Lattice::default() };
    let base = Material::default();
    for material in [
        Material { restitution: 1.0, friction: 0.0, ..base },
        Material { restitution: 1.0, friction: 10.0, damping_ratio: 0.0, ..base },
        Material { restitution: 1e-3, friction: 10.0, ..base },
        Material { stiffness_ratio: 0.0, friction: 10.0, ..base },
        Material { rolling_friction: 10.0, friction: 10.0, ..base },
    ] {
        let mut dem = boxed::<D2>(lattice, material, 0.0);
        let start = dem.energies().mechanical();
        dem = runs(dem, 4000);
        assert!(dem.energies().mechanical() < 1.01 * start, "{material:?}");
        runs(boxed::<D3>(lattice, material, 9.81), 3000);
    }
}

#[test]
fn the_smallest_number_as_friction_and_a_size_ratio_of_a_hundred() {
    fn ratio<D: Dim>() {
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        // A large grain falls onto a row of small ones.
        let mut grains: Vec<Grain<D>> = (0..20)
            .map(|k| {
                let place = D::Vec::along(0, 2.1e-4 * (f64::from(k) - 9.5)) + D::Vec::along(D::UP, 1e-4);
                Grain::at(place, 1e-4, glass)
            })
            .collect();
        grains.push(Grain::at(D::Vec::along(D::UP, 1e-2 + 2.2e-4), 1e-2, glass));
        let up = D::Vec::along(D::UP, 1.0);
        let walls = vec![granular_dem::Wall::plane("floor", D::Vec::ZERO, up, glass).unwrap()];
        let (gravity, options) = (down::<D>(9.81), Options::default());
        let dem = Dem::<D>::new(Setup { materials, grains, walls, gravity, options }).unwrap();
        let dt = dem.recommended_step();
        if let Some(error) = ends(dem, dt, 30_000) {
            assert!(matches!(error, StepError::TooStiff { .. }), "{error}");
        }
    }
    ratio::<D2>();
    ratio::<D3>();
    let lattice = Lattice { side: 4, ..Lattice::default() };
    runs(boxed::<D2>(lattice, Material { friction: f64::MIN_POSITIVE, ..Material::default() }, 9.81), 500);
}

#[test]
fn a_shot_ends_or_says_why() {
    for speed in [100.0, 1e5, 1e160, 1e300] {
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        let lattice = Lattice { side: 6, speed: 0.0, ..Lattice::default() };
        let mut grains = lattice.grains::<D2>(&[glass]);
        grains[15].velocity.x = speed;
        let dem = free(materials, grains, Options::default());
        // The check before a run refuses it,
        let mut limits = Limits::default();
        dem.limits(&mut limits);
        let bound = limits.bounds.iter().find(|bound| bound.name == "overlap of the hardest impact").unwrap();
        assert!(bound.refuses && !bound.holds(), "{speed}");
        // and so does the run, unless the grain jumps over all others in one step.
        let dt = dem.recommended_step();
        let outcome = ends(dem, dt, 3000);
        match &outcome {
            Some(StepError::TooStiff { what, .. }) => assert!(what.contains("overlap"), "{speed}: {what}"),
            Some(StepError::NotFinite { .. }) => assert!(speed > 1e150, "{speed}"),
            other => assert!(other.is_none() && speed * dt > 6e-3, "{speed}: {other:?}"),
        }
    }
    // Alone, it flies.
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let grain = Grain::at(<D3 as Dim>::Vec::ZERO, 1e-3, glass).moving(D3_X * 1e5);
    let mut dem = free::<D3>(materials, vec![grain], Options::default());
    dem.advance(1e-6, 1000).unwrap();
    assert!((dem.grain(0).position.x - 100.0).abs() < 1e-9);
}

#[test]
fn advice_is_a_stiffness_that_is_enough_and_names_the_two_that_overlap() {
    let bound = |name: &str, stiffness: f64, options: Options, speed: f64, gap: f64| {
        let mut materials = Materials::new();
        let glass = Material { normal_stiffness: stiffness, ..Material::default() };
        let glass = materials.add(glass).unwrap();
        let grain = |x: f64| Grain::at(<D2 as Dim>::Vec::new(x, 0.0), 1e-3, glass);
        let grains =
            vec![grain(0.5), grain(0.0).moving(<D2 as Dim>::Vec::new(speed, 0.0)), grain(2e-3 + gap)];
        let mut limits = Limits::default();
        free::<D2>(materials, grains, options).limits(&mut limits);
        limits.bounds.into_iter().find(|bound| bound.name == name).unwrap()
    };
    let hardest =
        |stiffness| bound("overlap of the hardest impact", stiffness, Options::default(), 20.0, 1e-3);
    let soft = hardest(1e4);
    assert!(!soft.holds());
    let (_, advice) = soft.why.split_once(", to ").expect("a target");
    let target: f64 = advice.split(' ').next().unwrap().parse().unwrap();
    let enough = hardest(target);
    assert!(enough.holds() && !hardest(0.8 * target).holds(), "{}", soft.why);
    // What holds needs no advice.
    assert!(!enough.why.contains("raise"), "{}", enough.why);
    let overlap = bound("overlap at the start", 1e6, Options::default(), 0.0, -2e-4);
    assert!(!overlap.holds());
    for part in
        ["grain 1 at (0.000000, 0.000000) m", "grain 2 at (0.001800, 0.000000) m", "overlap by 2.000e-4 m"]
    {
        assert!(overlap.why.contains(part), "{part}: {}", overlap.why);
    }
}

const D3_X: granular_core::glam::DVec3 = granular_core::glam::DVec3::X;

#[test]
fn two_grains_in_one_place_are_refused() {
    fn twins<D: Dim>(tension: Tension, friction: f64) {
        let mut materials = Materials::new();
        let glass = materials.add(Material { friction, ..Material::default() }).unwrap();
        let grain = Grain::at(D::Vec::along(0, 0.3), 1e-3, glass);
        let mut dem = free::<D>(materials, vec![grain, grain], Options { tension, ..Options::default() });
        let error = dem.step(1e-7).unwrap_err();
        assert!(matches!(error, StepError::TooStiff { .. } | StepError::NotFinite { .. }), "{error}");
        assert!(error.to_string().contains("overlap"), "{error}");
    }
    for tension in [Tension::Cut, Tension::Kept] {
        for friction in [0.0, 0.5] {
            twins::<D2>(tension, friction);
            twins::<D3>(tension, friction);
        }
    }
}

#[test]
fn a_grain_far_away_costs_nothing_and_changes_nothing() {
    fn with_far<D: Dim>(far: Option<f64>) -> Vec<Grain<D>> {
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        let lattice = Lattice { side: 6, ..Lattice::default() };
        let mut grains = lattice.grains::<D>(&[glass]);
        let count = grains.len();
        grains.extend(far.map(|x| Grain::at(D::Vec::along(0, x), 0.5e-3, glass)));
        let mut dem = free::<D>(materials, grains, Options { skin: 0.05, ..Options::default() });
        dem.advance(1e-7, 600).unwrap();
        assert!(is_sound(&dem) && dem.memory().bytes < 1_000_000);
        let mut grains: Vec<(u32, Grain<D>)> = dem.grains().collect();
        grains.sort_by_key(|(id, _)| *id);
        grains.into_iter().map(|(_, grain)| grain).take(count).collect()
    }
    assert_eq!(with_far::<D2>(None), with_far::<D2>(Some(1e9)));
    assert_eq!(with_far::<D2>(None), with_far::<D2>(Some(-1e9)));
    assert_eq!(with_far::<D3>(None), with_far::<D3>(Some(1e9)));
}

#[test]
fn steps_that_are_far_too_long_are_noticed() {
    for dt in [1e-2, 1e10, 1e300] {
        let lattice = Lattice { side: 5, ..Lattice::default() };
        assert!(ends(boxed::<D2>(lattice, Material::default(), 9.81), dt, 50).is_some(), "{dt}");
        assert!(ends(boxed::<D3>(lattice, Material::default(), 9.81), dt, 50).is_some(), "{dt}");
    }
}

#[test]
fn a_grain_within_a_block_or_behind_a_plane_is_refused() {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let (low, high) = (D3_X * 0.0, D3_X * 0.0 + granular_core::glam::DVec3::ONE);
    let block = granular_dem::Wall::<D3>::block("block", low, high, glass).unwrap();
    let plane = granular_dem::Wall::<D3>::plane("plane", high, D3_X, glass).unwrap();
    for wall in [block, plane] {
        let grain = Grain::at(high * 0.5, 1e-3, glass);
        let (materials, options) = (materials.clone(), Options::default());
        let gravity = down::<D3>(9.81);
        let setup = Setup { materials, grains: vec![grain], walls: vec![wall], gravity, options };
        let error = Dem::<D3>::new(setup).unwrap().step(1e-7).unwrap_err();
        assert!(matches!(error, StepError::TooStiff { .. }), "{error}");
    }
}

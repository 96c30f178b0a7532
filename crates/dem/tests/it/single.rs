//! Single grains that are set, held, or not those of their material, and springs that are given.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Linear, Matrix, Section, Solver, StepError, Vector};
use granular_dem::material::restitution_of_damping;
use granular_dem::{
    Contact, ContactModel, Dem, Dem2, Elasticity, Grain, Material, MaterialId, Materials, Options, OtherBody,
    PairOverride, PeriodicCell, Setup, SpringTurning, Tension, Wall,
};

const GLASS: MaterialId = MaterialId::of_index(0);

fn of<D: Dim>(
    material: Material,
    grains: Vec<Grain<D>>,
    floor: bool,
    gravity: D::Vec,
    options: Options,
) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let plane = Wall::plane("floor", D::Vec::ZERO, D::Vec::along(D::UP, 1.0), glass).unwrap();
    let walls = if floor { vec![plane] } else { vec![] };
    Dem::new(Setup { materials, grains, walls, gravity, options }).unwrap()
}

fn with_ledger() -> Options {
    Options { ledger: true, ..Options::default() }
}

fn bytes<D: Dim>(dem: &Dem<D>) -> String {
    let mut section = Section::new("dem");
    dem.save(&mut section);
    format!("{section:?}")
}

fn only<D: Dim>(dem: &Dem<D>) -> Contact<D> {
    let mut list = Vec::new();
    dem.visit_contacts(&mut |contact| list.push(contact));
    assert_eq!(list.len(), 1);
    list[0]
}

/// Without dashpots and sliding, a disk on a floor swings on its tangential spring with `w^2 = (1 + 1/q) k_t / m`, where the
/// surface moves by rolling and sliding at once.
#[test]
fn a_disk_swings_on_the_spring_that_it_was_given() {
    let (radius, overlap, displacement) = (1e-3, 1e-5, 1e-7);
    let material = Material { damping_ratio: 0.0, restitution: 1.0, friction: 100.0, ..Material::default() };
    let mut dem = of::<D2>(
        material,
        vec![Grain::at(DVec2::new(0.0, radius - overlap), radius, GLASS)],
        true,
        DVec2::ZERO,
        Options { lever_arm: granular_dem::LeverArm::Radius, ..with_ledger() },
    );
    // Held up by gravity, so that the overlap stays.
    dem.set_gravity(DVec2::new(0.0, -material.normal_stiffness * overlap / dem.mass()));
    dem.set_tangential_displacement(0, OtherBody::Wall("floor"), DVec2::new(displacement, 0.0)).unwrap();
    let contact = only(&dem);
    assert!((contact.tangential_displacement() - DVec2::new(displacement, 0.0)).length() < 1e-20);
    assert!(
        (contact.force.x + material.normal_stiffness * displacement).abs() < 1e-12 * contact.normal_force
    );
    assert!(dem.energy_residual().unwrap().abs() < 1e-12 * contact.energy, "the ledger counts the spring");
    let period = std::f64::consts::TAU / (3.0 * material.normal_stiffness / dem.mass()).sqrt();
    let steps = 400;
    for (part, expected) in [(1, 0.0), (2, -1.0), (3, 0.0), (4, 1.0)] {
        dem.advance(period / (4 * steps) as f64, steps).unwrap();
        let found = only(&dem).tangential_displacement().x / displacement;
        assert!((found - expected).abs() < 1e-3, "after {part} quarters: {found}");
    }
}

fn springs_are_read_as_they_were_set<D: Dim>(model: ContactModel) {
    let elasticity = Some(Elasticity { young_modulus: 1e8, poisson_ratio: 0.3 });
    let material = Material { elasticity, friction: 0.5, rolling_friction: 0.1, ..Material::default() };
    let place = |x: f64| D::Vec::along(0, x) + D::Vec::along(1, 4e-3);
    let grains = vec![Grain::at(place(4e-3), 1e-3, GLASS), Grain::at(place(5.99e-3), 1e-3, GLASS)];
    let options = Options { contact: model, ..with_ledger() };
    let across = D::Vec::along(1, 1e-7);
    for (own, other) in [(0, 1), (1, 0)] {
        let mut dem = of::<D>(material, grains.clone(), false, D::Vec::ZERO, options);
        // The part along the normal does not count.
        dem.set_tangential_displacement(own, OtherBody::Grain(other), across + D::Vec::along(0, 3e-7))
            .unwrap();
        let contact = only(&dem);
        let first_is_own = dem.grains().nth(contact.first).unwrap().0 == own;
        let sign = if first_is_own { 1.0 } else { -1.0 };
        assert!((contact.tangential_displacement() - across * sign).length() < 1e-20, "{own}");
        assert!(contact.force.dot(across) * sign < 0.0, "the spring pulls back");
        assert!(dem.energy_residual().unwrap().abs() < 1e-12 * contact.energy);
    }
}

#[test]
fn springs_between_grains_are_read_as_they_were_set_from_either_side() {
    for model in [ContactModel::Linear, ContactModel::Hertz] {
        springs_are_read_as_they_were_set::<D2>(model);
        springs_are_read_as_they_were_set::<D3>(model);
    }
}

#[test]
fn springs_across_the_face_of_a_cell_are_set_too_and_others_are_refused() {
    let grains = vec![
        Grain::at(DVec2::new(0.5e-3, 5e-3), 1e-3, GLASS),
        Grain::at(DVec2::new(8.51e-3, 5e-3), 1e-3, GLASS),
    ];
    let mut dem = of::<D2>(Material::default(), grains.clone(), true, DVec2::ZERO, with_ledger());
    assert!(
        dem.set_tangential_displacement(0, OtherBody::Grain(1), DVec2::Y * 1e-7).is_err(),
        "they do not touch"
    );
    assert!(dem.set_tangential_displacement(0, OtherBody::Wall("lid"), DVec2::Y).is_err());
    dem.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::splat(10e-3), &[true, false]).unwrap()).unwrap();
    dem.set_tangential_displacement(0, OtherBody::Grain(1), DVec2::Y * 1e-7).unwrap();
    let contact = only(&dem);
    assert_ne!(contact.shift, [0; 3]);
    assert!((contact.tangential_displacement().y.abs() - 1e-7).abs() < 1e-20);
    let touching = vec![grains[0], Grain { position: grains[0].position + DVec2::X * 1.99e-3, ..grains[0] }];
    let mut smooth = of::<D2>(
        Material { friction: 0.0, ..Material::default() },
        touching,
        false,
        DVec2::ZERO,
        with_ledger(),
    );
    assert!(
        smooth.set_tangential_displacement(0, OtherBody::Grain(1), DVec2::Y).is_err(),
        "no friction, no spring"
    );
}

/// The spring of two spheres that turn as one about their normal.
#[test]
fn springs_of_spheres_turn_about_the_normal_as_is_chosen() {
    for (turning, angle) in
        [(SpringTurning::MeanSpin, 0.5 * std::f64::consts::PI), (SpringTurning::NormalOnly, 0.0)]
    {
        let grains = vec![Grain::at(DVec3::ZERO, 1e-3, GLASS), Grain::at(DVec3::X * 1.999e-3, 1e-3, GLASS)];
        let options = Options { spring_turning: turning, ..Options::default() };
        let mut dem = of::<D3>(Material::default(), grains, false, DVec3::ZERO, options);
        for id in 0..2 {
            // So heavy that the contact does not move them.
            dem.set_mass(id, 1e6).unwrap();
            dem.set_spin(id, DVec3::X * 1000.0).unwrap();
        }
        dem.set_tangential_displacement(0, OtherBody::Grain(1), DVec3::Y * 1e-8).unwrap();
        let before = only(&dem).tangential_displacement();
        dem.advance(0.5e-3 * std::f64::consts::PI / 2000.0, 2000).unwrap();
        let after = only(&dem).tangential_displacement();
        let turned = DVec3::new(0.0, angle.cos(), angle.sin()) * before.y;
        assert!((after - turned).length() < 1e-4 * before.length(), "{turning:?}: {after:?} {turned:?}");
    }
}

/// A dashpot that is given damps by its own constant, whatever the masses.
#[test]
fn given_dashpots_give_the_restitution_of_their_damping() {
    for (mass, damping) in [(1.0, 2.0), (7.0, 2.0), (1.0, 0.0)] {
        let mut materials = Materials::new();
        let glass =
            materials.add(Material { normal_stiffness: 1e5, friction: 0.0, ..Material::default() }).unwrap();
        let stated = PairOverride { normal_damping: Some(damping), ..PairOverride::default() };
        materials.set_pair(glass, glass, stated).unwrap();
        let grains = vec![
            Grain::at(DVec2::ZERO, 1e-3, glass).moving(DVec2::X * 0.1),
            Grain::at(DVec2::X * 2.001e-3, 1e-3, glass).moving(-DVec2::X * 0.1),
        ];
        let options = with_ledger();
        let mut dem =
            Dem2::new(Setup { materials, grains, walls: vec![], gravity: DVec2::ZERO, options }).unwrap();
        let usual = dem.mass_of(1);
        dem.set_mass(1, mass * usual).unwrap();
        let effective = usual * mass / (1.0 + mass);
        let zeta = damping / (2.0 * (1e5 * effective).sqrt());
        let dt = std::f64::consts::PI * (effective / 1e5).sqrt() / 500.0;
        dem.advance(dt, 60_000.min((0.02 / dt) as u64)).unwrap();
        let restitution = (dem.grain(1).velocity.x - dem.grain(0).velocity.x) / 0.2;
        let exact = restitution_of_damping(zeta, Tension::Cut);
        assert!((restitution - exact).abs() < 1e-4, "{mass} {damping}: {restitution} {exact}");
    }
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let wrong = PairOverride { normal_damping: Some(-1.0), ..PairOverride::default() };
    assert!(materials.set_pair(glass, glass, wrong).is_err());
}

/// The tangential dashpot alone, as a rate: a disk that slides on a floor without tangential stiffness and below the cap slows
/// down as `exp(-3 c t / m)`, where rolling takes part.
#[test]
fn a_given_tangential_dashpot_slows_the_surface() {
    let mut materials = Materials::new();
    let material = Material { stiffness_ratio: 0.0, friction: 1e6, restitution: 1.0, ..Material::default() };
    let glass = materials.add(material).unwrap();
    let damping = 0.5;
    let stated = PairOverride { tangential_damping: Some(damping), ..PairOverride::default() };
    materials.set_pair(glass, glass, stated).unwrap();
    let overlap = 1e-6;
    let grain = Grain::at(DVec2::new(0.0, 1e-3 - overlap), 1e-3, glass).moving(DVec2::X * 0.01);
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap();
    let options = Options { lever_arm: granular_dem::LeverArm::Radius, ..Options::default() };
    let mut dem = Dem2::new(Setup {
        materials,
        grains: vec![grain],
        walls: vec![floor],
        gravity: DVec2::ZERO,
        options,
    })
    .unwrap();
    dem.set_gravity(DVec2::new(0.0, -1.6e6 * overlap / dem.mass()));
    let rate = 3.0 * damping / dem.mass();
    let (steps, time) = (4000, 1.0 / rate);
    dem.advance(time / steps as f64, steps).unwrap();
    let now = dem.grain(0);
    let slip = now.velocity.x + now.spin * 1e-3;
    assert!((slip / 0.01 - (-1.0_f64).exp()).abs() < 1e-4, "{slip}");
}

/// The effective mass of a contact with a fixed grain is that of the other one, so the restitution is that of the material.
#[test]
fn a_fixed_grain_stays_and_others_rebound_from_it() {
    let material = Material { restitution: 0.6, ..Material::default() };
    let grains = vec![
        Grain::at(DVec2::ZERO, 1e-3, GLASS),
        Grain::at(DVec2::new(0.0, 2.01e-3), 1e-3, GLASS).moving(-DVec2::Y * 0.5),
    ];
    let build = || {
        let mut dem = of::<D2>(material, grains.clone(), false, DVec2::ZERO, with_ledger());
        dem.set_fixed(0, true).unwrap();
        dem
    };
    let mut dem = build();
    let dt = dem.recommended_step() / 8.0;
    dem.advance(dt, 500).unwrap();
    let mut section = Section::new("dem");
    dem.save(&mut section);
    dem.advance(dt, 2500).unwrap();
    assert!(dem.is_fixed(0) && !dem.is_fixed(1));
    let held = dem.grain(0);
    assert_eq!((held.position, held.velocity, held.spin), (DVec2::ZERO, DVec2::ZERO, 0.0));
    let rebound = dem.grain(1).velocity.y / 0.5;
    assert!((rebound - 0.6).abs() < 1e-4, "{rebound}");
    assert!(dem.energy_residual().unwrap().abs() < 1e-4 * dem.losses().total());
    let mut restored = build();
    restored.set_fixed(0, false).unwrap();
    restored.restore(&section).unwrap();
    (0..2500).for_each(|_| restored.advance(dt, 1).unwrap());
    assert!(bytes(&dem) == bytes(&restored), "a fixed grain is part of the state");
    assert!(dem.set_velocity(0, DVec2::X).is_err() && dem.set_spin(0, 1.0).is_err());
    // Let go, it falls.
    dem.set_fixed(0, false).unwrap();
    dem.set_gravity(DVec2::new(0.0, -10.0));
    dem.advance(dt, 100).unwrap();
    assert!((dem.grain(0).velocity.y + 1000.0 * dt).abs() < 1e-12);
}

/// Rolling without sliding on a slope: `a = g sin / (1 + I / (m r^2))`, one half of `g sin` for a ring.
#[test]
fn a_ring_rolls_down_slower_than_a_disk() {
    let slope = 0.3_f64;
    let gravity = DVec2::new(slope.sin(), -slope.cos()) * 9.81;
    for (inertia, expected) in [(None, 2.0 / 3.0), (Some(1.0), 0.5)] {
        let mut dem = of::<D2>(
            Material { normal_stiffness: 1e6, ..Material::default() },
            vec![Grain::at(DVec2::new(0.0, 10e-3), 10e-3, GLASS)],
            true,
            gravity,
            with_ledger(),
        );
        if let Some(share) = inertia {
            dem.set_inertia(0, share * dem.mass() * 1e-4).unwrap();
            assert!((dem.inertia_of(0) / (dem.mass() * 1e-4) - 1.0).abs() < 1e-15);
        }
        let dt = dem.recommended_step();
        dem.advance(dt, (0.2 / dt) as u64).unwrap();
        let acceleration = dem.grain(0).velocity.x / dem.time();
        assert!((acceleration / gravity.x - expected).abs() < 2e-3, "{acceleration} {expected}");
        assert!(dem.energy_residual().unwrap().abs() < 1e-4 * dem.energies().translational());
    }
}

#[test]
fn a_grain_keeps_its_own_mass_and_place_when_others_come_and_are_sorted() {
    let at = |k: u32| DVec2::new(f64::from(k % 24), f64::from(k / 24)) * 2.5e-3;
    let grains: Vec<_> = (0..528).map(|k| Grain::at(at(k), 1e-3, GLASS)).collect();
    let mut dem = of::<D2>(Material::default(), grains, false, DVec2::ZERO, Options::default());
    for (id, factor) in [(3, 2.0), (500, 5.0)] {
        dem.set_mass(id, factor * dem.mass_of(0)).unwrap();
        dem.set_inertia(id, factor * 10.0 * dem.inertia_of(0)).unwrap();
    }
    dem.set_fixed(77, true).unwrap();
    for id in 0..528 {
        if id != 77 {
            dem.set_velocity(id, DVec2::new(f64::from(id % 5), f64::from(id % 7)) * 1e-3).unwrap();
        }
    }
    let [mass, inertia] = [dem.mass_of(0), dem.inertia_of(0)];
    dem.advance(1e-6, 5010).unwrap();
    let order: Vec<u32> = dem.grains().map(|(id, _)| id).collect();
    assert_ne!(order, (0..528).collect::<Vec<_>>(), "they were sorted");
    for id in 0..528 {
        let factor = match id {
            3 => 2.0,
            500 => 5.0,
            _ => 1.0,
        };
        assert_eq!(dem.mass_of(id), factor * mass);
        let own = if factor > 1.0 { factor * 10.0 } else { 1.0 };
        assert!((dem.inertia_of(id) / (own * inertia) - 1.0).abs() < 1e-12);
        assert_eq!(dem.is_fixed(id), id == 77);
    }
    assert_eq!(dem.grain(77).position, at(77));
}

#[test]
fn a_disk_may_spin_without_friction_and_goes_on_spinning_after_a_restart() {
    let material = Material { friction: 0.0, ..Material::default() };
    let grains = vec![
        Grain::at(DVec2::new(0.0, 1.05e-3), 1e-3, GLASS).turning(300.0),
        Grain::at(DVec2::new(3e-3, 1.05e-3), 1e-3, GLASS),
    ];
    let build = || of::<D2>(material, grains.clone(), true, DVec2::new(0.0, -9.81), with_ledger());
    let mut dem = build();
    let dt = dem.recommended_step();
    dem.advance(dt, 300).unwrap();
    let mut section = Section::new("dem");
    dem.save(&mut section);
    let mut restored = build();
    restored.restore(&section).unwrap();
    dem.advance(dt, 3000).unwrap();
    (0..3000).for_each(|_| restored.advance(dt, 1).unwrap());
    assert!(bytes(&dem) == bytes(&restored));
    assert_eq!((dem.grain(0).spin, dem.grain(1).spin), (300.0, 0.0));
    assert!(dem.losses().normal_damping > 0.0, "they hit the floor");
    // With friction the floor takes hold of it.
    dem.set_friction(GLASS, 0.5);
    dem.advance(dt, 3000).unwrap();
    assert!(dem.grain(0).spin < 200.0);
}

#[test]
fn a_step_beyond_the_stability_limit_is_refused_unless_it_is_asked_for() {
    let grains = vec![
        Grain::at(DVec2::new(0.0, 0.999e-3), 1e-3, GLASS),
        Grain::at(DVec2::new(1.0, 1e-3), 1e-3, GLASS),
    ];
    let build = || of::<D2>(Material::default(), grains.clone(), true, DVec2::ZERO, Options::default());
    let mut dem = build();
    let limit = dem.contact_step();
    assert!(dem.stable_step() < limit, "two contacts at once bear less");
    let before = bytes(&dem);
    let error = dem.advance(1.01 * limit, 1).unwrap_err();
    assert!(matches!(error, StepError::Step { .. }) && error.to_string().contains("stability"), "{error}");
    assert_eq!(bytes(&dem), before, "nothing was done");
    dem.advance(limit, 3).unwrap();
    // Stiffer, lighter: what was good is looked at again.
    dem.set_mass(0, 0.25 * dem.mass_of(0)).unwrap();
    assert!(dem.advance(limit, 1).is_err());
    dem.advance(0.49 * limit, 1).unwrap();
    let mut study = build();
    study.allow_any_step();
    study.advance(1.01 * limit, 1).unwrap();
}

#[test]
fn what_is_set_is_booked_and_bad_values_are_refused() {
    let grains = vec![Grain::at(DVec2::new(0.5e-3, 5e-3), 1e-3, GLASS)];
    let mut dem = of::<D2>(Material::default(), grains, true, DVec2::new(0.0, -9.81), with_ledger());
    dem.set_position(0, DVec2::new(2e-3, 9e-3)).unwrap();
    dem.set_velocity(0, DVec2::new(1.0, 2.0)).unwrap();
    dem.set_spin(0, 40.0).unwrap();
    dem.set_mass(0, 3.0 * dem.mass()).unwrap();
    dem.set_inertia(0, 2.0 * dem.inertia_of(0)).unwrap();
    let grain = dem.grain(0);
    assert_eq!(
        (grain.position, grain.velocity, grain.spin),
        (DVec2::new(2e-3, 9e-3), DVec2::new(1.0, 2.0), 40.0)
    );
    let scale = dem.energies().mechanical();
    assert!(dem.energy_residual().unwrap().abs() < 1e-14 * scale);
    dem.advance(1e-5, 100).unwrap();
    assert!(dem.energy_residual().unwrap().abs() < 1e-13 * scale);
    for wrong in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        assert!(dem.set_mass(0, wrong).is_err() && dem.set_inertia(0, wrong).is_err());
    }
    assert!(dem.set_position(0, DVec2::NAN).is_err() && dem.set_velocity(0, DVec2::NAN).is_err());
    assert!(dem.set_position(1, DVec2::ZERO).is_err() && dem.set_fixed(1, true).is_err());
    // Outside of a cell is inside of it.
    let size = Matrix::<D2>::from_fn(|row, column| if row == column { 10e-3 } else { 0.0 });
    dem.set_cell(PeriodicCell::with_edges(DVec2::ZERO, size, &[true, false]).unwrap()).unwrap();
    dem.set_position(0, DVec2::new(23e-3, 4e-3)).unwrap();
    assert!((dem.grain(0).position - DVec2::new(3e-3, 4e-3)).length() < 1e-15);
    let mut spheres = of::<D3>(
        Material::default(),
        vec![Grain::at(DVec3::Z, 1e-3, GLASS)],
        false,
        DVec3::ZERO,
        with_ledger(),
    );
    spheres.set_spin(0, DVec3::new(1.0, 2.0, 3.0)).unwrap();
    assert_eq!(spheres.grain(0).spin, DVec3::new(1.0, 2.0, 3.0));
}

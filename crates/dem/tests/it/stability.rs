//! The stability limit from both sides.

use crate::sample::{Lattice, Random, down, free};
use granular_core::glam::DVec2;
use granular_core::{D2, D3, Dim, Linear, Section, Solver, Vector};
use granular_dem::material::restitution_of_damping;
use granular_dem::{Dem, Dem2, Grain, Material, Materials, Options, Setup, Tension, Wall, stability_step};

/// One grain pressed onto a floor by gravity, with a contact of this damping ratio.
#[derive(Clone, Copy, Debug)]
struct Pressed {
    zeta: f64,
    tension: Tension,
    /// Tangential over normal stiffness; `None` for a scene without friction.
    tangential: Option<f64>,
    damping_ratio: f64,
}

const RADIUS: f64 = 1e-3;
const WEIGHT: f64 = 9.81;
/// Disturbance over the static overlap.
const DISTURBANCE: f64 = 1e-7;

impl Pressed {
    fn material(&self) -> Material {
        Material {
            restitution: restitution_of_damping(self.zeta, self.tension),
            friction: if self.tangential.is_some() { 10.0 } else { 0.0 },
            stiffness_ratio: self.tangential.unwrap_or(1.0),
            damping_ratio: self.damping_ratio,
            ..Material::default()
        }
    }

    /// Solver at rest but for the disturbance, its predicted limit \[s\], and the height at rest.
    fn build<D: Dim>(&self) -> (Dem<D>, f64, f64) {
        let material = self.material();
        let mass = material.density * D::ball_volume(RADIUS);
        let mut materials = Materials::new();
        let glass = materials.add(material).unwrap();
        let limit =
            stability_step::<D>(&materials.pair(0, 0), mass, self.tension, 1, self.tangential.is_some());
        let up = D::Vec::along(D::UP, 1.0);
        let overlap = mass * WEIGHT / material.normal_stiffness;
        let speed = DISTURBANCE * overlap * (material.normal_stiffness / mass).sqrt();
        let height = RADIUS - overlap;
        let grain = Grain::at(up * height, RADIUS, glass).moving(up * speed + D::Vec::along(0, speed));
        let walls = vec![Wall::plane("floor", D::Vec::ZERO, up, glass).unwrap()];
        let options = Options { tension: self.tension, ..Options::default() };
        let setup = Setup { materials, grains: vec![grain], walls, gravity: down::<D>(WEIGHT), options };
        let mut dem = Dem::new(setup).unwrap();
        dem.allow_any_step();
        // A new grain is taken to fall; this one rests, and a first guess of its acceleration that
        // is wrong by its weight would be a far larger disturbance.
        let mut saved = Section::new("solver");
        dem.save(&mut saved);
        let mut resting = Section::new("solver");
        for (name, bytes) in saved.entries() {
            let bytes = if name == "acceleration" { vec![0; bytes.len()] } else { bytes.to_vec() };
            resting.put_bytes(name, bytes);
        }
        dem.restore(&resting).unwrap();
        (dem, limit, height)
    }

    /// Whether the disturbance grows a thousandfold with a step of this share of the limit.
    fn grows<D: Dim>(&self, share: f64) -> bool {
        let (mut dem, limit, height) = self.build::<D>();
        let dt = share * limit;
        let up = D::Vec::along(D::UP, 1.0);
        let size = |dem: &Dem<D>| {
            let grain = dem.grain(0);
            let velocity = grain.velocity - D::turn(grain.spin, up * RADIUS);
            // Rolling along is neutral: the motion of the contact point counts.
            let slip = if self.tangential.is_some() { velocity.component(0).abs() } else { 0.0 };
            slip + velocity.component(D::UP).abs() + (grain.position.component(D::UP) - height).abs() / dt
        };
        let start = size(&dem);
        for _ in 0..40 {
            if dem.advance(dt, 100).is_err() || size(&dem) > 1000.0 * start {
                return true;
            }
        }
        assert!(size(&dem) < 30.0 * start, "neither grows nor stays bounded");
        false
    }
}

/// Tries both sides of the limit for every cut, damping and tangential spring.
fn both_sides<D: Dim>(springs: &[(Option<f64>, f64)]) {
    let mut wrong = Vec::new();
    for tension in [Tension::Cut, Tension::Kept] {
        for zeta in [0.0, 0.1, 0.5] {
            for &(tangential, damping_ratio) in springs {
                let case = Pressed { zeta, tension, tangential, damping_ratio };
                let sides = [(0.5, false), (0.98, false), (1.02, true), (1.1, true)];
                let found = sides.iter().filter(|&&(share, grows)| case.grows::<D>(share) != grows);
                wrong.extend(found.map(|&(share, grows)| format!("{case:?} at {share}: not {grows}")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}, grows: {wrong:#?}", D::BALL);
}

#[test]
fn a_normal_contact_is_stable_below_the_limit_and_not_above() {
    both_sides::<D2>(&[(None, 0.5)]);
    both_sides::<D3>(&[(None, 0.5)]);
}

/// Tangential springs that bind, with little and much damping.
const TANGENTIAL: [(Option<f64>, f64); 3] = [(Some(1.0), 0.0), (Some(1.0), 0.5), (Some(1.0), 1.5)];

#[test]
fn a_tangential_contact_of_a_disk_is_stable_below_the_limit_and_not_above() {
    both_sides::<D2>(&TANGENTIAL);
}

#[test]
fn a_tangential_contact_of_a_sphere_is_stable_below_the_limit_and_not_above() {
    both_sides::<D3>(&TANGENTIAL);
}

/// Disks in a hexagonal packing between a floor and two walls, pressed by their weight.
fn hexagonal(material: Material) -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let (across, rows) = (8, 8);
    let mut random = Random::new(5);
    let mut grains = Vec::new();
    for row in 0..rows {
        for k in 0..across - row % 2 {
            let x = RADIUS * (1.0 + 2.0 * k as f64 + (row % 2) as f64);
            let y = RADIUS * (1.0 + 3.0_f64.sqrt() * row as f64);
            let place = DVec2::new(x, y) + random.vector::<D2>(1e-9);
            grains.push(Grain::at(place, RADIUS, glass));
        }
    }
    let width = 2.0 * RADIUS * across as f64;
    let walls = vec![
        Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap(),
        Wall::plane("left", DVec2::ZERO, DVec2::X, glass).unwrap(),
        Wall::plane("right", DVec2::new(width, 0.0), -DVec2::X, glass).unwrap(),
    ];
    let gravity = DVec2::new(0.0, -WEIGHT);
    Dem2::new(Setup { materials, grains, walls, gravity, options: Options::default() }).unwrap()
}

/// Whether a settled packing stays at rest with a step of this share of the limit.
fn stays(material: Material, share: f64) -> bool {
    let mut dem = hexagonal(material);
    let limit = dem.stable_step();
    dem.advance(0.2 * limit, 20_000).unwrap();
    let (rest, scale) = (dem.energies().translational(), dem.energies().contact);
    assert!(rest < 1e-4 * scale, "{rest:e} {scale:e}");
    for _ in 0..20 {
        if dem.advance(share * limit, 100).is_err() {
            return false;
        }
    }
    dem.energies().translational() < rest.max(1e-12 * scale) * 10.0
}

#[test]
fn a_hexagonal_packing_is_stable_at_the_limit_and_the_limit_is_not_far_off() {
    for (name, material) in [
        ("friction", Material::default()),
        ("no friction", Material { friction: 0.0, ..Material::default() }),
        ("strong damping", Material { restitution: 0.2, ..Material::default() }),
        ("soft tangential", Material { stiffness_ratio: 0.2, damping_ratio: 0.1, ..Material::default() }),
    ] {
        assert!(stays(material, 1.0), "{name}: not stable at the predicted limit");
        let mut share = 1.0;
        while share < 4.0 && stays(material, share + 0.05) {
            share += 0.05;
        }
        println!("hexagonal packing, {name}: observed over predicted limit {share:.2}");
        assert!(share < 3.0, "{name}: the predicted limit is {share} times too small");
    }
}

#[test]
fn dense_boxes_of_disks_and_spheres_do_not_gain_energy_at_the_limit() {
    fn gain<D: Dim>(side: usize, material: Material) -> f64 {
        let mut materials = Materials::new();
        let glass = materials.add(material).unwrap();
        let lattice = Lattice { side, speed: 0.01, ..Lattice::default() };
        let mut dem = free::<D>(materials, lattice.grains(&[glass]), Options::default());
        let start = dem.energies().mechanical();
        let dt = dem.stable_step();
        dem.advance(dt, 1000).unwrap();
        dem.energies().mechanical() / start
    }
    let rough = Material { restitution: 0.5, ..Material::default() };
    let smooth = Material { friction: 0.0, ..rough };
    for material in [rough, smooth] {
        let (disks, spheres) = (gain::<D2>(12, material), gain::<D3>(6, material));
        assert!(disks < 1.0 && spheres < 1.0, "{disks} {spheres}");
    }
}

//! Samples that are made hostile.

use granular_core::glam::DVec2;
use granular_core::{D2, Dim, Section, Solver};
use granular_dem::{Dem2, Grain, Material, Materials, Options, Setup, SetupError, Wall};
use granular_driver::failure::Failure;

const RADIUS: f64 = 1e-3;
/// Part of all lengths by which samples are squeezed between walls.
const SQUEEZE: f64 = 1e-3;
const FITS: &str = "the sample is in range";

/// How grains are arranged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// So many rows of a hexagonal packing, as wide as it is high.
    Hexagonal(usize),
    /// A small grain, one larger by this ratio, and a small one, upwards.
    Row(f64),
}

/// Disks squeezed between four walls: they touch with and without gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Squeezed {
    pub(super) shape: Shape,
    pub(super) material: Material,
    /// Downwards \[m/s^2\].
    pub(super) gravity: f64,
}

impl Default for Squeezed {
    fn default() -> Self {
        Self { shape: Shape::Hexagonal(8), material: Material::default(), gravity: 9.81 }
    }
}

/// A sample at rest.
pub(super) struct Calm {
    state: Section,
    /// In the springs of its contacts \[J/m\].
    pub(super) energy: f64,
}

impl Squeezed {
    /// Places and radii before the squeeze, and the size of the box.
    fn grains(&self) -> (Vec<(DVec2, f64)>, DVec2) {
        match self.shape {
            Shape::Hexagonal(rows) => {
                let height = 3.0_f64.sqrt() * RADIUS;
                let row = |row: usize| {
                    let shift = (row % 2) as f64;
                    (0..rows - row % 2).map(move |k| {
                        let x = RADIUS * (1.0 + 2.0 * k as f64 + shift);
                        (DVec2::new(x, RADIUS + height * row as f64), RADIUS)
                    })
                };
                let size = DVec2::new(2.0 * RADIUS * rows as f64, 2.0 * RADIUS + height * (rows - 1) as f64);
                ((0..rows).flat_map(row).collect(), size)
            }
            Shape::Row(ratio) => {
                let (small, large) = (RADIUS, ratio * RADIUS);
                // Side walls hold the large grain: a free row under pressure buckles with any step.
                let middle = large;
                let at = |y: f64, radius: f64| (DVec2::new(middle, y), radius);
                let list = vec![
                    at(small, small),
                    at(2.0 * small + large, large),
                    at(3.0 * small + 2.0 * large, small),
                ];
                (list, DVec2::new(2.0 * middle, 4.0 * small + 2.0 * large))
            }
        }
    }

    /// The sample before it comes to rest.
    pub(super) fn build(&self) -> Result<Dem2, SetupError> {
        let mut materials = Materials::new();
        let glass = materials.add(self.material)?;
        let (list, size) = self.grains();
        // Small grains are squeezed as far as large ones: by a part of their own size.
        let small = SQUEEZE * 2.0 * RADIUS;
        let rows = match self.shape {
            Shape::Hexagonal(rows) => rows as f64,
            Shape::Row(_) => 3.0,
        };
        let shrink = DVec2::ONE - DVec2::splat(small * rows) / size;
        let place = |(place, radius): &(DVec2, f64)| Grain::at(*place * shrink, *radius, glass);
        let grains = list.iter().map(place).collect();
        let size = size * shrink;
        let walls = vec![
            Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass)?,
            Wall::plane("lid", size, -DVec2::Y, glass)?,
            Wall::plane("left", DVec2::ZERO, DVec2::X, glass)?,
            Wall::plane("right", size, -DVec2::X, glass)?,
        ];
        let (gravity, options) = (DVec2::new(0.0, -self.gravity), Options::default());
        Dem2::new(Setup { materials, grains, walls, gravity, options })
    }

    /// The sample at rest, and its longest stable step \[s\].
    pub(super) fn calm(&self) -> Result<(Calm, f64), Failure> {
        let mut dem = self.build().map_err(|error| Failure::Invalid(error.to_string()))?;
        let stable = dem.stable_step();
        for _ in 0..100 {
            dem.advance(0.2 * stable, 100)?;
            dem.stop_motion();
        }
        let mut state = Section::new("solver");
        dem.save(&mut state);
        Ok((Calm { state, energy: dem.energies().contact }, stable))
    }
}

impl Calm {
    /// The sample as it came to rest, and a nudge: a change of gravity that moves the heaviest grain by a thousandth of
    /// its squeeze. A sample that is not disturbed at all would rest with any step.
    pub(super) fn again(&self, sample: &Squeezed) -> Result<Dem2, Failure> {
        let mut dem = sample.build().map_err(|error| Failure::Invalid(error.to_string()))?;
        dem.restore(&self.state)?;
        let largest = dem.grains().map(|(_, grain)| grain.radius).fold(0.0, f64::max);
        let mass = sample.material.density * D2::ball_volume(largest);
        let nudge = 1e-3 * sample.material.normal_stiffness * SQUEEZE * 2.0 * RADIUS / mass;
        let gravity = dem.gravity();
        dem.set_gravity(gravity + DVec2::new(0.6, 0.8) * nudge);
        Ok(dem)
    }
}

/// Length of the box in which a grain is shot \[m\].
const BOX: f64 = 20.0 * RADIUS;
/// Distance that a shot grain flies \[m\].
pub(super) const FLIGHT: f64 = 3.0 * BOX;

/// A grain that flies at another one, which stands before a wall.
pub(super) fn shot(speed: f64, stiffness: f64) -> Dem2 {
    let mut materials = Materials::new();
    let glass = Material::default();
    let glass = Material { normal_stiffness: stiffness * glass.normal_stiffness, ..glass };
    let glass = materials.add(glass).expect(FITS);
    let middle = 0.5 * BOX;
    let grains = vec![
        Grain::at(DVec2::new(0.2 * BOX, middle), RADIUS, glass).moving(DVec2::X * speed),
        Grain::at(DVec2::new(0.7 * BOX, middle + 0.1 * RADIUS), RADIUS, glass),
    ];
    let wall = |name: &str, point: DVec2, normal: DVec2| Wall::plane(name, point, normal, glass).expect(FITS);
    let high = DVec2::splat(BOX);
    let walls = vec![
        wall("floor", DVec2::ZERO, DVec2::Y),
        wall("lid", high, -DVec2::Y),
        wall("left", DVec2::ZERO, DVec2::X),
        wall("right", high, -DVec2::X),
    ];
    let (gravity, options) = (DVec2::ZERO, Options::default());
    Dem2::new(Setup { materials, grains, walls, gravity, options }).expect(FITS)
}

/// Two grains and a wall that overlap by a part of the radius.
pub(super) fn touching(overlap: f64) -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).expect(FITS);
    let first = RADIUS * (1.0 - overlap);
    let grains = vec![
        Grain::at(DVec2::new(first, 0.0), RADIUS, glass),
        Grain::at(DVec2::new(first + RADIUS * (2.0 - overlap), 0.0), RADIUS, glass),
    ];
    let walls = vec![Wall::plane("left", DVec2::ZERO, DVec2::X, glass).expect(FITS)];
    let (gravity, options) = (DVec2::ZERO, Options::default());
    Dem2::new(Setup { materials, grains, walls, gravity, options }).expect(FITS)
}

/// A packing in motion, and a grain that flew off.
pub(super) fn flung(distance: f64) -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).expect(FITS);
    let (list, _) = Squeezed { shape: Shape::Hexagonal(20), ..Squeezed::default() }.grains();
    let velocity = |place: DVec2| DVec2::new(-place.y, place.x) * 50.0;
    let mut grains: Vec<_> = list
        .into_iter()
        .map(|(place, radius)| Grain::at(place, radius, glass).moving(velocity(place)))
        .collect();
    grains.push(Grain::at(DVec2::new(distance, distance), RADIUS, glass).moving(DVec2::splat(10.0)));
    let (gravity, options) = (DVec2::ZERO, Options { skin: 0.05, ..Options::default() });
    Dem2::new(Setup { materials, grains, walls: Vec::new(), gravity, options }).expect(FITS)
}

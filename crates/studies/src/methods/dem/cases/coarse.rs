//! Coarse graining: what is conserved, lattices with closed forms, and a box at rest.

use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::glam::DVec2;
use granular_core::random::Chance;
use granular_core::{D2, D3, Dim, Linear, Solver, SymmetricTensor, Vector};
use granular_dem::{CoarseFields, CoarseGrid, Dem, Grain, Material, Materials, Options, Setup, Wall};
use granular_driver::failure::Failure;

const RADIUS: f64 = 1e-3;
const STIFFNESS: f64 = 1e5;
const GRAVITY: f64 = 9.81;
const ROUND_OFF: f64 = 1e-12;
const FITS: &str = "the sample is in range";

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    conserved::<D2>(rows, 20)?;
    conserved::<D3>(rows, 6)?;
    lattice::<D2>(rows, 12);
    lattice::<D3>(rows, 8);
    hexagonal(rows);
    sheared(rows);
    at_rest(rows)
}

fn material() -> Material {
    Material { normal_stiffness: STIFFNESS, friction: 0.0, ..Material::default() }
}

fn everywhere<D: Dim>(length: f64) -> D::Vec {
    D::Vec::splat(length)
}

/// Graded grains on a loose lattice with random velocities, between smooth walls on all sides but the top.
fn boxed<D: Dim>(side: usize, speed: f64, material: Material) -> (Dem<D>, f64) {
    let mut chance = Chance::new(3);
    let mut materials = Materials::new();
    let glass = materials.add(material).expect(FITS);
    let smooth = materials.add(Material { friction: 0.0, ..material }).expect(FITS);
    let pitch = 2.1 * RADIUS;
    let grain = |index: usize| {
        let place = |axis: usize| index / side.pow(axis as u32) % side;
        let position = (0..D::N)
            .fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, pitch * (place(axis) as f64 + 0.5)));
        let velocity = (0..D::N)
            .fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, chance.between(-speed, speed)));
        Grain::at(position, RADIUS * chance.between(0.8, 1.0), glass).moving(velocity)
    };
    let grains = (0..side.pow(D::N as u32)).map(grain).collect();
    let size = pitch * side as f64;
    let mut walls = Vec::new();
    for axis in 0..D::N {
        let normal = D::Vec::along(axis, 1.0);
        let low = Wall::plane(&format!("low {axis}"), D::Vec::ZERO, normal, smooth);
        walls.push(low.expect(FITS));
        if axis != D::UP {
            let high = Wall::plane(&format!("high {axis}"), normal * size, -normal, smooth);
            walls.push(high.expect(FITS));
        }
    }
    let gravity = D::Vec::along(D::UP, -GRAVITY);
    let options = Options::default();
    (Dem::new(Setup { materials, grains, walls, gravity, options }).expect(FITS), size)
}

fn conserved<D: Dim>(rows: &mut Rows, side: usize) -> Result<(), Failure> {
    let (mut dem, size) = boxed::<D>(side, 0.5, Material { friction: 0.5, ..material() });
    dem.advance(dem.recommended_step(), 500)?;
    let spacing = 1.7 * RADIUS;
    let margin = 5.0 * spacing;
    let grid = CoarseGrid::<D>::new(everywhere::<D>(-margin), everywhere::<D>(size + margin), spacing, 1);
    let fields = dem.coarse_fields(&grid.expect(FITS));
    let density = material().density;
    let mass = |grain: &Grain<D>| density * D::ball_volume(grain.radius);
    let total: f64 = dem.grains().map(|(_, grain)| mass(&grain)).sum();
    let scale: f64 = dem.grains().map(|(_, grain)| mass(&grain) * grain.velocity.length()).sum();
    let volume = fields.grid().cell_volume();
    let found: f64 = fields.density().iter().map(|density| density * volume).sum();
    let name = D::BALL;
    let note = format!("{} {name}s in collisions, {} cells", dem.len(), fields.density().len());
    let tier = Tier::Conservation;
    let metric = format!("{name}s: mass in cells, over that of grains");
    let measure = Measure::absolute(tier, metric, (found + fields.mass_outside()) / total, 1.0, ROUND_OFF);
    rows.add(measure.note(&note));
    let found = fields.momentum().iter().fold(D::Vec::ZERO, |sum, &p| sum + p * volume);
    let missed = (found - dem.momentum()).length() / scale;
    let metric = format!("{name}s: momentum in cells less that of grains");
    let measure = Measure::absolute(tier, metric, missed, 0.0, ROUND_OFF);
    rows.add(measure.note("scaled by the sum of magnitudes"));
    Ok(())
}

/// Equal grains at these places, which move at these velocities; nothing else.
fn equal<D: Dim>(places: impl Iterator<Item = D::Vec>, velocity: impl Fn(D::Vec) -> D::Vec) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material()).expect(FITS);
    let grains = places.map(|place| Grain::at(place, RADIUS, glass).moving(velocity(place))).collect();
    let (gravity, options) = (D::Vec::ZERO, Options::default());
    Dem::new(Setup { materials, grains, walls: Vec::new(), gravity, options }).expect(FITS)
}

/// Spacing of lattices, and the overlap of their contacts \[m\].
const PITCH: f64 = 1.99 * RADIUS;
const OVERLAP: f64 = 2.0 * RADIUS - PITCH;

/// A square or cubic lattice on the cells of its grid, and the cells whose kernel lies within.
fn square<D: Dim>(side: usize, velocity: impl Fn(D::Vec) -> D::Vec) -> (CoarseFields<D>, Vec<usize>) {
    let place = |index: usize| {
        let along = |axis: usize| PITCH * ((index / side.pow(axis as u32) % side) as f64 + 0.5);
        (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, along(axis)))
    };
    let dem = equal::<D>((0..side.pow(D::N as u32)).map(place), velocity);
    let grid = CoarseGrid::new(D::Vec::ZERO, everywhere::<D>(PITCH * side as f64), PITCH, 1).expect(FITS);
    let [nx, ny, _] = grid.cells();
    let is_inside = |&cell: &usize| {
        let place = [cell % nx, cell / nx % ny, cell / (nx * ny)];
        place[..D::N].iter().all(|&place| place >= 3 && place + 3 < side)
    };
    let inside = (0..side.pow(D::N as u32)).filter(is_inside).collect();
    (dem.coarse_fields(&grid), inside)
}

/// The value farthest from a reference among some cells.
fn farthest(values: &[f64], cells: &[usize], reference: f64) -> f64 {
    let distance = |cell: &&usize| (values[**cell] - reference).abs();
    let worst = cells.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
    worst.map_or(f64::NAN, |&cell| values[cell])
}

fn lattice<D: Dim>(rows: &mut Rows, side: usize) {
    let (fields, inside) = square::<D>(side, |_| D::Vec::ZERO);
    let stress = fields.contact_stress();
    let exact = STIFFNESS * OVERLAP * PITCH / PITCH.powi(D::N as i32);
    let ball = D::BALL;
    let up = |stress: &SymmetricTensor| [stress.xx, stress.yy, stress.zz][D::UP];
    let found = farthest(&stress.iter().map(up).collect::<Vec<_>>(), &inside, exact);
    let metric = format!("lattice of {ball}s: vertical stress [Pa]");
    let measure = Measure::relative(Tier::ClosedForm, metric, found, exact, 1e-10);
    rows.add(measure.note(format!("worst of {} cells", inside.len())));
    let shear = farthest(&stress.iter().map(|s| s.xy).collect::<Vec<_>>(), &inside, 0.0);
    let metric = format!("lattice of {ball}s: shear stress over vertical stress");
    rows.add(Measure::absolute(Tier::ClosedForm, metric, shear / exact, 0.0, 1e-10));
    let contacts = farthest(&fields.coordination(), &inside, 2.0 * D::N as f64);
    let metric = format!("lattice of {ball}s: contacts per grain");
    rows.add(Measure::absolute(Tier::ClosedForm, metric, contacts, 2.0 * D::N as f64, 1e-10));
}

fn hexagonal(rows: &mut Rows) {
    let (across, up) = (30, 34);
    let height = 0.5 * 3.0_f64.sqrt() * PITCH;
    let place = |index: usize| {
        let (column, row) = (index % across, index / across);
        DVec2::new(PITCH * (column as f64 + 0.5 * (row % 2) as f64), height * row as f64)
    };
    let dem = equal::<D2>((0..across * up).map(place), |_| DVec2::ZERO);
    let (width, middle) = (2, 10.0 * PITCH);
    let grid = CoarseGrid::<D2>::new(DVec2::splat(middle), DVec2::splat(1.9 * middle), PITCH, width);
    let stress = dem.coarse_fields(&grid.expect(FITS)).contact_stress();
    let exact = 3.0_f64.sqrt() * STIFFNESS * OVERLAP / PITCH;
    let all: Vec<usize> = (0..stress.len()).collect();
    for (name, of) in [("horizontal", 0), ("vertical", 1)] {
        let values: Vec<f64> = stress.iter().map(|s| [s.xx, s.yy][of]).collect();
        let found = farthest(&values, &all, exact);
        let metric = format!("hexagonal lattice: {name} stress [Pa]");
        let measure = Measure::relative(Tier::ClosedForm, metric, found, exact, 1e-3);
        rows.add(measure.note(format!("worst of {} cells, kernel of two spacings", all.len())));
    }
}

/// A square lattice whose rows slide past one another: inertial number with the kinetic pressure of the kernel.
fn sheared(rows: &mut Rows) {
    let rate = 7.0;
    let (fields, inside) = square::<D2>(12, |x| DVec2::X * (rate * x.y));
    let bulk = material().density * D2::ball_volume(RADIUS) / PITCH.powi(2);
    let pressure = STIFFNESS * OVERLAP / PITCH + 0.5 * bulk * (rate * PITCH).powi(2) / 3.0;
    let exact = rate * 2.0 * RADIUS * (material().density / pressure).sqrt();
    let found = farthest(&fields.inertial_number(), &inside, exact);
    rows.add(Measure::relative(Tier::ClosedForm, "sheared lattice: inertial number", found, exact, 1e-10));
    let found = farthest(&fields.shear_rate(), &inside, rate);
    rows.add(Measure::relative(Tier::ClosedForm, "sheared lattice: shear rate [1/s]", found, rate, 1e-10));
}

/// Disks that came to rest in a box of smooth walls.
fn at_rest(rows: &mut Rows) -> Result<(), Failure> {
    let rough = Material { friction: 0.5, restitution: 0.2, ..material() };
    let (mut dem, size) = boxed::<D2>(20, 0.05, rough);
    let dt = dem.recommended_step();
    dem.advance(dt, (1.0 / dt) as u64)?;
    let spacing = 2.0 * RADIUS;
    let margin = 5.0 * spacing;
    let grid = CoarseGrid::<D2>::new(DVec2::splat(-margin), DVec2::splat(size + margin), spacing, 1);
    let fields = dem.coarse_fields(&grid.expect(FITS));
    let volume = fields.grid().cell_volume();
    let mut total = SymmetricTensor::ZERO;
    fields.contact_stress().iter().for_each(|&stress| total += stress * volume);
    let wall = |name: &str| {
        let index = dem.walls().iter().position(|wall| wall.name == name);
        index.map_or(DVec2::splat(f64::NAN), |index| dem.wall_forces()[index])
    };
    let mass = |grain: &Grain<D2>| material().density * D2::ball_volume(grain.radius);
    let note = format!(
        "kinetic over contact energy {:.0e}",
        dem.energies().translational() / dem.energies().contact
    );
    let tier = Tier::Identity;
    let side = wall("high 0").x * size;
    let metric = "box at rest: horizontal stress in cells, of the side wall [N m/m]";
    rows.add(Measure::relative(tier, metric, total.xx, side, 1e-4).note(note));
    let weights: f64 = dem.grains().map(|(_, grain)| mass(&grain) * GRAVITY * grain.position.y).sum();
    let metric = "box at rest: vertical stress in cells, of weights [N m/m]";
    rows.add(Measure::relative(tier, metric, total.yy, weights, 1e-4));
    let weight: f64 = dem.grains().map(|(_, grain)| mass(&grain) * GRAVITY).sum();
    let found: f64 = fields.wall_force().iter().map(|force| force.y * volume).sum();
    let metric = "box at rest: force of walls in cells over the weight";
    rows.add(Measure::absolute(tier, metric, found / weight, 1.0, 1e-4));
    hydrostatic(rows, &fields, size);
    Ok(())
}

/// The vertical stress in a row of cells against the weight above its middle.
fn hydrostatic(rows: &mut Rows, fields: &CoarseFields<D2>, width: f64) {
    let [columns, layers, _] = fields.grid().cells();
    let spacing = fields.grid().spacing();
    let (stress, density) = (fields.contact_stress(), fields.density());
    let row = |values: &dyn Fn(usize) -> f64, layer: usize| -> f64 {
        (0..columns).map(|column| values(layer * columns + column)).sum::<f64>() * spacing / width
    };
    let (mut above, mut worst, mut largest) = (0.0, 0.0_f64, 0.0_f64);
    for layer in (0..layers).rev() {
        let weight = row(&|cell| density[cell], layer) * GRAVITY * spacing;
        let expected = above + 0.5 * weight;
        above += weight;
        // Cells into which the kernel spreads the force of the floor carry less.
        if fields.grid().centre([0, layer, 0]).y < 2.0 * spacing {
            break;
        }
        let found = row(&|cell| stress[cell].yy, layer);
        largest = largest.max(expected);
        worst = worst.max((found - expected).abs());
    }
    let metric = "box at rest: vertical stress less the weight above, worst row over the largest";
    let measure = Measure::absolute(Tier::Identity, metric, worst / largest, 0.0, 0.01);
    rows.add(measure.note(format!("largest {largest:.1} Pa")));
}

//! Boundaries: stress of contacts against forces on walls, walls that move, and surfaces of many parts.

use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::random::Chance;
use granular_core::{D2, D3, Dim, Linear, Solver, StepError, Vector};
use granular_dem::{
    Dem, Grain, Material, MaterialId, Materials, Options, Partner, Servo, Setup, Shape, Wall, WallMotion,
};
use granular_driver::failure::Failure;
use std::f64::consts::TAU;

const FITS: &str = "walls and grains of this case are in range";
const GRAVITY: f64 = 9.81;

/// Stress of contacts, the sum of `branch (x) force` over the volume \[Love1927\], against forces on walls over areas.
pub(super) fn wall_forces(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let sides = if effort == Effort::Full { (24, 10) } else { (10, 5) };
    pressed::<D2>(rows, sides.0)?;
    Ok(pressed::<D3>(rows, sides.1)?)
}

fn pressed<D: Dim>(rows: &mut Rows, side: usize) -> Result<(), StepError> {
    let spacing = 1e-3;
    let far = spacing * side as f64;
    let mut materials = Materials::new();
    // A contact lasts as long in space as in the plane, so that as much happens in as many steps.
    let one = Material::default().density * D::ball_volume(0.46e-3);
    let normal_stiffness = one * 3e4_f64.powi(2);
    let material = Material { restitution: 0.5, friction: 0.3, normal_stiffness, ..Material::default() };
    let glass = materials.add(material).expect(FITS);
    // Friction at the walls would add shear to the stress of the box.
    let smooth = materials.add(Material { friction: 0.0, ..material }).expect(FITS);
    let mut chance = Chance::new(3);
    let grain = |index: usize, chance: &mut Chance| {
        let place = (0..D::N).fold(D::Vec::ZERO, |place, axis| {
            let row = index / side.pow(axis as u32) % side;
            place + D::Vec::along(axis, spacing * (row as f64 + 0.5))
        });
        Grain::at(place, chance.between(0.42e-3, 0.5e-3), glass)
    };
    let grains: Vec<Grain<D>> = (0..side.pow(D::N as u32)).map(|index| grain(index, &mut chance)).collect();
    let mass = grains.len() as f64 * one;
    let mut walls = Vec::new();
    for axis in 0..D::N {
        let along = D::Vec::along(axis, 1.0);
        walls.push(Wall::plane(&format!("{axis}low"), D::Vec::ZERO, along, smooth).expect(FITS));
        // Other pressures along other axes.
        let area = side.pow(D::N as u32 - 1) as f64;
        let force = (1.0 + axis as f64) * 1e-7 * normal_stiffness * area;
        let servo =
            Servo { direction: -along, force, pressure: None, mass, damping: force / 0.1, max_speed: 1.0 };
        let lid = Wall::plane(&format!("{axis}high"), along * far, -along, smooth).expect(FITS);
        walls.push(lid.moving(WallMotion::Servo(servo)));
    }
    let options = Options::default();
    let mut dem = Dem::new(Setup { materials, grains, walls, gravity: D::Vec::ZERO, options }).expect(FITS);
    let dt = dem.recommended_step();
    // At rest when opposite walls feel the same.
    let mut rounds = 0;
    while rounds < 120 && unbalanced(&dem) > 1e-5 {
        dem.advance(dt, 2000)?;
        rounds += 1;
    }
    compare(rows, &dem);
    Ok(())
}

/// Largest sum of forces on opposite walls over the force on one.
fn unbalanced<D: Dim>(dem: &Dem<D>) -> f64 {
    let forces = dem.wall_forces();
    let of_axis = |axis: usize| {
        let [low, high] = [0, 1].map(|side| forces[2 * axis + side].component(axis));
        if high == 0.0 { f64::INFINITY } else { (low + high).abs() / high }
    };
    (0..D::N).map(of_axis).fold(0.0, f64::max)
}

/// Rows of diagonal stresses. Wall `2 a` is at zero on axis `a`, wall `2 a + 1` opposite.
fn compare<D: Dim>(rows: &mut Rows, dem: &Dem<D>) {
    let grains: Vec<Grain<D>> = dem.grains().map(|(_, grain)| grain).collect();
    let mut sums = [0.0; 3];
    dem.visit_contacts(&mut |contact| {
        let first = &grains[contact.first];
        let branch = match contact.partner {
            Partner::Grain(second) => first.position - grains[second].position,
            Partner::Wall(_) => contact.normal * (first.radius - contact.overlap),
        };
        for (axis, sum) in sums.iter_mut().enumerate().take(D::N) {
            *sum += branch.component(axis) * contact.force.component(axis);
        }
    });
    let forces = dem.wall_forces();
    let extent: Vec<f64> = (0..D::N).map(|axis| dem.wall_position(2 * axis + 1).component(axis)).collect();
    let volume: f64 = extent.iter().product();
    for axis in 0..D::N {
        let of_walls = forces[2 * axis + 1].component(axis) * extent[axis] / volume;
        let name = format!("{}s: stress of contacts along {} [Pa]", D::BALL, D::AXES[axis]);
        let measure = Measure::relative(Tier::Identity, name, sums[axis] / volume, of_walls, 1e-4);
        rows.add(measure.note("against the force on the wall over its area"));
    }
    let name = format!("{}s: sum of forces on opposite walls over one", D::BALL);
    rows.add(Measure::absolute(Tier::Conservation, name, unbalanced(dem), 0.0, 1e-4));
}

/// Closed forms of moving walls, and the energy they put in.
pub(super) fn moving_walls(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    piston::<D2>(rows)?;
    piston::<D3>(rows)?;
    belt::<D2>(rows)?;
    belt::<D3>(rows)?;
    squeezed(rows)?;
    shaken::<D2>(rows, 16, 1.0)?;
    Ok(shaken::<D3>(rows, 6, 10.0)?)
}

fn one_on<D: Dim>(material: Material, motion: WallMotion<D>, gap: f64, gravity: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).expect(FITS);
    let up = D::Vec::along(D::UP, 1.0);
    let wall = Wall::plane("wall", D::Vec::ZERO, up, glass).expect(FITS).moving(motion);
    let grains = vec![Grain::at(up * (1e-3 + gap), 1e-3, glass)];
    let options = Options { ledger: true, ..Options::default() };
    Dem::new(Setup { materials, grains, walls: vec![wall], gravity: up * -gravity, options }).expect(FITS)
}

/// A piston that hits a ball at rest gives it its speed times one and the restitution.
fn piston<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let (speed, restitution) = (1.0, 0.6);
    let material = Material { restitution, friction: 0.0, ..Material::default() };
    let motion = WallMotion::Steady { velocity: D::Vec::along(D::UP, speed) };
    let mut dem = one_on::<D>(material, motion, 1e-5, 0.0);
    let dt = 0.1 * dem.recommended_step();
    dem.advance(dt, 1200)?;
    let metric = format!("{}: speed after a hit by a piston [m/s]", D::BALL);
    let found = dem.grain(0).velocity.component(D::UP);
    rows.add(Measure::relative(Tier::ClosedForm, metric, found, (1.0 + restitution) * speed, 1e-4));
    let momentum = dem.momentum().component(D::UP);
    let metric = format!("{}: work of the piston over momentum and its speed", D::BALL);
    rows.add(Measure::relative(Tier::Conservation, metric, dem.wall_work() / (momentum * speed), 1.0, 1e-9));
    Ok(())
}

/// On a belt a ball slides until its rim has the speed of the belt: it then moves at 1/3 (disk) or 2/7 (sphere) of it.
fn belt<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let (speed, friction) = (0.05, 0.2);
    let material = Material { restitution: 0.2, friction, ..Material::default() };
    let motion = WallMotion::Steady { velocity: D::Vec::along(0, speed) };
    let mut dem = one_on::<D>(material, motion, 0.0, GRAVITY);
    let dt = dem.recommended_step();
    let sliding = speed / (friction * GRAVITY);
    dem.advance(dt, (sliding / dt) as u64)?;
    let share = D::BALL_INERTIA / (1.0 + D::BALL_INERTIA);
    let found = dem.grain(0).velocity.component(0) / speed;
    let metric = format!("{}: speed of rolling on a belt over that of the belt", D::BALL);
    rows.add(Measure::relative(Tier::ClosedForm, metric, found, share, 2e-3));
    Ok(())
}

/// A lid under a force on one disk between it and a floor: two springs in a row, and twice the force at the lowest point.
fn squeezed(rows: &mut Rows) -> Result<(), StepError> {
    let mut materials = Materials::new();
    let material = Material { restitution: 1.0, friction: 0.0, ..Material::default() };
    let glass = materials.add(material).expect(FITS);
    let up = <D2 as Dim>::Vec::along(1, 1.0);
    let (mass, force) = (10.0, 1.0);
    let servo = Servo { direction: -up, force, pressure: None, mass, damping: 0.0, max_speed: f64::INFINITY };
    let lid = Wall::plane("lid", up * 2e-3, -up, glass).expect(FITS).moving(WallMotion::Servo(servo));
    let floor = Wall::plane("floor", up * 0.0, up, glass).expect(FITS);
    let grains = vec![Grain::at(up * 1e-3, 1e-3, glass)];
    let (gravity, options) = (up * 0.0, Options::default());
    let setup = Setup { materials, grains, walls: vec![floor, lid], gravity, options };
    let mut dem = Dem::<D2>::new(setup).expect(FITS);
    let stiffness = 0.5 * material.normal_stiffness;
    let period = TAU * (mass / stiffness).sqrt();
    let dt = dem.recommended_step();
    let (mut steps, mut lowest, mut before) = (0_u64, f64::NAN, 0.0);
    // The lid turns where its height is least.
    while lowest.is_nan() {
        dem.advance(dt, 1)?;
        steps += 1;
        let depth = 2e-3 - dem.wall_position(1).component(1);
        if depth < before {
            lowest = before;
        }
        before = depth;
    }
    let metric = "disk: deepest squeeze by a lid under a force [nm]";
    rows.add(Measure::relative(Tier::ClosedForm, metric, 1e9 * lowest, 2e9 * force / stiffness, 5e-3));
    let metric = "disk: time of the deepest squeeze over half the period";
    let found = (steps as f64 - 1.0) * dt / (0.5 * period);
    rows.add(Measure::relative(Tier::ClosedForm, metric, found, 1.0, 1e-2));
    Ok(())
}

/// A box with a side that swings, one that is pushed by a force, a floor that rises and a beam that turns.
fn shaken<D: Dim>(rows: &mut Rows, side: usize, speed: f64) -> Result<(), StepError> {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).expect(FITS);
    let (far, mut chance) = (1e-3 * side as f64, Chance::new(8));
    let random = |chance: &mut Chance, size: f64| {
        (0..D::N).fold(D::Vec::ZERO, |v, axis| v + D::Vec::along(axis, chance.between(-size, size)))
    };
    let middle = D::Vec::splat(0.5 * far);
    let arm = D::Vec::along(0, 0.25 * far);
    let beam = Wall::segment("beam", middle - arm, middle + arm, glass).expect(FITS);
    let spin = <D::Spin as granular_core::Spin>::about_z(300.0 * speed);
    let mut walls = vec![beam.moving(WallMotion::Turning { about: middle, spin })];
    for axis in 0..D::N {
        let along = D::Vec::along(axis, 1.0);
        walls.push(Wall::plane(&format!("{axis}low"), D::Vec::ZERO, along, glass).expect(FITS));
        walls.push(Wall::plane(&format!("{axis}high"), along * far, -along, glass).expect(FITS));
    }
    let along = D::Vec::along(0, 1.0);
    let (frequency, amplitude) = (2000.0 * speed, along * 20e-6);
    walls[1].motion = Some(WallMotion::Oscillating { amplitude, frequency, phase: 0.3 });
    let servo =
        Servo { direction: -along, force: 20.0, pressure: None, mass: 0.02, damping: 5.0, max_speed: speed };
    walls[2].motion = Some(WallMotion::Servo(servo));
    walls[3].motion = Some(WallMotion::Steady { velocity: D::Vec::along(1, 0.1 * speed) });
    let place = |index: usize| {
        (0..D::N).fold(D::Vec::ZERO, |v, axis| {
            v + D::Vec::along(axis, 1e-3 * ((index / side.pow(axis as u32) % side) as f64 + 0.5))
        })
    };
    let mut grains: Vec<Grain<D>> = (0..side.pow(D::N as u32))
        .map(|index| {
            let at = place(index) + random(&mut chance, 30e-6);
            let velocity = random(&mut chance, speed);
            Grain::at(at, chance.between(0.40e-3, 0.46e-3), glass).moving(velocity)
        })
        .collect();
    grains.retain(|grain| walls[0].shape.distance(grain.position).0 > grain.radius);
    let options = Options { ledger: true, ..Options::default() };
    let gravity = D::Vec::along(D::UP, -GRAVITY);
    let mut dem = Dem::new(Setup { materials, grains, walls, gravity, options }).expect(FITS);
    let dt = 0.5 * dem.recommended_step();
    let (start, mut worst) = (dem.energies().mechanical(), 0.0_f64);
    for _ in 0..20 {
        dem.advance(dt, (2e-4 / speed / dt) as u64)?;
        worst = worst.max(dem.energy_residual().unwrap_or(f64::NAN).abs() / start);
    }
    let metric = format!("{}s in a shaken box: largest energy residual [% of E_0]", D::BALL);
    let note = format!("walls put in {:.0} % of E_0", 100.0 * dem.wall_work() / start);
    rows.add(Measure::absolute(Tier::Conservation, metric, 100.0 * worst, 0.0, 0.1).note(note));
    Ok(())
}

/// A ball that bounces, slides and rolls over a flat surface of many parts, and over a plane.
pub(super) fn flat_surface(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let chain = |glass: MaterialId| {
        let points: Vec<_> = uneven(200).into_iter().map(|x| <D2 as Dim>::Vec::along(0, x)).collect();
        Wall::chain("floor", &points, false, glass).expect(FITS)
    };
    over_parts::<D2>(rows, chain)?;
    Ok(over_parts::<D3>(rows, mesh)?)
}

/// Coordinates from -20 mm to 20 mm at uneven distances.
fn uneven(count: usize) -> Vec<f64> {
    let mut chance = Chance::new(4);
    let size = 40e-3 / count as f64;
    (0..=count).map(|k| -20e-3 + size * (k as f64 + chance.between(-0.3, 0.3))).collect()
}

/// Two triangles for each square of an uneven lattice.
fn mesh(glass: MaterialId) -> Wall<D3> {
    let (x, y) = (uneven(60), uneven(61));
    let corner = |i: usize, j: usize| {
        // Sheared, so that no edge is along the path.
        <D3 as Dim>::Vec::along(0, x[i] + 0.2 * y[j]) + <D3 as Dim>::Vec::along(1, y[j])
    };
    let mut corners = Vec::new();
    for i in 0..60 {
        for j in 0..61 {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            corners.extend([a, b, c, a, c, d]);
        }
    }
    Wall::triangles("floor", corners, glass).expect(FITS)
}

fn over_parts<D: Dim>(rows: &mut Rows, parts: impl Fn(MaterialId) -> Wall<D>) -> Result<(), StepError> {
    let run = |wall: &dyn Fn(MaterialId) -> Wall<D>| {
        let mut materials = Materials::new();
        let material =
            Material { restitution: 0.5, friction: 0.3, rolling_friction: 0.02, ..Material::default() };
        let glass = materials.add(material).expect(FITS);
        let up = D::Vec::along(D::UP, 1.0);
        let start = up * 1.05e-3 - D::Vec::along(0, 8e-3);
        let spin = <D::Spin as granular_core::Spin>::of_components([20.0, -30.0, 100.0]);
        let grains = vec![Grain::at(start, 1e-3, glass).moving(D::Vec::along(0, 0.3)).turning(spin)];
        let options = Options { ledger: true, ..Options::default() };
        let gravity = up * -GRAVITY;
        Dem::<D>::new(Setup { materials, grains, walls: vec![wall(glass)], gravity, options }).expect(FITS)
    };
    let plane = |glass| Wall::plane("floor", D::Vec::ZERO, D::Vec::along(D::UP, 1.0), glass).expect(FITS);
    let (mut one, mut many) = (run(&plane), run(&|glass| parts(glass)));
    debug_assert!(matches!(many.walls()[0].shape, Shape::Facets(_)));
    let dt = one.recommended_step();
    let weight = Material::default().density * D::ball_volume(1e-3) * GRAVITY;
    let (mut force, mut losses) = (0.0_f64, 0.0_f64);
    for _ in 0..2000 {
        let steps = (3e-2 / 2000.0 / dt).ceil() as u64;
        one.advance(dt, steps)?;
        many.advance(dt, steps)?;
        force = force.max((one.wall_forces()[0] - many.wall_forces()[0]).length() / weight);
        let (a, b) = (one.losses().total(), many.losses().total());
        losses = losses.max((a - b).abs() / a.max(1e-300));
    }
    let speed = (one.grain(0).velocity - many.grain(0).velocity).length() / 0.3;
    let way = 1e3 * (many.grain(0).position.component(0) + 8e-3);
    for (what, found, tolerance) in [
        ("force over the weight", force, 1e-9),
        ("speed at the end over that at the start", speed, 1e-9),
        ("losses, relative", losses, 1e-9),
    ] {
        let metric = format!("{}: difference to a plane, {what}", D::BALL);
        let note = format!("{way:.1} mm of bouncing, sliding and rolling over parts of 0.2 to 0.9 mm");
        rows.add(Measure::absolute(Tier::Identity, metric, found, 0.0, tolerance).note(note));
    }
    Ok(())
}

//! Weighted Voronoi diagrams: closed forms, and random diagrams against their definition.

use crate::validate::Effort;
use crate::validate::reference::named;
use crate::validate::{Measure, Rows, Tier};
use granular_core::glam::DVec2;
use granular_core::random::Chance;
use granular_driver::failure::Failure;
use granular_tessellate::{Diagram, Domain, TessellationError, encloses, local_densities, periodic_areas};
use granular_validation_data::TESSELLATION;

const ROUND_OFF: f64 = 1e-12;
/// Random diagrams.
const DIAGRAMS: u64 = 200;

pub(super) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    pair(rows)?;
    inside(rows)?;
    lattices(rows)?;
    circle(rows)?;
    own_cells(rows)?;
    random(rows, effort)?;
    points(rows)
}

fn exact(name: &str) -> f64 {
    named(TESSELLATION, name, "exact")
}

fn add(rows: &mut Rows, tier: Tier, metric: &str, found: f64, reference: f64) {
    rows.add(Measure::absolute(tier, metric, found, reference, ROUND_OFF));
}

fn square(half: f64) -> Result<Domain, TessellationError> {
    Domain::rectangle(DVec2::splat(-half), DVec2::splat(half))
}

/// The value farthest from a reference.
fn farthest(values: impl Iterator<Item = f64>, reference: f64) -> f64 {
    let distance = |value: &f64| (value - reference).abs();
    values.max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(f64::NAN)
}

/// Two disks and the curve between them.
fn pair(rows: &mut Rows) -> Result<(), Failure> {
    let (centres, domain) = ([-DVec2::X, DVec2::X], square(2.0)?);
    let equal = Diagram::new(&centres, &[0.3, 0.3])?;
    let area = farthest(equal.cells(&domain).areas().iter().copied(), exact("equal disks"));
    add(rows, Tier::ClosedForm, "two equal disks: area of a cell", area, exact("equal disks"));
    let diagram = Diagram::new(&centres, &[0.5, 0.1])?;
    let cells = diagram.cells(&domain);
    let sides: Vec<_> = cells.boundary(0).into_iter().flatten().filter(|s| s.neighbour.is_some()).collect();
    let border: Vec<DVec2> =
        sides.iter().flat_map(|side| (0..=100).map(|k| side.point(f64::from(k) / 100.0))).collect();
    let axis = border.iter().min_by(|a, b| a.y.abs().total_cmp(&b.y.abs()));
    let crossing = axis.map_or(f64::NAN, |point| point.x);
    add(
        rows,
        Tier::ClosedForm,
        "unequal disks: where the border crosses the axis",
        crossing,
        exact("crossing"),
    );
    let (a, b) = (0.2, 0.96_f64.sqrt());
    let equation = |p: &DVec2| (p.x / a).powi(2) - (p.y / b).powi(2);
    let metric = "unequal disks: x^2/A^2 - y^2/B^2 on the border";
    add(rows, Tier::ClosedForm, metric, farthest(border.iter().map(equation), 1.0), 1.0);
    // The larger disk has the half square and what lies between x = 0 and the branch.
    let top = 2.0 / b;
    let larger = 8.0 + a * b * (top * top.hypot(1.0) + top.asinh());
    add(rows, Tier::ClosedForm, "unequal disks: area of the larger one's cell", cells.areas()[0], larger);
    Ok(())
}

/// A disk within another one, and one that touches from inside.
fn inside(rows: &mut Rows) -> Result<(), Failure> {
    let domain = square(2.0)?;
    for (name, x) in [("hidden", 0.3), ("touching", 0.5)] {
        let diagram = Diagram::new(&[DVec2::ZERO, DVec2::X * x], &[1.0, 0.5])?;
        let metric = format!("{name} disk: area of its cell");
        add(rows, Tier::ClosedForm, &metric, diagram.cells(&domain).areas()[1], exact(name));
    }
    Ok(())
}

fn lattices(rows: &mut Rows) -> Result<(), Failure> {
    let centres: Vec<DVec2> = (0..9).map(|k| DVec2::new(f64::from(k % 3), f64::from(k / 3))).collect();
    let domain = Domain::rectangle(DVec2::splat(-0.5), DVec2::splat(2.5))?;
    let radii = [0.4; 9];
    let diagram = Diagram::new(&centres, &radii)?;
    let cells = diagram.cells(&domain);
    let one = exact("square lattice");
    let worst = farthest(cells.areas().iter().copied(), one);
    add(rows, Tier::ClosedForm, "square lattice: area of a cell", worst, one);
    let density = std::f64::consts::PI * 0.16;
    let worst = farthest(local_densities(&radii, cells.areas()).into_iter(), density);
    add(rows, Tier::ClosedForm, "square lattice: density", worst, density);
    let (across, up, radius) = (6, 4, 0.01);
    let rise = 3.0_f64.sqrt() * radius;
    let edges = [DVec2::X * (2.0 * radius * f64::from(across)), DVec2::Y * (rise * f64::from(up))];
    let place = |k: i32| {
        DVec2::new(radius * f64::from(2 * (k % across) + k / across % 2), rise * f64::from(k / across))
    };
    let centres: Vec<DVec2> = (0..across * up).map(place).collect();
    let radii = vec![radius; centres.len()];
    let densities = local_densities(&radii, &periodic_areas(&centres, &radii, edges)?);
    let closest = exact("hexagonal lattice");
    let worst = farthest(densities.into_iter(), closest);
    let metric = "periodic hexagonal lattice: density";
    let measure = Measure::absolute(Tier::ClosedForm, metric, worst, closest, 1e-9);
    rows.add(measure.note("worst of 24 cells"));
    Ok(())
}

/// A vertex is the centre of a circle that touches three disks.
fn circle(rows: &mut Rows) -> Result<(), Failure> {
    // Disks about a circle of radius 0.75 and centre (0.1, 0.2): closed form by construction.
    let centre = DVec2::new(0.1, 0.2);
    let radii = [0.5, 0.2, 0.05];
    let angles = [0.3, 2.2, 4.4];
    let place = |k: usize| centre + DVec2::from_angle(angles[k]) * (0.75 + radii[k]);
    let centres: Vec<DVec2> = (0..3).map(place).collect();
    let diagram = Diagram::new(&centres, &radii)?;
    let vertex = diagram
        .vertices()
        .iter()
        .min_by(|a, b| (a.position - centre).length().total_cmp(&(b.position - centre).length()));
    let (away, distance) =
        vertex.map_or([f64::NAN; 2].into(), |v| ((v.position - centre).length(), v.distance));
    add(rows, Tier::ClosedForm, "three disks: distance of the vertex from the centre", away, 0.0);
    add(rows, Tier::ClosedForm, "three disks: radius of the circle that touches them", distance, 0.75);
    Ok(())
}

/// Graded disks that do not overlap, on a distorted lattice.
fn own_cells(rows: &mut Rows) -> Result<(), Failure> {
    let mut chance = Chance::new(5);
    let mut disk = |k: i32| {
        let place = DVec2::new(f64::from(k % 20) + 0.5, f64::from(k / 20) + 0.5);
        let radius = chance.between(0.05, 0.48);
        let room = 0.5 - radius;
        let step = DVec2::new(chance.between(-room, room), chance.between(-room, room));
        (place + step, radius)
    };
    let (centres, radii): (Vec<DVec2>, Vec<f64>) = (0..400).map(&mut disk).unzip();
    let domain = Domain::rectangle(DVec2::ZERO, DVec2::splat(20.0))?;
    for (name, weights) in [("weights are radii", radii.clone()), ("no weights", vec![0.0; 400])] {
        let diagram = Diagram::new(&centres, &weights)?;
        let cells = diagram.cells(&domain);
        let cut = |&site: &usize| {
            let sides = cells.boundary(site).into_iter().flatten().filter(|side| side.neighbour.is_some());
            let mut points = sides.flat_map(|side| (0..=50).map(move |k| side.point(f64::from(k) / 50.0)));
            points.any(|point| (point - centres[site]).length() < radii[site] * (1.0 - ROUND_OFF))
        };
        let found = (0..400).filter(cut).count() as f64;
        let metric = format!("400 disks that do not overlap, {name}: cut by their cells");
        if weights[0] > 0.0 {
            add(rows, Tier::Identity, &metric, found, 0.0);
        } else {
            let measure =
                Measure::judged(Tier::Identity, metric, [found, 1.0], f64::from(u8::from(found < 1.0)), 0.0);
            rows.add(measure.note("at least one: why disks have weights"));
        }
    }
    Ok(())
}

/// What random diagrams break.
#[derive(Default)]
struct Broken {
    points: usize,
    wrong: usize,
    hidden: usize,
    area: f64,
    lopsided: usize,
    beyond_euler: usize,
}

fn random(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let side = if effort == Effort::Full { 128 } else { 32 };
    let domain = Domain::rectangle(DVec2::ZERO, DVec2::ONE)?;
    let mut broken = Broken::default();
    for seed in 0..DIAGRAMS {
        let mut chance = Chance::new(seed);
        let count = 1 + (40.0 * chance.uniform()) as usize;
        let largest = [0.0, 0.02, 0.1, 0.3, 0.6][seed as usize % 5];
        let mut disk = || (DVec2::new(chance.uniform(), chance.uniform()), largest * chance.uniform());
        let (centres, radii): (Vec<DVec2>, Vec<f64>) = (0..count).map(|_| disk()).unzip();
        examine(&Diagram::new(&centres, &radii)?, &domain, side, &mut broken);
    }
    let Broken { points, wrong, hidden, area, lopsided, beyond_euler } = broken;
    let metric = format!("{DIAGRAMS} random diagrams: points of a raster in a wrong cell");
    let measure = Measure::absolute(Tier::Identity, metric, wrong as f64, 0.0, 0.0);
    rows.add(measure.note(format!("{points} points; {hidden} hidden disks")));
    add(rows, Tier::Conservation, "random diagrams: area of cells less that of the domain", area, 0.0);
    add(rows, Tier::Identity, "random diagrams: neighbours that are not mutual", lopsided as f64, 0.0);
    let metric = "random diagrams: with more vertices or edges than Euler allows";
    add(rows, Tier::Identity, metric, beyond_euler as f64, 0.0);
    Ok(())
}

/// Compares a diagram with its definition.
fn examine(diagram: &Diagram, domain: &Domain, side: u32, broken: &mut Broken) {
    let cells = diagram.cells(domain);
    let sum: f64 = cells.areas().iter().sum();
    broken.area = farthest([broken.area, sum - domain.area()].into_iter(), 0.0);
    let visible = (0..diagram.len()).filter(|&site| diagram.hidden_by(site).is_none()).count();
    broken.hidden += diagram.len() - visible;
    let too_many = diagram.vertices().len() + 5 > 2 * visible || diagram.edge_count() + 6 > 3 * visible;
    broken.beyond_euler += usize::from(visible >= 3 && too_many);
    let neighbours: Vec<Vec<usize>> = (0..diagram.len()).map(|site| cells.neighbours(site)).collect();
    let mutual = |site: usize| neighbours[site].iter().all(|&other| neighbours[other].contains(&site));
    broken.lopsided += (0..diagram.len()).filter(|&site| !mutual(site)).count();
    let boundaries: Vec<_> = (0..diagram.len()).map(|site| cells.boundary(site)).collect();
    for k in 0..side * side {
        let point = (DVec2::new(f64::from(k % side), f64::from(k / side)) + 0.5) / f64::from(side);
        let distances: Vec<f64> = (0..diagram.len())
            .map(|site| (point - diagram.position(site)).length() - diagram.radius(site))
            .collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        // On a border rounding decides.
        if distances.iter().filter(|distance| **distance < least + ROUND_OFF).count() > 1 {
            continue;
        }
        broken.points += 1;
        let right =
            |(site, boundary): (usize, &Vec<_>)| encloses(boundary, point) == (distances[site] == least);
        broken.wrong += usize::from(!boundaries.iter().enumerate().all(right));
    }
}

/// Disks of one size against polygons cut by every bisector.
fn points(rows: &mut Rows) -> Result<(), Failure> {
    let mut chance = Chance::new(1);
    let centres: Vec<DVec2> = (0..300).map(|_| DVec2::new(chance.uniform(), chance.uniform())).collect();
    let domain = Domain::rectangle(DVec2::ZERO, DVec2::ONE)?;
    let diagram = Diagram::new(&centres, &[0.01; 300])?;
    let areas = diagram.cells(&domain).areas().to_vec();
    let difference = |site: usize| areas[site] - cut_by_bisectors(&centres, site, &domain);
    let worst = farthest((0..300).map(difference), 0.0);
    add(rows, Tier::Identity, "300 equal disks: area less that cut by all bisectors", worst, 0.0);
    let ordinary = Diagram::of_points(&centres)?.dual();
    let equal = f64::from(u8::from(diagram.dual() == ordinary));
    add(rows, Tier::Identity, "300 equal disks: the dual is that of points", equal, 1.0);
    Ok(())
}

/// Area of what is nearer to a site than to any other, by cutting a polygon.
fn cut_by_bisectors(centres: &[DVec2], site: usize, domain: &Domain) -> f64 {
    let mut polygon: Vec<DVec2> = domain.corners().collect();
    let centre = centres[site];
    for &other in centres.iter().filter(|other| **other != centre) {
        let beyond = |p: DVec2| (p - 0.5 * (centre + other)).dot(other - centre);
        let mut kept = Vec::new();
        for (k, &from) in polygon.iter().enumerate() {
            let to = polygon[(k + 1) % polygon.len()];
            let (a, b) = (beyond(from), beyond(to));
            if a <= 0.0 {
                kept.push(from);
            }
            if (a <= 0.0) != (b <= 0.0) {
                kept.push(from.lerp(to, a / (a - b)));
            }
        }
        polygon = kept;
    }
    let turn = |k: usize| (polygon[k] - centre).perp_dot(polygon[(k + 1) % polygon.len()] - centre);
    (0..polygon.len()).map(|k| 0.5 * turn(k)).sum()
}

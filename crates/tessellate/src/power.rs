//! Power cells of spheres in a box.
//!
//! In space the faces of the additively weighted diagram are parts of hyperboloids that meet in conics; volumes
//! between them have no closed form, and two cells may share several faces. The power diagram,
//! $\min_i |x - x_i|^2 - r_i^2$, has flat faces and volumes in closed form, and keeps what matters for packings: the
//! plane of equal power of two spheres that do not overlap lies between them \[Aurenhammer1987\], so each sphere lies
//! in its own cell. It equals the additively weighted diagram for spheres of one size. Where spheres overlap it cuts them
//! through their common circle.
//!
//! Each cell is the box, cut by the planes to its neighbours from near to far until no further sphere can
//! reach it; neighbours come from the same grid as contacts.

use crate::error::TessellationError;
use granular_core::D3;
use granular_core::glam::DVec3;
use granular_core::search::CellGrid;

/// A power cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PowerCell {
    /// Volume; 0 if other spheres have won all of it.
    pub volume: f64,
    /// Spheres with a common face, and the area of the face.
    pub faces: Vec<(usize, f64)>,
}

/// A convex polyhedron. Faces are loops of vertices, counter-clockwise from outside, with the sphere beyond.
struct Polyhedron {
    vertices: Vec<DVec3>,
    faces: Vec<(usize, Vec<usize>)>,
}

/// Beyond a face of the box.
const WALL: usize = usize::MAX;

/// The power cells of spheres, cut to a box.
///
/// # Errors
/// As [`Diagram::new`](crate::Diagram::new), and when `high` is not above `low` on all axes.
pub fn power_cells(
    positions: &[DVec3],
    radii: &[f64],
    low: DVec3,
    high: DVec3,
) -> Result<Vec<PowerCell>, TessellationError> {
    check(positions, radii)?;
    if !(low.cmplt(high).all() && (high - low).is_finite()) {
        return Err(TessellationError::Domain { corner: 0, position: vec![low.x, low.y, low.z] });
    }
    let largest = radii.iter().map(|radius| radius.abs()).fold(0.0, f64::max);
    let spacing = ((high - low).element_product() / positions.len() as f64).cbrt();
    let mut levels: Vec<(f64, CellGrid<D3>)> = Vec::new();
    let mut edge = 1.5 * spacing.max(largest);
    // Far enough to have every sphere around every other one.
    let all = positions.iter().fold((low, high), |(a, b), &p| (a.min(p), b.max(p)));
    let all = 2.0 * (all.1 - all.0).length() + edge;
    let mut cells = vec![PowerCell::default(); positions.len()];
    let mut pending: Vec<usize> = (0..positions.len()).collect();
    while !pending.is_empty() {
        let mut grid = CellGrid::default();
        grid.fill(positions, edge);
        levels.push((edge, grid));
        let (reach, grid) = &levels[levels.len() - 1];
        pending.retain(|&site| {
            let mut near = Vec::new();
            grid.visit_around(positions[site], |other| near.push(other as usize));
            let (cell, extent) = cell(site, positions, radii, &near, (low, high));
            cells[site] = cell;
            // A sphere further away than the grid reaches has its plane at this distance or more.
            let square = reach * reach + radii[site] * radii[site] - largest * largest;
            let certain = extent == 0.0 || square / (2.0 * reach) >= extent;
            !certain && *reach < all
        });
        edge *= 2.0;
    }
    Ok(cells)
}

fn check(positions: &[DVec3], radii: &[f64]) -> Result<(), TessellationError> {
    let count = positions.len();
    if count == 0 || count > u32::MAX as usize {
        return Err(TessellationError::Count { sites: count });
    }
    if radii.len() != count {
        return Err(TessellationError::Radii { sites: count, radii: radii.len() });
    }
    for (index, (p, &radius)) in positions.iter().zip(radii).enumerate() {
        for (what, value) in [("x", p.x), ("y", p.y), ("z", p.z), ("radius", radius)] {
            if value.is_nan() || value.abs() > crate::diagram::LARGEST {
                return Err(TessellationError::Site { index, what, value });
            }
        }
    }
    Ok(())
}

/// The cell of a sphere among others, and the distance from its centre to its farthest corner.
fn cell(
    site: usize,
    positions: &[DVec3],
    radii: &[f64],
    near: &[usize],
    (low, high): (DVec3, DVec3),
) -> (PowerCell, f64) {
    let (centre, radius) = (positions[site], radii[site]);
    let mut planes: Vec<(f64, usize)> = near
        .iter()
        .filter(|&&other| other != site)
        .map(|&other| {
            let square = (positions[other] - centre).length_squared();
            let height = 0.5 * (square + radius * radius - radii[other] * radii[other]);
            (height / square.sqrt(), other)
        })
        .collect();
    planes.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // Corners are kept relative to the centre.
    let mut body = Polyhedron::of_box(low - centre, high - centre);
    let mut extent = body.extent();
    for (distance, other) in planes {
        let step = positions[other] - centre;
        if step == DVec3::ZERO {
            // Concentric spheres: the larger takes all, of equal ones the first.
            let order = radii[other].abs().total_cmp(&radius.abs()).reverse().then(site.cmp(&other));
            if order.is_gt() {
                return (PowerCell::default(), 0.0);
            }
            continue;
        }
        if distance >= extent {
            break;
        }
        body.cut(step.normalize(), distance, other);
        extent = body.extent();
        if body.faces.len() < 4 {
            return (PowerCell::default(), 0.0);
        }
    }
    (body.measure(), extent)
}

impl Polyhedron {
    fn of_box(low: DVec3, high: DVec3) -> Self {
        let corner = |k: usize| {
            let pick = |bit: usize, a: f64, b: f64| if k >> bit & 1 == 1 { b } else { a };
            DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
        };
        let loops = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Self {
            vertices: (0..8).map(corner).collect(),
            faces: loops.into_iter().map(|face| (WALL, face.to_vec())).collect(),
        }
    }

    fn extent(&self) -> f64 {
        let used = self.faces.iter().flat_map(|(_, corners)| corners);
        used.map(|&corner| self.vertices[corner].length()).fold(0.0, f64::max)
    }

    /// Takes off what lies beyond a plane at a distance along a normal.
    fn cut(&mut self, normal: DVec3, distance: f64, other: usize) {
        let beyond: Vec<f64> = self.vertices.iter().map(|corner| corner.dot(normal) - distance).collect();
        let corners = || self.faces.iter().flat_map(|(_, corners)| corners);
        if corners().all(|&corner| beyond[corner] <= 0.0) {
            return;
        }
        let mut made: Vec<((usize, usize), usize)> = Vec::new();
        // Sides of the new face, each from where a face is left to where it is entered again.
        let mut sides: Vec<(usize, usize)> = Vec::new();
        let vertices = &mut self.vertices;
        let mut crossing = |a: usize, b: usize| {
            let key = (a.min(b), a.max(b));
            if let Some(&(_, corner)) = made.iter().find(|(edge, _)| *edge == key) {
                return corner;
            }
            let share = beyond[key.0] / (beyond[key.0] - beyond[key.1]);
            vertices.push(vertices[key.0].lerp(vertices[key.1], share));
            made.push((key, vertices.len() - 1));
            vertices.len() - 1
        };
        for (_, corners) in &mut self.faces {
            let mut kept = Vec::with_capacity(corners.len() + 1);
            let (mut leaves, mut enters) = (None, None);
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                let inside = [a, b].map(|corner| beyond[corner] <= 0.0);
                if inside[0] {
                    kept.push(a);
                }
                if inside[0] != inside[1] {
                    let corner = crossing(a, b);
                    kept.push(corner);
                    *(if inside[0] { &mut leaves } else { &mut enters }) = Some(corner);
                }
            }
            if let (Some(leaves), Some(enters)) = (leaves, enters) {
                sides.push((enters, leaves));
            }
            *corners = kept;
        }
        self.faces.retain(|(_, corners)| corners.len() > 2);
        let mut face = Vec::with_capacity(sides.len());
        if let Some((first, mut last)) = sides.pop() {
            face.push(first);
            while last != first {
                let Some(next) = sides.iter().position(|&(from, _)| from == last) else { break };
                face.push(last);
                last = sides.swap_remove(next).1;
            }
        }
        if face.len() > 2 {
            self.faces.push((other, face));
        }
    }

    fn measure(&self) -> PowerCell {
        let mut cell = PowerCell::default();
        for (other, corners) in &self.faces {
            let apex = self.vertices[corners[0]];
            let mut area = DVec3::ZERO;
            for pair in corners[1..].windows(2) {
                let [b, c] = [self.vertices[pair[0]], self.vertices[pair[1]]];
                area += 0.5 * (b - apex).cross(c - apex);
            }
            cell.volume += apex.dot(area) / 3.0;
            if *other != WALL {
                cell.faces.push((*other, area.length()));
            }
        }
        cell.faces.sort_unstable_by_key(|&(other, _)| other);
        cell
    }
}

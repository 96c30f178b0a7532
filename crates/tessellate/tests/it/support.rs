//! Random disks, and what a diagram must obey.

use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain};

/// Random numbers of a seed (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// From 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-53)
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    pub(crate) fn point(&mut self) -> DVec2 {
        DVec2::new(self.unit(), self.unit())
    }
}

pub(crate) fn unit_square() -> Domain {
    Domain::rectangle(DVec2::ZERO, DVec2::ONE).unwrap()
}

/// Distance of a point to a disk.
pub(crate) fn distance(diagram: &Diagram, site: usize, point: DVec2) -> f64 {
    (point - diagram.position(site)).length() - diagram.radius(site)
}

/// What every diagram obeys, as a reason if it does not: areas are not negative and sum to the domain, hidden
/// sites are hidden and have no cell, boundaries close, the sites of a vertex are equally near and no other one is
/// nearer, adjacency is symmetric, and the planar graph has no more edges and vertices than Euler allows.
pub(crate) fn violation(diagram: &Diagram, domain: &Domain, tolerance: f64) -> Option<String> {
    let cells = diagram.cells(domain);
    let sum: f64 = cells.areas().iter().sum();
    if sum.is_nan() || (sum - domain.area()).abs() > tolerance * domain.area() {
        return Some(format!("areas sum to {sum}, not {}", domain.area()));
    }
    let size = domain.area().sqrt();
    for site in 0..diagram.len() {
        if cells.areas()[site] < -tolerance * domain.area() {
            return Some(format!("area {} of site {site}", cells.areas()[site]));
        }
        if let Some(other) = diagram.hidden_by(site) {
            let gap = (diagram.position(site) - diagram.position(other)).length();
            let step = diagram.radius(other) - diagram.radius(site);
            if gap > step + 1e-15 * (gap + step.abs()) || !cells.boundary(site).is_empty() {
                return Some(format!("site {site} is not hidden by {other}: {gap} {step}"));
            }
        }
        for (k, sides) in cells.boundary(site).iter().enumerate() {
            for (side, next) in sides.iter().zip(sides.iter().cycle().skip(1)) {
                if (side.to - next.from).length() > 1e-9 * size {
                    return Some(format!("loop {k} of site {site} is open: {} {}", side.to, next.from));
                }
            }
        }
        for other in cells.neighbours(site) {
            if !cells.neighbours(other).contains(&site) {
                return Some(format!("{site} has neighbour {other}, not the other way round"));
            }
        }
    }
    counts(diagram).or_else(|| vertices(diagram, domain, tolerance))
}

/// Euler's relation for the planar graph with one more vertex at infinity.
fn counts(diagram: &Diagram) -> Option<String> {
    let visible = (0..diagram.len()).filter(|&site| diagram.hidden_by(site).is_none()).count();
    let (vertices, edges) = (diagram.vertices().len(), diagram.edge_count());
    let open = diagram.edges().map(|edge| usize::from(edge.from.is_none()) + usize::from(edge.to.is_none()));
    let open: usize = open.sum();
    if 2 * edges != 3 * vertices + open {
        return Some(format!("{edges} edges, {vertices} vertices, {open} open ends"));
    }
    // Faces of the graph closed by a vertex at infinity: v + 1 - e + f = 2 if it is connected.
    if visible > 1 && vertices + visible != edges + 1 {
        return Some(format!("{edges} edges, {vertices} vertices, {visible} cells"));
    }
    None
}

/// Vertices are what they should be. Their places are rounded: `tolerance` is relative to the size of the circle.
fn vertices(diagram: &Diagram, domain: &Domain, tolerance: f64) -> Option<String> {
    let mut sites = vec![Vec::new(); diagram.vertices().len()];
    for edge in diagram.edges() {
        for vertex in [edge.from, edge.to].into_iter().flatten() {
            sites[vertex].extend([edge.left, edge.right]);
        }
    }
    let size = domain.area().sqrt();
    for (vertex, mut sites) in diagram.vertices().iter().zip(sites) {
        sites.sort_unstable();
        sites.dedup();
        if sites.len() != 3 {
            return Some(format!("a vertex has sites {sites:?}"));
        }
        // Far away rounding says nothing.
        let scale = size + (vertex.position - domain.corners().next()?).length() + vertex.distance.abs();
        if scale > 1e3 * size {
            continue;
        }
        for site in sites {
            let error = distance(diagram, site, vertex.position) - vertex.distance;
            if error.abs() > 1e3 * tolerance * scale {
                return Some(format!("site {site} at {error} from the circle of {vertex:?}"));
            }
        }
        let nearest = diagram.nearest(vertex.position);
        let gap = distance(diagram, nearest, vertex.position) - vertex.distance;
        if gap < -1e3 * tolerance * scale {
            return Some(format!("site {nearest} is nearer by {gap} to {vertex:?}"));
        }
    }
    None
}

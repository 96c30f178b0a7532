//! The diagram of all sites in the whole plane.

use crate::beach::NONE;
use crate::cells::Cells;
use crate::curve::Curve;
use crate::domain::Domain;
use crate::error::TessellationError;
use crate::site::Site;
use crate::sweep::{Topology, Vertex, sweep};
use granular_core::glam::DVec2;

/// The additively weighted Voronoi diagram of disks: each point belongs to the site whose centre is nearest
/// after its radius is taken off, $\min_i |x - x_i| - r_i$.
#[derive(Clone, Debug)]
pub struct Diagram {
    positions: Vec<DVec2>,
    radii: Vec<f64>,
    topology: Topology,
}

/// Points equally near to two sites and nearer to no other one, with `left` at the left of its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Site at the left.
    pub left: usize,
    /// Site at the right.
    pub right: usize,
    /// Number of the vertex where it begins; none where it comes from infinity.
    pub from: Option<usize>,
    /// Number of the vertex where it ends; none where it goes to infinity.
    pub to: Option<usize>,
    /// The curve on which it lies.
    pub curve: Curve,
}

/// Largest size of a coordinate or radius: its square is still a number.
pub(crate) const LARGEST: f64 = 1e150;

/// Largest number of sites: half-edges, six for each, are numbered with 32 bits.
const MOST_SITES: usize = 500_000_000;

impl Diagram {
    /// The diagram of disks.
    ///
    /// Only differences of radii matter, so a radius may also be negative. A site is hidden, without a cell, if its
    /// disk lies within another one or touches it from inside; of equal disks the first keeps the cell.
    ///
    /// # Errors
    /// Without sites, without a radius for each, or with a number that is not finite or above 1e150.
    pub fn new(positions: &[DVec2], radii: &[f64]) -> Result<Self, TessellationError> {
        let count = positions.len();
        if count == 0 || count > MOST_SITES {
            return Err(TessellationError::Count { sites: count });
        }
        if radii.len() != count {
            return Err(TessellationError::Radii { sites: count, radii: radii.len() });
        }
        let largest = largest(positions, radii)?;
        // A power of two: no digit is lost, and products neither overflow nor underflow.
        let unit = if largest > 0.0 { 2f64.powi(largest.log2().ceil() as i32) } else { 1.0 };
        let site = |index: u32| Site::new(positions[index as usize] / unit, radii[index as usize] / unit);
        // Rounded heights first: whole sites are compared only where those are equal.
        let mut order: Vec<(f64, u32)> = (0..count as u32).map(|index| (site(index).low[0], index)).collect();
        order.sort_unstable_by(|&(a, i), &(b, j)| {
            let exactly = || site(i).order(&site(j)).then(i.cmp(&j));
            a.partial_cmp(&b).filter(|order| order.is_ne()).unwrap_or_else(exactly)
        });
        let order: Vec<u32> = order.into_iter().map(|(_, index)| index).collect();
        let sites: Vec<Site> = order.iter().map(|&index| site(index)).collect();
        let mut topology = sweep(&sites);
        for site in &mut topology.site {
            *site = order[*site as usize];
        }
        let mut hidden_by = vec![NONE; count];
        for (&site, &other) in order.iter().zip(&topology.hidden_by) {
            hidden_by[site as usize] = if other == NONE { NONE } else { order[other as usize] };
        }
        topology.hidden_by = hidden_by;
        for vertex in &mut topology.vertices {
            vertex.position *= unit;
            vertex.distance *= unit;
        }
        Ok(Self { positions: positions.to_vec(), radii: radii.to_vec(), topology })
    }

    /// The ordinary Voronoi diagram, of points.
    ///
    /// # Errors
    /// As [`Diagram::new`].
    pub fn of_points(positions: &[DVec2]) -> Result<Self, TessellationError> {
        Self::new(positions, &vec![0.0; positions.len()])
    }

    /// Number of sites.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Never: a diagram has a site.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Centre of a site.
    pub fn position(&self, site: usize) -> DVec2 {
        self.positions[site]
    }

    /// Radius of a site.
    pub fn radius(&self, site: usize) -> f64 {
        self.radii[site]
    }

    /// The site in whose disk this one lies, if it is hidden.
    pub fn hidden_by(&self, site: usize) -> Option<usize> {
        some(self.topology.hidden_by[site])
    }

    /// Points equally near to three sites. Where more sites are equally near, several coincide.
    pub fn vertices(&self) -> &[Vertex] {
        &self.topology.vertices
    }

    /// Bytes of memory that the diagram holds.
    pub fn bytes(&self) -> usize {
        let Topology { vertices, site, target, hidden_by } = &self.topology;
        size_of_val(&self.positions[..])
            + size_of_val(&self.radii[..])
            + size_of_val(&vertices[..])
            + size_of_val(&site[..])
            + size_of_val(&target[..])
            + size_of_val(&hidden_by[..])
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.topology.site.len() / 2
    }

    /// Edges, with the curve of each.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = Edge> {
        (0..self.edge_count() as u32).map(|edge| {
            let [left, right] = self.owners(edge).map(|site| site as usize);
            let [from, to] = self.ends(edge).map(some);
            Edge { left, right, from, to, curve: self.curve(edge) }
        })
    }

    /// The dual graph: pairs of sites that share an edge, each once, the smaller number first, in ascending order.
    /// For disks of one size these are the edges of a Delaunay triangulation, else of the Apollonius graph.
    ///
    /// Where more than three sites are equally near to a point, the edges of length zero that resolve the
    /// vertex are among them.
    pub fn dual(&self) -> Vec<[usize; 2]> {
        let edges = (0..self.edge_count() as u32).map(|edge| self.owners(edge).map(|site| site as usize));
        let mut pairs: Vec<[usize; 2]> = edges.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// The site whose disk is nearest to a point, the owner of its cell: all are tried.
    pub fn nearest(&self, point: DVec2) -> usize {
        let distance = |site: usize| (self.positions[site] - point).length() - self.radii[site];
        let visible = (0..self.len()).filter(|&site| self.topology.hidden_by[site] == NONE);
        visible.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or_default()
    }

    /// The cells of all sites, cut to a convex domain.
    pub fn cells<'a>(&'a self, domain: &'a Domain) -> Cells<'a> {
        Cells::new(self, domain)
    }

    #[inline(always)]
    pub(crate) fn owners(&self, edge: u32) -> [u32; 2] {
        let half = 2 * edge as usize;
        [self.topology.site[half], self.topology.site[half + 1]]
    }

    /// Vertices at the begin and end of an edge.
    #[inline(always)]
    pub(crate) fn ends(&self, edge: u32) -> [u32; 2] {
        let half = 2 * edge as usize;
        [self.topology.target[half + 1], self.topology.target[half]]
    }

    pub(crate) fn curve(&self, edge: u32) -> Curve {
        let [left, right] = self.owners(edge).map(|site| site as usize);
        Curve::new(self.positions[left], self.radii[left], self.positions[right], self.radii[right])
    }
}

fn some(number: u32) -> Option<usize> {
    (number != NONE).then_some(number as usize)
}

/// The largest coordinate or radius, without sign.
fn largest(positions: &[DVec2], radii: &[f64]) -> Result<f64, TessellationError> {
    let mut largest = 0.0_f64;
    for (index, (position, &radius)) in positions.iter().zip(radii).enumerate() {
        for (what, value) in [("x", position.x), ("y", position.y), ("radius", radius)] {
            if value.is_nan() || value.abs() > LARGEST {
                return Err(TessellationError::Site { index, what, value });
            }
            largest = largest.max(value.abs());
        }
    }
    Ok(largest)
}
